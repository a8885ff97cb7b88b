#include "exact/atlas_certificate.h"

#include <algorithm>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "exact/covering.h"
#include "exact/orientation.h"
#include "exact/uv_boundary.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;

bool is_excepted(const AtlasRules& rules, Index f) {
  return !rules.excepted.empty() && rules.excepted[f];
}

std::vector<std::int8_t> judged_signs(const std::vector<Triangle>& faces,
                                      const std::vector<Vec2>& uvs, const AtlasRules& rules,
                                      const Work& work) {
  std::vector<std::int8_t> signs(faces.size(), 0);
  parallel_for(work, size_of(faces), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      if (is_excepted(rules, f)) continue;
      const auto [a, b, c] = faces[f];
      signs[f] = static_cast<std::int8_t>(orientation(uvs[a], uvs[b], uvs[c]));
    }
  });
  return signs;
}

/// Whether each face is in a chart all of whose faces are negative; their number.
std::vector<bool> mirrored_faces(const SignedTriangles& triangles, const Work& work,
                                 std::int64_t& charts) {
  const std::vector<Index> chart = uv_charts(triangles, work);
  std::vector<bool> has_positive;
  PollSometimes poll;
  for (Index f = 0; f < size_of(chart); ++f) {
    poll();
    if (chart[f] == kNone) continue;
    if (chart[f] == size_of(has_positive)) has_positive.push_back(false);
    if (triangles.signs[f] > 0) has_positive[chart[f]] = true;
  }
  charts = std::count(has_positive.begin(), has_positive.end(), false);
  std::vector<bool> mirrored(chart.size(), false);
  for (Index f = 0; f < size_of(chart); ++f) {
    poll();
    mirrored[f] = chart[f] != kNone && !has_positive[chart[f]];
  }
  return mirrored;
}

void count_signs(const SignedTriangles& triangles, const AtlasRules& rules, const Work& work,
                 AtlasCertificate& result) {
  const std::vector<Index> bad = parallel_filter(work, size_of(triangles.faces), kGrain,
                                                 [&](Index f) { return triangles.signs[f] <= 0; });
  std::vector<bool> mirrored;
  if (rules.allow_mirrored && !bad.empty()) {
    mirrored = mirrored_faces(triangles, work, result.mirrored_charts);
  }
  Orientations& counts = result.orientations;
  counts.positive = size_of(triangles.faces) - size_of(bad);
  PollSometimes poll;
  for (const Index f : bad) {
    poll();
    if (is_excepted(rules, f)) {
      ++result.excepted_faces;
    } else if (!mirrored.empty() && mirrored[f]) {
      ++result.mirrored_faces;
      ++counts.positive;
    } else {
      ++(triangles.signs[f] < 0 ? counts.negative : counts.degenerate);
      if (counts.first_bad_face == kNone) counts.first_bad_face = f;
    }
  }
}

void count_not_finite(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                      AtlasCertificate& result, const Work& work) {
  const std::vector<Index> bad =
      parallel_filter(work, size_of(uvs), kGrain, [&](Index v) { return !uvs[v].allFinite(); });
  if (bad.empty()) return;
  std::vector<bool> used(uvs.size(), false);
  PollSometimes poll;
  for (const Triangle& face : faces) {
    poll();
    for (const Index v : face) used[v] = true;
  }
  for (const Index v : bad) {
    if (!used[v]) continue;
    ++result.not_finite;
    if (result.first_not_finite == kNone) result.first_not_finite = v;
  }
}

}  // namespace

AtlasCertificate certify_atlas(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs,
                               const AtlasRules& rules, const Work& work) {
  AtlasCertificate result;
  count_not_finite(faces, uvs, result, work);
  const SignedTriangles triangles{faces, uvs, judged_signs(faces, uvs, rules, work)};
  count_signs(triangles, rules, work, result);
  work.report(0.05);
  const UvBoundary boundary = uv_boundary(triangles, work);
  work.report(0.2);
  Index suspect = kNone;
  if (boundary.first_doubled != kNone) {
    suspect = boundary.edges[boundary.first_doubled].corner;
  } else {
    const Covering covering = sweep_covering(triangles, boundary.edges, work.part(0.2, 0.7));
    suspect = covering.doubled;
    result.touching_places = covering.touching_places;
    result.first_touching = covering.first_touching;
  }
  if (suspect != kNone) {
    result.overlaps =
        list_overlaps(triangles, boundary.edges, suspect / 3, rules.most_listed, work.part(0.7, 1));
  }
  work.report(1);
  return result;
}

}  // namespace beltrami
