// What a command found, as JSON for other programs (docs/report.md) and as a summary for people.
#pragma once

#include <beltrami/beltrami.h>

#include <chrono>
#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "commands/page_layout.h"
#include "files/mesh_file.h"
#include "files/surface.h"
#include "process/failure.h"

namespace beltrami::cli {

/// Raised when a key changes its meaning or goes away; new keys alone do not raise it.
inline constexpr int kReportSchema = 1;

/// Square texels of a chart below which nothing can be painted on it, and a user is told.
inline constexpr double kFewTexels = 4;

struct StageTime {
  std::string name;
  double seconds = 0;
  double cpu_seconds = 0;
  int iterations = 0;
};

/// Options by name. Plain data, for objects of the JSON library need memory to end.
using OptionValues =
    std::vector<std::pair<std::string, std::variant<bool, std::int64_t, double, std::string>>>;

/// A chart that is not as it was promised.
struct FailedChart {
  std::uint64_t index = 0;
  beltrami_chart chart{};
};

/// What seams were searched for; 0: any.
struct Target {
  double energy = 0, p99 = 0;
  std::int64_t charts = 0;
  double seams = 0;  ///< length over the root of the area
};

/// What was baked for new UVs.
struct BakedCounts {
  std::uint64_t textures = 0, texels = 0, without_source = 0;
};

/// The pages, counted from 0, that the charts of a label are on.
struct LabelPages {
  std::string name;
  std::uint64_t first = 0, last = 0;
};

/// Everything that a command has not come to know is empty, and null in JSON.
struct Report {
  std::string command;
  bool printed = false;  ///< goes to standard output, failures too
  std::string status = "BELTRAMI_OK";
  std::string message;  ///< of a failure
  std::int32_t element_kind = BELTRAMI_ELEMENT_NONE;
  std::uint64_t element = BELTRAMI_NO_ELEMENT;

  std::string input_path;
  std::optional<std::uint64_t> vertices, faces, triangles, boundary_edges, unreferenced_vertices,
      welded_vertices, short_faces;
  std::optional<double> area;

  OptionValues options;
  std::optional<beltrami_certificate> certificate;
  std::optional<bool> float32_injective;  ///< of the UVs as written, rounded to nearest
  std::optional<bool> float32_possible;   ///< with the option float32
  std::optional<beltrami_energy> energy;
  std::optional<std::uint64_t> coarse_faces, flips_before_repair;
  std::optional<beltrami_result> result;
  std::optional<beltrami_atlas> atlas;
  std::optional<Target> target;
  std::optional<beltrami_packing> packing;
  std::vector<double> page_utilisations;
  std::vector<LabelPages> label_pages;  ///< by their first pages; where labels have their own
  std::optional<BakedCounts> textures;
  std::optional<PageLayout> layout;  ///< check
  std::vector<std::string> unmet;    ///< check: what was asked for and is not so, in words
  std::optional<beltrami_atlas_certificate> atlas_certificate;
  std::vector<FailedChart> failed_charts;
  std::uint64_t tiny_charts = 0;      ///< that have less than kFewTexels
  std::vector<std::string> not_kept;  ///< of the input, in words, by the output
  std::vector<std::string> notes;     ///< what else is to be known of the output, in sentences
  std::string advice;                 ///< for the summary: what else the user may want, or ""
  std::vector<StageTime> stages;
  std::optional<std::int64_t> threads;
  std::optional<std::uint64_t>
      estimated_memory_bytes;  ///< of the run, see beltrami_estimate_memory
  double seconds = 0;

  /// Counts of what was read, and of the triangles that it was cut into.
  void set_input(const MeshFile& file, const Surface& surface);
  bool injective() const {
    return atlas_certificate ? atlas_certificate->injective != 0
                             : certificate && certificate->injective != 0;
  }
  void set_failure(const Failure& failure);
};

/// Length of the seams of an atlas, over the root of its area.
double seam_over_root_area(const beltrami_atlas& atlas);

/// The JSON text, with a final line end.
std::string to_json(const Report& report);

/// "face", "vertex" or "corner".
const char* element_name(std::int32_t kind);

/// The lines on stderr that say what of the input `written` does not keep, and what else is to be
/// known of it; "" where there is nothing.
std::string to_note(const Report& report, const std::string& written);

/// The lines for people. `written`: the output path, or "".
std::string to_summary(const Report& report, const std::string& written);

/// Times a stage from its construction and adds it to a report in finish(); a stage that fails is
/// not listed.
class StageClock {
 public:
  StageClock(Report& report, const char* name) : report_(report), name_(name) {}
  void finish();

 private:
  Report& report_;
  const char* name_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::clock_t cpu_start_ = std::clock();
};

}  // namespace beltrami::cli
