// The barrier between boundary parts: its derivatives, what it sees, and when parts touch.
#include "descend/contact.h"

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/orientation.h"
#include "support/disks.h"

namespace beltrami {
namespace {

using disks::Random;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A polygon through some of the vertices, in some order; counter-clockwise.
struct Polygon {
  std::vector<Index> loop;
  std::vector<double> lengths;
  std::vector<Vec2> uvs;

  std::size_t size() const { return loop.size(); }
  const Vec2& corner(std::size_t i) const { return uvs[loop[i % size()]]; }
  BoundaryContact contact() const { return {loop, lengths, lengths}; }
};

/// Through these corners, numbered as they come; the surface is as long as the polygon.
Polygon through(const std::vector<Vec2>& corners) {
  Polygon polygon;
  polygon.uvs = corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    polygon.loop.push_back(static_cast<Index>(i));
    polygon.lengths.push_back((corners[(i + 1) % corners.size()] - corners[i]).norm());
  }
  return polygon;
}

/// The same with its vertices numbered at random, and some that are not on the boundary.
Polygon shuffled(const Polygon& polygon, Random& random) {
  const std::size_t count = polygon.size();
  std::vector<Index> number(count + 3);
  std::iota(number.begin(), number.end(), 0);
  for (std::size_t i = number.size(); i > 1; --i) {
    std::swap(number[i - 1], number[static_cast<std::size_t>(random.below(static_cast<int>(i)))]);
  }
  Polygon result;
  result.uvs.assign(number.size(), Vec2(0.1, 0.2));
  const std::size_t first = static_cast<std::size_t>(random.below(static_cast<int>(count)));
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = (first + k) % count;
    result.loop.push_back(number[i]);
    result.lengths.push_back(polygon.lengths[i]);
    result.uvs[number[i]] = polygon.corner(i);
  }
  return result;
}

/// Spikes and notches around the origin.
Polygon star(int corners, Random& random) {
  std::vector<Vec2> places;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * (i + random.between(-0.4, 0.4)) / corners;
    const double radius = random.between(0.3, 1);
    places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  Polygon polygon = through(places);
  for (double& length : polygon.lengths) length *= random.between(0.5, 1.5);
  return polygon;
}

/// A block with a slot from the right whose ragged sides are `gap` apart.
Polygon slot(int along, double gap, Random& random) {
  const double n = along;
  std::vector<Vec2> places = {{n, 3}, {-3, 3}, {-3, -3}, {n, -3}};
  const auto side = [&](int i, double sign) {
    places.emplace_back(i + random.between(-0.4, 0.4), sign * gap * random.between(0.5, 1.5));
  };
  for (int i = along; i >= 0; --i) side(i, -1);
  for (int i = 0; i <= along; ++i) side(i, 1);
  return through(places);
}

/// In and near contact, and beyond the ends of edges.
std::vector<Polygon> crowded_polygons() {
  Random random(3);
  std::vector<Polygon> polygons;
  for (const int corners : {12, 25, 40, 90, 150}) polygons.push_back(star(corners, random));
  for (const double gap : {1.0, 0.3, 0.1, 1e-3}) polygons.push_back(slot(12, gap, random));
  for (Polygon& polygon : polygons) polygon = shuffled(polygon, random);
  return polygons;
}

using Pairs = std::vector<std::array<Index, 3>>;

Pairs pairs_of(const std::vector<Contact>& contacts) {
  Pairs pairs;
  for (const Contact& c : contacts) pairs.push_back({c.vertex, c.from, c.to});
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

double distance_to_edge(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 edge = b - a;
  const double share = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - share * edge).norm();
}

/// Of all vertices and edges that do not end there.
double least_distance(const Polygon& polygon, const std::vector<Vec2>& uvs) {
  double least = kNever;
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t e = 0; e < n; ++e) {
      if (e == i || (e + 1) % n == i) continue;
      least = std::min(least, distance_to_edge(uvs[polygon.loop[i]], uvs[polygon.loop[e]],
                                               uvs[polygon.loop[(e + 1) % n]]));
    }
  }
  return least;
}

std::vector<Vec2> along(const std::vector<Vec2>& uvs, const std::vector<Vec2>& direction,
                        double t) {
  std::vector<Vec2> moved(uvs.size());
  for (std::size_t v = 0; v < uvs.size(); ++v) moved[v] = uvs[v] + t * direction[v];
  return moved;
}

// ---- The barrier ----------------------------------------------------------------------------

