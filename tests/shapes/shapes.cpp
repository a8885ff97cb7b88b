#include "shapes/shapes.h"

#include <algorithm>
#include <array>
#include <string>

#include "shapes/kinds.h"
#include "shapes/random.h"

namespace beltrami::shapes {
namespace {

constexpr std::array<std::string_view, 25> kNames = {
    "flat_ring", "frame",  "plate",        "letter",    "disc",   "t_vertices", "spiral",
    "prism",     "block",  "solid_letter", "sliver",    "blob",   "torus",      "voxels",
    "lattice",   "needle", "soup",         "chaos",     "copies", "crumbs",     "twisted",
    "book",      "hub",    "ribbon",       "degenerate"};
constexpr std::array<Shape (*)(Random&), 25> kMakers = {
    flat_ring,    frame,  plate,   letter, disc,   t_vertices, spiral,    prism, block,
    solid_letter, sliver, blob,    torus,  voxels, lattice,    needle,    soup,  chaos,
    copies,       crumbs, twisted, book,   hub,    ribbon,     degenerate};

void turn_faces_over(Shape& shape, Random& random) {
  const auto firsts = shape.first_corners();
  for (std::size_t f = 0; f < shape.faces(); ++f) {
    if (random.chance(0.7)) continue;
    std::reverse(shape.corners.begin() + static_cast<std::ptrdiff_t>(firsts[f]),
                 shape.corners.begin() + static_cast<std::ptrdiff_t>(firsts[f + 1]));
  }
}

/// What a file may do to any shape.
Shape as_in_files(Shape shape, Random& random) {
  if (random.chance(0.1)) turn_faces_over(shape, random);
  if (random.chance(0.6)) {
    turn(shape, random);
    const double size = random.chance(0.5) ? 1 : random.spread(1e-3, 1e3);
    scale(shape, {size, size, size});
    if (random.chance(0.5)) {
      shift(shape, {size * random.between(-2, 2), size * random.between(-2, 2), 0});
    }
    if (random.chance(0.5)) round_to_float(shape);
  }
  if (random.chance(0.12)) shape = exploded(shape);
  if (random.chance(0.1)) {
    constexpr std::array<int, 4> kResolutions = {128, 512, 2048, 8192};
    shape.resolution = kResolutions[random.bits() % kResolutions.size()];
    shape.margin = random.count(0, 1 + shape.resolution / 128);
  }
  return shape;
}

}  // namespace

std::span<const std::string_view> kinds() {
  return kNames;
}

std::string_view kind_of(std::uint64_t seed) {
  return kNames[seed % kNames.size()];
}

Shape make_shape(std::uint64_t seed, std::string_view kind) {
  if (kind.empty()) kind = kind_of(seed);
  const auto name = std::find(kNames.begin(), kNames.end(), kind);
  Shape shape;
  if (name != kNames.end()) {
    Random random(seed);
    random.bits();
    Shape made = kMakers[static_cast<std::size_t>(name - kNames.begin())](random);
    shape = as_in_files(std::move(made), random);
  }
  shape.kind = kind;
  shape.seed = seed;
  return shape;
}

}  // namespace beltrami::shapes
