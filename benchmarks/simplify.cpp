// Our simplifier beside OpenMesh's decimater, on meshes refined to some sizes: CPU seconds on one
// thread, the best of some rounds, and the root mean square distance from the fine vertices to the
// coarse surface, in units of the square root of the area.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/vectors.h"
#include "mesh/closest_point.h"
#include "mesh/disk_mesh.h"
#include "records.h"
#include "refine.h"
#include "simplify/back_ends.h"
#include "simplify/simplify.h"
#include "yardstick.h"

namespace beltrami::benchmarks {
namespace {

DiskMesh disk_of(const TriangleMesh& file) {
  const std::vector<Vec3> positions = positions_of(file);
  std::vector<Triangle> faces = faces_of(file);
  std::vector<Vec3> kept;
  for (const Index v : drop_unreferenced(size_of(positions), faces, Work(1)))
    kept.push_back(positions[v]);
  DiskMesh mesh = build_disk(std::move(kept), std::move(faces), Work(1));
  normalise(mesh.positions, mesh.faces, Work(1));
  return mesh;
}

double distance(const DiskMesh& fine, const DiskMesh& coarse) {
  const ClosestPoint closest(coarse.positions, coarse.faces);
  double sum = 0;
  for (const Vec3& p : fine.positions) sum += closest.find(p, Vec3::Zero(), kNone).distance_sq;
  return std::sqrt(sum / fine.vertex_count() / surface_area(fine, Work(1)));
}

struct Outcome {
  double cpu = std::numeric_limits<double>::infinity();
  CoarseDisk coarse;
};

Outcome run(const std::function<CoarseDisk()>& simplify, int rounds) {
  Outcome best;
  for (int round = 0; round < rounds; ++round) {
    const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
    best.coarse = simplify();
    best.cpu = std::min(best.cpu, seconds(CLOCK_PROCESS_CPUTIME_ID) - begin);
  }
  return best;
}

void benchmark(const std::string& path, std::uint64_t faces, Index target, int rounds,
               Records& records) {
  auto file = read_triangles(path);
  if (faces > file.face_count()) file = refine(file, faces);
  const DiskMesh fine = disk_of(file);
  const Outcome ours = run([&] { return simplify_in_passes(fine, target, Work(1)); }, rounds);
  const Outcome openmesh = run([&] { return simplify_by_openmesh(fine, target, Work(1)); }, rounds);
  const double near = distance(fine, ours.coarse.mesh);
  const double openmesh_near = distance(fine, openmesh.coarse.mesh);
  std::printf("%-24s %8d %6d %8.3f %9.3f %7.1f %9.2e %9.2e %6.2f\n",
              std::filesystem::path(path).stem().string().c_str(), fine.face_count(),
              ours.coarse.mesh.face_count(), ours.cpu, openmesh.cpu, openmesh.cpu / ours.cpu, near,
              openmesh_near, near / openmesh_near);
  std::fflush(stdout);
  records.add({{"mesh", std::filesystem::path(path).stem().string()},
               {"faces", fine.face_count()},
               {"left", ours.coarse.mesh.face_count()},
               {"cpu_seconds", ours.cpu},
               {"openmesh_cpu_seconds", openmesh.cpu},
               {"distance", near},
               {"openmesh_distance", openmesh_near}});
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  CLI::App app("Simplifies MESH..., refined to some sizes, with our simplifier and OpenMesh's.");
  std::vector<std::string> meshes = {BELTRAMI_EXAMPLE_MESH};
  std::vector<std::uint64_t> faces = {100000, 300000};
  beltrami::Index target = 10000;
  int rounds = 3;
  app.add_option("MESH", meshes, "Disks; the bust of examples/data by default");
  app.add_option("--faces", faces, "Refine smaller meshes to about so many faces");
  app.add_option("--target", target, "Simplify to so many faces");
  app.add_option("--rounds", rounds, "The best of so many counts");
  beltrami::benchmarks::Records records("simplify");
  return beltrami::benchmarks::run(app, argc, argv, records, [&] {
    std::printf("%-24s %8s %6s %8s %9s %7s %9s %9s %6s\n", "mesh", "faces", "left", "ours s",
                "OpenMesh", "ratio", "distance", "OpenMesh", "ratio");
    for (const std::string& mesh : meshes) {
      for (const std::uint64_t count : faces) {
        beltrami::benchmarks::benchmark(mesh, count, target, rounds, records);
      }
    }
    return 0;
  });
}
