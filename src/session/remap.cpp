#include "session/remap.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "atlas/map_charts.h"
#include "atlas/snap.h"
#include "base/error.h"
#include "descend/tutte.h"
#include "energy/energy.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "mesh/rest_shape.h"
#include "pins/hold.h"
#include "pins/similarity.h"
#include "repair/rounding.h"
#include "session/carry.h"
#include "session/state.h"

namespace beltrami {
namespace {

/// So many pins are met by a similarity.
constexpr std::size_t kFewPins = 2;

Vec2 scaled(const Vec2& w, int exponent) {
  return {std::ldexp(w.x(), exponent), std::ldexp(w.y(), exponent)};
}

bool any(const std::vector<bool>& flags) {
  return std::find(flags.begin(), flags.end(), true) != flags.end();
}

/// The real faces alone.
std::vector<Triangle> real_faces(const AtlasChart& part) {
  const std::vector<Triangle>& faces = part.chart.mesh.faces;
  return {faces.begin(), faces.begin() + part.real_faces};
}

/// One chart on its way.
class Mapper {
 public:
  Mapper(const RemapTask& task, const ChartOptions& options, const Work& work)
      : task_(task), options_(options), work_(work) {}

  Drafted run();

 private:
  bool is_free() const { return task_.pins.empty() && !any(task_.held); }
  void set_unit(double scale);
  std::vector<HeldVertex> pinned_places() const;
  std::vector<HeldVertex> held_places() const;
  void fit_pins();
  void map_anew();
  void hold(bool from_anywhere);
  void take_back();
  void align();

