#include "atlas/atlas.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "atlas/map_charts.h"
#include "atlas/measure.h"
#include "atlas/rows.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "cut/cut_into_charts.h"
#include "cut/open_minimal.h"
#include "exact/certificate.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 16384;
// Where the stages end in the progress.
constexpr double kAdmitted = 0.04, kCut = 0.1, kMapped = 0.9, kPlaced = 0.95;

bool is_disk(const Admitted& admitted) {
  const std::vector<Component>& components = admitted.topology.components;
  return components.size() == 1 && components[0].is_disk();
}

Admitted admitted_surface(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
                          const AtlasOptions& options, const Work& work) {
  Admitted admitted = admit(positions, faces, options.admit, work);
  if (!options.keep_disk || admitted.counts.welded_vertices == 0) return admitted;
  AdmitOptions apart = options.admit;
  apart.weld_distance.reset();
  Admitted as_it_stands = admit(positions, faces, apart, work);
  return is_disk(as_it_stands) ? as_it_stands : admitted;
}

/// Scales the surface by the power of two that brings it to about unit area, and returns its
/// exponent.
int bring_to_unit(Surface& surface, const Work& work) {
  std::vector<Vec3> moved = surface.positions;
  const int exponent = normalise(moved, surface.faces, work).exponent;
  parallel_for(work, surface.vertex_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      for (double& x : surface.positions[v]) x = std::ldexp(x, exponent);
    }
  });
  return exponent;
}

std::vector<Chart> cut_open(const Surface& surface, const Topology& topology, const Work& work) {
  CutSurface cut = cut_into_charts(surface, open_minimal(surface, topology, {}, work), work);
  if (!cut.non_disks.empty()) {
    throw Error(BELTRAMI_E_INTERNAL, "a chart of the cut surface is no disk, please report it");
  }
  return std::move(cut.charts);
}

Eigen::AlignedBox2d box_of(const std::vector<Vec2>& uvs) {
  Eigen::AlignedBox2d box;
  for (const Vec2& w : uvs) box.extend(w);
  return box;
}

/// Rounds a map, moved by `shift`, to doubles that rounded to nearest stay injective in single
/// precision; or to single-precision numbers at once. Notes where it does not stay injective.
void round_chart(const DiskMesh& mesh, const Vec2& shift, int exponent, bool float32,
                 const Work& work, MappedChart& map) {
  const Numbers doubles{.single = false, .exponent = exponent};
  const Numbers floats{.single = true, .exponent = exponent};
  const bool was_injective = map.outcome <= Outcome::kNotConverged;
  const auto note = [&](const Numbers& numbers, const Certificate& certificate, Outcome outcome) {
    if (was_injective && !(numbers.hold(map.uvs) && certificate.injective())) {
      map.outcome = outcome;
    }
  };
  std::vector<Vec2> placed = map.uvs;
  for (Vec2& w : placed) w += shift;
  Rounded rounded = round_map(mesh, map.uvs, placed, doubles, work);
  map.uvs = std::move(rounded.uvs);
  note(doubles, rounded.certificate, Outcome::kNotInjective);
  Rounded single = round_map(mesh, map.uvs, map.uvs, floats, work);
  if (float32) {
    if (map.outcome != Outcome::kNotInjective) {
      note(floats, single.certificate, Outcome::kNotInjectiveFloat32);
    }
    map.uvs = std::move(single.uvs);
  } else if (single.moved > 0 && single.certificate.injective()) {
    map.uvs = std::move(single.uvs);
  }
}

/// Lays the maps out without overlap, in the numbers to be delivered but for 2^exponent. A single
/// one stays where it is.
void place_maps(const std::vector<Chart>& charts, int exponent, bool float32,
                std::vector<MappedChart>& maps, const Work& work) {
  std::vector<Vec2> shifts(maps.size(), Vec2::Zero());
  if (maps.size() > 1) {
    std::vector<Vec2> sizes;
    for (const MappedChart& map : maps) sizes.push_back(box_of(map.uvs).sizes());
    shifts = place_in_rows(sizes);
    for (std::size_t c = 0; c < maps.size(); ++c) shifts[c] -= box_of(maps[c].uvs).min();
  }
  const Work of_chart = maps.size() == 1 ? work : work.aside();
  parallel_for(work, size_of(maps), 1, [&](std::int64_t c, std::int64_t) {
    if (maps[c].error != BELTRAMI_OK) {
      for (Vec2& w : maps[c].uvs) w += shifts[c];
      return;
    }
    round_chart(charts[c].mesh, shifts[c], exponent, float32, of_chart, maps[c]);
  });
}

/// UV vertices for the faces that were set aside: each a point, where another face has a corner of
/// theirs, if one has. `uv_of`: per vertex of the input, one of its UV vertices, or kNone.
void put_aside(const std::vector<Triangle>& faces, const std::vector<Index>& set_aside,
               const std::vector<Index>& uv_of, Atlas& atlas) {
  for (const Index f : set_aside) {
    const auto met =
        std::find_if(faces[f].begin(), faces[f].end(), [&](Index v) { return uv_of[v] != kNone; });
    const Vec2 place = atlas.uvs[met != faces[f].end() ? uv_of[*met] : 0];
    for (int k = 0; k < 3; ++k) {
      atlas.faces[f][k] = size_of(atlas.uvs);
      atlas.uvs.push_back(place);
      atlas.input_vertex.push_back(faces[f][k]);
    }
  }
}

