// Pass-based half-edge collapse under a quadric error: Garland & Heckbert 1997, "Surface
// Simplification Using Quadric Error Metrics". Instead of a heap, each pass finds the cheapest
// collapse of every vertex, sorts, and collapses greedily. A collapse locks its two vertices for
// the rest of the pass: no other vertex has its quadric, its place or its list of faces changed,
// hence the costs of the candidates left stay exact, and the checks look at the faces as they are
// by then. (Locking the whole ring needs half as many passes again and came out no better.)
#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/quadric.h"
#include "simplify/shape.h"
#include "simplify/simplify.h"
#include "simplify/surface.h"
#include "simplify/sweep.h"

namespace beltrami {
namespace {

using Role = ShrinkingSurface::Role;

/// Share of the squared edge length added to the mean squared distance: in flat regions, where the
/// quadrics leave the choice open, short edges go first and the triangles stay even. At 1e-3 the
/// normals are 3% further off than at 1e-5, and the spread of the areas falls by a fifth to a half.
constexpr double kEvenness = 1e-3;

/// Collapses onto a vertex of more faces are not considered: one would cost as much as a pass.
constexpr Index kMaxTargetValence = 64;

/// How many targets of one vertex are tried in a pass; later ones cost too much to be wanted.
constexpr int kMaxAttempts = 3;

/// Vertices in a block. Blocks are simplified side by side; what reaches into another block comes
/// after them. Its borders do not depend on the number of threads, so the result does not either;
/// and they move from pass to pass, since vertices are renumbered.
constexpr Index kBlock = 16384;

/// Costs that tell which candidates are the cheaper half.
constexpr Index kSample = 20000;

/// Of a surface whose history is kept, sweeps lead to so many times the faces of the coarse one and
/// to this share of its own at least: further on it counts that costs remember what went before.
constexpr Index kSweptOfTarget = 8;
constexpr double kSweptShare = 1.0 / 16;
/// Above this share there is little to sweep.
constexpr double kWorthSweeping = 0.5;
constexpr double kSwept = 0.7;  // share of the progress

struct Candidate {
  double cost;
  Index vertex, target;

  bool operator<(const Candidate& other) const {
    return cost != other.cost ? cost < other.cost : vertex < other.vertex;
  }
};

// --- Candidates ---------------------------------------------------------------------------------

/// The cheapest unlocked target of v whose (cost, index) lies above that of `floor`, if any: else
/// the target is kNone. A boundary vertex moves along the loop only.
Candidate cheapest_collapse(const ShrinkingSurface& surface, Index v, const Candidate& floor) {
  Candidate best{std::numeric_limits<double>::infinity(), v, kNone};
  const Quadric& quadric = surface.quadric[v];
  const double evenness = kEvenness * quadric.weight();
  const Vec3& from = surface.position(v);
  const double own_error = surface.site[v].error;
  const auto consider = [&](Index target) {
    const auto& site = surface.site[target];
    const Vec3 d = site.position - from;
    // Rounding alone could make the moved error negative.
    const double moved = std::max(0.0, own_error + quadric.change(d));
    const double cost = moved + site.error + evenness * d.squaredNorm();
    const bool below_best = cost != best.cost ? cost < best.cost : target < best.target;
    if (!below_best) return;
    const bool above_floor = cost != floor.cost ? cost > floor.cost : target > floor.target;
    if (!above_floor || surface.locked[target] || surface.valence[target] > kMaxTargetValence) {
      return;
    }
    best = {cost, v, target};
  };
  if (surface.role[v] == Role::kInterior) {
    surface.for_each_corner(v, [&](Index, int, Index a, Index) { consider(a); });
  } else if (surface.role[v] == Role::kBoundary && surface.may_shorten(v)) {
    consider(surface.loop_next[v]);
    consider(surface.loop_previous[v]);
  }
  return best;
}

/// In the order of the vertices.
std::vector<Candidate> find_candidates(const ShrinkingSurface& surface, const Work& work) {
  const Candidate no_floor{-1, kNone, kNone};
  std::vector<Candidate> candidates;
  parallel_assign(work, candidates, surface.site.size());
  parallel_for(work, surface.vertex_count(), kBlock, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) {
      candidates[v] = cheapest_collapse(surface, static_cast<Index>(v), no_floor);
    }
  });
  std::erase_if(candidates, [](const Candidate& c) { return c.target == kNone; });
  return candidates;
}

