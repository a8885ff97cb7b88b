#include "prolong/derivative.h"

#include "base/parallel.h"
#include "base/portable_math.h"
#include "prolong/frame.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 4096;

/// The derivative of a linear map, with the logarithm of its area factor in the place of the scale.
VertexDerivative derivative_in_space(const Frame& frame, const LinearMap& map, double log_area) {
  const Complex by_x = map.fz + map.fzbar, by_y = Complex(0, 1) * (map.fz - map.fzbar);
  const Vec3 y = frame.n.cross(frame.x);
  VertexDerivative result;
  result.segment<3>(0) = (by_x.real() * frame.x + by_y.real() * y).cast<float>();
  result.segment<3>(3) = (by_x.imag() * frame.x + by_y.imag() * y).cast<float>();
  result.segment<3>(6) = frame.n.cast<float>();
  result[9] = static_cast<float>(log_area);
  return result;
}

/// Of a face; zero where it has no normal or the map no area.
VertexDerivative of_face(const DiskMesh& mesh, Index f, const RestTriangle& rest,
                         const std::vector<Vec2>& uvs) {
  const Triangle& t = mesh.faces[f];
  bool valid = false;
  const Frame frame =
      face_frame(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]], valid);
  const LinearMap map = linear_map(rest, uvs[t[0]], uvs[t[1]], uvs[t[2]]);
  const double area_factor = std::norm(map.fz) - std::norm(map.fzbar);
  if (!valid || !(area_factor > 0)) return VertexDerivative::Zero();
  return derivative_in_space(frame, map, portable::log(area_factor));
}

}  // namespace

std::vector<VertexDerivative> vertex_derivatives(const DiskMesh& mesh,
                                                 const std::vector<RestTriangle>& rest,
                                                 const std::vector<Vec2>& uvs, const Work& work) {
  std::vector<VertexDerivative> of_faces(mesh.faces.size());
  parallel_for(work, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      of_faces[f] = of_face(mesh, f, rest[f], uvs);
    }
  });
  std::vector<VertexDerivative> result(mesh.positions.size());
  parallel_for(work, mesh.vertex_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      VertexDerivative sum = VertexDerivative::Zero();
      float weight = 0;
      mesh.for_each_outgoing(v, [&](Index h) {
        const VertexDerivative& of = of_faces[h / 3];
        if (of.normal().isZero(0)) return;
        const auto area = static_cast<float>(rest[h / 3].area());
        sum += area * of;
        weight += area;
      });
      if (weight > 0) {
        sum /= weight;
        const float length = sum.segment<3>(6).norm();
        if (length > 0) sum.segment<3>(6) /= length;
        sum[9] = static_cast<float>(portable::exp(0.5 * double{sum[9]}));
      }
      result[v] = sum;
    }
  });
  return result;
}

std::vector<VertexDerivative> carried(const std::vector<VertexDerivative>& coarse,
                                      const std::vector<Footpoint>& points, const Work& work) {
  std::vector<VertexDerivative> fine(points.size());
  parallel_for(work, size_of(points), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) fine[v] = interpolated(points[v], coarse);
  });
  return fine;
}

}  // namespace beltrami
