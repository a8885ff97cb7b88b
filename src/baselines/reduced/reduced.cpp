#include "baselines/reduced/reduced.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/portable_math.h"
#include "baselines/reduced/meta_vertices.h"
#include "baselines/reduced/reduced_basis.h"
#include "baselines/reduced/reduced_newton.h"
#include "baselines/reduced/samples.h"
#include "exact/crossings.h"
#include "linear/spd_solver.h"

namespace beltrami {
namespace {

/// The paper's 50 to 500 uniform samples underestimate the energy by 5% to 15%.
constexpr Index kStrata = 2000;
constexpr double kBasisShare = 0.5, kNewtonShare = 0.45;  // of the work

/// On a circle of the area of the mesh, by arc length.
std::vector<Vec2> metas_on_circle(const MetaVertices& metas, double area) {
  double length = 0;
  for (const double arc : metas.arc) length += arc;
  const double radius = std::sqrt(area / std::numbers::pi);
  std::vector<Vec2> x;
  double along = 0;
  for (const double arc : metas.arc) {
    const double angle = 2 * std::numbers::pi * along / length;
    x.push_back(radius * Vec2(portable::cos(angle), portable::sin(angle)));
    along += arc;
  }
  return x;
}

/// The sampled faces' edges as rows of H. Faces that share vertices share the work.
ReducedProblem sampled_problem(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                               const ReducedBasis& basis) {
  const SampledFaces samples = sample_faces(mesh, rest, basis.metas(), kStrata);

  std::vector<Index> vertices;
  for (const Index f : samples.faces) {
    vertices.insert(vertices.end(), mesh.faces[f].begin(), mesh.faces[f].end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const DenseMatrix rows = basis.rows(vertices);
  const auto row = [&](Index v) {
    return std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin();
  };

  ReducedProblem problem;
  problem.weights = samples.weights;
  problem.edges.resize(2 * size_of(samples.faces), basis.metas().count());
  for (Index s = 0; s < size_of(samples.faces); ++s) {
    const Triangle& t = mesh.faces[samples.faces[s]];
    problem.edges.row(2 * s) = rows.row(row(t[1])) - rows.row(row(t[0]));
    problem.edges.row(2 * s + 1) = rows.row(row(t[2])) - rows.row(row(t[0]));
    problem.rest.push_back(rest[samples.faces[s]]);
  }
  return problem;
}

}  // namespace

ReducedResult flatten_reduced(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                              const std::vector<Cotangents>& cotangents,
                              const ReducedOptions& options, const Work& work) {
  work.report(0);
  MetaVertices metas = choose_meta_vertices(mesh, work);
  if (metas.count() > kMostMetas) {
    throw Error(Fault::kSolver, "the boundary has " + std::to_string(metas.count()) +
                                    " vertices at bridges and between them: too many for a "
                                    "reduced flattening; try another");
  }
  double area = 0;
  for (const RestTriangle& r : rest) area += r.area();
  std::vector<Vec2> x = metas_on_circle(metas, area);
  const ReducedBasis basis(mesh, cotangents, std::move(metas), work);
  work.report(0.5 * kBasisShare);
  ReducedProblem problem = sampled_problem(mesh, rest, basis);
  problem.energy = options.energy;
  work.report(kBasisShare);

  ReducedDescent descent =
      minimise_reduced(problem, options.scaffold, options.tolerance, options.max_iterations, x,
                       work.part(kBasisShare, kBasisShare + kNewtonShare));
  ReducedResult result;
  result.uvs = basis.expand(x);
  result.energies = std::move(descent.energies);
  result.meta_vertices = size_of(x);
  result.samples = size_of(problem.rest);
  result.converged = descent.converged;
  result.simple_boundary = is_simple(mesh.boundary, result.uvs);
  return result;
}

}  // namespace beltrami
