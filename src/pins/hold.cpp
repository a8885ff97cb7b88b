#include "pins/hold.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "base/portable_math.h"
#include "descend/contact.h"
#include "descend/line_search.h"
#include "descend/newton.h"
#include "descend/tutte.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "local/untangle.h"
#include "mesh/boundary.h"
#include "mesh/rest_shape.h"
#include "multilevel/descent.h"
#include "multilevel/policy.h"
#include "pins/line_similarity.h"
#include "pins/pin_field.h"
#include "pins/similarity.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// Of the way to the first face without area, or the first touch: the rest is left to relax.
constexpr double kShareOfWay = 0.6;
/// Of the way to the first touch: pins may have the boundary touch itself.
constexpr double kAllButThere = 1 - 1e-9;
constexpr double kShortStep = 0.01;  ///< of what remains
constexpr int kMostShortSteps = 6;   ///< in a row: stuck
/// Between two steps, enough to make room for the next one.
constexpr int kRelaxingSteps = 10, kRelaxingProxies = 2;
constexpr double kRelaxed = 1e-2;
/// Relative decrease in the last step: leaves the energy a thousandth too high.
constexpr double kTolerance = 1e-3;
/// Places nearer to each other than that, relative to the size of the map, are so for roundoff.
constexpr double kRoundoff = 1e-12;
/// The sine of an angle between lines that count as of one direction.
constexpr double kParallel = 1e-9;
/// Where the parts end in the progress.
constexpr double kThere = 0.5;

using Pins = std::span<const HeldVertex>;

/// That takes the vertices of the pins in the map to their places. Mirrored places fit none: then
/// it hardly matters.
Similarity similarity_of_points(const std::vector<Vec2>& uvs, Pins pins) {
  std::vector<std::pair<Vec2, Vec2>> pairs;
  for (const HeldVertex& pin : pins) pairs.emplace_back(uvs[pin.vertex], pin.place);
  return fit_similarity(pairs, false);
}

double size_of_map(const std::vector<Vec2>& uvs) {
  Eigen::AlignedBox2d box;
  for (const Vec2& w : uvs) box.extend(w);
  return box.sizes().norm();
}

/// The way of one map to some pins, in the unit of the mesh.
class WayToPins {
 public:
  WayToPins(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
            const ChartOptions& options, bool strict, const Work& work,
            std::span<const Index> ranks = {})
      : mesh_(mesh),
        rest_(rest),
        options_(options),
        work_(work),
        contact_(mesh.boundary, boundary_lengths(mesh), boundary_lengths(mesh)),
        strict_(strict),
        ranks_(ranks) {}

  void set_pins(const Similarity& frame, Pins pins) {
    held_.assign(mesh_.positions.size(), false);
    fixed_ = held_;
    slides_.assign(mesh_.positions.size(), Vec2::Zero());
    vertices_.clear();
    places_.clear();
    for (const HeldVertex& pin : pins) {
      held_[pin.vertex] = true;
      fixed_[pin.vertex] = pin.kind == PinKind::kPoint;
      if (!fixed_[pin.vertex]) slides_[pin.vertex] = frame.direction_back(pin.normal());
      vertices_.push_back(pin.vertex);
      places_.push_back(frame.back(pin.place));
    }
    any_slides_ =
        std::any_of(vertices_.begin(), vertices_.end(), [&](Index v) { return !fixed_[v]; });
    fix_what_drifts();
  }

