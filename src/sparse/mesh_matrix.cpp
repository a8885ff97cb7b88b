#include "sparse/mesh_matrix.h"

#include <algorithm>

namespace beltrami {

MeshMatrix::MeshMatrix(Index vertex_count, const std::vector<Triangle>& faces,
                       const std::vector<bool>& fixed, int block_size)
    : block_size_(block_size), row_(vertex_count, kNone) {
  for (Index v = 0; v < vertex_count; ++v) {
    if (!fixed[v]) row_[v] = free_count_++;
  }
  // Rows below the diagonal of each block column, with repeats: an interior edge occurs twice.
  std::vector<Index> start(free_count_ + 1, 0);
  const auto for_each_edge = [&](auto&& visit) {
    for (Index f = 0; f < size_of(faces); ++f) {
      for (int k = 0; k < 3; ++k) {
        const Index a = row_[faces[f][k]], b = row_[faces[f][next_corner(k)]];
        if (a != kNone && b != kNone) visit(f, k, std::min(a, b), std::max(a, b));
      }
    }
  };
  for_each_edge([&](Index, int, Index column, Index) { ++start[column + 1]; });
  for (Index c = 0; c < free_count_; ++c) start[c + 1] += start[c];
  std::vector<Index> rows(start.back());
  {
    std::vector<Index> cursor(start.begin(), start.end() - 1);
    for_each_edge([&](Index, int, Index column, Index row) { rows[cursor[column]++] = row; });
  }
  std::vector<Index> unique_count(free_count_);
  for (Index c = 0; c < free_count_; ++c) {
    const auto first = rows.begin() + start[c], last = rows.begin() + start[c + 1];
    std::sort(first, last);
    unique_count[c] = static_cast<Index>(std::unique(first, last) - first);
  }
  slot_.assign(faces.size(), {kNone, kNone, kNone});
  for_each_edge([&](Index f, int k, Index column, Index row) {
    const auto first = rows.begin() + start[column];
    slot_[f][k] =
        static_cast<Index>(std::lower_bound(first, first + unique_count[column], row) - first);
  });

  const Index b = block_size_;
  matrix_.resize(b * free_count_, b * free_count_);
  int* outer = matrix_.outerIndexPtr();
  outer[0] = 0;
  for (Index c = 0; c < free_count_; ++c) {
    for (Index i = 0; i < b; ++i) {
      outer[b * c + i + 1] = outer[b * c + i] + (b - i) + b * unique_count[c];
    }
  }
  matrix_.resizeNonZeros(outer[b * free_count_]);
  int* inner = matrix_.innerIndexPtr();
  for (Index c = 0; c < free_count_; ++c) {
    for (Index i = 0; i < b; ++i) {
      for (Index r = i; r < b; ++r) *inner++ = b * c + r;
      for (Index s = start[c]; s < start[c] + unique_count[c]; ++s) {
        for (Index r = 0; r < b; ++r) *inner++ = b * rows[s] + r;
      }
    }
  }
  set_zero();
}

void MeshMatrix::set_zero() {
  std::fill(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros(), 0.0);
}

}  // namespace beltrami
