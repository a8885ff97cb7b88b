// The caller's pins as pins of triangles.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <string>
#include <vector>

#include "abi/surface.h"
#include "atlas/pins.h"
#include "atlas/types.h"
#include "base/work.h"
#include "pins/hold.h"

namespace beltrami {

/// The kind of a BELTRAMI_PIN_ number; `name` is of what has it. Throws Error INVALID_ARGUMENT.
PinKind pin_kind_of(std::uint64_t number, const std::string& name);

/// Makes a pin one of a BELTRAMI_PIN_ number; `direction`: two numbers, or nullptr where none is
/// given. Throws Error INVALID_ARGUMENT with the corner.
void hold_by(std::uint64_t kind, const double* direction, Pin& pin);

/// Reads the pins of a surface: one for each triangle that has the corner. Throws Error
/// INVALID_ARGUMENT where pins come with densities or the unit square, or with the corner where a
/// place is no single-precision number and the options ask for these; or a kind or direction is
/// none; INDEX_OUT_OF_RANGE; or NON_FINITE with the corner.
std::vector<Pin> read_pins(const beltrami_surface& header, const LoadedSurface& surface,
                           const AtlasOptions& options, const Work& work);

}  // namespace beltrami
