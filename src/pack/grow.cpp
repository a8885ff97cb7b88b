#include "pack/grow.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/interrupt.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "base/vectors.h"
#include "pack/blocks.h"
#include "pack/clearance.h"
#include "pack/edge_grid.h"
#include "pack/outline.h"
#include "pack/types.h"

namespace beltrami {
namespace {

/// Points of borders that may be moved in steps, at an effort of one: about a second.
constexpr double kPointSteps = 2e6;

/// What a step costs beside, in points; and what an edge does beside each block that is near.
constexpr double kPointsOfStep = 200, kPointsOfBlock = 0.1;

/// Blocks of all pages up to which they are followed: some ten megabytes.
constexpr std::int64_t kMostBlocks = 1 << 22;

/// Margins below this many texels leave no room for the steps to err.
constexpr double kLeastMargin = 1;

/// Texels: borders are thinned by so much, and distances held to so much.
constexpr double kHeld = 0.01;

/// Texels: how far a point may move in a step, and how far beyond the margin contacts are looked
/// for.
constexpr double kFurthest = 0.5;

/// Of the margin: by how much two charts come nearer when they are scaled.
constexpr double kNearer = 0.5;

/// Where a chart is: the place of its middle, and how it is turned.
struct Pose {
  Vec2 middle{0, 0}, turn{1, 0};
};

/// A chart with its middle at the origin, at a density of one.
struct Body {
  Index chart = kNone, page = 0;
  Outline outline;
  double density = 0;                   // that of a chart that is kept; 0: that of all
  double lightness = 0, slackness = 0;  // inverses of mass and moment of inertia
};

Vec2 rotated(const Vec2& turn, const Vec2& p) {
  return {turn.x() * p.x() - turn.y() * p.y(), turn.y() * p.x() + turn.x() * p.y()};
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Two charts that may touch, or one and the page: `normal` leads from the second to the first, by
/// whose motion the gap opens.
struct Contact {
  Index first = kNone, second = kNone;
  Vec2 arm_first{0, 0}, arm_second{0, 0};  // from the middles to the points that may touch
  Vec2 normal{0, 0};
  double gap = 0;   // beyond the margin: negative where it is broken
  double mass = 0;  // as the push feels it
  double push = 0;  // never negative
};

class Growth {
 public:
  Growth(const Problem& problem, const Packed& packed, double limit)
      : limit_(limit),
        side_(problem.options().resolution),
        // What both borders are thinned by, and what distances may miss.
        margin_(2 * problem.radius() + 2 * (kHeld + kHeld)),
        turns_(problem.options().turns > 4) {
    if (problem.options().block > 1) {
      blocks_.emplace(problem.cells(), problem.cell(), margin_ / 2 - kHeld);
    }
    for (Index c = 0; c < problem.size(); ++c) {
      const Outline& outline = problem.outline(c);
      if (outline.edges.empty()) continue;
      const bool stays = problem.chart(c).kept.has_value();
      const double texels_per_unit = stays ? limit : packed.texels_per_unit;
      const double density = texels_per_unit * problem.chart(c).scale;
      Body body{c, packed.placements[c].page, outline, stays ? limit : 0};
      Eigen::AlignedBox2d box;
      for (const Vec2& p : outline.hull) box.extend(p);
      const Vec2 middle = box.center();
      for (Vec2& p : body.outline.points) p = problem.chart(c).scale * (p - middle);
      thin(body.outline, kHeld / texels_per_unit);
      double inertia = 0;
      for (const Vec2& p : body.outline.points) inertia += p.squaredNorm();
      inertia *= texels_per_unit * texels_per_unit / size_of(body.outline.points);
      const double mass = std::max(1.0, box.sizes().norm() * density);
      if (!stays) extent_ = std::max(extent_, box.sizes().norm() * density);
      body.lightness = stays ? 0 : 1 / mass;
      const bool turns = turns_ && !stays && problem.chart(c).own_turns == 0;
      body.slackness = turns ? 1 / (mass * std::max(inertia, 1.0)) : 0;
      points_ += size_of(body.outline.points);
      poses_.push_back({packed.placements[c].place(middle, density), packed.placements[c].turn});
      middles_.push_back(problem.chart(c).scale * middle);
      bodies_.push_back(std::move(body));
    }
    density_ = packed.texels_per_unit;
  }

  void run(double effort) {
    constexpr double kGreatestRate = 0.01, kLeastRate = 0.0004;
    // Borders that pass each other in a step are not seen to touch.
    const double greatest = std::min(kGreatestRate, kNearer * margin_ / extent_);
    const double least = std::min(kLeastRate, 0.1 * greatest);
    const double budget = effort * kPointSteps;
    double rate = greatest;
    while (rate > least && spent_ < budget && density_ < limit_) {
      const std::vector<Pose> before = poses_;
      const std::optional<Blocks> blocks_before = blocks_;
      const double raised = std::min(density_ * (1 + rate), limit_);
      if (settle(raised)) {
        density_ = raised;
        rate = std::min(1.3 * rate, greatest);
      } else {
        poses_ = before;
        blocks_ = blocks_before;
        rate /= 2;
      }
    }
  }

  Packed result(const Packed& packed) const {
    Packed grown{packed.placements, density_};
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].density > 0) continue;
      Placement& placement = grown.placements[bodies_[b].chart];
      placement.turn = poses_[b].turn;
      placement.offset = poses_[b].middle - density_ * rotated(poses_[b].turn, middles_[b]);
    }
    return grown;
  }

