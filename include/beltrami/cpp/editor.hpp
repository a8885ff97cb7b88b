// Editor: a session of edits on one surface, whose seams and pins move and whose maps follow.
#ifndef BELTRAMI_CPP_EDITOR_HPP
#define BELTRAMI_CPP_EDITOR_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/context.hpp>
#include <beltrami/cpp/handle.hpp>
#include <beltrami/cpp/result.hpp>
#include <beltrami/cpp/results.hpp>
#include <beltrami/cpp/span.hpp>
#include <beltrami/cpp/surface.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

// The structs of C, which its header describes field by field.
using EditorInfo = beltrami_session;
using EditorChart = beltrami_session_chart;

/// Corners that the last update, pack or restore moved, increasing, and where they are now.
template <class Item = Uv>
struct Changes {
  std::vector<std::uint32_t> corners;
  std::vector<Item> uvs;
};

/// Edits are noted at once; update() then maps the charts that they concern, from the maps that
/// they have, and judges each exactly. What a call cannot do leaves the maps as they were. The
/// header of C says more: beltrami_session_.... It keeps its context alive, whose options for
/// packing and threads count at each call, and frees the session when it goes. Like the context it
/// belongs to one thread at a time; canceller() is for the others. Functions named try_ return a
/// Result and throw nothing but what a callable of the caller throws.
class Editor {
 public:
  /// Reads a surface, of which nothing is kept, and begins a session on the context, in place of
  /// the one before. With seams these are cut; with corner UVs charts keep them until an edit
  /// concerns them. Failure as of Context::try_unwrap.
  static Result<Editor> begin(Context& context, const Surface& surface, Progress progress = {}) {
    const std::shared_ptr<detail::Handle> handle = context.handle_;
    if (!handle) return Context::moved_from();
    if (surface.defect()) return Failure(Status::kInvalidArgument, surface.defect());
    const beltrami_status status =
        beltrami_session_begin(handle->context, &surface.c(), progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    ++handle->numbers[detail::kSession];
    Editor editor{Unset()};
    editor.source_ = detail::Source(handle, detail::kSession);
    editor.corners_ = surface.corners();
    editor.faces_ = surface.faces();
    return editor;
  }

  Editor(Editor&&) noexcept = default;
  Editor& operator=(Editor&& other) noexcept {
    if (this == &other) return *this;
    end();
    source_ = std::move(other.source_);
    corners_ = other.corners_;
    faces_ = other.faces_;
    return *this;
  }
  Editor(const Editor&) = delete;
  Editor& operator=(const Editor&) = delete;
  ~Editor() { end(); }

  // ---- Edits ----

  /// Opens seams at edges, by their vertices. Failure INVALID_ARGUMENT where there is no such edge,
  /// or it lies inside a polygon.
  Result<void> try_open_seams(const Indices<2>& edges) { return set_seams(edges, 1); }
  /// Closes them.
  Result<void> try_close_seams(const Indices<2>& edges) { return set_seams(edges, 0); }
  /// These pins in place of all before: corners, counted from 0, and where they are to be.
  Result<void> try_set_pins(const Indices<1>& corners, const Reals<2>& uvs) {
    if (Result<void> is = sound(corners); !is) return is;
    if (Result<void> is = sound(uvs); !is) return is;
    if (corners.size() != uvs.size()) {
      return Failure(Status::kInvalidArgument, "there is not one UV per pin");
    }
    return source_.call(&beltrami_session_set_pins, &corners.buffer(), &uvs.buffer(),
                        count(corners));
  }
  /// What is held of each of them, BELTRAMI_PIN_, and of lines their directions, or Reals<2>(): all
  /// are points at first.
  Result<void> try_set_pin_kinds(const Indices<1>& kinds, const Reals<2>& directions = {}) {
    if (Result<void> is = sound(kinds); !is) return is;
    if (Result<void> is = sound(directions); !is) return is;
    if (directions.size() != 0 && directions.size() != kinds.size()) {
      return Failure(Status::kInvalidArgument, "there is not one direction per pin");
    }
    const beltrami_buffer* along = directions.size() == 0 ? nullptr : &directions.buffer();
    return source_.call(&beltrami_session_set_pin_kinds, &kinds.buffer(), along, count(kinds));
  }
  /// The faces that may move alone, which makes their charts due; Indices<1>(): all may.
  Result<void> try_select(const Indices<1>& faces) {
    if (Result<void> is = sound(faces); !is) return is;
    return source_.call(&beltrami_session_select, &faces.buffer(), count(faces));
  }
  /// Locks charts, by their numbers (EditorChart::id), or no longer: locked ones never move.
  Result<void> try_lock(const Indices<1>& charts, bool locked = true) {
    return set_charts(&beltrami_session_lock, charts, locked);
  }
  /// Gives charts flags, a sum of BELTRAMI_CHART_ numbers, in place of those that they have.
  Result<void> try_set_flags(const Indices<1>& charts, std::uint32_t flags) {
    if (Result<void> is = sound(charts); !is) return is;
    return source_.call(&beltrami_session_set_flags, &charts.buffer(), count(charts), flags);
  }
  /// Has charts mapped anew by the next update; `cold`: from nothing.
  Result<void> try_renew(const Indices<1>& charts, bool cold = false) {
    return set_charts(&beltrami_session_renew, charts, cold);
  }

  // ---- Maps ----

  /// Cuts and maps what is due, for so many seconds and Newton steps a chart, 0: any. kOk,
  /// kNotConverged where the next update goes on, or kNotInjective. Failure PINS with the corner,
  /// INVALID_STATE with the face of parts that cannot be joined, CANCELLED.
  Result<Status> try_update(double seconds = 0, std::int32_t steps = 0, Progress progress = {}) {
    return run(progress, &beltrami_session_update, seconds, steps);
  }
  /// Packs all charts onto pages. Failure NO_ROOM, INVALID_STATE before the first update.
  Result<Status> try_pack(Progress progress = {}) {
    return run(progress, &beltrami_session_pack, nullptr, std::uint64_t{0});
  }
  /// The same of charts by their numbers, among the others, which stay.
  Result<Status> try_pack_charts(const Indices<1>& charts, Progress progress = {}) {
    if (Result<void> is = sound(charts); !is) return is.error();
    if (charts.size() == 0) {
      return Failure(Status::kInvalidArgument, "there are no charts to pack: try_pack packs all");
    }
    return run(progress, &beltrami_session_pack, &charts.buffer(), count(charts));
  }
  /// The exact verdict on all charts together.
  Result<AtlasCertificate> try_check() const {
    return source_.get<AtlasCertificate>(&beltrami_session_check);
  }

  /// Notes how all stands, under a number that is given once; goes back to it; drops it.
  Result<std::uint64_t> try_save() {
    std::uint64_t mark = 0;
    if (Result<void> done = source_.call(&beltrami_session_save, &mark); !done) {
      return done.error();
    }
    return mark;
  }
  Result<void> try_restore(std::uint64_t mark) {
    return source_.call(&beltrami_session_restore, mark);
  }
  Result<void> try_forget(std::uint64_t mark) {
    return source_.call(&beltrami_session_forget, mark);
  }

  // ---- How it stands ----

  Result<EditorInfo> try_info() const { return source_.get<EditorInfo>(&beltrami_get_session); }
  /// All charts, in the order of their first faces.
  Result<std::vector<EditorChart>> try_charts() const {
    const Result<EditorInfo> info = try_info();
    if (!info) return info.error();
    return source_.each<EditorChart, std::uint64_t>(info->charts, &beltrami_get_session_chart);
  }
  /// One (u, v) per corner, face after face.
  template <class Item = Uv>
  Result<std::vector<Item>> try_corner_uvs() const {
    return source_.read<2, Item>(corners_, &beltrami_get_session_uvs);
  }
  /// The same into memory of the caller, one item per corner.
  template <class Item>
  Result<void> try_write_corner_uvs(Span<Item> out) const {
    return source_.write<2>(out, corners_, &beltrami_get_session_uvs);
  }
  template <class Item = Uv>
  Result<Changes<Item>> try_changes() const {
    using Traits = detail::TraitsOf<Item>;
    constexpr std::int32_t kType = detail::scalar_type<typename Traits::Scalar>();
    static_assert(detail::is_real(kType) && Traits::kWidth == 2, "an item has two coordinates");
    const Result<EditorInfo> info = try_info();
    if (!info) return info.error();
    const auto moved = static_cast<std::size_t>(info->changes);
    Changes<Item> changes;
    if (!detail::has_room_for([&] {
          changes.corners.resize(moved);
          changes.uvs.resize(moved);
        })) {
      return Failure(Status::kOutOfMemory);
    }
    if (moved == 0) return changes;
    Result<void> done = source_.call(&beltrami_get_session_changes, changes.corners.data(),
                                     BELTRAMI_U32, changes.uvs.data(), kType);
    if (!done) return done.error();
    return changes;
  }
  /// The number of the chart of each face, all bits set for faces without area.
  template <class Item = std::uint32_t>
  Result<std::vector<Item>> try_face_charts() const {
    return source_.read<1, Item>(faces_, &beltrami_get_session_face_charts);
  }
  /// Edges that had to be cut beside the seams, by their vertices.
  template <class Item = SeamEdge>
  Result<std::vector<Item>> try_opened() const {
    const Result<EditorInfo> info = try_info();
    if (!info) return info.error();
    return source_.read<2, Item>(static_cast<std::size_t>(info->opened),
                                 &beltrami_get_session_opened);
  }

  /// What another thread ends calls with.
  Canceller canceller() const noexcept {
    Canceller canceller;
    canceller.handle_ = source_.handle();
    return canceller;
  }

#if BELTRAMI_CPP_EXCEPTIONS
  Editor(Context& context, const Surface& surface, Progress progress = {})
      : Editor(begin(context, surface, std::move(progress)).value()) {}

  void open_seams(const Indices<2>& edges) {
    try_open_seams(edges).value();
  }
  void close_seams(const Indices<2>& edges) {
    try_close_seams(edges).value();
  }
  void set_pins(const Indices<1>& corners, const Reals<2>& uvs) {
    try_set_pins(corners, uvs).value();
  }
  void set_pin_kinds(const Indices<1>& kinds, const Reals<2>& directions = {}) {
    try_set_pin_kinds(kinds, directions).value();
  }
  void select(const Indices<1>& faces) {
    try_select(faces).value();
  }
  void lock(const Indices<1>& charts, bool locked = true) {
    try_lock(charts, locked).value();
  }
  void set_flags(const Indices<1>& charts, std::uint32_t flags) {
    try_set_flags(charts, flags).value();
  }
  void renew(const Indices<1>& charts, bool cold = false) {
    try_renew(charts, cold).value();
  }
  Status update(double seconds = 0, std::int32_t steps = 0, Progress progress = {}) {
    return try_update(seconds, steps, std::move(progress)).value();
  }
  Status pack(Progress progress = {}) {
    return try_pack(std::move(progress)).value();
  }
  Status pack_charts(const Indices<1>& charts, Progress progress = {}) {
    return try_pack_charts(charts, std::move(progress)).value();
  }
  AtlasCertificate check() const {
    return try_check().value();
  }
  std::uint64_t save() {
    return try_save().value();
  }
  void restore(std::uint64_t mark) {
    try_restore(mark).value();
  }
  void forget(std::uint64_t mark) {
    try_forget(mark).value();
  }
  EditorInfo info() const {
    return try_info().value();
  }
  std::vector<EditorChart> charts() const {
    return try_charts().value();
  }
  template <class Item = Uv>
  std::vector<Item> corner_uvs() const {
    return try_corner_uvs<Item>().value();
  }
  template <class Item>
  void write_corner_uvs(Span<Item> out) const {
    try_write_corner_uvs(out).value();
  }
  template <class Item = Uv>
  Changes<Item> changes() const {
    return try_changes<Item>().value();
  }
  template <class Item = std::uint32_t>
  std::vector<Item> face_charts() const {
    return try_face_charts<Item>().value();
  }
  template <class Item = SeamEdge>
  std::vector<Item> opened() const {
    return try_opened<Item>().value();
  }
#endif

 private:
  struct Unset {};
  explicit Editor(Unset) noexcept {}

  template <class View>
  static Result<void> sound(const View& items) {
    if (items.defect() != nullptr) return Failure(Status::kInvalidArgument, items.defect());
    return {};
  }
  template <class View>
  static std::uint64_t count(const View& items) noexcept {
    return static_cast<std::uint64_t>(items.size());
  }

  Result<void> set_seams(const Indices<2>& edges, std::int32_t open) {
    if (Result<void> is = sound(edges); !is) return is;
    return source_.call(&beltrami_session_set_seams, &edges.buffer(), count(edges), open);
  }
  template <class Function>
  Result<void> set_charts(Function function, const Indices<1>& charts, bool flag) {
    if (Result<void> is = sound(charts); !is) return is;
    return source_.call(function, &charts.buffer(), count(charts), std::int32_t{flag});
  }

  /// A call that takes a progress, with what it returns where that is no error.
  template <class Function, class... Arguments>
  Result<Status> run(Progress& progress, Function function, Arguments... arguments) {
    if (Result<void> is = source_.ready(); !is) return is.error();
    // The callable may move or destroy this object: the call keeps what it runs on.
    const std::shared_ptr<detail::Handle> handle = source_.handle();
    const beltrami_status status =
        function(handle->context, arguments..., progress.function(), progress.user());
    progress.rethrow();
    if (status < 0) return handle->failure(status);
    return static_cast<Status>(status);
  }

  /// Frees the session, unless the context has another one by now.
  void end() noexcept {
    if (source_.ready()) beltrami_session_end(source_.handle()->context);
  }

  detail::Source source_;
  std::size_t corners_ = 0, faces_ = 0;
};

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_EDITOR_HPP
