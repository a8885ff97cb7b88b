// What calls of a context end with: Flattening, Atlas, Packing. Each keeps its context alive, reads
// from it when asked, and fails with kInvalidState once the context has newer results of its kind,
// or after a move. Like the context they belong to one thread at a time.
//
// Every function `x` that throws Error has one `try_x` that returns a Result instead. Arrays take
// the type of an item: `uvs<beltrami::Uv32>()`, or `uvs<float>()` for u and v one after another.
#ifndef BELTRAMI_CPP_RESULTS_HPP
#define BELTRAMI_CPP_RESULTS_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/handle.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/span.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

// The structs of C, which its header describes field by field.
using AtlasInfo = beltrami_atlas;
using AtlasCertificate = beltrami_atlas_certificate;
using Certificate = beltrami_certificate;
using Chart = beltrami_chart;
using Energies = beltrami_energy;
using FlatteningInfo = beltrami_result;
using PackingInfo = beltrami_packing;
using TriangleCorners = std::array<std::uint32_t, 3>;
using SeamEdge = std::array<std::uint32_t, 2>;

/// A disk in the plane: one UV per vertex, in the mesh's unit of length.
class Flattening {
 public:
  /// kOk, or the reservation with which it comes.
  Status status() const noexcept { return static_cast<Status>(info_.status); }
  /// Whether it is proven to be injective, in the precision that was asked for.
  bool injective() const noexcept { return detail::is_injective(status()); }
  const FlatteningInfo& info() const noexcept { return info_; }

  /// One (u, v) per vertex; single precision is rounded to nearest, but where that would fold.
  template <class Item = Uv>
  Result<std::vector<Item>> try_uvs() const {
    return source_.read<2, Item>(vertices(), &beltrami_get_uvs);
  }
  /// The same into memory of the caller, one item per vertex.
  template <class Item>
  Result<void> try_write_uvs(Span<Item> out) const {
    return source_.write<2>(out, vertices(), &beltrami_get_uvs);
  }
  /// The triangles that the map speaks of; those of the input but with option::kDelaunay.
  template <class Item = TriangleCorners>
  Result<std::vector<Item>> try_triangles() const {
    return source_.read<3, Item>(static_cast<std::size_t>(info_.faces), &beltrami_get_faces);
  }
  /// The exact verdict on the UVs as doubles, or for Scalar float on those as floats.
  template <class Scalar = double>
  Result<Certificate> try_certificate() const {
    return source_.get<Certificate>(detail::scalar_type<Scalar>() == BELTRAMI_F32
                                        ? &beltrami_get_float32_certificate
                                        : &beltrami_get_certificate);
  }
  /// Mean and greatest distortion.
  Result<Energies> try_energy() const { return source_.get<Energies>(&beltrami_get_energy); }
  /// Symmetric Dirichlet energy of each face.
  Result<std::vector<double>> try_face_energies() const {
    return source_.read<1, double>(static_cast<std::size_t>(info_.faces), &face_energies_of_c);
  }
  /// Name and cost of each stage, in the order in which they ran.
  Result<std::vector<Stage>> try_stages() const {
    if (Result<void> is = source_.ready(); !is) return is.error();
    const std::int32_t count = beltrami_stage_count(source_.handle()->context);
    return source_.each<Stage, std::int32_t>(static_cast<std::uint64_t>(count),
                                             &beltrami_get_stage);
  }

#if BELTRAMI_CPP_EXCEPTIONS
  template <class Item = Uv>
  std::vector<Item> uvs() const {
    return try_uvs<Item>().value();
  }
  template <class Item>
  void write_uvs(Span<Item> out) const {
    try_write_uvs(out).value();
  }
  template <class Item = TriangleCorners>
  std::vector<Item> triangles() const {
    return try_triangles<Item>().value();
  }
  template <class Scalar = double>
  Certificate certificate() const {
    return try_certificate<Scalar>().value();
  }
  Energies energy() const {
    return try_energy().value();
  }
  std::vector<double> face_energies() const {
    return try_face_energies().value();
  }
  std::vector<Stage> stages() const {
    return try_stages().value();
  }
#endif

 private:
  friend class Context;

  std::size_t vertices() const noexcept {
    return static_cast<std::size_t>(info_.vertices);
  }

  static beltrami_status face_energies_of_c(beltrami_context* context, void* out, std::int32_t,
                                            std::uint64_t stride) {
    return beltrami_get_face_energies(context, out, stride);
  }

  detail::Source source_;
  FlatteningInfo info_{};
};

/// Charts on pages: those of UV meshes that were packed, or of an atlas.
class Packing {
 public:
  Status status() const noexcept { return static_cast<Status>(info_.status); }
  /// Whether it is proven to be injective, in the precision that was asked for.
  bool injective() const noexcept { return detail::is_injective(status()); }
  const PackingInfo& info() const noexcept { return info_; }

