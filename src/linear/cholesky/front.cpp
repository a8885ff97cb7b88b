#include "linear/cholesky/front.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/compiler.h"

namespace beltrami::front {
namespace {

constexpr int kInnerBlock = 16;  // columns that are eliminated one by one
constexpr int kRowBlock = 128;   // rows of a packed operand that stay in the second cache

/// `kLanes` numbers in one register.
template <class T, int kLanes>
struct Vector {
  Register<T, kLanes> v;

  BELTRAMI_INLINE static Vector load(const T* p) {
    Vector r;
    std::memcpy(&r.v, p, sizeof r.v);
    return r;
  }
  BELTRAMI_INLINE void store(T* p) const { std::memcpy(p, &v, sizeof v); }
  BELTRAMI_INLINE void subtract_product(const Vector& a, T b) { v -= a.v * b; }
};

/// A tile of C -= A B^T: kGroup rows by `kColumns` columns, A and B packed with `depth` columns.
template <class T, int kLanes>
struct Tile {
  static constexpr int kVectors = kGroup / kLanes;
  static constexpr int kColumns = kLanes;  // eight accumulators, half of the registers
  using V = Vector<T, kLanes>;

  BELTRAMI_INLINE static void run(const T* a, const T* b, int depth, T* c, std::int64_t stride) {
    V sum[kColumns][kVectors];
    BELTRAMI_UNROLL(8)
    for (int j = 0; j < kColumns; ++j) {
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) sum[j][v] = V::load(c + j * stride + v * kLanes);
    }
    for (int p = 0; p < depth; ++p) {
      V row[kVectors];
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) row[v] = V::load(a + p * kGroup + v * kLanes);
      BELTRAMI_UNROLL(8)
      for (int j = 0; j < kColumns; ++j) {
        const T factor = b[p * kGroup + j];
        BELTRAMI_UNROLL(8)
        for (int v = 0; v < kVectors; ++v) sum[j][v].subtract_product(row[v], factor);
      }
    }
    BELTRAMI_UNROLL(8)
    for (int j = 0; j < kColumns; ++j) {
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) sum[j][v].store(c + j * stride + v * kLanes);
    }
  }

  /// The same where C ends before the tile does.
  BELTRAMI_INLINE static void run_clipped(const T* a, const T* b, int depth, T* c,
                                          std::int64_t stride, int rows, int columns) {
    T whole[kColumns * kGroup] = {};
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < rows; ++i) whole[j * kGroup + i] = c[j * stride + i];
    }
    run(a, b, depth, whole, kGroup);
    for (int j = 0; j < columns; ++j) {
      for (int i = 0; i < rows; ++i) c[j * stride + i] = whole[j * kGroup + i];
    }
  }
};

/// The target of an update: the lower triangle of rows and columns [first, ...) of the packed
/// operand, down to `rows_end`, in columns [first, columns_end).
template <class T>
struct Target {
  T* values;  // of row and column `first`
  std::int64_t stride;
  int first, columns_end, rows_end;
};

/// Target -= P P^T for the groups [group_begin, group_end) of its rows; P is packed.
template <class T, int kLanes>
BELTRAMI_INLINE void update_rows(const T* packed, int depth, const Target<T>& target,
                                 int group_begin, int group_end) {
  using Kernel = Tile<T, kLanes>;
  const std::int64_t group_size = static_cast<std::int64_t>(kGroup) * depth;
  for (int block = group_begin; block < group_end; block += kRowBlock / kGroup) {
    const int block_end = std::min(block + kRowBlock / kGroup, group_end);
    const int last = std::min(target.columns_end, block_end * kGroup);
    for (int j = target.first; j < last; j += Kernel::kColumns) {
      const T* b = packed + j / kGroup * group_size + j % kGroup;
      const int columns = std::min(Kernel::kColumns, target.columns_end - j);
      for (int g = std::max(block, j / kGroup); g < block_end; ++g) {
        T* c = target.values + (j - target.first) * target.stride + (g * kGroup - target.first);
        const int rows = std::min(kGroup, target.rows_end - g * kGroup);
        if (rows == kGroup && columns == Kernel::kColumns) {
          Kernel::run(packed + g * group_size, b, depth, c, target.stride);
        } else {
          Kernel::run_clipped(packed + g * group_size, b, depth, c, target.stride, rows, columns);
        }
      }
    }
  }
}

