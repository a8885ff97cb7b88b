#include "atlas/atlas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "admit/admit.h"
#include "admit/arrange_admitted.h"
#include "atlas/assemble.h"
#include "atlas/chart_parts.h"
#include "atlas/fit_page.h"
#include "atlas/keep_windings.h"
#include "atlas/map_charts.h"
#include "atlas/open.h"
#include "atlas/open_and_map.h"
#include "atlas/pack_maps.h"
#include "atlas/pages.h"
#include "atlas/place.h"
#include "atlas/rescue.h"
#include "atlas/snap.h"
#include "atlas/split_necks.h"
#include "atlas/straighten_charts.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "pack/types.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

/// Smaller surfaces are in the caches anyway.
constexpr Index kWorthArranging = 50'000;
// Where the stages end in the progress.
constexpr double kAdmitted = 0.03, kMapped = 0.83, kPlaced = 0.98;

/// What cannot be rounded where it was placed is split, and all is placed anew, so often: a chart
/// that was halved so often is a crumb.
constexpr int kMostRescues = 6;

/// Steps that the map of a chart takes where the chart may be split instead, unless another number
/// is asked for. Most charts take ten. Of 383 public files 372 have the same bits at 100. At 200
/// all of the others that reach their target reach it as before; beds of printers, which missed it,
/// take half to three quarters of the time that 500 take, and one of three reaches it.
constexpr int kMostSteps = 200;

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

/// Charts of faces with different labels are to share no page.
void group_by_labels(const std::vector<std::uint64_t>& labels, const Admitted& admitted,
                     const std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps) {
  if (labels.empty()) return;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    maps[c].page_group = labels[first_input_face(charts[c], admitted)];
  }
}

/// As many charts as there may be; 0: any number.
Index most_charts(const AtlasOptions& options, const Admitted& admitted) {
  if (!options.target || options.target->max_charts == 0) return 0;
  return std::max(options.target->max_charts, admitted.counts.components);
}

/// For the maps of a surface that was scaled by 2^exponent.
PackOptions pack_options(const AtlasOptions& options, int exponent) {
  PackOptions pack = *options.pack;
  pack.effort *= options.effort.packing;
  // The frame of a map is nobody's choice: upright its borders are more likely to lie along texels.
  pack.upright = true;
  if (pack.texels_per_unit > 0) {
    // 0 would leave the scale open.
    const double scaled = std::ldexp(pack.texels_per_unit, -exponent);
    pack.texels_per_unit = std::clamp(scaled, kLeastDensity, 1 / kLeastDensity);
  }
  return pack;
}

/// Packs the maps of a surface that was scaled by 2^exponent. Returns the scale that they have on
/// their pages.
double pack_onto_pages(const AtlasInput& input, const Admitted& admitted, int exponent,
                       const AtlasOptions& options, const SplitCharts& charts, const Work& work,
                       Atlas& atlas) {
  const PackOptions pack = pack_options(options, exponent);
  if (pack.snap) align_to_borders(charts.charts, charts.maps);
  if (options.label_pages) {
    group_by_labels(input.cuts.labels, admitted, charts.charts, charts.maps);
  }
  const bool is_painted = !input.hints.vertex_paint.empty() || !input.hints.edge_paint.empty();
  SplitRules rules{.price = is_painted ? 0 : options.fill_weight,
                   .most_charts = most_charts(options, admitted),
                   .polygons = options.admit.polygons};
  if (options.target) rules.seam_budget = options.target->seam_budget;
  Pages& pages = atlas.pages.emplace(
      rules.price > 0 ? pack_split_maps(admitted, rules, pack, options.float32, charts, work)
                      : pack_maps(charts.charts, pack, options.float32, charts.maps, work));
  const double scale = pages.texels_per_unit / pages.resolution;
  pages.texels_per_unit = std::ldexp(pages.texels_per_unit, exponent);
  return scale > 0 ? scale : 1;
}