// --- Checks -------------------------------------------------------------------------------------

/// The faces on the edge (one on the boundary, else two) and their corners opposite it.
struct EdgeFaces {
  Index count = 0;
  Index apex[2] = {kNone, kNone};

  bool has_apex(Index v) const { return v == apex[0] || v == apex[1]; }
};

EdgeFaces faces_of_edge(const ShrinkingSurface& surface, Index v, Index target) {
  EdgeFaces edge;
  surface.for_each_corner(v, [&](Index, int, Index a, Index b) {
    if (a == target) edge.apex[edge.count++] = b;
    if (b == target) edge.apex[edge.count++] = a;
  });
  return edge;
}

/// Whether the collapse keeps the topology: the link condition, no vertex of too few faces and no
/// new interior edge between boundary vertices.
bool keeps_topology(ShrinkingSurface& surface, Index v, Index target) {
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
  if (new_bridge && surface.role[v] == Role::kInterior && surface.on_boundary(target)) return false;

  Index common = 0;
  surface.for_each_neighbour(target, [&](Index u) { common += surface.mark[u] == v; });
  return common == edge.count;
}

// --- Collapses ----------------------------------------------------------------------------------

/// What a collapse renames: the neighbours of v that are none of the target's. By the link
/// condition those that are both have a face with the edge.
void record(const ShrinkingSurface& surface, Index v, Index target, CollapseHistory& history) {
  const EdgeFaces edge = faces_of_edge(surface, v, target);
  const std::vector<Index>& fine = surface.fine_vertex;
  const auto apex = [&](Index i) { return i < edge.count ? fine[edge.apex[i]] : kNone; };
  history.steps.push_back({fine[v], fine[target], {apex(0), apex(1)}, size_of(history.renamed)});
  surface.for_each_neighbour(v, [&](Index u) {
    if (u != target && !edge.has_apex(u)) history.renamed.push_back(fine[u]);
  });
}

/// Returns the number of faces that go.
Index collapse(ShrinkingSurface& surface, Index v, Index target) {
  surface.locked[v] = surface.locked[target] = true;
  Index gone = 0;

  for (Index i = surface.fan_start[v]; i < surface.fan_start[v + 1]; ++i) {
    Triangle& face = surface.faces[surface.fan[i] / 3];
    if (face[0] == kNone) continue;
    if (std::find(face.begin(), face.end(), target) == face.end()) {
      face[surface.fan[i] % 3] = target;
      ++surface.valence[target];
    } else {
      for (const Index u : face) --surface.valence[u];
      face[0] = kNone;
      ++gone;
    }
  }
  const Vec3 d = surface.position(target) - surface.position(v);
  surface.site[target].error += std::max(0.0, surface.site[v].error + surface.quadric[v].change(d));
  surface.quadric[target] += surface.quadric[v].seen_from(d);
  if (surface.on_boundary(v)) {
    const Index next = surface.loop_next[v], previous = surface.loop_previous[v];
    surface.loop_next[previous] = next;
    surface.loop_previous[next] = previous;
    --surface.loop_size[surface.loop(v)];
  }
  surface.role[v] = Role::kRemoved;
  surface.collapsed_into[surface.fine_vertex[v]] = surface.fine_vertex[target];
  return gone;
}

/// The vertices of a block, or all.
struct Range {
  Index begin, end;

  bool has(Index v) const { return v >= begin && v < end; }
  /// Whether a collapse of v onto the target, both inside, looks at and changes nothing outside.
  bool has_all_of(const ShrinkingSurface& surface, Index v, Index target) const {
    bool inside = true;
    surface.for_each_neighbour(v, [&](Index u) { inside &= has(u); });
    surface.for_each_neighbour(target, [&](Index u) { inside &= has(u); });
    return inside;
  }
};

enum class Outcome { kCollapsed, kRefused, kReachesOut };

/// What candidates came to.
struct Collapses {
  Index vertices = 0, faces = 0;
  std::vector<Candidate> reaching_out;
  CollapseHistory history;  ///< where it is asked for
};

