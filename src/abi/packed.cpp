#include "abi/packed.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include "abi/buffers.h"
#include "admit/admit.h"
#include "atlas/types.h"
#include "base/error.h"
#include "base/resources.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

constexpr std::uint64_t kMaxVertices = std::numeric_limits<Index>::max();
constexpr std::uint64_t kMaxFaces = 700'000'000;

bool is_given(const beltrami_buffer& buffer) {
  return buffer.data != nullptr;
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

/// "face 3", or with several meshes "face 3 of mesh 1".
std::string of_mesh(std::size_t mesh, std::size_t meshes) {
  return meshes > 1 ? " of mesh " + std::to_string(mesh) : "";
}

/// Reads some meshes into one list.
class Reader {
 public:
  Reader(const std::vector<beltrami_uv_mesh>& headers, const Work& work)
      : headers_(headers), work_(work) {}

  UvMesh read(PackedMeshes& packed) {
    UvMesh all;
    for (std::size_t m = 0; m < headers_.size(); ++m) {
      packed.first_uv.push_back(size_of(all.uvs));
      packed.first_face.push_back(size_of(all.faces));
      add(m, all);
    }
    packed.first_uv.push_back(size_of(all.uvs));
    packed.first_face.push_back(size_of(all.faces));
    if (std::find(all.excepted.begin(), all.excepted.end(), true) == all.excepted.end()) {
      all.excepted.clear();
    }
    return all;
  }

 private:
  void add(std::size_t m, UvMesh& all) {
    const beltrami_uv_mesh& header = headers_[m];
    const Index first = size_of(all.uvs);
    const std::vector<double> uvs = read_numbers(header.uvs, header.uv_count, 2, "UVs", work_);
    const std::vector<Triangle> faces =
        read_faces(header.uv_indices, "UV indices", header.face_count, header.uv_count, m);
    for (std::size_t v = 0; v < header.uv_count; ++v) {
      all.uvs.emplace_back(uvs[2 * v], uvs[2 * v + 1]);
    }
    for (const auto& [a, b, c] : faces) {
      for (const Index v : {a, b, c}) require_usable(all.uvs[first + v], "UV", v, m);
      all.faces.push_back({first + a, first + b, first + c});
    }
    // UV vertices that no face names may be no numbers.
    for (auto w = all.uvs.begin() + first; w != all.uvs.end(); ++w) {
      if (!w->allFinite()) w->setZero();
    }
    if (is_given(header.positions)) add_areas(m, faces, all);
    add_kept(m, all);
    if (!is_given(header.page_labels)) return;
    const std::vector<std::uint64_t> labels =
        read_integers(header.page_labels, header.face_count, 1, "page labels", work_);
    all.page_labels.insert(all.page_labels.end(), labels.begin(), labels.end());
  }

  void add_areas(std::size_t m, const std::vector<Triangle>& uv_faces, UvMesh& all) {
    const beltrami_uv_mesh& header = headers_[m];
    std::vector<Triangle> faces = uv_faces;
    if (is_given(header.indices)) {
      faces = read_faces(header.indices, "indices", header.face_count, header.vertex_count, m);
    } else if (header.vertex_count < header.uv_count) {
      refuse("there are fewer positions than UV vertices" + of_mesh(m, headers_.size()) +
             ": give indices, the vertices of corners");
    }
    const std::vector<double> numbers =
        read_numbers(header.positions, header.vertex_count, 3, "positions", work_);
    std::vector<Vec3> positions(header.vertex_count);
    for (std::size_t v = 0; v < positions.size(); ++v) {
      positions[v] = {numbers[3 * v], numbers[3 * v + 1], numbers[3 * v + 2]};
    }
    for (const Triangle& face : faces) {
      for (const Index v : face) require_usable(positions[v], "position", v, m);
      const auto [a, b, c] = face;
      all.areas.push_back(triangle_area(positions[a], positions[b], positions[c]));
    }
    for (Vec3& p : positions) {
      if (!p.allFinite()) p.setZero();
    }
    const std::vector<bool> flat = faces_without_area(positions, faces, work_);
    all.excepted.insert(all.excepted.end(), flat.begin(), flat.end());
  }

  void add_kept(std::size_t m, UvMesh& all) {
    const beltrami_uv_mesh& header = headers_[m];
    if (!is_given(header.kept_pages)) {
      if (!all.kept_page.empty()) all.kept_page.resize(all.faces.size(), kNone);
      return;
    }
    // Those of the meshes before this one are placed anew.
    all.kept_page.resize(all.faces.size() - header.face_count, kNone);
    const std::uint64_t none = all_bits_of(header.kept_pages.type);
    for (const std::uint64_t page :
         read_integers(header.kept_pages, header.face_count, 1, "kept pages", work_)) {
      if (page != none && page > static_cast<std::uint64_t>(kMostPages)) {
        refuse("a chart is to stay on page " + std::to_string(page) + ": pages count from 0, to " +
               std::to_string(kMostPages));
      }
      all.kept_page.push_back(page == none ? kNone : static_cast<Index>(page));
    }
  }

  std::vector<Triangle> read_faces(const beltrami_buffer& buffer, const char* what,
                                   std::uint64_t faces, std::uint64_t vertices, std::size_t m) {
    const std::vector<std::uint64_t> indices = read_integers(buffer, faces, 3, what, work_);
    std::vector<Triangle> result(faces);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] >= vertices) {
        throw Error(Fault::kIndexOutOfRange,
                    "face " + std::to_string(i / 3) + of_mesh(m, headers_.size()) + " names " +
                        std::to_string(indices[i]) + " among its " + what + ", but there are " +
                        std::to_string(vertices) + ": they count from 0",
                    Element::face(i / 3));
      }
      result[i / 3][i % 3] = static_cast<Index>(indices[i]);
    }
    return result;
  }

  template <class Vector>
  void require_usable(const Vector& place, const char* what, Index vertex, std::size_t m) const {
    if (place.allFinite() && place.cwiseAbs().maxCoeff() <= kFarthest) return;
    const char* const why = place.allFinite()
                                ? " is beyond 1e100, where areas are no numbers: scale it"
                                : " is infinite or not a number";
    throw Error(Fault::kNonFinite,
                std::string("the ") + what + " of vertex " + std::to_string(vertex) +
                    of_mesh(m, headers_.size()) + why,
                Element::vertex(static_cast<std::uint64_t>(vertex)));
  }

  /// Coordinates whose products of three, times any number of texels, are finite.
  static constexpr double kFarthest = 1e100;
  static constexpr Index kMostPages = 999;  // of the option max-pages, counted from 0

  const std::vector<beltrami_uv_mesh>& headers_;
  const Work& work_;
};

}  // namespace