/// The maps as UVs of the input's corners.
void collect(const std::vector<Triangle>& faces, const Admitted& admitted,
             const std::vector<Chart>& charts, const std::vector<MappedChart>& maps, Atlas& atlas) {
  atlas.faces.resize(faces.size());
  atlas.chart_of_face.assign(faces.size(), kNone);
  atlas.reversed.assign(faces.size(), false);
  Index vertices = 0;
  for (const Triangle& face : faces) vertices = std::max({vertices, face[0], face[1], face[2]});
  std::vector<Index> uv_of(static_cast<std::size_t>(vertices) + 1, kNone);
  PollSometimes poll;
  for (Index c = 0; c < size_of(charts); ++c) {
    const Chart& chart = charts[c];
    const Index first = size_of(atlas.uvs);
    atlas.uvs.insert(atlas.uvs.end(), maps[c].uvs.begin(), maps[c].uvs.end());
    for (const Index v : chart.input_vertex) {
      atlas.input_vertex.push_back(admitted.input_vertex[v]);
    }
    for (Index f = 0; f < chart.mesh.face_count(); ++f) {
      poll();
      const Index own = chart.input_face[f], input = admitted.input_face[own];
      atlas.chart_of_face[input] = c;
      atlas.reversed[input] = admitted.reversed[own];
      for (int k = 0; k < 3; ++k) {
        const int corner = admitted.input_corner(own, k);
        const Index uv = first + chart.mesh.faces[f][k];
        atlas.faces[input][corner] = uv;
        Index& known = uv_of[faces[input][corner]];
        if (known == kNone) known = uv;
      }
    }
  }
  put_aside(faces, admitted.set_aside, uv_of, atlas);
}

/// Judges the faces as they were oriented, but for those set aside: the UVs as they are, and
/// rounded to single precision.
void judge(const Numbers& floats, const Work& work, Atlas& atlas) {
  AtlasRules rules;
  rules.excepted.resize(atlas.faces.size());
  std::vector<Triangle> faces = atlas.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (atlas.reversed[f]) std::swap(faces[f][1], faces[f][2]);
    rules.excepted[f] = atlas.chart_of_face[f] == kNone;
  }
  atlas.certificate = certify_atlas(faces, atlas.uvs, rules, work.part(0, 0.5));
  std::vector<Vec2> single = atlas.uvs;
  for (Vec2& w : single) w = floats.nearest(w);
  atlas.single_certificate =
      single == atlas.uvs ? atlas.certificate : certify_atlas(faces, single, rules, work);
}

Outcome outcome_of(const Atlas& atlas, bool float32) {
  Outcome outcome = Outcome::kOk;
  bool in_doubles = true;
  for (const ChartInfo& chart : atlas.charts) {
    in_doubles = in_doubles && chart.outcome != Outcome::kNotInjective;
    outcome = std::max(outcome, chart.outcome);
  }
  if (!in_doubles) return Outcome::kNotInjective;
  if (atlas.certificate.injective()) return outcome;
  return float32 ? Outcome::kNotInjectiveFloat32 : Outcome::kNotInjective;
}

}  // namespace

Atlas unwrap(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
             const AtlasOptions& options, const Work& work) {
  Admitted admitted =
      admitted_surface(positions, faces, options, work.part(0, kAdmitted).named("admit"));
  const int exponent = bring_to_unit(admitted.surface, work);
  const std::vector<Chart> charts =
      cut_open(admitted.surface, admitted.topology, work.part(kAdmitted, kCut).named("cut"));
  std::vector<MappedChart> maps = map_charts(charts, work.part(kCut, kMapped).named("flatten"));
  place_maps(charts, exponent, options.float32, maps, work);
  work.named("place").report(kPlaced);

  Atlas atlas;
  for (const Chart& chart : charts) {
    const MappedChart& map = maps[atlas.charts.size()];
    atlas.charts.push_back(
        {.faces = chart.mesh.face_count(), .outcome = map.outcome, .error = map.error});
  }
  atlas.admitted = admitted.counts;
  collect(faces, admitted, charts, maps, atlas);
  atlas.energy = measure_charts(charts, maps, atlas.charts, work);
  double area = 0;
  for (const ChartInfo& chart : atlas.charts) area += chart.area;
  atlas.seam_over_root_area = seam_length(charts, admitted.input_vertex) / std::sqrt(area);
  judge({.single = true, .exponent = exponent}, work.part(kPlaced, 1).named("certify"), atlas);
  atlas.outcome = outcome_of(atlas, options.float32);

  // Into the input's unit, by a power of two.
  const Numbers numbers{.single = options.float32, .exponent = exponent};
  for (Vec2& w : atlas.uvs) w = numbers.delivered(w);
  for (ChartInfo& chart : atlas.charts) chart.area = std::ldexp(chart.area, -2 * exponent);
  atlas.area = std::ldexp(area, -2 * exponent);
  return atlas;
}

}  // namespace beltrami