 private:
  /// Moves the charts until all margins hold at a density.
  bool settle(double density) {
    constexpr int kMostSteps = 30;
    double worst_before = HUGE_VAL;
    for (int step = 0; step < kMostSteps; ++step) {
      const bool apart = find_contacts(density);
      spent_ += static_cast<double>(points_) + kPointsOfStep;
      if (!apart) return false;
      double worst = 0;
      for (const Contact& contact : contacts_) worst = std::max(worst, -contact.gap);
      if (worst <= kHeld) return true;
      // Where a third of the steps have not halved it, all is jammed.
      if (step % 10 == 9) {
        if (worst > 0.6 * worst_before) return false;
        worst_before = worst;
      }
      push();
    }
    return false;
  }

  /// False where charts lie on blocks of others.
  bool find_contacts(double density) {
    std::vector<PlacedOutline> placed(bodies_.size());
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const Body& body = bodies_[b];
      const double own = body.density > 0 ? body.density : density;
      placed[b].page = body.page;
      placed[b].edges = body.outline.edges;
      placed[b].stays = body.density > 0;
      for (const Vec2& p : body.outline.points) {
        placed[b].points.push_back(poses_[b].middle + own * rotated(poses_[b].turn, p));
      }
    }
    contacts_.clear();
    const EdgeGrid grid(placed, margin_ + kFurthest);
    PollSometimes poll;
    for (Index b = 0; b < size_of(bodies_); ++b) {
      for (const Vec2& p : placed[b].points) {
        poll();
        if (!placed[b].stays) add_walls(b, p);
        add_nearest(grid, placed, b, p);
      }
    }
    return !blocks_ || add_blocks(placed);
  }

  /// Between a chart and the blocks of others.
  bool add_blocks(const std::vector<PlacedOutline>& placed) {
    blocks_->take(placed);
    for (Index b = 0; b < size_of(bodies_); ++b) {
      if (placed[b].stays) continue;
      const std::vector<NearBlock> found = blocks_->near(placed, b, margin_ / 2 + kFurthest);
      spent_ += kPointsOfBlock * static_cast<double>(found.size() * placed[b].edges.size());
      for (const NearBlock& near : found) {
        if (!(near.distance > 0)) return false;
        const Vec2 normal = (near.on_chart - near.on_block) / near.distance;
        add(b, kNone, near.on_chart, near.on_block, normal, near.distance - margin_ / 2);
      }
    }
    return true;
  }

  /// Between a point and the edges of the page.
  void add_walls(Index body, const Vec2& p) {
    for (int axis = 0; axis < 2; ++axis) {
      for (const double sign : {1.0, -1.0}) {
        const double gap = (sign > 0 ? p[axis] : side_ - p[axis]) - margin_ / 2;
        if (gap < kFurthest) add(body, kNone, p, p, sign * Vec2::Unit(axis), gap);
      }
    }
  }

  /// Between a point and the nearest edge of each chart that is near.
  void add_nearest(const EdgeGrid& grid, const std::vector<PlacedOutline>& placed, Index body,
                   const Vec2& p) {
    Index other = kNone;
    double least = 0;
    Vec2 nearest(0, 0);
    const auto flush = [&] {
      if (other == kNone) return;
      const double distance = std::sqrt(least);
      if (distance > 0 && distance < margin_ + kFurthest) {
        add(body, other, p, nearest, (p - nearest) / distance, distance - margin_);
      }
    };
    for (const ChartEdge& near : grid.near(placed[body].page, p)) {  // chart by chart
      if (near.chart == body || (placed[near.chart].stays && placed[body].stays)) continue;
      if (near.chart != other) {
        flush();
        other = near.chart;
        least = HUGE_VAL;
      }
      const auto& [from, to] = placed[other].edges[near.edge];
      const Vec2 place = nearest_on(placed[other].points[from], placed[other].points[to], p);
      const double squared = (place - p).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = place;
      }
    }
    flush();
  }

  void add(Index first, Index second, const Vec2& p, const Vec2& q, const Vec2& normal,
           double gap) {
    Contact contact{first, second, p - poses_[first].middle, Vec2(0, 0), normal, gap};
    const double turned = cross(contact.arm_first, normal);
    double give = bodies_[first].lightness + bodies_[first].slackness * turned * turned;
    if (second != kNone) {
      contact.arm_second = q - poses_[second].middle;
      const double other = cross(contact.arm_second, normal);
      give += bodies_[second].lightness + bodies_[second].slackness * other * other;
    }
    contact.mass = 1 / give;
    contacts_.push_back(contact);
  }

  /// The least motions that leave no gap negative, to first order.
  void push() {
    constexpr int kSweeps = 40;
    std::vector<Eigen::Vector3d> moves(bodies_.size(), Eigen::Vector3d::Zero());
    const auto move_by = [&](Index b, const Vec2& arm, const Vec2& normal, double push) {
      moves[b].head<2>() += bodies_[b].lightness * push * normal;
      moves[b].z() += bodies_[b].slackness * push * cross(arm, normal);
    };
    const auto opening = [&](Index b, const Vec2& arm, const Vec2& normal) {
      return normal.dot(moves[b].head<2>()) + cross(arm, normal) * moves[b].z();
    };
    PollSometimes poll;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      for (Contact& contact : contacts_) {
        poll();
        double gap = contact.gap + opening(contact.first, contact.arm_first, contact.normal);
        if (contact.second != kNone) {
          gap -= opening(contact.second, contact.arm_second, contact.normal);
        }
        const double push = std::max(0.0, contact.push - gap * contact.mass);
        const double more = push - contact.push;
        if (more == 0) continue;
        contact.push = push;
        move_by(contact.first, contact.arm_first, contact.normal, more);
        if (contact.second != kNone) {
          move_by(contact.second, contact.arm_second, contact.normal, -more);
        }
      }
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) apply(moves[b], b);
  }

  void apply(const Eigen::Vector3d& move, std::size_t b) {
    double reach = 0;
    for (const Vec2& p : bodies_[b].outline.points) reach = std::max(reach, p.squaredNorm());
    const double far = move.head<2>().norm() + std::abs(move.z()) * density_ * std::sqrt(reach);
    const double share = far > kFurthest ? kFurthest / far : 1;
    poses_[b].middle += share * move.head<2>();
    const Vec2 turn = rotated(poses_[b].turn, Vec2(1, share * move.z()));
    if (bodies_[b].slackness > 0) poses_[b].turn = turn / portable::hypot(turn.x(), turn.y());
  }

  double limit_, side_, margin_;
  double extent_ = 1;  // texels from end to end of the largest chart that grows
  bool turns_;
  std::optional<Blocks> blocks_;
  double density_ = 0, spent_ = 0;
  Index points_ = 0;
  std::vector<Body> bodies_;
  std::vector<Vec2> middles_;  // of the charts' own points, times their scale
  std::vector<Pose> poses_;
  std::vector<Contact> contacts_;
};

