// Checks of any UVs, which need no context, and what else the library tells without one.
#ifndef BELTRAMI_CPP_CHECKS_HPP
#define BELTRAMI_CPP_CHECKS_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/results.hpp>
#include <beltrami/cpp/span.hpp>
#include <beltrami/cpp/surface.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

using OptionInfo = beltrami_option_info;
using FacePair = std::array<std::uint64_t, 2>;

/// The verdict on an atlas, and pairs of faces that overlap, as many as were asked for.
struct AtlasCheck {
  AtlasCertificate certificate{};
  std::vector<FacePair> pairs;

  bool injective() const noexcept { return certificate.injective != 0; }
};

/// Distortion of each face: singular values s1 >= |s2|, symmetric Dirichlet and symmetric ARAP
/// energy. All are NaN for a face without area on the surface.
struct FaceDistortion {
  double s1, s2, symmetric_dirichlet, symmetric_arap;
};
template <>
struct ItemTraits<FaceDistortion> : ItemOf<double, 4> {};

namespace detail {

/// Of a check: the certificate has the element of a failure.
template <class Verdict>
Failure failure_of(beltrami_status status, const Verdict& verdict) noexcept {
  return Failure(static_cast<Status>(status), "",
                 static_cast<ElementKind>(verdict.error_element_kind), verdict.error_element);
}

using MapCheck = beltrami_status (*)(const beltrami_mesh*, const beltrami_buffer*,
                                     beltrami_certificate*);

/// Runs a check of one UV per vertex.
inline Result<Certificate> check_map(MapCheck check, const Indices<3>& triangles,
                                     const Reals<2>& uvs) {
  for (const char* defect : {triangles.defect(), uvs.defect()}) {
    if (defect != nullptr) return Failure(Status::kInvalidArgument, defect);
  }
  auto mesh = sized<beltrami_mesh>();
  mesh.vertex_count = uvs.size();
  mesh.face_count = triangles.size();
  mesh.indices = triangles.buffer();
  auto verdict = sized<Certificate>();
  const beltrami_status status = check(&mesh, &uvs.buffer(), &verdict);
  if (status < 0) return failure_of(status, verdict);
  return verdict;
}

/// The mesh of a surface that is measured under one UV per vertex.
inline Result<beltrami_mesh> measured(const Surface& surface, const Reals<2>& uvs) {
  if (uvs.defect() != nullptr) return Failure(Status::kInvalidArgument, uvs.defect());
  if (uvs.size() != surface.vertices()) {
    return Failure(Status::kInvalidArgument, "there is not one UV per vertex");
  }
  return surface.mesh();
}

}  // namespace detail

/// Judges the corner UVs of a surface: beltrami_check_atlas. At most `most_pairs` of the pairs of
/// faces that overlap are listed. With `allow_mirrored` charts may be mirror images.
inline Result<AtlasCheck> try_check_atlas(const Surface& surface, std::size_t most_pairs = 0,
                                          bool allow_mirrored = false) {
  if (surface.defect() != nullptr) return Failure(Status::kInvalidArgument, surface.defect());
  AtlasCheck found;
  found.certificate = detail::sized<AtlasCertificate>();
  const FacePair none{BELTRAMI_NO_ELEMENT, BELTRAMI_NO_ELEMENT};
  if (!detail::has_room_for([&] { found.pairs.resize(most_pairs, none); })) {
    return Failure(Status::kOutOfMemory);
  }
  const beltrami_status status =
      beltrami_check_atlas(&surface.c(), allow_mirrored ? 1 : 0, &found.certificate,
                           most_pairs == 0 ? nullptr : found.pairs.data()->data(), most_pairs);
  if (status < 0) return detail::failure_of(status, found.certificate);
  while (!found.pairs.empty() && found.pairs.back() == none) found.pairs.pop_back();
  return found;
}

