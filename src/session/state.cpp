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

std::uint8_t SessionState::flags_of(const SessionChart& chart) const {
  std::uint8_t common = kKeepFrame | kKeepScale | kAlign | kStack;
  for (Index f = 0; f < chart.faces(); ++f) common &= flags[chart.part->chart.input_face[f]];
  return common;
}

Index SessionState::stacked_on(const SessionChart& chart) const {
  if (!chart.lies_on) return kNone;
  for (Index c = 0; c < size_of(charts); ++c) {
    if (charts[c].uvs == chart.lies_on) return c;
  }
  return kNone;
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
