#include "linear/smoother.h"

#include <array>
#include <cstddef>
#include <numeric>

#include "base/parallel.h"

namespace beltrami {
namespace {

/// Calls visit(neighbour, half-edge at that side or kNone, half-edge at the other one or kNone) for
/// the ring of a vertex.
template <class Visit>
void for_each_edge(const Surface& mesh, Index v, const Visit& visit) {
  const Index first = mesh.outgoing[v];
  Index h = first, last = first;
  do {
    visit(mesh.target(h), h, mesh.twin[h]);
    last = h;
    h = mesh.rotate(h);
  } while (h != kNone && h != first);
  if (h == kNone) visit(mesh.origin(Surface::previous(last)), Surface::previous(last), kNone);
}

/// Of the row of a vertex of the block [begin, end), where its neighbour is: 0 and 1 for an earlier
/// and a later one of the block, 2 outside. Without branches, which nobody could predict.
std::size_t part_of(Index neighbour, Index vertex, std::int64_t begin, std::int64_t end) {
  const bool outside = (neighbour < begin) | (neighbour >= end), later = neighbour > vertex;
  return (std::size_t{outside} << 1U) | (std::size_t{later} & std::size_t{!outside});
}

}  // namespace

Smoother::Smoother(const Surface& mesh, const Work& work)
    : work_(work),
      count_(mesh.vertex_count()),
      rows_(work, static_cast<std::size_t>(count_) + 1),
      inverse_diagonal_(work, static_cast<std::size_t>(count_)) {
  std::vector<Index> before(static_cast<std::size_t>(count_ / kBlock) + 2, 0);  // each block
  parallel_for(work, count_, kBlock, [&](std::int64_t begin, std::int64_t end) {
    Index total = 0;
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      std::array<Index, 3> counts{};
      for_each_edge(mesh, v, [&](Index u, Index, Index) { ++counts[part_of(u, v, begin, end)]; });
      rows_[v] = {total, total + counts[0], total + counts[0] + counts[1]};
      total += counts[0] + counts[1] + counts[2];
    }
    before[begin / kBlock + 1] = total;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  const Index total = before.back();
  parallel_for(work, count_, kBlock, [&](std::int64_t begin, std::int64_t end) {
    const Index offset = before[begin / kBlock];
    for (std::int64_t v = begin; v < end; ++v) {
      rows_[v].begin += offset;
      rows_[v].upper += offset;
      rows_[v].outside += offset;
    }
  });
  rows_[count_].begin = total;
  column_ = Scratch<Index>(work, static_cast<std::size_t>(total));
  weight_ = Scratch<float>(work, static_cast<std::size_t>(total));
}

void Smoother::set(const Surface& mesh, const std::vector<SingleWeights>& weights,
                   const std::vector<float>& springs) {
  const auto weight_of = [&](Index h) {
    return h == kNone ? 0.0F : weights[h / 3][previous_corner(h % 3)];
  };
  parallel_for(work_, mesh.vertex_count(), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      const Row& row = rows_[v];
      std::array<Index, 3> next = {row.begin, row.upper, row.outside};
      for_each_edge(mesh, v, [&](Index u, Index h, Index other) {
        const Index at = next[part_of(u, v, begin, end)]++;
        column_[at] = u;
        weight_[at] = weight_of(h) + weight_of(other);
      });
    }
  });
  set_springs(springs);
}

float Smoother::stiffness(Index vertex) const {
  float sum = 0;
  for (Index i = rows_[vertex].begin; i < rows_[vertex + 1].begin; ++i) sum += weight_[i];
  return sum;
}

void Smoother::set_springs(const std::vector<float>& springs) {
  springs_ = springs;
  parallel_for(work_, count_, kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      const float diagonal = stiffness(v) + (springs_.empty() ? 0 : springs_[v]);
      inverse_diagonal_[v] = diagonal > 0 ? 1 / diagonal : 0;
    }
  });
}

void Smoother::multiply(const SingleField& x, SingleField& product) const {
  product.resize(x.size());
  parallel_for(work_, size_of(x), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      const Eigen::Vector2f& here = x[v];
      Eigen::Vector2f sum(0, 0);
      for (Index i = rows_[v].begin; i < rows_[v + 1].begin; ++i) {
        sum += weight_[i] * (here - x[column_[i]]);
      }
      if (!springs_.empty()) sum += springs_[v] * here;
      product[v] = sum;
    }
  });
}

template <class Rhs>
void Smoother::sweep_forward(const std::vector<Rhs>& rhs, SingleField& x) const {
  x.resize(rhs.size());
  parallel_for(work_, size_of(rhs), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      Eigen::Vector2f sum = rhs[v].template cast<float>();
      for (Index i = rows_[v].begin; i < rows_[v].upper; ++i) sum += weight_[i] * x[column_[i]];
      x[v] = inverse_diagonal_[v] * sum;
    }
  });
}

void Smoother::residual_after_forward(const SingleField& x, SingleField& residual) const {
  residual.resize(x.size());
  parallel_for(work_, size_of(x), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      Eigen::Vector2f sum(0, 0);
      for (Index i = rows_[v].upper; i < rows_[v + 1].begin; ++i) sum += weight_[i] * x[column_[i]];
      residual[v] = sum;
    }
  });
}

template <class Rhs>
void Smoother::sweep_backward(const std::vector<Rhs>& rhs, SingleField& x,
                              SingleField& before) const {
  parallel_copy(work_, x, before);
  parallel_for(work_, size_of(x), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = end; v-- > begin;) {
      const Row& row = rows_[v];
      Eigen::Vector2f sum = rhs[v].template cast<float>();
      for (Index i = row.begin; i < row.outside; ++i) sum += weight_[i] * x[column_[i]];
      for (Index i = row.outside; i < rows_[v + 1].begin; ++i) {
        sum += weight_[i] * before[column_[i]];
      }
      x[v] = inverse_diagonal_[v] * sum;
    }
  });
}

template void Smoother::sweep_forward(const std::vector<Vec2>&, SingleField&) const;
template void Smoother::sweep_forward(const SingleField&, SingleField&) const;
template void Smoother::sweep_backward(const std::vector<Vec2>&, SingleField&, SingleField&) const;
template void Smoother::sweep_backward(const SingleField&, SingleField&, SingleField&) const;

}  // namespace beltrami