  bool fits(const std::vector<Vec2>& uvs) const {
    const std::vector<Vec2> targets = targets_of(uvs);
    double farthest = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      farthest = std::max(farthest, (uvs[vertices_[i]] - targets[i]).norm());
    }
    return farthest <= kRoundoff * size_of_map(uvs);
  }

  /// Brings the pins of a map whose faces are positive to their targets. Where it cannot, returns
  /// false.
  bool go(std::vector<Vec2>& uvs) const;

  /// Minimises the energy with the pins held, without overlaps where there are none. Returns
  /// whether it was not cut short.
  bool relax(const Work& work, std::vector<Vec2>& uvs) const;

  /// The same from a map near the minimum. `presses`: whether its boundary did so when it was made,
  /// and does now.
  bool relax_nearby(const Work& work, std::vector<Vec2>& uvs, bool& presses) const;

 private:
  bool keeps_simple(const std::vector<Vec2>& uvs) const {
    return keeps_boundary_simple(options_) && contact_.is_simple(uvs);
  }
  /// Whether no two faces overlap, though the boundary may touch itself.
  bool is_sound(const std::vector<Vec2>& uvs) const {
    return certify_atlas(mesh_.faces, uvs, {}, work_).injective();
  }
  bool positive(const std::vector<Vec2>& uvs) const {
    return non_positive_faces(mesh_.faces, uvs, work_).empty();
  }
  /// Where lines alone are given, all in one direction, the map could drift along it: one vertex
  /// then stays, which is no loss.
  void fix_what_drifts() {
    Index first = kNone;
    for (const Index v : vertices_) {
      if (fixed_[v]) return;
      if (first == kNone) first = v;
      const Vec2 &a = slides_[first], &b = slides_[v];
      if (std::abs(a.x() * b.y() - a.y() * b.x()) > kParallel) return;
    }
    if (first != kNone) fixed_[first] = true;
  }
  /// Per pin its place, or the nearest one of its line.
  std::vector<Vec2> targets_of(const std::vector<Vec2>& uvs) const {
    std::vector<Vec2> targets = places_;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Vec2 &normal = slides_[vertices_[i]], &at = uvs[vertices_[i]];
      if (!normal.isZero(0)) targets[i] = at + normal.dot(places_[i] - at) * normal;
    }
    return targets;
  }
  void put_in_place(std::vector<Vec2>& uvs) const {
    const std::vector<Vec2> targets = targets_of(uvs);
    for (std::size_t i = 0; i < vertices_.size(); ++i) uvs[vertices_[i]] = targets[i];
  }
  std::vector<Vec2> remaining(const std::vector<Vec2>& uvs) const {
    std::vector<Vec2> displacements = targets_of(uvs);
    for (std::size_t i = 0; i < vertices_.size(); ++i) displacements[i] -= uvs[vertices_[i]];
    return displacements;
  }
  bool boundary_is_held() const {
    return std::all_of(mesh_.boundary.begin(), mesh_.boundary.end(),
                       [&](Index v) { return held_[v]; });
  }

  /// Composite majorization alone, for the start is near the minimum; but not with straight
  /// borders, which `strict_` says.
  NewtonOptions last_steps() const {
    NewtonOptions newton = newton_options(options_);
    newton.ranks = ranks_;
    if (any_slides_) newton.slides = &slides_;
    if (strict_) return newton;
    newton.proxy_steps = 0;
    newton.tolerance = std::max(newton.tolerance, kTolerance);
    return newton;
  }
  NewtonOptions relaxing_steps() const {
    NewtonOptions newton = newton_options(options_);
    newton.ranks = ranks_;
    if (any_slides_) newton.slides = &slides_;
    newton.max_iterations = kRelaxingSteps;
    newton.proxy_steps = kRelaxingProxies;
    newton.tolerance = std::max(newton.tolerance, kRelaxed);
    return newton;
  }
  bool minimise(NewtonOptions newton, bool simple, const Work& work, std::vector<Vec2>& uvs) const;
  std::optional<bool> relax_freely(const Work& work, std::vector<Vec2>& uvs) const;
  std::optional<bool> relax_pressed(const Work& work, std::vector<Vec2>& uvs) const;
  bool minimise_soundly(const Work& work, std::vector<Vec2>& uvs) const;
  bool embed(std::vector<Vec2>& uvs) const;
  enum class End { kMet, kStuck, kTouched };
  End walk(bool simple, std::vector<Vec2>& uvs) const;
  bool untangle_all(std::vector<Vec2> uvs, std::vector<Vec2>& result) const;

  const DiskMesh& mesh_;
  const std::vector<RestTriangle>& rest_;
  const ChartOptions& options_;
  const Work work_;
  const BoundaryContact contact_;
  std::vector<bool> held_;    // per vertex
  std::vector<bool> fixed_;   // likewise: points, and what stays so that the map does not drift
  std::vector<Vec2> slides_;  // per vertex as NewtonOptions has it
  bool any_slides_ = false;
  const bool strict_;  // pins may not have the boundary touch itself
  const std::span<const Index> ranks_;
  std::vector<Index> vertices_;
  std::vector<Vec2> places_;
};

