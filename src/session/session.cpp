#include "session/session.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "atlas/open.h"
#include "base/error.h"
#include "cut/edge_marks.h"
#include "cut/given.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "session/carry.h"
#include "session/recut.h"
#include "session/remap.h"

namespace beltrami {
namespace {

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

bool is_real_seam(const Ground& ground, Index h) {
  return ground.admitted.surface.twin[h] != kNone && (ground.inside.empty() || !ground.inside[h]);
}

/// The seams that a session begins with, but for edges inside polygons.
EdgeMarks first_seams(const Ground& ground, const SessionInput& input, const Work& work) {
  GivenCuts cuts;
  cuts.edges = input.seams;
  cuts.corner_uvs = input.corner_uvs;
  EdgeMarks marks = given_marks(ground.admitted, cuts, work);
  for (Index h = 0; h < size_of(marks); ++h) {
    if (marks[h] && !is_real_seam(ground, h)) marks[h] = false;
  }
  return marks;
}

}  // namespace

Session::Session(SessionInput input, const GroundOptions& options, const ChartOptions& chart,
                 bool float32, const Work& work)
    : ground_(make_ground(input.positions, input.faces, options, work.part(0, 0.5))),
      chart_(chart),
      float32_(float32),
      scratch_(ground_.face_count()) {
  const Index faces = ground_.face_count();
  state_.seams = first_seams(ground_, input, work.part(0.5, 0.6));
  state_.opened.assign(state_.seams.size(), false);
  state_.locked.assign(faces, false);
  state_.flags.assign(faces, 0);
  state_.chart_of_face.assign(faces, kNone);
  state_.place_in_chart.assign(faces, kNone);
  state_.pins = std::move(input.pins);
  std::vector<Index> all(faces);
  std::iota(all.begin(), all.end(), 0);
  Recut cut = recut(ground_, all, state_.seams, state_.opened, state_.opened, work.part(0.6, 1));
  for (const Index h : cut.opened) mark_edge(ground_.admitted.surface, h, state_.opened);
  for (AtlasChart& part : cut.charts) {
    SessionChart own;
    own.id = state_.next_id++;
    own.scale = std::ldexp(1.0, -ground_.exponent);
    own.first = first_input_face(part, ground_.admitted);
    own.part = std::make_shared<const AtlasChart>(std::move(part));
    std::vector<Vec2> uvs(own.mesh().positions.size(), Vec2::Zero());
    if (!input.corner_uvs.empty()) {
      for (Index f = 0; f < own.faces(); ++f) {
        for (int k = 0; k < 3; ++k) {
          const Index corner = ground_.input_corner(own.part->chart.input_face[f], k);
          uvs[own.mesh().faces[f][k]] = input.corner_uvs[corner];
        }
      }
      place_virtual(*own.part, uvs);
      own.placed = true;
      own.scale = scale_of_map(*own.part, uvs, work);
      Remapped judged = judge_as_is(*own.part, uvs, own.scale, work);
      own.outcome = judged.outcome;
      own.energy = judged.energy;
      own.due = Due::kNothing;
    }
    own.uvs = std::make_shared<const std::vector<Vec2>>(std::move(uvs));
    state_.charts.push_back(std::move(own));
    state_.own_faces(size_of(state_.charts) - 1);
  }
}

void Session::set_seams(std::span<const std::array<Index, 2>> edges, bool open) {
  const Surface& surface = ground_.admitted.surface;
  std::vector<Index> halfedges;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::vector<Index> found = ground_.halfedges_between(edges[i][0], edges[i][1]);
    const std::string name = "seam " + std::to_string(i) + ", between the vertices " +
                             std::to_string(edges[i][0]) + " and " + std::to_string(edges[i][1]);
    if (found.empty()) refuse(name + ", is no edge of the surface");
    const bool inside = std::any_of(found.begin(), found.end(), [&](Index h) {
      return surface.twin[h] != kNone && !is_real_seam(ground_, h);
    });
    if (inside && open) refuse(name + ", lies inside a polygon: no seam runs there");
    halfedges.insert(halfedges.end(), found.begin(), found.end());
  }
  state_.toggled.reserve(state_.toggled.size() + halfedges.size());  // all are noted, or none
  for (const Index h : halfedges) {
    if (surface.twin[h] == kNone) continue;
    const bool is_opened = state_.opened[h];
    if (state_.seams[h] == open && (open || !is_opened)) continue;
    for (const Index side : {h, surface.twin[h]}) {
      state_.seams[side] = open;
      state_.opened[side] = false;
    }
    if (open && is_opened) continue;  // it is cut already
    state_.toggled.push_back(h);
  }
}

void Session::select(std::span<const Index> faces) {
  std::vector<bool> selected;
  std::vector<bool> touched(state_.charts.size(), false);
  if (!faces.empty()) selected.assign(ground_.face_count(), false);
  for (const Index f : faces) {
    if (f < 0 || f >= size_of(ground_.face_of)) {
      refuse("there is no face " + std::to_string(f) + ": there are " +
             std::to_string(ground_.face_of.size()) + ", counted from 0");
    }
    const Index own = ground_.face_of[f];
    if (own == kNone) continue;
    selected[own] = true;
    touched[state_.chart_of_face[own]] = true;
  }
  state_.selected = std::move(selected);
  for (std::size_t c = 0; c < touched.size(); ++c) {
    Due& due = state_.charts[c].due;
    if (touched[c] && due == Due::kNothing) due = Due::kWarm;
  }
}