  const RemapTask& task_;
  const ChartOptions& options_;
  const Work& work_;
  std::vector<Vec2> start_;  // in the unit of the disk
  Drafted result_;
};

/// The disk in the unit of its map: at the scale that it is to have.
void Mapper::set_unit(double scale) {
  Draft& draft = result_.draft;
  draft.scale = scale;
  draft.disk = task_.part.chart.mesh;
  for (Vec3& p : draft.disk.positions) p *= scale;
  draft.exponent = normalise(draft.disk.positions, draft.disk.faces, work_).exponent;
}

std::vector<HeldVertex> Mapper::pinned_places() const {
  std::vector<HeldVertex> places;
  for (const ChartPin& pin : task_.pins) {
    const Vec2 place = scaled(pin.place, result_.draft.exponent);
    places.push_back({pin.vertex, place, pin.kind, pin.along});
  }
  return places;
}

std::vector<HeldVertex> Mapper::held_places() const {
  std::vector<HeldVertex> places = pinned_places();
  std::vector<bool> known(start_.size(), false);
  for (const HeldVertex& pin : places) known[pin.vertex] = true;
  for (std::size_t v = 0; v < task_.held.size(); ++v) {
    if (task_.held[v] && !known[v]) places.push_back({static_cast<Index>(v), start_[v]});
  }
  return places;
}

/// Takes the start to where its pins fit best, with its scale.
void Mapper::fit_pins() {
  if ((task_.flags & kKeepScale) != 0) {
    std::vector<std::pair<Vec2, Vec2>> pairs;
    for (const HeldVertex& pin : pinned_places()) {
      if (pin.kind == PinKind::kPoint) pairs.emplace_back(start_[pin.vertex], pin.place);
    }
    const Similarity fit = fit_similarity(pairs, true);
    for (Vec2& w : start_) w = fit(w);
    return;
  }
  const Similarity fit = fit_to_pins(start_, pinned_places());
  const int before = result_.draft.exponent;
  set_unit(result_.draft.scale * fit.scale());
  for (Vec2& w : start_) w = scaled(fit(w), result_.draft.exponent - before);
}

/// From nothing, at its scale, near where the chart was.
void Mapper::map_anew() {
  ChartOptions doubles = options_;
  doubles.float32 = false;
  doubles.unit_square = false;
  const std::vector<MappedChart> maps = map_charts({AtlasChart(task_.part)}, {}, doubles, work_);
  const MappedChart& map = maps[0];
  if (map.error) throw Error(*map.error, "a chart could not be mapped: cut it otherwise");
  Draft& draft = result_.draft;
  draft.outcome = map.outcome;
  draft.converged = map.outcome != Outcome::kNotConverged;
  std::vector<std::pair<Vec2, Vec2>> pairs;
  std::vector<Vec2> uvs;
  for (std::size_t v = 0; v < map.uvs.size(); ++v) {
    uvs.push_back(scaled(draft.scale * map.uvs[v], draft.exponent));
    if (task_.placed) pairs.emplace_back(uvs[v], start_[v]);
  }
  const Similarity back = fit_similarity(pairs, true);
  draft.uvs = uvs;
  for (Vec2& w : uvs) w = back(w);
  draft.placed = std::move(uvs);
}

/// Meets what is held, from the start or a new map.
void Mapper::hold(bool from_anywhere) {
  Draft& draft = result_.draft;
  std::vector<HeldVertex> places = held_places();
  if (places.empty()) places.push_back({draft.disk.boundary[0], start_[draft.disk.boundary[0]]});
  ChartOptions limited = options_;
  if (task_.steps > 0) limited.max_iterations = std::min(limited.max_iterations, task_.steps);
  const HeldMap map = from_anywhere
                          ? hold_pins(draft.disk, draft.placed, places, options_, work_)
                          : drag_pins(draft.disk, start_, places, Touching::kAllowed, limited,
                                      work_, {.presses = task_.presses, .ranks = task_.ranks});
  if (map.failed != kNone) {
    const auto failed = static_cast<std::size_t>(map.failed);
    if (failed < task_.pins.size()) {
      result_.failed_pin = task_.pins[failed].pin;
      return;
    }
    throw Error(Fault::kInvalidState,
                "the faces that may move find no room beside those that may not: select more of "
                "them, or unlock the chart");
  }
  draft.uvs = map.uvs;
  draft.converged = map.converged && draft.converged;
  draft.presses = map.presses;
  draft.scale *= map.scale;
  if (is_free()) return;
  draft.held.assign(draft.uvs.size(), false);
  for (const HeldVertex& place : places) draft.held[place.vertex] = true;
  draft.placed = draft.uvs;
}

/// A map that is free to move as a whole lies where the start did.
void Mapper::take_back() {
  Draft& draft = result_.draft;
  if (draft.uvs == start_) {
    draft.placed = draft.uvs;
    return;
  }
  std::vector<std::pair<Vec2, Vec2>> pairs;
  for (std::size_t v = 0; v < start_.size(); ++v) pairs.emplace_back(draft.uvs[v], start_[v]);
  const Similarity back = fit_similarity(pairs, true);
  draft.placed = draft.uvs;
  for (Vec2& w : draft.placed) w = back(w);
}

/// Turns a map that is free to move as a whole so that its straight borders lie along the axes,
/// about its middle.
void Mapper::align() {
  Draft& draft = result_.draft;
  const std::optional<Vec2> turn = turn_to_borders(draft.disk, draft.placed);
  if (!turn) return;
  Eigen::AlignedBox2d box;
  for (const Vec2& w : draft.placed) box.extend(w);
  const Similarity turned{{turn->x(), turn->y()}, box.center(), box.center()};
  for (Vec2& w : draft.placed) w = turned(w);
}

Drafted Mapper::run() {
  set_unit(task_.scale);
  for (const Vec2& w : task_.start) start_.push_back(scaled(w, result_.draft.exponent));
  const bool serves = task_.warm && mend_start(result_.draft.disk, task_.held, start_, work_);
  if (!serves) {
    map_anew();
    const bool keeps_scale = task_.placed && (task_.flags & kKeepScale) != 0;
    if (!is_free() && keeps_scale) {
      start_ = result_.draft.placed;
      if (!any(task_.held)) fit_pins();
      hold(false);
    } else if (!is_free()) {
      hold(true);
    } else if ((task_.flags & kAlign) != 0) {
      align();
    }
    return std::move(result_);
  }
  const bool fits = task_.fit_pins || task_.pins.size() <= kFewPins;
  if (!task_.pins.empty() && !any(task_.held) && fits) fit_pins();
  hold(false);
  if (is_free()) take_back();
  if (is_free() && (task_.flags & kAlign) != 0) align();
  return std::move(result_);
}

/// The mean energy of the real faces.
double energy_of(const AtlasChart& part, const std::vector<Vec3>& positions,
                 const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Triangle> faces = real_faces(part);
  const std::vector<RestTriangle> rest = rest_triangles(positions, faces, work);
  return mean_energy(Energy::kSymmetricDirichlet, faces, rest, uvs, work);
}

Outcome verdict(const AtlasChart& part, const Certificate& certificate,
                const std::vector<Vec2>& uvs, const Work& work) {
  if (certificate.injective()) return Outcome::kOk;
  // A boundary that is held may touch itself, and holes that are filled may be folded.
  return certify_atlas(real_faces(part), uvs, {}, work).injective() ? Outcome::kOk
                                                                    : Outcome::kNotInjective;
}

}  // namespace

Drafted draft(const RemapTask& task, const ChartOptions& options, const Work& work) {
  return Mapper(task, options, work).run();
}

Remapped finish(const AtlasChart& part, Draft draft, const Vec2& shift, bool float32,
                const Work& work) {
  const Numbers numbers{.single = float32, .exponent = draft.exponent};
  const Vec2 moved = scaled(shift, draft.exponent);
  if (!moved.isZero(0)) {
    for (Vec2& w : draft.placed) w += moved;
  }
  const Rounded rounded = round_map(draft.disk, draft.uvs, draft.placed, draft.held, numbers, work);
  Remapped result;
  result.scale = draft.scale;
  result.converged = draft.converged;
  result.presses = draft.presses;
  result.energy = energy_of(part, draft.disk.positions, rounded.uvs, work);
  result.outcome = verdict(part, rounded.certificate, rounded.uvs, work);
  if (result.outcome == Outcome::kOk && !result.converged) result.outcome = Outcome::kNotConverged;
  for (const Vec2& w : rounded.uvs) result.uvs.push_back(numbers.delivered(w));
  return result;
}

Remapped judge_as_is(const AtlasChart& part, const std::vector<Vec2>& uvs, double scale,
                     const Work& work) {
  const DiskMesh& mesh = part.chart.mesh;
  std::vector<Vec3> positions = mesh.positions;
  for (Vec3& p : positions) p *= scale;
  Remapped result;
  result.uvs = uvs;
  result.scale = scale;
  result.energy = energy_of(part, positions, uvs, work);
  result.outcome = verdict(part, certify(mesh.faces, mesh.boundary, uvs, work), uvs, work);
  return result;
}

double scale_of_map(const AtlasChart& part, const std::vector<Vec2>& uvs, const Work& work) {
  const std::vector<Triangle> faces = real_faces(part);
  const std::vector<RestTriangle> rest = rest_triangles(part.chart.mesh.positions, faces, work);
  if (non_positive_faces(faces, uvs, work).empty()) {
    return 1 / best_scale(Energy::kSymmetricDirichlet, faces, rest, uvs, work);
  }
  double on_ground = 0, in_plane = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Vec2 a = uvs[faces[f][1]] - uvs[faces[f][0]], b = uvs[faces[f][2]] - uvs[faces[f][0]];
    on_ground += rest[f].area();
    in_plane += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
  }
  const double scale = std::sqrt(in_plane / on_ground);
  return scale > 0 && std::isfinite(scale) ? scale : 1;
}

}  // namespace beltrami
