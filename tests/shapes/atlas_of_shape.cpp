#include "shapes/atlas_of_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <utility>

namespace beltrami::shapes {
namespace {

using Triangles = std::vector<std::array<std::size_t, 3>>;

struct Destroy {
  void operator()(beltrami_context* context) const { beltrami_destroy(context); }
};
using Context = std::unique_ptr<beltrami_context, Destroy>;

template <class Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

void set_way(beltrami_context* context, Way way) {
  switch (way) {
    case Way::kAuto:
      break;
    case Way::kHard:
      beltrami_set_float(context, BELTRAMI_OPTION_HARD_ANGLE, 30);
      break;
    case Way::kLightmap:
      beltrami_set_int(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_LIGHTMAP);
      break;
    case Way::kMinimal:
      beltrami_set_int(context, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
      break;
  }
}

Triangles in_threes(const std::vector<std::uint64_t>& corners) {
  Triangles out(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); ++i) out[i / 3][i % 3] = corners[i];
  return out;
}

void read_results(beltrami_context* context, ShapeAtlas& atlas) {
  auto counts = sized<beltrami_atlas>();
  beltrami_get_atlas(context, &counts);
  atlas.cpu_seconds = counts.cpu_seconds;
  std::vector<std::uint64_t> triangles(3 * counts.triangles);
  beltrami_get_triangles(context, triangles.data(), BELTRAMI_U64, 0);
  atlas.triangles = in_threes(triangles);
  atlas.uvs.resize(counts.corners);
  beltrami_get_corner_uvs(context, atlas.uvs.data(), BELTRAMI_F64, 0);
  std::vector<std::array<float, 2>> single(counts.corners);
  beltrami_get_corner_uvs(context, single.data(), BELTRAMI_F32, 0);
  for (const auto& [u, v] : single) atlas.single_uvs.push_back({u, v});
  atlas.pages.resize(counts.corners);
  beltrami_get_corner_pages(context, atlas.pages.data(), BELTRAMI_U32, 0);
  for (const bool single_precision : {false, true}) {
    auto certificate = sized<beltrami_atlas_certificate>();
    beltrami_get_atlas_certificate(context, single_precision ? BELTRAMI_F32 : BELTRAMI_F64,
                                   &certificate);
    (single_precision ? atlas.injective_single : atlas.injective) = certificate.injective != 0;
  }
  auto packing = sized<beltrami_packing>();
  if (beltrami_get_packing(context, &packing) == BELTRAMI_OK) atlas.margin = packing.margin;
}

}  // namespace

beltrami_surface view(const Shape& shape) {
  auto surface = sized<beltrami_surface>();
  surface.vertex_count = shape.positions.size();
  surface.face_count = shape.faces();
  surface.corner_count = shape.corners.size();
  surface.positions = {shape.positions.data(), 0, BELTRAMI_F64, 0};
  surface.indices = {shape.corners.data(), 0, BELTRAMI_U32, 0};
  surface.face_sizes = {shape.sizes.data(), 0, BELTRAMI_U32, 0};
  return surface;
}

ShapeAtlas unwrap(const Shape& shape, Way way, int threads) {
  ShapeAtlas atlas;
  beltrami_context* made = nullptr;
  atlas.status = beltrami_create(&made);
  if (atlas.status != BELTRAMI_OK) return atlas;
  const Context context(made);
  beltrami_set_int(made, BELTRAMI_OPTION_THREADS, threads);
  beltrami_set_int(made, BELTRAMI_OPTION_RESOLUTION, shape.resolution);
  beltrami_set_float(made, BELTRAMI_OPTION_MARGIN, shape.margin);
  set_way(made, way);
  if (way != Way::kMinimal) {
    beltrami_get_option(made, BELTRAMI_OPTION_TARGET_ENERGY, &atlas.target);
  }
  const beltrami_surface surface = view(shape);
  atlas.status = beltrami_unwrap(made, &surface, nullptr, nullptr);
  atlas.message = beltrami_error_message(made);
  if (atlas.status >= BELTRAMI_OK) read_results(made, atlas);
  return atlas;
}

Triangles triangulate(const Shape& shape) {
  std::size_t count = 0;
  for (const std::uint32_t size : shape.sizes) count += size - 2;
  std::vector<std::uint64_t> corners(3 * count);
  const beltrami_surface surface = view(shape);
  if (beltrami_triangulate(&surface, corners.data(), BELTRAMI_U64, 0, nullptr) != BELTRAMI_OK) {
    return {};
  }
  return in_threes(corners);
}

namespace {

/// A triangle in a plane of its own: its first side runs along x.
struct Flat {
  double base = 0, x = 0, height = 0;
  double longest_square = 0;

