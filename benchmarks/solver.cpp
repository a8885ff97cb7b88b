// The native solver beside others on the same matrices, in one process, round by round: the
// interior cotan Laplacian of refined meshes, analyze + factorize + two solves.
//
// Costs are CPU seconds, the best of some rounds. In the preset gpl they are also given in the
// units Um and Ua: what stock CHOLMOD takes for the same, supernodal, ordered by METIS or by AMD.
// Only ratios carry from machine to machine. Run CHOLMOD's BLAS on one thread
// (OPENBLAS_NUM_THREADS=1).
#include <CLI/CLI.hpp>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh/disk_mesh.h"
#include "mesh_file.h"
#include "refine.h"
#include "sparse/mesh_matrix.h"
#include "sparse/native_solver.h"
#ifdef BELTRAMI_WITH_CHOLMOD
#include <cholmod.h>
#endif

namespace beltrami::benchmarks {
namespace {

double seconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct System {
  SparseMatrix lower;
  std::vector<Place> places;
  DenseMatrix rhs;
};

/// CPU seconds of the steps; wall seconds of all.
struct Cost {
  double analyze = 0, factorize = 0, solve = 0, wall = 0, residual = 0;
  double total() const { return analyze + factorize + solve; }
};

/// Runs the steps and takes their times.
Cost measure(const System& system, const std::function<void()>& analyze,
             const std::function<void()>& factorize, const std::function<DenseMatrix()>& solve) {
  Cost cost;
  const double wall = seconds(CLOCK_MONOTONIC);
  const auto time = [](double& sum, const auto& step) {
    const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
    step();
    sum = seconds(CLOCK_PROCESS_CPUTIME_ID) - begin;
  };
  DenseMatrix x;
  time(cost.analyze, analyze);
  time(cost.factorize, factorize);
  time(cost.solve, [&] { x = solve(); });
  cost.wall = seconds(CLOCK_MONOTONIC) - wall;
  const DenseMatrix left = system.lower.selfadjointView<Eigen::Lower>() * x - system.rhs;
  cost.residual = left.norm() / system.rhs.norm();
  return cost;
}

Cost run_native(const System& system, Precision precision, int threads) {
  const auto solver = make_native_solver({precision, threads});
  return measure(
      system, [&] { solver->analyze(system.lower, system.places); },
      [&] {
        if (!solver->factorize(system.lower)) throw std::runtime_error("not definite");
      },
      [&] { return solver->solve(system.rhs); });
}

Cost run_eigen(const System& system) {
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::AMDOrdering<int>> factor;
  return measure(
      system, [&] { factor.analyzePattern(system.lower); }, [&] { factor.factorize(system.lower); },
      [&]() -> DenseMatrix { return factor.solve(system.rhs); });
}

#ifdef BELTRAMI_WITH_CHOLMOD
Cost run_cholmod(const System& system, int ordering) {
  cholmod_common common;
  cholmod_start(&common);
  common.nmethods = 1;
  common.method[0].ordering = ordering;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(system.lower.rows());
  view.nzmax = static_cast<std::size_t>(system.lower.nonZeros());
  view.p = const_cast<int*>(system.lower.outerIndexPtr());
  view.i = const_cast<int*>(system.lower.innerIndexPtr());
  view.x = const_cast<double*>(system.lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_INT;
  view.xtype = CHOLMOD_REAL;
  view.sorted = view.packed = 1;
  cholmod_factor* factor = nullptr;
  const Cost cost = measure(
      system, [&] { factor = cholmod_analyze(&view, &common); },
      [&] { cholmod_factorize(&view, factor, &common); },
      [&] {
        DenseMatrix x(system.rhs.rows(), system.rhs.cols());
        for (Eigen::Index c = 0; c < system.rhs.cols(); ++c) {
          cholmod_dense right{};
          right.nrow = right.nzmax = right.d = view.nrow;
          right.ncol = 1;
          right.x = const_cast<double*>(system.rhs.col(c).data());
          right.xtype = CHOLMOD_REAL;
          cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor, &right, &common);
          x.col(c) =
              Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(solution->x), x.rows());
          cholmod_free_dense(&solution, &common);
        }
        return x;
      });
  cholmod_free_factor(&factor, &common);
  cholmod_finish(&common);
  return cost;
}
#endif

System laplacian(const cli::MeshFile& file) {
  std::vector<Vec3> positions;
  for (std::size_t v = 0; v < file.vertex_count(); ++v) {
    positions.emplace_back(file.positions[3 * v], file.positions[3 * v + 1],
                           file.positions[3 * v + 2]);
  }
  std::vector<Triangle> faces;
  for (std::size_t f = 0; f < file.face_count(); ++f) {
    faces.push_back({static_cast<Index>(file.faces[3 * f]),
                     static_cast<Index>(file.faces[3 * f + 1]),
                     static_cast<Index>(file.faces[3 * f + 2])});
  }
  const DiskMesh mesh = build_disk(std::move(positions), std::move(faces));
  MeshMatrix matrix(mesh.vertex_count(), mesh.faces, mesh.on_boundary, 1);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& t = mesh.faces[f];
    for (int k = 0; k < 3; ++k) {
      const int i = next_corner(k), j = previous_corner(k);
      const Vec3 a = mesh.positions[t[i]] - mesh.positions[t[k]],
                 b = mesh.positions[t[j]] - mesh.positions[t[k]];
      const double weight = 0.5 * a.dot(b) / std::max(a.cross(b).norm(), 1e-300);
      matrix.add(f, t, i, i, [=](int, int) { return weight; });
      matrix.add(f, t, j, j, [=](int, int) { return weight; });
      matrix.add(f, t, i, j, [=](int, int) { return -weight; });
    }
  }
  DenseMatrix rhs(matrix.free_count(), 2);
  for (Eigen::Index i = 0; i < rhs.rows(); ++i) {
    rhs(i, 0) = std::sin(static_cast<double>(i));
    rhs(i, 1) = std::cos(0.7 * static_cast<double>(i));
  }
  return {matrix.matrix(), matrix.places(mesh.positions), rhs};
}

