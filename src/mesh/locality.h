// Numbering vertices and faces by where they are, so that neighbours lie close in memory.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"

namespace beltrami {

/// The least box around points.
Eigen::AlignedBox3d bounding_box(const std::vector<Vec3>& points, const Work& work);

/// Points in the order of a Hilbert curve through their bounding box: the index of the first point,
/// of the second, and so on. Points in one cell (2^-11 of the longest side) keep their order.
/// Precondition: finite points.
std::vector<Index> along_hilbert_curve(const std::vector<Vec3>& points, const Work& work);

/// Faces by their least vertex: the index of the first face, of the second, and so on. Faces with
/// the same one keep their order. Precondition: indices in [0, vertex_count).
std::vector<Index> by_least_vertex(Index vertex_count, const std::vector<Triangle>& faces,
                                   const Work& work);

/// The items that `order` names, one after the other.
template <class Item>
std::vector<Item> in_order(const std::vector<Item>& items, const std::vector<Index>& order,
                           const Work& work) {
  std::vector<Item> result;
  result.reserve(order.size());
  touch_memory(work, result.data(), order.size() * sizeof(Item));
  result.resize(order.size());
  constexpr std::int64_t kGrain = 16384;
  parallel_for(work, size_of(order), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) result[i] = items[order[i]];
  });
  return result;
}

/// A new numbering of a mesh.
struct Arrangement {
  std::vector<Index> vertices;  ///< per vertex: its number before
  std::vector<Index> faces;     ///< per face: likewise
};

/// Numbers vertices along a Hilbert curve and faces by their least vertex; `faces` is renumbered.
/// Preconditions: finite positions, indices in range.
Arrangement arrange(const std::vector<Vec3>& positions, std::vector<Triangle>& faces,
                    const Work& work);

}  // namespace beltrami
