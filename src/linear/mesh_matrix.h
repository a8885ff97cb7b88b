// Symmetric matrices with the pattern of a mesh, assembled face by face without sorting triplets.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "base/types.h"
#include "base/work.h"
#include "linear/spd_solver.h"
#include "mesh/face_chunks.h"

namespace beltrami {

/// A point of a surface or of the plane as the place of an unknown.
template <class Point>
Place place_of(const Point& point) {
  Place place{};
  for (int k = 0; k < point.size(); ++k) place[k] = static_cast<float>(point[k]);
  return place;
}

/// A symmetric matrix of block_size x block_size blocks: one block row per free vertex, blocks
/// where two free vertices share an edge. Only the lower triangle is stored.
class MeshMatrix {
 public:
  /// `fixed`: per vertex, whether it is left out of the system.
  MeshMatrix(Index vertex_count, const std::vector<Triangle>& faces, const std::vector<bool>& fixed,
             int block_size, const Work& work);

  /// Block row of a vertex, or kNone if it is fixed.
  Index row(Index vertex) const { return row_[vertex]; }
  Index free_count() const { return free_count_; }
  const std::vector<Index>& rows() const { return row_; }
  /// The places of the free vertices in the order of their rows, for SpdSolver::analyze, on a
  /// surface or in the plane.
  template <class Point>
  std::vector<Place> places(const std::vector<Point>& points) const;

  void set_zero(const Work& work);
  /// Adds the block of corner i against corner j of a face; `block(r, c)` gives its entries. To be
  /// called once for every unordered pair of corners, the diagonal ones included. Fixed corners are
  /// skipped.
  template <class Block>
  void add(Index face, const Triangle& corners, int i, int j, const Block& block) {
    for_each_entry(face, corners, i, j, block,
                   [](Index, double& entry, double term) { entry += term; });
  }
  /// Adds to the block of a row against itself.
  template <class Block>
  void add_diagonal(Index row, const Block& block) {
    for (int c = 0; c < block_size_; ++c) {
      double* column = matrix_.valuePtr() + matrix_.outerIndexPtr()[block_size_ * row + c];
      for (int r = c; r < block_size_; ++r) column[r - c] += block(r, c);
    }
  }
  /// For every face calls `give(face, add)`, which adds blocks of that face by add(i, j, block), in
  /// parallel; the same bits at any number of threads. `faces` are those of the constructor.
  template <class Give>
  void add_up(const Work& work, const std::vector<Triangle>& faces, const Give& give);

  const SparseMatrix& matrix() const { return matrix_; }
  SparseMatrix& matrix() { return matrix_; }

  /// The chunks of faces of add_up.
  const FaceChunks& chunks() const { return chunks_; }

 private:
  /// Calls visit(vertex, entry, term) for the entries of a block, `vertex` being that of the
  /// column.
  template <class Block, class Visit>
  void for_each_entry(Index face, const Triangle& corners, int i, int j, const Block& block,
                      const Visit& visit);

  int block_size_;
  FaceChunks chunks_;
  Index free_count_ = 0;
  std::vector<Index> row_;  // per vertex
  std::vector<std::array<Index, 3>>
      slot_;  // per face and edge k: rank of its block below the diagonal
  SparseMatrix matrix_;
};

template <class Point>
std::vector<Place> MeshMatrix::places(const std::vector<Point>& points) const {
  std::vector<Place> places(free_count_, Place{});
  for (std::size_t v = 0; v < row_.size(); ++v) {
    if (row_[v] != kNone) places[row_[v]] = place_of(points[v]);
  }
  return places;
}

template <class Block, class Visit>
void MeshMatrix::for_each_entry(Index face, const Triangle& corners, int i, int j,
                                const Block& block, const Visit& visit) {
  const Index ri = row_[corners[i]], rj = row_[corners[j]];
  if (ri == kNone || rj == kNone) return;
  double* values = matrix_.valuePtr();
  const int* starts = matrix_.outerIndexPtr();
  if (i == j) {
    for (int c = 0; c < block_size_; ++c) {
      double* column = values + starts[block_size_ * ri + c];
      for (int r = c; r < block_size_; ++r) visit(corners[i], column[r - c], block(r, c));
    }
    return;
  }
  const Index rank = slot_[face][next_corner(i) == j ? i : j];
  const bool swap = ri < rj;  // the block below the diagonal has the larger row
  const Index column_block = swap ? ri : rj;
  const Index vertex = corners[swap ? i : j];
  for (int c = 0; c < block_size_; ++c) {
    double* column =
        values + starts[block_size_ * column_block + c] + (block_size_ - c) + rank * block_size_;
    for (int r = 0; r < block_size_; ++r) {
      visit(vertex, column[r], swap ? block(c, r) : block(r, c));
    }
  }
}

template <class Give>
void MeshMatrix::add_up(const Work& work, const std::vector<Triangle>& faces, const Give& give) {
  struct Aside {
    double* entry;
    double term;
  };
  PutAside<Aside> aside(chunks_, size_of(row_));
  parallel_for(work, static_cast<std::int64_t>(faces.size()), chunks_.grain(),
               [&](std::int64_t begin, std::int64_t end) {
                 const std::size_t chunk = chunks_.of(begin);
                 const auto put = [&](Index vertex, double& entry, double term) {
                   if (chunks_.shared(vertex)) {
                     aside.put(chunk, vertex, {&entry, term});
                   } else {
                     entry += term;
                   }
                 };
                 for (std::int64_t f = begin; f < end; ++f) {
                   const auto face = static_cast<Index>(f);
                   give(face, [&](int i, int j, const auto& block) {
                     for_each_entry(face, faces[face], i, j, block, put);
                   });
                 }
               });
  aside.add_up(work, [](const Aside& a) { *a.entry += a.term; });
}

}  // namespace beltrami
