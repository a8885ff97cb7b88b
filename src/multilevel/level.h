// One level of a disk: the map of the level below it carried up, solved for by the V-cycle, mended.
#pragma once

#include <cstddef>
#include <vector>

#include "base/vectors.h"
#include "base/work.h"
#include "descend/contact.h"
#include "energy/energy.h"
#include "flatten/v_cycle.h"
#include "linear/smoother.h"
#include "mesh/disk_mesh.h"
#include "multilevel/chart_map.h"
#include "multilevel/map_problem.h"
#include "multilevel/options.h"
#include "repair/repair.h"
#include "simplify/coarse.h"

namespace beltrami {

/// Share of the faces of a level that may be flipped after its solve: the repair is made for that.
inline constexpr double kFewFlips = 1e-4;

/// A level as its solve sees it. References are to what the caller keeps.
struct Level {
  MapProblem problem;
  const CoarseDisk& coarse;
  const std::vector<Vec2>& from;  ///< the map of the coarse level
  SingleField residual;  ///< what pulls the carried one to the target; the cycle has its stiffness
  BoundaryContact contact;
};

/// The stage "prolong": adds the level to the cycle, and aims at the derivative of the map `from`
/// of the coarse level, whose mean energy is `energy_below`.
Level prepare_level(const DiskMesh& mesh, const CoarseDisk& coarse, const std::vector<Vec2>& from,
                    double energy_below, Energy energy, const Work& work, VCycle& cycle,
                    ChartStatistics& statistics);

/// Gives the level its residual and the cycle the stiffness of the target.
void take_aim(Energy energy, const Work& work, VCycle& cycle, Level& level);

/// The stage "flatten": a few steps from the carried map, whose vertices `anchored` (per vertex, or
/// empty) stay; that map itself where it has fewer flips. Returns these.
std::size_t solve_level(const Level& level, const std::vector<bool>& anchored, const Work& work,
                        VCycle& cycle, ChartMap& map);

/// The stage "repair". What was flipped is relaxed with what is around it: it is positive now, but
/// little more. Returns whether all faces are positive.
bool mend_level(const Level& level, const RepairOptions& how, const ChartOptions& options,
                const Work& work, ChartMap& map);

}  // namespace beltrami
