#include "cut/layers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// Pixels in the area of the map: a few for each face, enough for the tolerance of coarse maps, and
/// no more than a few ten milliseconds' worth.
constexpr double kPixelsPerFace = 4, kLeastPixels = 1 << 17, kMostPixels = 1 << 20;
/// Pixels of the box, most of which may be empty: 16 MB.
constexpr double kMostCells = 1 << 22;

double area_of(const Triangle& face, const std::vector<Vec2>& uvs) {
  const Vec2 a = uvs[face[1]] - uvs[face[0]], b = uvs[face[2]] - uvs[face[0]];
  return (a.x() * b.y() - a.y() * b.x()) / 2;
}

/// The place along a row where an edge crosses it: the same from both of its faces.
double crossing(Vec2 a, Vec2 b, double y) {
  if (b.y() < a.y()) std::swap(a, b);
  return a.x() + (y - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
}

/// Calls visit(pixel) for those whose centres lie in a face that lies the right way round, by the
/// pixels' own coordinates.
template <class Visit>
void for_each_pixel(const std::array<Vec2, 3>& p, Index width, const Visit& visit) {
  const double least = std::min({p[0].y(), p[1].y(), p[2].y()});
  const double most = std::max({p[0].y(), p[1].y(), p[2].y()});
  // A row is crossed by the edges with one end above it: half-open, as the spans in it.
  for (double y = std::ceil(least); y < most; ++y) {
    double from = 0, to = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec2 &a = p[k], &b = p[next_corner(k)];
      if (a.y() <= y && b.y() > y) to = crossing(a, b, y);
      if (b.y() <= y && a.y() > y) from = crossing(a, b, y);
    }
    const auto row = static_cast<Index>(y) * width;
    for (double x = std::ceil(from); x < to; ++x) visit(row + static_cast<Index>(x));
  }
}

/// Entries of pixels with two faces or more, as (pixel, face).
using Entries = std::vector<std::pair<Index, Index>>;

Layers sorted(Entries entries, Layers layers) {
  sort_interruptibly(entries.begin(), entries.end(), std::less<>());
  for (const auto& [pixel, face] : entries) {
    if (layers.pixels.empty() || layers.pixels.back() != pixel) {
      layers.pixels.push_back(pixel);
      layers.start.push_back(size_of(layers.faces));
    }
    layers.faces.push_back(face);
  }
  layers.start.push_back(size_of(layers.faces));
  return layers;
}

}  // namespace

Layers layers_of(const Surface& mesh, const std::vector<Vec2>& uvs) {
  PollSometimes poll;
  Eigen::AlignedBox2d box;
  double area = 0;
  for (const Triangle& face : mesh.faces) {
    poll();
    area += std::max(area_of(face, uvs), 0.0);
    for (const Index v : face) box.extend(uvs[v]);
  }
  Layers layers;
  if (!(area > 0)) return sorted({}, std::move(layers));
  const double wanted = std::clamp(kPixelsPerFace * mesh.face_count(), kLeastPixels, kMostPixels);
  // No more than kMostCells whatever the shape of the box: of area, or of length where it is thin.
  const Vec2 size = box.sizes();
  layers.pixel = std::max({std::sqrt(area / wanted), std::sqrt(size.prod() / (kMostCells / 2)),
                           (size.x() + size.y()) / (kMostCells / 4)});
  layers.origin = box.min();
  layers.width = static_cast<Index>(size.x() / layers.pixel) + 2;
  const Index height = static_cast<Index>(size.y() / layers.pixel) + 2;
  std::vector<Index> first(static_cast<std::size_t>(layers.width) * height, kNone);
  constexpr Index kListed = -2;  // its first face is among the entries already
  Entries entries;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    poll();
    if (!(area_of(mesh.faces[f], uvs) > 0)) continue;
    std::array<Vec2, 3> corners;
    for (int k = 0; k < 3; ++k) {
      corners[k] = (uvs[mesh.faces[f][k]] - layers.origin) / layers.pixel;
    }
    for_each_pixel(corners, layers.width, [&](Index pixel) {
      poll();
      if (first[pixel] == kNone) {
        first[pixel] = f;
        return;
      }
      if (first[pixel] != kListed)
        entries.emplace_back(pixel, std::exchange(first[pixel], kListed));
      entries.emplace_back(pixel, f);
    });
  }
  return sorted(std::move(entries), std::move(layers));
}

Layers layers_among(const Layers& layers, const std::vector<Index>& new_face) {
  Layers among;
  among.origin = layers.origin;
  among.pixel = layers.pixel;
  among.width = layers.width;
  PollSometimes poll;
  for (Index i = 0; i < layers.count(); ++i) {
    poll();
    const std::size_t before = among.faces.size();
    for (const Index f : layers[i]) {
      if (new_face[f] != kNone) among.faces.push_back(new_face[f]);
    }
    if (among.faces.size() < before + 2) {
      among.faces.resize(before);
      continue;
    }
    among.pixels.push_back(layers.pixels[i]);
    among.start.push_back(static_cast<Index>(before));
  }
  among.start.push_back(size_of(among.faces));
  return among;
}

double overlapped_area(const Layers& layers) {
  return static_cast<double>(size_of(layers.faces) - layers.count()) * layers.pixel * layers.pixel;
}

}  // namespace beltrami
