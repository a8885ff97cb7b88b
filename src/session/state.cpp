#include "session/state.h"

#include "mesh/chart.h"

namespace beltrami {

void SessionState::own_faces(Index c) {
  const SessionChart& chart = charts[c];
  for (Index f = 0; f < chart.faces(); ++f) {
    const Index face = chart.part->chart.input_face[f];
    chart_of_face[face] = c;
    place_in_chart[face] = f;
  }
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
