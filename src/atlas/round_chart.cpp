#include "atlas/round_chart.h"

#include <utility>

#include "base/types.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

/// What an atlas asks of a chart: positive faces that do not overlap.
bool is_sound(const AtlasChart& part, const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Triangle>& all = part.chart.mesh.faces;
  const std::vector<Triangle> faces(all.begin(), all.begin() + part.real_faces);
  return certify_atlas(faces, uvs, {}, work).injective();
}

}  // namespace

void round_chart(const DiskMesh& mesh, const std::vector<Vec2>& placed, const NumberFormat& format,
                 const Work& work, MappedChart& map) {
  const Numbers doubles{.single = false, .exponent = format.exponent};
  const Numbers floats{.single = true, .exponent = format.exponent};
  const bool was_injective = map.outcome <= Outcome::kNotConverged;
  const auto note = [&](const Numbers& numbers, const Certificate& certificate, Outcome outcome) {
    if (was_injective && !(numbers.hold(map.uvs, work) && certificate.injective())) {
      map.outcome = outcome;
    }
  };
  Rounded rounded = round_map(mesh, map.uvs, placed, doubles, work);
  map.uvs = std::move(rounded.uvs);
  note(doubles, rounded.certificate, Outcome::kNotInjective);
  Rounded single = round_map(mesh, map.uvs, map.uvs, floats, work);
  if (format.float32) {
    if (map.outcome != Outcome::kNotInjective) {
      note(floats, single.certificate, Outcome::kNotInjectiveFloat32);
    }
    map.uvs = std::move(single.uvs);
  } else if ((single.moved > 0 || format.single_first) && single.certificate.injective()) {
    map.uvs = std::move(single.uvs);
  }
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
