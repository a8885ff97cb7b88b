#include "atlas/assemble.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "atlas/measure.h"
#include "atlas/open.h"
#include "atlas/pages.h"
#include "atlas/pins.h"
#include "atlas/seams.h"
#include "base/interrupt.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/seam_target.h"
#include "exact/atlas_certificate.h"
#include "mesh/chart.h"

namespace beltrami {
namespace {

/// The maps as UVs of the input's corners.
class Collector {
 public:
  Collector(const std::vector<Triangle>& faces, const PolygonParts& polygons,
            const Admitted& admitted, Atlas& atlas)
      : faces_(faces), polygons_(polygons), admitted_(admitted), atlas_(atlas) {
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
  /// Notes a UV vertex of a vertex of the input, if it has none.
  void note(Index vertex, Index uv) {
    if (uv_of_[vertex] == kNone) uv_of_[vertex] = uv;
  }

  /// The UV vertices of the polygon that a face is a part of, by the input's vertices.
  std::map<Index, Index> corners_of_polygon(Index face) const;

  const std::vector<Triangle>& faces_;
  const PolygonParts& polygons_;
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
    const Index input = admitted_.input_face[chart.input_face[f]];
    atlas_.chart_of_face[input] = c;
    atlas_.reversed[input] = part.is_reversed(admitted_, f);
    for (int k = 0; k < 3; ++k) {
      const int corner = part.input_corner(admitted_, f, k);
      const Index uv = place[chart.mesh.faces[f][k]];
      atlas_.faces[input][corner] = uv;
      note(faces_[input][corner], uv);
    }
  }
  atlas_.charts.push_back(info);
}

std::map<Index, Index> Collector::corners_of_polygon(Index face) const {
  std::map<Index, Index> corners;
  const std::span<const Index> polygon = polygons_.polygon;
  if (polygon.empty()) return corners;
  Index f = face;
  while (f > 0 && polygon[f - 1] == polygon[face]) --f;
  for (; f < size_of(faces_) && polygon[f] == polygon[face]; ++f) {
    if (atlas_.chart_of_face[f] == kNone) continue;
    for (int k = 0; k < 3; ++k) corners.try_emplace(faces_[f][k], atlas_.faces[f][k]);
  }
  return corners;
}

/// UV vertices for the faces that were set aside: each a point, where another face has a corner of
/// theirs, if one has, and one of their polygon before others; but for corners with pins.
void Collector::put_aside(const std::vector<PinAside>& pins) {
  std::map<std::pair<Index, int>, Vec2> pinned;
  for (const PinAside& pin : pins) pinned[{pin.face, pin.corner}] = pin.place;
  std::map<Index, Index> corners;
  Index polygon = kNone;
  for (const Index f : admitted_.set_aside) {
    const Triangle& face = faces_[f];
    if (!polygons_.polygon.empty() && polygons_.polygon[f] != polygon) {
      polygon = polygons_.polygon[f];
      corners = corners_of_polygon(f);
    }
    Index beside = 0;
    for (const Index v : {face[2], face[1], face[0]}) {
      if (uv_of_[v] != kNone) beside = uv_of_[v];
    }
    for (const Index v : face) {
      if (const auto known = corners.find(v); known != corners.end()) beside = known->second;
    }
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
        note(faces_[copy][k], atlas_.faces[copy][k]);
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
    atlas_.reversed[face.face] = face.runs_against != atlas_.reversed[face.on];
    atlas_.excepted[face.face] = true;
    for (int k = 0; k < 3; ++k) {
      const Index vertex = admitted_.welded(faces_[face.face][k]);
      const Index on = atlas_.faces[face.on][face.corner[k]];
      const auto [known, is_new] = own.try_emplace({vertex, on}, size_of(atlas_.uvs));
      atlas_.faces[face.face][k] = known->second;
      note(faces_[face.face][k], known->second);
      if (!is_new) continue;
      const Vec2 place = atlas_.uvs[on];
      atlas_.uvs.push_back(place);
      if (atlas_.pages) atlas_.page_of_uv.push_back(atlas_.page_of_uv[on]);
      atlas_.input_vertex.push_back(vertex);
    }
  }
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

/// Names the components whose maps reach the target, but not the numbers that they are rounded to.
void name_missed(const SeamTarget& target, const Admitted& admitted,
                 const std::vector<AtlasChart>& charts, Atlas& atlas) {
  std::map<Index, MissedTarget> components;
  std::map<Index, double> areas;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const ChartInfo& chart = atlas.charts[c];
    const Index component = admitted.topology.component_of_face[charts[c].chart.input_face.front()];
    const auto [at, is_new] = components.try_emplace(component, MissedTarget{chart.first_face});
    MissedTarget& sum = at->second;
    sum.first_face = std::min(sum.first_face, chart.first_face);
    sum.faces += chart.faces;
    sum.symmetric_dirichlet += chart.area * chart.symmetric_dirichlet;
    areas[component] += chart.area;
  }
  for (auto& [component, sum] : components) {
    sum.symmetric_dirichlet /= areas[component];
    if (sum.symmetric_dirichlet > target.energy + kEnergyTolerance) atlas.missed.push_back(sum);
  }
}

}  // namespace

void assemble(const AtlasInput& input, const AtlasOptions& options, const Admitted& admitted,
              const PlacedMaps& placed, const Work& work, Atlas& atlas) {
  atlas.admitted = admitted.counts;
  atlas.filled_holes = placed.surface.filled_holes;
  atlas.missed = placed.surface.missed;
  atlas.stacked_parts = placed.surface.stacked_parts;
  Collector collector(input.faces, options.admit.polygons, admitted, atlas);
  for (std::size_t c = 0; c < placed.maps.size(); ++c) {
    collector.add(placed.surface.charts[c], placed.maps[c].uvs);
    ChartInfo& chart = atlas.charts.back();
    chart.outcome = placed.maps[c].outcome;
    chart.error = placed.maps[c].error;
    chart.density = placed.scales[c] * placed.maps[c].scale;
    chart.pinned = placed.maps[c].pinned();
  }
  collector.stack(placed.surface.stacked);
  collector.share();
  // What has no area lies beside any of these.
  collector.put_aside(placed.surface.pins_aside);
  atlas.energy =
      measure_charts(placed.surface.charts, placed.maps, placed.page_scale, atlas.charts, work);
  // The means of charts count slivers that are too small in their component to have a say: so they
  // tell where the target is missed, but not whether.
  if (options.target && atlas.missed.empty() &&
      atlas.energy.symmetric_dirichlet > options.target->energy + kEnergyTolerance) {
    name_missed(*options.target, admitted, placed.surface.charts, atlas);
  }
  atlas.seam_length = seam_length(placed.surface.charts, admitted.input_vertex);
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

void deliver(const Numbers& numbers, int exponent, Atlas& atlas) {
  for (Vec2& w : atlas.uvs) w = numbers.delivered(w);
  for (ChartInfo& chart : atlas.charts) {
    chart.area = std::ldexp(chart.area, -2 * exponent);
    atlas.area += chart.area;
    chart.box = {numbers.delivered(chart.box.min()), numbers.delivered(chart.box.max())};
  }
  atlas.seam_length = std::ldexp(atlas.seam_length, -exponent);
}

}  // namespace beltrami
