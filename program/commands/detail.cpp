#include "commands/detail.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <utility>

#include "files/column.h"
#include "files/corner_tangents.h"
#include "files/gltf_file.h"
#include "files/point_numbers.h"
#include "files/polygons.h"
#include "files/texture_use.h"
#include "files/vector3.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

/// Of the largest coordinate: how far single precision may have moved a vertex of glTF.
constexpr double kSamePlace = 1e-6;

Vector3 vector_at(const std::vector<double>& values, std::size_t i) {
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

void append(std::vector<double>& to, const Vector3& value) {
  to.insert(to.end(), value.begin(), value.end());
}

/// Per corner of `triangles`, the mean of the triangles at its place, by their areas.
std::vector<double> smooth_normals(const std::vector<double>& places) {
  PointNumbers<3> numbers;
  std::vector<Vector3> sums;
  std::vector<std::uint32_t> number_of;
  for (std::size_t first = 0; first < places.size() / 3; first += 3) {
    throw_if_interrupted();
    const Vector3 a = vector_at(places, first);
    const Vector3 normal =
        cross(vector_at(places, first + 1) - a, vector_at(places, first + 2) - a);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3 p = vector_at(places, first + k);
      const std::uint32_t number = numbers.number({p[0], p[1], p[2]});
      if (number >= sums.size()) sums.emplace_back();
      sums[number] = sums[number] + normal;
      number_of.push_back(number);
    }
  }
  std::vector<double> normals;
  for (const std::uint32_t number : number_of) append(normals, normalized(sums[number], {}));
  return normals;
}

/// Of the file's corners, NaN for none; empty where the file has none.
std::vector<double> given_normals(const MeshFile& file) {
  const std::vector<std::uint32_t>& vertices = file.polygons.corners();
  std::vector<double> found;
  if (file.gltf) {
    const std::vector<double> normals = gltf_attribute(file, "NORMAL", 3);
    if (normals.empty()) return {};
    const std::vector<double> own = gltf_attribute(file, "POSITION", 3);
    double most = 0;
    for (const double x : file.positions) most = std::max(most, std::abs(x));
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (std::abs(own[i] - file.positions[i]) <= kSamePlace * most) continue;
      throw Failure(file.path +
                    ": its nodes move meshes: apply their transforms and export it again");
    }
    for (const std::uint32_t vertex : vertices) append(found, vector_at(normals, vertex));
    return found;
  }
  const auto& [values, of_corner] = file.normals;
  const Vector3 none = {std::nan(""), std::nan(""), std::nan("")};
  for (const std::uint32_t normal : of_corner) {
    append(found, normal == kNoNormal ? none : vector_at(values, normal));
  }
  if (!found.empty()) return found;
  std::vector<const Column*> columns;
  for (const char* name : {"nx", "ny", "nz"}) {
    columns.push_back(find_column(file.vertex_columns, name));
    if (columns.back() == nullptr) return {};
  }
  for (const std::uint32_t vertex : vertices) {
    for (const Column* column : columns) found.push_back((*column)[vertex]);
  }
  return found;
}

/// Two numbers of each corner of triangles.
using Pairs = std::vector<std::array<double, 2>>;

/// Numbers of corners, on the pages of the coarse mesh.
class Spreading {
 public:
  Spreading(const DetailMesh& fine, const DetailMesh& coarse, const DetailLayout& layout,
            beltrami_context* context, const std::string& name)
      : fine_(fine), coarse_(coarse), layout_(layout), context_(context), name_(name) {}

  /// Per texel of all pages: what the coarse mesh has there, or the nearest place of the fine one.
  std::vector<Vector3> spread(const std::vector<double>& of_corners, bool of_fine) {
    Pairs first, second;
    for (std::size_t c = 0; c < of_corners.size() / 3; ++c) {
      const Vector3 value = vector_at(of_corners, c);
      first.push_back({value[0], value[1]});
      second.push_back({value[2], 0});
    }
    const Pairs one = spread_pairs(first, of_fine), two = spread_pairs(second, of_fine);
    std::vector<Vector3> found(one.size());
    for (std::size_t i = 0; i < one.size(); ++i) found[i] = {one[i][0], one[i][1], two[i][0]};
    return found;
  }
  const BakeOutcome& outcome() const { return outcome_; }