bool WayToPins::minimise(NewtonOptions newton, bool simple, const Work& work,
                         std::vector<Vec2>& uvs) const {
  const auto run = [&] { return minimise_energy(mesh_.faces, rest_, fixed_, uvs, newton, work); };
  if (!simple) return !run().is_cut_short;
  if (!contact_.is_pressed(uvs)) {
    newton.admissible = [&](const std::vector<Vec2>& map) { return contact_.is_simple(map); };
    NewtonResult free = run();
    if (!free.refused) return !free.is_cut_short;
    uvs = std::move(free.admitted);
    newton.admissible = nullptr;
  }
  newton.contact = &contact_;
  return !run().is_cut_short;
}

/// From a map whose boundary touches itself, to the last one before it overlaps.
bool WayToPins::minimise_soundly(const Work& work, std::vector<Vec2>& uvs) const {
  NewtonOptions newton = last_steps();
  newton.admissible = [&](const std::vector<Vec2>& map) { return is_sound(map); };
  NewtonResult result = minimise_energy(mesh_.faces, rest_, fixed_, uvs, newton, work);
  if (result.refused) uvs = std::move(result.admitted);
  return !result.is_cut_short && !result.refused;
}

bool WayToPins::relax(const Work& work, std::vector<Vec2>& uvs) const {
  const bool simple = keeps_simple(uvs);
  if (!simple && keeps_boundary_simple(options_) && is_sound(uvs)) {
    return minimise_soundly(work, uvs);
  }
  return minimise(last_steps(), simple, work, uvs);
}

/// Without a look at the boundary, which may not touch itself afterwards; none where it does.
std::optional<bool> WayToPins::relax_freely(const Work& work, std::vector<Vec2>& uvs) const {
  std::vector<Vec2> free = uvs;
  const bool converged = minimise(last_steps(), false, work, free);
  const std::vector<Vec2> before = free;
  const auto holds = [&] {
    for (std::size_t v = 0; v < held_.size(); ++v) {
      if (held_[v] && free[v] != before[v]) return false;
    }
    return true;
  };
  const bool sound = contact_.is_simple(free) ||
                     (options_.parts_touching && open_touching_sides(mesh_, work, free) && holds());
  if (!sound) return std::nullopt;
  uvs.swap(free);
  return converged;
}

/// With the barrier of the boundary; none where steps too few have gained nothing.
std::optional<bool> WayToPins::relax_pressed(const Work& work, std::vector<Vec2>& uvs) const {
  const auto energy = [&](const std::vector<Vec2>& map) {
    return mean_energy(options_.energy, mesh_.faces, rest_, map, work);
  };
  NewtonOptions newton = last_steps();
  newton.contact = &contact_;
  std::vector<Vec2> pressed = uvs;
  const bool converged =
      !minimise_energy(mesh_.faces, rest_, fixed_, pressed, newton, work).is_cut_short;
  if (!converged && energy(pressed) > energy(uvs)) return std::nullopt;
  uvs.swap(pressed);
  return converged;
}

bool WayToPins::relax_nearby(const Work& work, std::vector<Vec2>& uvs, bool& presses) const {
  const bool did_press = std::exchange(presses, false);
  if (!keeps_simple(uvs)) return relax(work, uvs);
  std::optional<bool> converged;
  if (!did_press) converged = relax_freely(work, uvs);
  if (converged) return *converged;
  converged = relax_pressed(work, uvs);
  if (converged) {
    presses = contact_.is_pressed(uvs);
    return *converged;
  }
  if (did_press) converged = relax_freely(work, uvs);
  return converged.value_or(false);
}

/// Tutte's embedding in the polygon of the pins, which cannot fold where that is convex.
bool WayToPins::embed(std::vector<Vec2>& uvs) const {
  PinField field(mesh_, vertices_, work_);
  std::vector<Vec2> trial = field.harmonic(targets_of(uvs));
  if (!positive(trial)) return false;
  uvs = std::move(trial);
  return true;
}

