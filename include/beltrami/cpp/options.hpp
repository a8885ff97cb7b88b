// Options: the values of choices, the keys with the types of their values, and values of any type
// for those who have a name and a text.
#ifndef BELTRAMI_CPP_OPTIONS_HPP
#define BELTRAMI_CPP_OPTIONS_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/result.hpp>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

BELTRAMI_CPP_BEGIN

// The header of C says what each choice means.
enum class Method : std::int32_t {
  kBeltrami = BELTRAMI_METHOD_BELTRAMI,
  kCm = BELTRAMI_METHOD_CM,
  kTutte = BELTRAMI_METHOD_TUTTE,
  kGif = BELTRAMI_METHOD_GIF,
  kBff = BELTRAMI_METHOD_BFF,
  kUvProlongation = BELTRAMI_METHOD_UV_PROLONGATION
};
enum class EnergyKind : std::int32_t {
  kSymmetricDirichlet = BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET,
  kSymmetricArap = BELTRAMI_ENERGY_SYMMETRIC_ARAP,
  kExponentialDirichlet = BELTRAMI_ENERGY_EXPONENTIAL_DIRICHLET
};
enum class Flatten : std::int32_t {
  kMetric = BELTRAMI_FLATTEN_METRIC,
  kDirichlet = BELTRAMI_FLATTEN_DIRICHLET,
  kGif = BELTRAMI_FLATTEN_GIF,
  kFlim = BELTRAMI_FLATTEN_FLIM,
  kBff = BELTRAMI_FLATTEN_BFF
};
enum class Injectivity : std::int32_t {
  kAuto = BELTRAMI_INJECTIVITY_AUTO,
  kGlobal = BELTRAMI_INJECTIVITY_GLOBAL,
  kLocal = BELTRAMI_INJECTIVITY_LOCAL
};
enum class Cut : std::int32_t {
  kMinimal = BELTRAMI_CUT_MINIMAL,
  kIslands = BELTRAMI_CUT_ISLANDS,
  kAuto = BELTRAMI_CUT_AUTO,
  kGiven = BELTRAMI_CUT_GIVEN
};
enum class Weld : std::int32_t {
  kAuto = BELTRAMI_WELD_AUTO,
  kOn = BELTRAMI_WELD_ON,
  kOff = BELTRAMI_WELD_OFF
};
enum class Preset : std::int32_t {
  kNone = BELTRAMI_PRESET_NONE,
  kLightmap = BELTRAMI_PRESET_LIGHTMAP,
  kTexturing = BELTRAMI_PRESET_TEXTURING,
  kOneChart = BELTRAMI_PRESET_ONE_CHART,
  kHardSurface = BELTRAMI_PRESET_HARD_SURFACE
};
enum class Pack : std::int32_t { kPages = BELTRAMI_PACK_PAGES, kNone = BELTRAMI_PACK_NONE };
enum class PackTurns : std::int32_t {
  kAny = BELTRAMI_PACK_TURNS_ANY,
  kQuarter = BELTRAMI_PACK_TURNS_QUARTER,
  kNone = BELTRAMI_PACK_TURNS_NONE
};
enum class Effort : std::int32_t {
  kQuick = BELTRAMI_EFFORT_QUICK,
  kNormal = BELTRAMI_EFFORT_NORMAL,
  kHigh = BELTRAMI_EFFORT_HIGH
};
enum class Stack : std::int32_t {
  kNone = BELTRAMI_STACK_NONE,
  kCopies = BELTRAMI_STACK_COPIES,
  kMirrored = BELTRAMI_STACK_MIRRORED,
  kHalves = BELTRAMI_STACK_HALVES
};
enum class Rectify : std::int32_t {
  kNone = BELTRAMI_RECTIFY_NONE,
  kGrids = BELTRAMI_RECTIFY_GRIDS
};
enum class Delaunay : std::int32_t { kOff = 0, kOn = 1 };

