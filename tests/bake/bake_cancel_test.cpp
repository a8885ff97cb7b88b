// How soon baking ends when it is cancelled: what is done between two polls.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/bake.h"
#include "bake/gutters.h"
#include "bake/image.h"
#include "bake/page.h"
#include "base/interrupt.h"
#include "base/vectors.h"
#include "base/work.h"
#include "support/polls.h"

namespace beltrami {
namespace {

constexpr int kSide = 256;

/// A square of two triangles in the plane, on all of a page, which shows an image of noise.
struct Square {
  std::vector<std::uint8_t> noise = std::vector<std::uint8_t>(std::size_t{kSide} * kSide);
  std::vector<std::uint8_t> pixels = noise;
  BakeProblem problem;

  Square() {
    for (std::size_t i = 0; i < noise.size(); ++i) {
      noise[i] = static_cast<std::uint8_t>(i * i % 251);
    }
    problem.images = {{noise.data(), kSide, kSide, 1, PixelType::kByte, kSide}};
    problem.side = kSide;
    problem.rings = kWholePage;
    // Not quite all of it, so that there are gutters.
    const UvTriangle lower = {{{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}}};
    const UvTriangle upper = {{{0.1, 0.1}, {0.9, 0.9}, {0.1, 0.9}}};
    for (const UvTriangle& uvs : {lower, upper}) {
      problem.new_uvs.push_back(uvs);
      problem.new_pages.push_back(0);
      problem.sources.push_back({0, uvs});
      for (const auto& [u, v] : uvs) {
        problem.positions.insert(problem.positions.end(), {u, v, 0});
      }
    }
  }

  BakeReport run() {
    const PageRoom room{pixels.data(), kSide, kSide, 1, PixelType::kByte};
    return bake(problem, {&room, 1}, {}, Work(1));
  }
};

TEST(BakeCancel, ItLooksAtEveryRowOfAPageAndOfItsGutters) {
  Square square;
  const std::int64_t polls = count_polls([&] { square.run(); });
  EXPECT_GE(polls, 2 * kSide);
  for (const std::int64_t last : {polls / 4, polls / 2, 3 * polls / 4, polls}) {
    EXPECT_THROW(count_polls([&] { square.run(); }, last), Cancelled) << last << " of " << polls;
  }
}

TEST(BakeCancel, ItLooksAtEveryRay) {
  Square square;
  square.problem.kind = ImageKind::kOcclusion;
  square.problem.rays = 8;
  std::uint64_t texels = 0;
  const std::int64_t polls = count_polls([&] { texels = square.run().texels.covered; });
  EXPECT_GT(texels, 40'000u);
  // Texels along the edges of the square send some of them alone.
  EXPECT_GE(polls, static_cast<std::int64_t>(7 * texels));
  EXPECT_THROW(count_polls([&] { square.run(); }, polls - 1), Cancelled);
}

TEST(BakeCancel, ItLooksAtEveryRowThatRaysFindASourceFor) {
  Square square;
  for (std::size_t t = 0; t < 2; ++t) {
    auto& places = square.problem.source_places.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      places[k] = Vec3(&square.problem.positions[9 * t + 3 * k]) + Vec3(0, 0, 0.1);
    }
  }
  square.problem.cage = 0.2;
  BakeReport report;
  const std::int64_t polls = count_polls([&] { report = square.run(); });
  EXPECT_EQ(report.texels.without_source, 0u);
  EXPECT_GE(polls, 2 * kSide);
}

}  // namespace
}  // namespace beltrami