/// `simple`: whether the boundary may not touch itself; kTouched: it was in the way.
WayToPins::End WayToPins::walk(bool simple, std::vector<Vec2>& uvs) const {
  PinField field(mesh_, vertices_, work_);
  std::vector<Vec2> trial(uvs.size());
  const Index most = most_pin_steps(mesh_.face_count());
  int short_steps = 0;
  bool touched = false;
  for (Index step = 0; step < most && short_steps < kMostShortSteps; ++step) {
    const Work inner = work_.part(kThere * step / most, kThere * step / most);
    inner.report(0);
    const std::vector<Vec2> direction =
        field.extend(uvs, remaining(uvs), [&](const std::vector<Vec2>& map) {
          return mean_energy(options_.energy, mesh_.faces, rest_, map, work_);
        });
    const auto move = [&](double length) {
      for (std::size_t v = 0; v < uvs.size(); ++v) trial[v] = uvs[v] + length * direction[v];
      if (length == 1) put_in_place(trial);
      if (!positive(trial)) return false;
      const bool may_touch = length == 1 && !strict_;
      return !simple || (may_touch ? is_sound(trial) : contact_.is_simple(trial));
    };
    const double singular = first_singular_step(mesh_.faces, uvs, direction, work_);
    double reach = std::min(singular, 1 / kShareOfWay);
    if (simple) reach = contact_.first_touch(uvs, direction, reach);
    touched = touched || reach < std::min(singular, 1.0) || (simple && contact_.is_pressed(uvs));
    if (singular > 1 && reach >= kAllButThere && move(1)) {
      uvs.swap(trial);
      return End::kMet;
    }
    double length = kShareOfWay * std::min(reach, 1.0);
    while (length > kRoundoff && !move(length)) length *= 0.5;
    if (!(length > kRoundoff)) break;
    uvs.swap(trial);
    short_steps = length < kShortStep ? short_steps + 1 : 0;
    // Without time nothing would make room.
    const Work patient = work_.out_of_time() ? Work(1) : inner;
    minimise(relaxing_steps(), simple, patient, uvs);
  }
  return touched ? End::kTouched : End::kStuck;
}

/// From a map with folds.
bool WayToPins::untangle_all(std::vector<Vec2> uvs, std::vector<Vec2>& result) const {
  put_in_place(uvs);
  const Work patient = work_.out_of_time() ? Work(1) : work_.part(kThere, kThere);
  if (!positive(uvs) && !untangle(mesh_.faces, rest_, held_, uvs, patient)) return false;
  result = std::move(uvs);
  return true;
}

bool WayToPins::go(std::vector<Vec2>& uvs) const {
  if (boundary_is_held() && embed(uvs)) return true;
  std::vector<Vec2> trial = uvs;
  End end = End::kTouched;
  if (keeps_simple(trial)) end = walk(true, trial);
  if (end == End::kTouched && !strict_) {
    trial = uvs;
    end = walk(false, trial);
  }
  if (end == End::kMet) {
    uvs.swap(trial);
    return true;
  }
  if (strict_) return false;
  // From where it got stuck, and from the start.
  return untangle_all(std::move(trial), uvs) || untangle_all(uvs, uvs);
}

/// What is held, at its very numbers.
void put_at(Pins pins, std::vector<Vec2>& uvs) {
  for (const HeldVertex& pin : pins) {
    Vec2& w = uvs[pin.vertex];
    if (pin.kind == PinKind::kPoint || pin.kind == PinKind::kU) w.x() = pin.place.x();
    if (pin.kind == PinKind::kPoint || pin.kind == PinKind::kV) w.y() = pin.place.y();
    if (pin.kind == PinKind::kLine) w += pin.normal().dot(pin.place - w) * pin.normal();
  }
}

/// The map that meets the pins; nothing where none was found. `relaxed`: and has the least energy.
std::optional<HeldMap> meet(WayToPins& way, const std::vector<Vec2>& start, Pins pins, bool relaxed,
                            const Work& work) {
  const Similarity frame = fit_to_pins(start, pins);
  way.set_pins(frame, pins);
  HeldMap map{start, modulus(frame.turn)};
  if (!way.fits(start)) {
    if (!way.go(map.uvs)) return std::nullopt;
    if (relaxed) map.converged = way.relax(work.part(kThere, 1), map.uvs);
  }
  for (Vec2& w : map.uvs) w = frame(w);
  put_at(pins, map.uvs);
  return map;
}