/// Cholesky of the diagonal block, in place; 1 / diagonal goes to `inverse`, and the block, rows
/// contiguous, to `rows`.
template <class T>
BELTRAMI_INLINE bool factor_block(T* block, std::int64_t stride, int size, T* inverse, T* rows) {
  alignas(64) T l[kInnerBlock * kInnerBlock];  // columns contiguous
  for (int j = 0; j < size; ++j) {
    for (int i = j; i < size; ++i) l[j * kInnerBlock + i] = block[j * stride + i];
  }
  for (int j = 0; j < size; ++j) {
    T* column = l + j * kInnerBlock;
    if (!(column[j] > 0) || !std::isfinite(column[j])) return false;
    column[j] = std::sqrt(column[j]);
    inverse[j] = 1 / column[j];
    for (int i = j + 1; i < size; ++i) column[i] *= inverse[j];
    for (int k = j + 1; k < size; ++k) {
      const T factor = column[k];
      T* target = l + k * kInnerBlock;
      for (int i = k; i < size; ++i) target[i] -= column[i] * factor;
    }
  }
  for (int j = 0; j < size; ++j) {
    for (int i = j; i < size; ++i) {
      block[j * stride + i] = rows[i * kInnerBlock + j] = l[j * kInnerBlock + i];
    }
  }
  return true;
}

/// X = C L^-T for one group of rows of C, in place and packed; `loaded` of them exist.
template <class T, int kLanes, int kGroups>
BELTRAMI_INLINE void solve_groups(T* c, std::int64_t stride, int loaded, int size, const T* rows,
                                  const T* inverse, T* packed, std::int64_t group_stride) {
  constexpr int kVectors = kGroup / kLanes * kGroups;
  using V = Vector<T, kLanes>;
  alignas(64) T partial[kGroup * kGroups];
  const bool clipped = loaded < kGroup * kGroups;
  const auto at = [&](int p, int v) {
    return packed + (v * kLanes / kGroup) * group_stride + p * kGroup + v * kLanes % kGroup;
  };
  for (int j = 0; j < size; ++j) {
    const T* source = c + j * stride;
    if (clipped) {
      for (int i = 0; i < kGroup * kGroups; ++i) partial[i] = i < loaded ? source[i] : 0;
      source = partial;
    }
    V x[kVectors];
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) x[v] = V::load(source + v * kLanes);
    for (int p = 0; p < j; ++p) {
      const T factor = rows[j * kInnerBlock + p];
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) x[v].subtract_product(V::load(at(p, v)), factor);
    }
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) {
      x[v].v *= inverse[j];
      x[v].store(at(j, v));
    }
    if (clipped) {
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) x[v].store(partial + v * kLanes);
      for (int i = 0; i < loaded; ++i) c[j * stride + i] = partial[i];
    } else {
      BELTRAMI_UNROLL(8)
      for (int v = 0; v < kVectors; ++v) x[v].store(c + j * stride + v * kLanes);
    }
  }
}

/// Copies columns of a panel into packed groups, with zeros after the last row.
template <class T>
BELTRAMI_INLINE void pack(const T* source, std::int64_t stride, int rows, int depth, T* packed) {
  for (int g = 0; g < rows; g += kGroup) {
    const int count = std::min(kGroup, rows - g);
    for (int p = 0; p < depth; ++p, packed += kGroup) {
      const T* from = source + p * stride + g;
      if (count == kGroup) {
        std::memcpy(packed, from, kGroup * sizeof(T));
      } else {
        for (int i = 0; i < kGroup; ++i) packed[i] = i < count ? from[i] : 0;
      }
    }
  }
}

template <class T>
struct Kernels {
  bool (*eliminate)(T* panel, std::int64_t height, int begin, int end, T* buffer);
  void (*update)(const T* packed, int depth, const Target<T>& target, int begin, int end);
  void (*forward)(const T* panel, int height, int width, T* x, int columns);
  void (*backward)(const T* panel, int height, int width, T* x, int columns);
  void (*forward_rows)(const T* panel, int height, int width, T* const* rows, int columns);
  void (*backward_rows)(const T* panel, int height, int width, T* const* rows, int columns);
};

