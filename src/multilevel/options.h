// What can be asked of the flattening of one disk.
#pragma once

#include <cstdint>

#include "energy/energy.h"

namespace beltrami {

/// How the map is computed.
enum class Method { kBeltrami, kCm, kTutte, kGif, kBff, kUvProlongation };

/// How the method kBeltrami flattens the fine mesh.
enum class Flatten { kMetric, kDirichlet, kGif, kFlim, kBff };

/// What the optimisation sees to. kAuto: the whole, but for the method kCm, which is left as the
/// literature has it.
enum class Injectivity { kAuto, kGlobal, kLocal };

/// Each has the meaning of the public option of its name, but for the last two.
struct ChartOptions {
  Method method = Method::kBeltrami;
  Flatten flatten = Flatten::kMetric;
  Injectivity injectivity = Injectivity::kAuto;
  Energy energy = Energy::kSymmetricDirichlet;
  std::int64_t coarse_faces = 0;  ///< 0: max(1% of the faces, 10,000)
  double tolerance = 1e-4;
  int max_iterations = 500;
  bool refine = false;
  int refine_iterations = 0;  ///< 0: to the stopping rule of composite majorization
  bool delaunay = false;      ///< flatten on the intrinsic Delaunay triangulation
  bool unit_square = false;
  bool float32 = false;  ///< deliver single-precision numbers
  /// No public option: the map only tells what a cut is worth, and starts that are hard to mend are
  /// given up.
  bool is_trial = false;
  /// Likewise: a chart of an atlas is split in two sooner than several levels are climbed anew.
  bool may_be_split = false;
  /// Likewise: sides of the boundary that touch in the best map are parted by hardly anything. Not
  /// on a coarse mesh, from whose map a finer one starts: there contact holds them apart, with room
  /// for what is between its vertices.
  bool parts_touching = true;
};

/// Whether the boundary may not cross itself.
inline bool keeps_boundary_simple(const ChartOptions& options) {
  const bool reference = options.method == Method::kCm && !options.refine;
  return options.injectivity == Injectivity::kGlobal ||
         (options.injectivity == Injectivity::kAuto && !reference);
}

/// Whether the map must be injective; that of other modes is judged as it is.
inline bool promises(const ChartOptions& options) {
  return options.method == Method::kBeltrami && options.flatten != Flatten::kBff &&
         options.flatten != Flatten::kFlim;
}

}  // namespace beltrami
