#include "repair/spikes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/sort_unique.h"
#include "base/types.h"
#include "local/regions.h"
#include "local/vertex_sweep.h"
#include "mesh/face_block.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;
constexpr int kRounds = 3, kSweeps = 3, kRings = 2;
constexpr double kFew = 100, kMostOf = 1e-2;  // of the faces: around more the map is lost anyway
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The faces whose energy is above the limit or no number, increasing; where they are many, those
/// of them that have most.
template <class Density>
std::vector<Index> faces_above(double limit, const DiskMesh& mesh,
                               const std::vector<RestTriangle>& rest, const std::vector<Vec2>& uvs,
                               const Work& work) {
  using Rank = std::pair<double, Index>;  // the negative energy, so that the worst is first
  std::vector<std::vector<Rank>> found(mesh.faces.size() / kGrain + 1);
  parallel_for(work, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    FaceBlock block;
    FaceBlock::Numbers energies;
    for (std::int64_t first = begin; first < end; first += FaceBlock::kFaces) {
      block.load(mesh.faces, rest, uvs, first, end);
      for (int i = 0; i < FaceBlock::kFaces; ++i) {
        energies[i] = Density::slopes(block.map(i)).value;
      }
      const auto count = std::min<std::int64_t>(FaceBlock::kFaces, end - first);
      for (int i = 0; i < count; ++i) {
        if (energies[i] <= limit) continue;
        const double rank = std::isnan(energies[i]) ? -kInfinity : -energies[i];
        found[begin / kGrain].emplace_back(rank, static_cast<Index>(first + i));
      }
    }
  });
  std::vector<Rank> ranked;
  for (const auto& some : found) ranked.insert(ranked.end(), some.begin(), some.end());
  const auto most = static_cast<std::size_t>(kFew + kMostOf * mesh.face_count());
  if (ranked.size() > most) {
    std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(most),
                     ranked.end());
    ranked.resize(most);
  }
  std::vector<Index> faces;
  for (const Rank& rank : ranked) faces.push_back(rank.second);
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// The vertices of the faces and those up to some rings around, increasing.
std::vector<Index> vertices_around(const DiskMesh& mesh, const std::vector<Index>& faces) {
  std::vector<Index> found;
  PollSometimes poll;
  for (const Index f : faces) found.insert(found.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  sort_unique(found);
  for (int ring = 0; ring < kRings; ++ring) {
    const std::vector<Index> inner = found;
    for (const Index v : inner) {
      mesh.for_each_outgoing(v, [&](Index h) {
        poll();
        found.push_back(mesh.target(h));
      });
    }
    sort_unique(found);
  }
  return found;
}

}  // namespace

std::size_t relax_spikes(Energy energy, double limit, const DiskMesh& mesh,
                         const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                         const Work& work) {
  std::size_t at_first = 0;
  for (int round = 0; round < kRounds && !work.out_of_time(); ++round) {
    const std::vector<Index> faces = with_density(energy, [&]<class Density>(Density) {
      return faces_above<Density>(from_dirichlet<Density>(limit), mesh, rest, uvs, work);
    });
    if (round == 0) at_first = faces.size();
    if (faces.empty()) break;
    const std::vector<Index> vertices = vertices_around(mesh, faces);
    for (int i = 0; i < kSweeps; ++i) sweep_vertices(energy, mesh, rest, uvs, vertices);
    relax_regions(energy, mesh, rest, uvs, faces, kRegionRings, work);
  }
  return at_first;
}

}  // namespace beltrami