void benchmark(const std::string& path, std::uint64_t faces, int rounds, bool with_eigen) {
  auto mesh = cli::read_mesh(path, cli::Content::kSurface);
  if (faces > mesh.face_count()) mesh = refine(mesh, faces);
  const System system = laplacian(mesh);
  std::printf("\n%s, %llu faces, %lld unknowns\n",
              std::filesystem::path(path).stem().string().c_str(),
              static_cast<unsigned long long>(mesh.face_count()),
              static_cast<long long>(system.lower.rows()));
  struct Contender {
    std::string name;
    std::function<Cost()> run;
    Cost best = {};
  };
  std::vector<Contender> all;
  for (const int threads : {1, 2}) {
    const std::string suffix = threads == 1 ? "" : ", 2 threads";
    all.push_back({"native, double" + suffix,
                   [&, threads] { return run_native(system, Precision::kDouble, threads); }});
    all.push_back({"native, single" + suffix,
                   [&, threads] { return run_native(system, Precision::kSingle, threads); }});
  }
  if (with_eigen) all.push_back({"Eigen simplicial, AMD", [&] { return run_eigen(system); }});
#ifdef BELTRAMI_WITH_CHOLMOD
  all.push_back({"CHOLMOD, AMD (Ua)", [&] { return run_cholmod(system, CHOLMOD_AMD); }});
  all.push_back({"CHOLMOD, METIS (Um)", [&] { return run_cholmod(system, CHOLMOD_METIS); }});
#endif
  for (Contender& c : all) c.best.wall = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    for (Contender& c : all) {
      const Cost cost = c.run();
      const bool first = round == 0;
      c.best.analyze = first ? cost.analyze : std::min(c.best.analyze, cost.analyze);
      c.best.factorize = first ? cost.factorize : std::min(c.best.factorize, cost.factorize);
      c.best.solve = first ? cost.solve : std::min(c.best.solve, cost.solve);
      c.best.wall = std::min(c.best.wall, cost.wall);
      c.best.residual = std::max(c.best.residual, cost.residual);
    }
  }
  std::printf("%-28s %8s %9s %7s %7s %7s %9s", "cpu s", "analyze", "factorize", "solve", "total",
              "wall", "residual");
#ifdef BELTRAMI_WITH_CHOLMOD
  const double ua = all[all.size() - 2].best.total(), um = all.back().best.total();
  std::printf(" %7s %7s", "/ Ua", "/ Um");
#endif
  std::printf("\n");
  for (const Contender& c : all) {
    std::printf("%-28s %8.3f %9.3f %7.3f %7.3f %7.3f %9.1e", c.name.c_str(), c.best.analyze,
                c.best.factorize, c.best.solve, c.best.total(), c.best.wall, c.best.residual);
#ifdef BELTRAMI_WITH_CHOLMOD
    std::printf(" %7.3f %7.3f", c.best.total() / ua, c.best.total() / um);
#endif
    std::printf("\n");
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  CLI::App app("Factorizes the Laplacian of MESH... with every solver, refined to some sizes.");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::vector<std::uint64_t> faces = {100000, 300000, 1000000};
  int rounds = 3;
  bool no_eigen = false;
  app.add_option("MESH", meshes, "Disks; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine smaller meshes to about so many faces");
  app.add_option("--rounds", rounds, "The best of so many counts");
  app.add_flag("--no-eigen", no_eigen, "Leave out Eigen's solver, which takes the longest");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const std::string& mesh : meshes) {
      for (const std::uint64_t count : faces) {
        beltrami::benchmarks::benchmark(mesh, count, rounds, !no_eigen);
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "beltrami_bench_solver: %s\n", error.what());
    return 2;
  }
  return 0;
}
