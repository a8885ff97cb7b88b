// The native solver beside others on the same matrices, in one process, round by round: the
// interior cotan Laplacian of refined meshes, analyze + factorize + two solves.
//
// Costs are CPU seconds, the best of some rounds, and, where CHOLMOD is built in, the units Um and
// Ua: what it takes for the same in stock form, supernodal, ordered by METIS or by AMD. Only ratios
// carry from machine to machine. Run CHOLMOD's BLAS on one thread (OPENBLAS_NUM_THREADS=1).
#include <CLI/CLI.hpp>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/work.h"
#include "linear/cholesky/native_solver.h"
#include "linear/spd_solver.h"
#include "records.h"
#include "refine.h"
#include "yardstick.h"

namespace beltrami::benchmarks {
namespace {

Cost run_native(const System& system, Precision precision, int threads) {
  const auto solver = make_native_solver({precision}, kLeastSingle, Work(threads));
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

void benchmark(const std::string& path, std::uint64_t faces, int rounds, bool with_eigen,
               Records& records) {
  auto mesh = read_triangles(path);
  if (faces > mesh.face_count()) mesh = refine(mesh, faces);
  const System system = interior_laplacian(mesh, Numbering::kAlongCurve);
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
  all.push_back({"CHOLMOD, AMD (Ua)", [&] { return run_cholmod(system, Unit::kUa); }});
  all.push_back({"CHOLMOD, METIS (Um)", [&] { return run_cholmod(system, Unit::kUm); }});
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
    records.add({{"mesh", std::filesystem::path(path).stem().string()},
                 {"faces", mesh.face_count()},
                 {"solver", c.name},
                 {"analyze", c.best.analyze},
                 {"factorize", c.best.factorize},
                 {"solve", c.best.solve},
                 {"total", c.best.total()},
                 {"wall", c.best.wall},
                 {"residual", c.best.residual}});
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
  beltrami::benchmarks::Records records("solver");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    for (const std::string& mesh : meshes) {
      for (const std::uint64_t count : faces) {
        beltrami::benchmarks::benchmark(mesh, count, rounds, !no_eigen, records);
      }
    }
    return 0;
  });
}
