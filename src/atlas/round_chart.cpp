#include "atlas/round_chart.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <utility>

#include "atlas/pages.h"
#include "base/parallel.h"
#include "base/types.h"
#include "chart/flattening.h"
#include "descend/grid_drawing.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
/// Width of a drawing that stands for a chart too small to be rounded, in pages: a texel of 1,024.
constexpr double kMostDrawn = 0x1p-10;

/// What an atlas asks of a chart: positive faces that do not overlap.
bool is_sound(const AtlasChart& part, const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Triangle>& all = part.chart.mesh.faces;
  const std::vector<Triangle> faces(all.begin(), all.begin() + part.real_faces);
  return certify_atlas(faces, uvs, {}, work).injective();
}

bool injective(const DiskMesh& mesh, const std::vector<Vec2>& uvs, const Work& work) {
  return certify(mesh.faces, mesh.boundary, uvs, work).injective();
}

/// Takes a rounding of the map. Says in its outcome what became of a map that was injective;
/// `held`: whether the numbers are fine enough, and reach far enough.
void take(Rounded rounded, bool held, Outcome not_injective, MappedChart& map) {
  const bool was_injective = map.outcome <= Outcome::kNotConverged;
  if (was_injective && !(held && rounded.certificate.injective())) map.outcome = not_injective;
  map.uvs = std::move(rounded.uvs);
}

void take_doubles(const DiskMesh& mesh, const std::vector<Vec2>& placed, int exponent,
                  const Work& work, MappedChart& map) {
  const Numbers doubles{.single = false, .exponent = exponent};
  Rounded rounded = round_map(mesh, map.uvs, placed, doubles, work);
  const bool held = doubles.hold(rounded.uvs, work);
  take(std::move(rounded), held, Outcome::kNotInjective, map);
}

/// A chart that is smaller than a drawing of it in whole steps becomes that drawing, around its
/// centre: no rounding nearby has room for its faces. Nothing where it is larger, or the drawing
/// would be seen.
std::optional<Rounded> drawn_in_steps(const DiskMesh& mesh, const std::vector<Vec2>& placed,
                                      const Numbers& steps, const Work& work) {
  Eigen::AlignedBox2d box, drawn;
  for (const Vec2& w : placed) box.extend(w);
  const double width = steps.step * (2.0 * static_cast<double>(placed.size()) - 4);
  if (!(box.sizes().maxCoeff() < width) || width > kMostDrawn) return std::nullopt;
  Rounded result;
  result.uvs = grid_drawing(mesh);
  for (const Vec2& w : result.uvs) drawn.extend(w);
  const double scale = width / drawn.sizes().x();  // a power of two: both are whole, of one unit
  const Vec2 corner = steps.nearest(box.center() - 0.5 * scale * drawn.sizes());
  for (Vec2& w : result.uvs) w = corner + scale * (w - drawn.min());
  result.certificate = certify(mesh.faces, mesh.boundary, result.uvs, work);
  return result;
}

/// A map on a page in multiples of its step.
Rounded round_to_steps(const DiskMesh& mesh, const std::vector<Vec2>& uvs, const Numbers& steps,
                       const Work& work) {
  Rounded rounded = round_map(mesh, uvs, uvs, steps, work);
  if (rounded.certificate.injective()) return rounded;
  std::optional<Rounded> drawn = drawn_in_steps(mesh, uvs, steps, work);
  return drawn && drawn->certificate.injective() ? std::move(*drawn) : std::move(rounded);
}

}  // namespace

std::vector<Vec2> stored_downwards(std::vector<Vec2> uvs, const Work& work) {
  const Numbers floats{.single = true};
  parallel_for(work, size_of(uvs), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      uvs[v] = {floats.nearest(uvs[v].x()), -floats.nearest(1 - uvs[v].y())};
    }
  });
  return uvs;
}

void round_chart(const DiskMesh& mesh, const std::vector<Vec2>& placed, const NumberFormat& format,
                 const Work& work, MappedChart& map) {
  const Numbers floats{.single = true, .exponent = format.exponent};
  take_doubles(mesh, placed, format.exponent, work, map);
  Rounded single = round_map(mesh, map.uvs, map.uvs, floats, work);
  if (format.float32) {
    take(std::move(single), floats.hold(map.uvs, work), Outcome::kNotInjectiveFloat32, map);
  } else if (single.moved > 0 && single.certificate.injective()) {
    map.uvs = std::move(single.uvs);
  }
}

void round_on_page(const DiskMesh& mesh, const std::vector<Vec2>& placed, Index page, bool float32,
                   const Work& work, MappedChart& map) {
  const Numbers steps{.single = true, .step = step_of(page)};
  take_doubles(mesh, placed, 0, work, map);
  if (!float32 && page == 0) {
    std::vector<Vec2> upwards = map.uvs;
    for (Vec2& w : upwards) w = Numbers{.single = true}.nearest(w);
    if (injective(mesh, upwards, work) && injective(mesh, stored_downwards(map.uvs, work), work)) {
      return;
    }
  }
  Rounded single = round_to_steps(mesh, map.uvs, steps, work);
  if (float32) {
    take(std::move(single), true, Outcome::kNotInjectiveFloat32, map);
    return;
  }
  map.fits_single = single.certificate.injective();
  if (map.fits_single) map.uvs = std::move(single.uvs);
}

void round_pinned(const AtlasChart& part, const NumberFormat& format, const Work& work,
                  MappedChart& map) {
  const DiskMesh& mesh = part.chart.mesh;
  const Numbers doubles{.single = false, .exponent = format.exponent};
  const Numbers floats{.single = true, .exponent = format.exponent};
  map.uvs = round_map(mesh, map.uvs, map.uvs, map.held, doubles, work).uvs;
  Rounded single = round_map(mesh, map.uvs, map.uvs, map.held, floats, work);
  bool pins_stay = true;
  for (std::size_t v = 0; v < map.uvs.size(); ++v) {
    pins_stay = pins_stay && (!map.held[v] || single.uvs[v] == map.uvs[v]);
  }
  if (!is_sound(part, map.uvs, work)) {
    map.outcome = Outcome::kNotInjective;
  } else if (map.outcome > Outcome::kNotConverged) {
    map.outcome = Outcome::kOk;
  }
  const bool mended = single.moved > 0 && single.certificate.injective() && pins_stay;
  if (!format.float32 && !mended) return;
  map.uvs = std::move(single.uvs);
  if (format.float32 && map.outcome != Outcome::kNotInjective && !is_sound(part, map.uvs, work)) {
    map.outcome = Outcome::kNotInjectiveFloat32;
  }
}

}  // namespace beltrami
