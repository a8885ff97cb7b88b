// What an atlas of any shape owes, judged through the C ABI and by own means.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "shapes/shape.h"

namespace beltrami::shapes {

/// How a shape is unwrapped.
enum class Way { kAuto, kHard, kLightmap, kMinimal };
inline constexpr std::array kWays = {Way::kAuto, Way::kHard, Way::kLightmap, Way::kMinimal};
std::string_view name_of(Way way);

/// What can go wrong, the worst first.
enum class Fault {
  kCrash,         ///< the process ends
  kTime,          ///< it takes more processor time than it may
  kRefused,       ///< an error where the surface has area
  kLost,          ///< a triangle with area is a point, or a number is not finite
  kNotInjective,  ///< a triangle is not positive, or two overlap
  kSingle,        ///< the same once rounded to single precision
  kDisagreement,  ///< the library's verdict is another than ours
  kOffPage,
  kMargin,
  kEnergy,   ///< a component is above the target, and above what the minimal cut gives it
  kBent,     ///< a flat component is above kFlatEnergy
  kStatus,   ///< a reservation, e.g. NOT_CONVERGED, where nothing is wrong
  kThreads,  ///< two threads give other UVs than one
  kScale     ///< the same in another unit of length, by a power of two, has other UVs
};
inline constexpr int kFaults = 14;
std::string_view name_of(Fault fault);

/// Mean energy that a flat component may have: twice 1, and half a percent for what rounds.
inline constexpr double kFlatEnergy = 2.01;

struct Finding {
  Fault fault;
  std::string what;
};

struct Report {
  std::vector<Finding> findings;
  int status = 0;
  double cpu_seconds = 0;
  double energy = 2;  ///< mean over the surface, by our measure
};

struct ShapeAtlas;

/// Judges an atlas of a shape; for the energies it may unwrap it along the minimal cut as well.
Report judge(const Shape& shape, const ShapeAtlas& atlas);

/// Unwraps a shape on one thread, and judges the result.
Report check(const Shape& shape, Way way);

/// The same; then also on two threads, in twice and half the unit of length, and turned in space.
Report check_again(const Shape& shape, Way way);

}  // namespace beltrami::shapes
