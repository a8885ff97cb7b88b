#include "chart/starts.h"

#include "chart/coarser_start.h"
#include "chart/descent.h"
#include "chart/memory_estimate.h"
#include "descend/contact.h"
#include "descend/flat_start.h"
#include "descend/grid_drawing.h"
#include "descend/tutte.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/boundary.h"
#include "repair/repair.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// Unfolds the faces of a flat start that are folded, where all of them are slivers: rounding turns
/// over what has no height to speak of. Whether all faces are positive then.
bool mend_slivers(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, const Work& work,
                  std::vector<Vec2>& uvs) {
  const std::vector<Index> folded = non_positive_faces(mesh.faces, uvs, work);
  if (folded.empty()) return true;
  double area = 0;
  for (const Index f : folded) area += rest[f].area();
  if (!(area < kSliverShare * surface_area(mesh, work))) return false;
  return repair(mesh, rest, uvs, {.global_fix = false}, work.part(0, 0)).flips_after == 0;
}

}  // namespace

std::vector<Vec2> start_map(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                            const ChartOptions& options, const Work& work) {
  std::vector<Vec2> uvs = tutte_embedding(mesh, work);
  const RepairOptions mend{.global_fix = affords(mesh, options, Extra::kGlobalFix, work)};
  if (repair(mesh, rest, uvs, mend, work.part(0, 0)).flips_after == 0) return uvs;
  std::vector<Vec2> other = start_from_coarser(mesh, rest, options, work);
  return other.empty() ? grid_drawing(mesh) : other;
}

void start_flat(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const ChartOptions& options, std::vector<Vec2>& uvs, const Work& work) {
  double least = mean_energy(options.energy, mesh.faces, rest, uvs, work);
  const std::vector<double> lengths = boundary_lengths(mesh);
  BoundaryContact contact(mesh.boundary, lengths, lengths);
  for (std::vector<Vec2> start : {projection(mesh), unflipped_unfolding(mesh, rest)}) {
    if (start.empty()) continue;
    if (!mend_slivers(mesh, rest, work, start)) continue;
    scale_best(mesh, rest, options, work, start);
    double energy = mean_energy(options.energy, mesh.faces, rest, start, work);
    if (!(energy < least)) continue;
    if (!is_simple(mesh.boundary, start) && !open_touching_sides(mesh, work, start)) continue;
    if (keeps_boundary_simple(options)) {
      contact.fit(start, 2);
      energy += contact.strength() / surface_area(mesh, work) * contact.energy(start);
    }
    if (!(energy < least)) continue;
    uvs.swap(start);
    least = energy;
  }
}

}  // namespace beltrami
