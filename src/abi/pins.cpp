#include "abi/pins.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "abi/buffers.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "pins/hold.h"

namespace beltrami {
namespace {

void require_effect(const beltrami_surface& header, const AtlasOptions& options) {
  const char* other = options.unit_square                ? "the option unit-square"
                      : header.densities.data != nullptr ? "densities"
                                                         : nullptr;
  if (other == nullptr) return;
  throw Error(Fault::kInvalidArgument,
              std::string("pins say how large charts are, and so do ") + other + ": leave one out");
}

/// Throws Error where the place of a pin is no number that can be delivered.
void require_number(const Pin& pin, bool float32) {
  const auto corner = Element::corner(static_cast<std::uint64_t>(pin.of_caller));
  if (!pin.uv.allFinite()) {
    throw Error(Fault::kNonFinite, "the UV of " + name_of(pin) + " is infinite or not a number",
                corner);
  }
  if (!float32) return;
  for (const double x : pin.uv) {
    if (std::abs(x) <= std::numeric_limits<float>::max() && static_cast<float>(x) == x) continue;
    throw Error(Fault::kInvalidArgument,
                "the UV of " + name_of(pin) +
                    " is no single-precision number, which the option float32 asks for: round it, "
                    "or leave float32 out",
                corner);
  }
}

/// Of each pin its kind, its place and its direction, and all else but where it is.
std::vector<Pin> read_places(const beltrami_surface& header,
                             const std::vector<std::uint64_t>& corners, bool float32,
                             const Work& work) {
  const std::vector<double> uvs =
      read_numbers(header.pin_uvs, header.pin_count, 2, "pin UVs", work);
  std::vector<std::uint64_t> kinds;
  std::vector<double> directions;
  if (header.pin_kinds.data != nullptr) {
    kinds = read_integers(header.pin_kinds, header.pin_count, 1, "kinds of pins", work);
  }
  if (header.pin_directions.data != nullptr) {
    directions = read_numbers(header.pin_directions, header.pin_count, 2, "directions", work);
  }
  std::vector<Pin> pins;
  pins.reserve(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Pin pin{kNone,
            0,
            {uvs[2 * i], uvs[2 * i + 1]},
            static_cast<Index>(i),
            static_cast<Index>(corners[i])};
    pin.given = pin.uv;
    if (!kinds.empty()) hold_by(kinds[i], directions.empty() ? nullptr : &directions[2 * i], pin);
    require_number(pin, float32);
    pins.push_back(pin);
  }
  return pins;
}

}  // namespace

PinKind pin_kind_of(std::uint64_t number, const std::string& name) {
  switch (number) {
    case BELTRAMI_PIN_POINT:
      return PinKind::kPoint;
    case BELTRAMI_PIN_U:
      return PinKind::kU;
    case BELTRAMI_PIN_V:
      return PinKind::kV;
    case BELTRAMI_PIN_LINE:
      return PinKind::kLine;
    default:
      throw Error(Fault::kInvalidArgument, name + " is of kind " + std::to_string(number) +
                                               ": give a BELTRAMI_PIN_ number, from 0 to 3");
  }
}

void hold_by(std::uint64_t kind, const double* direction, Pin& pin) {
  const auto corner = Element::corner(static_cast<std::uint64_t>(pin.of_caller));
  pin.kind = pin_kind_of(kind, name_of(pin));
  if (pin.kind == PinKind::kLine && direction == nullptr) {
    throw Error(Fault::kInvalidArgument,
                name_of(pin) + " is of the kind BELTRAMI_PIN_LINE: give pin_directions", corner);
  }
  pin.along = pin.kind == PinKind::kLine ? Vec2(direction[0], direction[1]) : Vec2(0, 0);
  if (pin.kind == PinKind::kLine && !(pin.along.allFinite() && !pin.along.isZero(0))) {
    throw Error(Fault::kInvalidArgument,
                "the direction of " + name_of(pin) + " is none: give two numbers, not both 0",
                corner);
  }
  // What says nothing is to do no harm.
  pin.uv = pin.given;
  if (pin.kind == PinKind::kU) pin.uv.y() = 0;
  if (pin.kind == PinKind::kV) pin.uv.x() = 0;
}

std::vector<Pin> read_pins(const beltrami_surface& header, const LoadedSurface& surface,
                           const AtlasOptions& options, const Work& work) {
  std::vector<Pin> pins;
  if (header.pin_count == 0) return pins;
  if (header.pin_count > static_cast<std::uint64_t>(std::numeric_limits<Index>::max())) {
    throw Error(Fault::kInvalidArgument, "there are " + std::to_string(header.pin_count) +
                                             " pins: at most 2^31 - 1 are possible");
  }
  require_effect(header, options);
  const std::vector<std::uint64_t> corners =
      read_integers(header.pins, header.pin_count, 1, "pins", work);
  std::vector<Index> first(header.corner_count, kNone), next(corners.size(), kNone);
  PollSometimes poll;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    poll();
    if (corners[i] >= header.corner_count) {
      throw Error(Fault::kIndexOutOfRange, "pin " + std::to_string(i) + " names corner " +
                                               std::to_string(corners[i]) + ", but there are " +
                                               std::to_string(header.corner_count) +
                                               " corners: they count from 0, face after face");
    }
  }
  const std::vector<Pin> places = read_places(header, corners, options.float32, work);
  for (std::size_t i = corners.size(); i-- > 0;) {
    next[i] = first[corners[i]];
    first[corners[i]] = static_cast<Index>(i);
  }
  const std::vector<Triangle>& triangles = surface.triangulation.triangles;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    poll();
    for (int k = 0; k < 3; ++k) {
      for (Index i = first[triangles[t][k]]; i != kNone; i = next[i]) {
        Pin& pin = pins.emplace_back(places[static_cast<std::size_t>(i)]);
        pin.face = static_cast<Index>(t);
        pin.corner = k;
      }
    }
  }
  sort_interruptibly(pins.begin(), pins.end(), [](const Pin& a, const Pin& b) {
    return std::pair(a.number, a.face) < std::pair(b.number, b.face);
  });
  return pins;
}

}  // namespace beltrami
