#include "atlas/atlas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "atlas/chart_parts.h"
#include "atlas/map_charts.h"
#include "atlas/measure.h"
#include "atlas/open.h"
#include "atlas/open_and_map.h"
#include "atlas/pack_maps.h"
#include "atlas/pins.h"
#include "atlas/place.h"
#include "atlas/rescue.h"
#include "atlas/snap.h"
#include "atlas/split_necks.h"
#include "atlas/straighten_charts.h"
#include "base/interrupt.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "mesh/surface.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

/// Smaller surfaces are in the caches anyway.
constexpr Index kWorthArranging = 50'000;
// Where the stages end in the progress.
constexpr double kAdmitted = 0.04, kMapped = 0.9, kPlaced = 0.95;

/// What cannot be rounded where it was placed is split, and all is placed anew, so often: a chart
/// that was halved so often is a crumb.
constexpr int kMostRescues = 6;

/// Texels per unit of a surface of unit area that stand for any fewer.
constexpr double kLeastDensity = 1e-100;

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

/// Numbers a large surface by where it is: what follows goes over it many times, and takes half the
/// time where neighbours lie close in memory. Its vertices and faces are no longer in the order of
/// the input's.
void arrange_surface(Admitted& admitted, const Work& work) {
  if (admitted.surface.face_count() < kWorthArranging) return;
  std::vector<Triangle> faces = std::move(admitted.surface.faces);
  const Arrangement order = arrange(admitted.surface.positions, faces, work);
  admitted.surface = build_surface(in_order(admitted.surface.positions, order.vertices, work),
                                   std::move(faces), work);
  admitted.topology = topology_of(admitted.surface, work);
  admitted.input_vertex = in_order(admitted.input_vertex, order.vertices, work);
  admitted.input_face = in_order(admitted.input_face, order.faces, work);
  std::vector<bool> reversed(order.faces.size());
  for (std::size_t f = 0; f < reversed.size(); ++f) {
    reversed[f] = admitted.reversed[order.faces[f]];
  }
  admitted.reversed = std::move(reversed);
}

/// The maps as UVs of the input's corners.
class Collector {
 public:
  Collector(const std::vector<Triangle>& faces, const Admitted& admitted, Atlas& atlas)
      : faces_(faces), admitted_(admitted), atlas_(atlas) {
    atlas.faces.resize(faces.size());
    atlas.chart_of_face.assign(faces.size(), kNone);
    atlas.reversed.assign(faces.size(), false);
    atlas.excepted.assign(faces.size(), false);
    Index vertices = 0;
    for (const Triangle& face : faces) vertices = std::max({vertices, face[0], face[1], face[2]});
    uv_of_.assign(static_cast<std::size_t>(vertices) + 1, kNone);
  }

  void add(const AtlasChart& part, const std::vector<Vec2>& uvs);
  void put_aside(const std::vector<PinAside>& pins);
  void share();
  void stack(const std::vector<StackedFace>& stacked);

 private:
  const std::vector<Triangle>& faces_;
  const Admitted& admitted_;
  Atlas& atlas_;
  std::vector<Index> uv_of_;  ///< per vertex of the input, one of its UV vertices, or kNone
  PollSometimes poll_;
};

void Collector::add(const AtlasChart& part, const std::vector<Vec2>& uvs) {
  const Chart& chart = part.chart;
  const auto c = static_cast<Index>(atlas_.charts.size());
  std::vector<Index> place(uvs.size(), kNone);
  for (Index f = 0; f < part.real_faces; ++f) {
    for (const Index v : chart.mesh.faces[f]) place[v] = 0;
  }
  ChartInfo info;
  info.faces = part.real_faces;
  info.first_face = first_input_face(part, admitted_);
  for (std::size_t v = 0; v < uvs.size(); ++v) {
    if (place[v] == kNone) continue;  // of virtual faces alone
    place[v] = size_of(atlas_.uvs);
    atlas_.uvs.push_back(uvs[v]);
    atlas_.input_vertex.push_back(admitted_.input_vertex[chart.input_vertex[v]]);
    Vec2 on_page = uvs[v];
    if (atlas_.pages) {
      atlas_.page_of_uv.push_back(atlas_.pages->page_of_chart[c]);
      on_page -= tile_of(atlas_.page_of_uv.back());
    }
    info.box.extend(on_page);
  }
  for (Index f = 0; f < part.real_faces; ++f) {
    poll_();
    const Index own = chart.input_face[f], input = admitted_.input_face[own];
    atlas_.chart_of_face[input] = c;
    atlas_.reversed[input] = admitted_.reversed[own];
    for (int k = 0; k < 3; ++k) {
      const int corner = admitted_.input_corner(own, k);
      const Index uv = place[chart.mesh.faces[f][k]];
      atlas_.faces[input][corner] = uv;
      Index& known = uv_of_[faces_[input][corner]];
      if (known == kNone) known = uv;
    }
  }
  atlas_.charts.push_back(info);
}