  /// The new (u, v) of each UV vertex of mesh `mesh`, counted from 0. Of Context::pack alone.
  template <class Item = Uv>
  Result<std::vector<Item>> try_uvs(std::size_t mesh = 0) const {
    if (mesh >= uvs_.size()) return no_mesh();
    return source_.read<2, Item>(uvs_[mesh], &uvs_of_c, static_cast<std::uint64_t>(mesh));
  }
  /// The same into memory of the caller, one item per UV vertex.
  template <class Item>
  Result<void> try_write_uvs(std::size_t mesh, Span<Item> out) const {
    if (mesh >= uvs_.size()) return no_mesh();
    return source_.write<2>(out, uvs_[mesh], &uvs_of_c, static_cast<std::uint64_t>(mesh));
  }
  /// The chart of each face of mesh `mesh`. Of Context::pack alone.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_face_charts(std::size_t mesh = 0) const {
    if (mesh >= faces_.size()) return no_mesh();
    return source_.read<1, Item>(faces_[mesh], &charts_of_c, static_cast<std::uint64_t>(mesh));
  }
  /// The page of each chart.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_chart_pages() const {
    return source_.read<1, Item>(static_cast<std::size_t>(info_.charts), &beltrami_get_chart_pages);
  }
  /// The share of each page that charts cover.
  Result<std::vector<double>> try_page_utilisations() const {
    return source_.read<1, double>(static_cast<std::size_t>(info_.pages),
                                   &beltrami_get_page_utilisations);
  }
  /// The exact verdict, page by page, on the UVs as doubles or floats.
  template <class Scalar = double>
  Result<AtlasCertificate> try_certificate() const {
    return source_.get<AtlasCertificate>(&beltrami_get_packing_certificate,
                                         detail::scalar_type<Scalar>());
  }
  /// A BELTRAMI_TEXEL_ number for each texel of a page, rows from the top down.
  Result<std::vector<std::uint8_t>> try_page_mask(std::uint64_t page) const {
    std::vector<std::uint8_t> mask;
    const auto side = static_cast<std::size_t>(info_.resolution);
    if (Result<void> is = source_.ready(); !is) return is.error();
    if (!detail::has_room_for([&] { mask.resize(side * side); })) {
      return Failure(Status::kOutOfMemory);
    }
    Result<void> done =
        source_.call(&beltrami_get_page_mask, page, mask.data(), std::uint64_t{side});
    if (!done) return done.error();
    return mask;
  }

