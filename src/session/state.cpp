#include "session/state.h"

#include <algorithm>

#include "mesh/chart.h"

namespace beltrami {

Index SessionChart::local_face(Index face) const {
  const std::vector<Index>& faces = part->chart.input_face;
  return static_cast<Index>(
      std::lower_bound(faces.begin(), faces.begin() + part->real_faces, face) - faces.begin());
}

void CornerUvs::read(const SessionChart& chart) {
  const Chart& own = chart.part->chart;
  for (Index f = 0; f < chart.faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      uvs_[3 * own.input_face[f] + k] = (*chart.uvs)[own.mesh.faces[f][k]];
    }
  }
}

}  // namespace beltrami
