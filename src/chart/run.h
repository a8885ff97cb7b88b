// One run of the pipeline: times its stages, maps their progress into the whole, cancels them.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/checkpoint.h"
#include "base/resources.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/pipeline.h"
#include "descend/contact.h"
#include "descend/newton.h"
#include "exact/certificate.h"
#include "flatten/laplacian.h"
#include "flatten/metric.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "prolong/prolongation.h"
#include "repair/rounding.h"
#include "simplify/simplify.h"

namespace beltrami {

/// What is known about the fine mesh when the coarse one is done.
struct FineProblem {
  CoarseDisk coarse;
  std::vector<Vec2> coarse_uvs;
  double coarse_energy = 2;
  bool in_contact = false;  ///< parts of the coarse boundary press on each other
  std::vector<RestTriangle> rest;
  std::vector<FaceMetric> metric;
  std::vector<Cotangents> cotangents;  ///< for the harmonic solves
};

/// The minimum on a coarser mesh, as the start of that on a finer one.
struct CoarserMinimum {
  CoarseDisk coarse;
  std::vector<Vec2> uvs;           ///< of the coarse mesh
  std::vector<FaceMetric> metric;  ///< of the finer one
};

/// A map in the numbers that are delivered, but for a power of two, and what they are worth.
struct Delivery {
  beltrami_status status = BELTRAMI_OK;  ///< of the method: OK or NOT_CONVERGED
  std::vector<Vec2> uvs;                 ///< one per vertex, in double precision
  Certificate certificate;               ///< of them
  std::optional<Rounded> single;         ///< in single precision, with the option float32
  std::vector<Triangle> faces;           ///< of the map if they are not the input's; else empty
};

/// Simplification may get stuck far above its target: a coarse mesh that keeps more of the faces
/// than this saves nothing.
inline constexpr double kLeastReduction = 0.7;

/// Faces that a mesh of so many is simplified to: the option's number, or max(1%, 10,000), and no
/// more than it has.
Index coarse_faces(Index faces, const Options& options);

class Run {
 public:
  Run(const DiskMesh& disk, const Normalisation& frame, const Options& options,
      const Progress& progress, const std::atomic<bool>& cancelled)
      : input_(disk),
        frame_(frame),
        options_(options),
        progress_(progress),
        cancelled_(cancelled) {}

  Flattening flatten();

 private:
  /// Runs `body(statistics, checkpoint)` as the stage `name`, which takes the progress bar up to
  /// `until`.
  template <class Body>
  void stage(const char* name, double until, Body&& body);
  void report(double fraction, const char* name);

  // pipeline.cpp: the methods, and what comes after them.
  bool promises() const;
  Delivery run_with_fallback();
  std::vector<Vec2> run_method();
  std::vector<Vec2> run_tutte();
  std::vector<Vec2> run_cm(const DiskMesh& mesh, const char* name, double until,
                           bool* in_contact = nullptr);
  std::vector<Vec2> start_map(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                              const Checkpoint& checkpoint);
  std::vector<Vec2> start_from_coarser(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                       const Checkpoint& checkpoint);
  bool restrict_map(const std::vector<Vec2>& fine_uvs, const CoarseDisk& coarse,
                    const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs) const;
  std::optional<CoarserMinimum> minimise_coarser(const DiskMesh& mesh, Index target, bool simple,
                                                 double tolerance, const Checkpoint& checkpoint,
                                                 const std::vector<Vec2>* start = nullptr);
  std::vector<Vec2> contact_from_coarser(const DiskMesh& mesh,
                                         const std::vector<RestTriangle>& rest,
                                         const std::vector<Vec2>& start,
                                         const Checkpoint& checkpoint);
  void refine(std::vector<Vec2>& uvs);
  NewtonOptions newton_options() const;
  void scale_best(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  std::vector<Vec2>& uvs) const;
  void start_flat(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                  std::vector<Vec2>& uvs) const;
  NewtonResult descend_to(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                          NewtonOptions newton, std::vector<Vec2>& uvs, StageStatistics& statistics,
                          const Checkpoint& checkpoint);
  NewtonResult descend(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                       NewtonOptions newton, bool simple, std::vector<Vec2>& uvs,
                       StageStatistics& statistics, const Checkpoint& checkpoint);

  // delivery.cpp: the numbers that are delivered.
  Numbers numbers(bool single) const;
  std::vector<Vec2> placed(const std::vector<Vec2>& uvs) const;
  Delivery prepare(const std::vector<Vec2>& uvs);
  std::int64_t broken_promises(const Delivery& made) const;
  void deliver(Delivery made);
  void measure(const std::vector<Vec2>& uvs);

  // fine_map.cpp: from the coarse map to the fine one.
  std::vector<Vec2> run_beltrami();
  std::vector<Vec2> run_uv_prolongation();
  std::vector<Vec2> run_plain();
  std::vector<Vec2> run_whole();
  void simplify_fine(FineProblem& fine);
  void solve_coarse(FineProblem& fine);
  void measure_fine(FineProblem& fine, const Checkpoint& checkpoint);
  Index coarse_target() const;
  bool keeps_boundary_simple() const;
  std::vector<Vec2> flatten_metric(const FineProblem& fine);
  std::vector<Vec2> flatten_dirichlet(const FineProblem& fine);
  std::vector<Vec2> flatten_reduced(const FineProblem& fine, bool scaffold);
  std::vector<Vec2> descend_from_circle(const std::vector<RestTriangle>& rest, bool simple,
                                        StageStatistics& statistics, const Checkpoint& checkpoint);
  std::vector<Vec2> flatten_boundary_first(const FineProblem& fine);
  bool solve_flat(const FineProblem& fine, const std::vector<Vec2>& carried,
                  const std::vector<bool>& anchored, std::unique_ptr<MetricLaplacian>& laplacian,
                  std::vector<Vec2>& uvs);
  bool polish_map(const FineProblem& fine, std::optional<BoundaryContact> contact,
                  MetricLaplacian& laplacian, std::vector<Vec2>& uvs);
  NewtonResult take_newton_steps(const FineProblem& fine, const BoundaryContact* contact,
                                 std::vector<Vec2>& uvs, const Checkpoint& checkpoint);
  bool mend(const FineProblem& fine, bool simple_boundary, double until, std::vector<Vec2>& uvs);
  void count_flips(const std::vector<Vec2>& uvs);

  const DiskMesh& input_;
  const Normalisation& frame_;
  const DiskMesh* disk_ = &input_;  // or what intrinsic flips made of it
  DiskMesh retriangulated_;
  Index coarse_target_ = kNone;  // of a restart; none: as the options have it
  const Options& options_;
  const Progress& progress_;
  const std::atomic<bool>& cancelled_;
  const double started_ = wall_seconds();
  double fraction_ = 0;
  Flattening result_;
};

template <class Body>
void Run::stage(const char* name, double until, Body&& body) {
  const double from = fraction_;
  const double wall = wall_seconds(), cpu = cpu_seconds();
  StageStatistics statistics{name};
  const Checkpoint checkpoint = [&](double fraction) {
    report(from + (until - from) * std::clamp(fraction, 0.0, 1.0), name);
  };
  checkpoint(0);
  body(statistics, checkpoint);
  checkpoint(1);
  statistics.seconds = wall_seconds() - wall;
  statistics.cpu_seconds = cpu_seconds() - cpu;
  result_.stages.push_back(statistics);
}

}  // namespace beltrami
