// An atlas as a host sees it, and what we measure on it.
#pragma once

#include <beltrami/beltrami.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "shapes/exact_triangles.h"
#include "shapes/properties.h"
#include "shapes/shape.h"

namespace beltrami::shapes {

struct ShapeAtlas {
  beltrami_status status = BELTRAMI_OK;
  std::string message;                               ///< of a failure
  double target = 0;                                 ///< mean energy asked for; 0 where none is
  double margin = 0;                                 ///< texels, as the library measures it
  bool injective = false, injective_single = false;  ///< its verdicts
  double cpu_seconds = 0;
  std::vector<std::array<std::size_t, 3>> triangles;  ///< corners
  std::vector<Uv> uvs;                                ///< of corners
  std::vector<Uv> single_uvs;
  std::vector<std::uint32_t> pages;  ///< of corners
};

/// A view of a shape, which must outlive it.
beltrami_surface view(const Shape& shape);

ShapeAtlas unwrap(const Shape& shape, Way way, int threads = 1);

/// Area of the triangles of a shape as the library cuts it; of all, before any of them is left out.
std::vector<double> areas(const Shape& shape, const std::vector<std::array<std::size_t, 3>>& faces);

/// Whether each triangle is without area: what the header says of beltrami_atlas.
std::vector<char> without_area(const Shape& shape,
                               const std::vector<std::array<std::size_t, 3>>& triangles);

/// The triangles of a shape as beltrami_triangulate cuts them.
std::vector<std::array<std::size_t, 3>> triangulate(const Shape& shape);

/// A component: triangles joined by edges with the same ends in space.
struct ComponentEnergy {
  double area = 0;
  double energy = 2;  ///< mean by area, but for the worst that have less than kNoVote of the area
};

/// Share of the area, of a component's and of all, that has no vote.
inline constexpr double kNoVote = 1e-6;

/// The component of each triangle.
std::vector<std::size_t> components(const Shape& shape,
                                    const std::vector<std::array<std::size_t, 3>>& triangles);

/// Energies of all components, at one scale for all: the best.
std::vector<ComponentEnergy> component_energies(const Shape& shape, const ShapeAtlas& atlas);

}  // namespace beltrami::shapes