/// Eliminates the columns [begin, end) of a panel that is up to date there. If they are one inner
/// block, `buffer` holds the rows below, packed.
template <class T, int kLanes>
BELTRAMI_INLINE bool eliminate(T* panel, std::int64_t height, int begin, int end, T* buffer) {
  T inverse[kInnerBlock];
  alignas(64) T rows[kInnerBlock * kInnerBlock];
  // The first block is the odd one, so that the others end on whole groups.
  int size = (end - begin) % kInnerBlock;
  if (size == 0) size = kInnerBlock;
  for (int j = begin; j < end; j += size, size = kInnerBlock) {
    T* block = panel + j * height + j;
    if (!factor_block(block, height, size, inverse, rows)) return false;
    const int below = static_cast<int>(height) - (j + size);
    const std::int64_t group_stride = static_cast<std::int64_t>(kGroup) * size;
    T* packed = buffer;
    int i = 0;
    for (; i + 2 * kGroup <= below; i += 2 * kGroup, packed += 2 * group_stride) {
      solve_groups<T, kLanes, 2>(block + size + i, height, 2 * kGroup, size, rows, inverse, packed,
                                 group_stride);
    }
    for (; i < below; i += kGroup, packed += group_stride) {
      solve_groups<T, kLanes, 1>(block + size + i, height, std::min(kGroup, below - i), size, rows,
                                 inverse, packed, group_stride);
    }
    if (j + size == end) break;
    const Target<T> rest = {block + size * height + size, height, 0, end - (j + size), below};
    update_rows<T, kLanes>(buffer, size, rest, 0, padded(below) / kGroup);
  }
  return true;
}

/// kSides right-hand sides at once; columns of the panel in pairs, so that the vectors pass through
/// the registers half as often.
template <class T, int kLanes, int kSides>
BELTRAMI_INLINE void forward(const T* panel, int height, int width, T* x) {
  using V = Vector<T, kLanes>;
  constexpr int kUnroll = 4;
  for (int j = 0; j < width;) {
    const int count = std::min(kUnroll, width - j);
    const T* column[kUnroll];
    T factor[kSides][kUnroll];
    for (int q = 0; q < count; ++q) column[q] = panel + static_cast<std::int64_t>(j + q) * height;
    for (int s = 0; s < kSides; ++s) {
      T* y = x + static_cast<std::int64_t>(s) * height;
      for (int q = 0; q < count; ++q) {
        T value = y[j + q];
        for (int p = 0; p < q; ++p) value -= column[p][j + q] * factor[s][p];
        factor[s][q] = y[j + q] = value / column[q][j + q];
      }
    }
    int i = j + count;
    if (count == kUnroll) {
      for (; i + kLanes <= height; i += kLanes) {
        V l[kUnroll];
        BELTRAMI_UNROLL(4)
        for (int q = 0; q < kUnroll; ++q) l[q] = V::load(column[q] + i);
        BELTRAMI_UNROLL(4)
        for (int s = 0; s < kSides; ++s) {
          T* y = x + static_cast<std::int64_t>(s) * height + i;
          V value = V::load(y);
          BELTRAMI_UNROLL(4)
          for (int q = 0; q < kUnroll; ++q) value.subtract_product(l[q], factor[s][q]);
          value.store(y);
        }
      }
      for (; i < height; ++i) {
        for (int s = 0; s < kSides; ++s) {
          T value = x[static_cast<std::int64_t>(s) * height + i];
          for (int q = 0; q < kUnroll; ++q) value -= column[q][i] * factor[s][q];
          x[static_cast<std::int64_t>(s) * height + i] = value;
        }
      }
    } else {
      for (int q = 0; q < count; ++q) {
        for (int s = 0; s < kSides; ++s) {
          T* y = x + static_cast<std::int64_t>(s) * height;
          const T f = factor[s][q];
          for (int r = i; r < height; ++r) y[r] -= column[q][r] * f;
        }
      }
    }
    j += count;
  }
}