OnPages on_pages(const PackedMeshes& packed) {
  const PackedUvs& result = packed.result;
  return {result.pages,
          result.outcome,
          packed.faces,
          result.uvs,
          result.chart_of_face,
          result.certificate,
          result.single_certificate,
          packed.seconds,
          packed.cpu_seconds};
}

OnPages on_pages(const Unwrapped& unwrapped) {
  const Atlas& atlas = unwrapped.atlas;
  return {*atlas.pages,
          atlas.outcome,
          atlas.faces,
          atlas.uvs,
          atlas.chart_of_face,
          atlas.certificate,
          atlas.single_certificate,
          unwrapped.seconds,
          unwrapped.cpu_seconds};
}

std::vector<beltrami_uv_mesh> read_uv_headers(const beltrami_uv_mesh* const* meshes,
                                              std::uint64_t count) {
  if (meshes == nullptr) refuse("meshes is NULL");
  if (count == 0) throw Error(Fault::kEmpty, "there are no meshes: there is nothing to pack");
  std::vector<beltrami_uv_mesh> headers;
  std::uint64_t uvs = 0, faces = 0;
  for (std::uint64_t m = 0; m < count; ++m) {
    headers.push_back(read_sized(meshes[m], "a mesh"));
    const beltrami_uv_mesh& header = headers.back();
    if (header.flags != 0) refuse("the field `flags` of a mesh is not 0");
    if (header.uv_count == 0 || header.face_count == 0) {
      throw Error(Fault::kEmpty, "mesh " + std::to_string(m) +
                                     " has no UV vertices or no faces: there is nothing to pack");
    }
    if (is_given(header.positions) != is_given(headers.front().positions)) {
      refuse("some meshes have positions, and some have none: give them with all, or with none");
    }
    if (is_given(header.page_labels) != is_given(headers.front().page_labels)) {
      refuse("some meshes have page labels, and some have none: give them with all, or with none");
    }
    if (is_given(header.page_labels) && is_given(header.kept_pages)) {
      refuse("page labels do not go with charts that stay: leave out one of them");
    }
    uvs += std::min(header.uv_count, kMaxVertices + 1);
    faces += std::min(header.face_count, kMaxFaces + 1);
    if (uvs > kMaxVertices || faces > kMaxFaces || header.vertex_count > kMaxVertices) {
      refuse("there are more than " + std::to_string(kMaxVertices) + " vertices or " +
             std::to_string(kMaxFaces) + " faces: pack fewer at once");
    }
  }
  return headers;
}

PackedMeshes pack_meshes(const std::vector<beltrami_uv_mesh>& headers, const PackOptions& options,
                         bool float32, const Work& work) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  PackedMeshes packed;
  UvMesh mesh = Reader(headers, work.named("read")).read(packed);
  try {
    packed.result = pack_uvs(mesh, options, float32, work);
  } catch (const Error& error) {
    if (error.element().kind != ElementKind::kFace) throw;
    std::uint64_t face = error.element().index;
    std::size_t m = 0;
    for (; face >= headers[m].face_count; ++m) face -= headers[m].face_count;
    throw Error(error.fault(),
                "face " + std::to_string(face) + of_mesh(m, headers.size()) + ": " + error.what(),
                Element::face(face));
  }
  packed.faces = std::move(mesh.faces);
  packed.seconds = wall_seconds() - wall;
  packed.cpu_seconds = cpu_seconds() - cpu;
  return packed;
}

}  // namespace beltrami
