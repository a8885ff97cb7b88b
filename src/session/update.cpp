#include "session/update.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <tuple>

#include "atlas/open.h"
#include "atlas/rows.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "linear/elimination.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "pins/hold.h"
#include "session/carry.h"
#include "session/ground.h"
#include "session/recut.h"
#include "session/state.h"

namespace beltrami {
namespace {

constexpr double kCut = 0.1;  // where cutting ends in the progress
/// Relative gain of an update of few steps that is the last: as of the last of many steps. Sides
/// that lie on each other and are parted may never gain so little in one step that it says so.
constexpr double kSettled = 1e-3;

/// The failure of a chart, which is named by its first face.
Error named(const Error& error, const Ground& ground, const SessionChart& chart) {
  if (error.element().kind != ElementKind::kNothing) return error;
  const Index face = ground.name_of(chart.first);
  return {error.fault(), "the chart of face " + std::to_string(face) + ": " + error.what(),
          Element::face(static_cast<std::uint64_t>(face))};
}

/// Relative to the coordinates: a line goes through few numbers.
constexpr double kOnLine = 1e-12;

MetPin met_pin(const Pin& pin, Index corner) {
  return {corner, pin.uv, pin.kind, pin.along};
}

/// Whether a vertex lies where its pin wants it.
bool is_met(const ChartPin& pin, const Vec2& w) {
  const Vec2 normal = HeldVertex{pin.vertex, pin.place, pin.kind, pin.along}.normal();
  if (normal.isZero(0)) return w == pin.place;
  return std::abs(normal.dot(pin.place - w)) <= kOnLine * (w.norm() + pin.place.norm());
}

Eigen::AlignedBox2d box_of(const std::vector<Vec2>& uvs) {
  Eigen::AlignedBox2d box;
  for (const Vec2& w : uvs) box.extend(w);
  return box;
}

}  // namespace

/// Per chart, whether a seam on its border or inside it has been opened or closed.
std::vector<bool> Updater::affected() const {
  const Surface& surface = session_.ground_.admitted.surface;
  std::vector<bool> affected(next_.charts.size(), false);
  for (const Index h : next_.toggled) {
    affected[next_.chart_of_face[h / 3]] = true;
    affected[next_.chart_of_face[surface.twin[h] / 3]] = true;
  }
  return affected;
}

/// The edges of faces that their charts are cut at, seams or not any more.
EdgeMarks Updater::standing(const std::vector<Index>& faces) const {
  const Surface& surface = session_.ground_.admitted.surface;
  std::vector<Index> vertex(surface.twin.size(), kNone);  // per corner that of its chart
  for (const Index f : faces) {
    const Triangle& face = next_.vertices_in_chart(f);
    for (int k = 0; k < 3; ++k) vertex[3 * f + k] = face[k];
  }
  EdgeMarks standing(surface.twin.size(), false);
  for (const Index f : faces) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const Index twin = surface.twin[h];
      if (twin == kNone) continue;
      standing[h] = next_.chart_of_face[f] != next_.chart_of_face[twin / 3] ||
                    vertex[h] != vertex[Surface::next(twin)] ||
                    vertex[Surface::next(h)] != vertex[twin];
    }
  }
  return standing;
}

/// The order of charts one after another, each with its own; what meets of two has the later rank,
/// and what closes a hole the last. None where one has no order.
std::shared_ptr<const std::vector<Index>> Updater::ranks_after_cut(const AtlasChart& part) const {
  const Chart& chart = part.chart;
  std::vector<Index> ranks(chart.mesh.positions.size(), kNone);
  std::map<Index, Index> first;  // the rank that each old chart begins with
  Index count = 0;
  for (Index f = 0; f < part.real_faces; ++f) {
    const Index old = next_.chart_of_face[chart.input_face[f]];
    const SessionChart& before = next_.charts[old];
    if (!before.ranks) return nullptr;
    const auto [at, is_new] = first.try_emplace(old, count);
    if (is_new) count += size_of(*before.ranks);
    for (int k = 0; k < 3; ++k) {
      const Index of_old = (*before.ranks)[next_.vertices_in_chart(chart.input_face[f])[k]];
      Index& rank = ranks[chart.mesh.faces[f][k]];
      rank = std::max(rank, at->second + of_old);
    }
  }
  for (Index& rank : ranks) {
    if (rank == kNone) rank = count;
  }
  return std::make_shared<const std::vector<Index>>(std::move(ranks));
}

