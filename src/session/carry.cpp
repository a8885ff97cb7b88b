#include "session/carry.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/sort_unique.h"
#include "base/types.h"
#include "exact/atlas_certificate.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "local/patch.h"
#include "local/untangle.h"
#include "mesh/disk_mesh.h"
#include "mesh/rest_shape.h"
#include "pins/similarity.h"
#include "repair/touching.h"

namespace beltrami {
namespace {

/// Rings around what is folded in which vertices move, tried one after the other. Two are enough
/// for a face that turned over at a sewn edge; where eight are not, a new map is as cheap.
constexpr int kRings[] = {2, 4, 8};

/// A chart made of parts that lay in charts of their own.
class Parts {
 public:
  Parts(const Ground& ground, const SessionState& before, const CornerUvs& uvs,
        const AtlasChart& part)
      : ground_(ground), before_(before), uvs_(uvs), part_(part) {
    std::map<Index, Index> number;
    for (Index f = 0; f < part.real_faces; ++f) {
      const Index chart = before.chart_of_face[part.chart.input_face[f]];
      const auto [at, is_new] = number.try_emplace(chart, size_of(charts_));
      if (is_new) {
        charts_.push_back(chart);
        faces_.push_back(0);
        is_held_.push_back(false);
      }
      part_of_.push_back(at->second);
      ++faces_[at->second];
      if (!before.may_move(part.chart.input_face[f])) is_held_[at->second] = true;
    }
  }

  bool all_placed() const {
    return std::all_of(charts_.begin(), charts_.end(),
                       [&](Index c) { return before_.charts[c].placed; });
  }

  /// The first of those that are held, or the largest.
  Index leader() const {
    Index best = 0;
    for (Index p = 1; p < size_of(charts_); ++p) {
      const bool more =
          is_held_[p] != is_held_[best] ? bool(is_held_[p]) : faces_[p] > faces_[best];
      if (more) best = p;
    }
    return best;
  }

  bool all_warm() const {
    return std::all_of(charts_.begin(), charts_.end(),
                       [&](Index c) { return before_.charts[c].due != Due::kCold; });
  }

  bool any_presses() const {
    return std::any_of(charts_.begin(), charts_.end(),
                       [&](Index c) { return before_.charts[c].presses; });
  }

  /// Of all parts, in the order of the pins of each.
  std::vector<MetPin> pins() const {
    std::vector<MetPin> all;
    for (const Index c : charts_) {
      for (const MetPin& pin : before_.charts[c].pins) {
        const Index own = ground_.own_corner(pin.corner / 3, pin.corner % 3);
        const std::vector<Index>& faces = part_.chart.input_face;
        const auto end = faces.begin() + part_.real_faces;
        if (own != kNone && std::binary_search(faces.begin(), end, own / 3)) all.push_back(pin);
      }
    }
    return all;
  }

  double scale() const { return before_.charts[charts_[leader()]].scale; }

  /// The vertices of the chart, with the parts around each as they lie once all are aligned.
  void align();
  void place(Carried& carried) const;

 private:
  struct Place {
    Index part, face;
    Vec2 uv;
  };
  void collect();

