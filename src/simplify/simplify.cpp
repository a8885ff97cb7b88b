// Pass-based half-edge collapse under a quadric error: Garland & Heckbert 1997, "Surface
// Simplification Using Quadric Error Metrics". Instead of a heap, each pass finds the cheapest
// collapse of every vertex, sorts, and collapses greedily while it locks the rings it touches, so
// that nothing a candidate was computed from changes under it. Flat arrays throughout.
#include "simplify/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "simplify/quadric.h"

namespace beltrami {
namespace {

/// The loop keeps at least this many vertices (or all it has): fewer leave the flattened boundary
/// too little freedom.
constexpr Index kMinBoundary = 8;

/// A boundary edge weighs as much as a plane of this many times its squared length.
constexpr double kBoundaryWeight = 10;

/// Share of the squared edge length added to the mean squared distance: in flat regions, where the
/// quadrics leave the choice open, short edges go first and the triangles stay even.
constexpr double kEvenness = 1e-4;

/// A ring vertex with more faces than this is not locked, or a fan would shrink by one vertex a
/// pass. Its own face list stays valid, since collapses around it edit the faces in place.
constexpr Index kHubValence = 24;

/// Collapses onto a vertex of more faces are not considered: one would cost as much as a pass.
constexpr Index kMaxTargetValence = 64;

/// How many targets of one vertex are tried in a pass; later ones cost too much to be wanted.
constexpr int kMaxAttempts = 3;

/// Candidates between two checkpoints.
constexpr Index kCheckpointStride = 50000;

enum Role : std::uint8_t { kInterior, kBoundary, kFixedBoundary, kRemoved };

/// What a collapse may do to the shape of the faces around it.
struct ShapeLimits {
  double min_turn_cosine;    ///< between the normals of a face before and after
  double min_quality;        ///< a face at least this good (1 is equilateral) is always accepted
  double min_quality_ratio;  ///< below that: the worst new face over the worst old one
};

/// Tried in order, each only when the one before lets no more collapses through. The quality is
/// relative, since an absolute bound stalls on meshes that are made of slivers.
constexpr ShapeLimits kShapeLimits[] = {
    {0.5, 0.3, 0.8},
    {0.2, 0.1, 0.4},
    {-0.5, 0.02, 0.1},
};

/// The surface between passes. Vertices and faces are compacted before each pass, in their order.
struct Surface {
  std::vector<Vec3> position;
  std::vector<Quadric> quadric;
  std::vector<std::uint8_t> role;
  std::vector<Index> loop_next, loop_previous;  ///< along the boundary; kNone inside
  std::vector<Index> fine_vertex;
  std::vector<Triangle> faces;  ///< a removed one has kNone as its first corner
  Index live_faces = 0;
  Index boundary_count = 0;
  Index min_boundary = 0;

  // Built for one pass.
  std::vector<Index> fan_start;  ///< per vertex: its first entry in `fan`
  std::vector<Index> fan;        ///< half-edges 3 * face + corner, by origin
  std::vector<Index> valence;    ///< live faces per vertex
  std::vector<Index> mark;       ///< scratch: the vertex whose ring was marked last
  std::vector<bool> locked;

  Index vertex_count() const { return size_of(position); }
  bool on_boundary(Index v) const { return role[v] == kBoundary || role[v] == kFixedBoundary; }
  Index min_valence(Index v) const { return on_boundary(v) ? 2 : 3; }

  /// Calls visit(face, corner, next vertex, previous vertex) for each live face of v.
  template <class Visit>
  void for_each_corner(Index v, Visit&& visit) const {
    for (Index i = fan_start[v]; i < fan_start[v + 1]; ++i) {
      const Index f = fan[i] / 3;
      const int k = fan[i] % 3;
      const Triangle& face = faces[f];
      if (face[0] != kNone) visit(f, k, face[next_corner(k)], face[previous_corner(k)]);
    }
  }

  template <class Visit>
  void for_each_neighbour(Index v, Visit&& visit) const {
    for_each_corner(v, [&](Index, int, Index a, Index) { visit(a); });
    if (on_boundary(v)) visit(loop_previous[v]);
  }
};

struct Candidate {
  double cost;
  Index vertex, target;

