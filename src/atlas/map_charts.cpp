#include "atlas/map_charts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "chart/flatten_disk.h"
#include "chart/memory_estimate.h"
#include "descend/flat_start.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "mesh/rest_shape.h"
#include "multilevel/inherited.h"
#include "pins/hold.h"
#include "simplify/replay.h"

namespace beltrami {
namespace {

/// Charts from here on gain from several threads. Below, side by side is faster.
constexpr Index kLargeChart = 20'000;
/// Charts of so few faces unfold without distortion, and cannot overlap.
constexpr Index kFewFaces = 2;
/// So many pins are met by a similarity.
constexpr std::size_t kFewPins = 2;
/// Where the free map of a chart with pins ends in the progress.
constexpr double kFree = 0.5;

/// The faces unfolded, their longest edge along the first axis: in rows of slivers the numbers of
/// the second one are small, and dense.
std::vector<Vec2> unfolded(const Chart& chart, const Work& work) {
  const DiskMesh& mesh = chart.mesh;
  std::vector<Vec2> uvs = unfolding(mesh, rest_triangles(mesh.positions, mesh.faces, work));
  Complex longest = 0;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Vec2 edge = uvs[mesh.target(h)] - uvs[mesh.origin(h)];
    const Complex z(edge.x(), edge.y());
    if (std::norm(z) > std::norm(longest)) longest = z;
  }
  const Complex turn = std::conj(longest) / modulus(longest);
  for (Vec2& w : uvs) {
    const Complex turned = turn * Complex(w.x(), w.y());
    w = {turned.real(), turned.imag()};
  }
  return uvs;
}

Vec2 scaled(const Vec2& w, int exponent) {
  return {std::ldexp(w.x(), exponent), std::ldexp(w.y(), exponent)};
}

/// Where a vertex lies that has come to its pin: what is held to the bit, and what is not in single
/// precision, as it is not rounded after this.
void put_in_place(const ChartPin& pin, Vec2& w) {
  const bool is_point = pin.kind == PinKind::kPoint;
  for (int k = 0; k < 2; ++k) {
    const bool held = is_point || pin.kind == (k == 0 ? PinKind::kU : PinKind::kV);
    w[k] = held ? pin.place[k] : static_cast<float>(w[k]);
  }
}

/// Holds the pins of a map of the disk, whose vertex i is order[i] of the chart.
void hold(const DiskMesh& disk, const Normalisation& frame, const std::vector<Index>& order,
          const std::vector<ChartPin>& pins, const ChartOptions& options, const Work& work,
          MappedChart& map) {
  std::vector<Index> place_of(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) place_of[order[i]] = static_cast<Index>(i);
  std::vector<Vec2> free;
  free.reserve(order.size());
  for (const Index v : order) free.push_back(scaled(map.uvs[v], frame.exponent));
  std::vector<HeldVertex> vertices;
  for (const ChartPin& pin : pins) {
    vertices.push_back(
        {place_of[pin.vertex], scaled(pin.place, frame.exponent), pin.kind, pin.along});
  }
  const HeldMap held = hold_pins(disk, free, vertices, options, work);
  if (held.failed != kNone) {
    map.failed_pin = pins[held.failed].pin;
    return;
  }
  for (std::size_t i = 0; i < order.size(); ++i) {
    map.uvs[order[i]] = scaled(held.uvs[i], -frame.exponent);
  }
  map.scale = held.scale;
  if (!held.converged) map.outcome = std::max(map.outcome, Outcome::kNotConverged);
}

/// A chart whose neighbours lie close in memory: vertex i is order[i] of it.
struct ArrangedChart {
  DiskMesh disk;
  std::vector<Index> order;
};

ArrangedChart arranged(const AtlasChart& part, const Work& work) {
  const DiskMesh& mesh = part.chart.mesh;
  ArrangedChart chart;
  if (!part.collapsed_into.empty()) {
    // So large a surface has been arranged as a whole.
    chart.disk = mesh;
    chart.order.resize(mesh.positions.size());
    std::iota(chart.order.begin(), chart.order.end(), 0);
    return chart;
  }
  std::vector<Triangle> faces = mesh.faces;
  chart.order = arrange(mesh.positions, faces, work).vertices;
  chart.disk = build_disk(in_order(mesh.positions, chart.order, work), std::move(faces), work);
  return chart;
}

/// What the chart inherits, for the disk whose vertex i is order[i] of it.
Inherited inherited_by(const DiskMesh& disk, const Normalisation& frame,
                       const std::vector<Index>& order, const AtlasChart& part, const Work& work) {
  Inherited inherited;
  if (!part.local_map.empty()) {
    for (const Index v : order) {
      inherited.start.push_back(scaled(part.local_map[v], frame.exponent));
    }
  }
  if (part.collapsed_into.empty()) return inherited;
  std::vector<Index> place_of(order.size()), into;
  for (std::size_t i = 0; i < order.size(); ++i) place_of[order[i]] = static_cast<Index>(i);
  for (const Index v : order) into.push_back(place_of[part.collapsed_into[v]]);
  inherited.level = collapsed_disk(disk, std::move(into), work);
  return inherited;
}

MappedChart flattened(const AtlasChart& part, const std::vector<ChartPin>& pins,
                      const ChartOptions& options, const Work& work) {
  const Chart& chart = part.chart;
  auto [disk, order] = arranged(part, work);
  const Normalisation frame = normalise(disk.positions, disk.faces, work);
  const double free = pins.empty() ? 1 : kFree;
  MappedChart map;
  if (disk.face_count() <= kFewFaces) {
    map.uvs = unfolded(chart, work);
  } else {
    const Inherited inherited = inherited_by(disk, frame, order, part, work);
    const Flattening result = flatten(disk, frame, inherited, options, work.part(0, free));
    map.outcome = result.status;
    map.uvs.resize(result.uvs.size());
    for (std::size_t i = 0; i < result.uvs.size(); ++i) map.uvs[order[i]] = result.uvs[i];
  }
  if (!pins.empty()) hold(disk, frame, order, pins, options, work.part(free, 1), map);
  return map;
}

MappedChart map_chart(const AtlasChart& part, const std::vector<ChartPin>& pins,
                      const ChartOptions& options, const Work& work) {
  const Chart& chart = part.chart;
  MappedChart map;
  try {
    map = chart.mesh.face_count() <= kFewFaces && pins.empty()
              ? MappedChart{unfolded(chart, work)}
              : flattened(part, pins, options, work);
  } catch (const Error& error) {
    map = {std::vector<Vec2>(chart.mesh.positions.size(), Vec2::Zero()), Outcome::kNotInjective,
           error.fault()};
  }
  if (!pins.empty()) map.held.assign(map.uvs.size(), false);
  for (const ChartPin& pin : pins) {
    map.held[pin.vertex] = true;
    put_in_place(pin, map.uvs[pin.vertex]);
  }
  return map;
}

/// Throws Error OUT_OF_MEMORY where a chart alone exceeds the limit. `bent`: by its pins, with
/// Newton steps on all its faces.
void require_memory(const DiskMesh& mesh, bool bent, const ChartOptions& options,
                    const Work& work) {
  constexpr std::uint64_t kMebibyte = 1 << 20;
  const auto limit = static_cast<std::uint64_t>(work.memory_limit());
  if (limit == 0) return;
  std::uint64_t estimate = estimate_memory(mesh, options, work.threads());
  if (bent) {
    ChartOptions newton = options;
    newton.method = Method::kCm;
    estimate = std::max(estimate, estimate_memory(mesh, newton, work.threads()));
  }
  if (estimate <= limit) return;
  throw Error(Fault::kOutOfMemory,
              "a chart, of " + std::to_string(mesh.face_count()) + " faces, is estimated to need " +
                  std::to_string((estimate + kMebibyte - 1) / kMebibyte) +
                  " MiB of memory, and the option memory-limit allows " +
                  std::to_string(limit / kMebibyte) + " MiB: raise it, or give more cuts");
}

}  // namespace