/// The key of an option whose values have type T: std::int64_t, double, or the enum of a choice.
template <class T>
struct Option {
  std::int32_t key;
};

/// Every option, by the name that it has in C: BELTRAMI_OPTION_COARSE_FACES is kCoarseFaces.
namespace option {
using Integer = Option<std::int64_t>;
using Real = Option<double>;

inline constexpr Option<Method> kMethod{BELTRAMI_OPTION_METHOD};
inline constexpr Option<EnergyKind> kEnergy{BELTRAMI_OPTION_ENERGY};
inline constexpr Integer kCoarseFaces{BELTRAMI_OPTION_COARSE_FACES};
inline constexpr Real kTolerance{BELTRAMI_OPTION_TOLERANCE};
inline constexpr Integer kMaxIterations{BELTRAMI_OPTION_MAX_ITERATIONS};
inline constexpr Integer kThreads{BELTRAMI_OPTION_THREADS};
inline constexpr Integer kUnitSquare{BELTRAMI_OPTION_UNIT_SQUARE};
inline constexpr Option<Flatten> kFlatten{BELTRAMI_OPTION_FLATTEN};
inline constexpr Option<Injectivity> kInjectivity{BELTRAMI_OPTION_INJECTIVITY};
inline constexpr Integer kRefine{BELTRAMI_OPTION_REFINE};
inline constexpr Integer kRefineIterations{BELTRAMI_OPTION_REFINE_ITERATIONS};
inline constexpr Real kTimeLimit{BELTRAMI_OPTION_TIME_LIMIT};
inline constexpr Integer kFloat32{BELTRAMI_OPTION_FLOAT32};
inline constexpr Option<Delaunay> kDelaunay{BELTRAMI_OPTION_DELAUNAY};
inline constexpr Integer kMemoryLimit{BELTRAMI_OPTION_MEMORY_LIMIT};
inline constexpr Option<Cut> kCut{BELTRAMI_OPTION_CUT};
inline constexpr Real kHardAngle{BELTRAMI_OPTION_HARD_ANGLE};
inline constexpr Option<Weld> kWeld{BELTRAMI_OPTION_WELD};
inline constexpr Real kWeldDistance{BELTRAMI_OPTION_WELD_DISTANCE};
inline constexpr Real kFillHoles{BELTRAMI_OPTION_FILL_HOLES};
inline constexpr Integer kShareCopies{BELTRAMI_OPTION_SHARE_COPIES};
inline constexpr Option<Preset> kPreset{BELTRAMI_OPTION_PRESET};
inline constexpr Real kTargetEnergy{BELTRAMI_OPTION_TARGET_ENERGY};
inline constexpr Real kTargetP99{BELTRAMI_OPTION_TARGET_P99};
inline constexpr Integer kMaxCharts{BELTRAMI_OPTION_MAX_CHARTS};
inline constexpr Real kSeamBudget{BELTRAMI_OPTION_SEAM_BUDGET};
inline constexpr Real kConcaveSeams{BELTRAMI_OPTION_CONCAVE_SEAMS};
inline constexpr Real kHiddenSeams{BELTRAMI_OPTION_HIDDEN_SEAMS};
inline constexpr Real kHardSeams{BELTRAMI_OPTION_HARD_SEAMS};
inline constexpr Real kMaterialSeams{BELTRAMI_OPTION_MATERIAL_SEAMS};
inline constexpr Option<Pack> kPack{BELTRAMI_OPTION_PACK};
inline constexpr Integer kResolution{BELTRAMI_OPTION_RESOLUTION};
inline constexpr Real kMargin{BELTRAMI_OPTION_MARGIN};
inline constexpr Real kTexelsPerUnit{BELTRAMI_OPTION_TEXELS_PER_UNIT};
inline constexpr Integer kMaxPages{BELTRAMI_OPTION_MAX_PAGES};
inline constexpr Option<PackTurns> kPackTurns{BELTRAMI_OPTION_PACK_TURNS};
inline constexpr Integer kPackBlock{BELTRAMI_OPTION_PACK_BLOCK};
inline constexpr Real kFillWeight{BELTRAMI_OPTION_FILL_WEIGHT};
inline constexpr Real kSymmetricSeams{BELTRAMI_OPTION_SYMMETRIC_SEAMS};
inline constexpr Real kStraightSeams{BELTRAMI_OPTION_STRAIGHT_SEAMS};
inline constexpr Option<Effort> kEffort{BELTRAMI_OPTION_EFFORT};
inline constexpr Real kFlatSeams{BELTRAMI_OPTION_FLAT_SEAMS};
inline constexpr Option<Stack> kStack{BELTRAMI_OPTION_STACK};
inline constexpr Option<Rectify> kRectify{BELTRAMI_OPTION_RECTIFY};
inline constexpr Integer kSnapTexels{BELTRAMI_OPTION_SNAP_TEXELS};
inline constexpr Integer kLabelPages{BELTRAMI_OPTION_LABEL_PAGES};
}  // namespace option