/// Whether one UV per vertex maps a disk injectively: beltrami_check_injective.
inline Result<Certificate> try_check_injective(const Indices<3>& triangles, const Reals<2>& uvs) {
  return detail::check_map(&beltrami_check_injective, triangles, uvs);
}
/// Signs of all triangles alone: beltrami_check_triangles. It proves no injectivity.
inline Result<Certificate> try_check_triangles(const Indices<3>& triangles, const Reals<2>& uvs) {
  return detail::check_map(&beltrami_check_triangles, triangles, uvs);
}
/// Crossings of the boundary alone: beltrami_check_boundary. It proves no injectivity.
inline Result<Certificate> try_check_boundary(const Indices<3>& triangles, const Reals<2>& uvs) {
  return detail::check_map(&beltrami_check_boundary, triangles, uvs);
}

/// Distortion of one UV per vertex: beltrami_measure.
inline Result<Energies> try_measure(const Surface& surface, const Reals<2>& uvs) {
  const Result<beltrami_mesh> mesh = detail::measured(surface, uvs);
  if (!mesh) return mesh.error();
  auto energy = detail::sized<Energies>();
  const beltrami_status status = beltrami_measure(&*mesh, &uvs.buffer(), &energy, nullptr);
  if (status < 0) return Failure(status);
  return energy;
}

/// The same, of every face: beltrami_measure_faces.
inline Result<std::vector<FaceDistortion>> try_measure_faces(const Surface& surface,
                                                             const Reals<2>& uvs) {
  const Result<beltrami_mesh> mesh = detail::measured(surface, uvs);
  if (!mesh) return mesh.error();
  std::vector<FaceDistortion> faces;
  if (!detail::has_room_for([&] { faces.resize(surface.faces()); })) {
    return Failure(Status::kOutOfMemory);
  }
  const beltrami_status status = beltrami_measure_faces(&*mesh, &uvs.buffer(), faces.data(), 0);
  if (status < 0) return Failure(status);
  return faces;
}

/// Cuts polygons into triangles as unwrap does, each by its corners: beltrami_triangulate.
inline Result<std::vector<TriangleCorners>> try_triangulate(const Surface& surface) {
  if (surface.defect() != nullptr) return Failure(Status::kInvalidArgument, surface.defect());
  // A face of n corners, which are 3 or more, makes n - 2. Where there are fewer the call fails.
  const std::size_t corners = surface.corners(), faces = surface.faces();
  std::vector<TriangleCorners> triangles;
  if (!detail::has_room_for(
          [&] { triangles.resize(corners > 2 * faces ? corners - 2 * faces : 1); })) {
    return Failure(Status::kOutOfMemory);
  }
  const beltrami_status status =
      beltrami_triangulate(&surface.c(), triangles.data(), BELTRAMI_U32, 0, nullptr);
  if (status < 0) return Failure(status);
  return triangles;
}

/// What there is to set, in the order of the keys; names and sentences are static.
inline std::vector<OptionInfo> options() {
  std::vector<OptionInfo> all;
  auto info = detail::sized<OptionInfo>();
  for (std::int32_t key = 0; beltrami_option_describe(key, &info) == BELTRAMI_OK; ++key) {
    all.push_back(info);
  }
  return all;
}

#if BELTRAMI_CPP_EXCEPTIONS
inline AtlasCheck check_atlas(const Surface& surface, std::size_t most_pairs = 0,
                              bool allow_mirrored = false) {
  return try_check_atlas(surface, most_pairs, allow_mirrored).value();
}
inline Certificate check_injective(const Indices<3>& triangles, const Reals<2>& uvs) {
  return try_check_injective(triangles, uvs).value();
}
inline Certificate check_triangles(const Indices<3>& triangles, const Reals<2>& uvs) {
  return try_check_triangles(triangles, uvs).value();
}
inline Certificate check_boundary(const Indices<3>& triangles, const Reals<2>& uvs) {
  return try_check_boundary(triangles, uvs).value();
}
inline Energies measure(const Surface& surface, const Reals<2>& uvs) {
  return try_measure(surface, uvs).value();
}
inline std::vector<FaceDistortion> measure_faces(const Surface& surface, const Reals<2>& uvs) {
  return try_measure_faces(surface, uvs).value();
}
inline std::vector<TriangleCorners> triangulate(const Surface& surface) {
  return try_triangulate(surface).value();
}
#endif

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_CHECKS_HPP
