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

}  // namespace

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

namespace {

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

/// Two numbers of each corner of triangles, or of each texel.
using Pairs = std::vector<std::array<float, 2>>;
/// What texels of a page have: a vector, and a number beside it.
using Texels = std::vector<std::array<float, 4>>;

Vector3 vector_of(const std::array<float, 4>& texel) {
  return {double(texel[0]), double(texel[1]), double(texel[2])};
}

/// Numbers of corners, on a page of the coarse mesh.
class Spreading {
 public:
  Spreading(const DetailLooks& looks, const DetailMesh& fine, const DetailMesh& coarse,
            const std::vector<double>& uvs, beltrami_context* context, const std::string& name)
      : looks_(looks), fine_(fine), coarse_(coarse), uvs_(uvs), context_(context), name_(name) {}

  /// Per texel: what the coarse mesh has there, or the fine one where it is found. Corners have a
  /// vector each, and may have a number beside it.
  Texels spread(const std::vector<double>& vectors, bool of_fine,
                const std::vector<double>& beside = {}) {
    std::vector<std::array<double, 2>> first, second;
    for (std::size_t c = 0; c < vectors.size() / 3; ++c) {
      const Vector3 value = vector_at(vectors, c);
      first.push_back({value[0], value[1]});
      second.push_back({value[2], beside.empty() ? 0 : beside[c]});
    }
    Texels found;
    for (const auto& [x, y] : spread_pairs(first, of_fine)) found.push_back({x, y, 0, 0});
    const Pairs rest = spread_pairs(second, of_fine);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      found[i][2] = rest[i][0];
      found[i][3] = rest[i][1];
    }
    return found;
  }

  /// Per texel, what of the sky the fine mesh sees.
  Pixels sky() {
    constexpr std::uint64_t kUsualRays = 128;  // steps of less than 1 %
    BakeCall call = empty_call(true);
    call.rays = looks_.rays > 0 ? looks_.rays : kUsualRays;
    call.images.push_back({1, 1, 1, std::vector<std::uint8_t>(sizeof(float), 0), sizeof(float)});
    outcome_ = call.run(context_, name_, {});
    return std::move(call.pages.front());
  }

  const BakeOutcome& outcome() const { return outcome_; }

 private:
  BakeCall empty_call(bool of_fine) const {
    BakeCall call;
    call.side = looks_.side;
    call.new_uvs = uvs_;
    if (!of_fine) return call;
    call.positions = coarse_.places;
    call.source_positions = fine_.places;
    call.cage = looks_.cage;
    if (looks_.cage > 0) call.normals = coarse_.smooth;
    return call;
  }

