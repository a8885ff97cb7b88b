// Where seams are worth their length, by the elastic model.
#pragma once

#include <optional>
#include <vector>

#include "base/types.h"
#include "base/work.h"
#include "cut/across.h"
#include "cut/edge_marks.h"
#include "cut/elastic_model.h"
#include "cut/mirror.h"
#include "cut/seam_paths.h"
#include "mesh/surface.h"

namespace beltrami {

/// Seams cost about the excess of the energy over 2 to the power of minus that.
constexpr double kSeamPrice = 0.36;
/// Gains below that are rounding.
constexpr double kLeastGain = 1e-7;

/// Seams that grow and shrink. What they leave of a surface are the same pieces as at the start:
/// they grow by trees, and lose branches only.
class SeamTree {
 public:
  /// `seams` open the surface into disks; `cost`: per half-edge, both of an edge alike, infinite
  /// where no seam may be; `budget`: seams of more length over the root of the area are not
  /// extended, 0: any; `least_cost`: what a path costs beside its own, over the root of the area,
  /// for short ones are worth little to the eye; `anchors`: per vertex, or none; `mirror`: what
  /// extends and shrinks does so in mirrored pairs, or null. Keeps references to `surface`, `cost`
  /// and the mirror.
  SeamTree(const Surface& surface, Index real_faces, const std::vector<double>& cost,
           EdgeMarks seams, double budget, double least_cost, const Work& work,
           std::vector<bool> anchors = {}, const Mirror* mirror = nullptr);
  /// The same seams and model, for another thread; `cost`: a copy of its own.
  SeamTree(const SeamTree& other, const std::vector<double>& cost, const Work& work);

  /// Adds paths to where the model is distorted most until its energy is at most `target`, the best
  /// by what is gained for the cost. `exactly`: the last one, which reaches it, is the cheapest
  /// part of a path that does; a start is better off with what is worth most. False where nothing
  /// helps any more.
  bool extend(double target, bool exactly = false);

  /// Joins the parts that fall apart without an arc of the seams again where that is cheapest, arc
  /// after arc, as long as something is gained: what was joined in the order of its worth becomes a
  /// short tree (key paths exchanged, Uchoa & Werneck 2012). The energy may rise.
  void reconnect();

  /// The same of the arcs around handles: each goes where it opens the surface at the least cost.
  void reopen();

  /// Takes back branches, or their ends, that are worth the least, as long as the energy of the
  /// model stays at most `target`.
  void shrink(double target);

  /// Puts branches where they are worth more for their cost, at the price that energy has at
  /// `target`, and goes there, in so many rounds as long as something is gained.
  void exchange(double target, int rounds);

  /// Takes `count` branches that are near one another away; by `number` they are others. Whether
  /// any went.
  bool ruin(int number, int count);

  /// As ElasticModel has it.
  void calibrate(const std::vector<double>& excess) { model_.calibrate(excess); }

  /// A seam between two charts, and what it is worth.
  struct Joint {
    std::vector<Index> halfedges;  ///< in order
    double cost = 0;
    double energy = 0;  ///< of the model without it

    /// By which it is known again.
    Index middle() const { return halfedges[halfedges.size() / 2]; }
  };

  /// The seams that part two charts and not one from itself, from node to node, and their halves;
  /// `chart`: per face. What is most costly for the energy that it holds at the price of `target`
  /// comes first.
  std::vector<Joint> joints(const std::vector<Index>& chart, double target) const;

  /// Joins the charts on its sides.
  void join(const Joint& joint);

  double energy() const { return model_.energy(); }
  double cost() const { return cost_of_seams_; }
  const EdgeMarks& seams() const { return seams_; }
  /// Per vertex, whether a path was made to it.
  const std::vector<bool>& anchors() const { return anchored_; }

  /// Takes other seams, which have been moved or added to; anchors stay where they were.
  void take(EdgeMarks seams);
  void take(EdgeMarks seams, std::vector<bool> anchors);

 private:
  struct Branch {
    std::vector<Index> halfedges, vertices;  ///< from its tip; the vertices that go with it
    double cost = 0;
    double energy = 0;  ///< of the model without it
    double worth = 0;   ///< energy gained for the cost
  };

  bool move_branch(Index tip, double price);
  void refresh();
  std::vector<Index> candidates(const SeamPaths& paths) const;
  SeamPath least_part(const SeamPath& whole, const ModelChange& change, double target) const;
  bool extend_once(double target, bool exactly);
  void add_path(const SeamPath& path);
  void add_mirrored(const SeamPath& path);
  double length_of(Index halfedge) const;
  bool affords(const SeamPath& path) const;
  std::vector<std::vector<Index>> arcs(bool ends_at_anchors) const;
  std::vector<bool> joined_to(Index vertex) const;
  std::optional<Index> on_smaller_part(Index one, Index other) const;
  template <class Reach>
  void for_each_joined(Index vertex, const Reach& reach) const;
  bool is_alone(Index halfedge) const;
  bool reconnect(const std::vector<Index>& arc, PathsAcross* across, bool may_part);
  bool reconnect_all(bool around_handles);
  const SeamPaths& paths();
  void mark(Index halfedge, bool is);
  Branch branch_from(Index tip) const;
  void judge(Branch& branch, double energy_without) const;
  std::vector<Branch> ends_of(Branch branch) const;
  bool is_branch(const Branch& branch) const;
  Branch partner_of(const Branch& branch) const;
  void remove(const Branch& branch);
  void put_back(const Branch& branch);

  const Surface& surface_;
  const std::vector<double>& cost_;
  const Work work_;       ///< when its time is up all loops end with what they have
  const Mirror* mirror_;  ///< or null
  EdgeMarks seams_;
  std::vector<Index> degree_;  ///< per vertex: seams at it
  std::vector<bool> anchored_;
  ElasticModel model_;
  std::optional<SeamPaths> paths_;  ///< to the seams that there are, where known
  double scale_;                    ///< root of the area
  double budget_;                   ///< of length
  double least_cost_;
  double cost_of_seams_ = 0, length_of_seams_ = 0;
};

}  // namespace beltrami
