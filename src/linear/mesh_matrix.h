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

/// A symmetric matrix of block_size x block_size blocks, of size 1 or 2: one block row per free
/// vertex, blocks where two free vertices share an edge. Only the lower triangle is stored.
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
  /// Adds the block of corner i against corner j of a face; `block(r, c)` gives its entries, of a
  /// corner against itself those of the lower triangle. To be called once for every unordered pair
  /// of corners, the diagonal ones included. Fixed corners are skipped.
  template <class Block>
  void add(Index face, const Triangle& corners, int i, int j, const Block& block) {
    with_size([&]<int kSize>(Size<kSize> size) {
      for_each_column(size, face, corners, i, j, block,
                      [](Index, double* entries, const double* terms, int count) {
                        for (int r = 0; r < count; ++r) entries[r] += terms[r];
                      });
    });
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
  /// The same with chunks: calls `give(begin, end, add)`, which adds by add(face, i, j, block).
  template <class Give>
  void add_up_chunks(const Work& work, const std::vector<Triangle>& faces, const Give& give);

  const SparseMatrix& matrix() const { return matrix_; }
  SparseMatrix& matrix() { return matrix_; }

  /// The chunks of faces of add_up.
  const FaceChunks& chunks() const { return chunks_; }

 private:
  template <int kSize>
  struct Size {};
  /// Calls body with the size of the blocks, so that loops over them have a fixed length.
  template <class Body>
  void with_size(const Body& body) {
    block_size_ == 1 ? body(Size<1>()) : body(Size<2>());
  }
  /// Calls visit(vertex, entries, terms, count) for the columns of a block, `vertex` being that of
  /// the column.
  template <int kSize, class Block, class Visit>
  void for_each_column(Size<kSize> size, Index face, const Triangle& corners, int i, int j,
                       const Block& block, const Visit& visit);

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

template <int kSize, class Block, class Visit>
void MeshMatrix::for_each_column(Size<kSize>, Index face, const Triangle& corners, int i, int j,
                                 const Block& block, const Visit& visit) {
  const Index ri = row_[corners[i]], rj = row_[corners[j]];
  if (ri == kNone || rj == kNone) return;
  double* values = matrix_.valuePtr();
  const int* starts = matrix_.outerIndexPtr();
  double terms[kSize];
  if (i == j) {
    for (int c = 0; c < kSize; ++c) {
      for (int r = c; r < kSize; ++r) terms[r - c] = block(r, c);
      visit(corners[i], values + starts[kSize * ri + c], terms, kSize - c);
    }
    return;
  }
  const Index rank = slot_[face][next_corner(i) == j ? i : j];
  const bool swap = ri < rj;  // the block below the diagonal has the larger row
  const Index column_block = swap ? ri : rj;
  const Index vertex = corners[swap ? i : j];
  for (int c = 0; c < kSize; ++c) {
    for (int r = 0; r < kSize; ++r) terms[r] = swap ? block(c, r) : block(r, c);
    visit(vertex, values + starts[kSize * column_block + c] + (kSize - c) + rank * kSize, terms,
          kSize);
  }
}

template <class Give>
void MeshMatrix::add_up(const Work& work, const std::vector<Triangle>& faces, const Give& give) {
  add_up_chunks(work, faces, [&](std::int64_t begin, std::int64_t end, const auto& add) {
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      give(f, [&](int i, int j, const auto& block) { add(f, i, j, block); });
    }
  });
}

template <class Give>
void MeshMatrix::add_up_chunks(const Work& work, const std::vector<Triangle>& faces,
                               const Give& give) {
  struct Aside {
    double* entry;
    double term;
  };
  PutAside<Aside> aside(chunks_, size_of(row_));
  with_size([&]<int kSize>(Size<kSize> size) {
    parallel_for(work, static_cast<std::int64_t>(faces.size()), chunks_.grain(),
                 [&](std::int64_t begin, std::int64_t end) {
                   const std::size_t chunk = chunks_.of(begin);
                   const auto visit = [&](Index vertex, double* entries, const double* terms,
                                          int count) {
                     if (chunks_.shared(vertex)) {
                       for (int r = 0; r < count; ++r) {
                         aside.put(chunk, vertex, {entries + r, terms[r]});
                       }
                     } else {
                       for (int r = 0; r < count; ++r) entries[r] += terms[r];
                     }
                   };
                   give(begin, end, [&](Index face, int i, int j, const auto& block) {
                     for_each_column(size, face, faces[face], i, j, block, visit);
                   });
                 });
  });
  aside.add_up(work, [](const Aside& a) { *a.entry += a.term; });
}

}  // namespace beltrami
