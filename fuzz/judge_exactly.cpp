// Exact verdicts against rational numbers: orientations, overlaps of an atlas, crossings of a loop.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "exact/atlas_certificate.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "target.h"
#include "tests/exact/rational_overlaps.h"

namespace beltrami::fuzz {
namespace {

using Provider = FuzzedDataProvider;

/// Small whole numbers, so that points coincide, perhaps a few units of the last place aside; or
/// any number of which products are in the range of doubles.
double coordinate(Provider& data) {
  const int kind = data.ConsumeIntegralInRange(0, 15);
  const double whole = data.ConsumeIntegralInRange(-4, 4);
  if (kind < 10) return whole;
  if (kind < 14) {
    const int units = data.ConsumeIntegralInRange(-2, 2);
    return std::bit_cast<double>(std::bit_cast<std::int64_t>(whole + 0.5) + units);
  }
  const double any = data.ConsumeFloatingPoint<double>();
  return std::isfinite(any) && std::abs(any) < 1e60 && std::abs(any) > 1e-60 ? any : whole / 3;
}

Vec2 point(Provider& data) {
  const double x = coordinate(data);
  return {x, coordinate(data)};
}

RationalPoint rational(const Vec2& p) {
  return {Rational(p.x()), Rational(p.y())};
}

int sign_by_force(const Vec2& a, const Vec2& b, const Vec2& c) {
  return static_cast<int>(CGAL::sign(twice_area(rational(a), rational(b), rational(c))));
}

bool in_box(const Vec2& a, const Vec2& b, const Vec2& p) {
  return std::min(a.x(), b.x()) <= p.x() && p.x() <= std::max(a.x(), b.x()) &&
         std::min(a.y(), b.y()) <= p.y() && p.y() <= std::max(a.y(), b.y());
}

/// Whether closed segments have a point in common, but for an end that `shared` says is one.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int c_side = sign_by_force(a, b, c), d_side = sign_by_force(a, b, d);
  const int a_side = sign_by_force(c, d, a), b_side = sign_by_force(c, d, b);
  if (c_side * d_side < 0 && a_side * b_side < 0) return true;
  return (c_side == 0 && in_box(a, b, c)) || (d_side == 0 && in_box(a, b, d)) ||
         (a_side == 0 && in_box(c, d, a)) || (b_side == 0 && in_box(c, d, b));
}

void judge_loop(const std::vector<Vec2>& uvs) {
  const Index n = size_of(uvs);
  std::vector<Index> loop;
  for (Index i = 0; i < n; ++i) loop.push_back(i);
  bool simple = true;
  for (Index i = 0; i < n; ++i) {
    const Vec2 &a = uvs[i], &b = uvs[(i + 1) % n];
    if (a == b) simple = false;
    for (Index j = i + 1; j < n; ++j) {
      const Vec2 &c = uvs[j], &d = uvs[(j + 1) % n];
      if (j == i + 1 || (i == 0 && j == n - 1)) {
        // Neighbours have an end in common: more only where one runs back along the other.
        const Vec2 &from = j == i + 1 ? a : b, &middle = j == i + 1 ? b : a,
                   &to = j == i + 1 ? d : c;
        if (sign_by_force(from, middle, to) == 0 &&
            (in_box(from, middle, to) || in_box(middle, to, from))) {
          simple = false;
        }
      } else if (meet(a, b, c, d)) {
        simple = false;
      }
    }
  }
  promise(is_simple(loop, uvs) == simple, "a loop is simple where rational numbers say so");
  promise(find_crossings(loop, uvs).empty() == simple, "crossings are found where there are any");
}

void judge_atlas(Provider& data) {
  UvFaces atlas;
  const Index count = data.ConsumeIntegralInRange(3, 9);
  for (Index i = 0; i < count; ++i) atlas.uvs.push_back(point(data));
  const int faces = data.ConsumeIntegralInRange(1, 8);
  for (int f = 0; f < faces; ++f) {
    Triangle face{};
    for (Index& v : face) v = data.ConsumeIntegralInRange<Index>(0, count - 1);
    if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
    atlas.faces.push_back(face);
  }
  if (atlas.faces.empty()) return;
  Orientations by_force;
  for (Index f = 0; f < size_of(atlas.faces); ++f) {
    const int sign = rational_sign(atlas, f);
    ++(sign > 0 ? by_force.positive : sign < 0 ? by_force.negative : by_force.degenerate);
  }
  const AtlasCertificate verdict = certify_atlas(atlas.faces, atlas.uvs, {}, Work());
  promise(verdict.orientations.positive == by_force.positive &&
              verdict.orientations.negative == by_force.negative &&
              verdict.orientations.degenerate == by_force.degenerate,
          "orientations are those of rational numbers");
  const bool overlap = !overlaps_by_force(atlas).empty();
  promise((verdict.overlaps.faces > 0) == overlap, "overlaps are those of rational numbers");
}

}  // namespace

void run_one(std::string_view bytes) {
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const Vec2 a = point(data), b = point(data), c = point(data);
  promise(orientation(a, b, c) == sign_by_force(a, b, c), "a turn is that of rational numbers");
  judge_atlas(data);
  std::vector<Vec2> loop;
  const int length = data.ConsumeIntegralInRange(3, 8);
  for (int i = 0; i < length; ++i) loop.push_back(point(data));
  judge_loop(loop);
}

}  // namespace beltrami::fuzz
