// What grows with what: hubs, stars and UVs that coincide, at a size and at a quarter of it. Time
// and memory grow at most as n log n: by 4.4 at most where the size grows by 4, but for the caches.
//
// Each case has a process of its own, whose peak of memory is counted from before the library is
// called.
#include <beltrami/beltrami.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "process_memory.h"
#include "records.h"

namespace beltrami::benchmarks {
namespace {

constexpr double kMebibyte = 1 << 20;

struct Arrays {
  std::vector<double> positions;
  std::vector<std::uint32_t> faces;
  std::vector<double> uvs;  ///< only where they are judged

  beltrami_mesh view() const {
    beltrami_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = positions.size() / 3;
    mesh.face_count = faces.size() / 3;
    mesh.positions = {positions.data(), 0, BELTRAMI_F64, 0};
    mesh.indices = {faces.data(), 0, BELTRAMI_U32, 0};
    return mesh;
  }
};

/// On a wavy cone, which teeth do not fold.
void add_ring(Arrays& mesh, std::uint32_t count, double shift,
              const std::function<double(std::uint32_t)>& radius) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * (i + shift) / count;
    const double r = radius(i);
    mesh.positions.insert(mesh.positions.end(), {r * std::cos(angle), r * std::sin(angle),
                                                 0.1 * r * std::sin(7 * angle)});
  }
}

/// `valence` faces around vertex 0, with teeth: a star whose rim goes in and out.
Arrays star(std::uint32_t valence, double inner) {
  Arrays mesh;
  mesh.positions.assign(3, 0.0);
  add_ring(mesh, valence, 0, [inner](std::uint32_t i) { return i % 2 == 0 ? 1 : inner; });
  for (std::uint32_t i = 0; i < valence; ++i) {
    mesh.faces.insert(mesh.faces.end(), {0, 1 + i, 1 + (i + 1) % valence});
  }
  return mesh;
}

/// A hub inside: a fan, and a ring of two faces for each of its faces around it.
Arrays hub(std::uint32_t valence) {
  Arrays mesh = star(valence, 1);
  add_ring(mesh, valence, 0.5, [](std::uint32_t) { return 2; });
  for (std::uint32_t i = 0; i < valence; ++i) {
    const std::uint32_t next = (i + 1) % valence, outer = 1 + valence;
    mesh.faces.insert(mesh.faces.end(),
                      {1 + i, outer + i, 1 + next, outer + i, outer + next, 1 + next});
  }
  return mesh;
}

/// A strip of which every vertex lies on the boundary, and all have one UV.
Arrays unset(std::uint32_t edges) {
  Arrays mesh;
  for (std::uint32_t i = 0; i < edges / 2; ++i) {
    mesh.positions.insert(mesh.positions.end(), {1.0 * i, 0, 0, 1.0 * i, 1, 0});
  }
  for (std::uint32_t a = 0; a + 3 < edges; a += 2) {
    mesh.faces.insert(mesh.faces.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
  }
  mesh.uvs.assign(mesh.positions.size() / 3 * 2, 0.0);
  return mesh;
}

struct Case {
  const char* name;
  std::function<Arrays(std::uint32_t)> make;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"hub", hub},
      {"star", [](std::uint32_t n) { return star(n, 0.5); }},
      {"thin star", [](std::uint32_t n) { return star(n, 0.1); }},
      {"all UVs zero", unset},
  };
  return all;
}

struct Measured {
  double seconds, bytes, estimate;
  std::int32_t status;
};

Measured judge(const Arrays& arrays) {
  const beltrami_mesh mesh = arrays.view();
  const beltrami_buffer uvs = {arrays.uvs.data(), 0, BELTRAMI_F64, 0};
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  return {0, 0, 0, beltrami_check_injective(&mesh, &uvs, &certificate)};
}

Measured flatten(const Arrays& arrays) {
  const beltrami_mesh mesh = arrays.view();
  beltrami_context* context = nullptr;
  std::uint64_t estimate = 0;
  std::int32_t status = beltrami_create(&context);
  if (status >= 0) status = beltrami_set_mesh(context, &mesh);
  if (status >= 0) status = beltrami_estimate_memory(context, &estimate);
  if (status >= 0) status = beltrami_run(context, nullptr, nullptr);
  beltrami_destroy(context);
  return {0, 0, static_cast<double>(estimate), status};
}

Measured measure(const Arrays& arrays) {
  malloc_trim(0);
  reset_peak();
  const double before = memory_of_process("VmRSS");
  const std::clock_t start = std::clock();
  Measured measured = arrays.uvs.empty() ? flatten(arrays) : judge(arrays);
  measured.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  measured.bytes = memory_of_process("VmHWM") - before;
  return measured;
}

/// In a process of its own, whose peak is that of this case alone.
void measure_apart(const Case& what, std::uint32_t size, Records& records) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const Measured m = measure(what.make(size));
    _exit(write(ends[1], &m, sizeof m) == sizeof m ? 0 : 1);
  }
  close(ends[1]);
  Measured m{};
  const bool told = read(ends[0], &m, sizeof m) == sizeof m;
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!told) {
    std::printf("%-14s %9u  did not end\n", what.name, size);
    return;
  }
  std::printf("%-14s %9u %8.2f %8.0f %8.0f  %s\n", what.name, size, m.seconds, m.bytes / kMebibyte,
              m.estimate / kMebibyte, beltrami_status_name(m.status));
  records.add({{"case", what.name},
               {"size", size},
               {"cpu_seconds", m.seconds},
               {"bytes", m.bytes},
               {"estimate", m.estimate},
               {"status", beltrami_status_name(m.status)}});
}

}  // namespace
}  // namespace beltrami::benchmarks

int main(int argc, char** argv) {
  using namespace beltrami::benchmarks;
  CLI::App app("What hubs, stars and UVs that coincide cost, in CPU time and memory");
  std::uint32_t size = 1000000;
  std::string only;
  app.add_option("--size", size, "Faces around the hub, or boundary edges")
      ->check(CLI::Range(100, 100000000))
      ->capture_default_str();
  app.add_option("--only", only, "One case by its name");
  Records records("limits");
  return run(app, argc, argv, records, [&] {
    std::printf("%-14s %9s %8s %8s %8s  %s\n", "", "size", "CPU s", "MiB", "estimate", "status");
    for (const Case& what : cases()) {
      if (!only.empty() && only != what.name) continue;
      for (const std::uint32_t n : {size / 4, size}) measure_apart(what, n, records);
    }
    return 0;
  });
}
