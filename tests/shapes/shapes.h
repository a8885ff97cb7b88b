// Small meshes of all kinds that people have and adversaries make, as many as there are seeds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "shapes/shape.h"

namespace beltrami::shapes {

/// Names of all kinds: "flat_ring", ...
std::span<const std::string_view> kinds();

/// The kind that a seed is of: they take turns.
std::string_view kind_of(std::uint64_t seed);

/// The shape of a seed: some 1 to 1,500 faces, the same on every platform. Made by its kind, then
/// perhaps turned, scaled and shifted, rounded to single precision, taken apart into lone faces, or
/// with faces turned over. `kind`: one of kinds(), or empty for that of the seed; an unknown one
/// gives no faces.
Shape make_shape(std::uint64_t seed, std::string_view kind = {});

}  // namespace beltrami::shapes