/// That not all pins can be met: the first that `meets`, asked for the first few of them, finds out
/// of reach.
template <class Meets>
HeldMap first_failure(Pins pins, const Work& work, const Meets& meets) {
  // One pin is always met.
  std::size_t met = 1, failed = pins.size();
  while (failed - met > 1 && !work.out_of_time()) {
    const std::size_t middle = met + (failed - met) / 2;
    (meets(pins.first(middle)) ? met : failed) = middle;
  }
  HeldMap none;
  none.failed = static_cast<Index>(failed) - 1;
  return none;
}

}  // namespace

Vec2 HeldVertex::normal() const {
  switch (kind) {
    case PinKind::kU:
      return {1, 0};
    case PinKind::kV:
      return {0, 1};
    case PinKind::kLine:
      return Vec2(-along.y(), along.x()) / portable::hypot(along.x(), along.y());
    case PinKind::kPoint:
      break;
  }
  return Vec2::Zero();
}

Similarity fit_to_pins(const std::vector<Vec2>& uvs, std::span<const HeldVertex> pins) {
  std::vector<HeldVertex> points;
  for (const HeldVertex& pin : pins) {
    if (pin.kind == PinKind::kPoint) points.push_back(pin);
  }
  if (points.size() == pins.size() || points.size() > 1) return similarity_of_points(uvs, points);
  std::vector<LineFit> fits;
  for (const HeldVertex& pin : pins) {
    if (pin.kind == PinKind::kPoint) {
      fits.push_back({uvs[pin.vertex], pin.place, {1, 0}});
      fits.push_back({uvs[pin.vertex], pin.place, {0, 1}});
    } else {
      fits.push_back({uvs[pin.vertex], pin.place, pin.normal()});
    }
  }
  const LineSimilarity fit = fit_to_lines(fits);
  return {.turn = fit.turn, .from = Vec2::Zero(), .to = fit.shift};
}

HeldMap hold_pins(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<HeldVertex>& pins, const ChartOptions& options,
                  const Work& work) {
  const std::vector<RestTriangle> rest = rest_triangles(mesh.positions, mesh.faces, work);
  std::vector<Vec2> start = uvs;
  if (pins.size() > 2 && !non_positive_faces(mesh.faces, start, work).empty()) {
    start = start_map(mesh, rest, options, work);
  }
  WayToPins way(mesh, rest, options, false, work);
  if (auto met = meet(way, start, pins, true, work)) return *std::move(met);
  return first_failure(pins, work,
                       [&](Pins some) { return meet(way, start, some, false, work).has_value(); });
}

HeldMap drag_pins(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<HeldVertex>& pins, Touching touching,
                  const ChartOptions& options, const Work& work, const Known& known) {
  const std::vector<RestTriangle> rest = rest_triangles(mesh.positions, mesh.faces, work);
  const bool may_touch = touching == Touching::kAllowed;
  WayToPins way(mesh, rest, options, !may_touch, work, known.ranks);
  const auto reach = [&](Pins some, std::vector<Vec2>& map) {
    way.set_pins({}, some);
    return way.fits(map) || way.go(map);
  };
  HeldMap map{uvs};
  const bool met = reach(pins, map.uvs);
  if (!met && !may_touch) {
    HeldMap none;
    none.failed = 0;
    return none;
  }
  if (!met) {
    return first_failure(pins, work, [&](Pins some) {
      std::vector<Vec2> trial = uvs;
      return reach(some, trial);
    });
  }
  const Work relaxing = work.part(kThere, 1);
  if (!may_touch) {
    map.converged = way.relax(relaxing, map.uvs);
    put_at(pins, map.uvs);
    return map;
  }
  put_at(pins, map.uvs);
  map.presses = known.presses;
  map.converged = way.relax_nearby(relaxing, map.uvs, map.presses);
  return map;
}

}  // namespace beltrami