/// The value of an option whose type is known when the program runs: an integer, a number, the enum
/// of a choice, or the name of one ("minimal"). Names are read, not kept.
class OptionValue {
 public:
  template <class T, class = std::enable_if_t<std::is_arithmetic_v<T> || std::is_enum_v<T>>>
  OptionValue(T value) noexcept {  // NOLINT(google-explicit-constructor)
    if constexpr (std::is_floating_point_v<T>) {
      real_ = static_cast<double>(value);
      is_real_ = true;
    } else {
      integer_ = static_cast<std::int64_t>(value);
      // Of unsigned numbers that are too large the greatest is as far out of range.
      if (!std::is_enum_v<T> && (value > T{}) && integer_ < 0) {
        integer_ = std::numeric_limits<std::int64_t>::max();
      }
      real_ = static_cast<double>(integer_);
    }
  }
  OptionValue(const char* choice) noexcept : choice_(choice) {}  // NOLINT(google-explicit-*)
  OptionValue(const std::string& choice) noexcept                // NOLINT(google-explicit-*)
      : choice_(choice.c_str()) {}

  /// Sets it. Failure INVALID_ARGUMENT (a value of another type, which is no matter of the context,
  /// a name that no choice has); else as beltrami_set_int, of which the context says more.
  Result<void> set(beltrami_context* context, std::int32_t key) const {
    auto info = detail::sized<beltrami_option_info>();
    std::int64_t integer = integer_;
    bool real = is_real_;
    if (beltrami_option_describe(key, &info) == BELTRAMI_OK) {  // else the library refuses the key
      if (choice_ != nullptr) {
        integer = number_of(choice_, key);
        if (integer < 0) {
          return detail::refusal({"the option ", info.name, " has no value '", choice_, "'"});
        }
      } else if (real && info.type != BELTRAMI_TYPE_FLOAT) {
        return detail::refusal({"the option ", info.name, " takes an integer"});
      }
      real = info.type == BELTRAMI_TYPE_FLOAT;
    }
    const beltrami_status status =
        real ? beltrami_set_float(context, key, real_) : beltrami_set_int(context, key, integer);
    if (status < 0) return Failure(status, beltrami_error_message(context));
    return {};
  }

 private:
  /// The number of a choice, -1 where none has this name.
  static std::int64_t number_of(const char* name, std::int32_t key) noexcept {
    std::int32_t value = 0;
    for (; const char* known = beltrami_option_choice(key, value); ++value) {
      if (std::strcmp(name, known) == 0) return value;
    }
    return -1;
  }

  std::int64_t integer_ = 0;
  double real_ = 0;
  bool is_real_ = false;
  const char* choice_ = nullptr;
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_OPTIONS_HPP
