#include "prolong/prolongation.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "mesh/closest_point.h"
#include "prolong/frame.h"
#include "prolong/surface_walk.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;
constexpr Index kHub = 40;                    // faces at a vertex, beyond what a walk crosses
constexpr std::int64_t kPollPeriod = 64;      // faces, of which one at a hub takes long
constexpr std::int64_t kBatch = 64 * kGrain;  // between two reports

/// The metric at each corner of a face, in the frame of the face.
using CornerMetrics = std::array<FaceMetric, 3>;

/// What a metric becomes where tangent vectors are multiplied by the unit complex r.
FaceMetric rotated(const FaceMetric& metric, Complex r) {
  return {metric.mu * r * r, metric.log_area, metric.phase * std::conj(r)};
}

/// Adds up metrics; the phase is a direction, left unnormalised.
void accumulate(FaceMetric& sum, const FaceMetric& metric, double weight) {
  sum.mu += weight * metric.mu;
  sum.log_area += weight * metric.log_area;
  sum.phase += weight * metric.phase;
}

void normalise_phase(FaceMetric& metric) {
  const double length = modulus(metric.phase);
  metric.phase = length > 0 ? metric.phase / length : Complex(1);
}

constexpr FaceMetric zero_metric() {
  return {0, 0, 0};
}

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
std::vector<CornerMetrics> average_at_vertices(const DiskMesh& mesh,
                                               const std::vector<FrameOfFace>& face_frames,
                                               const std::vector<FaceMetric>& metrics) {
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
  std::vector<FaceMetric> sum(mesh.vertex_count(), zero_metric());
  std::vector<double> weight(mesh.vertex_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!face_frames[f].valid) continue;
    for (const Index v : mesh.faces[f]) {
      const Complex r = transport(face_frames[f].frame, vertex_frame[v]);
      accumulate(sum[v], rotated(metrics[f], r), area[f]);
      weight[v] += area[f];
    }
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (!(weight[v] > 0)) continue;
    sum[v].mu /= weight[v];
    sum[v].log_area /= weight[v];
    normalise_phase(sum[v]);
  }
  std::vector<CornerMetrics> corners(mesh.face_count());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!face_frames[f].valid) continue;
    for (int k = 0; k < 3; ++k) {
      const Index v = mesh.faces[f][k];
      const Complex r = transport(vertex_frame[v], face_frames[f].frame);
      corners[f][k] = rotated(sum[v], r);
    }
  }
  return corners;
}

}  // namespace

std::vector<FaceMetric> face_metrics(const std::vector<Triangle>& faces,
                                     const std::vector<RestTriangle>& rest,
                                     const std::vector<Vec2>& uvs) {
  std::vector<FaceMetric> metrics(faces.size());
  for (Index f = 0; f < size_of(faces); ++f) {
    const LinearMap map = linear_map(rest[f], uvs[faces[f][0]], uvs[faces[f][1]], uvs[faces[f][2]]);
    const double area_factor = std::norm(map.fz) - std::norm(map.fzbar);
    if (!(area_factor > 0)) continue;
    metrics[f] = {quotient(map.fzbar, map.fz), portable::log(area_factor),
                  map.fz / modulus(map.fz)};
  }
  return metrics;
}

std::vector<FaceMetric> prolong_metric(const DiskMesh& coarse,
                                       const std::vector<FaceMetric>& metrics, const DiskMesh& fine,
                                       const std::vector<Index>& nearby, const Work& work) {
  std::vector<FrameOfFace> coarse_frames(coarse.face_count());
  for (Index f = 0; f < coarse.face_count(); ++f) coarse_frames[f] = frame_of(coarse, f);
  const auto corners = average_at_vertices(coarse, coarse_frames, metrics);
  const ClosestPoint tree(coarse.positions, coarse.faces);
  const SurfaceWalk walk(coarse, work);
  std::vector<Index> valence(coarse.vertex_count(), 0);
  for (const Triangle& t : coarse.faces) {
    for (const Index v : t) ++valence[v];
  }
  // The face to start at: the last one found where it touches the coarse vertex nearby.
  const auto start_at = [&](const Triangle& fine_face, Index last) {
    Index home = nearby[fine_face[0]];
    // A walk around a hub would take too long.
    for (const Index v : fine_face) {
      if (valence[home] > kHub && valence[nearby[v]] < valence[home]) home = nearby[v];
    }
    if (last != kNone) {
      const Triangle& t = coarse.faces[last];
      if (t[0] == home || t[1] == home || t[2] == home) return last;
    }
    return coarse.outgoing[home] / 3;
  };

  std::vector<FaceMetric> result;
  parallel_assign(work, result, fine.faces.size());
  for (std::int64_t first = 0; first < fine.face_count(); first += kBatch) {
    work.report(static_cast<double>(first) / fine.face_count());
    const std::int64_t count = std::min(kBatch, fine.face_count() - first);
    parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      Index seed = kNone;  // neighbours in the file are often neighbours on the surface
      for (std::int64_t i = begin; i < end; ++i) {
        if (i % kPollPeriod == 0) poll_interrupt();
        const auto f = static_cast<Index>(first + i);
        const FrameOfFace to = frame_of(fine, f);
        if (!to.valid) continue;
        const Triangle& t = fine.faces[f];
        const Vec3 centroid =
            (fine.positions[t[0]] + fine.positions[t[1]] + fine.positions[t[2]]) / 3;
        SurfacePoint hit;
        if (!nearby.empty()) hit = walk.find(centroid, to.frame.n, start_at(t, seed));
        if (hit.face == kNone) hit = tree.find(centroid, to.frame.n, seed);
        seed = hit.face;
        FaceMetric sum = zero_metric();
        for (int k = 0; k < 3; ++k) {
          accumulate(sum, corners[hit.face][k], hit.barycentric[k]);
        }
        normalise_phase(sum);
        result[f] = rotated(sum, transport(coarse_frames[hit.face].frame, to.frame));
      }
    });
  }
  return result;
}

}  // namespace beltrami
