// From the verdicts of the stages to the public structs.
#pragma once

#include <beltrami/beltrami.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/types.h"
#include "chart/flattening.h"
#include "energy/measure.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "multilevel/chart_map.h"

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

/// Nothing found and nothing proved.
inline beltrami_atlas_certificate empty_atlas_certificate() {
  beltrami_atlas_certificate report{};
  report.first_overlap[0] = BELTRAMI_NO_ELEMENT;
  report.first_overlap[1] = BELTRAMI_NO_ELEMENT;
  report.first_bad_face = BELTRAMI_NO_ELEMENT;
  report.error_element = BELTRAMI_NO_ELEMENT;
  report.error_element_kind = BELTRAMI_ELEMENT_NONE;
  return report;
}

/// With triangles where the public struct has faces.
inline beltrami_atlas_certificate describe_atlas(const AtlasCertificate& found) {
  beltrami_atlas_certificate report = empty_atlas_certificate();
  report.injective = found.injective() ? 1 : 0;
  report.positive = static_cast<std::uint64_t>(found.orientations.positive);
  report.negative = static_cast<std::uint64_t>(found.orientations.negative);
  report.degenerate = static_cast<std::uint64_t>(found.orientations.degenerate);
  report.excepted = static_cast<std::uint64_t>(found.excepted_faces);
  report.mirrored_charts = static_cast<std::uint64_t>(found.mirrored_charts);
  report.mirrored_faces = static_cast<std::uint64_t>(found.mirrored_faces);
  report.overlaps = static_cast<std::uint64_t>(found.overlaps.faces);
  if (!found.overlaps.first_faces.empty()) {
    for (std::size_t k = 0; k < 2; ++k) {
      report.first_overlap[k] = element_or_none(found.overlaps.first_faces.front()[k]);
    }
  }
  report.first_bad_face = element_or_none(found.orientations.first_bad_face);
  report.touching_places = static_cast<std::uint64_t>(found.touching_places);
  return report;
}

/// The caller's faces instead of triangles.
template <class FaceOf>
void name_faces(beltrami_atlas_certificate& report, const FaceOf& face_of) {
  for (std::uint64_t* face :
       {&report.first_overlap[0], &report.first_overlap[1], &report.first_bad_face}) {
    if (*face != BELTRAMI_NO_ELEMENT) *face = face_of(static_cast<Index>(*face));
  }
}

inline std::vector<Index> flat(const std::vector<Triangle>& triangles) {
  std::vector<Index> items;
  items.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    items.insert(items.end(), triangle.begin(), triangle.end());
  }
  return items;
}

inline beltrami_stage describe_stage(const StageStatistics& statistics) {
  beltrami_stage stage{};
  stage.iterations = statistics.iterations;
  stage.seconds = statistics.seconds;
  stage.cpu_seconds = statistics.cpu_seconds;
  stage.name = statistics.name;
  return stage;
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
