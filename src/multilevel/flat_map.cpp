#include "multilevel/flat_map.h"

#include <utility>

#include "base/types.h"
#include "descend/contact.h"
#include "descend/flat_start.h"
#include "descend/tutte.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/boundary.h"
#include "multilevel/descent.h"
#include "repair/rounding.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// Mean symmetric Dirichlet energy, above the least, below which a map counts as isometric: what
/// the barrier of a boundary that presses on itself costs at the end of a descent.
constexpr double kIsometric = 1e-3;

/// Unfolds the faces of a flat start that are folded, where all of them are slivers: rounding turns
/// over what has no height to speak of. Whether all faces are positive then.
bool mend_slivers(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, const Work& work,
                  std::vector<Vec2>& uvs) {
  const std::vector<Index> folded = non_positive_faces(mesh.faces, uvs, work);
  if (folded.empty()) return true;
  double area = 0;
  for (const Index f : folded) area += rest[f].area();
  if (!(area < kSliverShare * surface_area(mesh, work))) return false;
  return unfold_nearby(mesh, {}, work, uvs);
}

/// Whether a flat start is the map: it has the lengths of the surface but for slivers, and a
/// descent would bend it, for the sake of the contact of its boundary or of those slivers. Sides
/// that touch are parted then.
bool is_final(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
              const BoundaryContact& contact, const Work& work, std::vector<Vec2>& start) {
  const auto energies = [&](const std::vector<Vec2>& uvs) {
    std::vector<double> of_face(mesh.faces.size());
    measure_distortion(mesh.positions, mesh.faces, uvs, of_face.data(), work);
    std::vector<WeighedEnergy> faces;
    for (std::size_t f = 0; f < of_face.size(); ++f) faces.push_back({of_face[f], rest[f].area()});
    return summarise(faces);
  };
  if (!(energies(start).mean < 2 + kIsometric)) return false;
  std::vector<Vec2> apart = start;
  if (!is_simple(mesh.boundary, apart) && !open_touching_sides(mesh, work, apart)) return false;
  const EnergySummary energy = energies(apart);
  const bool has_slivers = !(energy.mean_of_all < 2 + kIsometric);
  if (!(energy.mean < 2 + kIsometric) || !(has_slivers || contact.is_pressed(apart))) return false;
  start.swap(apart);
  return true;
}

}  // namespace

bool start_flat(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                const ChartOptions& options, std::vector<Vec2>& uvs, const Work& work) {
  double least = mean_energy(options.energy, mesh.faces, rest, uvs, work);
  const std::vector<double> lengths = boundary_lengths(mesh);
  BoundaryContact contact(mesh.boundary, lengths, lengths);
  for (std::vector<Vec2> start : {projection(mesh), unflipped_unfolding(mesh, rest)}) {
    if (start.empty()) continue;
    if (!mend_slivers(mesh, rest, work, start)) continue;
    const bool may_end = keeps_boundary_simple(options) && options.parts_touching;
    if (may_end && is_final(mesh, rest, contact, work, start)) {
      uvs.swap(start);
      return true;
    }
    scale_best(mesh, rest, options, work, start);
    double energy = mean_energy(options.energy, mesh.faces, rest, start, work);
    if (!(energy < least)) continue;
    if (!is_simple(mesh.boundary, start) &&
        !(options.parts_touching && open_touching_sides(mesh, work, start))) {
      continue;
    }
    if (keeps_boundary_simple(options)) {
      contact.fit(start, 2);
      energy += contact.strength() / surface_area(mesh, work) * contact.energy(start);
    }
    if (!(energy < least)) continue;
    uvs.swap(start);
    least = energy;
  }
  return false;
}

}  // namespace beltrami
