// An editing session in the numbers of the caller's corners, faces and vertices.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "abi/options.h"
#include "abi/surface.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "pack/types.h"
#include "session/session.h"

namespace beltrami {

/// What beltrami_session_begin leaves behind.
class EditSession {
 public:
  /// Throws Error INVALID_ARGUMENT for what a session takes no notice of, or what atlas_input and
  /// the session throw.
  EditSession(const beltrami_surface& header, const Options& options, const Work& work);

  /// Throw what the functions of the session of these names do, and Error INVALID_ARGUMENT or
  /// INDEX_OUT_OF_RANGE for the caller's arrays.
  void set_seams(const beltrami_buffer* edges, std::uint64_t count, bool open);
  void set_pins(const beltrami_buffer* corners, const beltrami_buffer* uvs, std::uint64_t count);
  void set_pin_kinds(const beltrami_buffer* kinds, const beltrami_buffer* directions,
                     std::uint64_t count);
  void select(const beltrami_buffer* faces, std::uint64_t count);
  void lock(const beltrami_buffer* charts, std::uint64_t count, bool locked);
  void set_flags(const beltrami_buffer* charts, std::uint64_t count, std::uint32_t flags);
  void renew(const beltrami_buffer* charts, std::uint64_t count, bool cold);

  Updated update(int steps, const Work& work);
  Outcome pack(const std::vector<Index>& charts, const PackOptions& options, const Work& work);
  /// The numbers of charts in the caller's array.
  static std::vector<Index> read_charts(const beltrami_buffer* charts, std::uint64_t count);
  std::uint64_t save() { return session_.save(); }
  void restore(std::uint64_t mark);
  void forget(std::uint64_t mark) { session_.forget(mark); }

  const Session& session() const { return session_; }
  std::uint64_t corner_count() const { return header_.corner_count; }
  /// Per corner of the caller.
  const Vec2& uv(Index corner) const { return session_.uv(source_[corner]); }
  std::vector<Vec2> uvs() const;
  /// Corners that the last call moved, increasing.
  const std::vector<Index>& changes() const { return changes_; }
  /// Per face of the caller the number of its chart, or kNone.
  std::vector<Index> face_charts() const;
  /// Two vertices per edge that had to be cut beside the seams.
  std::vector<Index> opened() const;
  Index face_of(Index triangle) const { return surface_.face_of(triangle); }
  AtlasCertificate check(const Work& work) const { return session_.check(work); }

 private:
  void find_sources();
  void follow_others(const std::vector<Index>& of_vertex);
  /// There is room for all: the session has changed already, so this must not fail.
  void find_changes() noexcept;

  beltrami_surface header_;  ///< its counts alone
  Options options_;
  LoadedSurface surface_;
  std::vector<std::uint8_t> diagonals_;
  Session session_;
  std::vector<Index> source_;  ///< per corner of the caller one of the ground
  std::vector<Index> start_,
      followers_;  ///< per corner of the ground those that it is the source of
  std::vector<Index> changes_;
  std::vector<std::uint64_t> moved_;  ///< a bit per corner of the caller
};

}  // namespace beltrami
