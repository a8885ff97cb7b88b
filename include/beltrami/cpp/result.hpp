// Statuses, failures, and how they reach the caller: Result holds them, Error throws them.
#ifndef BELTRAMI_CPP_RESULT_HPP
#define BELTRAMI_CPP_RESULT_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>

#include <cstdint>
#include <exception>
#include <initializer_list>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

BELTRAMI_CPP_BEGIN

namespace detail {

/// A struct of C with its size set.
template <class Struct>
Struct sized() noexcept {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

/// Runs `allocate`, which may throw std::bad_alloc, and says whether it went well.
template <class Allocate>
bool has_room_for(Allocate&& allocate) noexcept {
#if BELTRAMI_CPP_EXCEPTIONS
  try {
    allocate();
  } catch (const std::exception&) {  // std::length_error as well
    return false;
  }
#else
  allocate();
#endif
  return true;
}

}  // namespace detail

/// The BELTRAMI_ statuses. Above 0 there is a result with a reservation, below 0 there is none.
enum class Status : std::int32_t {
  kOk = BELTRAMI_OK,
  kNotConverged = BELTRAMI_NOT_CONVERGED,
  kNotInjective = BELTRAMI_NOT_INJECTIVE,
  kNotInjectiveFloat32 = BELTRAMI_NOT_INJECTIVE_FLOAT32,
  kInvalidArgument = BELTRAMI_E_INVALID_ARGUMENT,
  kOutOfMemory = BELTRAMI_E_OUT_OF_MEMORY,
  kAbiMismatch = BELTRAMI_E_ABI_MISMATCH,
  kUnsupported = BELTRAMI_E_UNSUPPORTED,
  kInvalidState = BELTRAMI_E_INVALID_STATE,
  kCancelled = BELTRAMI_E_CANCELLED,
  kInternal = BELTRAMI_E_INTERNAL,
  kEmpty = BELTRAMI_E_EMPTY,
  kIndexOutOfRange = BELTRAMI_E_INDEX_OUT_OF_RANGE,
  kNonFinite = BELTRAMI_E_NON_FINITE,
  kRepeatedVertex = BELTRAMI_E_REPEATED_VERTEX,
  kNonManifoldEdge = BELTRAMI_E_NON_MANIFOLD_EDGE,
  kNonManifoldVertex = BELTRAMI_E_NON_MANIFOLD_VERTEX,
  kOrientation = BELTRAMI_E_ORIENTATION,
  kComponents = BELTRAMI_E_COMPONENTS,
  kClosed = BELTRAMI_E_CLOSED,
  kBoundaries = BELTRAMI_E_BOUNDARIES,
  kGenus = BELTRAMI_E_GENUS,
  kZeroArea = BELTRAMI_E_ZERO_AREA,
  kPins = BELTRAMI_E_PINS,
  kNoRoom = BELTRAMI_E_NO_ROOM,
  kSolver = BELTRAMI_E_SOLVER
};

/// Its name in C, such as "BELTRAMI_E_CLOSED"; "unknown" for other numbers.
inline const char* name_of(Status status) {
  return beltrami_status_name(static_cast<beltrami_status>(status));
}
/// One sentence on what it means and what to do about it.
inline const char* advice_on(Status status) {
  return beltrami_status_advice(static_cast<beltrami_status>(status));
}

/// What the index of an element counts.
enum class ElementKind : std::int32_t {
  kNone = BELTRAMI_ELEMENT_NONE,
  kFace = BELTRAMI_ELEMENT_FACE,
  kVertex = BELTRAMI_ELEMENT_VERTEX,
  kCorner = BELTRAMI_ELEMENT_CORNER
};

/// Why there is no result. Nothing here throws, copies do not either.
class Failure {
 public:
  explicit Failure(Status status, const char* sentence = "", ElementKind kind = ElementKind::kNone,
                   std::uint64_t element = BELTRAMI_NO_ELEMENT) noexcept
      : status_(status), kind_(kind), element_(element) {
    // Where there is no room for the sentence, the advice on the status is said instead.
    if (*sentence != '\0') {
      detail::has_room_for([&] { sentence_ = std::make_shared<const std::string>(sentence); });
    }
  }
  explicit Failure(beltrami_status status, const char* sentence = "") noexcept
      : Failure(static_cast<Status>(status), sentence) {}

