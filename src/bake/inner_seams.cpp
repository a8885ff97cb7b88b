#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "bake/image.h"
#include "bake/page.h"
#include "base/interrupt.h"

namespace beltrami {
namespace {

using Corner = std::array<double, 2>;

/// 0 and -0 are the same coordinate: exporters give both for one point.
Corner without_sign_of_zero(const Corner& corner) {
  return {corner[0] + 0.0, corner[1] + 0.0};
}

/// A side of a triangle.
struct SideOfTriangle {
  std::array<Corner, 2> ends;   // on the new page, the lesser first
  std::array<Corner, 2> shown;  // the same on the old one
  std::uint32_t page = 0;       // the old one
  std::size_t triangle = 0, corner = 0;
};

}  // namespace

std::vector<std::uint8_t> inner_seams(std::span<const UvTriangle> triangles,
                                      std::span<const SourceTriangle> sources) {
  std::vector<SideOfTriangle> sides;
  sides.reserve(3 * triangles.size());
  PollSometimes poll;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    poll();
    for (std::size_t k = 0; k < 3; ++k) {
      std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      if (triangles[t][b] < triangles[t][a]) std::swap(a, b);
      sides.push_back(
          {{without_sign_of_zero(triangles[t][a]), without_sign_of_zero(triangles[t][b])},
           {without_sign_of_zero(sources[t].uvs[a]), without_sign_of_zero(sources[t].uvs[b])},
           sources[t].page,
           t,
           k});
    }
  }
  sort_interruptibly(
      sides.begin(), sides.end(), [](const SideOfTriangle& a, const SideOfTriangle& b) {
        return std::tie(a.ends, a.triangle, a.corner) < std::tie(b.ends, b.triangle, b.corner);
      });
  std::vector<std::uint8_t> seams(triangles.size(), 0);
  for (std::size_t i = 1; i < sides.size(); ++i) {
    poll();
    const SideOfTriangle &a = sides[i - 1], &b = sides[i];
    if (a.ends != b.ends || (a.shown == b.shown && a.page == b.page)) continue;
    for (const SideOfTriangle* side : {&a, &b}) {
      seams[side->triangle] = static_cast<std::uint8_t>(seams[side->triangle] | 1u << side->corner);
    }
  }
  return seams;
}

}  // namespace beltrami
