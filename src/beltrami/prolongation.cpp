#include "beltrami/prolongation.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "beltrami/closest_point.h"
#include "beltrami/frame.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
constexpr std::int64_t kBatch = 64 * kGrain;  // between two checkpoints

/// The coefficient at each corner of a face, in the frame of the face.
using CornerCoefficients = std::array<Complex, 3>;

struct FrameOfFace {
  Frame frame;
  bool valid;
};

FrameOfFace frame_of(const DiskMesh& mesh, Index face) {
  const Triangle& t = mesh.faces[face];
  FrameOfFace result;
  result.frame =
      face_frame(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], result.valid);
  return result;
}

/// Face values -> vertex values in tangent frames -> corner values in face frames.
std::vector<CornerCoefficients> average_at_vertices(const DiskMesh& mesh,
                                                    const std::vector<FrameOfFace>& face_frames,
                                                    const std::vector<Complex>& coefficients) {
  std::vector<double> area(mesh.face_count());
  std::vector<Vec3> normal(mesh.vertex_count(), Vec3::Zero());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!face_frames[f].valid) continue;
    const Triangle& t = mesh.faces[f];
    area[f] = triangle_area(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]);
    for (const Index v : t) normal[v] += area[f] * face_frames[f].frame.n;
  }
  std::vector<Frame> vertex_frame(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double length = normal[v].norm();
    if (length > 0) vertex_frame[v] = frame_of_normal(normal[v] / length);
  }
  std::vector<Complex> sum(mesh.vertex_count());
  std::vector<double> weight(mesh.vertex_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!face_frames[f].valid) continue;
    for (const Index v : mesh.faces[f]) {
      const Complex r = transport(face_frames[f].frame, vertex_frame[v]);
      sum[v] += area[f] * coefficients[f] * r * r;
      weight[v] += area[f];
    }
  }
  std::vector<CornerCoefficients> corners(mesh.face_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!face_frames[f].valid) continue;
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      const Complex r = transport(vertex_frame[v], face_frames[f].frame);
      corners[f][k] = sum[v] / weight[v] * r * r;
    }
  }
  return corners;
}

}  // namespace

std::vector<Complex> beltrami_coefficients(const std::vector<Triangle>& faces,
                                           const std::vector<RestTriangle>& rest,
                                           const std::vector<Vec2>& uvs) {
  std::vector<Complex> coefficients(faces.size());
  for (Index f = 0; f < size_of(faces); ++f) {
    const LinearMap map =
        linear_map(rest[f], uvs[faces[f][0]], uvs[faces[f][1]], uvs[faces[f][2]]);
    if (std::norm(map.fz) > 0) coefficients[f] = map.fzbar / map.fz;
  }
  return coefficients;
}

std::vector<Complex> prolong_coefficients(const DiskMesh& coarse,
                                          const std::vector<Complex>& coefficients,
                                          const DiskMesh& fine, int threads,
                                          const Checkpoint& checkpoint) {
  std::vector<FrameOfFace> coarse_frames(coarse.face_count());
  for (Index f = 0; f < coarse.face_count(); ++f) coarse_frames[f] = frame_of(coarse, f);
  const auto corners = average_at_vertices(coarse, coarse_frames, coefficients);
  const ClosestPoint tree(coarse.positions, coarse.faces);

  std::vector<Complex> result(fine.face_count());
  for (std::int64_t first = 0; first < fine.face_count(); first += kBatch) {
    checkpoint(static_cast<double>(first) / fine.face_count());
    const std::int64_t count = std::min(kBatch, fine.face_count() - first);
    parallel_for(threads, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      Index seed = kNone;  // neighbours in the file are often neighbours on the surface
      for (std::int64_t i = begin; i < end; ++i) {
        const auto f = static_cast<Index>(first + i);
        const FrameOfFace to = frame_of(fine, f);
        if (!to.valid) continue;
        const Triangle& t = fine.faces[f];
        const Vec3 centroid =
            (fine.positions[t[0]] + fine.positions[t[1]] + fine.positions[t[2]]) / 3;
        const SurfacePoint hit = tree.find(centroid, to.frame.n, seed);
        seed = hit.face;
        Complex mu = 0;
        for (int k = 0; k < 3; ++k) mu += hit.barycentric[k] * corners[hit.face][k];
        const Complex r = transport(coarse_frames[hit.face].frame, to.frame);
        result[f] = mu * r * r;
      }
    });
  }
  return result;
}

}  // namespace beltrami