TEST(BoundaryContact, HasTheGradientOfItsEnergy) {
  constexpr double kStrength = 0.7;
  int pressed = 0;
  for (Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    std::vector<Vec2>& uvs = polygon.uvs;
    std::vector<Vec2> gradient(uvs.size(), Vec2(1, 2));
    const double energy = contact.energy(uvs);
    EXPECT_NEAR(contact.add_gradient(uvs, kStrength, gradient), energy, 1e-14 * energy);
    double greatest = 0;
    for (Vec2& g : gradient) greatest = std::max(greatest, (g -= Vec2(1, 2)).norm());
    pressed += greatest > 0;
    const double h = 1e-5 * least_distance(polygon, uvs);
    for (std::size_t v = 0; v < uvs.size(); ++v) {
      for (int axis = 0; axis < 2; ++axis) {
        const double place = uvs[v][axis];
        uvs[v][axis] = place + h;
        const double ahead = contact.energy(uvs);
        uvs[v][axis] = place - h;
        const double behind = contact.energy(uvs);
        uvs[v][axis] = place;
        EXPECT_NEAR(kStrength * (ahead - behind) / (2 * h), gradient[v][axis], 1e-5 * greatest)
            << polygon.size() << " corners, vertex " << v;
      }
    }
  }
  EXPECT_GE(pressed, 5);
}

TEST(BoundaryContact, ModelsHaveTheGradientAndAPositiveSemidefiniteHessian) {
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    std::vector<Vec2> expected(polygon.uvs.size(), Vec2::Zero()), sum = expected;
    contact.add_gradient(polygon.uvs, 1, expected);
    double greatest = 0;
    for (const Vec2& g : expected) greatest = std::max(greatest, g.norm());
    // With a margin: pairs that are not in contact add nothing.
    for (const Contact& c : contact.find(polygon.uvs, 1.5)) {
      const FaceModel model = contact_model(c, polygon.uvs, false);
      const FaceModel stuck = contact_model(c, polygon.uvs, true);
      EXPECT_EQ(stuck.gradient, model.gradient);
      const double size = stuck.hessian.norm();
      for (const Matrix6& hessian : {model.hessian, Matrix6(stuck.hessian - model.hessian)}) {
        EXPECT_LE((hessian - hessian.transpose()).norm(), 1e-14 * size);
        const Eigen::SelfAdjointEigenSolver<Matrix6> solver(hessian, Eigen::EigenvaluesOnly);
        EXPECT_GE(solver.eigenvalues().minCoeff(), -1e-13 * size);
      }
      const std::array<Index, 3> ends = {c.vertex, c.from, c.to};
      for (int k = 0; k < 3; ++k) sum[ends[k]] += model.gradient.segment<2>(2 * k);
    }
    for (std::size_t v = 0; v < sum.size(); ++v) {
      EXPECT_LE((sum[v] - expected[v]).norm(), 1e-12 * greatest);
    }
  }
}

/// A square with a slot of width `gap` from its upper side to its middle, in steps of a quarter.
Polygon narrow_slot(double gap) {
  const double g = 0.5 * gap;
  return through({{-1, -1},
                  {1, -1},
                  {1, 1},
                  {g, 1},
                  {g, 0.75},
                  {g, 0.5},
                  {g, 0.25},
                  {0, 0},
                  {-g, 0.25},
                  {-g, 0.5},
                  {-g, 0.75},
                  {-g, 1},
                  {-1, 1}});
}

TEST(BoundaryContact, PressesTheMoreTheNearerPartsAre) {
  double before = 0;
  for (const double gap : {0.3, 0.1, 1e-2, 1e-3, 1e-6}) {
    const Polygon polygon = narrow_slot(gap);
    const double energy = polygon.contact().energy(polygon.uvs);
    EXPECT_GT(energy, before) << gap;
    EXPECT_TRUE(std::isfinite(energy)) << gap;
    before = energy;
  }
  const Polygon near = narrow_slot(1e-6), nearer = narrow_slot(1e-7);
  EXPECT_NEAR(nearer.contact().energy(nearer.uvs) / near.contact().energy(near.uvs), 10, 0.1);
}

TEST(BoundaryContact, IsZeroBeyondItsReach) {
  const Polygon wide = narrow_slot(1.5);
  EXPECT_EQ(wide.contact().energy(wide.uvs), 0);
  EXPECT_TRUE(wide.contact().find(wide.uvs).empty());
  // However long the edges, points that are near along the boundary are near by nature.
  for (const int corners : {3, 4, 7, 50}) {
    std::vector<Vec2> places;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      places.emplace_back(std::cos(angle), std::sin(angle));
    }
    const Polygon round = through(places);
    EXPECT_EQ(round.contact().energy(round.uvs), 0) << corners;
  }
}

