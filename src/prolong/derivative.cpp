#include "prolong/derivative.h"

#include <Eigen/Geometry>
#include <cmath>

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

/// What carried_maps reads of the faces, lane by lane.
struct Corners {
  LanesVec3 x, y;  ///< axes of the frames
  LanesComplex corner;
  LanesVec3 gradient_u, gradient_v, normal;  ///< sums over the corners
  Lanes scale;
};

Corners corners_of(const DiskMesh& mesh, const std::array<Index, kLanes>& faces,
                   const std::vector<RestTriangle>& rest,
                   const std::vector<VertexDerivative>& derivatives) {
  Corners c;
  const auto set = [](LanesVec3& to, int i, const auto& v) {
    to.x[i] = static_cast<float>(v[0]);
    to.y[i] = static_cast<float>(v[1]);
    to.z[i] = static_cast<float>(v[2]);
  };
  for (int i = 0; i < kLanes; ++i) {
    const Index f = faces[i];
    const Triangle& t = mesh.faces[f];
    const RestTriangle& r = rest[f];
    const double inverse = 1 / r.x1;
    const Vec3& origin = mesh.positions[t[0]];
    // In double precision: the height of a sliver is the difference of what is much longer.
    const Vec3 x = inverse * (mesh.positions[t[1]] - origin);
    set(c.x, i, x);
    set(c.y, i, (1 / r.y2) * (mesh.positions[t[2]] - origin - r.x2 * x));
    c.corner.real[i] = static_cast<float>(inverse * r.x2);
    c.corner.imag[i] = static_cast<float>(inverse * r.y2);
    const VertexDerivative sum = derivatives[t[0]] + derivatives[t[1]] + derivatives[t[2]];
    set(c.gradient_u, i, sum.gradient_u());
    set(c.gradient_v, i, sum.gradient_v());
    set(c.normal, i, sum.normal());
    c.scale[i] = sum.scale();
  }
  return c;
}

/// Where the x and y axes found are not: a mollified face has none; or where nothing is carried.
void leave_out(const LanesVec3& x, const LanesVec3& y, CarriedMaps& maps) {
  constexpr float kUnit = 0.1F;  // how far from a unit vector what is mollified is
  const Lanes x_sq = x.dot(x), y_sq = y.dot(y);
  for (int i = 0; i < kLanes; ++i) {
    const bool is_frame = std::abs(x_sq[i] - 1) < kUnit && std::abs(y_sq[i] - 1) < kUnit;
    if (is_frame && maps.fz_norm[i] > 0) continue;
    maps.fz.real[i] = maps.fz.imag[i] = maps.fzbar.real[i] = maps.fzbar.imag[i] = 0;
    maps.fz_norm[i] = maps.fzbar_norm[i] = 0;
  }
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

CarriedMaps carried_maps(const DiskMesh& mesh, const std::array<Index, kLanes>& faces,
                         const std::vector<RestTriangle>& rest,
                         const std::vector<VertexDerivative>& derivatives) {
  constexpr float kMostStretched = 0.98F;  // |fzbar|^2 over |fz|^2: means may come near to flipping
  constexpr float kOpposite = 1e-3F;       // 1 + cosine below which normals have no turn between
  constexpr float kTiny = 1e-30F;          // in the place of zeros that are divided by
  const Corners c = corners_of(mesh, faces, rest, derivatives);
  const LanesVec3 &x = c.x, &y = c.y;
  // Onto the plane of the other normal by the least turn: e - (e.u) (u + n) / (1 + u.n).
  const LanesVec3 normal = x.cross(y);
  const Lanes inverse = 1 / root(c.normal.dot(c.normal).max(kTiny));
  const Lanes cosine = inverse * c.normal.dot(normal);
  const LanesVec3 middle = (inverse / (1 + cosine).max(kOpposite)) * (inverse * c.normal + normal);
  const LanesVec3 turned_x = x - c.normal.dot(x) * middle, turned_y = y - c.normal.dot(y) * middle;
  const Lanes ux = c.gradient_u.dot(turned_x), vx = c.gradient_v.dot(turned_x);
  const Lanes uy = c.gradient_u.dot(turned_y), vy = c.gradient_v.dot(turned_y);
  CarriedMaps maps;
  maps.corner = c.corner;
  maps.fz = {0.5F * (ux + vy), 0.5F * (vx - uy)};
  maps.fzbar = {0.5F * (ux - vy), 0.5F * (vx + uy)};
  const Lanes a_sq = squared_modulus(maps.fz).max(kTiny), most = kMostStretched * a_sq;
  const Lanes b_sq = squared_modulus(maps.fzbar);
  const Lanes shrink = root(most / b_sq.max(most));
  const Lanes scale = c.scale / (3 * root(a_sq - b_sq.min(most)));
  maps.fz = scale * maps.fz;
  maps.fzbar = (scale * shrink) * maps.fzbar;
  maps.fz_norm = squared_modulus(maps.fz);
  maps.fzbar_norm = squared_modulus(maps.fzbar);
  leave_out(x, y, maps);
  return maps;
}

}  // namespace beltrami
