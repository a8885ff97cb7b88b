// Charts of any form and scale on pages: inside them, and as far apart as asked for.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "pack/pack.h"
#include "target.h"
#include "tests/shapes/exact_triangles.h"

namespace beltrami::fuzz {
namespace {

using Provider = FuzzedDataProvider;
using shapes::Uv;

PackChart chart(Provider& data) {
  PackChart out;
  const int points = data.ConsumeIntegralInRange(3, 6);
  const bool tiny = data.ConsumeIntegralInRange(0, 15) == 0;
  for (int i = 0; i < points; ++i) {
    const double x = data.ConsumeIntegralInRange(-20, 20), y = data.ConsumeIntegralInRange(-20, 20);
    out.points.emplace_back(tiny ? Vec2(1e-9 * x, y) : Vec2(x, y));
  }
  const int faces = data.ConsumeIntegralInRange(1, 5);
  for (int f = 0; f < faces; ++f) {
    Triangle face{};
    for (Index& v : face) v = data.ConsumeIntegralInRange<Index>(0, points - 1);
    const auto at = [&](Index v) { return Uv{out.points[v].x(), out.points[v].y()}; };
    // The callers of the packer leave out what has no area.
    if (shapes::orientation(at(face[0]), at(face[1]), at(face[2])) != 0) out.faces.push_back(face);
  }
  // Nor do they have charts without a face.
  const Vec2 side(20, tiny ? 1e-9 : 1);
  const auto last = static_cast<Index>(points);
  out.points.insert(out.points.end(), {Vec2(0, 0), Vec2(side.x(), 0), Vec2(0, side.y())});
  out.faces.push_back({last, last + 1, last + 2});
  if (data.ConsumeIntegralInRange(0, 3) == 0) {
    out.scale = data.ConsumeFloatingPointInRange(0.01, 10.0);
  }
  return out;
}

PackOptions options(Provider& data) {
  PackOptions out;
  constexpr std::array kResolutions = {8, 8, 16, 16, 33, 64};
  out.resolution = data.PickValueInArray(kResolutions);
  out.margin = data.ConsumeIntegralInRange(0, 12) / 4.0;
  // Without a density many are tried: that takes most of the time.
  if (data.ConsumeIntegralInRange(0, 3) != 0) {
    out.texels_per_unit = data.ConsumeFloatingPointInRange(0.01, 2.0);
  }
  constexpr std::array kTurns = {1, 1, 4, 16};
  out.turns = data.PickValueInArray(kTurns);
  out.upright = data.ConsumeBool();
  constexpr std::array kBlocks = {1, 1, 2, 4};
  out.block = data.PickValueInArray(kBlocks);
  out.max_pages = data.ConsumeIntegralInRange(1, 3);
  out.effort = std::max(0, data.ConsumeIntegralInRange(-6, 1)) / 4.0;
  return out;
}

/// The triangles of a chart where it lies, in texels.
std::vector<std::array<Uv, 3>> placed(const PackChart& chart, const Packing& packing, Index c) {
  std::vector<std::array<Uv, 3>> out;
  const double density = packing.texels_per_unit * chart.scale;
  for (const Triangle& face : chart.faces) {
    std::array<Uv, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 p = packing.placements[c].place(chart.points[face[k]], density);
      corners[k] = {p.x(), p.y()};
    }
    out.push_back(corners);
  }
  return out;
}

double distance(const std::array<Uv, 3>& a, const std::array<Uv, 3>& b) {
  double least = 1e300;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      least = std::min(least, shapes::distance(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
  }
  return least;
}

/// Whether a point of `a` is inside `b`, whichever way `b` turns.
bool inside(const std::array<Uv, 3>& a, const std::array<Uv, 3>& b) {
  std::array<int, 3> sides{};
  for (std::size_t k = 0; k < 3; ++k) sides[k] = shapes::orientation(b[k], b[(k + 1) % 3], a[0]);
  return sides[0] != 0 && sides[0] == sides[1] && sides[1] == sides[2];
}

void judge(const std::vector<PackChart>& charts, const PackOptions& options,
           const Packing& packing) {
  constexpr double kRounding = 1e-3;  // texels
  promise(packing.placements.size() == charts.size(), "every chart has a place");
  std::map<Index, std::uint64_t> group_of_page;
  std::set<std::uint64_t> groups;
  std::vector<std::vector<std::array<Uv, 3>>> all;
  for (Index c = 0; c < size_of(charts); ++c) {
    const Index page = packing.placements[c].page;
    promise(page >= 0 && page < packing.pages, "every chart has a page");
    const std::uint64_t group = charts[c].group;
    groups.insert(group);
    promise(group_of_page.emplace(page, group).first->second == group, "groups share no page");
    all.push_back(placed(charts[c], packing, c));
    for (const auto& triangle : all.back()) {
      for (const Uv& p : triangle) {
        for (const double x : p) {
          promise(x >= options.margin / 2 - kRounding &&
                      x <= options.resolution - options.margin / 2 + kRounding,
                  "half the margin is left to the edges of the page");
        }
      }
    }
  }
  const auto most = static_cast<int>(groups.size()) * options.max_pages;
  promise(packing.pages >= 1 && packing.pages <= most, "no page is too many");
  for (std::size_t c = 0; c < all.size(); ++c) {
    for (std::size_t d = c + 1; d < all.size(); ++d) {
      if (packing.placements[c].page != packing.placements[d].page) continue;
      for (const auto& a : all[c]) {
        for (const auto& b : all[d]) {
          promise(!inside(a, b) && !inside(b, a), "no chart lies on another");
          promise(distance(a, b) >= options.margin - kRounding, "charts keep their margin");
        }
      }
    }
  }
}

}  // namespace

void run_one(std::string_view bytes) {
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const PackOptions how = options(data);
  const bool twice = data.ConsumeIntegralInRange(0, 3) == 0;
  std::vector<PackChart> charts;
  const int count = data.ConsumeIntegralInRange(1, 4);
  for (int i = 0; i < count; ++i) charts.push_back(chart(data));
  if (data.ConsumeIntegralInRange(0, 3) == 3) {
    for (std::size_t c = 0; c < charts.size(); ++c) charts[c].group = c % 2;
  }
  try {
    const Packing packing = pack_charts(charts, how, Work());
    judge(charts, how, packing);
    if (!twice) return;
    const Packing again = pack_charts(charts, how, Work(2));
    for (std::size_t c = 0; c < charts.size(); ++c) {
      promise(packing.placements[c].offset == again.placements[c].offset &&
                  packing.placements[c].turn == again.placements[c].turn,
              "two threads place charts where one does");
    }
  } catch (const Error& error) {
    promise(*error.what() != '\0', "a refusal has a sentence");
  }
}

}  // namespace beltrami::fuzz
