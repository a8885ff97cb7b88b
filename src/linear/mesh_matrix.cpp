#include "linear/mesh_matrix.h"

#include <algorithm>

#include "base/bucket_sort.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 1024;

}  // namespace

MeshMatrix::MeshMatrix(Index vertex_count, const std::vector<Triangle>& faces,
                       const std::vector<bool>& fixed, int block_size, const Work& work)
    : block_size_(block_size), chunks_(vertex_count, faces, work), row_(vertex_count, kNone) {
  for (Index v = 0; v < vertex_count; ++v) {
    if (!fixed[v]) row_[v] = free_count_++;
  }
  // Rows below the diagonal of each block column, with repeats: an interior edge occurs twice.
  std::vector<Index> start;
  const auto for_each_edge = [&](std::int64_t f, auto&& visit) {
    for (int k = 0; k < 3; ++k) {
      const Index a = row_[faces[f][k]], b = row_[faces[f][next_corner(k)]];
      if (a != kNone && b != kNone) visit(k, std::min(a, b), std::max(a, b));
    }
  };
  const Index face_count = size_of(faces);
  BucketSort<Index> sort(work, face_count, free_count_, start,
                         [&](std::int64_t f, const auto& count) {
                           for_each_edge(f, [&](int, Index column, Index) { count(column); });
                         });
  std::vector<Index> rows;
  parallel_assign(work, rows, static_cast<std::size_t>(start.back()));
  sort.place([&](std::int64_t f, const auto& place) {
    for_each_edge(f, [&](int, Index column, Index row) { rows[place(column)] = row; });
  });
  std::vector<Index> unique_count(free_count_);
  parallel_for(work, free_count_, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) {
      const auto first = rows.begin() + start[c], last = rows.begin() + start[c + 1];
      std::sort(first, last);
      unique_count[c] = static_cast<Index>(std::unique(first, last) - first);
    }
  });
  parallel_assign(work, slot_, faces.size());
  parallel_for(work, face_count, kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      slot_[f] = {kNone, kNone, kNone};
      for_each_edge(f, [&](int k, Index column, Index row) {
        const auto first = rows.begin() + start[column];
        const auto found = std::lower_bound(first, first + unique_count[column], row);
        slot_[f][k] = static_cast<Index>(found - first);
      });
    }
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
  parallel_for(work, free_count_, kGrain, [&](std::int64_t begin, std::int64_t end) {
    int* inner = matrix_.innerIndexPtr() + outer[b * begin];
    for (auto c = static_cast<Index>(begin); c < end; ++c) {
      for (Index i = 0; i < b; ++i) {
        for (Index r = i; r < b; ++r) *inner++ = b * c + r;
        for (Index s = start[c]; s < start[c] + unique_count[c]; ++s) {
          for (Index r = 0; r < b; ++r) *inner++ = b * rows[s] + r;
        }
      }
    }
  });
  set_zero(work);
}

void MeshMatrix::set_zero(const Work& work) {
  parallel_for(work, matrix_.nonZeros(), 8 * kGrain, [&](std::int64_t begin, std::int64_t end) {
    std::fill(matrix_.valuePtr() + begin, matrix_.valuePtr() + end, 0.0);
  });
}

}  // namespace beltrami