  bool operator<(const Candidate& other) const {
    return cost != other.cost ? cost < other.cost : vertex < other.vertex;
  }
};

// --- Set-up -------------------------------------------------------------------------------------

/// One boundary vertex strictly between two positions of the loop, nearest the middle by length.
Index middle_of_loop(const DiskMesh& mesh, Index begin, Index end) {
  const Index count = size_of(mesh.boundary);
  const auto edge_length = [&](Index i) {
    const Vec3& from = mesh.positions[mesh.boundary[i % count]];
    return (mesh.positions[mesh.boundary[(i + 1) % count]] - from).norm();
  };
  double total = 0;
  for (Index i = begin; i < end; ++i) total += edge_length(i);
  Index middle = begin + 1;
  double before = edge_length(begin);
  while (middle + 1 < end && before + 0.5 * edge_length(middle) < 0.5 * total) {
    before += edge_length(middle++);
  }
  return mesh.boundary[middle % count];
}

/// Marks the boundary vertices that stay: ear tips, bridge ends, and one vertex between bridge ends
/// that follow each other on the loop, else the patch behind the bridge could lose all its width.
void fix_boundary(const DiskMesh& mesh, std::vector<std::uint8_t>& role) {
  std::vector<bool> bridge_end(mesh.vertex_count(), false);
  for (Index h = 0; h < size_of(mesh.twin); ++h) {
    const Index from = mesh.origin(h), to = mesh.target(h);
    if (mesh.twin[h] == kNone || !mesh.on_boundary[from] || !mesh.on_boundary[to]) continue;
    bridge_end[from] = bridge_end[to] = true;
  }
  std::vector<Index> ends;  // positions on the loop
  for (Index i = 0; i < size_of(mesh.boundary); ++i) {
    const Index v = mesh.boundary[i];
    role[v] = kBoundary;
    if (bridge_end[v]) ends.push_back(i);
    const bool ear_tip = mesh.rotate(mesh.outgoing[v]) == kNone;
    if (bridge_end[v] || ear_tip) role[v] = kFixedBoundary;
  }
  for (Index e = 0; e < size_of(ends); ++e) {
    const bool last = e + 1 == size_of(ends);
    const Index end = last ? ends.front() + size_of(mesh.boundary) : ends[e + 1];
    if (end - ends[e] > 1) role[middle_of_loop(mesh, ends[e], end)] = kFixedBoundary;
  }
}

/// The planes of the faces, weighted by area, and through each boundary edge one across its face.
void add_face_quadrics(const DiskMesh& mesh, Surface& surface) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Triangle& face = mesh.faces[f];
    const Vec3& p = mesh.positions[face[0]];
    const Vec3 area_normal = (mesh.positions[face[1]] - p).cross(mesh.positions[face[2]] - p);
    const double twice_area = area_normal.norm();
    // A degenerate face has no plane: its vertices cost nothing and go first.
    if (!(twice_area > 0)) continue;
    const Vec3 normal = area_normal / twice_area;
    for (const Index v : face) surface.quadric[v].add_plane(normal, 0.5 * twice_area);
    for (int k = 0; k < 3; ++k) {
      if (mesh.twin[3 * f + k] != kNone) continue;
      const Index from = face[k], to = face[next_corner(k)];
      const Vec3 edge = mesh.positions[to] - mesh.positions[from];
      const Vec3 across = normal.cross(edge);
      const double length = across.norm();
      if (!(length > 0)) continue;
      const double weight = kBoundaryWeight * length * length;
      surface.quadric[from].add_plane(across / length, weight);
      surface.quadric[to].add_plane(across / length, weight);
    }
  }
}

Surface make_surface(const DiskMesh& mesh) {
  const Index vertex_count = mesh.vertex_count();
  Surface surface;
  surface.position = mesh.positions;
  surface.quadric.resize(vertex_count);
  surface.role.assign(vertex_count, kInterior);
  surface.loop_next.assign(vertex_count, kNone);
  surface.loop_previous.assign(vertex_count, kNone);
  surface.fine_vertex.resize(vertex_count);
  for (Index v = 0; v < vertex_count; ++v) surface.fine_vertex[v] = v;
  surface.faces = mesh.faces;
  surface.live_faces = mesh.face_count();
  surface.boundary_count = size_of(mesh.boundary);
  surface.min_boundary = std::min(surface.boundary_count, kMinBoundary);
  for (Index i = 0; i < size_of(mesh.boundary); ++i) {
    const Index v = mesh.boundary[i];
    const Index next = mesh.boundary[i + 1 == size_of(mesh.boundary) ? 0 : i + 1];
    surface.loop_next[v] = next;
    surface.loop_previous[next] = v;
  }
  fix_boundary(mesh, surface.role);
  add_face_quadrics(mesh, surface);
  return surface;
}

