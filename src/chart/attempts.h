// What is tried until a map keeps the promise of its mode. An attempt is a value: the best one is
// kept whole, and of the others nothing but their time.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/work.h"
#include "chart/delivery.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/inherited.h"
#include "multilevel/options.h"

namespace beltrami {

struct JudgedMap {
  ChartMap map;  ///< but for its UVs, which are those of `delivery`
  Delivery delivery;
  std::int64_t broken = 0;  ///< see broken_promises; 0 of modes that promise nothing
};

struct Attempts {
  JudgedMap best;
  std::int64_t restarts = 0;  ///< attempts after the first
};

/// A way to a map of the disk.
struct Way {
  std::function<ChartMap(const Work& work)> run;  ///< may throw Error SOLVER
  bool needs_time = false;  ///< passed over when the time is up, if it is not the first
};

/// One way, refined where the options say so, and judged in the numbers that it would be delivered
/// in. Throws as the way does.
JudgedMap attempt(const DiskMesh& mesh, const Normalisation& frame, const Way& way,
                  const ChartOptions& options, const Work& work);

/// The ways one after the other, until one breaks no promise; of several that do the first with the
/// fewest faults. Ways that throw Error SOLVER are passed over; where all do, the last error is
/// thrown. The time of those that are not kept is the stage "given-up" of the best.
Attempts try_in_turn(const DiskMesh& mesh, const Normalisation& frame, const std::vector<Way>& ways,
                     const ChartOptions& options, const Work& work);

/// The method; then, where its map must be injective, again with coarser meshes (paper section 3.2)
/// and with the usual one if a coarser one was asked for; and at last embeddings of the fine mesh:
/// Tutte's, then one that cannot fold. When the time is up, these alone are left. Throws Error
/// SOLVER for the method GIF: it asks for another one, with the reason.
Attempts try_all(const DiskMesh& mesh, const Normalisation& frame, const Inherited& inherited,
                 const ChartOptions& options, const Work& work);

}  // namespace beltrami
