#include "atlas/pack_uvs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "admit/orient.h"
#include "atlas/margin.h"
#include "atlas/round_chart.h"
#include "base/disjoint_sets.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "exact/orientation.h"
#include "mesh/disk_mesh.h"
#include "repair/rounding.h"

namespace beltrami {
namespace {

/// A chart with its vertices and faces in numbers of the whole.
struct UvChart {
  std::vector<Index> vertices, faces;
  PackChart shape;
  double area = 0, area_on_surface = 0;
  Vec2 origin = Vec2::Zero();  ///< what was taken from the points: near 0 numbers are dense
};

double area_of(const std::vector<Vec2>& uvs, const Triangle& face) {
  const Vec2 p = uvs[face[1]] - uvs[face[0]], q = uvs[face[2]] - uvs[face[0]];
  return 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
}

bool is_kept(const UvMesh& mesh, Index f) {
  return !mesh.kept_page.empty() && mesh.kept_page[f] != kNone;
}

/// Per face whether it has an area in the plane, or stays whatever it has.
std::vector<bool> faces_of_charts(const UvMesh& mesh) {
  std::vector<bool> found(mesh.faces.size());
  PollSometimes poll;
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    poll();
    const auto [a, b, c] = mesh.faces[f];
    found[f] = is_kept(mesh, f) || orientation(mesh.uvs[a], mesh.uvs[b], mesh.uvs[c]) != 0;
  }
  return found;
}

/// Numbers charts by their least face. In none are sets of faces without area in the plane, nor
/// faces that have none on the surface either: these tie no charts together.
std::vector<Index> charts_of_faces(const UvMesh& mesh) {
  const std::vector<bool> counts = faces_of_charts(mesh);
  const auto ties = [&](Index f) {
    return counts[f] || mesh.excepted.empty() || !mesh.excepted[f];
  };
  DisjointSets sets(size_of(mesh.uvs));
  for (Index v = 0; v < size_of(mesh.uvs); ++v) sets.make(v);
  PollSometimes poll;
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    poll();
    if (!ties(f)) continue;
    sets.unite(mesh.faces[f][0], mesh.faces[f][1]);
    sets.unite(mesh.faces[f][1], mesh.faces[f][2]);
  }
  std::vector<bool> is_chart(mesh.uvs.size(), false);
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    if (counts[f]) is_chart[sets.root(mesh.faces[f][0])] = true;
  }
  std::vector<Index> number(mesh.uvs.size(), kNone), chart_of_face(mesh.faces.size(), kNone);
  Index count = 0;
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    const Index root = sets.root(mesh.faces[f][0]);
    if (!ties(f) || !is_chart[root]) continue;
    if (number[root] == kNone) number[root] = count++;
    chart_of_face[f] = number[root];
  }
  if (count == 0) {
    throw Error(Fault::kZeroArea,
                "no face has an area between its UVs: there is nothing to pack (unwrap the mesh)");
  }
  return chart_of_face;
}

[[noreturn]] void refuse_kept(Index face, const std::string& why) {
  throw Error(Fault::kInvalidArgument, "its chart cannot stay where it is: " + why,
              Element::face(static_cast<std::uint64_t>(face)));
}

/// Notes on which page a chart stays.
void keep(const UvMesh& mesh, UvChart& chart) {
  if (mesh.kept_page.empty()) return;
  const Index page = mesh.kept_page[chart.faces.front()];
  for (const Index f : chart.faces) {
    if (mesh.kept_page[f] != page) refuse_kept(f, "its faces are to stay on different pages");
  }
  if (page == kNone) return;
  for (const Index f : chart.faces) {
    for (const Index v : mesh.faces[f]) {
      const Vec2& w = mesh.uvs[v];
      if (w.minCoeff() >= 0 && w.maxCoeff() <= 1) continue;
      refuse_kept(f, "it is not inside its page, the unit square");
    }
  }
  chart.shape.kept = Placement{.page = page};
}

