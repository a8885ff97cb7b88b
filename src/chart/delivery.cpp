#include "chart/delivery.h"

#include <Eigen/Geometry>
#include <utility>

#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/types.h"
#include "energy/measure.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;

std::int64_t faults(const Certificate& certificate, bool crossings_too) {
  return certificate.orientations.negative + certificate.orientations.degenerate +
         (crossings_too ? certificate.crossings.count : 0);
}

/// The unit that the numbers are delivered in: the caller's, or that of the unit square.
Numbers numbers(const Normalisation& frame, const ChartOptions& options, bool single) {
  return {.single = single, .exponent = options.unit_square ? 0 : frame.exponent};
}

/// The map with its bounding box around the origin, or in the unit square; in the unit of the
/// normalised mesh, from which that of the caller is a power of two away.
std::vector<Vec2> placed(const std::vector<Vec2>& uvs, bool unit_square, const Work& work) {
  std::vector<Eigen::AlignedBox2d> of_chunk(uvs.size() / kGrain + 1);
  parallel_for(work, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Eigen::AlignedBox2d box;
    for (std::int64_t v = begin; v < end; ++v) box.extend(uvs[v]);
    of_chunk[begin / kGrain] = box;
  });
  Eigen::AlignedBox2d box;
  for (const Eigen::AlignedBox2d& own : of_chunk) box.extend(own);
  // Around the origin floats are densest, above all in single precision. The scale is one ulp
  // short, so that no rounding leaves the square.
  const Vec2 from = unit_square ? box.min() : Vec2(0.5 * (box.min() + box.max()));
  const double scale = unit_square ? (1 - 0x1p-52) / box.sizes().maxCoeff() : 1;
  std::vector<Vec2> placed;
  parallel_assign(work, placed, uvs.size());
  parallel_for(work, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) placed[v] = scale * (uvs[v] - from);
  });
  return placed;
}

/// Against the normalised mesh in its own unit: there no energy leaves the range of numbers because
/// of the caller's. `exponent`: of that unit in the unit of `uvs`.
void measure(const DiskMesh& mesh, const std::vector<Vec2>& uvs, int exponent, const Work& work,
             Flattening& result) {
  std::vector<Vec2> in_mesh_unit;
  if (exponent != 0) {
    in_mesh_unit = uvs;
    for (Vec2& w : in_mesh_unit) {
      w = {portable::times_power_of_two(w.x(), exponent),
           portable::times_power_of_two(w.y(), exponent)};
    }
  }
  parallel_assign(work, result.face_energies, mesh.faces.size());
  result.distortion =
      measure_distortion(mesh.positions, mesh.faces, exponent != 0 ? in_mesh_unit : uvs,
                         result.face_energies.data(), work);
}

/// Where single precision does not have the nearest number to `uvs`, as it is delivered.
std::vector<std::pair<Index, Vec2>> moves(const std::vector<Vec2>& uvs,
                                          const std::vector<Vec2>& single, const Numbers& numbers) {
  std::vector<std::pair<Index, Vec2>> moves;
  for (Index v = 0; v < size_of(uvs); ++v) {
    if (single[v] == numbers.nearest(uvs[v])) continue;
    moves.emplace_back(v, numbers.delivered(single[v]));
  }
  return moves;
}

}  // namespace

Delivery prepare(const DiskMesh& mesh, const Normalisation& frame, const std::vector<Vec2>& uvs,
                 const ChartOptions& options, const Work& work,
                 std::vector<StageStatistics>& stages) {
  Delivery made;
  run_stage("certify", work, stages, [&](StageStatistics&, const Work& inner) {
    Rounded rounded = round_map(mesh, uvs, placed(uvs, options.unit_square, inner),
                                numbers(frame, options, false), inner.part(0, 0.5));
    inner.report(0.5);
    made.certificate = rounded.certificate;
    made.uvs = std::move(rounded.uvs);
    if (options.float32) {
      made.single =
          round_map(mesh, made.uvs, made.uvs, numbers(frame, options, true), inner.part(0.5, 0.5));
    }
  });
  return made;
}

std::int64_t broken_promises(const Delivery& made, const Normalisation& frame,
                             const ChartOptions& options, const Work& work) {
  const bool single = made.single && numbers(frame, options, true).hold(made.uvs, work);
  return faults(single ? made.single->certificate : made.certificate,
                keeps_boundary_simple(options));
}

Flattening deliver(const DiskMesh& mesh, const Normalisation& frame, Delivery made, bool converged,
                   const ChartOptions& options, const Work& work) {
  Flattening result;
  result.status = converged ? Outcome::kOk : Outcome::kNotConverged;
  const Numbers asked = numbers(frame, options, options.float32);
  const Numbers floats = numbers(frame, options, true);
  const bool held = asked.hold(made.uvs, work);
  run_stage("certify", work, result.statistics.stages, [&](StageStatistics&, const Work& inner) {
    result.certificate = made.certificate;
    Rounded single = made.single ? *std::move(made.single)
                                 : round_map(mesh, made.uvs, made.uvs, floats, inner.part(0, 0.8));
    result.single_certificate = single.certificate;
    result.float32_moves = single.moved;
    if (options.float32) {
      if (made.certificate.injective() && !(held && single.certificate.injective())) {
        result.status = Outcome::kNotInjectiveFloat32;
      }
      result.certificate = single.certificate;
      made.uvs.swap(single.uvs);
    } else if (single.moved > 0) {
      result.single_moves = moves(made.uvs, single.uvs, floats);
    }
    inner.report(0.8);
    measure(mesh, made.uvs, frame.exponent - asked.exponent, inner, result);
    parallel_for(inner, size_of(made.uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v) made.uvs[v] = asked.delivered(made.uvs[v]);
    });
  });
  if (!(held && result.certificate.injective()) && result.status != Outcome::kNotInjectiveFloat32) {
    result.status = Outcome::kNotInjective;
  }
  result.uvs = std::move(made.uvs);
  return result;
}

}  // namespace beltrami
