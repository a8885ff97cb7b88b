// The end of every simplifier: where the fine vertices went, and the proof of a disk.
#include <numeric>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/types.h"
#include "base/work.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"
#include "simplify/simplify.h"

namespace beltrami {
namespace {

/// From the next vertex on the way to the coarse vertex at its end.
std::vector<Index> follow_collapses(std::vector<Index> into,
                                    const std::vector<Index>& fine_vertex) {
  for (Index v = 0; v < size_of(into); ++v) {
    Index end = v;
    while (into[end] != end) end = into[end];
    for (Index on_the_way = v; on_the_way != end;)
      on_the_way = std::exchange(into[on_the_way], end);
  }
  std::vector<Index> coarse_vertex(into.size(), kNone);
  for (Index c = 0; c < size_of(fine_vertex); ++c) coarse_vertex[fine_vertex[c]] = c;
  for (Index& v : into) v = coarse_vertex[v];
  return into;
}

/// With the mesh that `disk` returns, or throws Error without.
template <class Disk>
CoarseDisk proven(std::vector<Index> fine_vertex, std::vector<Index> collapsed_into,
                  const Disk& disk) {
  CoarseDisk coarse;
  coarse.nearby = follow_collapses(std::move(collapsed_into), fine_vertex);
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
  return proven(std::move(fine_vertex), std::move(collapsed_into),
                [&] { return build_disk(std::move(positions), std::move(faces), work); });
}

CoarseDisk coarse_disk(Surface left, std::vector<Index> fine_vertex,
                       std::vector<Index> collapsed_into, const Work& work) {
  return proven(std::move(fine_vertex), std::move(collapsed_into),
                [&] { return prove_disk(std::move(left), work); });
}

}  // namespace beltrami
