// Triangles of polygons, and the verdict on any atlas: no context, nothing kept.
#include <beltrami/beltrami.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "abi/buffers.h"
#include "abi/failure.h"
#include "abi/reports.h"
#include "abi/surface.h"
#include "admit/admit.h"
#include "admit/orient.h"
#include "admit/weld.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/atlas_certificate.h"

namespace beltrami {
namespace {

constexpr int kThreads = 1;  // a check takes no options, and threads must be asked for

/// Triangles over UV vertices: corners at one place, of the surface and of the plane, are one.
struct UvTriangles {
  std::vector<Triangle> faces;
  std::vector<Vec2> uvs;
};

/// `vertex`: per vertex of the surface the one that it counts as.
UvTriangles unite_corners(const LoadedSurface& surface, const std::vector<Vec2>& corner_uvs,
                          const std::vector<Index>& vertex) {
  struct Corner {
    Index vertex;
    double u, v;
    Index corner;
    auto key() const { return std::tie(vertex, u, v); }
  };
  std::vector<Corner> corners;
  corners.reserve(corner_uvs.size());
  for (Index c = 0; c < size_of(corner_uvs); ++c) {
    corners.push_back(
        {vertex[surface.polygons.corners[c]], corner_uvs[c].x(), corner_uvs[c].y(), c});
  }
  sort_interruptibly(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.corner < b.corner;
  });
  UvTriangles united;
  std::vector<Index> number(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || corners[i].key() != corners[i - 1].key()) {
      united.uvs.emplace_back(corners[i].u, corners[i].v);
    }
    number[corners[i].corner] = size_of(united.uvs) - 1;
  }
  for (const Triangle& triangle : surface.triangulation.triangles) {
    united.faces.push_back({number[triangle[0]], number[triangle[1]], number[triangle[2]]});
  }
  return united;
}

/// Turns triangles over that disagree with their chart.
void orient_charts(UvTriangles& united, const std::vector<bool>& excepted, const Work& work) {
  std::vector<Triangle> judged;
  std::vector<Index> number;
  for (Index f = 0; f < size_of(united.faces); ++f) {
    const auto [a, b, c] = united.faces[f];
    if (excepted[f] || a == b || b == c || c == a) continue;
    judged.push_back(united.faces[f]);
    number.push_back(f);
  }
  if (judged.empty()) return;
  Gluing gluing = glue(united.uvs, judged, std::vector<Index>(judged.size(), 0), {}, work);
  orient(judged, gluing.twin, {}, work);
  for (std::size_t i = 0; i < judged.size(); ++i) united.faces[number[i]] = judged[i];
}

beltrami_status judge(const beltrami_surface* theirs, bool allow_mirrored,
                      beltrami_atlas_certificate& report, std::uint64_t* pairs,
                      std::uint64_t capacity) {
  const beltrami_surface header = read_surface_header(theirs);
  const InterruptScope interruptible({nullptr, header.cancel, {}});
  const Work work(kThreads);
  const LoadedSurface surface = read_surface_to_check(header, work);
  const std::vector<Vec2> corner_uvs = read_corner_uvs(header, surface, work);
  const bool has_positions = header.positions.data != nullptr;
  UvTriangles united = unite_corners(
      surface, corner_uvs,
      has_positions ? weld(surface.positions, 0, work) : each_its_own(surface.vertex_count));
  AtlasRules rules;
  rules.allow_mirrored = allow_mirrored;
  rules.most_listed =
      static_cast<std::int64_t>(std::clamp<std::uint64_t>(capacity, 1, std::uint64_t{1} << 32));
  const std::vector<Triangle> triangles = triangles_of(surface);
  rules.excepted = has_positions ? faces_without_area(surface.positions, triangles, work)
                                 : std::vector<bool>(triangles.size(), false);
  orient_charts(united, rules.excepted, work);
  const AtlasCertificate found = certify_atlas(united.faces, united.uvs, rules, work);
  const auto face_of = [&](Index t) { return element_or_none(surface.face_of(t)); };
  report = describe_atlas(found);
  name_faces(report, face_of);
  const auto& listed = found.overlaps.first_faces;
  for (std::uint64_t i = 0; pairs != nullptr && i < capacity; ++i) {
    const bool is_one = i < listed.size();
    pairs[2 * i] = is_one ? face_of(listed[i][0]) : BELTRAMI_NO_ELEMENT;
    pairs[2 * i + 1] = is_one ? face_of(listed[i][1]) : BELTRAMI_NO_ELEMENT;
  }
  return found.injective() ? BELTRAMI_OK : BELTRAMI_NOT_INJECTIVE;
}

}  // namespace
}  // namespace beltrami

beltrami_status beltrami_triangulate(const beltrami_surface* surface, void* out, int32_t type,
                                     uint64_t stride, uint64_t* repeating) {
  beltrami::Failure unused;
  return beltrami::guarded(unused, [&] {
    const beltrami_surface header = beltrami::read_surface_header(surface);
    const beltrami::InterruptScope interruptible({nullptr, header.cancel, {}});
    const beltrami::LoadedSurface loaded =
        beltrami::read_surface_to_triangulate(header, beltrami::Work(beltrami::kThreads));
    beltrami::write_integers(beltrami::flat(loaded.triangulation.triangles), 3, out, type, stride);
    if (repeating != nullptr) {
      *repeating = beltrami::element_or_none(loaded.triangulation.first_repeating);
    }
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_check_atlas(const beltrami_surface* surface, int32_t allow_mirrored,
                                     beltrami_atlas_certificate* out, uint64_t* pairs,
                                     uint64_t capacity) {
  beltrami::Failure failure;
  beltrami_status status = beltrami::guarded(failure, [&] {
    beltrami::require_sized(out, "out");
    return BELTRAMI_OK;
  });
  if (status != BELTRAMI_OK) return status;
  beltrami_atlas_certificate report = beltrami::empty_atlas_certificate();
  status = beltrami::guarded(failure, [&] {
    return beltrami::judge(surface, allow_mirrored != 0, report, pairs, capacity);
  });
  if (status < 0) {
    report = beltrami::empty_atlas_certificate();
    report.error_element = failure.element();
    report.error_element_kind = failure.element_kind();
  }
  beltrami::write_sized(out, report);
  return status;
}