void Updater::cut() {
  if (next_.toggled.empty()) return;
  const Ground& ground = session_.ground_;
  const std::vector<bool> is_affected = affected();
  std::vector<Index> faces;
  for (Index f = 0; f < ground.face_count(); ++f) {
    if (is_affected[next_.chart_of_face[f]]) faces.push_back(f);
  }
  Recut cut = recut(ground, faces, next_.seams, next_.opened, standing(faces),
                    work_.part(0, kCut).named("cut"));
  // Edges to charts that are not cut anew stay as they are, on both sides.
  const std::vector<Index>& twin = ground.admitted.surface.twin;
  for (const Index f : faces) {
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      const bool is_inside = twin[h] == kNone || is_affected[next_.chart_of_face[twin[h] / 3]];
      if (is_inside) next_.opened[h] = false;
    }
  }
  for (const Index h : cut.opened) mark_edge(ground.admitted.surface, h, next_.opened);
  for (std::size_t c = 0; c < is_affected.size(); ++c) {
    if (is_affected[c]) session_.scratch_.read(next_.charts[c]);
  }
  std::vector<SessionChart> fresh;
  for (AtlasChart& part : cut.charts) {
    SessionChart chart;
    Carried carried = carry(ground, next_, session_.scratch_, part);
    chart.placed = carried.placed;
    chart.scale = carried.scale;
    chart.due = carried.warm ? Due::kWarm : Due::kCold;
    chart.presses = carried.presses;
    chart.ranks = ranks_after_cut(part);
    chart.pins = std::move(carried.pins);
    chart.uvs = std::make_shared<const std::vector<Vec2>>(std::move(carried.uvs));
    chart.first = first_input_face(part, ground.admitted);
    chart.part = std::make_shared<const AtlasChart>(std::move(part));
    fresh.push_back(std::move(chart));
  }
  number(fresh);
  replace(is_affected, std::move(fresh));
  next_.toggled.clear();
}

/// Each number goes on with the new chart that has most of the faces of the old one, and no new
/// chart has two.
void Updater::number(std::vector<SessionChart>& fresh) {
  std::vector<std::tuple<Index, Index, Index>> shares;  // -faces, number, new chart
  for (Index c = 0; c < size_of(fresh); ++c) {
    fresh[c].id = kNone;
    std::map<Index, Index> faces;
    auto own = faces.end();  // neighbours are of one chart
    for (Index f = 0; f < fresh[c].faces(); ++f) {
      const Index old = next_.chart_of_face[fresh[c].part->chart.input_face[f]];
      if (own == faces.end() || own->first != old) own = faces.try_emplace(old, 0).first;
      ++own->second;
    }
    for (const auto& [old, count] : faces) shares.emplace_back(-count, next_.charts[old].id, c);
  }
  std::sort(shares.begin(), shares.end());
  std::set<Index> given;
  for (const auto& [faces, id, c] : shares) {
    if (fresh[c].id == kNone && given.insert(id).second) fresh[c].id = id;
  }
  for (SessionChart& chart : fresh) {
    if (chart.id == kNone) chart.id = next_.next_id++;
  }
}

void Updater::replace(const std::vector<bool>& affected, std::vector<SessionChart> fresh) {
  std::vector<SessionChart> charts = std::move(fresh);
  for (std::size_t c = 0; c < affected.size(); ++c) {
    if (!affected[c]) charts.push_back(std::move(next_.charts[c]));
  }
  std::sort(charts.begin(), charts.end(),
            [](const SessionChart& a, const SessionChart& b) { return a.first < b.first; });
  next_.charts = std::move(charts);
  for (Index c = 0; c < size_of(next_.charts); ++c) next_.own_faces(c);
}

