#include "atlas/map_charts.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "chart/memory_estimate.h"
#include "descend/flat_start.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "mesh/locality.h"
#include "mesh/rest_shape.h"

namespace beltrami {
namespace {

/// Charts from here on gain from several threads. Below, side by side is faster.
constexpr Index kLargeChart = 20'000;
/// Charts of so few faces unfold without distortion, and cannot overlap.
constexpr Index kFewFaces = 2;

MappedChart flattened(const Chart& chart, const ChartOptions& options, const Work& work) {
  std::vector<Triangle> faces = chart.mesh.faces;
  const std::vector<Index> order = arrange(chart.mesh.positions, faces, work).vertices;
  DiskMesh disk = build_disk(in_order(chart.mesh.positions, order, work), std::move(faces), work);
  const Normalisation frame = normalise(disk.positions, disk.faces, work);
  const Flattening result = flatten(disk, frame, options, work);
  MappedChart map{std::vector<Vec2>(result.uvs.size()), result.status};
  for (std::size_t i = 0; i < result.uvs.size(); ++i) map.uvs[order[i]] = result.uvs[i];
  return map;
}

/// The faces unfolded, their longest edge along the first axis: in rows of slivers the numbers of
/// the second one are small, and dense.
MappedChart unfolded(const Chart& chart, const Work& work) {
  const DiskMesh& mesh = chart.mesh;
  MappedChart map{unfolding(mesh, rest_triangles(mesh.positions, mesh.faces, work))};
  Complex longest = 0;
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Vec2 edge = map.uvs[mesh.target(h)] - map.uvs[mesh.origin(h)];
    const Complex z(edge.x(), edge.y());
    if (std::norm(z) > std::norm(longest)) longest = z;
  }
  const Complex turn = std::conj(longest) / modulus(longest);
  for (Vec2& w : map.uvs) {
    const Complex turned = turn * Complex(w.x(), w.y());
    w = {turned.real(), turned.imag()};
  }
  return map;
}

MappedChart map_chart(const Chart& chart, const ChartOptions& options, const Work& work) {
  try {
    return chart.mesh.face_count() <= kFewFaces ? unfolded(chart, work)
                                                : flattened(chart, options, work);
  } catch (const Error& error) {
    return {std::vector<Vec2>(chart.mesh.positions.size(), Vec2::Zero()), Outcome::kNotInjective,
            error.status()};
  }
}

/// Throws Error OUT_OF_MEMORY where the largest chart alone exceeds the limit.
void require_memory(const DiskMesh& largest, const ChartOptions& options, const Work& work) {
  constexpr std::uint64_t kMebibyte = 1 << 20;
  const auto limit = static_cast<std::uint64_t>(work.memory_limit());
  if (limit == 0) return;
  const std::uint64_t estimate = estimate_memory(largest, options, work.threads());
  if (estimate <= limit) return;
  throw Error(BELTRAMI_E_OUT_OF_MEMORY,
              "the largest chart, of " + std::to_string(largest.face_count()) +
                  " faces, is estimated to need " +
                  std::to_string((estimate + kMebibyte - 1) / kMebibyte) +
                  " MiB of memory, and the option memory-limit allows " +
                  std::to_string(limit / kMebibyte) + " MiB: raise it, or give more cuts");
}

}  // namespace

std::vector<MappedChart> map_charts(const std::vector<AtlasChart>& charts,
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

  if (!order.empty()) require_memory(charts[order[0]].chart.mesh, options, work);

  std::int64_t mapped = 0;
  std::int64_t large = 0;
  // Others would wait for a chart of more than a thread's share.
  const auto is_large = [&](Index c) {
    return faces(c) >= kLargeChart && faces(c) * work.threads() > all - mapped;
  };
  for (; large < size_of(order) && is_large(order[large]); ++large) {
    const Index c = order[large];
    maps[c] =
        map_chart(charts[c].chart, options, work.part(share(mapped), share(mapped + faces(c))));
    mapped += faces(c);
  }
  std::atomic<std::int64_t> done{mapped};
  const std::thread::id caller = std::this_thread::get_id();
  const Work aside = work.aside();
  parallel_for(work, size_of(order) - large, 1, [&](std::int64_t i, std::int64_t) {
    const Index c = order[large + i];
    maps[c] = map_chart(charts[c].chart, options, aside);
    done += faces(c);
    if (std::this_thread::get_id() == caller) work.report(share(done));
  });
  return maps;
}

}  // namespace beltrami
