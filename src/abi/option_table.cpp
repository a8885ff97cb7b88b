#include "abi/option_table.h"

#include <charconv>
#include <string>

#include "base/error.h"

namespace beltrami {
namespace {

constexpr const char* kMethods[] = {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"};
constexpr const char* kFlattens[] = {"metric", "dirichlet", "gif", "flim", "bff"};
constexpr const char* kInjectivities[] = {"auto", "global", "local"};
constexpr const char* kSwitch[] = {"off", "on"};
constexpr const char* kEnergies[] = {"symmetric-dirichlet", "symmetric-arap"};

template <auto Member>
double get(const Options& options) {
  return static_cast<double>(options.*Member);
}

template <auto Member>
void set(Options& options, double value) {
  using Value = std::remove_reference_t<decltype(options.*Member)>;
  options.*Member = static_cast<Value>(value);
}

const OptionEntry kOptions[] = {
    {BELTRAMI_OPTION_METHOD, BELTRAMI_TYPE_CHOICE, "method",
     "How the map is computed: beltrami (fast and low in distortion), cm (composite majorization "
     "on the full mesh, the slow reference), tutte (into a circle, highly distorted), or a "
     "baseline "
     "to compare with: gif and bff on the surface's own metric, uv-prolongation of the coarse UVs "
     "(bff and uv-prolongation may flip).",
     0, std::size(kMethods) - 1, kMethods, get<&Options::method>, set<&Options::method>},
    {BELTRAMI_OPTION_ENERGY, BELTRAMI_TYPE_CHOICE, "energy", "The distortion that is minimised.", 0,
     std::size(kEnergies) - 1, kEnergies, get<&Options::energy>, set<&Options::energy>},
    {BELTRAMI_OPTION_COARSE_FACES,
     BELTRAMI_TYPE_INT,
     "coarse-faces",
     "Faces of the simplified mesh that composite majorization runs on; 0 chooses 1% of the "
     "faces, at least 10,000.",
     0,
     700e6,
     {},
     get<&Options::coarse_faces>,
     set<&Options::coarse_faces>},
    {BELTRAMI_OPTION_TOLERANCE,
     BELTRAMI_TYPE_FLOAT,
     "tolerance",
     "Relative decrease of the energy in one iteration below which composite majorization stops.",
     0,
     1,
     {},
     get<&Options::tolerance>,
     set<&Options::tolerance>},
    {BELTRAMI_OPTION_MAX_ITERATIONS,
     BELTRAMI_TYPE_INT,
     "max-iterations",
     "Iterations after which composite majorization stops even if it has not converged.",
     1,
     1e6,
     {},
     get<&Options::max_iterations>,
     set<&Options::max_iterations>},
    {BELTRAMI_OPTION_THREADS,
     BELTRAMI_TYPE_INT,
     "threads",
     "Threads to use, the calling one included; the result does not depend on it.",
     1,
     1024,
     {},
     get<&Options::threads>,
     set<&Options::threads>},
    {BELTRAMI_OPTION_UNIT_SQUARE,
     BELTRAMI_TYPE_INT,
     "unit-square",
     "1 scales and shifts the UVs into the unit square; 0 keeps them in the mesh's unit of length.",
     0,
     1,
     {},
     get<&Options::unit_square>,
     set<&Options::unit_square>},
    {BELTRAMI_OPTION_FLATTEN, BELTRAMI_TYPE_CHOICE, "flatten",
     "How the method beltrami flattens the fine mesh: metric (Poisson solve with a free boundary "
     "and "
     "a polish), dirichlet (harmonic, boundary from the coarse map: faster, energy a little "
     "higher), "
     "gif (harmonic subspace of a few boundary vertices with a scaffold), flim (the same, local "
     "injectivity only) or bff (conformal, may flip).",
     0, std::size(kFlattens) - 1, kFlattens, get<&Options::flatten>, set<&Options::flatten>},
    {BELTRAMI_OPTION_INJECTIVITY, BELTRAMI_TYPE_CHOICE, "injectivity",
     "What the optimisation sees to: global (no flips, no boundary crossings), local (no flips: "
     "parts may overlap, at a slightly lower energy) or auto (global, but for the method cm, which "
     "is left as the literature has it).",
     0, std::size(kInjectivities) - 1, kInjectivities, get<&Options::injectivity>,
     set<&Options::injectivity>},
    {BELTRAMI_OPTION_REFINE,
     BELTRAMI_TYPE_INT,
     "refine",
     "1 goes on with composite majorization on the fine mesh from the result, to a little less "
     "energy in much more time.",
     0,
     1,
     {},
     get<&Options::refine>,
     set<&Options::refine>},
    {BELTRAMI_OPTION_REFINE_ITERATIONS,
     BELTRAMI_TYPE_INT,
     "refine-iterations",
     "Iterations after which the refinement stops; 0 leaves it to the tolerance.",
     0,
     1e6,
     {},
     get<&Options::refine_iterations>,
     set<&Options::refine_iterations>},
    {BELTRAMI_OPTION_TIME_LIMIT,
     BELTRAMI_TYPE_FLOAT,
     "time-limit",
     "Seconds since the start of the run after which iterations stop with the best map so far; 0 "
     "sets no limit.",
     0,
     1e9,
     {},
     get<&Options::time_limit>,
     set<&Options::time_limit>},
    {BELTRAMI_OPTION_FLOAT32,
     BELTRAMI_TYPE_INT,
     "float32",
     "1 delivers UVs that single precision holds exactly, rounded so that the map stays injective.",
     0,
     1,
     {},
     get<&Options::float32>,
     set<&Options::float32>},
    {BELTRAMI_OPTION_DELAUNAY, BELTRAMI_TYPE_CHOICE, "delaunay",
     "on flips edges to the intrinsic Delaunay triangulation of the prolonged metric before the "
     "fine mesh is flattened: what is injective then are its own triangles on the same vertices.",
     0, std::size(kSwitch) - 1, kSwitch, get<&Options::delaunay>, set<&Options::delaunay>},
    {BELTRAMI_OPTION_MEMORY_LIMIT,
     BELTRAMI_TYPE_INT,
     "memory-limit",
     "Bytes of memory that a run is to stay within by its estimate: one that needs more ends "
     "before "
     "it starts, and steps that only hard meshes need are left out where they would exceed it; 0 "
     "sets no limit.",
     0,
     1e14,
     {},
     get<&Options::memory_limit>,
     set<&Options::memory_limit>},
};

/// The shortest text that reads back to the value, whatever the host's locale.
std::string number(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

const OptionEntry& require_option(std::int32_t key, bool is_float) {
  const OptionEntry* option = find_option(key);
  if (option == nullptr) {
    throw Error(BELTRAMI_E_INVALID_ARGUMENT, "there is no option with key " + std::to_string(key) +
                                                 ": keys run from 0 to " +
                                                 std::to_string(std::size(kOptions) - 1));
  }
  if (is_float != (option->type == BELTRAMI_TYPE_FLOAT)) {
    throw Error(BELTRAMI_E_INVALID_ARGUMENT, std::string("the option ") + option->name +
                                                 " is set by beltrami_set_" +
                                                 (is_float ? "int" : "float"));
  }
  return *option;
}

[[noreturn]] void refuse_value(const OptionEntry& option, const std::string& value) {
  std::string message = value + " is out of range for the option " + option.name +
                        ": give a number from " + number(option.minimum) + " to " +
                        number(option.maximum);
  const char* separator = " (";
  for (const char* choice : option.choices) {
    message += separator;
    message += choice;
    separator = ", ";
  }
  if (!option.choices.empty()) message += ")";
  throw Error(BELTRAMI_E_INVALID_ARGUMENT, message);
}

}  // namespace

std::span<const OptionEntry> option_table() {
  return kOptions;
}

const OptionEntry* find_option(std::int32_t key) {
  if (key < 0 || static_cast<std::size_t>(key) >= std::size(kOptions)) return nullptr;
  return &kOptions[key];
}

void set_int_option(Options& options, std::int32_t key, std::int64_t value) {
  const OptionEntry& option = require_option(key, false);
  if (value < static_cast<std::int64_t>(option.minimum) ||
      value > static_cast<std::int64_t>(option.maximum)) {
    refuse_value(option, std::to_string(value));
  }
  option.set(options, static_cast<double>(value));
}

void set_float_option(Options& options, std::int32_t key, double value) {
  const OptionEntry& option = require_option(key, true);
  // Written so that NaN is refused, too.
  if (!(value >= option.minimum && value <= option.maximum)) refuse_value(option, number(value));
  option.set(options, value);
}

}  // namespace beltrami