/// Whether all charts keep the margin, by the distances of their whole borders, and share no block.
bool holds(const Problem& problem, const Packed& packed, double limit) {
  std::vector<PlacedOutline> charts;
  for (Index c = 0; c < problem.size(); ++c) {
    const bool stays = problem.chart(c).kept.has_value();
    const double density = stays ? limit : packed.texels_per_unit;
    charts.push_back(
        placed(problem.outline(c), packed.placements[c], density * problem.chart(c).scale));
    charts.back().stays = stays;
  }
  const double margin = 2 * problem.radius();
  const Clearance least = clearance(charts, problem.options().resolution, margin);
  if (least.charts < margin || least.page < margin / 2) return false;
  if (problem.options().block == 1) return true;
  Blocks blocks(problem.cells(), problem.cell(), problem.radius());
  return blocks.take(charts);
}

}  // namespace

Packed grow(const Problem& problem, Packed packed, double limit) {
  if (problem.options().margin < kLeastMargin) return packed;
  if (problem.options().block > 1) {
    std::int64_t pages = 1;
    for (const Placement& placement : packed.placements) {
      pages = std::max<std::int64_t>(pages, placement.page + 1);
    }
    if (pages * problem.cells() * problem.cells() > kMostBlocks) return packed;
  }
  Growth growth(problem, packed, limit);
  growth.run(problem.options().effort);
  Packed grown = growth.result(packed);
  return grown.texels_per_unit > packed.texels_per_unit && holds(problem, grown, limit)
             ? std::move(grown)
             : std::move(packed);
}

}  // namespace beltrami