std::vector<UvChart> charts_of(const UvMesh& mesh, const std::vector<Index>& chart_of_face) {
  std::vector<UvChart> charts;
  std::vector<Index> number(mesh.uvs.size(), kNone);
  PollSometimes poll;
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    poll();
    if (chart_of_face[f] == kNone) continue;
    if (chart_of_face[f] == size_of(charts)) charts.emplace_back();
    UvChart& chart = charts[chart_of_face[f]];
    chart.faces.push_back(f);
    Triangle face = mesh.faces[f];
    chart.area += area_of(mesh.uvs, face);
    if (!mesh.areas.empty()) chart.area_on_surface += mesh.areas[f];
    for (Index& v : face) {
      if (number[v] == kNone) {
        number[v] = size_of(chart.vertices);
        chart.vertices.push_back(v);
        chart.shape.points.push_back(mesh.uvs[v]);
      }
      v = number[v];
    }
    chart.shape.faces.push_back(face);
  }
  for (UvChart& chart : charts) {
    keep(mesh, chart);
    if (!mesh.own_turns.empty()) chart.shape.own_turns = mesh.own_turns[chart.faces.front()];
    if (!mesh.page_labels.empty()) chart.shape.group = mesh.page_labels[chart.faces.front()];
    if (chart.shape.kept) continue;
    chart.origin = chart.shape.points.front();
    for (const Vec2& w : chart.shape.points) chart.origin = chart.origin.cwiseMin(w);
    for (Vec2& w : chart.shape.points) w -= chart.origin;
  }
  return charts;
}

bool stays(const UvChart& chart) {
  return chart.shape.kept.has_value();
}

/// The density of what is to be packed: units of the surface, or else of the input's UVs, per UV of
/// a chart; and for charts that stay, the texels per unit that they have.
double set_scales(const UvMesh& mesh, const PackOptions& options, std::vector<UvChart>& charts) {
  double area = 0, on_surface = 0, kept_area = 0, kept_on_surface = 0;
  for (const UvChart& chart : charts) {
    area += chart.area;
    on_surface += chart.area_on_surface;
    if (!stays(chart)) continue;
    kept_area += chart.area;
    kept_on_surface += chart.area_on_surface;
  }
  const bool equal_density = !mesh.areas.empty();
  // Charts without an area, here or there, are scaled as all of them are on the whole.
  const double mean = area > 0 && on_surface > 0 ? std::sqrt(on_surface / area) : 1;
  for (UvChart& chart : charts) {
    if (!equal_density) continue;
    const bool has_both = chart.area > 0 && chart.area_on_surface > 0;
    chart.shape.scale = has_both ? std::sqrt(chart.area_on_surface / chart.area) : mean;
  }
  double density = options.texels_per_unit;
  const bool any_stays = std::any_of(charts.begin(), charts.end(), stays);
  if (density == 0 && any_stays) {
    density = options.resolution;
    if (equal_density) {
      density *=
          kept_area > 0 && kept_on_surface > 0 ? std::sqrt(kept_area / kept_on_surface) : 1 / mean;
    }
  }
  for (UvChart& chart : charts) {
    if (stays(chart)) chart.shape.scale = options.resolution / density;
  }
  return density;
}

std::vector<int> signs_of(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs) {
  std::vector<int> signs;
  signs.reserve(faces.size());
  for (const auto& [a, b, c] : faces) signs.push_back(orientation(uvs[a], uvs[b], uvs[c]));
  return signs;
}

std::vector<Vec2> nearest(const Numbers& numbers, std::vector<Vec2> places) {
  for (Vec2& w : places) w = numbers.nearest(w);
  return places;
}

/// A disk whose faces all have one sign, `mirrored` if that is the negative one, is rounded so that
/// they keep it; anything else to nearest.
std::vector<Vec2> round_disk(const UvChart& chart, bool mirrored, const std::vector<Vec2>& placed,
                             const Numbers& numbers, const Work& work) {
  const auto reflected = [&](std::vector<Vec2> places) {
    if (mirrored) {
      for (Vec2& w : places) w.x() = -w.x();
    }
    return places;
  };
  try {
    const DiskMesh disk =
        build_disk(std::vector<Vec3>(chart.vertices.size(), Vec3::Zero()), chart.shape.faces, work);
    return reflected(
        round_map(disk, reflected(chart.shape.points), reflected(placed), numbers, work).uvs);
  } catch (const Error&) {  // no disk
    return nearest(numbers, placed);
  }
}