/// Inner products run over eight interleaved partial sums, added in a fixed order: the same bits
/// with vectors of any width.
template <class T, int kLanes, int kSides>
BELTRAMI_INLINE void backward(const T* panel, int height, int width, T* x) {
  using V = Vector<T, kLanes>;
  constexpr int kVectors = kGroup / kLanes, kUnroll = 2;
  for (int j = width; j > 0;) {
    const int count = std::min(kUnroll, j);
    j -= count;
    const T* column[kUnroll];
    for (int q = 0; q < count; ++q) column[q] = panel + static_cast<std::int64_t>(j + q) * height;
    for (int q = count; q < kUnroll; ++q) column[q] = column[0];
    const int begin = j + count;
    V sum[kSides][kUnroll][kVectors];
    BELTRAMI_UNROLL(4)
    for (int s = 0; s < kSides; ++s) {
      BELTRAMI_UNROLL(4)
      for (int q = 0; q < kUnroll; ++q) {
        BELTRAMI_UNROLL(8)
        for (int v = 0; v < kVectors; ++v) sum[s][q][v].v = decltype(sum[s][q][v].v){};
      }
    }
    int i = begin;
    for (; i + kGroup <= height; i += kGroup) {
      BELTRAMI_UNROLL(4)
      for (int s = 0; s < kSides; ++s) {
        const T* y = x + static_cast<std::int64_t>(s) * height + i;
        BELTRAMI_UNROLL(8)
        for (int v = 0; v < kVectors; ++v) {
          const V value = V::load(y + v * kLanes);
          BELTRAMI_UNROLL(4)
          for (int q = 0; q < kUnroll; ++q) {
            sum[s][q][v].v += V::load(column[q] + i + v * kLanes).v * value.v;
          }
        }
      }
    }
    for (int s = 0; s < kSides; ++s) {
      T* y = x + static_cast<std::int64_t>(s) * height;
      T total[kUnroll];
      for (int q = 0; q < count; ++q) {
        alignas(64) T part[kGroup];
        BELTRAMI_UNROLL(8)
        for (int v = 0; v < kVectors; ++v) sum[s][q][v].store(part + v * kLanes);
        total[q] = ((part[0] + part[1]) + (part[2] + part[3])) +
                   ((part[4] + part[5]) + (part[6] + part[7]));
        for (int r = i; r < height; ++r) total[q] += column[q][r] * y[r];
      }
      for (int q = count; q-- > 0;) {
        T value = y[j + q] - total[q];
        for (int p = q + 1; p < count; ++p) value -= column[q][j + p] * y[j + p];
        y[j + q] = value / column[q][j + q];
      }
    }
  }
}

template <class T, int kLanes>
BELTRAMI_INLINE void forward_all(const T* panel, int height, int width, T* x, int columns) {
  int c = 0;
  for (; c + 2 <= columns; c += 2) {
    forward<T, kLanes, 2>(panel, height, width, x + static_cast<std::int64_t>(c) * height);
  }
  if (c < columns) {
    forward<T, kLanes, 1>(panel, height, width, x + static_cast<std::int64_t>(c) * height);
  }
}

template <class T, int kLanes>
BELTRAMI_INLINE void backward_all(const T* panel, int height, int width, T* x, int columns) {
  int c = 0;
  for (; c + 2 <= columns; c += 2) {
    backward<T, kLanes, 2>(panel, height, width, x + static_cast<std::int64_t>(c) * height);
  }
  if (c < columns) {
    backward<T, kLanes, 1>(panel, height, width, x + static_cast<std::int64_t>(c) * height);
  }
}

/// Entries of one row that lie side by side.
template <class T, int kLanes, int kColumns>
struct Row {
  static constexpr int kWidth = kLanes < kColumns ? kLanes : kColumns;
  static constexpr int kVectors = kColumns / kWidth;
  Vector<T, kWidth> part[kVectors];