/// The pins of each chart. Throws Error PINS where two of one vertex lie apart.
std::vector<Updater::Pins> Updater::pins_of_charts() const {
  std::vector<Pins> pins(next_.charts.size());
  std::map<std::pair<Index, Index>, Index> first_at;  // the first pin of a vertex of a chart
  for (Index i = 0; i < size_of(next_.pins); ++i) {
    const Pin& pin = next_.pins[i];
    const Index corner = session_.ground_.own_corner(pin.face, pin.corner);
    if (corner == kNone) continue;  // of a face that is in no chart
    const Index c = next_.chart_of_face[corner / 3];
    const Index vertex = next_.vertices_in_chart(corner / 3)[corner % 3];
    const auto [at, is_first] = first_at.try_emplace({c, vertex}, i);
    if (is_first) {
      pins[c].push_back({vertex, pin.uv, i, pin.kind, pin.along});
    } else if (met_pin(next_.pins[at->second], 0) != met_pin(pin, 0)) {
      throw unmet(pin, "lies apart from " + name_of(next_.pins[at->second]) +
                           ", and both are of one UV vertex: give one place, or cut between them");
    }
  }
  return pins;
}

std::vector<MetPin> Updater::met_pins(const Pins& pins) const {
  std::vector<MetPin> met;
  for (const ChartPin& pin : pins) {
    const Pin& own = next_.pins[pin.pin];
    met.push_back(met_pin(own, 3 * own.face + own.corner));
  }
  return met;
}

/// Charts whose pins have changed are due.
void Updater::note_pins(const std::vector<Pins>& pins) {
  for (std::size_t c = 0; c < pins.size(); ++c) {
    SessionChart& chart = next_.charts[c];
    if (chart.due == Due::kNothing && met_pins(pins[c]) != chart.pins) chart.due = Due::kWarm;
  }
}