std::vector<Index> Session::indices_of(std::span<const Index> ids) const {
  std::map<Index, Index> of_id;
  for (Index c = 0; c < size_of(state_.charts); ++c) of_id[state_.charts[c].id] = c;
  std::vector<Index> indices;
  for (const Index id : ids) {
    const auto found = of_id.find(id);
    if (found == of_id.end()) {
      refuse("there is no chart of the number " + std::to_string(id) +
             ": numbers of charts that have gone are not given again");
    }
    indices.push_back(found->second);
  }
  return indices;
}

void Session::lock(std::span<const Index> ids, bool locked) {
  for (const Index c : indices_of(ids)) {
    const SessionChart& chart = state_.charts[c];
    for (Index f = 0; f < chart.faces(); ++f) {
      state_.locked[chart.part->chart.input_face[f]] = locked;
    }
  }
}

void Session::set_flags(std::span<const Index> ids, std::uint8_t flags) {
  for (const Index c : indices_of(ids)) {
    SessionChart& chart = state_.charts[c];
    const bool turns = (flags & ~state_.flags_of(chart) & kAlign) != 0;
    if (turns && chart.due == Due::kNothing) chart.due = Due::kWarm;
    for (Index f = 0; f < chart.faces(); ++f) {
      state_.flags[chart.part->chart.input_face[f]] = flags;
    }
  }
}

void Session::renew(std::span<const Index> ids, bool cold) {
  for (const Index c : indices_of(ids))
    state_.charts[c].due = cold ? Due::kCold : std::max(state_.charts[c].due, Due::kWarm);
}

std::uint64_t Session::save() {
  saved_.emplace(next_mark_, state_);
  return next_mark_++;
}

void Session::restore(std::uint64_t mark) {
  const auto found = saved_.find(mark);
  if (found == saved_.end()) {
    refuse("nothing is saved as number " + std::to_string(mark));
  }
  commit(found->second);
}

void Session::forget(std::uint64_t mark) {
  if (saved_.erase(mark) == 0) refuse("nothing is saved as number " + std::to_string(mark));
}

void Session::commit(SessionState next) {
  std::vector<Index> changed;
  std::vector<bool> is_read(state_.charts.size(), false);
  for (const SessionChart& chart : next.charts) {
    const Index old = state_.chart_of_face[chart.part->chart.input_face[0]];
    const SessionChart& as_before = state_.charts[old];
    if (as_before.part == chart.part && as_before.uvs == chart.uvs) continue;
    for (Index f = 0; f < chart.faces(); ++f) {
      const Index face = chart.part->chart.input_face[f];
      const Index was = state_.chart_of_face[face];
      if (!is_read[was]) scratch_.read(state_.charts[was]);
      is_read[was] = true;
      for (int k = 0; k < 3; ++k) {
        const Vec2& uv = (*chart.uvs)[chart.mesh().faces[f][k]];
        if (uv != scratch_[3 * face + k] || !state_.charts[was].placed) {
          changed.push_back(3 * face + k);
        }
      }
    }
  }
  changes_ = std::move(changed);
  state_ = std::move(next);
}

const Vec2& Session::uv(Index corner) const {
  const SessionChart& chart = state_.charts[state_.chart_of_face[corner / 3]];
  return (*chart.uvs)[state_.vertices_in_chart(corner / 3)[corner % 3]];
}

double Session::energy() const {
  double sum = 0, area = 0;
  for (const SessionChart& chart : state_.charts) {
    if (!chart.placed) return std::numeric_limits<double>::quiet_NaN();
    double own = 0;
    for (Index f = 0; f < chart.faces(); ++f) {
      const Triangle& face = chart.mesh().faces[f];
      const std::vector<Vec3>& p = chart.mesh().positions;
      own += triangle_area(p[face[0]], p[face[1]], p[face[2]]);
    }
    sum += own * chart.energy;
    area += own;
  }
  return sum / area;
}

AtlasCertificate Session::check(const Work& work) const {
  std::vector<Triangle> faces(ground_.face_count());
  std::vector<Vec2> uvs;
  AtlasRules rules;
  rules.excepted.assign(faces.size(), false);
  for (const SessionChart& chart : state_.charts) {
    const Index first = size_of(uvs);
    const bool is_stacked = state_.stacked_on(chart) != kNone;
    for (Index f = 0; f < chart.faces(); ++f) {
      Triangle& face = faces[chart.part->chart.input_face[f]];
      for (int k = 0; k < 3; ++k) face[k] = first + chart.mesh().faces[f][k];
      rules.excepted[chart.part->chart.input_face[f]] = is_stacked;
    }
    uvs.insert(uvs.end(), chart.uvs->begin(), chart.uvs->end());
  }
  return certify_atlas(faces, uvs, rules, work);
}

}  // namespace beltrami
