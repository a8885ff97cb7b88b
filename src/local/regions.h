// Whole regions around faces that are in each other's way, optimised at once where patches would
// each hold what the next one has to move.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/energy.h"
#include "local/patch.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"

namespace beltrami {

/// Rings around the faces that regions of a repair reach over.
inline constexpr int kRegionRings = 4;

/// How far regions reach.
struct RegionSize {
  int rings;  ///< around the faces
  /// That move; what is larger is parted, along vertices that stay: a face with none that moves is
  /// in no patch.
  Index most_vertices = std::numeric_limits<Index>::max();
  /// With more they are parted, too, where they have more than a sixteenth of all that move, so
  /// that none keeps one thread long.
  Index few_vertices = most_vertices;
};

/// The vertices of the faces and those up to so many rings around move; the last ring is the one
/// with which they are more than a seventh of all vertices. What hangs together is one region, so
/// that none moves a vertex of another. Hubs, vertices with more than 1000 faces, stay.
class Regions {
 public:
  /// Takes time for the mesh. Keeps a reference to it.
  Regions(const DiskMesh& mesh, const std::vector<Index>& faces, const RegionSize& size,
          const Work& work);

  int rings() const { return rings_; }  ///< that were reached
  Index count() const { return size_of(begins_) - 1; }

  /// `rest` may be empty, and that of the patch then is.
  Patch patch(Index region, const std::vector<RestTriangle>& rest,
              const std::vector<Vec2>& uvs) const;

  using Treatment = std::function<bool(Patch& patch, Index region, const Work& work)>;

  /// Treats each: side by side and the largest first, so that it does not come last; before these
  /// one after the other, on all threads, those that would be under way when all else is done.
  /// Returns the patches for which that said true, without their faces and rest shapes: those are
  /// there one at a time on each thread.
  std::vector<std::optional<Patch>> treat(const std::vector<RestTriangle>& rest,
                                          const std::vector<Vec2>& uvs, const Treatment& treatment,
                                          const Work& work) const;

 private:
  const DiskMesh& mesh_;
  int rings_ = 0;
  std::vector<Index> vertices_;      ///< that move, of each region in turn, increasing
  std::vector<Index> begins_ = {0};  ///< of each of these, and the end
  std::vector<Index> of_;            ///< per vertex: its place there, or below 0
};

/// Minimises the energy in the regions within `rings` rings of the faces, in place, to a relative
/// decrease of 0.1% in a step, in 30 steps at most. Large regions are parted, so that none
/// keeps one thread long: neighbours change anyway. A region that moves boundary
/// vertices is taken back if it adds boundary crossings. Faces that are singular in floats are
/// untangled first. Ends where the time is up. Returns how many regions have changed. Precondition:
/// the faces of the mesh are positive by exact predicates; they stay so.
std::int64_t relax_regions(Energy energy, const DiskMesh& mesh,
                           const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                           const std::vector<Index>& faces, int rings, const Work& work);

}  // namespace beltrami