  double area() const { return 0.5 * base * height; }
};

Flat flattened(const Shape& shape, const std::array<std::size_t, 3>& triangle) {
  std::array<Point3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = shape.positions[shape.corners[triangle[k]]];
  const auto less = [](const Point3& a, const Point3& b) {
    return Point3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const auto dot = [](const Point3& a, const Point3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const Point3 e = less(p[1], p[0]), f = less(p[2], p[0]), g = less(p[2], p[1]);
  const Point3 n = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2],
                    e[0] * f[1] - e[1] * f[0]};
  Flat flat;
  flat.base = std::sqrt(dot(e, e));
  flat.longest_square = std::max({dot(e, e), dot(f, f), dot(g, g)});
  if (flat.base > 0) {
    flat.x = dot(e, f) / flat.base;
    flat.height = std::sqrt(dot(n, n)) / flat.base;
  }
  return flat;
}

}  // namespace

std::vector<double> areas(const Shape& shape, const Triangles& faces) {
  std::vector<double> out;
  for (const auto& face : faces) out.push_back(flattened(shape, face).area());
  return out;
}

std::vector<char> without_area(const Shape& shape, const Triangles& triangles) {
  constexpr double kLeast = 1e-14 * 1.01;  // of what is compared with, and a little for rounding
  double largest = 0;
  for (const double area : areas(shape, triangles)) largest = std::max(largest, area);
  std::vector<char> out;
  for (const auto& triangle : triangles) {
    const Flat flat = flattened(shape, triangle);
    out.push_back(!(flat.area() > kLeast * std::max(largest, flat.longest_square)));
  }
  return out;
}

std::vector<std::size_t> components(const Shape& shape, const Triangles& triangles) {
  std::map<Point3, std::size_t> names;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> first_at;
  std::vector<std::size_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto name = [&](std::size_t corner) {
        const Point3& place = shape.positions[shape.corners[triangles[t][corner]]];
        return names.try_emplace(place, names.size()).first->second;
      };
      const std::size_t a = name(k), b = name((k + 1) % 3);
      if (a == b) continue;
      const auto [edge, is_new] = first_at.try_emplace(std::minmax(a, b), t);
      if (!is_new) parent[root(t)] = root(edge->second);
    }
  }
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < triangles.size(); ++t) out.push_back(root(t));
  return out;
}

namespace {

/// Energy of a face at scale s: along s^2 + across / s^2.
struct FaceEnergy {
  double area = 0, along = 0, across = 0;

  double at(double square) const { return along * square + across / square; }
};

/// What has finite energy, and a vote. Faces that are not judged have no area here.
std::vector<FaceEnergy> face_energies(const Shape& shape, const ShapeAtlas& atlas) {
  const std::vector<char> left_out = without_area(shape, atlas.triangles);
  std::vector<FaceEnergy> faces(atlas.triangles.size());
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (left_out[t]) continue;
    const Flat flat = flattened(shape, atlas.triangles[t]);
    const auto& [a, b, c] = atlas.triangles[t];
    const Uv &p = atlas.uvs[a], &q = atlas.uvs[b], &r = atlas.uvs[c];
    std::array<double, 4> j;
    for (std::size_t k = 0; k < 2; ++k) {
      j[2 * k] = (q[k] - p[k]) / flat.base;
      j[2 * k + 1] = ((r[k] - p[k]) - j[2 * k] * flat.x) / flat.height;
    }
    const double norm = j[0] * j[0] + j[1] * j[1] + j[2] * j[2] + j[3] * j[3];
    const double determinant = j[0] * j[3] - j[1] * j[2];
    faces[t] = {flat.area(), 0.5 * norm, 0.5 * norm / (determinant * determinant)};
    if (!(determinant > 0)) faces[t].across = std::numeric_limits<double>::infinity();
  }
  return faces;
}

/// Mean at a scale but for the worst faces, which are left out of `voters`.
double mean_of_voters(const std::vector<FaceEnergy>& faces, std::vector<std::size_t>& voters,
                      double square) {
  std::sort(voters.begin(), voters.end(), [&](std::size_t i, std::size_t j) {
    return faces[i].at(square) < faces[j].at(square);
  });
  double area = 0, sum = 0;
  for (const std::size_t t : voters) area += faces[t].area;
  for (double dropped = 0; !voters.empty(); voters.pop_back()) {
    dropped += faces[voters.back()].area;
    if (dropped >= kNoVote * area) break;
  }
  area = 0;
  for (const std::size_t t : voters) {
    area += faces[t].area;
    sum += faces[t].area * faces[t].at(square);
  }
  return area > 0 ? sum / area : 2;
}

/// The square of the scale that is best for all that vote.
double best_scale(const std::vector<FaceEnergy>& faces) {
  double square = 1;
  for (int round = 0; round < 4; ++round) {
    std::vector<std::size_t> voters(faces.size());
    std::iota(voters.begin(), voters.end(), std::size_t{0});
    if (round > 0) mean_of_voters(faces, voters, square);
    double along = 0, across = 0;
    for (const std::size_t t : voters) {
      if (!std::isfinite(faces[t].across)) continue;
      along += faces[t].area * faces[t].along;
      across += faces[t].area * faces[t].across;
    }
    if (along > 0 && across > 0) square = std::sqrt(across / along);
  }
  return square;
}

}  // namespace

std::vector<ComponentEnergy> component_energies(const Shape& shape, const ShapeAtlas& atlas) {
  const std::vector<FaceEnergy> faces = face_energies(shape, atlas);
  const double square = best_scale(faces);
  const std::vector<std::size_t> roots = components(shape, atlas.triangles);
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t t = 0; t < faces.size(); ++t) {
    if (faces[t].area > 0) members[roots[t]].push_back(t);
  }
  std::vector<ComponentEnergy> out;
  for (auto& [root, voters] : members) {
    ComponentEnergy one;
    for (const std::size_t t : voters) one.area += faces[t].area;
    one.energy = mean_of_voters(faces, voters, square);
    out.push_back(one);
  }
  return out;
}

}  // namespace beltrami::shapes