/// Whether charts may be split for their places: not where their number is bound, or pins hold
/// them, nor those of a baseline, which is shown as it is.
bool may_split(const AtlasInput& input, const Admitted& admitted, const AtlasOptions& options) {
  return promises(options.chart) && input.pins.empty() && most_charts(options, admitted) == 0;
}

/// Splits the charts whose maps, scaled as they will be, are larger than a page at the density that
/// is asked for. Whether there is one.
bool split_for_pages(const AtlasInput& input, const Admitted& admitted, int exponent,
                     const AtlasOptions& options, const std::vector<MappedChart>& scaled,
                     const Work& work, MappedSurface& mapped) {
  if (!options.pack || options.pack->texels_per_unit == 0) return false;
  if (!may_split(input, admitted, options)) return false;
  const std::vector<Index> which =
      larger_than_page(mapped.charts, scaled, pack_options(options, exponent));
  return !which.empty() && split_in_place(admitted, options.admit.polygons, which, work.untimed(),
                                          mapped.charts, mapped.maps);
}

/// Splits the charts that are sound, but not in the numbers of the places that they were given.
/// Whether there is one.
bool rescue(const AtlasInput& input, const Admitted& admitted, const AtlasOptions& options,
            const std::vector<MappedChart>& placed, const Work& work, MappedSurface& mapped) {
  if (!may_split(input, admitted, options)) return false;
  if (placed.size() != mapped.maps.size()) return false;  // they were split for their pages
  std::vector<Index> which;
  for (Index c = 0; c < size_of(placed); ++c) {
    const bool is_sound = placed[c].outcome <= Outcome::kNotConverged && placed[c].fits_single;
    if (!is_sound) which.push_back(c);
  }
  return split_charts(admitted, options.admit.polygons, which, options.chart, work.untimed(),
                      mapped.charts, mapped.maps);
}

}  // namespace

Atlas unwrap(const AtlasInput& input, const AtlasOptions& asked, const Work& work) {
  Atlas atlas;
  AtlasOptions options = asked;
  const auto stage = [&](const char* name, double from, double to, auto&& body) {
    run_stage(name, work.part(from, to), atlas.stages,
              [&](StageStatistics&, const Work& inner) { body(inner); });
  };
  Admitted admitted;
  int exponent = 0;
  stage("admit", 0, kAdmitted, [&](const Work& inner) {
    admitted = admitted_surface(input.positions, input.faces, options, inner);
    // What follows goes over it many times, and takes half the time where neighbours lie close.
    if (admitted.surface.face_count() >= kWorthArranging) arrange_admitted(admitted, inner);
    exponent = bring_to_unit(admitted.surface, inner);
    // Charts between seams that are given, or as few as there can be, stay whole where they can.
    options.chart.may_be_split = options.target && may_split(input, admitted, options);
    const bool is_asked = options.chart.max_iterations != ChartOptions().max_iterations;
    if (options.chart.may_be_split && !is_asked) options.chart.max_iterations = kMostSteps;
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
      do {
        keep_windings(admitted, mapped.charts, mapped.maps, inner.aside());
        placed = mapped.maps;
        scales = scale_by_density(input.densities, admitted, mapped.charts, placed);
      } while (split_for_pages(input, admitted, exponent, options, placed, inner.aside(), mapped));
      if (options.pack && input.pins.empty()) {
        page_scale = pack_onto_pages(input, admitted, exponent, options,
                                     {mapped.charts, placed, scales}, inner, atlas);
        numbers.exponent = 0;
      } else {
        numbers.exponent = place_maps(mapped.charts, exponent, options.unit_square, options.float32,
                                      placed, inner);
      }
      if (round == kMostRescues || !rescue(input, admitted, options, placed, inner, mapped)) break;
    }
    assemble(input, options, admitted, {mapped, placed, scales, page_scale}, inner, atlas);
  });
  stage("certify", kPlaced, 1,
        [&](const Work& inner) { judge_atlas(numbers.exponent, options.float32, inner, atlas); });
  deliver(numbers, exponent, atlas);
  return atlas;
}

}  // namespace beltrami