/// UV vertices for the faces that were set aside: each a point, where another face has a corner of
/// theirs, if one has, but for corners with pins.
void Collector::put_aside(const std::vector<PinAside>& pins) {
  std::map<std::pair<Index, int>, Vec2> pinned;
  for (const PinAside& pin : pins) pinned[{pin.face, pin.corner}] = pin.place;
  for (const Index f : admitted_.set_aside) {
    const Triangle& face = faces_[f];
    const auto met =
        std::find_if(face.begin(), face.end(), [&](Index v) { return uv_of_[v] != kNone; });
    const Index beside = met != face.end() ? uv_of_[*met] : 0;
    const Vec2 place = atlas_.uvs[beside];
    atlas_.excepted[f] = true;
    for (int k = 0; k < 3; ++k) {
      const auto pin = pinned.find({f, k});
      atlas_.faces[f][k] = size_of(atlas_.uvs);
      atlas_.uvs.push_back(pin != pinned.end() ? pin->second : place);
      if (atlas_.pages) atlas_.page_of_uv.push_back(atlas_.page_of_uv[beside]);
      atlas_.input_vertex.push_back(admitted_.welded(face[k]));
    }
  }
}

/// The UV vertices of the first of their kind for copies that are no faces of the surface.
void Collector::share() {
  for (const auto& [copy, first] : admitted_.copies) {
    if (atlas_.chart_of_face[copy] != kNone) continue;
    atlas_.chart_of_face[copy] = atlas_.chart_of_face[first];
    atlas_.excepted[copy] = true;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        if (admitted_.welded(faces_[first][j]) != admitted_.welded(faces_[copy][k])) continue;
        atlas_.faces[copy][k] = atlas_.faces[first][j];
      }
    }
  }
}

/// UV vertices where those of other faces are, for what is stacked on these.
void Collector::stack(const std::vector<StackedFace>& stacked) {
  std::map<std::pair<Index, Index>, Index> own;  // by the vertex, and the UV vertex that it lies on
  for (const StackedFace& face : stacked) {
    poll_();
    atlas_.chart_of_face[face.face] = atlas_.chart_of_face[face.on];
    atlas_.reversed[face.face] = face.reversed;
    atlas_.excepted[face.face] = true;
    for (int k = 0; k < 3; ++k) {
      const Index vertex = admitted_.welded(faces_[face.face][k]);
      const Index on = atlas_.faces[face.on][face.corner[k]];
      const auto [known, is_new] = own.try_emplace({vertex, on}, size_of(atlas_.uvs));
      atlas_.faces[face.face][k] = known->second;
      if (!is_new) continue;
      const Vec2 place = atlas_.uvs[on];
      atlas_.uvs.push_back(place);
      if (atlas_.pages) atlas_.page_of_uv.push_back(atlas_.page_of_uv[on]);
      atlas_.input_vertex.push_back(vertex);
    }
  }
}

/// Scales every map by the mean density of its faces, weighted by area. One per chart.
std::vector<double> scale_by_density(const std::vector<double>& densities, const Admitted& admitted,
                                     const std::vector<AtlasChart>& charts,
                                     std::vector<MappedChart>& maps) {
  std::vector<double> scales(charts.size(), 1);
  if (densities.empty()) return scales;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const DiskMesh& mesh = charts[c].chart.mesh;
    double area = 0, sum = 0;
    for (Index f = 0; f < charts[c].real_faces; ++f) {
      const auto [i, j, k] = mesh.faces[f];
      const double own = triangle_area(mesh.positions[i], mesh.positions[j], mesh.positions[k]);
      area += own;
      sum += own * densities[admitted.input_face[charts[c].chart.input_face[f]]];
    }
    if (!(area > 0)) continue;
    scales[c] = sum / area;
    for (Vec2& w : maps[c].uvs) w *= scales[c];
  }
  return scales;
}