  BELTRAMI_INLINE explicit Row(const T* from) {
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) part[v] = Vector<T, kWidth>::load(from + v * kWidth);
  }
  BELTRAMI_INLINE void store(T* to) const {
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) part[v].store(to + v * kWidth);
  }
  BELTRAMI_INLINE void subtract_product(const Row& row, T factor) {
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) part[v].subtract_product(row.part[v], factor);
  }
  BELTRAMI_INLINE void divide(T by) {
    BELTRAMI_UNROLL(8)
    for (int v = 0; v < kVectors; ++v) part[v].v /= by;
  }
};

template <class T, int kLanes, int kColumns>
BELTRAMI_INLINE void forward_rows(const T* panel, int height, int width, T* const* rows) {
  using Entries = Row<T, kLanes, kColumns>;
  for (int j = 0; j < width; ++j, panel += height) {
    Entries source(rows[j]);
    source.divide(panel[j]);
    source.store(rows[j]);
    for (int i = j + 1; i < height; ++i) {
      Entries target(rows[i]);
      target.subtract_product(source, panel[i]);
      target.store(rows[i]);
    }
  }
}

template <class T, int kLanes, int kColumns>
BELTRAMI_INLINE void backward_rows(const T* panel, int height, int width, T* const* rows) {
  using Entries = Row<T, kLanes, kColumns>;
  for (int j = width; j-- > 0;) {
    const T* column = panel + static_cast<std::int64_t>(j) * height;
    Entries sum(rows[j]);
    for (int i = j + 1; i < height; ++i) sum.subtract_product(Entries(rows[i]), column[i]);
    sum.divide(column[j]);
    sum.store(rows[j]);
  }
}

template <class T, int kLanes>
BELTRAMI_INLINE void forward_rows(const T* panel, int height, int width, T* const* rows,
                                  int columns) {
  if (columns == 4) return forward_rows<T, kLanes, 4>(panel, height, width, rows);
  if (columns == 8) return forward_rows<T, kLanes, 8>(panel, height, width, rows);
  forward_rows<T, kLanes, 16>(panel, height, width, rows);
}

template <class T, int kLanes>
BELTRAMI_INLINE void backward_rows(const T* panel, int height, int width, T* const* rows,
                                   int columns) {
  if (columns == 4) return backward_rows<T, kLanes, 4>(panel, height, width, rows);
  if (columns == 8) return backward_rows<T, kLanes, 8>(panel, height, width, rows);
  backward_rows<T, kLanes, 16>(panel, height, width, rows);
}

// The bodies above for one width of vectors: NAME and what the compiler may use.
// NOLINTBEGIN(bugprone-macro-parentheses): an attribute cannot be put in parentheses
#define BELTRAMI_KERNELS(NAME, TARGET, BYTES)                                                     \
  template <class T>                                                                              \
  struct NAME {                                                                                   \
    static constexpr int kLanes = (BYTES) / static_cast<int>(sizeof(T));                          \
    TARGET static bool run_eliminate(T* panel, std::int64_t height, int begin, int end,           \
                                     T* buffer) {                                                 \
      return eliminate<T, kLanes>(panel, height, begin, end, buffer);                             \
    }                                                                                             \
    TARGET static void run_update(const T* packed, int depth, const Target<T>& target, int begin, \
                                  int end) {                                                      \
      update_rows<T, kLanes>(packed, depth, target, begin, end);                                  \
    }                                                                                             \
    TARGET static void run_forward(const T* panel, int height, int width, T* x, int columns) {    \
      forward_all<T, kLanes>(panel, height, width, x, columns);                                   \
    }                                                                                             \
    TARGET static void run_backward(const T* panel, int height, int width, T* x, int columns) {   \
      backward_all<T, kLanes>(panel, height, width, x, columns);                                  \
    }                                                                                             \
    TARGET static void run_forward_rows(const T* panel, int height, int width, T* const* rows,    \
                                        int columns) {                                            \
      forward_rows<T, kLanes>(panel, height, width, rows, columns);                               \
    }                                                                                             \
    TARGET static void run_backward_rows(const T* panel, int height, int width, T* const* rows,   \
                                         int columns) {                                           \
      backward_rows<T, kLanes>(panel, height, width, rows, columns);                              \
    }                                                                                             \
    static constexpr Kernels<T> kAll = {run_eliminate, run_update,       run_forward,             \
                                        run_backward,  run_forward_rows, run_backward_rows};      \
  };

