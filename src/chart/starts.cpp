#include "chart/starts.h"

#include "chart/coarser_start.h"
#include "chart/descent.h"
#include "chart/memory_estimate.h"
#include "descend/contact.h"
#include "descend/flat_start.h"
#include "descend/grid_drawing.h"
#include "descend/tutte.h"
#include "exact/certificate.h"
#include "mesh/boundary.h"
#include "repair/repair.h"

namespace beltrami {

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
    scale_best(mesh, rest, options, work, start);
    double energy = mean_energy(options.energy, mesh.faces, rest, start, work);
    if (!(energy < least) || !certify(mesh.faces, mesh.boundary, start, work).injective()) continue;
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
