// What Context and its results share: the context of C, and how calls of it become results here.
#ifndef BELTRAMI_CPP_HANDLE_HPP
#define BELTRAMI_CPP_HANDLE_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/span.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

using Uv = std::array<double, 2>;
using Uv32 = std::array<float, 2>;
using Stage = beltrami_stage;

/// A callable that hears how far a call is: of (double fraction, const char* stage), or of the
/// fraction alone, that returns nothing, or whether to go on. What it throws ends the call, too,
/// and comes out of it, round the code of C. A call that is cancelled otherwise fails with
/// kCancelled.
class Progress {
 public:
  Progress() noexcept = default;
  Progress(std::nullptr_t) noexcept {}  // NOLINT(google-explicit-constructor)
  /// Refers to the callable, which is not copied: it must outlive the call.
  template <class Callable,
            class = std::enable_if_t<!std::is_same_v<std::decay_t<Callable>, Progress> &&
                                     !std::is_same_v<std::decay_t<Callable>, std::nullptr_t>>>
  Progress(Callable&& callable) noexcept {  // NOLINT(google-explicit-constructor)
    using Target = std::remove_reference_t<Callable>;
    if constexpr (std::is_function_v<Target>) {
      function_ = reinterpret_cast<void (*)()>(&callable);
    } else {
      object_ = const_cast<void*>(static_cast<const void*>(std::addressof(callable)));
    }
    call_ = &call<Target>;
  }

  /// What C calls, and what it passes on; both nullptr where there is no callable.
  beltrami_progress function() const noexcept { return call_ == nullptr ? nullptr : &report; }
  void* user() noexcept { return this; }

  /// Throws what the callable has thrown. To be called after the call of C.
  void rethrow() const {
#if BELTRAMI_CPP_EXCEPTIONS
    if (thrown_) std::rethrow_exception(thrown_);
#endif
  }

 private:
  template <class Target>
  static bool call(const Progress& self, double fraction, const char* stage) {
    if constexpr (std::is_function_v<Target>) {
      return answer(*reinterpret_cast<Target*>(self.function_), fraction, stage);
    } else {
      return answer(*static_cast<Target*>(self.object_), fraction, stage);
    }
  }

  /// Whether to go on. A callable that returns nothing never ends a call.
  template <class Target>
  static bool answer(Target& target, double fraction, const char* stage) {
    if constexpr (std::is_invocable_v<Target&, double, const char*>) {
      return told([&] { return std::invoke(target, fraction, stage); });
    } else {
      return told([&] { return std::invoke(target, fraction); });
    }
  }
  template <class Call>
  static bool told(Call invoke) {
    using Answer = decltype(invoke());
    // A number would be taken for C's, where 0 goes on.
    static_assert(std::is_void_v<Answer> || std::is_same_v<Answer, bool>,
                  "progress returns nothing, or a bool: whether to go on");
    if constexpr (std::is_void_v<Answer>) {
      invoke();
      return true;
    } else {
      return invoke();
    }
  }

  static std::int32_t report(void* user, double fraction, const char* stage) {
    auto& self = *static_cast<Progress*>(user);
#if BELTRAMI_CPP_EXCEPTIONS
    try {
      return self.call_(self, fraction, stage) ? 0 : 1;
    } catch (...) {
      self.thrown_ = std::current_exception();
      return 1;
    }
#else
    return self.call_(self, fraction, stage) ? 0 : 1;
#endif
  }

  bool (*call_)(const Progress&, double, const char*) = nullptr;
  void* object_ = nullptr;
  void (*function_)() = nullptr;
#if BELTRAMI_CPP_EXCEPTIONS
  std::exception_ptr thrown_;
#endif
};

namespace detail {

/// What kind of results a context has one of at a time.
enum Kind : std::size_t { kRun, kUnwrap, kPack, kSession };

/// A context of C, and the numbers of the results of each kind that it has had. By these a result
/// knows that there are newer ones, and that its own is gone.
struct Handle {
  Handle() = default;
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { beltrami_destroy(context); }

  /// What the context says of a call that failed.
  Failure failure(beltrami_status status) const noexcept {
    return Failure(static_cast<Status>(status), beltrami_error_message(context),
                   static_cast<ElementKind>(beltrami_error_element_kind(context)),
                   beltrami_error_element(context));
  }