// NOLINTEND(bugprone-macro-parentheses)
BELTRAMI_KERNELS(Baseline, , 16)
#if BELTRAMI_DISPATCH_AVX2
BELTRAMI_KERNELS(Avx2, BELTRAMI_FOR_AVX2, 32)
#endif

template <class T>
const Kernels<T>& kernels([[maybe_unused]] Vectors vectors) {
#if BELTRAMI_DISPATCH_AVX2
  if (vectors == Vectors::kAvx2) return Avx2<T>::kAll;
#endif
  return Baseline<T>::kAll;
}

}  // namespace

template <class T>
bool factorize(Vectors vectors, T* panel, int height, int width, T* update, T* buffer,
               const ForChunks& for_chunks) {
  const Kernels<T>& kernel = kernels<T>(vectors);
  const auto apply = [&](int depth, const Target<T>& target) {
    const int first = target.first / kGroup, last = padded(target.rows_end) / kGroup;
    if (!for_chunks) {
      kernel.update(buffer, depth, target, first, last);
      return;
    }
    // Rows further down are longer: chunks of one block of rows balance by themselves.
    constexpr int kLeast = 32 / kGroup, kMost = kRowBlock / kGroup, kChunks = 16;
    const int block = std::clamp((last - first) / kChunks, kLeast, kMost);
    for_chunks((last - first + block - 1) / block, [&](int begin, int end) {
      kernel.update(buffer, depth, target, first + begin * block,
                    std::min(first + end * block, last));
    });
  };
  // The first block is the odd one: the rest starts on whole groups for every block.
  int size = width % kOuterBlock;
  if (size == 0) size = std::min(width, kOuterBlock);
  for (int j = 0; j < width; j += size, size = kOuterBlock) {
    if (!kernel.eliminate(panel, height, j, j + size, buffer)) return false;
    const int below = height - (j + size), columns = width - (j + size);
    if (below == 0) break;
    if (size > kInnerBlock) {
      pack(panel + static_cast<std::int64_t>(j) * height + (j + size), height, below, size, buffer);
    }
    if (columns > 0) {
      apply(size, {panel + static_cast<std::int64_t>(j + size) * height + (j + size), height, 0,
                   columns, below});
    }
    if (below > columns) {
      apply(size,
            {update, padded(below - columns), columns, below, columns + padded(below - columns)});
    }
  }
  return true;
}

template <class T>
void solve_forward(Vectors vectors, const T* panel, int height, int width, T* x, int columns) {
  kernels<T>(vectors).forward(panel, height, width, x, columns);
}

template <class T>
void solve_backward(Vectors vectors, const T* panel, int height, int width, T* x, int columns) {
  kernels<T>(vectors).backward(panel, height, width, x, columns);
}

template <class T>
void solve_forward_side_by_side(Vectors vectors, const T* panel, int height, int width,
                                T* const* rows, int columns) {
  kernels<T>(vectors).forward_rows(panel, height, width, rows, columns);
}

template <class T>
void solve_backward_side_by_side(Vectors vectors, const T* panel, int height, int width,
                                 T* const* rows, int columns) {
  kernels<T>(vectors).backward_rows(panel, height, width, rows, columns);
}

template bool factorize(Vectors, float*, int, int, float*, float*, const ForChunks&);
template bool factorize(Vectors, double*, int, int, double*, double*, const ForChunks&);
template void solve_forward(Vectors, const float*, int, int, float*, int);
template void solve_forward(Vectors, const double*, int, int, double*, int);
template void solve_backward(Vectors, const float*, int, int, float*, int);
template void solve_backward(Vectors, const double*, int, int, double*, int);
template void solve_forward_side_by_side(Vectors, const float*, int, int, float* const*, int);
template void solve_forward_side_by_side(Vectors, const double*, int, int, double* const*, int);
template void solve_backward_side_by_side(Vectors, const float*, int, int, float* const*, int);
template void solve_backward_side_by_side(Vectors, const double*, int, int, double* const*, int);

}  // namespace beltrami::front
