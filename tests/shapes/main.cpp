// Unwraps as many shapes as asked for in every way, and says what broke.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "shapes/isolated.h"
#include "shapes/properties.h"
#include "shapes/shape.h"
#include "shapes/shapes.h"

namespace beltrami::shapes {
namespace {

struct Arguments {
  std::uint64_t count = 300;
  std::uint64_t seed = 0;
  std::vector<std::string> kinds;
  std::string options = "all";
  std::string out;
  int cpu_limit = 60;
  double slow = 5;
  int minimise = 0;
  double seconds = 0;
  bool again = false;
};

void write_obj(const Shape& shape, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (!file) return;
  for (const auto& [x, y, z] : shape.positions)
    std::fprintf(file, "v %.17g %.17g %.17g\n", x, y, z);
  std::size_t corner = 0;
  for (const std::uint32_t size : shape.sizes) {
    std::fprintf(file, "f");
    for (std::uint32_t k = 0; k < size; ++k) std::fprintf(file, " %u", shape.corners[corner++] + 1);
    std::fprintf(file, "\n");
  }
  std::fclose(file);
}

class LongRun {
 public:
  explicit LongRun(Arguments arguments) : arguments_(std::move(arguments)) {
    for (const Way way : kWays) {
      if (arguments_.options == "all" || arguments_.options == name_of(way)) ways_.push_back(way);
    }
    if (!arguments_.out.empty()) std::filesystem::create_directories(arguments_.out);
  }

  /// Returns whether nothing broke.
  bool run() {
    const std::time_t begin = std::time(nullptr);
    for (std::uint64_t i = 0; i < arguments_.count; ++i) {
      const double elapsed = std::difftime(std::time(nullptr), begin);
      if (arguments_.seconds > 0 && elapsed >= arguments_.seconds) break;
      const std::uint64_t seed = arguments_.seed + i;
      const std::string kind = arguments_.kinds.empty()
                                   ? std::string(kind_of(seed))
                                   : arguments_.kinds[seed % arguments_.kinds.size()];
      const Shape shape = make_shape(seed, kind);
      for (const Way way : ways_) try_one(shape, way);
    }
    print_table();
    return failures_.empty();
  }

 private:
  void try_one(const Shape& shape, Way way) {
    const Report report =
        check_isolated(shape, way, arguments_.cpu_limit, arguments_.again ? check_again : check);
    ++tried_[shape.kind];
    const std::string name(name_of(way));
    const auto seed = static_cast<unsigned long long>(shape.seed);
    if (report.cpu_seconds >= arguments_.slow) {
      std::printf("%-13s %-13s %6llu %-8s  %zu faces, %.1f CPU s\n", "slow", shape.kind.c_str(),
                  seed, name.c_str(), shape.faces(), report.cpu_seconds);
    }
    for (const Finding& finding : report.findings) {
      ++failures_[shape.kind][{finding.fault, way}];
      std::printf("%-13s %-13s %6llu %-8s  %zu faces: %s\n", name_of(finding.fault).data(),
                  shape.kind.c_str(), seed, name.c_str(), shape.faces(), finding.what.c_str());
      if (!arguments_.out.empty()) keep(shape, way, finding.fault);
    }
    std::fflush(stdout);
  }

  void keep(const Shape& shape, Way way, Fault fault) {
    const std::string path = arguments_.out + "/" + std::string(name_of(fault)) + "_" + shape.kind +
                             "_" + std::to_string(shape.seed) + "_" + std::string(name_of(way));
    write_obj(shape, path + ".obj");
    if (arguments_.minimise == 0) return;
    const Shape least = minimised(shape, way, fault, arguments_.minimise,
                                  fault == Fault::kTime ? arguments_.cpu_limit : 10);
    write_obj(least, path + "_least.obj");
    std::printf("              least: %zu faces, resolution %d, margin %g: %s_least.obj\n",
                least.faces(), least.resolution, least.margin, path.c_str());
  }

  void print_table() const {
    std::printf("\nchecks that failed, by kind and option\n");
    for (const auto& [kind, checks] : tried_) {
      const auto failed = failures_.find(kind);
      std::printf("%-13s %5d checks", kind.c_str(), checks);
      if (failed != failures_.end()) {
        for (const auto& [key, count] : failed->second) {
          std::printf("  %s/%s %d", name_of(key.first).data(), name_of(key.second).data(), count);
        }
      }
      std::printf("\n");
    }
  }

  Arguments arguments_;
  std::vector<Way> ways_;
  std::map<std::string, int> tried_;
  std::map<std::string, std::map<std::pair<Fault, Way>, int>> failures_;
};

}  // namespace
}  // namespace beltrami::shapes

int main(int argc, char** argv) {
  using namespace beltrami::shapes;
  Arguments arguments;
  CLI::App app("Unwraps shapes of all kinds and says what broke. Exit code 1 if something did.");
  app.add_option("--count", arguments.count, "Shapes: seeds from --seed on")->capture_default_str();
  app.add_option("--seed", arguments.seed, "The first seed")->capture_default_str();
  std::vector<std::string> names;
  for (const std::string_view kind : kinds()) names.emplace_back(kind);
  app.add_option("--kind", arguments.kinds, "Only shapes of these kinds")
      ->check(CLI::IsMember(names));
  app.add_option("--options", arguments.options, "How they are unwrapped")
      ->check(CLI::IsMember({"auto", "hard", "lightmap", "minimal", "all"}))
      ->capture_default_str();
  app.add_option("--out", arguments.out, "A folder for shapes that failed, as OBJ");
  app.add_option("--cpu-limit", arguments.cpu_limit, "CPU seconds that a check may take")
      ->capture_default_str();
  app.add_option("--slow", arguments.slow, "CPU seconds from which a run is listed")
      ->capture_default_str();
  app.add_option("--minimise", arguments.minimise,
                 "Also writes smaller shapes with the same fault, after so many checks at most")
      ->capture_default_str();
  app.add_option("--seconds", arguments.seconds, "Ends after so much time; 0: after the count")
      ->capture_default_str();
  app.add_flag("--again", arguments.again,
               "Also on two threads, at other scales and turned in space");
  CLI11_PARSE(app, argc, argv);
  return LongRun(arguments).run() ? 0 : 1;
}
