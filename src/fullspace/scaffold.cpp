#include "fullspace/scaffold.h"

#include <algorithm>

#include "exact/certificate.h"
#include "fullspace/newton_step.h"
#include "mesh/boundary.h"
#include "scaffold/ring_faces.h"

namespace beltrami {
namespace {

constexpr double kFullStep = 0.5;
constexpr int kPatience = 5;  // short steps with little gain before it ends

/// The mesh and its scaffold as one triangulation of a circle.
struct Surrounded {
  std::vector<Triangle> faces;
  std::vector<RestTriangle> rest;
  std::vector<double> weights;
  std::vector<bool> fixed;
  std::vector<Vec2> uvs;
};

Surrounded surround(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    const std::vector<Vec2>& uvs) {
  const std::vector<Vec2> polygon = boundary_polygon(mesh, uvs);
  Surrounded all{mesh.faces, rest, {}, std::vector<bool>(uvs.size(), false), uvs};
  double mesh_area = 0;
  for (const RestTriangle& r : rest) {
    all.weights.push_back(r.area());
    mesh_area += r.area();
  }
  const RingFaces ring = ring_faces(polygon, mesh_area);
  all.uvs.insert(all.uvs.end(), ring.circle.begin(), ring.circle.end());
  all.fixed.resize(all.uvs.size(), true);
  const auto vertex = [&](Index i) {
    return i < size_of(polygon) ? mesh.boundary[i] : size_of(uvs) + i - size_of(polygon);
  };
  for (const Triangle& t : ring.faces) {
    all.faces.push_back({vertex(t[0]), vertex(t[1]), vertex(t[2])});
  }
  all.rest.insert(all.rest.end(), ring.rest.begin(), ring.rest.end());
  all.weights.insert(all.weights.end(), ring.weights.begin(), ring.weights.end());
  return all;
}

template <class Density>
double mesh_energy(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                   const std::vector<Vec2>& uvs) {
  double sum = 0, area = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& t = mesh.faces[f];
    const SingularValues s = singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
    sum += rest[f].area() * Density::value(s.s1, s.s2);
    area += rest[f].area();
  }
  return sum / area;
}

template <class Density>
NewtonResult minimise(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                      std::vector<Vec2>& uvs, const NewtonOptions& options,
                      const Checkpoint& checkpoint) {
  NewtonResult result;
  result.energies.push_back(mesh_energy<Density>(mesh, rest, uvs));
  int little_gain = 0;
  while (!result.converged && result.iterations() < options.max_iterations) {
    if (options.out_of_time && options.out_of_time()) break;
    checkpoint(result.iterations() / (result.iterations() + 12.0));
    Surrounded all = surround(mesh, rest, uvs);
    NewtonStepper<Density> stepper(all.faces, all.rest, all.weights, mesh.face_count(), all.fixed,
                                   options.threads);
    stepper.set_accept([&](const std::vector<Vec2>& trial) {
      return is_simple(mesh.boundary, trial);
    });
    const NewtonStep step = stepper.step(all.uvs, stepper.mean_energy(all.uvs));
    if (step.length == 0) break;
    std::copy_n(all.uvs.begin(), uvs.size(), uvs.begin());
    const double before = result.energies.back();
    result.energies.push_back(mesh_energy<Density>(mesh, rest, uvs));
    const bool little =
        before - result.energies.back() <= options.tolerance * comparable_energy<Density>(before);
    little_gain = little ? little_gain + 1 : 0;
    result.converged = (little && step.length >= kFullStep) || little_gain >= kPatience;
  }
  return result;
}

}  // namespace

NewtonResult minimise_with_scaffold(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                                    std::vector<Vec2>& uvs, const NewtonOptions& options,
                                    const Checkpoint& checkpoint) {
  return with_density(options.energy, [&]<class Density>(Density) {
    return minimise<Density>(mesh, rest, uvs, options, checkpoint);
  });
}

}  // namespace beltrami