TEST(BoundaryContact, IsInfiniteWherePartsTouch) {
  // A vertex in the middle of an edge, and two vertices at the same place.
  const Polygon on_edge = through({{0, 0}, {4, 0}, {4, 4}, {3, 4}, {2, 0}, {1, 4}, {0, 4}});
  const Polygon on_vertex =
      through({{0, 0}, {2, 0}, {4, 0}, {4, 4}, {3, 4}, {2, 0}, {1, 4}, {0, 4}});
  for (const Polygon& polygon : {on_edge, on_vertex, narrow_slot(0)}) {
    // Scales of their own: what matters here is not the reach.
    const std::vector<double> scales(polygon.size(), 1);
    const BoundaryContact contact(polygon.loop, polygon.lengths, scales);
    ASSERT_FALSE(contact.is_simple(polygon.uvs));
    EXPECT_EQ(contact.energy(polygon.uvs), kNever) << polygon.size();
    std::vector<Vec2> unused(polygon.uvs.size(), Vec2::Zero());
    EXPECT_EQ(contact.add_gradient(polygon.uvs, 1, unused), kNever) << polygon.size();
  }
}

TEST(BoundaryContact, SeesNothingThroughTheInside) {
  for (const double height : {0.5, 1e-3, 1e-8}) {
    std::vector<Vec2> places;
    for (int i = 0; i <= 20; ++i) places.emplace_back(i, 0);
    for (int i = 20; i >= 0; --i) places.emplace_back(i, height);
    const Polygon strip = through(places);
    EXPECT_TRUE(strip.contact().find(strip.uvs).empty()) << height;
    EXPECT_EQ(strip.contact().energy(strip.uvs), 0) << height;
    std::reverse(places.begin(), places.end());
    const Polygon hole = through(places);  // now the same gap is outside
    EXPECT_GT(hole.contact().energy(hole.uvs), 0) << height;
  }
}

TEST(BoundaryContact, PressesPartsApart) {
  for (const double gap : {0.05, 1e-2, 1e-5}) {
    const Polygon polygon = narrow_slot(gap);
    std::vector<Vec2> gradient(polygon.uvs.size(), Vec2::Zero());
    polygon.contact().add_gradient(polygon.uvs, 1, gradient);
    for (const std::size_t v : {4, 5, 6}) {
      EXPECT_LT(gradient[v].x(), 0) << gap;  // the right side, to the right
      EXPECT_GT(gradient[14 - v].x(), 0) << gap;
    }
    Vec2 force = Vec2::Zero();
    for (const Vec2& g : gradient) force += g;
    EXPECT_LE(force.norm(), 1e-9 * gradient[5].norm());
  }
}

// ---- Which parts are near each other --------------------------------------------------------

TEST(BoundaryContact, FindsThePairsThatASearchOfAllPairsFinds) {
  int found = 0;
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    // With so wide a margin every pair but those behind an edge is a candidate.
    const std::vector<Contact> all = contact.find(polygon.uvs, 1e6);
    for (const double margin : {1.0, 1.5}) {
      Pairs expected;
      for (const Contact& c : all) {
        const Vec2 &p = polygon.uvs[c.vertex], &a = polygon.uvs[c.from], &b = polygon.uvs[c.to];
        if (!(distance_to_edge(p, a, b) < margin * c.reach)) continue;
        if (margin == 1 && orientation(a, b, p) >= 0) continue;
        expected.push_back({c.vertex, c.from, c.to});
      }
      std::sort(expected.begin(), expected.end());
      const std::vector<Contact> contacts = contact.find(polygon.uvs, margin);
      EXPECT_EQ(pairs_of(contacts), expected) << polygon.size() << ' ' << margin;
      for (const Contact& c : contacts) {
        const double share =
            distance_to_edge(polygon.uvs[c.vertex], polygon.uvs[c.from], polygon.uvs[c.to]) /
            c.reach;
        EXPECT_NEAR(share_of_reach(c, polygon.uvs), share, 1e-12);
        EXPECT_LT(share, margin);
      }
      found += static_cast<int>(contacts.size());
    }
    // Nothing is left out: each pair in front of an edge is among the candidates.
    std::size_t in_front = 0, candidates = 0;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t e = 0; e < n; ++e) {
        if (e == i || (e + 1) % n == i) continue;
        in_front += orientation(polygon.corner(e), polygon.corner(e + 1), polygon.corner(i)) < 0;
      }
    }
    for (const Contact& c : all) {
      candidates += orientation(polygon.uvs[c.from], polygon.uvs[c.to], polygon.uvs[c.vertex]) < 0;
    }
    EXPECT_EQ(candidates, in_front) << polygon.size();
  }
  EXPECT_GT(found, 200);
}