// --- Between passes -----------------------------------------------------------------------------

/// Drops removed faces and vertices, keeping the order of the others.
void compact(Surface& surface) {
  std::vector<Index> renumbered(surface.vertex_count(), kNone);
  Index kept = 0;
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (surface.role[v] == kRemoved) continue;
    renumbered[v] = kept;
    surface.position[kept] = surface.position[v];
    surface.quadric[kept] = surface.quadric[v];
    surface.role[kept] = surface.role[v];
    surface.loop_next[kept] = surface.loop_next[v];
    surface.loop_previous[kept] = surface.loop_previous[v];
    surface.fine_vertex[kept] = surface.fine_vertex[v];
    ++kept;
  }
  surface.position.resize(kept);
  surface.quadric.resize(kept);
  surface.role.resize(kept);
  surface.loop_next.resize(kept);
  surface.loop_previous.resize(kept);
  surface.fine_vertex.resize(kept);
  for (Index v = 0; v < kept; ++v) {
    if (!surface.on_boundary(v)) continue;
    surface.loop_next[v] = renumbered[surface.loop_next[v]];
    surface.loop_previous[v] = renumbered[surface.loop_previous[v]];
  }
  std::erase_if(surface.faces, [](const Triangle& face) { return face[0] == kNone; });
  for (Triangle& face : surface.faces) {
    for (Index& v : face) v = renumbered[v];
  }
}

/// Lists the half-edges of each vertex by counting sort and clears the state of the last pass.
void begin_pass(Surface& surface) {
  compact(surface);
  const Index vertex_count = surface.vertex_count();
  surface.valence.assign(vertex_count, 0);
  for (const Triangle& face : surface.faces) {
    for (const Index v : face) ++surface.valence[v];
  }
  surface.fan_start.resize(vertex_count + 1);
  Index total = 0;
  for (Index v = 0; v < vertex_count; ++v) {
    surface.fan_start[v] = total;
    total += surface.valence[v];
  }
  surface.fan_start[vertex_count] = total;
  surface.fan.resize(total);
  // `mark` serves as the cursor first.
  surface.mark.assign(surface.fan_start.begin(), surface.fan_start.end() - 1);
  for (Index f = 0; f < size_of(surface.faces); ++f) {
    for (int k = 0; k < 3; ++k) surface.fan[surface.mark[surface.faces[f][k]]++] = 3 * f + k;
  }
  surface.mark.assign(vertex_count, kNone);
  surface.locked.assign(vertex_count, false);
}

// --- Candidates ---------------------------------------------------------------------------------

double collapse_cost(const Surface& surface, Index v, Index target) {
  const Vec3 d = surface.position[target] - surface.position[v];
  const Quadric& quadric = surface.quadric[v];
  return quadric.at(d) + surface.quadric[target].c + kEvenness * quadric.weight() * d.squaredNorm();
}

/// The cheapest unlocked target of v whose (cost, index) lies above that of `floor`, if any: else
/// the target is kNone. A boundary vertex moves along the loop only.
Candidate cheapest_collapse(const Surface& surface, Index v, const Candidate& floor) {
  Candidate best{std::numeric_limits<double>::infinity(), v, kNone};
  const auto consider = [&](Index target) {
    if (surface.locked[target] || surface.valence[target] > kMaxTargetValence) return;
    const double cost = collapse_cost(surface, v, target);
    const bool above_floor = cost != floor.cost ? cost > floor.cost : target > floor.target;
    const bool below_best = cost != best.cost ? cost < best.cost : target < best.target;
    if (above_floor && below_best) best = {cost, v, target};
  };
  if (surface.role[v] == kInterior) {
    surface.for_each_neighbour(v, consider);
  } else if (surface.role[v] == kBoundary && surface.boundary_count > surface.min_boundary) {
    consider(surface.loop_next[v]);
    consider(surface.loop_previous[v]);
  }
  return best;
}

