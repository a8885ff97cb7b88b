// Packing the charts of a session, all or some of them.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "atlas/pack_uvs.h"
#include "atlas/pages.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "pack/types.h"
#include "pins/similarity.h"
#include "session/ground.h"
#include "session/session.h"
#include "session/stack.h"
#include "session/state.h"

namespace beltrami {

class Repacker {
 public:
  Repacker(const Session& session, std::vector<bool> moves)
      : session_(session), next_(session.state_), moves_(std::move(moves)) {
    for (const SessionChart& chart : next_.charts) {
      first_uv_.push_back(uvs_);
      uvs_ += size_of(*chart.uvs);
    }
  }

  /// Finds which charts are to lie on others.
  void stack(const Work& work);

  Outcome run(PackOptions options, const Work& work);
  bool lies_on_pages(const Work& work) const;
  SessionState result() { return std::move(next_); }

 private:
  Index page_of(const SessionChart& chart) const;
  UvMesh mesh() const;
  PackedUvs pack(const PackOptions& options, const Work& work) const;
  void take_off(std::size_t c, UvMesh& mesh) const;
  void lay(Index c);
  void take(Index c, const PackedUvs& packed);

  const Session& session_;
  SessionState next_;
  const std::vector<bool> moves_;                // per chart
  std::vector<Index> on_;                        // likewise the chart that it lies on, or kNone
  std::vector<std::vector<Index>> vertices_on_;  // of those that are to be laid there: vertices_on
  std::vector<Index> first_uv_;
  Index uvs_ = 0;
};

void Repacker::stack(const Work& work) {
  on_.assign(next_.charts.size(), kNone);
  vertices_on_.resize(next_.charts.size());
  std::vector<std::pair<Index, ChartShape>> first;  // of each shape
  for (Index c = 0; c < size_of(next_.charts); ++c) {
    const SessionChart& chart = next_.charts[c];
    const Index below = next_.stacked_on(chart);
    if (!moves_[c] && below != kNone && !moves_[below]) on_[c] = below;
    if ((next_.flags_of(chart) & kStack) == 0) continue;
    ChartShape shape = shape_of(*chart.part, work);
    for (const auto& [other, shape_of_other] : first) {
      if (!moves_[c]) break;
      auto vertices = vertices_on(shape, shape_of_other);
      if (!vertices) continue;
      on_[c] = other;
      vertices_on_[c] = *std::move(vertices);
      break;
    }
    if (on_[c] == kNone) first.emplace_back(c, std::move(shape));
  }
}

/// The page that a chart begins on: the first where it lies on none.
Index Repacker::page_of(const SessionChart& chart) const {
  Eigen::AlignedBox2d box;
  for (Index f = 0; f < chart.faces(); ++f) {
    for (const Index v : chart.mesh().faces[f]) box.extend((*chart.uvs)[v]);
  }
  const Vec2 middle = box.center();
  const double column = std::floor(middle.x()), row = std::floor(middle.y());
  const bool is_page = column >= 0 && column < kPagesInARow && row >= 0 && row < 1000;
  return is_page ? static_cast<Index>(column + kPagesInARow * row) : 0;
}

/// The faces of a chart that lies on another are none to be packed: each at a vertex of that.
void Repacker::take_off(std::size_t c, UvMesh& mesh) const {
  const Index on = on_[c], at = first_uv_[on] + next_.charts[on].mesh().faces[0][0];
  for (Index f = 0; f < next_.charts[c].faces(); ++f) {
    const Index face = next_.charts[c].part->chart.input_face[f];
    mesh.faces[face] = {at, at, at};
    mesh.excepted[face] = true;
  }
}

UvMesh Repacker::mesh() const {
  UvMesh mesh;
  mesh.uvs.assign(uvs_, Vec2::Zero());
  mesh.faces.resize(session_.ground_.face_count());
  mesh.kept_page.assign(mesh.faces.size(), kNone);
  mesh.own_turns.assign(mesh.faces.size(), 0);
  mesh.excepted.assign(mesh.faces.size(), false);
  for (std::size_t c = 0; c < next_.charts.size(); ++c) {
    const SessionChart& chart = next_.charts[c];
    if (on_[c] != kNone) {
      take_off(c, mesh);
      continue;
    }
    const std::uint8_t flags = next_.flags_of(chart);
    const Index page = moves_[c] ? kNone : page_of(chart);
    for (Index f = 0; f < chart.faces(); ++f) {
      const Index face = chart.part->chart.input_face[f];
      mesh.kept_page[face] = page;
      if ((flags & kKeepFrame) != 0) {
        mesh.own_turns[face] = 1;
      } else if ((flags & kAlign) != 0) {
        mesh.own_turns[face] = 4;
      }
      for (int k = 0; k < 3; ++k) {
        const Index v = chart.mesh().faces[f][k];
        mesh.faces[face][k] = first_uv_[c] + v;
        mesh.uvs[first_uv_[c] + v] = (*chart.uvs)[v];
        if (page != kNone) mesh.uvs[first_uv_[c] + v] -= tile_of(page);
      }
    }
  }
  return mesh;
}

/// The places of a chart that was moved; what has no faces in the plane follows.
void Repacker::take(Index c, const PackedUvs& packed) {
  SessionChart& chart = next_.charts[c];
  std::vector<Vec2> uvs = *chart.uvs;
  std::vector<bool> is_real(uvs.size(), false);
  for (Index f = 0; f < chart.faces(); ++f) {
    for (const Index v : chart.mesh().faces[f]) is_real[v] = true;
  }
  std::vector<std::pair<Vec2, Vec2>> pairs;
  for (Index v = 0; v < size_of(uvs); ++v) {
    if (is_real[v]) pairs.emplace_back(uvs[v], packed.uvs[first_uv_[c] + v]);
  }
  const Similarity moved = fit_similarity(pairs, false);
  for (Index v = 0; v < size_of(uvs); ++v) {
    uvs[v] = is_real[v] ? packed.uvs[first_uv_[c] + v] : moved(uvs[v]);
  }
  chart.scale *= moved.scale();
  chart.uvs = std::make_shared<const std::vector<Vec2>>(std::move(uvs));
  chart.lies_on = nullptr;
}

/// Gives a chart the map of the one that it lies on, which has got its place.
void Repacker::lay(Index c) {
  SessionChart& chart = next_.charts[c];
  const SessionChart& other = next_.charts[on_[c]];
  std::vector<Vec2> uvs = map_on(*chart.part, vertices_on_[c], *other.uvs);
  chart.uvs = std::make_shared<const std::vector<Vec2>>(std::move(uvs));
  chart.lies_on = other.uvs;
  chart.scale = other.scale;
  chart.due = other.due;
  chart.outcome = other.outcome;
  chart.energy = other.energy;
}

/// Packs the mesh. Failures name the face as the caller does.
PackedUvs Repacker::pack(const PackOptions& options, const Work& work) const {
  try {
    return pack_uvs(mesh(), options, session_.float32_, work);
  } catch (const Error& error) {
    if (error.element().kind != ElementKind::kFace) throw;
    const Ground& ground = session_.ground_;
    const auto own = static_cast<Index>(error.element().index);
    const Index face = ground.name_of(ground.admitted.input_face[own]);
    throw Error(error.fault(), "face " + std::to_string(face) + ": " + error.what(),
                Element::face(static_cast<std::uint64_t>(face)));
  }
}

Outcome Repacker::run(PackOptions options, const Work& work) {
  const PackedUvs packed = pack(options, work);
  for (Index c = 0; c < size_of(next_.charts); ++c) {
    if (moves_[c] && on_[c] == kNone) take(c, packed);
  }
  for (Index c = 0; c < size_of(next_.charts); ++c) {
    if (moves_[c] && on_[c] != kNone) lay(c);
  }
  return packed.outcome;
}

bool Repacker::lies_on_pages(const Work& work) const {
  for (const SessionChart& chart : next_.charts) {
    const Vec2 tile = tile_of(page_of(chart));
    const Eigen::AlignedBox2d page(tile, Vec2(tile + Vec2::Ones()));
    for (Index f = 0; f < chart.faces(); ++f) {
      for (const Index v : chart.mesh().faces[f]) {
        if (!page.contains((*chart.uvs)[v])) return false;
      }
    }
  }
  return session_.check(work).injective();
}

Outcome Session::pack(std::span<const Index> ids, const PackOptions& options, const Work& work) {
  std::vector<bool> moves(state_.charts.size(), ids.empty());
  for (const Index c : indices_of(ids)) moves[c] = true;
  for (Index c = 0; c < size_of(state_.charts); ++c) {
    const SessionChart& chart = state_.charts[c];
    if (!chart.placed) {
      throw Error(Fault::kInvalidState, "a chart has no map yet: update the session first");
    }
    const std::vector<Index>& faces = chart.part->chart.input_face;
    const bool any_locked = std::any_of(faces.begin(), faces.begin() + chart.faces(),
                                        [&](Index f) { return bool(state_.locked[f]); });
    if (any_locked || !chart.pins.empty()) moves[c] = false;
  }
  if (std::find(moves.begin(), moves.end(), true) == moves.end()) {
    const Outcome verdict = check(work).injective() ? Outcome::kOk : Outcome::kNotInjective;
    changes_.clear();
    return verdict;
  }
  const bool some_stay = std::find(moves.begin(), moves.end(), false) != moves.end();
  const bool keeps_scale = std::any_of(
      state_.charts.begin(), state_.charts.end(),
      [&](const SessionChart& chart) { return (state_.flags_of(chart) & kKeepScale) != 0; });
  PackOptions own = options;
  if (some_stay) {
    own.texels_per_unit = 0;  // that of those which stay: sizes are kept
  } else if (keeps_scale) {
    own.texels_per_unit = options.resolution;  // a page is 1 wide
  }
  Repacker repacker(*this, std::move(moves));
  repacker.stack(work);
  try {
    const Outcome outcome = repacker.run(own, work);
    commit(repacker.result());
    return outcome;
  } catch (const Error& error) {
    if (error.fault() != Fault::kNoRoom) throw;
    if (some_stay && repacker.lies_on_pages(work)) {
      changes_.clear();
      return Outcome::kOk;
    }
    if (!some_stay && !keeps_scale) throw;
    // Neither texels per unit nor the resolution say how large they are.
    throw Error(
        Fault::kNoRoom,
        "the charts have no room at the size of those that stay, or keep their scale: raise "
        "max-pages, or let more of them move and be scaled",
        error.element());
  }
}

}  // namespace beltrami