  Status status() const noexcept { return status_; }
  /// What is wrong, and what to do about it; never empty.
  const char* what() const noexcept { return sentence_ ? sentence_->c_str() : advice_on(status_); }
  /// The face, vertex or corner concerned, counted from 0, where there is one.
  std::optional<std::uint64_t> element() const noexcept {
    if (kind_ == ElementKind::kNone || element_ == BELTRAMI_NO_ELEMENT) return std::nullopt;
    return element_;
  }
  ElementKind element_kind() const noexcept { return kind_; }

 private:
  Status status_;
  ElementKind kind_;
  std::uint64_t element_;
  std::shared_ptr<const std::string> sentence_;
};

namespace detail {

/// An INVALID_ARGUMENT whose sentence is in parts.
inline Failure refusal(std::initializer_list<const char*> parts) noexcept {
  std::string sentence;
  has_room_for([&] {
    for (const char* part : parts) sentence += part;
  });
  return Failure(Status::kInvalidArgument, sentence.c_str());
}

/// Whether a result with this status is proven to be injective in the precision asked for.
inline bool is_injective(Status status) noexcept {
  return status == Status::kOk || status == Status::kNotConverged;
}

}  // namespace detail

#if BELTRAMI_CPP_EXCEPTIONS
/// A Failure that is thrown.
class Error : public std::runtime_error {
 public:
  explicit Error(Failure failure)
      : std::runtime_error(failure.what()), failure_(std::move(failure)) {}

  Status status() const noexcept { return failure_.status(); }
  std::optional<std::uint64_t> element() const noexcept { return failure_.element(); }
  ElementKind element_kind() const noexcept { return failure_.element_kind(); }
  const Failure& failure() const noexcept { return failure_; }

 private:
  Failure failure_;
};
#endif

/// A value, or why there is none: what functions named try_ return.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : held_(std::in_place_index<0>, std::move(value)) {}  // NOLINT(google-explicit-*)
  Result(Failure failure)  // NOLINT(google-explicit-constructor)
      : held_(std::in_place_index<1>, std::move(failure)) {}

  bool has_value() const noexcept { return held_.index() == 0; }
  explicit operator bool() const noexcept { return has_value(); }
  /// The value. There must be one.
  T& operator*() & noexcept { return *std::get_if<0>(&held_); }
  const T& operator*() const& noexcept { return *std::get_if<0>(&held_); }
  T&& operator*() && noexcept { return std::move(*std::get_if<0>(&held_)); }
  T* operator->() noexcept { return std::get_if<0>(&held_); }
  const T* operator->() const noexcept { return std::get_if<0>(&held_); }
  /// Why there is none. There must be no value.
  const Failure& error() const noexcept { return *std::get_if<1>(&held_); }
  /// kOk where there is a value.
  Status status() const noexcept { return has_value() ? Status::kOk : error().status(); }

#if BELTRAMI_CPP_EXCEPTIONS
  /// The value; throws Error where there is none.
  T& value() & {
    require();
    return **this;
  }
  const T& value() const& {
    require();
    return **this;
  }
  T value() && {
    require();
    return std::move(*std::get_if<0>(&held_));
  }

 private:
  void require() const {
    if (!has_value()) throw Error(error());
  }
#endif

 private:
  std::variant<T, Failure> held_;
};

/// Nothing, or why that did not work.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Failure failure) : failure_(std::move(failure)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const noexcept { return !failure_.has_value(); }
  explicit operator bool() const noexcept { return has_value(); }
  const Failure& error() const noexcept { return *failure_; }
  Status status() const noexcept { return has_value() ? Status::kOk : failure_->status(); }

#if BELTRAMI_CPP_EXCEPTIONS
  /// Throws Error if it did not work.
  void value() const {
    if (failure_) throw Error(*failure_);
  }
#endif

 private:
  std::optional<Failure> failure_;
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_RESULT_HPP
