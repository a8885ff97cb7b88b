// Views of the caller's arrays: Span knows the type of an item, Reals and Indices only how many
// numbers of which kind an item has. None of them owns, copies or writes what it shows.
#ifndef BELTRAMI_CPP_SPAN_HPP
#define BELTRAMI_CPP_SPAN_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>
#if __has_include(<version>)
#include <version>
#endif
#ifdef __cpp_lib_span
#include <span>
#endif

BELTRAMI_CPP_BEGIN

/// What an item of a buffer is made of: `Scalar`, and `kWidth` of them, one after another.
template <class T, std::size_t N>
struct ItemOf {
  using Scalar = T;
  static constexpr std::size_t kWidth = N;
};

/// Numbers, arrays of numbers and std::array are items. Types of others are not guessed at: say it,
/// as in `template <> struct beltrami::ItemTraits<glm::vec3> : beltrami::ItemOf<float, 3> {};`
template <class Item>
struct ItemTraits : ItemOf<Item, 1> {
  static_assert(std::is_arithmetic_v<Item>, "specialise beltrami::ItemTraits for this type");
};
template <class T, std::size_t N>
struct ItemTraits<T[N]> : ItemOf<T, N> {};
template <class T, std::size_t N>
struct ItemTraits<std::array<T, N>> : ItemOf<T, N> {};

/// `size()` items in memory of the caller, `stride()` bytes from one to the next.
template <class T>
class Span {
 public:
  using Item = T;
  using Byte = std::conditional_t<std::is_const_v<T>, const unsigned char, unsigned char>;

  constexpr Span() = default;
  /// A stride of 0 says that items lie next to each other.
  constexpr Span(T* data, std::size_t size, std::size_t stride = sizeof(T))
      : data_(data), size_(size), stride_(stride == 0 ? sizeof(T) : stride) {}

  /// Of what may be written, a view that only reads.
  template <class U, class = std::enable_if_t<std::is_same_v<const U, T>>>
  constexpr Span(Span<U> items)  // NOLINT(google-explicit-constructor)
      : data_(items.data()), size_(items.size()), stride_(items.stride()) {}

  constexpr T* data() const { return data_; }
  constexpr std::size_t size() const { return size_; }
  constexpr std::size_t stride() const { return stride_; }
  constexpr bool empty() const { return size_ == 0; }
  constexpr bool packed() const { return stride_ == sizeof(T); }
  /// Item `i`, less than size(), which must lie where a T may; the library itself reads any
  /// address.
  T& operator[](std::size_t i) const {
    // Bytes are stepped over, since a stride need not be a multiple of the item's size.
    return *reinterpret_cast<T*>(reinterpret_cast<Byte*>(data_) + i * stride_);
  }

 private:
  T* data_ = nullptr;
  std::size_t size_ = 0;
  std::size_t stride_ = sizeof(T);
};

/// The Span of a container. Only containers whose items are known to follow each other are taken:
/// a matrix has data() and size() as well, but may be stored by columns.
template <class T, class Allocator>
Span<T> span_of(std::vector<T, Allocator>& items) {
  static_assert(!std::is_same_v<T, bool>, "vectors of bool have no array");
  return {items.data(), items.size()};
}
template <class T, class Allocator>
Span<const T> span_of(const std::vector<T, Allocator>& items) {
  static_assert(!std::is_same_v<T, bool>, "vectors of bool have no array");
  return {items.data(), items.size()};
}
template <class T, std::size_t N>
constexpr Span<T> span_of(std::array<T, N>& items) {
  return {items.data(), N};
}
template <class T, std::size_t N>
constexpr Span<const T> span_of(const std::array<T, N>& items) {
  return {items.data(), N};
}
template <class T, std::size_t N>
constexpr Span<T> span_of(T (&items)[N]) {
  return {items, N};
}
template <class T>
constexpr Span<T> span_of(Span<T> items) {
  return items;
}
#ifdef __cpp_lib_span
template <class T, std::size_t N>
constexpr Span<T> span_of(std::span<T, N> items) {
  return {items.data(), items.size()};
}
#endif
// What the view of a temporary would show is gone at the end of the line.
template <class T, class Allocator>
Span<const T> span_of(const std::vector<T, Allocator>&&) = delete;
template <class T, std::size_t N>
Span<const T> span_of(const std::array<T, N>&&) = delete;
template <class T, std::size_t N>
Span<const T> span_of(const T (&&)[N]) = delete;

