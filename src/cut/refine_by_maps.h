// Seams of a coarse surface: by the elastic model, and corrected by real maps.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "cut/known_maps.h"
#include "cut/local_maps.h"
#include "cut/mirror.h"
#include "cut/seam_surface.h"
#include "cut/seam_target.h"
#include "cut/seam_tree.h"
#include "cut/search_effort.h"

namespace beltrami {

/// Where a search starts.
struct Start {
  double least_cost = 0.02;  ///< what a path costs beside its own, in roots of the area
  int number = 0;            ///< starts of one least cost differ by it: their first paths go astray
};

/// Seams and what is known of them.
struct Attempt {
  AnchoredSeams seams;
  double cost = std::numeric_limits<double>::infinity();
  double energy = std::numeric_limits<double>::infinity();
  double excess = std::numeric_limits<double>::infinity();  ///< over 2, by that asked for
  std::vector<std::vector<Vec2>> maps;                      ///< per chart, none of a sketch
  bool is_estimate = false;  ///< maps miss the target without contact, what that adds is guessed

  /// Of two that reach the target the shorter one, else the one that is nearer to it. What is only
  /// estimated is never better.
  bool is_better_than(const Attempt& other) const;

  /// What it would cost to just reach the target, about.
  double promised() const;
};

/// The search on one coarse surface. All that is asked for it does from the seams that it stands
/// at.
class SeamRefinement {
 public:
  /// `seams` open the surface into disks. `known`: of charts of it. `mirror`: the seams are
  /// symmetric to it and to stay so, or null. Keeps references to `coarse`, `known`, `target`,
  /// `effort` and the mirror.
  SeamRefinement(const SeamSurface& coarse, KnownMaps& known, AnchoredSeams seams,
                 const Start& start, const SeamTarget& target, const SearchEffort& effort,
                 const Work& work, const Mirror* mirror = nullptr);

  /// By the model alone.
  Attempt sketch();

  /// By maps along the seams as they are, overlaps parted.
  Attempt judged();

  /// Until maps have the energy asked for. `is_sketched`: the seams are a sketch.
  Attempt run(bool is_sketched);

  /// The same from seams that are near it: the model learns first what maps along them cost, and
  /// `calibrations` times more on the way.
  Attempt run_calibrated(int calibrations);

  /// What is found from `best` with a calibrated model, and unless there are no `rounds` with
  /// charts joined elsewhere, and with branches put elsewhere in so many, where that is better.
  void improve(int rounds, Attempt& best);

 private:
  /// What was judged last with contact.
  struct Contact {
    LocalMaps maps;
    double factor = 1;  ///< by what its excess was more than without
  };

  /// What became of seams on trial.
  struct Trial {
    std::optional<Attempt> attempt;  ///< none where they are not worth a map
    Contact contact;
  };

  /// The same, for a trial on another thread.
  SeamRefinement(const SeamRefinement& other, const Work& work);
  void report_step();
  Work here() const;
  bool extend_astray(double model_energy, int number, bool reopens);
  double tolerance() const;
  LocalMaps map(const LocalMaps* before) const;
  bool part_overlaps(const LocalMaps& maps);
  void mirror_seams();
  double missed_by(const LocalMaps& maps) const;
  bool judge(bool is_last, LocalMaps& maps, Attempt& attempt);
  double aim(double excess) const;
  void settle(Attempt now, LocalMaps& maps, Attempt& best);
  void calibrate(const LocalMaps& maps);
  Attempt approach(double model_energy, bool is_sketched, bool is_calibrated, int calibrations);
  std::vector<SeamTree::Joint> joints_of(const Attempt& best, double energy);
  Trial try_joint(const SeamTree::Joint& joint, const Attempt& best, const Contact& contact,
                  double energy);
  std::vector<Trial> try_joints(std::span<const SeamTree::Joint> joints, const Attempt& best,
                                const Contact& contact, double energy);
  void join_charts(Attempt& best);
  void vary(int rounds, Attempt& best);

  const SeamSurface& coarse_;
  KnownMaps& known_;
  const Mirror* mirror_;  ///< or null
  const Start start_;
  const SeamTarget& target_;
  const SearchEffort& effort_;
  const Work work_;
  int steps_ = 0;                  ///< that were reported
  std::vector<double> path_cost_;  ///< per half-edge, infinite along those that are not to be cut
  SeamTree tree_;
  Contact contact_;
};

}  // namespace beltrami