/// Area of the UVs over that of their bounding box.
double utilisation_of(const Atlas& atlas) {
  Eigen::AlignedBox2d box;
  double area = 0;
  for (std::size_t f = 0; f < atlas.faces.size(); ++f) {
    if (atlas.excepted[f]) continue;
    const auto [a, b, c] = atlas.faces[f];
    const Vec2 p = atlas.uvs[b] - atlas.uvs[a], q = atlas.uvs[c] - atlas.uvs[a];
    area += 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
    for (const Index v : atlas.faces[f]) box.extend(atlas.uvs[v]);
  }
  return box.volume() > 0 ? area / box.volume() : 0;
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
  // Pinned charts may lie on each other, in any numbers.
  const bool pinned = std::any_of(atlas.charts.begin(), atlas.charts.end(),
                                  [](const ChartInfo& chart) { return chart.pinned; });
  if (pinned && outcome < Outcome::kNotInjective) return Outcome::kNotInjective;
  return float32 ? Outcome::kNotInjectiveFloat32 : Outcome::kNotInjective;
}

/// Into the unit that is delivered, by a power of two; `exponent`: of the surface.
void deliver(const Numbers& numbers, int exponent, Atlas& atlas) {
  for (Vec2& w : atlas.uvs) w = numbers.delivered(w);
  for (ChartInfo& chart : atlas.charts) {
    chart.area = std::ldexp(chart.area, -2 * exponent);
    atlas.area += chart.area;
    chart.box = {numbers.delivered(chart.box.min()), numbers.delivered(chart.box.max())};
  }
  atlas.seam_length = std::ldexp(atlas.seam_length, -exponent);
}

/// The charts' outcomes, energies and counts, and the UVs of all corners. `maps`: as they lie on
/// their pages, scaled by `scales` and `page_scale`.
void assemble(const AtlasInput& input, const Admitted& admitted, const MappedSurface& mapped,
              const std::vector<MappedChart>& maps, const std::vector<double>& scales,
              double page_scale, const Work& work, Atlas& atlas) {
  atlas.admitted = admitted.counts;
  atlas.filled_holes = mapped.filled_holes;
  atlas.missed = mapped.missed;
  atlas.stacked_parts = mapped.stacked_parts;
  Collector collector(input.faces, admitted, atlas);
  for (std::size_t c = 0; c < maps.size(); ++c) {
    collector.add(mapped.charts[c], maps[c].uvs);
    ChartInfo& chart = atlas.charts.back();
    chart.outcome = maps[c].outcome;
    chart.error = maps[c].error;
    chart.density = scales[c] * maps[c].scale;
    chart.pinned = maps[c].pinned();
  }
  collector.put_aside(mapped.pins_aside);
  collector.stack(mapped.stacked);
  collector.share();
  atlas.energy = measure_charts(mapped.charts, maps, page_scale, atlas.charts, work);
  atlas.seam_length = seam_length(mapped.charts, admitted.input_vertex);
  double area = 0;
  for (const ChartInfo& chart : atlas.charts) area += chart.area;
  atlas.seam_over_root_area = atlas.seam_length > 0 ? atlas.seam_length / std::sqrt(area) : 0;
  if (!atlas.pages) {
    atlas.utilisation = utilisation_of(atlas);
    return;
  }
  std::vector<Index> judged = atlas.chart_of_face;
  for (std::size_t f = 0; f < judged.size(); ++f) {
    if (atlas.excepted[f]) judged[f] = kNone;
  }
  measure_pages(atlas.faces, atlas.uvs, judged, *atlas.pages);
  atlas.utilisation = atlas.pages->utilisation;
}

/// As many charts as there may be; 0: any number.
Index most_charts(const AtlasOptions& options, const Admitted& admitted) {
  if (!options.target || options.target->max_charts == 0) return 0;
  return std::max(options.target->max_charts, admitted.counts.components);
}

/// Packs the maps of a surface that was scaled by 2^exponent. Returns the scale that they have on
/// their pages.
double pack_onto_pages(const Admitted& admitted, int exponent, const AtlasOptions& options,
                       const SplitCharts& charts, const Work& work, Atlas& atlas) {
  PackOptions pack = *options.pack;
  pack.effort *= options.effort.packing;
  // The frame of a map is nobody's choice: upright its borders are more likely to lie along texels.
  pack.upright = true;
  if (pack.snap) align_to_borders(charts.charts, charts.maps);
  if (pack.texels_per_unit > 0) {
    // 0 would leave the scale open.
    const double scaled = std::ldexp(pack.texels_per_unit, -exponent);
    pack.texels_per_unit = std::clamp(scaled, kLeastDensity, 1 / kLeastDensity);
  }
  SplitRules rules{.price = options.split_price,
                   .most_charts = most_charts(options, admitted),
                   .polygons = {options.admit.polygons, options.diagonals}};
  if (options.target) rules.seam_budget = options.target->seam_budget;
  Pages& pages = atlas.pages.emplace(
      rules.price > 0 ? pack_split_maps(admitted, rules, pack, options.float32, charts, work)
                      : pack_maps(charts.charts, pack, options.float32, charts.maps, work));
  const double scale = pages.texels_per_unit / pages.resolution;
  pages.texels_per_unit = std::ldexp(pages.texels_per_unit, exponent);
  return scale > 0 ? scale : 1;
}