  const Ground& ground_;
  const SessionState& before_;
  const CornerUvs& uvs_;
  const AtlasChart& part_;
  std::vector<Index> charts_, faces_, part_of_;  // per part, per part, per face
  std::vector<bool> is_held_;
  std::vector<std::vector<Place>> places_;  // per vertex, different ones
};

void Parts::collect() {
  const DiskMesh& mesh = part_.chart.mesh;
  places_.assign(mesh.positions.size(), {});
  for (Index f = 0; f < part_.real_faces; ++f) {
    for (int k = 0; k < 3; ++k) {
      const Vec2& uv = uvs_[3 * part_.chart.input_face[f] + k];
      std::vector<Place>& known = places_[mesh.faces[f][k]];
      const bool is_known = std::any_of(known.begin(), known.end(), [&](const Place& place) {
        return place.part == part_of_[f] && place.uv == uv;
      });
      if (!is_known) known.push_back({part_of_[f], f, uv});
    }
  }
}

void Parts::align() {
  collect();
  std::vector<bool> aligned(charts_.size(), false);
  aligned[leader()] = true;
  PollSometimes poll;
  for (Index left = size_of(charts_) - 1; left > 0; --left) {
    // The part with the most vertices in common with those that lie already.
    std::vector<std::vector<std::pair<Vec2, Vec2>>> pairs(charts_.size());
    for (const std::vector<Place>& around : places_) {
      poll();
      if (around.size() < 2) continue;
      for (const Place& one : around) {
        if (!aligned[one.part]) continue;
        for (const Place& other : around) {
          if (!aligned[other.part]) pairs[other.part].emplace_back(other.uv, one.uv);
        }
      }
    }
    Index next = kNone;
    for (Index p = 0; p < size_of(charts_); ++p) {
      if (aligned[p]) continue;
      if (next == kNone || pairs[p].size() > pairs[next].size()) next = p;
    }
    aligned[next] = true;
    if (is_held_[next]) continue;
    const Similarity onto = fit_similarity(pairs[next], false);
    for (std::vector<Place>& around : places_) {
      poll();
      for (Place& place : around) {
        if (place.part == next) place.uv = onto(place.uv);
      }
    }
  }
}

void Parts::place(Carried& carried) const {
  const DiskMesh& mesh = part_.chart.mesh;
  carried.uvs.assign(mesh.positions.size(), Vec2::Zero());
  for (Index v = 0; v < size_of(places_); ++v) {
    const std::vector<Place>& around = places_[v];
    if (around.empty()) continue;
    Vec2& uv = carried.uvs[v];
    const Place* held = nullptr;
    for (const Place& place : around) {
      uv += place.uv / static_cast<double>(around.size());
      if (before_.may_move(part_.chart.input_face[place.face])) continue;
      if (held != nullptr && held->uv != place.uv) {
        const Index input = ground_.admitted.input_face[part_.chart.input_face[place.face]];
        const Index face = ground_.name_of(input);
        throw Error(Fault::kInvalidState,
                    "a seam is closed between faces that may not move, and their UVs lie apart: "
                    "unlock or select one side, or open the seam again",
                    Element::face(static_cast<std::uint64_t>(face)));
      }
      held = &place;
    }
    if (held != nullptr) uv = held->uv;
    if (around.size() == 1) uv = around[0].uv;
  }
}

/// The faces within some rings of vertices, increasing.
std::vector<Index> faces_around(const DiskMesh& mesh, std::vector<bool> near, int rings) {
  std::vector<Index> faces;
  for (int ring = 0; ring < rings; ++ring) {
    faces.clear();
    for (Index f = 0; f < mesh.face_count(); ++f) {
      const Triangle& face = mesh.faces[f];
      if (near[face[0]] || near[face[1]] || near[face[2]]) faces.push_back(f);
    }
    for (const Index f : faces) {
      for (const Index v : mesh.faces[f]) near[v] = true;
    }
  }
  return faces;
}

/// Unfolds a region around the vertices in which those of faces outside of it stay.
bool unfold_around(const DiskMesh& mesh, const std::vector<bool>& near, int rings,
                   const std::vector<bool>& held, std::vector<Vec2>& uvs, const Work& work) {
  std::vector<Index> region = faces_around(mesh, near, rings);
  std::vector<bool> inside(mesh.faces.size(), false), stays(uvs.size(), false);
  for (const Index f : region) inside[f] = true;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (inside[f]) continue;
    for (const Index v : mesh.faces[f]) stays[v] = true;
  }
  for (std::size_t v = 0; v < held.size(); ++v) {
    if (held[v]) stays[v] = true;
  }
  std::vector<Index> moving;
  for (const Index f : region) {
    for (const Index v : mesh.faces[f]) {
      if (!stays[v]) moving.push_back(v);
    }
  }
  sort_unique(moving);
  Patch patch = make_patch(mesh, {}, uvs, std::move(region), moving);
  std::vector<Vec3> positions;
  for (const Index v : patch.mesh_vertices) positions.push_back(mesh.positions[v]);
  patch.rest = rest_triangles(positions, patch.faces, work);
  if (!untangle(patch.faces, patch.rest, patch.fixed, patch.uvs, work)) return false;
  patch.exchange(uvs);
  return true;
}

}  // namespace

void place_virtual(const AtlasChart& part, std::vector<Vec2>& uvs) {
  const DiskMesh& mesh = part.chart.mesh;
  std::vector<bool> is_real(uvs.size(), false);
  for (Index f = 0; f < part.real_faces; ++f) {
    for (const Index v : mesh.faces[f]) is_real[v] = true;
  }
  for (Index v = 0; v < size_of(uvs); ++v) {
    if (is_real[v]) continue;
    Vec2 sum = Vec2::Zero();
    double count = 0;
    mesh.for_each_outgoing(v, [&](Index h) {
      sum += uvs[mesh.target(h)];
      ++count;
    });
    uvs[v] = sum / count;
  }
}

std::vector<bool> held_vertices(const SessionState& state, const AtlasChart& part) {
  std::vector<bool> held(part.chart.mesh.positions.size(), false);
  for (Index f = 0; f < part.real_faces; ++f) {
    if (state.may_move(part.chart.input_face[f])) continue;
    for (const Index v : part.chart.mesh.faces[f]) held[v] = true;
  }
  return held;
}

Carried carry(const Ground& ground, const SessionState& before, const CornerUvs& uvs,
              const AtlasChart& part) {
  Carried carried;
  Parts parts(ground, before, uvs, part);
  carried.scale = parts.scale();
  carried.placed = parts.all_placed();
  carried.warm = carried.placed && parts.all_warm();
  carried.presses = parts.any_presses();
  carried.pins = parts.pins();
  carried.uvs.assign(part.chart.mesh.positions.size(), Vec2::Zero());
  if (!carried.placed) return carried;
  parts.align();
  parts.place(carried);
  place_virtual(part, carried.uvs);
  return carried;
}

bool mend_start(const DiskMesh& mesh, const std::vector<bool>& held, std::vector<Vec2>& uvs,
                const Work& work) {
  std::vector<Index> folded = non_positive_faces(mesh.faces, uvs, work);
  if (!folded.empty()) {
    std::vector<bool> near(uvs.size(), false);
    for (const Index f : folded) {
      for (const Index v : mesh.faces[f]) near[v] = true;
    }
    bool mended = false;
    for (const int rings : kRings) {
      mended = mended || unfold_around(mesh, near, rings, held, uvs, work);
    }
    if (!mended || !non_positive_faces(mesh.faces, uvs, work).empty()) return false;
  }
  if (is_simple(mesh.boundary, uvs)) return true;
  const bool any_held = std::find(held.begin(), held.end(), true) != held.end();
  std::vector<Vec2> parted = uvs;
  const auto stays = [&] {
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (held[v] && parted[v] != uvs[v]) return false;
    }
    return true;
  };
  // The sides of a seam that has just been opened lie on each other.
  if (open_touching_sides(mesh, work, parted) && stays()) {
    uvs.swap(parted);
    return true;
  }
  return any_held && certify_atlas(mesh.faces, uvs, {}, work).injective();
}

}  // namespace beltrami