 private:
  /// Numbers go through beltrami_bake as places on a ramp, whose texels say where they are read.
  Pairs spread_pairs(const Pairs& pairs, bool of_fine) {
    std::array<double, 2> low = {0, 0}, high = {0, 0};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto finite = [&](const auto& pair) { return std::isfinite(pair[k]); };
      const auto first = std::find_if(pairs.begin(), pairs.end(), finite);
      if (first != pairs.end()) low[k] = high[k] = (*first)[k];
      for (const auto& pair : pairs) {
        if (!finite(pair)) continue;
        low[k] = std::min(low[k], pair[k]);
        high[k] = std::max(high[k], pair[k]);
      }
      if (!(high[k] > low[k])) high[k] = low[k] + 1;
    }
    BakeCall call;
    call.reading = {Beyond::kClamp, Beyond::kClamp};
    call.images.push_back(ramp());
    call.side = layout_.side;
    call.page_count = layout_.page_count;
    call.new_uvs = layout_.uvs;
    call.new_pages = layout_.pages;
    // Between the centres of its two texels a side shows all from 0 to 1.
    for (const auto& pair : pairs) {
      for (std::size_t k = 0; k < 2; ++k) {
        call.old_uvs.push_back(0.25 + 0.5 * (pair[k] - low[k]) / (high[k] - low[k]));
      }
    }
    if (of_fine) {
      call.positions = coarse_.places;
      call.source_positions = fine_.places;
    }
    const BakeOutcome outcome = call.run(context_, name_, {});
    if (of_fine) outcome_ = outcome;
    Pairs found;
    for (const Pixels& page : call.pages) {
      for (std::size_t i = 0; i < page.values.size(); i += 2 * sizeof(float)) {
        std::array<float, 2> read{};
        std::memcpy(read.data(), &page.values[i], sizeof read);
        found.push_back({low[0] + (high[0] - low[0]) * double(read[0]),
                         low[1] + (high[1] - low[1]) * double(read[1])});
      }
    }
    return found;
  }

  /// 2 x 2 texels that show their own places, rows from the top.
  static Pixels ramp() {
    constexpr std::array<float, 8> kPlaces = {0, 1, 1, 1, 0, 0, 1, 0};
    Pixels image{2, 2, 2, {}, sizeof(float)};
    image.values.resize(sizeof kPlaces);
    std::memcpy(image.values.data(), kPlaces.data(), sizeof kPlaces);
    return image;
  }

  const DetailMesh& fine_;
  const DetailMesh& coarse_;
  const DetailLayout& layout_;
  beltrami_context* context_;
  const std::string& name_;
  BakeOutcome outcome_;
};

/// Tangents of the coarse mesh, and their sides as vectors of one number.
std::array<std::vector<double>, 2> tangents_of(const DetailMesh& coarse,
                                               const DetailLayout& layout) {
  std::array<std::vector<double>, 2> found;
  for (const auto& [x, y, z, side] : corner_tangents({coarse.places, coarse.normals, layout.uvs})) {
    append(found[0], {x, y, z});
    append(found[1], {side, 0, 0});
  }
  return found;
}

Pixels page_of(const std::vector<Vector3>& values, std::size_t first, int side, int components) {
  Pixels page{side, side, components, {}, sizeof(float)};
  const auto width = static_cast<std::size_t>(components);
  const std::size_t texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  page.values.resize(sizeof(float) * width * texels);
  for (std::size_t i = 0; i < texels; ++i) {
    for (std::size_t k = 0; k < width; ++k) {
      const auto value = static_cast<float>(values[first + i][k]);
      std::memcpy(&page.values[sizeof(float) * (width * i + k)], &value, sizeof value);
    }
  }
  return page;
}

}  // namespace

std::optional<Detail> detail_named(const std::string& word) {
  if (word == "normals") return Detail::kNormals;
  if (word == "heights") return Detail::kHeights;
  return std::nullopt;
}