/// Tries the candidate, then the next cheapest targets of its vertex up to `max_cost`, if all that
/// it touches is in the range.
Outcome try_collapse(ShrinkingSurface& surface, Candidate candidate, double max_cost,
                     const ShapeLimits& limits, const Range* range, Collapses& done) {
  const Index v = candidate.vertex;
  // Not even a look at what another thread may be changing.
  if (range && !range->has(candidate.target)) return Outcome::kReachesOut;
  if (surface.locked[v] || surface.locked[candidate.target]) return Outcome::kRefused;
  if (surface.on_boundary(v)) {
    if (range) return Outcome::kReachesOut;  // the loop is everybody's
    if (!surface.may_shorten(v)) return Outcome::kRefused;
  }
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    if (range && !range->has_all_of(surface, v, candidate.target)) return Outcome::kReachesOut;
    if (keeps_topology(surface, v, candidate.target) &&
        keeps_shape(surface, v, candidate.target, limits)) {
      if (surface.keeps_history) record(surface, v, candidate.target, done.history);
      done.faces += collapse(surface, v, candidate.target);
      ++done.vertices;
      return Outcome::kCollapsed;
    }
    candidate = cheapest_collapse(surface, v, candidate);
    if (candidate.target == kNone || candidate.cost > max_cost) return Outcome::kRefused;
  }
  return Outcome::kRefused;
}

/// Collapses candidates from the cheapest on. With a range, those that reach out of it are kept for
/// later.
Collapses collapse_in_order(ShrinkingSurface& surface, std::vector<Candidate>& candidates,
                            double max_cost, Index target_faces, const ShapeLimits& limits,
                            const Range* range) {
  std::sort(candidates.begin(), candidates.end());
  Collapses done;
  for (const Candidate& candidate : candidates) {
    if (!range && surface.live_faces - done.faces <= target_faces) break;
    const Outcome outcome = try_collapse(surface, candidate, max_cost, limits, range, done);
    if (outcome == Outcome::kReachesOut) done.reaching_out.push_back(candidate);
  }
  return done;
}

