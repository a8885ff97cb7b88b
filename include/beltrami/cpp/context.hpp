// The context: options, and the calls that unwrap, flatten and pack.
#ifndef BELTRAMI_CPP_CONTEXT_HPP
#define BELTRAMI_CPP_CONTEXT_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/bake.hpp>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/handle.hpp>
#include <beltrami/cpp/options.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/results.hpp>
#include <beltrami/cpp/surface.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

/// Ends calls of a context from any thread, also after the context has moved or gone.
class Canceller {
 public:
  /// The call under way, or where none is the next one, ends with kCancelled.
  void cancel() const noexcept {
    if (handle_) beltrami_cancel(handle_->context);
  }

 private:
  friend class Context;
  friend class Editor;
  std::shared_ptr<const detail::Handle> handle_;
};

/// Options, and the results of the last call of each kind. It belongs to one thread at a time; it
/// moves, and is not copied. Functions that throw Error have a try_ that returns a Result: that one
/// throws nothing but what a callable of the caller throws.
class Context {
 public:
  /// With `memory` the context takes its own from there: see beltrami_create_with. Failure
  /// ABI_MISMATCH, INVALID_ARGUMENT, OUT_OF_MEMORY, UNSUPPORTED.
  static Result<Context> create(const beltrami_allocator* memory = nullptr) {
    Context context{Unset()};
    if (!detail::has_room_for([&] { context.handle_ = std::make_shared<detail::Handle>(); })) {
      return Failure(Status::kOutOfMemory);
    }
    const beltrami_status status = beltrami_create_with(memory, &context.handle_->context);
    if (status < 0) return Failure(status);
    return context;
  }

  Context(Context&&) noexcept = default;
  Context& operator=(Context&&) noexcept = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  ~Context() = default;

  // ---- Options ----

  /// An option by its key here: the compiler sees to it that the value is of its type. Failure
  /// INVALID_ARGUMENT (out of range; the old value stays), INVALID_STATE (during a call, or after a
  /// move).
  template <class T>
  Result<void> try_set(Option<T> option, std::common_type_t<T> value) {
    return try_set(option.key, OptionValue(value));
  }
  /// An option by its key in C.
  Result<void> try_set(std::int32_t key, const OptionValue& value) {
    if (!handle_) return moved_from();
    return value.set(handle_->context, key);
  }
  /// An option by its name, that of the program's flag: "target-energy".
  Result<void> try_set(const char* name, const OptionValue& value) {
    const std::int32_t key = beltrami_option_find(name);
    if (key < 0) {
      return detail::refusal({"there is no option '", name == nullptr ? "" : name, "'"});
    }
    return try_set(key, value);
  }
  Result<void> try_set(const std::string& name, const OptionValue& value) {
    return try_set(name.c_str(), value);
  }
  /// The value that an option has now.
  template <class T>
  Result<T> try_get(Option<T> option) const {
    Result<double> value = try_get(option.key);
    if (!value) return value.error();
    return static_cast<T>(*value);
  }
  Result<double> try_get(std::int32_t key) const {
    if (!handle_) return moved_from();
    double value = 0;
    const beltrami_status status = beltrami_get_option(handle_->context, key, &value);
    if (status < 0) return handle_->failure(status);
    return value;
  }

  // ---- Calls ----

