// From the verdicts of the stages to the public structs.
#pragma once

#include <beltrami/beltrami.h>

#include <vector>

#include "base/types.h"
#include "chart/flattening.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"

namespace beltrami {

inline std::uint64_t element_or_none(Index index) {
  return index == kNone ? BELTRAMI_NO_ELEMENT : static_cast<std::uint64_t>(index);
}

inline beltrami_status status_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kNotConverged:
      return BELTRAMI_NOT_CONVERGED;
    case Outcome::kNotInjective:
      return BELTRAMI_NOT_INJECTIVE;
    case Outcome::kNotInjectiveFloat32:
      return BELTRAMI_NOT_INJECTIVE_FLOAT32;
    default:
      return BELTRAMI_OK;
  }
}

/// Nothing found and nothing proved.
inline beltrami_certificate empty_certificate() {
  beltrami_certificate report{};
  report.first_bad_face = BELTRAMI_NO_ELEMENT;
  report.first_crossing[0] = BELTRAMI_NO_ELEMENT;
  report.first_crossing[1] = BELTRAMI_NO_ELEMENT;
  report.error_element = BELTRAMI_NO_ELEMENT;
  report.error_element_kind = BELTRAMI_ELEMENT_NONE;
  return report;
}

inline void describe_orientations(beltrami_certificate& report, const Orientations& found) {
  report.positive = static_cast<std::uint64_t>(found.positive);
  report.negative = static_cast<std::uint64_t>(found.negative);
  report.degenerate = static_cast<std::uint64_t>(found.degenerate);
  report.first_bad_face = element_or_none(found.first_bad_face);
}

/// `original`: per vertex of the disk its number in the input.
inline void describe_crossings(beltrami_certificate& report, const Crossings& found,
                               const std::vector<Index>& original) {
  report.boundary_crossings = static_cast<std::uint64_t>(found.count);
  for (std::size_t i = 0; i < 2; ++i) {
    const Index vertex = found.first_pair[i];
    report.first_crossing[i] =
        vertex == kNone ? BELTRAMI_NO_ELEMENT
                        : static_cast<std::uint64_t>(original[static_cast<std::size_t>(vertex)]);
  }
}

inline beltrami_energy describe_distortion(const Distortion& distortion) {
  beltrami_energy energy{};
  energy.symmetric_dirichlet = distortion.symmetric_dirichlet;
  energy.symmetric_arap = distortion.symmetric_arap;
  energy.max = distortion.max;
  energy.worst_face = element_or_none(distortion.worst_face);
  energy.left_out = static_cast<std::uint64_t>(distortion.left_out);
  return energy;
}

}  // namespace beltrami