std::vector<MappedChart> map_charts(const std::vector<AtlasChart>& charts, const AssignedPins& pins,
                                    const ChartOptions& options, const Work& work) {
  std::vector<MappedChart> maps(charts.size());
  std::vector<Index> order(charts.size());
  std::iota(order.begin(), order.end(), 0);
  const auto faces = [&](Index c) -> std::int64_t { return charts[c].chart.mesh.face_count(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return faces(a) > faces(b); });
  std::int64_t all = 0;
  for (const Index c : order) all += faces(c);
  const auto share = [&](std::int64_t of) {
    return static_cast<double>(of) / static_cast<double>(all);
  };

  const std::vector<ChartPin> no_pins;
  const auto pins_of = [&](Index c) -> const std::vector<ChartPin>& {
    return pins.of_chart.empty() ? no_pins : pins.of_chart[c];
  };
  for (const Index c : order) {
    if (c == order[0] || pins_of(c).size() > kFewPins) {
      require_memory(charts[c].chart.mesh, pins_of(c).size() > kFewPins, options, work);
    }
  }

  std::int64_t mapped = 0;
  std::int64_t large = 0;
  // Others would wait for a chart of more than a thread's share.
  const auto is_large = [&](Index c) {
    return faces(c) >= kLargeChart && faces(c) * work.threads() > all - mapped;
  };
  for (; large < size_of(order) && is_large(order[large]); ++large) {
    const Index c = order[large];
    maps[c] = map_chart(charts[c], pins_of(c), options,
                        work.part(share(mapped), share(mapped + faces(c))));
    mapped += faces(c);
  }
  std::atomic<std::int64_t> done{mapped};
  const std::thread::id caller = std::this_thread::get_id();
  const Work aside = work.aside();
  parallel_for(work, size_of(order) - large, 1, [&](std::int64_t i, std::int64_t) {
    const Index c = order[large + i];
    maps[c] = map_chart(charts[c], pins_of(c), options, aside);
    done += faces(c);
    if (std::this_thread::get_id() == caller) work.report(share(done));
  });
  return maps;
}

}  // namespace beltrami