/// Such numbers for a chart, in which as few faces as possible change their sign.
std::vector<Vec2> rounded(const UvChart& chart, const std::vector<Vec2>& placed,
                          const Numbers& numbers, const Work& work) {
  std::vector<Vec2> result = nearest(numbers, placed);
  const std::vector<int> before = signs_of(chart.shape.faces, chart.shape.points);
  if (signs_of(chart.shape.faces, result) == before) return result;
  const auto all = [&](int sign) {
    return std::all_of(before.begin(), before.end(), [&](int s) { return s == sign; });
  };
  if (!all(1) && !all(-1)) return result;
  return round_disk(chart, all(-1), placed, numbers, work);
}

/// The numbers to deliver: doubles on the first page where single precision keeps their faces, with
/// the V axis up and down; else multiples of the page's step, if these do.
std::vector<Vec2> rounded_on_page(const UvChart& chart, Index page, const std::vector<Vec2>& placed,
                                  bool float32, const Work& work) {
  const Numbers doubles, floats{.single = true}, steps{.single = true, .step = step_of(page)};
  if (stays(chart)) return rounded(chart, placed, float32 ? floats : doubles, work);
  if (float32) return rounded(chart, placed, steps, work);
  std::vector<Vec2> result = rounded(chart, placed, doubles, work);
  const auto signs = [&](const std::vector<Vec2>& uvs) { return signs_of(chart.shape.faces, uvs); };
  const std::vector<int> expected = signs(result);
  if (page == 0 && signs(nearest(floats, result)) == expected &&
      signs(stored_downwards(result, work)) == expected) {
    return result;
  }
  std::vector<Vec2> single = rounded(chart, placed, steps, work);
  return signs(single) == expected ? single : result;
}

/// Turns faces over that run against most of their chart: a winding that changes is no fold.
void orient_faces(UvMesh& mesh, const Work& work) {
  std::vector<Triangle> judged;
  std::vector<Index> number;
  for (Index f = 0; f < size_of(mesh.faces); ++f) {
    const auto [a, b, c] = mesh.faces[f];
    if (a == b || b == c || c == a || (!mesh.excepted.empty() && mesh.excepted[f])) continue;
    judged.push_back(mesh.faces[f]);
    number.push_back(f);
  }
  if (judged.empty()) return;
  Gluing gluing = glue(mesh.uvs, judged, std::vector<Index>(judged.size(), 0), {}, work);
  orient(judged, gluing.twin, {}, work);
  for (std::size_t i = 0; i < judged.size(); ++i) mesh.faces[number[i]] = judged[i];
}

/// Whose distances count: charts that stay may have no area.
std::vector<Index> measured_charts(std::vector<Index> chart_of_face,
                                   const std::vector<UvChart>& charts) {
  for (Index& chart : chart_of_face) {
    if (chart != kNone && charts[chart].area == 0) chart = kNone;
  }
  return chart_of_face;
}

/// Corners that are in no chart go to a vertex of the first one; their faces count to it, or to the
/// chart that has another corner of theirs.
void put_aside(const UvMesh& mesh, const std::vector<UvChart>& charts, PackedUvs& packed) {
  std::vector<Index> chart_of_uv(mesh.uvs.size(), kNone);
  for (Index c = 0; c < size_of(charts); ++c) {
    for (const Index v : charts[c].vertices) chart_of_uv[v] = c;
  }
  const Index at = charts.front().vertices.front();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    Index& chart = packed.chart_of_face[f];
    if (chart != kNone) continue;
    for (const Index v : mesh.faces[f]) {
      if (chart == kNone) chart = chart_of_uv[v];
      if (chart_of_uv[v] != kNone) continue;
      packed.uvs[v] = packed.uvs[at];
      packed.page_of_uv[v] = packed.page_of_uv[at];
    }
    if (chart == kNone) chart = 0;
  }
}