TEST(BoundaryContact, ListsPairsInTheOrderOfTheLoop) {
  for (const Polygon& polygon : crowded_polygons()) {
    std::vector<std::size_t> position(polygon.uvs.size());
    for (std::size_t i = 0; i < polygon.size(); ++i) position[polygon.loop[i]] = i;
    std::vector<std::pair<std::size_t, std::size_t>> order;
    for (const Contact& c : polygon.contact().find(polygon.uvs)) {
      order.emplace_back(position[c.vertex], position[c.from]);
    }
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  }
}

TEST(BoundaryContact, IsTheSameInEveryPlaceAndNumbering) {
  Random random(4);
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    const double energy = contact.energy(polygon.uvs);
    std::vector<Vec2> gradient(polygon.uvs.size(), Vec2::Zero()), turned_gradient = gradient;
    contact.add_gradient(polygon.uvs, 1, gradient);
    double greatest = 0;
    for (const Vec2& g : gradient) greatest = std::max(greatest, g.norm());

    const Eigen::Rotation2Dd turn(0.7);
    std::vector<Vec2> turned;
    for (const Vec2& w : polygon.uvs) turned.push_back(turn * w + Vec2(3, -2));
    EXPECT_NEAR(contact.add_gradient(turned, 1, turned_gradient), energy, 1e-8 * energy);
    EXPECT_EQ(pairs_of(contact.find(turned)), pairs_of(contact.find(polygon.uvs)));
    for (std::size_t v = 0; v < gradient.size(); ++v) {
      EXPECT_LE((turned_gradient[v] - turn * gradient[v]).norm(), 1e-7 * greatest);
    }

    const Polygon other = shuffled(polygon, random);
    EXPECT_NEAR(other.contact().energy(other.uvs), energy, 1e-11 * energy);
    EXPECT_EQ(other.contact().find(other.uvs).size(), contact.find(polygon.uvs).size());
  }
}

TEST(BoundaryContact, FitsItsReachToTinyMaps) {
  // A map at the scale s has the energy s^-2, and its parts are s times as far apart.
  Random random(5);
  const Polygon polygon = slot(12, 0.3, random);
  BoundaryContact contact = polygon.contact();
  contact.fit(polygon.uvs, 2);
  const Pairs expected = pairs_of(contact.find(polygon.uvs));
  const double reach = contact.find(polygon.uvs).front().reach;
  ASSERT_FALSE(expected.empty());
  for (const double scale : {1e-1, 1e-3, 1e-6}) {
    std::vector<Vec2> tiny = polygon.uvs;
    for (Vec2& w : tiny) w *= scale;
    contact.fit(tiny, 2 / (scale * scale));
    EXPECT_EQ(pairs_of(contact.find(tiny)), expected) << scale;
    EXPECT_NEAR(contact.find(tiny).front().reach, scale * reach, 1e-9 * scale * reach);
  }
}

TEST(BoundaryContact, NeverReachesFartherThanAtLeastEnergy) {
  const Polygon polygon = narrow_slot(0.2);
  BoundaryContact contact = polygon.contact();
  const double reach = contact.find(polygon.uvs).front().reach;
  for (const double energy : {2.0, 1.0, 0.01}) {
    contact.fit(polygon.uvs, energy);
    EXPECT_EQ(contact.find(polygon.uvs).front().reach, reach) << energy;
  }
}

TEST(BoundaryContact, CapsTheNumberOfPairs) {
  // A hundredth of the size of its surface, which its energy does not tell: all is near to all.
  Random random(6);
  Polygon polygon = star(300, random);
  for (double& length : polygon.lengths) length *= 100;
  BoundaryContact contact = polygon.contact();
  const std::size_t before = contact.find(polygon.uvs).size();
  contact.fit(polygon.uvs, 2);
  const std::size_t after = contact.find(polygon.uvs).size();
  EXPECT_LE(after, 100 * polygon.size());
  EXPECT_LT(4 * after, before);
  EXPECT_GT(after, 0u);
}

// ---- When parts touch -----------------------------------------------------------------------

std::vector<Vec2> random_direction(std::size_t count, double size, Random& random) {
  std::vector<Vec2> direction;
  for (std::size_t v = 0; v < count; ++v) direction.push_back(size * random.vec2());
  return direction;
}