std::vector<Candidate> find_candidates(const Surface& surface, const std::function<void()>& tick) {
  const Candidate no_floor{-1, kNone, kNone};
  std::vector<Candidate> candidates;
  candidates.reserve(surface.vertex_count());
  for (Index v = 0; v < surface.vertex_count(); ++v) {
    if (v % kCheckpointStride == 0) tick();
    const Candidate candidate = cheapest_collapse(surface, v, no_floor);
    if (candidate.target != kNone) candidates.push_back(candidate);
  }
  return candidates;
}

// --- Checks -------------------------------------------------------------------------------------

/// The faces on the edge (one on the boundary, else two) and their corners opposite it.
struct EdgeFaces {
  Index count = 0;
  Index apex[2] = {kNone, kNone};

  bool has_apex(Index v) const { return v == apex[0] || v == apex[1]; }
};

EdgeFaces faces_of_edge(const Surface& surface, Index v, Index target) {
  EdgeFaces edge;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    if (a == target) edge.apex[edge.count++] = b;
    if (b == target) edge.apex[edge.count++] = a;
  });
  return edge;
}

/// Whether the collapse keeps a disk: the link condition, no vertex of too few faces and no new
/// interior edge between boundary vertices.
bool keeps_topology(Surface& surface, Index v, Index target) {
  const EdgeFaces edge = faces_of_edge(surface, v, target);
  for (Index i = 0; i < edge.count; ++i) {
    const Index apex = edge.apex[i];
    if (surface.valence[apex] - 1 < surface.min_valence(apex)) return false;
  }
  const Index merged = surface.valence[v] + surface.valence[target] - 2 * edge.count;
  if (merged < surface.min_valence(target)) return false;

  bool new_bridge = false;
  surface.for_each_neighbour(v, [&](Index u) {
    surface.mark[u] = v;
    new_bridge |= surface.on_boundary(u) && u != target && !edge.has_apex(u);
  });
  // A boundary vertex that may move is no bridge end, so that its ring brings none along.
  if (new_bridge && surface.role[v] == kInterior && surface.on_boundary(target)) return false;

  Index common = 0;
  surface.for_each_neighbour(target, [&](Index u) { common += surface.mark[u] == v; });
  return common == edge.count;
}

/// Area over the sum of squared edge lengths, scaled to 1 for an equilateral triangle.
double shape_quality(double twice_area, double squared_lengths) {
  return squared_lengths > 0 ? 3.4641016151377544 * twice_area / squared_lengths : 0;
}

bool keeps_shape(const Surface& surface, Index v, Index target, const ShapeLimits& limits) {
  const Vec3& from = surface.position[v];
  const Vec3& to = surface.position[target];
  Vec3 fan_normal = Vec3::Zero();
  double worst_before = 1;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    const Vec3 u = surface.position[a] - from, w = surface.position[b] - from;
    const Vec3 normal = u.cross(w);
    fan_normal += normal;
    const double lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    worst_before = std::min(worst_before, shape_quality(normal.norm(), lengths));
  });
  const double worst_allowed =
      std::min(limits.min_quality, limits.min_quality_ratio * worst_before);

  bool kept = true;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    if (!kept || a == target || b == target) return;
    const Vec3& pa = surface.position[a];
    const Vec3& pb = surface.position[b];
    const Vec3 u = pa - to, w = pb - to;
    const Vec3 after = u.cross(w);
    const double twice_area = after.norm();
    const double lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    Vec3 before = (pa - from).cross(pb - from);
    double before_norm = before.norm();
    // A degenerate face has no normal of its own to keep.
    if (!(before_norm > 0)) {
      before = fan_normal;
      before_norm = before.norm();
    }
    kept = shape_quality(twice_area, lengths) >= worst_allowed &&
           before.dot(after) >= limits.min_turn_cosine * before_norm * twice_area;
  });
  return kept;
}

// --- Collapses ----------------------------------------------------------------------------------

void collapse(Surface& surface, Index v, Index target) {
  surface.for_each_neighbour(v, [&](Index u) {
    if (surface.valence[u] <= kHubValence) surface.locked[u] = true;
  });
  surface.locked[v] = surface.locked[target] = true;

  for (Index i = surface.fan_start[v]; i < surface.fan_start[v + 1]; ++i) {
    Triangle& face = surface.faces[surface.fan[i] / 3];
    if (face[0] == kNone) continue;
    if (std::find(face.begin(), face.end(), target) == face.end()) {
      face[surface.fan[i] % 3] = target;
      ++surface.valence[target];
    } else {
      for (const Index u : face) --surface.valence[u];
      face[0] = kNone;
      --surface.live_faces;
    }
  }
  surface.quadric[target] +=
      surface.quadric[v].seen_from(surface.position[target] - surface.position[v]);
  if (surface.on_boundary(v)) {
    const Index next = surface.loop_next[v], previous = surface.loop_previous[v];
    surface.loop_next[previous] = next;
    surface.loop_previous[next] = previous;
    --surface.boundary_count;
  }
  surface.role[v] = kRemoved;
}