/// Collapses those candidates that cost at most `max_cost` and more than `min_cost`. Returns how
/// many took place.
Index collapse_between(ShrinkingSurface& surface, const std::vector<Candidate>& candidates,
                       double min_cost, double max_cost, Index target_faces,
                       const ShapeLimits& limits, const Work& work) {
  poll_interrupt();
  const Index count = surface.vertex_count(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<std::vector<Candidate>> of_block(blocks);
  Index most = 0;
  for (const Candidate& c : candidates) {
    if (!(c.cost > min_cost) || c.cost > max_cost) continue;
    of_block[c.vertex / kBlock].push_back(c);
    ++most;
  }
  std::vector<Candidate> rest;
  Index collapsed = 0;
  // Blocks do not know when the target is reached: near it all goes in one order. A collapse takes
  // two faces.
  if (blocks > 1 && surface.live_faces - 2 * std::int64_t{most} > target_faces) {
    std::vector<Collapses> done(blocks);
    parallel_for(work, blocks, 1, [&](std::int64_t block, std::int64_t) {
      const auto begin = static_cast<Index>(block) * kBlock;
      const Range range{begin, std::min(begin + kBlock, count)};
      done[block] =
          collapse_in_order(surface, of_block[block], max_cost, target_faces, limits, &range);
    });
    for (const Collapses& d : done) {
      collapsed += d.vertices;
      surface.live_faces -= d.faces;
      rest.insert(rest.end(), d.reaching_out.begin(), d.reaching_out.end());
      surface.history.append(d.history);
    }
  } else {
    for (const auto& block : of_block) rest.insert(rest.end(), block.begin(), block.end());
  }
  poll_interrupt();
  const Collapses last = collapse_in_order(surface, rest, max_cost, target_faces, limits, nullptr);
  surface.live_faces -= last.faces;
  surface.history.append(last.history);
  return collapsed + last.vertices;
}

/// One pass over the cheaper half of the candidates, or all of them if the half barely helps.
/// Returns whether another one like it is worth its time.
bool run_pass(ShrinkingSurface& surface, Index target_faces, const ShapeLimits& limits,
              const Work& work) {
  begin_pass(surface, work);
  const std::vector<Candidate> candidates = find_candidates(surface, work);
  if (candidates.empty()) return false;
  const Index count = size_of(candidates);
  const Index worthwhile = 1 + static_cast<Index>(limits.min_progress * count);
  // The middle of a sample splits large lists well enough.
  const Index stride = 1 + count / kSample;
  std::vector<double> costs;
  for (Index i = 0; i < count; i += stride) costs.push_back(candidates[i].cost);
  const auto middle = costs.begin() + (size_of(costs) - 1) / 2;
  std::nth_element(costs.begin(), middle, costs.end());
  const auto run = [&](double min_cost, double max_cost) {
    return collapse_between(surface, candidates, min_cost, max_cost, target_faces, limits, work);
  };
  constexpr double kAny = std::numeric_limits<double>::infinity();
  Index collapsed = run(-1, *middle);
  if (collapsed < worthwhile) collapsed += run(*middle, kAny);
  return collapsed >= worthwhile;
}

void run_passes(ShrinkingSurface& surface, Index target_faces, const Work& work) {
  const Index start = surface.live_faces;
  for (const ShapeLimits& limits : kShapeLimits) {
    while (surface.live_faces > target_faces) {
      work.report(double(start - surface.live_faces) / double(start - target_faces));
      if (!run_pass(surface, target_faces, limits, work)) break;
    }
  }
  compact(surface, work);
}

// --- Surfaces -----------------------------------------------------------------------------------

VertexLoops vertices_of(const Surface& surface, const BoundaryLoops& loops) {
  VertexLoops vertices(loops.count());
  for (Index i = 0; i < loops.count(); ++i) {
    for (Index k = loops.start[i]; k < loops.start[i + 1]; ++k) {
      vertices[i].push_back(surface.origin(loops.halfedge[k]));
    }
  }
  return vertices;
}

CoarseSurface simplify_surface_in_passes(const Surface& fine, const VertexLoops& loops,
                                         Index target_faces, const Work& work) {
  ShrinkingSurface surface = make_surface(fine, loops, work);
  surface.keeps_history = true;
  surface.fine_face.resize(surface.faces.size());
  std::iota(surface.fine_face.begin(), surface.fine_face.end(), 0);
  run_passes(surface, target_faces, work);
  std::vector<Vec3> positions;
  positions.reserve(surface.fine_vertex.size());
  for (const Index v : surface.fine_vertex) positions.push_back(fine.positions[v]);
  CoarseSurface coarse;
  coarse.mesh = build_surface(std::move(positions), std::move(surface.faces), work);
  coarse.fine_vertex = std::move(surface.fine_vertex);
  coarse.fine_face = std::move(surface.fine_face);
  coarse.history = std::move(surface.history);
  return coarse;
}

/// The coarse surface of a level as that of what the level was made of.
CoarseSurface followed_by(const CoarseSurface& level, CoarseSurface coarse) {
  const auto vertex = [&](Index v) { return v == kNone ? kNone : level.fine_vertex[v]; };
  for (Index& v : coarse.fine_vertex) v = level.fine_vertex[v];
  for (Index& f : coarse.fine_face) f = level.fine_face[f];
  for (Index& v : coarse.history.renamed) v = level.fine_vertex[v];
  for (CollapseHistory::Step& step : coarse.history.steps) {
    step.vertex = vertex(step.vertex);
    step.target = vertex(step.target);
    for (Index& v : step.apexes) v = vertex(v);
  }
  CollapseHistory whole = level.history;
  whole.append(coarse.history);
  coarse.history = std::move(whole);
  return coarse;
}

}  // namespace

CoarseDisk simplify_in_passes(const DiskMesh& fine, Index target_faces, const Work& work) {
  if (target_faces >= fine.face_count()) return whole_disk(fine);
  ShrinkingSurface surface = make_surface(fine, {fine.boundary}, work);
  run_passes(surface, target_faces, work);
  return coarse_disk(fine, std::move(surface.fine_vertex), std::move(surface.faces),
                     std::move(surface.collapsed_into), work);
}

CoarseSurface simplify_surface(const Surface& fine, const BoundaryLoops& loops, Index target_faces,
                               const Work& work) {
  const auto swept =
      std::max(static_cast<Index>(kSweptShare * fine.face_count()), kSweptOfTarget * target_faces);
  if (swept > kWorthSweeping * fine.face_count()) {
    return simplify_surface_in_passes(fine, vertices_of(fine, loops), target_faces, work);
  }
  const CoarseSurface level = sweep_surface(fine, swept, work.part(0, kSwept));
  const VertexLoops left = vertices_of(level.mesh, boundary_loops(level.mesh, work));
  return followed_by(
      level, simplify_surface_in_passes(level.mesh, left, target_faces, work.part(kSwept, 1)));
}

}  // namespace beltrami