/// One member of every struct of a container: `span_of(vertices, &Vertex::position)`.
template <class Container, class Struct, class Member>
auto span_of(Container& structs, Member Struct::*member) {
  const auto whole = span_of(structs);
  using Kept = std::remove_reference_t<decltype(whole[0].*member)>;
  return whole.empty() ? Span<Kept>()
                       : Span<Kept>(&(whole[0].*member), whole.size(), whole.stride());
}

namespace detail {

template <class Scalar>
constexpr std::int32_t scalar_type() {
  if constexpr (std::is_same_v<Scalar, float>) return BELTRAMI_F32;
  if constexpr (std::is_same_v<Scalar, double>) return BELTRAMI_F64;
  if constexpr (std::is_same_v<Scalar, std::uint16_t>) return BELTRAMI_U16;
  if constexpr (std::is_integral_v<Scalar> && sizeof(Scalar) == 4) return BELTRAMI_U32;
  if constexpr (std::is_integral_v<Scalar> && sizeof(Scalar) == 8) return BELTRAMI_U64;
  return -1;
}

constexpr bool is_real(std::int32_t type) {
  return type == BELTRAMI_F32 || type == BELTRAMI_F64;
}
constexpr bool is_index(std::int32_t type) {
  return type == BELTRAMI_U16 || type == BELTRAMI_U32 || type == BELTRAMI_U64;
}

template <class T>
using TraitsOf = ItemTraits<std::remove_cv_t<T>>;

/// The type of the numbers that a Span shows.
template <class View>
constexpr std::int32_t type_in() {
  if constexpr (std::is_void_v<View>) {
    return -1;  // of an overload that is deleted
  } else {
    return scalar_type<typename TraitsOf<typename View::Item>::Scalar>();
  }
}

}  // namespace detail

/// Items of N numbers of one kind, as the C interface takes them. Comes from a Span, or from what
/// span_of takes, of items of N numbers, or of single numbers that follow each other, N to an item.
template <std::size_t N>
class Items {
 public:
  std::size_t size() const { return size_; }
  /// The buffer of C. Its data are NULL where there are none.
  const beltrami_buffer& buffer() const { return buffer_; }
  /// Why the caller's array cannot be such items, or nullptr.
  const char* defect() const { return defect_; }

 protected:
  Items() = default;

  template <class T>
  explicit Items(Span<T> items) {
    using Traits = detail::TraitsOf<T>;
    constexpr std::size_t kWidth = Traits::kWidth;
    static_assert(kWidth == N || kWidth == 1, "an item has another number of components");
    static_assert(sizeof(T) >= kWidth * sizeof(typename Traits::Scalar), "ItemTraits are wrong");
    buffer_.data = items.data();
    buffer_.type = detail::scalar_type<typename Traits::Scalar>();
    size_ = items.size();
    buffer_.stride = items.stride();
    if constexpr (kWidth != N) {  // flat
      size_ /= N;
      buffer_.stride = N * sizeof(T);
      if (!items.packed()) defect_ = "numbers with a stride are no items of several numbers";
      if (items.size() % N != 0)
        defect_ = "the numbers of a flat array are no multiple of an item's";
    }
  }

 private:
  beltrami_buffer buffer_{};
  std::size_t size_ = 0;
  const char* defect_ = nullptr;
};

/// Items of N floats or doubles: positions (3), UVs (2), factors (1).
template <std::size_t N>
class Reals : public Items<N> {
 public:
  Reals() = default;
  template <class Container, class View = decltype(span_of(std::declval<Container>())),
            class = std::enable_if_t<detail::is_real(detail::type_in<View>())>>
  Reals(Container&& items)  // NOLINT(google-explicit-constructor)
      : Items<N>(View(span_of(static_cast<Container&&>(items)))) {}
};

/// Items of N indices or numbers, 32 or 64 bits wide, signed or not: triangles (3), edges (2),
/// labels (1). Negative ones are read as those of the same bits, which are out of any range.
template <std::size_t N>
class Indices : public Items<N> {
 public:
  Indices() = default;
  template <class Container, class View = decltype(span_of(std::declval<Container>())),
            class = std::enable_if_t<detail::is_index(detail::type_in<View>())>>
  Indices(Container&& items)  // NOLINT(google-explicit-constructor)
      : Items<N>(View(span_of(static_cast<Container&&>(items)))) {}
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_SPAN_HPP