  /// The pages of what was packed last are those of an atlas, or of `atlas` false of a pack.
  void has_packed(bool atlas) noexcept {
    ++numbers[kPack];
    pages_of_atlas = atlas;
  }
  /// After an atlas without pages those of the one before are gone, but not those of a pack.
  void has_not_packed() noexcept {
    if (pages_of_atlas) has_packed(false);
  }

  beltrami_context* context = nullptr;
  std::uint64_t numbers[4] = {0, 0, 0, 0};
  bool pages_of_atlas = false;
};

/// One result of a context: it keeps the context alive, and knows whether it is still the newest.
class Source {
 public:
  Source() = default;
  Source(std::shared_ptr<Handle> handle, Kind kind) noexcept
      : handle_(std::move(handle)), kind_(kind), number_(handle_->numbers[kind]) {}

  /// Nothing, or why nothing can be asked of this result.
  Result<void> ready() const {
    if (!handle_) return Failure(Status::kInvalidState, "this result was moved from");
    if (handle_->numbers[kind_] != number_) {
      return Failure(Status::kInvalidState,
                     "the context has newer results: take what is needed of one before the next "
                     "call, or use a context for each");
    }
    return {};
  }

  /// Calls a function of C with the context and these arguments.
  template <class Function, class... Arguments>
  Result<void> call(Function function, Arguments... arguments) const {
    if (Result<void> is = ready(); !is) return is;
    const beltrami_status status = function(handle_->context, arguments...);
    if (status < 0) return handle_->failure(status);
    return {};
  }

  /// A struct that a function of C fills, whose leading arguments are these.
  template <class Struct, class Function, class... Arguments>
  Result<Struct> get(Function function, Arguments... arguments) const {
    auto value = sized<Struct>();
    if (Result<void> done = call(function, arguments..., &value); !done) return done.error();
    return value;
  }

  /// `count` items of N numbers in memory of the caller. Failure INVALID_ARGUMENT: `out` has room
  /// for another number of items, or is flat and not packed.
  template <std::size_t N, class Item, class Function, class... Arguments>
  Result<void> write(Span<Item> out, std::size_t count, Function function,
                     Arguments... arguments) const {
    using Traits = TraitsOf<Item>;
    constexpr std::int32_t kType = scalar_type<typename Traits::Scalar>();
    constexpr std::size_t kWidth = Traits::kWidth;
    static_assert(!std::is_const_v<Item>, "these items cannot be written");
    static_assert(kType >= 0, "numbers are float, double, or integers of 32 or 64 bits");
    static_assert(kWidth % N == 0 || kWidth == 1, "an item has another number of components");
    if (Result<void> is = ready(); !is) return is;
    if (out.size() * kWidth != count * N) {
      return Failure(Status::kInvalidArgument,
                     "the array to be filled has not as many items as there are results");
    }
    if (kWidth != N && !out.packed()) {
      return Failure(Status::kInvalidArgument, "items of another width have to be packed");
    }
    if (count == 0) return {};
    const std::uint64_t stride = kWidth == N ? out.stride() : 0;
    return call(function, arguments..., static_cast<void*>(out.data()), kType, stride);
  }

  /// The same as an array. An item has N numbers, or one (N to an item of C), or several items.
  template <std::size_t N, class Item, class Function, class... Arguments>
  Result<std::vector<Item>> read(std::size_t count, Function function,
                                 Arguments... arguments) const {
    std::vector<Item> items;
    if (Result<void> is = ready(); !is) return is.error();
    if (!has_room_for([&] { items.resize(count * N / TraitsOf<Item>::kWidth); })) {
      return Failure(Status::kOutOfMemory);
    }
    if (Result<void> done = write<N>(span_of(items), count, function, arguments...); !done) {
      return done.error();
    }
    return items;
  }

  /// `count` structs, one call each.
  template <class Struct, class Index, class Function>
  Result<std::vector<Struct>> each(std::uint64_t count, Function function) const {
    std::vector<Struct> structs;
    if (Result<void> is = ready(); !is) return is.error();
    const auto size = static_cast<std::size_t>(count);
    if (!has_room_for([&] { structs.resize(size, sized<Struct>()); })) {
      return Failure(Status::kOutOfMemory);
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (Result<void> done = call(function, static_cast<Index>(i), &structs[i]); !done) {
        return done.error();
      }
    }
    return structs;
  }

  const std::shared_ptr<Handle>& handle() const noexcept { return handle_; }

 private:
  std::shared_ptr<Handle> handle_;
  Kind kind_ = kRun;
  std::uint64_t number_ = 0;
};

}  // namespace detail

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_HANDLE_HPP
