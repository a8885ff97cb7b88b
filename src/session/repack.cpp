// Packing the charts of a session, all or some of them.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
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
#include "session/session.h"
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

  Outcome run(PackOptions options, const Work& work);
  bool lies_on_pages(const Work& work) const;
  SessionState result() { return std::move(next_); }

 private:
  Index page_of(const SessionChart& chart) const;
  UvMesh mesh() const;
  void take(Index c, const PackedUvs& packed);

  const Session& session_;
  SessionState next_;
  const std::vector<bool> moves_;  // per chart
  std::vector<Index> first_uv_;
  Index uvs_ = 0;
};

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

UvMesh Repacker::mesh() const {
  UvMesh mesh;
  mesh.uvs.assign(uvs_, Vec2::Zero());
  mesh.faces.resize(session_.ground_.face_count());
  mesh.kept_page.assign(mesh.faces.size(), kNone);
  for (std::size_t c = 0; c < next_.charts.size(); ++c) {
    const SessionChart& chart = next_.charts[c];
    const Index page = moves_[c] ? kNone : page_of(chart);
    for (Index f = 0; f < chart.faces(); ++f) {
      const Index face = chart.part->chart.input_face[f];
      mesh.kept_page[face] = page;
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
}

Outcome Repacker::run(PackOptions options, const Work& work) {
  const PackedUvs packed = pack_uvs(mesh(), options, session_.float32_, work);
  for (Index c = 0; c < size_of(next_.charts); ++c) {
    if (moves_[c]) take(c, packed);
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
  for (const Index id : ids) moves[index_of(id)] = true;
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
  PackOptions own = options;
  if (some_stay) own.texels_per_unit = 0;  // that of those which stay: sizes are kept
  Repacker repacker(*this, std::move(moves));
  try {
    const Outcome outcome = repacker.run(own, work);
    commit(repacker.result());
    return outcome;
  } catch (const Error& error) {
    if (error.fault() != Fault::kNoRoom || !some_stay || !repacker.lies_on_pages(work)) throw;
    changes_.clear();
    return Outcome::kOk;
  }
}

}  // namespace beltrami
