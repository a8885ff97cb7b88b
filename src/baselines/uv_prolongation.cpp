#include "baselines/uv_prolongation.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/parallel.h"
#include "base/types.h"
#include "mesh/closest_point.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
constexpr std::int64_t kBatch = 64 * kGrain;  // between two reports

}  // namespace

std::vector<Vec2> prolong_uvs(const DiskMesh& coarse, const std::vector<Vec2>& coarse_uvs,
                              const DiskMesh& fine, const Work& work) {
  const ClosestPoint tree(coarse.positions, coarse.faces);
  std::vector<Vec2> uvs(fine.vertex_count());
  for (std::int64_t first = 0; first < fine.vertex_count(); first += kBatch) {
    work.report(static_cast<double>(first) / fine.vertex_count());
    const std::int64_t count = std::min(kBatch, fine.vertex_count() - first);
    parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      Index seed = kNone;
      for (std::int64_t i = begin; i < end; ++i) {
        const auto v = static_cast<Index>(first + i);
        Vec3 normal = Vec3::Zero();
        fine.for_each_outgoing(v, [&](Index h) {
          const Triangle& t = fine.faces[h / 3];
          normal += (fine.positions[t[1]] - fine.positions[t[0]])
                        .cross(fine.positions[t[2]] - fine.positions[t[0]]);
        });
        const SurfacePoint hit = tree.find(fine.positions[v], normal, seed);
        seed = hit.face;
        Vec2 uv = Vec2::Zero();
        for (int k = 0; k < 3; ++k) {
          uv += hit.barycentric[k] * coarse_uvs[coarse.faces[hit.face][k]];
        }
        uvs[v] = uv;
      }
    });
  }
  return uvs;
}

}  // namespace beltrami
