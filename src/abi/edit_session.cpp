#include "abi/edit_session.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "abi/buffers.h"
#include "abi/core_options.h"
#include "abi/pins.h"
#include "abi/unwrapped.h"
#include "admit/admit.h"
#include "admit/triangulate.h"
#include "atlas/pins.h"
#include "atlas/types.h"
#include "base/error.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "pack/types.h"
#include "session/ground.h"
#include "session/state.h"

namespace beltrami {
namespace {

constexpr std::size_t kBits = 64;  // of a word of EditSession::moved_

void require_no_others(const beltrami_surface& header) {
  const std::pair<const char*, const beltrami_buffer*> others[] = {
      {"face_labels", &header.face_labels},       {"densities", &header.densities},
      {"vertex_paint", &header.vertex_paint},     {"painted_edges", &header.painted_edges},
      {"materials", &header.materials},           {"pins", &header.pins},
      {"pin_kinds", &header.pin_kinds},           {"pin_directions", &header.pin_directions},
      {"straight_edges", &header.straight_edges}, {"rectangles", &header.rectangles}};
  for (const auto& [name, buffer] : others) {
    if (buffer->data == nullptr) continue;
    throw Error(Fault::kInvalidArgument,
                std::string("a session takes no ") + name +
                    " of the surface: leave them out; pins are set by beltrami_session_set_pins");
  }
}

Session open(const beltrami_surface& header, const Options& options, const LoadedSurface& surface,
             const std::vector<std::uint8_t>& diagonals, const Work& work) {
  const AtlasOptions atlas = atlas_options(options);
  AtlasInput input =
      atlas_input(header, surface, header.corner_uvs.data != nullptr, work.part(0, 0.2));
  GroundOptions ground{atlas.admit, atlas.fill_limit};
  ground.admit.polygons = {surface.face_of_triangle, diagonals};
  return Session({.positions = std::move(input.positions),
                  .faces = std::move(input.faces),
                  .seams = std::move(input.cuts.edges),
                  .corner_uvs = std::move(input.cuts.corner_uvs),
                  .pins = {}},
                 ground, chart_options(options), options.float32, work.part(0.2, 1));
}

/// Integers of the caller, no more than there are indices.
std::vector<std::uint64_t> read_many(const beltrami_buffer* buffer, std::uint64_t count,
                                     int components, const char* what) {
  if (count == 0) return {};
  if (buffer == nullptr) throw Error(Fault::kInvalidArgument, std::string(what) + " are NULL");
  if (count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    throw Error(Fault::kInvalidArgument, std::string("there are more than 2^31 - 1 ") + what);
  }
  return read_integers(*buffer, count, components, what, Work(1));
}

/// Integers of the caller below a number. Throws Error INDEX_OUT_OF_RANGE.
std::vector<Index> read_indices(const beltrami_buffer* buffer, std::uint64_t count, int components,
                                std::uint64_t end, const char* what) {
  std::vector<Index> indices;
  for (const std::uint64_t i : read_many(buffer, count, components, what)) {
    if (i >= end) {
      throw Error(Fault::kIndexOutOfRange, std::string("one of the ") + what + " is " +
                                               std::to_string(i) + ": there are " +
                                               std::to_string(end) + ", counted from 0");
    }
    indices.push_back(static_cast<Index>(i));
  }
  return indices;
}

}  // namespace

EditSession::EditSession(const beltrami_surface& header, const Options& options, const Work& work)
    : header_((require_no_others(header), header)),
      options_(options),
      surface_(read_surface(header, work.part(0, 0.1))),
      diagonals_(diagonals_of(surface_)),
      session_(open(header, options, surface_, diagonals_, work.part(0.1, 1))) {
  find_sources();
}

/// Copies follow the face that they are copies of, corner by corner. What has no area is a point:
/// other corners of a polygon follow the first of it that is in a chart. If none is, all follow a
/// corner of a face beside it.
void EditSession::follow_others(const std::vector<Index>& of_vertex) {
  const Ground& ground = session_.ground();
  const Polygons& polygons = surface_.polygons;
  const std::vector<Triangle>& triangles = surface_.triangulation.triangles;
  const auto welded = [&](Index corner) {
    return ground.admitted.welded(polygons.corners[corner]);
  };
  for (const Admitted::Copy& copy : ground.admitted.copies) {
    for (const Index corner : triangles[copy.face]) {
      for (const Index other : triangles[copy.first]) {
        if (source_[corner] == kNone && welded(corner) == welded(other)) {
          source_[corner] = source_[other];
        }
      }
    }
  }
  for (Index face = 0; face < polygons.count(); ++face) {
    Index beside = kNone;
    const auto find = [&](const auto& source_of) {
      for (Index c = polygons.begin(face); beside == kNone && c < polygons.end(face); ++c) {
        beside = source_of(c);
      }
    };
    find([&](Index corner) { return source_[corner]; });
    find([&](Index corner) { return of_vertex[welded(corner)]; });
    for (Index c = polygons.begin(face); c < polygons.end(face); ++c) {
      if (source_[c] == kNone) source_[c] = std::max(beside, 0);
    }
  }
}

void EditSession::find_sources() {
  const Ground& ground = session_.ground();
  const std::vector<Index>& vertex = surface_.polygons.corners;
  source_.assign(vertex.size(), kNone);
  std::vector<Index> of_vertex(surface_.positions.size(), kNone);
  for (Index f = 0; f < ground.face_count(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const Index input = ground.input_corner(f, k);
      const Index corner = surface_.triangulation.triangles[input / 3][input % 3];
      if (source_[corner] == kNone) source_[corner] = 3 * f + k;
      Index& known = of_vertex[ground.admitted.welded(vertex[corner])];
      if (known == kNone) known = 3 * f + k;
    }
  }
  follow_others(of_vertex);
  start_.assign(3 * static_cast<std::size_t>(ground.face_count()) + 1, 0);
  for (const Index source : source_) ++start_[source + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  std::vector<Index> next = start_;
  followers_.resize(source_.size());
  for (Index c = 0; c < size_of(source_); ++c) followers_[next[source_[c]]++] = c;
  changes_.reserve(source_.size());
  moved_.resize(source_.size() / kBits + 1);
}

void EditSession::find_changes() noexcept {
  changes_.clear();
  std::fill(moved_.begin(), moved_.end(), 0);
  for (const Index corner : session_.changes()) {
    for (Index i = start_[corner]; i < start_[corner + 1]; ++i) {
      const auto follower = static_cast<std::size_t>(followers_[i]);
      moved_[follower / kBits] |= std::uint64_t{1} << follower % kBits;
    }
  }
  for (std::size_t w = 0; w < moved_.size(); ++w) {
    for (std::uint64_t word = moved_[w]; word != 0; word &= word - 1) {
      changes_.push_back(static_cast<Index>(kBits * w) + std::countr_zero(word));
    }
  }
}

void EditSession::set_seams(const beltrami_buffer* edges, std::uint64_t count, bool open) {
  const std::vector<Index> ends = read_indices(edges, count, 2, header_.vertex_count, "edges");
  std::vector<std::array<Index, 2>> pairs;
  for (std::size_t i = 0; i < ends.size(); i += 2) pairs.push_back({ends[i], ends[i + 1]});
  session_.set_seams(pairs, open);
}

void EditSession::set_pins(const beltrami_buffer* corners, const beltrami_buffer* uvs,
                           std::uint64_t count) {
  if (count > 0 && (corners == nullptr || uvs == nullptr)) {
    throw Error(Fault::kInvalidArgument, "the pins or their UVs are NULL");
  }
  beltrami_surface with_pins = header_;
  with_pins.pin_count = count;
  if (count > 0) {
    with_pins.pins = *corners;
    with_pins.pin_uvs = *uvs;
  }
  session_.set_pins(read_pins(with_pins, surface_, atlas_options(options_), Work(1)));
}

void EditSession::set_pin_kinds(const beltrami_buffer* kinds, const beltrami_buffer* directions,
                                std::uint64_t count) {
  std::vector<Pin> pins = session_.state().pins;
  const auto set = pins.empty() ? 0 : static_cast<std::uint64_t>(pins.back().number) + 1;
  if (count != set) {
    throw Error(Fault::kInvalidArgument, "there are " + std::to_string(count) + " kinds, and " +
                                             std::to_string(set) +
                                             " pins are set: give one kind for each");
  }
  if (count == 0) return;
  if (kinds == nullptr) throw Error(Fault::kInvalidArgument, "the kinds of pins are NULL");
  const std::vector<std::uint64_t> numbers =
      read_integers(*kinds, count, 1, "kinds of pins", Work(1));
  std::vector<double> along;
  if (directions != nullptr) along = read_numbers(*directions, count, 2, "directions", Work(1));
  for (Pin& pin : pins) {
    hold_by(numbers[pin.number], along.empty() ? nullptr : &along[2 * pin.number], pin);
  }
  session_.set_pins(std::move(pins));
}

void EditSession::select(const beltrami_buffer* faces, std::uint64_t count) {
  const std::vector<Index> chosen = read_indices(faces, count, 1, header_.face_count, "faces");
  std::vector<Index> triangles;
  if (surface_.face_of_triangle.empty()) {
    triangles = chosen;
  } else {
    std::vector<bool> is_chosen(header_.face_count, false);
    for (const Index f : chosen) is_chosen[f] = true;
    for (Index t = 0; t < size_of(surface_.face_of_triangle); ++t) {
      if (is_chosen[surface_.face_of_triangle[t]]) triangles.push_back(t);
    }
  }
  session_.select(triangles);
}

std::vector<Index> EditSession::read_charts(const beltrami_buffer* charts, std::uint64_t count) {
  std::vector<Index> ids;
  // No chart has the greatest number: what is above it is none either.
  constexpr std::uint64_t kNoChart = std::numeric_limits<Index>::max();
  for (const std::uint64_t id : read_many(charts, count, 1, "charts")) {
    ids.push_back(static_cast<Index>(std::min(id, kNoChart)));
  }
  return ids;
}

void EditSession::lock(const beltrami_buffer* charts, std::uint64_t count, bool locked) {
  session_.lock(read_charts(charts, count), locked);
}

void EditSession::set_flags(const beltrami_buffer* charts, std::uint64_t count,
                            std::uint32_t flags) {
  constexpr std::uint32_t kAll = BELTRAMI_CHART_KEEP_FRAME | BELTRAMI_CHART_KEEP_SCALE |
                                 BELTRAMI_CHART_ALIGN | BELTRAMI_CHART_STACK;
  if ((flags & ~kAll) != 0) {
    throw Error(Fault::kInvalidArgument,
                "the flags " + std::to_string(flags) + " are no sum of BELTRAMI_CHART_ numbers");
  }
  session_.set_flags(read_charts(charts, count), static_cast<std::uint8_t>(flags));
}

void EditSession::renew(const beltrami_buffer* charts, std::uint64_t count, bool cold) {
  session_.renew(read_charts(charts, count), cold);
}

Updated EditSession::update(int steps, const Work& work) {
  const Updated done = session_.update(steps, work);
  find_changes();
  return done;
}

Outcome EditSession::pack(const std::vector<Index>& charts, const PackOptions& options,
                          const Work& work) {
  const Outcome outcome = session_.pack(charts, options, work);
  find_changes();
  return outcome;
}

void EditSession::restore(std::uint64_t mark) {
  session_.restore(mark);
  find_changes();
}

std::vector<Vec2> EditSession::uvs() const {
  CornerUvs all(session_.ground().face_count());
  for (const SessionChart& chart : session_.state().charts) all.read(chart);
  std::vector<Vec2> uvs;
  uvs.reserve(source_.size());
  for (const Index corner : source_) uvs.push_back(all[corner]);
  return uvs;
}

std::vector<Index> EditSession::face_charts() const {
  const SessionState& state = session_.state();
  std::vector<Index> charts(header_.face_count, kNone);
  for (Index f = 0; f < session_.ground().face_count(); ++f) {
    charts[surface_.face_of(session_.ground().admitted.input_face[f])] =
        state.charts[state.chart_of_face[f]].id;
  }
  return charts;
}

std::vector<Index> EditSession::opened() const {
  const Admitted& admitted = session_.ground().admitted;
  std::vector<Index> vertices;
  const EdgeMarks& opened = session_.state().opened;
  for (Index h = 0; h < size_of(opened); ++h) {
    if (!opened[h] || admitted.surface.edge(h) != h) continue;
    vertices.push_back(admitted.input_vertex[admitted.surface.origin(h)]);
    vertices.push_back(admitted.input_vertex[admitted.surface.target(h)]);
  }
  return vertices;
}

}  // namespace beltrami