  /// Numbers go through beltrami_bake as places on a ramp, whose texels say where they are read.
  Pairs spread_pairs(const std::vector<std::array<double, 2>>& pairs, bool of_fine) {
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
    BakeCall call = empty_call(of_fine);
    call.reading = {Beyond::kClamp, Beyond::kClamp};
    call.images.push_back(ramp());
    // Between the centres of its two texels a side shows all from 0 to 1.
    for (const auto& pair : pairs) {
      for (std::size_t k = 0; k < 2; ++k) {
        call.old_uvs.push_back(0.25 + 0.5 * (pair[k] - low[k]) / (high[k] - low[k]));
      }
    }
    const BakeOutcome outcome = call.run(context_, name_, {});
    if (of_fine) outcome_ = outcome;
    const Pixels& page = call.pages.front();
    Pairs found(page.values.size() / (2 * sizeof(float)));
    std::memcpy(found.data(), page.values.data(), page.values.size());
    for (auto& pair : found) {
      for (std::size_t k = 0; k < 2; ++k) {
        pair[k] = static_cast<float>(low[k] + (high[k] - low[k]) * double(pair[k]));
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

  const DetailLooks& looks_;
  const DetailMesh& fine_;
  const DetailMesh& coarse_;
  const std::vector<double>& uvs_;
  beltrami_context* context_;
  const std::string& name_;
  BakeOutcome outcome_;
};

/// The page that `shown(texel)` gives, of as many components as its arrays.
template <class Shown>
Pixels page_of(int side, int components, const Shown& shown) {
  Pixels page{side, side, components, {}, sizeof(float)};
  const std::size_t texels = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
  const auto width = static_cast<std::size_t>(components);
  page.values.resize(sizeof(float) * width * texels);
  for (std::size_t i = 0; i < texels; ++i) {
    const Vector3 values = shown(i);
    for (std::size_t k = 0; k < width; ++k) {
      const auto value = static_cast<float>(values[k]);
      std::memcpy(&page.values[sizeof(float) * (width * i + k)], &value, sizeof value);
    }
  }
  return page;
}

Pixels heights(Spreading& spreading, const DetailMesh& fine, const DetailMesh& coarse, int side) {
  const Texels normals = spreading.spread(coarse.normals, false);
  const Texels there = spreading.spread(fine.places, true);
  const Texels here = spreading.spread(coarse.places, false);
  return page_of(side, 1, [&](std::size_t i) -> Vector3 {
    const Vector3 normal = normalized(vector_of(normals[i]), {});
    return {dot(vector_of(there[i]) - vector_of(here[i]), normal), 0, 0};
  });
}

Pixels directions(Spreading& spreading, const DetailMesh& fine, const DetailMesh& coarse,
                  const std::vector<double>& uvs, int side) {
  std::vector<double> tangents, sides;
  for (const auto& [x, y, z, of_side] : corner_tangents({coarse.places, coarse.normals, uvs})) {
    append(tangents, {x, y, z});
    sides.push_back(of_side);
  }
  const Texels normals = spreading.spread(coarse.normals, false);
  const Texels there = spreading.spread(fine.normals, true);
  const Texels along = spreading.spread(tangents, false, sides);
  return page_of(side, 3, [&](std::size_t i) -> Vector3 {
    const Vector3 n = normalized(vector_of(normals[i]), {0, 0, 1});
    const Vector3 a = vector_of(along[i]);
    const Vector3 t = normalized(a - dot(a, n) * n, {});
    const Vector3 b = (along[i][3] < 0 ? -1.0 : 1.0) * cross(n, t);
    const Vector3 seen = normalized(vector_of(there[i]), n);
    const Vector3 local =
        normalized({dot(seen, t), dot(seen, b), std::max(dot(seen, n), 0.0)}, {0, 0, 1});
    return {0.5 + 0.5 * local[0], 0.5 + 0.5 * local[1], 0.5 + 0.5 * local[2]};
  });
}

std::vector<double> of_triangles(const std::vector<double>& values,
                                 const std::vector<std::size_t>& triangles) {
  std::vector<double> found;
  for (const std::size_t t : triangles) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(9 * t);
    found.insert(found.end(), first, first + 9);
  }
  return found;
}

}  // namespace

std::optional<Detail> detail_named(const std::string& word) {
  if (word == "normals") return Detail::kNormals;
  if (word == "heights") return Detail::kHeights;
  if (word == "occlusion") return Detail::kOcclusion;
  return std::nullopt;
}

DetailMesh detail_mesh(const MeshFile& file, const std::vector<std::uint32_t>& triangles) {
  DetailMesh mesh;
  for (const std::uint32_t corner : triangles) {
    append(mesh.places, vector_at(file.positions, file.polygons.corners()[corner]));
  }
  mesh.normals = mesh.smooth = smooth_normals(mesh.places);
  const std::vector<double> given = given_normals(file);
  for (std::size_t c = 0; c < triangles.size() && !given.empty(); ++c) {
    const Vector3 own = vector_at(given, triangles[c]);
    if (!(norm(own) > 0) || !std::isfinite(norm(own))) continue;
    const Vector3 normal = normalized(own, {});
    std::copy(normal.begin(), normal.end(), mesh.normals.begin() + std::ptrdiff_t(3 * c));
  }
  return mesh;
}

DetailMesh part_of(const DetailMesh& mesh, const std::vector<std::size_t>& triangles) {
  return {of_triangles(mesh.places, triangles), of_triangles(mesh.normals, triangles),
          of_triangles(mesh.smooth, triangles)};
}

DetailPage bake_detail(const DetailLooks& looks, const DetailMesh& fine, const DetailMesh& coarse,
                       const std::vector<double>& uvs, beltrami_context* context,
                       const std::string& name) {
  Spreading spreading(looks, fine, coarse, uvs, context, name);
  DetailPage made;
  switch (looks.detail) {
    case Detail::kNormals:
      made.page = directions(spreading, fine, coarse, uvs, looks.side);
      break;
    case Detail::kHeights:
      made.page = heights(spreading, fine, coarse, looks.side);
      break;
    case Detail::kOcclusion:
      made.page = spreading.sky();
      break;
  }
  made.outcome = spreading.outcome();
  return made;
}

double greatest(const Pixels& page) {
  double most = 0;
  for (std::size_t i = 0; i < page.values.size(); i += sizeof(float)) {
    float value = 0;
    std::memcpy(&value, &page.values[i], sizeof value);
    most = std::max(most, double(std::abs(value)));
  }
  return most;
}

Pixels in_whole_numbers(const Pixels& page, Detail detail, double scale) {
  const bool byte = detail == Detail::kOcclusion;
  Pixels made{page.width, page.height, page.components, {}, std::size_t{byte ? 1u : 2u}};
  const std::size_t count = page.values.size() / sizeof(float);
  made.values.resize(made.bytes * count);
  for (std::size_t i = 0; i < count; ++i) {
    float value = 0;
    std::memcpy(&value, &page.values[sizeof value * i], sizeof value);
    double unit = double(value);
    if (detail == Detail::kHeights) unit = scale > 0 ? 0.5 + 0.5 * unit / scale : 0.5;
    unit = std::clamp(unit, 0.0, 1.0);
    if (byte) {
      made.values[i] = static_cast<std::uint8_t>(255 * unit + 0.5);
    } else {
      const auto number = static_cast<std::uint16_t>(65535 * unit + 0.5);
      std::memcpy(&made.values[2 * i], &number, sizeof number);
    }
  }
  return made;
}

}  // namespace beltrami::cli