/// Tries the candidate, then the next cheapest targets of its vertex below `max_cost`.
bool try_collapse(Surface& surface, Candidate candidate, double max_cost,
                  const ShapeLimits& limits) {
  const Index v = candidate.vertex;
  if (surface.locked[v] || surface.locked[candidate.target]) return false;
  if (surface.on_boundary(v) && surface.boundary_count <= surface.min_boundary) return false;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    if (keeps_topology(surface, v, candidate.target) &&
        keeps_shape(surface, v, candidate.target, limits)) {
      collapse(surface, v, candidate.target);
      return true;
    }
    candidate = cheapest_collapse(surface, v, candidate);
    if (candidate.target == kNone || candidate.cost > max_cost) return false;
  }
  return false;
}

/// Collapses the candidates [begin, end), which it sorts. Returns how many took place.
Index collapse_in_order(Surface& surface, std::vector<Candidate>& candidates, Index begin,
                        Index end, Index target_faces, const ShapeLimits& limits,
                        const std::function<void()>& tick) {
  std::sort(candidates.begin() + begin, candidates.begin() + end);
  const double max_cost = candidates[end - 1].cost;
  Index collapsed = 0;
  for (Index i = begin; i < end && surface.live_faces > target_faces; ++i) {
    if (i % kCheckpointStride == 0) tick();
    collapsed += try_collapse(surface, candidates[i], max_cost, limits);
  }
  return collapsed;
}

/// One pass over the cheaper half of the candidates, or all of them if the half barely helps.
Index run_pass(Surface& surface, Index target_faces, const ShapeLimits& limits, Index worthwhile,
               const std::function<void()>& tick) {
  begin_pass(surface);
  std::vector<Candidate> candidates = find_candidates(surface, tick);
  if (candidates.empty()) return 0;
  const Index count = size_of(candidates);
  const Index half = (count + 1) / 2;
  std::nth_element(candidates.begin(), candidates.begin() + (half - 1), candidates.end());
  Index collapsed = collapse_in_order(surface, candidates, 0, half, target_faces, limits, tick);
  if (collapsed < worthwhile && half < count) {
    collapsed += collapse_in_order(surface, candidates, half, count, target_faces, limits, tick);
  }
  return collapsed;
}

void run_passes(Surface& surface, Index target_faces, const Checkpoint& checkpoint) {
  const Index start = surface.live_faces;
  const auto tick = [&] {
    checkpoint(double(start - surface.live_faces) / double(start - target_faces));
  };
  for (const ShapeLimits& limits : kShapeLimits) {
    while (surface.live_faces > target_faces) {
      // Passes that trickle would cost a full sweep for a handful of vertices.
      const Index worthwhile = 1 + surface.live_faces / 2000;
      if (run_pass(surface, target_faces, limits, worthwhile, tick) < worthwhile) break;
    }
  }
  compact(surface);
}

}  // namespace

CoarseDisk simplify(const DiskMesh& fine, Index target_faces, const Checkpoint& checkpoint) {
  Surface surface;
  CoarseDisk coarse;
  if (target_faces >= fine.face_count()) {
    coarse.mesh = fine;
    coarse.fine_vertex.resize(fine.vertex_count());
    for (Index v = 0; v < fine.vertex_count(); ++v) coarse.fine_vertex[v] = v;
    return coarse;
  }
  surface = make_surface(fine);
  run_passes(surface, target_faces, checkpoint);
  coarse.fine_vertex = std::move(surface.fine_vertex);
  try {
    coarse.mesh = build_disk(std::move(surface.position), std::move(surface.faces));
  } catch (const Error& error) {
    throw Error(
        BELTRAMI_E_INTERNAL,
        std::string("the simplified surface is not a disk, please report it: ") + error.what());
  }
  return coarse;
}

}  // namespace beltrami