void judge(const UvMesh& mesh, bool float32, const Work& work, PackedUvs& packed) {
  AtlasRules rules;
  rules.excepted = mesh.excepted;
  packed.certificate = certify_atlas(mesh.faces, packed.uvs, rules, work.part(0, 0.5));
  const std::vector<Vec2> single = nearest({.single = true, .exponent = 0}, packed.uvs);
  packed.single_certificate = single == packed.uvs
                                  ? packed.certificate
                                  : certify_atlas(mesh.faces, single, rules, work.part(0.5, 1));
  if (packed.certificate.injective()) return;
  // Single precision is to blame where the charts as they came are not.
  const bool folded = packed.certificate.orientations.first_bad_face != kNone;
  bool came_folded = !folded;
  const std::vector<int> signs = signs_of(mesh.faces, mesh.uvs);
  for (std::size_t f = 0; f < signs.size(); ++f) {
    came_folded = came_folded || (signs[f] <= 0 && (mesh.excepted.empty() || !mesh.excepted[f]));
  }
  packed.outcome = float32 && !came_folded ? Outcome::kNotInjectiveFloat32 : Outcome::kNotInjective;
}

}  // namespace

PackedUvs pack_uvs(UvMesh mesh, const PackOptions& options, bool float32, const Work& work) {
  PackedUvs packed;
  orient_faces(mesh, work.aside());
  packed.chart_of_face = charts_of_faces(mesh);
  std::vector<UvChart> charts = charts_of(mesh, packed.chart_of_face);
  PackOptions with_density = options;
  with_density.texels_per_unit = set_scales(mesh, options, charts);
  with_density.upright = options.turns > 1;  // no turns means that charts stay as they are
  std::vector<PackChart> shapes;
  std::vector<bool> kept;
  for (const UvChart& chart : charts) {
    shapes.push_back(chart.shape);
    kept.push_back(stays(chart));
  }
  const std::vector<Index> measured = measured_charts(packed.chart_of_face, charts);
  Pages& pages = packed.pages;
  pages.resolution = options.resolution;
  pages.asked_margin = options.margin;
  pages.page_of_chart.assign(charts.size(), 0);
  const auto deliver = [&](const Packing& packing, const Work& own) {
    packed.uvs.assign(mesh.uvs.size(), Vec2::Zero());
    packed.page_of_uv.assign(mesh.uvs.size(), 0);
    parallel_for(own, size_of(charts), 1, [&](std::int64_t c, std::int64_t) {
      const Placement& placement = packing.placements[c];
      pages.page_of_chart[c] = placement.page;
      std::vector<Vec2> placed = shapes[c].points;
      for (Vec2& w : placed) {
        w = kept[c] ? Vec2(w + tile_of(placement.page))
                    : place_on_page(packing, shapes[c], placement, options.resolution, w);
      }
      placed = rounded_on_page(charts[c], placement.page, placed, float32, own.aside());
      for (std::size_t v = 0; v < placed.size(); ++v) {
        packed.uvs[charts[c].vertices[v]] = placed[v];
        packed.page_of_uv[charts[c].vertices[v]] = placement.page;
      }
    });
    return least_margin(
        {mesh.faces, packed.uvs, measured, pages.page_of_chart, options.resolution, kept}, own);
  };
  const Packing packing =
      pack_and_deliver(shapes, with_density, deliver, work.part(0, 0.8).named("pack"));
  pages.count = packing.pages;
  pages.texels_per_unit = packing.texels_per_unit;
  pages.margin =
      least_margin({mesh.faces, packed.uvs, measured, pages.page_of_chart, options.resolution, {}},
                   work.aside());
  put_aside(mesh, charts, packed);
  measure_pages(mesh.faces, packed.uvs, packed.chart_of_face, pages);
  judge(mesh, float32, work.part(0.8, 1).named("certify"), packed);
  return packed;
}

}  // namespace beltrami