#if BELTRAMI_CPP_EXCEPTIONS
  template <class Item = Uv>
  std::vector<Item> uvs(std::size_t mesh = 0) const {
    return try_uvs<Item>(mesh).value();
  }
  template <class Item>
  void write_uvs(std::size_t mesh, Span<Item> out) const {
    try_write_uvs(mesh, out).value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> face_charts(std::size_t mesh = 0) const {
    return try_face_charts<Item>(mesh).value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> chart_pages() const {
    return try_chart_pages<Item>().value();
  }
  std::vector<double> page_utilisations() const {
    return try_page_utilisations().value();
  }
  template <class Scalar = double>
  AtlasCertificate certificate() const {
    return try_certificate<Scalar>().value();
  }
  std::vector<std::uint8_t> page_mask(std::uint64_t page) const {
    return try_page_mask(page).value();
  }
#endif

 private:
  friend class Atlas;
  friend class Context;

  static Failure no_mesh() {
    return Failure(Status::kInvalidArgument, "no mesh of this number was packed");
  }
  // The functions of C with the mesh in front, where detail::Source has the arguments of its own.
  static beltrami_status uvs_of_c(beltrami_context* context, std::uint64_t mesh, void* out,
                                  std::int32_t type, std::uint64_t stride) {
    return beltrami_get_packed_uvs(context, mesh, out, type, stride);
  }
  static beltrami_status charts_of_c(beltrami_context* context, std::uint64_t mesh, void* out,
                                     std::int32_t type, std::uint64_t stride) {
    return beltrami_get_packed_charts(context, mesh, out, type, stride);
  }

  detail::Source source_;
  PackingInfo info_{};
  std::vector<std::size_t> uvs_, faces_;  // of each mesh: how many
};

/// A surface in charts: one UV per corner, or UV vertices and an index buffer.
class Atlas {
 public:
  /// kOk, or the reservation with which it comes.
  Status status() const noexcept { return static_cast<Status>(info_.status); }
  /// Whether it is proven to be injective, in the precision that was asked for.
  bool injective() const noexcept { return detail::is_injective(status()); }
  const AtlasInfo& info() const noexcept { return info_; }

  /// One (u, v) per corner, face after face.
  template <class Item = Uv>
  Result<std::vector<Item>> try_corner_uvs() const {
    return source_.read<2, Item>(corners(), &beltrami_get_corner_uvs);
  }
  /// The same into memory of the caller, one item per corner.
  template <class Item>
  Result<void> try_write_corner_uvs(Span<Item> out) const {
    return source_.write<2>(out, corners(), &beltrami_get_corner_uvs);
  }
  /// The page of each corner's UV.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_corner_pages() const {
    return source_.read<1, Item>(corners(), &beltrami_get_corner_pages);
  }
  /// The UV vertex of each corner: an index buffer, with TriangleCorners one of triangles.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_corner_uv_vertices() const {
    return source_.read<1, Item>(corners(), &beltrami_get_corner_uv_vertices);
  }
  /// The (u, v) of each UV vertex.
  template <class Item = Uv>
  Result<std::vector<Item>> try_uv_vertices() const {
    return source_.read<2, Item>(uv_vertex_count(), &beltrami_get_uv_vertices);
  }
  /// The same into memory of the caller, one item per UV vertex.
  template <class Item>
  Result<void> try_write_uv_vertices(Span<Item> out) const {
    return source_.write<2>(out, uv_vertex_count(), &beltrami_get_uv_vertices);
  }
  /// The vertex of the input that each UV vertex is a copy of.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_uv_vertex_origins() const {
    return source_.read<1, Item>(uv_vertex_count(), &beltrami_get_uv_vertex_origins);
  }
  /// The chart of each face; all bits set for a face without area.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_face_charts() const {
    return source_.read<1, Item>(static_cast<std::size_t>(info_.faces), &beltrami_get_face_charts);
  }
  /// The seams, by the vertices of their edges.
  template <class Item = SeamEdge>
  Result<std::vector<Item>> try_seams() const {
    return source_.read<2, Item>(static_cast<std::size_t>(info_.seams), &beltrami_get_seams);
  }
  /// The triangles that polygons were cut into, by their corners.
  template <class Item = TriangleCorners>
  Result<std::vector<Item>> try_triangles() const {
    return source_.read<3, Item>(static_cast<std::size_t>(info_.triangles),
                                 &beltrami_get_triangles);
  }
  /// Every chart, in the order of their least faces.
  Result<std::vector<Chart>> try_charts() const {
    return source_.each<Chart, std::uint64_t>(info_.charts, &beltrami_get_chart);
  }
  /// The exact verdict on the UVs as doubles or floats.
  template <class Scalar = double>
  Result<AtlasCertificate> try_certificate() const {
    return source_.get<AtlasCertificate>(&beltrami_get_atlas_certificate,
                                         detail::scalar_type<Scalar>());
  }
  /// Its pages. Failure INVALID_STATE where it is not packed, or something else was packed since.
  Result<Packing> try_packing() const {
    if (Result<void> is = source_.ready(); !is) return is.error();
    if (info_.pages == 0) return Failure(Status::kInvalidState, "this atlas is not packed");
    if (Result<void> is = packed_.ready(); !is) return is.error();
    Packing packing;
    packing.source_ = packed_;
    Result<PackingInfo> info = packed_.get<PackingInfo>(&beltrami_get_packing);
    if (!info) return info.error();
    packing.info_ = *info;
    return packing;
  }
  /// Name and cost of each stage, in the order in which they ran.
  Result<std::vector<Stage>> try_stages() const {
    if (Result<void> is = source_.ready(); !is) return is.error();
    const std::int32_t count = beltrami_atlas_stage_count(source_.handle()->context);
    return source_.each<Stage, std::int32_t>(static_cast<std::uint64_t>(count),
                                             &beltrami_get_atlas_stage);
  }

#if BELTRAMI_CPP_EXCEPTIONS
  template <class Item = Uv>
  std::vector<Item> corner_uvs() const {
    return try_corner_uvs<Item>().value();
  }
  template <class Item>
  void write_corner_uvs(Span<Item> out) const {
    try_write_corner_uvs(out).value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> corner_pages() const {
    return try_corner_pages<Item>().value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> corner_uv_vertices() const {
    return try_corner_uv_vertices<Item>().value();
  }
  template <class Item = Uv>
  std::vector<Item> uv_vertices() const {
    return try_uv_vertices<Item>().value();
  }
  template <class Item>
  void write_uv_vertices(Span<Item> out) const {
    try_write_uv_vertices(out).value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> uv_vertex_origins() const {
    return try_uv_vertex_origins<Item>().value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> face_charts() const {
    return try_face_charts<Item>().value();
  }
  template <class Item = SeamEdge>
  std::vector<Item> seams() const {
    return try_seams<Item>().value();
  }
  template <class Item = TriangleCorners>
  std::vector<Item> triangles() const {
    return try_triangles<Item>().value();
  }
  std::vector<Chart> charts() const {
    return try_charts().value();
  }
  template <class Scalar = double>
  AtlasCertificate certificate() const {
    return try_certificate<Scalar>().value();
  }
  Packing packing() const {
    return try_packing().value();
  }
  std::vector<Stage> stages() const {
    return try_stages().value();
  }
#endif

 private:
  friend class Context;

  std::size_t corners() const noexcept {
    return static_cast<std::size_t>(info_.corners);
  }
  std::size_t uv_vertex_count() const noexcept {
    return static_cast<std::size_t>(info_.uv_vertices);
  }

  detail::Source source_, packed_;
  AtlasInfo info_{};
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_RESULTS_HPP
