// From the map of a method to the numbers that are delivered: placed, rounded, judged, measured.
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/checkpoint.h"
#include "base/types.h"
#include "chart/pipeline.h"
#include "chart/run.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

std::int64_t faults(const Certificate& certificate, bool crossings_too) {
  return certificate.orientations.negative + certificate.orientations.degenerate +
         (crossings_too ? certificate.crossings.count : 0);
}

}  // namespace

/// The unit that the numbers are delivered in: the caller's, or that of the unit square.
Numbers Run::numbers(bool single) const {
  return {.single = single, .exponent = options_.unit_square ? 0 : frame_.exponent};
}

/// The map with its bounding box around the origin, or in the unit square; in the unit of the
/// normalised mesh, from which that of the caller is a power of two away.
std::vector<Vec2> Run::placed(const std::vector<Vec2>& uvs) const {
  Vec2 low = uvs.front(), high = uvs.front();
  for (const Vec2& w : uvs) {
    low = low.cwiseMin(w);
    high = high.cwiseMax(w);
  }
  std::vector<Vec2> placed;
  placed.reserve(uvs.size());
  if (options_.unit_square) {
    // One ulp short, so that no rounding leaves the square.
    const double scale = (1 - 0x1p-52) / (high - low).maxCoeff();
    for (const Vec2& w : uvs) placed.push_back(scale * (w - low));
  } else {
    // Where floats are densest, above all in single precision.
    const Vec2 centre = 0.5 * (low + high);
    for (const Vec2& w : uvs) placed.push_back(w - centre);
  }
  return placed;
}

/// Places a map and judges the very numbers that would be returned, after mending what placing and
/// rounding folded.
Delivery Run::prepare(const std::vector<Vec2>& uvs) {
  Delivery made;
  stage("certify", 0.98, [&](StageStatistics&, const Checkpoint& checkpoint) {
    Rounded rounded =
        round_map(*disk_, uvs, placed(uvs), numbers(false), options_.threads, checkpoint);
    checkpoint(0.5);
    made.certificate = rounded.certificate;
    made.uvs = std::move(rounded.uvs);
    if (options_.float32) {
      made.single =
          round_map(*disk_, made.uvs, made.uvs, numbers(true), options_.threads, checkpoint);
    }
  });
  if (disk_ != &input_) made.faces = disk_->faces;
  made.status = result_.status;
  return made;
}

/// What is wrong with the numbers that were asked for: faces that are not positive, and crossings
/// where the boundary was to stay simple. Where single precision cannot hold the map at all,
/// another one would be no better: then in double precision.
std::int64_t Run::broken_promises(const Delivery& made) const {
  const bool single = made.single && numbers(true).hold(made.uvs);
  return faults(single ? made.single->certificate : made.certificate, keeps_boundary_simple());
}

/// The results: the map in the unit that was asked for, its verdicts and its energies.
void Run::deliver(Delivery made) {
  result_.status = made.status;
  const bool held = numbers(options_.float32).hold(made.uvs);
  stage("certify", 1.0, [&](StageStatistics&, const Checkpoint& checkpoint) {
    result_.certificate = made.certificate;
    Rounded single = made.single ? *std::move(made.single)
                                 : round_map(*disk_, made.uvs, made.uvs, numbers(true),
                                             options_.threads, checkpoint);
    result_.single_certificate = single.certificate;
    result_.float32_moves = single.moved;
    if (options_.float32) {
      if (made.certificate.injective() && !(held && single.certificate.injective())) {
        result_.status = BELTRAMI_NOT_INJECTIVE_FLOAT32;
      }
      result_.certificate = single.certificate;
      made.uvs.swap(single.uvs);
    } else if (single.moved > 0) {
      for (Index v = 0; v < size_of(made.uvs); ++v) {
        if (single.uvs[v] == numbers(true).nearest(made.uvs[v])) continue;
        result_.single_moves.emplace_back(v, numbers(true).delivered(single.uvs[v]));
      }
    }
    checkpoint(0.8);
    measure(made.uvs);
    for (Vec2& w : made.uvs) w = numbers(options_.float32).delivered(w);
  });
  if (!(held && result_.certificate.injective()) &&
      result_.status != BELTRAMI_NOT_INJECTIVE_FLOAT32) {
    result_.status = BELTRAMI_NOT_INJECTIVE;
  }
  result_.faces = std::move(made.faces);
  result_.uvs = std::move(made.uvs);
}

/// Against the normalised mesh in its own unit: there no energy leaves the range of numbers because
/// of the caller's.
void Run::measure(const std::vector<Vec2>& uvs) {
  const int exponent = frame_.exponent - numbers(false).exponent;
  std::vector<Vec2> in_mesh_unit;
  if (exponent != 0) {
    in_mesh_unit = uvs;
    for (Vec2& w : in_mesh_unit) w = {std::ldexp(w.x(), exponent), std::ldexp(w.y(), exponent)};
  }
  result_.face_energies.resize(disk_->faces.size());
  result_.distortion =
      measure_distortion(disk_->positions, disk_->faces, exponent != 0 ? in_mesh_unit : uvs,
                         options_.threads, result_.face_energies.data());
}

}  // namespace beltrami