  /// Cuts a surface into charts, flattens and packs them: beltrami_unwrap.
  Result<Atlas> try_unwrap(const Surface& surface, Progress progress = {}) {
    // The callable may move or destroy this object: the call keeps what it runs on.
    const std::shared_ptr<detail::Handle> handle = handle_;
    if (!handle) return moved_from();
    if (surface.defect()) return Failure(Status::kInvalidArgument, surface.defect());
    const beltrami_status status =
        beltrami_unwrap(handle->context, &surface.c(), progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    ++handle->numbers[detail::kUnwrap];
    Atlas atlas;
    atlas.source_ = detail::Source(handle, detail::kUnwrap);
    Result<AtlasInfo> info = atlas.source_.get<AtlasInfo>(&beltrami_get_atlas);
    if (!info) return info.error();
    atlas.info_ = *info;
    if (info->pages != 0) {
      handle->has_packed(true);
    } else {
      handle->has_not_packed();
    }
    atlas.packed_ = detail::Source(handle, detail::kPack);
    return atlas;
  }

  /// Flattens triangles that form one disk: beltrami_set_mesh and beltrami_run.
  Result<Flattening> try_flatten(const Surface& disk, Progress progress = {}) {
    const std::shared_ptr<detail::Handle> handle = handle_;
    if (!handle) return moved_from();
    const Result<beltrami_mesh> mesh = disk.mesh();
    if (!mesh) return mesh.error();
    beltrami_status status = beltrami_set_mesh(handle->context, &*mesh);
    if (status < 0) return handle->failure(status);
    // From here on the results of the mesh before are gone, whether the run succeeds or not.
    ++handle->numbers[detail::kRun];
    status = beltrami_run(handle->context, progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    Flattening flattening;
    flattening.source_ = detail::Source(handle, detail::kRun);
    Result<FlatteningInfo> info = flattening.source_.get<FlatteningInfo>(&beltrami_get_result);
    if (!info) return info.error();
    flattening.info_ = *info;
    return flattening;
  }

  /// Packs the charts of UV meshes onto common pages: beltrami_pack.
  Result<Packing> try_pack(const std::vector<UvMesh>& meshes, Progress progress = {}) {
    return try_pack(meshes.data(), meshes.size(), progress);
  }
  Result<Packing> try_pack(const UvMesh& mesh, Progress progress = {}) {
    return try_pack(&mesh, 1, progress);
  }

  /// Reads images through old UVs and writes them for new ones: beltrami_bake, which says what the
  /// fields of `job` mean; its size is set here. `Number` is that of the images' type:
  /// std::uint8_t, std::uint16_t or float.
  template <class Number>
  Result<Baked<Number>> try_bake(beltrami_bake_job job, Progress progress = {}) {
    const std::shared_ptr<detail::Handle> handle = handle_;
    if (!handle) return moved_from();
    job.struct_size = sizeof job;
    Baked<Number> baked;
    if (const std::optional<Failure> refused = detail::make_room(job, baked)) return *refused;
    auto out = detail::sized<beltrami_baked>();
    out.pixels = baked.pixels.data();
    out.masks = baked.masks.data();
    const beltrami_status status =
        beltrami_bake(handle->context, &job, &out, progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    baked.texels = out.texels;
    baked.without_source = out.without_source;
    baked.old_texels = out.old_texels;
    return baked;
  }

  /// Copies the disk, and estimates how many bytes flattening it will take at its peak:
  /// beltrami_estimate_memory. Results of flattening end with it.
  Result<std::uint64_t> try_estimate_memory(const Surface& disk) {
    if (!handle_) return moved_from();
    const Result<beltrami_mesh> mesh = disk.mesh();
    if (!mesh) return mesh.error();
    beltrami_status status = beltrami_set_mesh(handle_->context, &*mesh);
    if (status < 0) return handle_->failure(status);
    ++handle_->numbers[detail::kRun];
    std::uint64_t bytes = 0;
    status = beltrami_estimate_memory(handle_->context, &bytes);
    if (status < 0) return handle_->failure(status);
    return bytes;
  }

  /// What another thread ends calls with.
  Canceller canceller() const noexcept {
    Canceller canceller;
    canceller.handle_ = handle_;
    return canceller;
  }

  /// For calls of the header of C; nullptr after a move. Results here do not hear of what such
  /// calls compute: nothing is to be asked of those of the same kind from then on.
  beltrami_context* c() const noexcept { return handle_ ? handle_->context : nullptr; }

#if BELTRAMI_CPP_EXCEPTIONS
  Context() : Context(create().value()) {}

  /// These return the context, so that several can be set in a line.
  template <class T>
  Context& set(Option<T> option, std::common_type_t<T> value) {
    try_set(option, value).value();
    return *this;
  }
  template <class Key>
  Context& set(const Key& key, const OptionValue& value) {
    try_set(key, value).value();
    return *this;
  }
  template <class T>
  T get(Option<T> option) const {
    return try_get(option).value();
  }
  double get(std::int32_t key) const {
    return try_get(key).value();
  }

  Atlas unwrap(const Surface& surface, Progress progress = {}) {
    return try_unwrap(surface, std::move(progress)).value();
  }
  Flattening flatten(const Surface& disk, Progress progress = {}) {
    return try_flatten(disk, std::move(progress)).value();
  }
  Packing pack(const std::vector<UvMesh>& meshes, Progress progress = {}) {
    return try_pack(meshes, std::move(progress)).value();
  }
  Packing pack(const UvMesh& mesh, Progress progress = {}) {
    return try_pack(mesh, std::move(progress)).value();
  }
  template <class Number>
  Baked<Number> bake(const beltrami_bake_job& job, Progress progress = {}) {
    return try_bake<Number>(job, std::move(progress)).value();
  }
  std::uint64_t estimate_memory(const Surface& disk) {
    return try_estimate_memory(disk).value();
  }
#endif

 private:
  friend class Editor;

  struct Unset {};
  explicit Context(Unset) noexcept {}

  static Failure moved_from() {
    return Failure(Status::kInvalidState, "this context was moved from");
  }

  Result<Packing> try_pack(const UvMesh* meshes, std::size_t count, Progress& progress) {
    const std::shared_ptr<detail::Handle> handle = handle_;
    if (!handle) return moved_from();
    Packing packing;
    std::vector<const beltrami_uv_mesh*> views;
    if (!detail::has_room_for([&] {
          for (std::size_t i = 0; i < count; ++i) {
            views.push_back(&meshes[i].c());
            packing.uvs_.push_back(meshes[i].uvs());
            packing.faces_.push_back(meshes[i].faces());
          }
        })) {
      return Failure(Status::kOutOfMemory);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (meshes[i].defect()) return Failure(Status::kInvalidArgument, meshes[i].defect());
    }
    const beltrami_status status =
        beltrami_pack(handle->context, views.data(), count, progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    handle->has_packed(false);
    packing.source_ = detail::Source(handle, detail::kPack);
    Result<PackingInfo> info = packing.source_.get<PackingInfo>(&beltrami_get_packing);
    if (!info) return info.error();
    packing.info_ = *info;
    return packing;
  }

  std::shared_ptr<detail::Handle> handle_;
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_CONTEXT_HPP