/// Splits the charts that are sound, but not in the numbers of the places that they were given.
/// Whether there is one.
bool rescue(const AtlasInput& input, const Admitted& admitted, const AtlasOptions& options,
            const std::vector<MappedChart>& placed, const Work& work, MappedSurface& mapped) {
  if (!promises(options.chart)) return false;  // a baseline is shown as it is
  if (!input.pins.empty() || most_charts(options, admitted) > 0) return false;
  if (placed.size() != mapped.maps.size()) return false;  // they were split for their pages
  std::vector<Index> which;
  for (Index c = 0; c < size_of(placed); ++c) {
    const bool is_sound = placed[c].outcome <= Outcome::kNotConverged && placed[c].fits_single;
    if (!is_sound) which.push_back(c);
  }
  return split_charts(admitted, {options.admit.polygons, options.diagonals}, which, options.chart,
                      work.untimed(), mapped.charts, mapped.maps);
}

}  // namespace

std::vector<Triangle> oriented_faces(const Atlas& atlas) {
  std::vector<Triangle> faces = atlas.faces;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (atlas.reversed[f]) std::swap(faces[f][1], faces[f][2]);
  }
  return faces;
}

void judge_atlas(int exponent, bool float32, const Work& work, Atlas& atlas) {
  const Numbers floats{.single = true, .exponent = exponent};
  const std::vector<Triangle> faces = oriented_faces(atlas);
  const AtlasRules rules{.excepted = atlas.excepted};
  atlas.certificate = certify_atlas(faces, atlas.uvs, rules, work.part(0, 0.5));
  std::vector<Vec2> single = atlas.uvs;
  for (Vec2& w : single) w = floats.nearest(w);
  atlas.single_certificate = single == atlas.uvs
                                 ? atlas.certificate
                                 : certify_atlas(faces, single, rules, work.part(0.5, 1));
  atlas.outcome = outcome_of(atlas, float32);
}

Atlas unwrap(const AtlasInput& input, const AtlasOptions& options, const Work& work) {
  Atlas atlas;
  const auto stage = [&](const char* name, double from, double to, auto&& body) {
    run_stage(name, work.part(from, to), atlas.stages,
              [&](StageStatistics&, const Work& inner) { body(inner); });
  };
  Admitted admitted;
  int exponent = 0;
  stage("admit", 0, kAdmitted, [&](const Work& inner) {
    admitted = admitted_surface(input.positions, input.faces, options, inner);
    arrange_surface(admitted, inner);
    exponent = bring_to_unit(admitted.surface, inner);
  });
  MappedSurface mapped =
      open_and_map(input, admitted, exponent, options, work.part(kAdmitted, kMapped), atlas.stages);
  if (asks_for_straight(input, options)) {
    stage("straighten", kMapped, kMapped,
          [&](const Work& inner) { straighten_charts(input, admitted, options, inner, mapped); });
  }
  Numbers numbers{.single = options.float32, .exponent = exponent};
  stage("place", kMapped, kPlaced, [&](const Work& inner) {
    separate_pieces(admitted, most_charts(options, admitted), mapped.charts, mapped.maps,
                    inner.aside());
    double page_scale = 1;
    std::vector<MappedChart> placed;
    std::vector<double> scales;
    for (int round = 0;; ++round) {
      placed = mapped.maps;
      scales = scale_by_density(input.densities, admitted, mapped.charts, placed);
      if (options.pack && input.pins.empty()) {
        page_scale = pack_onto_pages(admitted, exponent, options, {mapped.charts, placed, scales},
                                     inner, atlas);
        numbers.exponent = 0;
      } else {
        numbers.exponent = place_maps(mapped.charts, exponent, options.unit_square, options.float32,
                                      placed, inner);
      }
      if (round == kMostRescues || !rescue(input, admitted, options, placed, inner, mapped)) break;
    }
    assemble(input, admitted, mapped, placed, scales, page_scale, inner, atlas);
  });
  stage("certify", kPlaced, 1,
        [&](const Work& inner) { judge_atlas(numbers.exponent, options.float32, inner, atlas); });
  deliver(numbers, exponent, atlas);
  return atlas;
}

}  // namespace beltrami
