// What GCC and Clang can be told and other compilers cannot: with those the results are the same,
// and come later.
#pragma once

#if defined(__GNUC__) || defined(__clang__)
/// What is inlined into a function for wider vectors is compiled for wider vectors.
#define BELTRAMI_INLINE [[gnu::always_inline]] inline
#define BELTRAMI_PRAGMA(words) _Pragma(#words)
/// Before a loop of at most so many turns, whose variables are to stay in registers.
#define BELTRAMI_UNROLL(turns) BELTRAMI_PRAGMA(GCC unroll turns)
#else
#define BELTRAMI_INLINE inline
#define BELTRAMI_UNROLL(turns)
#endif

/// Whether functions may be compiled for AVX2 beside those for every processor, to be chosen from
/// as the program runs.
#if (defined(__GNUC__) || defined(__clang__)) && defined(__x86_64__)
#define BELTRAMI_DISPATCH_AVX2 1
#define BELTRAMI_FOR_AVX2 [[gnu::target("avx2")]]
/// The population count that nearly every processor has, and the base of x86-64 has not.
#define BELTRAMI_FOR_POPCNT [[gnu::target("popcnt")]]
#else
#define BELTRAMI_DISPATCH_AVX2 0
#define BELTRAMI_FOR_AVX2
#define BELTRAMI_FOR_POPCNT
#endif

namespace beltrami {

#if defined(__GNUC__) || defined(__clang__)

namespace internal {
template <class T, int kCount>
struct RegisterOf {
  using Type [[gnu::vector_size(kCount * sizeof(T))]] = T;
};
}  // namespace internal

/// `kCount` numbers in one register: operators go number by number.
template <class T, int kCount>
using Register = typename internal::RegisterOf<T, kCount>::Type;

#else

template <class T, int kCount>
struct Register {
  T numbers[kCount];

  T& operator[](int k) { return numbers[k]; }
  T operator[](int k) const { return numbers[k]; }

#define BELTRAMI_ASSIGNING(op)                                       \
  Register& operator op(const Register& other) {                     \
    for (int k = 0; k < kCount; ++k) numbers[k] op other.numbers[k]; \
    return *this;                                                    \
  }                                                                  \
  Register& operator op(T other) {                                   \
    for (int k = 0; k < kCount; ++k) numbers[k] op other;            \
    return *this;                                                    \
  }
  BELTRAMI_ASSIGNING(+=)
  BELTRAMI_ASSIGNING(-=)
  BELTRAMI_ASSIGNING(*=)
  BELTRAMI_ASSIGNING(/=)
  BELTRAMI_ASSIGNING(|=)
  BELTRAMI_ASSIGNING(&=)
  BELTRAMI_ASSIGNING(>>=)
  BELTRAMI_ASSIGNING(<<=)
#undef BELTRAMI_ASSIGNING

  friend Register operator*(Register a, const Register& b) {
    return a *= b;
  }
  friend Register operator*(Register a, T b) {
    return a *= b;
  }
  friend Register operator|(Register a, const Register& b) {
    return a |= b;
  }
  friend Register operator>>(Register a, int by) {
    return a >>= static_cast<T>(by);
  }
  friend Register operator<<(Register a, int by) {
    return a <<= static_cast<T>(by);
  }
  friend Register operator~(Register a) {
    for (T& number : a.numbers) number = ~number;
    return a;
  }
};

#endif

/// Gives a register the same number throughout.
template <class T, class R>
BELTRAMI_INLINE void fill(T number, R& all) {
  for (unsigned k = 0; k < sizeof(R) / sizeof(T); ++k) all[k] = number;
}

}  // namespace beltrami
