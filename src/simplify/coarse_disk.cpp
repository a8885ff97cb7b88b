// The end of every simplifier: where the fine vertices went, and the proof of a disk.
#include <atomic>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/coarse.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;

/// From the next vertex on the way to the coarse vertex at its end.
std::vector<Index> follow_collapses(std::vector<Index> into, const std::vector<Index>& fine_vertex,
                                    const Work& work) {
  Scratch<Index> coarse_vertex(work, into.size()), root(work, into.size());
  parallel_for(work, size_of(fine_vertex), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto c = static_cast<Index>(begin); c < end; ++c) coarse_vertex[fine_vertex[c]] = c;
  });
  parallel_for(work, size_of(into), kGrain, [&](std::int64_t begin, std::int64_t end) {
    // Ways are halved as they are gone: whoever does so, they end where they did.
    const auto next = [&](Index v) { return std::atomic_ref<Index>(into[v]); };
    constexpr auto kRelaxed = std::memory_order_relaxed;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      Index at = v, to = next(at).load(kRelaxed);
      while (to != at) {
        const Index beyond = next(to).load(kRelaxed);
        if (beyond != to) next(at).store(beyond, kRelaxed);
        at = std::exchange(to, beyond);
      }
      root[v] = at;
    }
  });
  parallel_for(work, size_of(into), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) into[v] = coarse_vertex[root[v]];
  });
  return into;
}

/// With the mesh that `disk` returns, or throws Error without.
template <class Disk>
CoarseDisk proven(std::vector<Index> fine_vertex, std::vector<Index> collapsed_into,
                  const Work& work, const Disk& disk) {
  CoarseDisk coarse;
  coarse.nearby = follow_collapses(std::move(collapsed_into), fine_vertex, work);
  coarse.fine_vertex = std::move(fine_vertex);
  try {
    coarse.mesh = disk();
  } catch (const Error& error) {
    throw Error(
        Fault::kInternal,
        std::string("the simplified surface is not a disk, please report it: ") + error.what());
  }
  return coarse;
}

}  // namespace

CoarseDisk whole_disk(const DiskMesh& fine) {
  CoarseDisk whole;
  whole.mesh = fine;
  whole.fine_vertex.resize(fine.vertex_count());
  std::iota(whole.fine_vertex.begin(), whole.fine_vertex.end(), 0);
  whole.nearby = whole.fine_vertex;
  return whole;
}

CoarseDisk coarse_disk(const DiskMesh& fine, std::vector<Index> fine_vertex,
                       std::vector<Triangle> faces, std::vector<Index> collapsed_into,
                       const Work& work) {
  std::vector<Vec3> positions;
  positions.reserve(fine_vertex.size());
  for (const Index v : fine_vertex) positions.push_back(fine.positions[v]);
  return proven(std::move(fine_vertex), std::move(collapsed_into), work,
                [&] { return build_disk(std::move(positions), std::move(faces), work); });
}

CoarseDisk coarse_disk(Surface left, std::vector<Index> fine_vertex,
                       std::vector<Index> collapsed_into, const Work& work) {
  return proven(std::move(fine_vertex), std::move(collapsed_into), work,
                [&] { return prove_disk(std::move(left), work); });
}

}  // namespace beltrami