/// The charts to be mapped. Throws Error PINS where a pin is not where its vertex is held.
std::vector<Updater::Job> Updater::jobs(std::vector<Pins> pins) const {
  std::vector<Job> jobs;
  for (Index c = 0; c < size_of(next_.charts); ++c) {
    const SessionChart& chart = next_.charts[c];
    if (chart.due == Due::kNothing) continue;
    Job job{.chart = c,
            .pins = std::move(pins[c]),
            .held = held_vertices(next_, *chart.part),
            .ranks = chart.ranks};
    for (const ChartPin& pin : job.pins) {
      if (!job.held[pin.vertex] || is_met(pin, (*chart.uvs)[pin.vertex])) continue;
      throw unmet(next_.pins[pin.pin],
                  "is of a vertex that may not move: unlock its chart, or select its faces");
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

void Updater::map(Job& job, const Work& work) const {
  const SessionChart& chart = next_.charts[job.chart];
  std::vector<MetPin> met = met_pins(job.pins);
  const bool same_pins = std::equal(met.begin(), met.end(), chart.pins.begin(), chart.pins.end(),
                                    [](const MetPin& a, const MetPin& b) { return a.is_like(b); });
  if (!job.ranks) {
    const DiskMesh& mesh = chart.mesh();
    job.ranks = std::make_shared<const std::vector<Index>>(
        elimination_ranks(mesh.positions, mesh.faces, work));
  }
  const RemapTask task{.part = *chart.part,
                       .start = *chart.uvs,
                       .placed = chart.placed,
                       .warm = chart.due == Due::kWarm,
                       .scale = chart.scale,
                       .pins = job.pins,
                       .fit_pins = !same_pins,
                       .held = job.held,
                       .steps = steps_,
                       .ranks = *job.ranks,
                       .presses = chart.presses,
                       .flags = next_.flags_of(chart)};
  try {
    Drafted made = draft(task, session_.chart_, work);
    if (made.failed_pin != kNone) {
      job.error =
          unmet(next_.pins[made.failed_pin],
                "cannot be met together with those before it: move it back, or take it off");
      return;
    }
    job.draft = std::move(made.draft);
  } catch (const Error& error) {
    job.error = named(error, session_.ground_, chart);
  }
}

/// Where charts go that have had no place: in rows to the right of all others.
std::vector<Vec2> Updater::places(const std::vector<Job>& jobs) const {
  std::vector<Vec2> shifts(jobs.size(), Vec2::Zero());
  Eigen::AlignedBox2d taken;
  for (const SessionChart& chart : next_.charts) {
    if (chart.placed) taken.extend(box_of(*chart.uvs));
  }
  std::vector<std::size_t> homeless;
  std::vector<Eigen::AlignedBox2d> boxes;
  std::vector<Vec2> sizes;
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    const SessionChart& chart = next_.charts[jobs[j].chart];
    if (chart.placed || !jobs[j].draft || !jobs[j].draft->held.empty()) continue;
    homeless.push_back(j);
    Eigen::AlignedBox2d box = box_of(jobs[j].draft->placed);
    const double unit = std::ldexp(1.0, -jobs[j].draft->exponent);
    box = {Vec2(unit * box.min()), Vec2(unit * box.max())};
    boxes.push_back(box);
    sizes.emplace_back(box.sizes());
  }
  if (homeless.empty()) return shifts;
  const std::vector<Vec2> corners = place_in_rows(sizes);
  Vec2 origin = Vec2::Zero();
  if (!taken.isEmpty()) {
    origin = {taken.max().x() + 0.02 * taken.sizes().maxCoeff(), taken.min().y()};
  }
  for (std::size_t i = 0; i < homeless.size(); ++i) {
    shifts[homeless[i]] = origin + corners[i] - boxes[i].min();
  }
  return shifts;
}

void Updater::take(Job& job, const Vec2& shift) {
  SessionChart& chart = next_.charts[job.chart];
  chart.ranks = job.ranks;
  if (!job.draft) {  // it waits for the next update
    const Remapped judged = judge_as_is(*chart.part, *chart.uvs, chart.scale, work_.aside());
    chart.outcome = std::max(judged.outcome, Outcome::kNotConverged);
    chart.energy = judged.energy;
    return;
  }
  Remapped made =
      finish(*chart.part, *std::move(job.draft), shift, session_.float32_, work_.aside());
  std::vector<MetPin> met = met_pins(job.pins);
  const bool again = chart.due == Due::kWarm && chart.energy > 0 && chart.pins == met;
  const bool is_limited = steps_ > 0 && !work_.out_of_time();
  if (again && is_limited && chart.energy - made.energy <= kSettled * made.energy) {
    made.converged = true;
    if (made.outcome == Outcome::kNotConverged) made.outcome = Outcome::kOk;
  }
  const bool goes_on = !made.converged && (steps_ > 0 || work_.out_of_time());
  chart.due = goes_on ? Due::kWarm : Due::kNothing;
  chart.placed = true;
  chart.scale = made.scale;
  chart.presses = made.presses;
  chart.outcome = made.outcome;
  chart.energy = made.energy;
  chart.pins = std::move(met);
  if (made.uvs != *chart.uvs) {
    chart.uvs = std::make_shared<const std::vector<Vec2>>(std::move(made.uvs));
    chart.lies_on = nullptr;
  }
}

Updated Updater::report(Index mapped) const {
  Updated report;
  report.mapped = mapped;
  for (const SessionChart& chart : next_.charts) {
    if (chart.due != Due::kNothing) ++report.due;
    report.outcome = std::max(report.outcome, chart.outcome);
  }
  if (report.due > 0) report.outcome = std::max(report.outcome, Outcome::kNotConverged);
  return report;
}

Updated Updater::run() {
  cut();
  std::vector<Pins> pins = pins_of_charts();
  note_pins(pins);
  std::vector<Job> due = jobs(std::move(pins));
  const Work mapping = work_.part(kCut, 1).named("flatten");
  if (due.size() == 1) {
    map(due[0], mapping);
  } else {
    parallel_for(mapping, size_of(due), 1, [&](std::int64_t j, std::int64_t) {
      // One is mapped at each call, or a short time would never get anywhere.
      const bool waits = j > 0 && next_.charts[due[j].chart].due == Due::kWarm;
      if (!waits || !mapping.out_of_time()) map(due[j], mapping.aside());
    });
  }
  for (const Job& job : due) {
    if (job.error) throw Error(*job.error);
  }
  const std::vector<Vec2> shifts = places(due);
  Index mapped = 0;
  for (std::size_t j = 0; j < due.size(); ++j) {
    if (due[j].draft) ++mapped;
    take(due[j], shifts[j]);
  }
  return report(mapped);
}

Updated Session::update(int steps, const Work& work) {
  Updater updater(*this, steps, work);
  const Updated report = updater.run();
  commit(updater.result());
  return report;
}

}  // namespace beltrami