TEST(FirstTouch, IsWhereTheBoundaryCeasesToBeSimple) {
  constexpr int kSamples = 200;
  Random random(7);
  int touching = 0, free = 0;
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    for (const double size : {0.02, 0.3, 2.0}) {
      const auto direction = random_direction(polygon.uvs.size(), size, random);
      const double touch = contact.first_touch(polygon.uvs, direction, 1);
      for (int k = 1; k <= kSamples; ++k) {
        const double t = 1.0 * k / kSamples;
        const bool simple = contact.is_simple(along(polygon.uvs, direction, t));
        EXPECT_TRUE(simple || t >= touch * (1 - 1e-9)) << "later than at " << t;
      }
      (touch < 1 ? touching : free) += 1;
      if (touch == 1) continue;
      EXPECT_GT(touch, 0);
      EXPECT_LE(least_distance(polygon, along(polygon.uvs, direction, touch)), 1e-9)
          << "nothing touches at " << touch;
      EXPECT_FALSE(contact.is_simple(along(polygon.uvs, direction, touch * (1 + 1e-6))));
    }
  }
  EXPECT_GT(touching, 5);
  EXPECT_GT(free, 2);
}

TEST(FirstTouch, IsTheLimitWhereNothingTouches) {
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    const std::vector<Vec2> still(polygon.uvs.size(), Vec2::Zero());
    const std::vector<Vec2> together(polygon.uvs.size(), Vec2(5, -3));
    for (const double limit : {0.1, 1.0, 1.25}) {
      EXPECT_EQ(contact.first_touch(polygon.uvs, still, limit), limit);
      EXPECT_EQ(contact.first_touch(polygon.uvs, together, limit), limit);
      EXPECT_EQ(contact.first_touch(polygon.uvs, polygon.uvs, limit), limit);  // it grows
    }
  }
}

TEST(FirstTouch, FindsSidesThatCloseAndCornersThatMeet) {
  const Polygon polygon = narrow_slot(0.2);
  const BoundaryContact contact = polygon.contact();
  // The right side of the slot moves left as a whole: parallel edges meet all at once, at 1/2.
  std::vector<Vec2> direction(polygon.uvs.size(), Vec2::Zero());
  for (const std::size_t v : {2, 3, 4, 5, 6}) direction[v] = {-0.4, 0};
  EXPECT_NEAR(contact.first_touch(polygon.uvs, direction, 1), 0.5, 1e-12);
  EXPECT_EQ(contact.first_touch(polygon.uvs, direction, 0.25), 0.25);
  // Two tips on their line towards each other.
  const Polygon tips = through({{-3, -2},
                                {3, -2},
                                {3, 1},
                                {1, 0.5},
                                {2, 0},
                                {2, -1},
                                {-2, -1},
                                {-2, 0},
                                {-1, 0.5},
                                {-3, 1}});
  std::vector<Vec2> towards(tips.uvs.size(), Vec2::Zero());
  towards[3] = {-2, 0};
  towards[8] = {2, 0};
  ASSERT_TRUE(tips.contact().is_simple(tips.uvs));
  EXPECT_NEAR(tips.contact().first_touch(tips.uvs, towards, 1), 0.5, 1e-9);
}

TEST(FirstTouch, FindsAnEdgeThatFoldsOntoTheNext) {
  // A tip that closes: its two edges fall together at 1.
  const Polygon polygon = through({{0, 0}, {4, 0}, {4, 2}, {1, 1}, {4, 4}, {0, 4}});
  std::vector<Vec2> direction(polygon.uvs.size(), Vec2::Zero());
  direction[4] = {0, -2};
  const double touch = polygon.contact().first_touch(polygon.uvs, direction, 2);
  EXPECT_NEAR(touch, 1, 1e-12);
  EXPECT_TRUE(polygon.contact().is_simple(along(polygon.uvs, direction, 0.999 * touch)));
}

TEST(FirstTouch, IsTheSameInAnyUnit) {
  Random random(8);
  for (const Polygon& polygon : crowded_polygons()) {
    const BoundaryContact contact = polygon.contact();
    const auto direction = random_direction(polygon.uvs.size(), 1, random);
    const double touch = contact.first_touch(polygon.uvs, direction, 1);
    for (const double unit : {0x1p-40, 0x1p40}) {
      std::vector<Vec2> uvs = polygon.uvs, way = direction;
      for (Vec2& w : uvs) w *= unit;
      for (Vec2& d : way) d *= unit;
      EXPECT_EQ(contact.first_touch(uvs, way, 1), touch) << unit;
    }
  }
}

}  // namespace
}  // namespace beltrami
