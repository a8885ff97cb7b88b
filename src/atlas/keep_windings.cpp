#include "atlas/keep_windings.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

/// Whether more of its faces are reversed than not; of as many the first of the input decides.
bool runs_against_input(const AtlasChart& chart, const Admitted& admitted) {
  const auto of_input = [&](Index f) { return admitted.input_face[chart.chart.input_face[f]]; };
  Index reversed = 0, first = 0;
  for (Index f = 0; f < chart.real_faces; ++f) {
    if (chart.is_reversed(admitted, f)) ++reversed;
    if (of_input(f) < of_input(first)) first = f;
  }
  if (2 * reversed == chart.real_faces) return chart.is_reversed(admitted, first);
  return 2 * reversed > chart.real_faces;
}

void turn_over(AtlasChart& chart, MappedChart& map, const Work& work) {
  DiskMesh& mesh = chart.chart.mesh;
  std::vector<Triangle> faces = mesh.faces;
  for (Triangle& face : faces) std::swap(face[1], face[2]);
  mesh = build_disk(std::move(mesh.positions), std::move(faces), work);
  for (Vec2& w : map.uvs) w.x() = -w.x();
  chart.is_turned = !chart.is_turned;
}

}  // namespace

void keep_windings(const Admitted& admitted, std::vector<AtlasChart>& charts,
                   std::vector<MappedChart>& maps, const Work& work) {
  if (admitted.counts.reversed_faces == 0) return;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (maps[c].pinned() || !runs_against_input(charts[c], admitted)) continue;
    turn_over(charts[c], maps[c], work);
  }
}

}  // namespace beltrami