DetailMesh detail_mesh(const MeshFile& file, const std::vector<std::uint32_t>& triangles) {
  DetailMesh mesh;
  for (const std::uint32_t corner : triangles) {
    append(mesh.places, vector_at(file.positions, file.polygons.corners()[corner]));
  }
  mesh.normals = smooth_normals(mesh.places);
  const std::vector<double> given = given_normals(file);
  for (std::size_t c = 0; c < triangles.size() && !given.empty(); ++c) {
    const Vector3 own = vector_at(given, triangles[c]);
    if (!(norm(own) > 0) || !std::isfinite(norm(own))) continue;
    const Vector3 normal = normalized(own, {});
    std::copy(normal.begin(), normal.end(), mesh.normals.begin() + std::ptrdiff_t(3 * c));
  }
  return mesh;
}

DetailPages bake_detail(Detail detail, const DetailMesh& fine, const DetailMesh& coarse,
                        const DetailLayout& layout, beltrami_context* context,
                        const std::string& name) {
  Spreading spreading(fine, coarse, layout, context, name);
  const std::vector<Vector3> normals = spreading.spread(coarse.normals, false);
  std::vector<Vector3> shown;
  if (detail == Detail::kHeights) {
    const std::vector<Vector3> there = spreading.spread(fine.places, true);
    const std::vector<Vector3> here = spreading.spread(coarse.places, false);
    for (std::size_t i = 0; i < here.size(); ++i) {
      shown.push_back({dot(there[i] - here[i], normalized(normals[i], {})), 0, 0});
    }
  } else {
    const std::vector<Vector3> there = spreading.spread(fine.normals, true);
    const auto [tangents, sides] = tangents_of(coarse, layout);
    const std::vector<Vector3> along = spreading.spread(tangents, false);
    const std::vector<Vector3> side = spreading.spread(sides, false);
    for (std::size_t i = 0; i < there.size(); ++i) {
      const Vector3 n = normalized(normals[i], {0, 0, 1});
      const Vector3 t = normalized(along[i] - dot(along[i], n) * n, {});
      const Vector3 b = (side[i][0] < 0 ? -1.0 : 1.0) * cross(n, t);
      const Vector3 seen = normalized(there[i], n);
      const Vector3 local =
          normalized({dot(seen, t), dot(seen, b), std::max(dot(seen, n), 0.0)}, {0, 0, 1});
      shown.push_back({0.5 + 0.5 * local[0], 0.5 + 0.5 * local[1], 0.5 + 0.5 * local[2]});
    }
  }
  DetailPages pages;
  pages.outcome = spreading.outcome();
  const auto side = static_cast<std::size_t>(layout.side);
  for (std::size_t page = 0; page < layout.page_count; ++page) {
    pages.pages.push_back(
        page_of(shown, page * side * side, layout.side, detail == Detail::kHeights ? 1 : 3));
  }
  return pages;
}

std::vector<Pixels> in_16_bits(const std::vector<Pixels>& pages, Detail detail, double& scale) {
  std::vector<std::vector<float>> all;
  scale = 0;
  for (const Pixels& page : pages) {
    std::vector<float>& values = all.emplace_back(page.values.size() / sizeof(float));
    std::memcpy(values.data(), page.values.data(), page.values.size());
    for (const float value : values) scale = std::max(scale, double(std::abs(value)));
  }
  if (detail == Detail::kNormals) scale = 0;
  std::vector<Pixels> made;
  for (std::size_t i = 0; i < pages.size(); ++i) {
    Pixels& page = made.emplace_back(pages[i]);
    page.bytes = 2;
    page.values.resize(2 * all[i].size());
    for (std::size_t k = 0; k < all[i].size(); ++k) {
      const double unit = scale > 0                    ? 0.5 + 0.5 * double(all[i][k]) / scale
                          : detail == Detail::kHeights ? 0.5
                                                       : double(all[i][k]);
      const auto number = static_cast<std::uint16_t>(65535 * std::clamp(unit, 0.0, 1.0) + 0.5);
      std::memcpy(&page.values[2 * k], &number, sizeof number);
    }
  }
  return made;
}

}  // namespace beltrami::cli
