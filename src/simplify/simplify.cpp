// Pass-based half-edge collapse under a quadric error: Garland & Heckbert 1997, "Surface
// Simplification Using Quadric Error Metrics". Instead of a heap, each pass finds the cheapest
// collapse of every vertex, sorts, and collapses greedily. A collapse locks its two vertices for
// the rest of the pass: no other vertex has its quadric, its place or its list of faces changed,
// hence the costs of the candidates left stay exact, and the checks look at the faces as they are
// by then. (Locking the whole ring needs half as many passes again and came out no better.)
#include <algorithm>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "mesh/disk_mesh.h"
#include "simplify/back_ends.h"
#include "simplify/blocks.h"
#include "simplify/history.h"
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

/// Blocks are simplified side by side, then pairs of them; what reaches into a third block comes
/// after them. There are at least so many where they need not be smaller than the least. Their
/// borders do not depend on the number of threads, so the result does not either; and they move
/// from pass to pass, since vertices are renumbered.
constexpr Index kBlocks = 24;

/// Collapses that are left to the target, below which all of them go in one order.
constexpr Index kFewCollapses = 256;

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

/// Those of a pass, block by block, in the order of the vertices.
struct Candidates {
  int shift;
  std::vector<std::vector<Candidate>> of_block;

  Index count() const {
    std::size_t sum = 0;
    for (const auto& block : of_block) sum += block.size();
    return static_cast<Index>(sum);
  }
};

/// Calls body(block) for each of them.
template <class Body>
void for_each_block(const Candidates& candidates, const Work& work, const Body& body) {
  parallel_for(work, size_of(candidates.of_block), 1,
               [&](std::int64_t block, std::int64_t) { body(static_cast<Index>(block)); });
}

Candidates find_candidates(const ShrinkingSurface& surface, const Work& work) {
  const Candidate no_floor{-1, kNone, kNone};
  const Index count = surface.vertex_count();
  const int shift = block_shift(count, kBlocks);
  Candidates candidates{shift, {}};
  candidates.of_block.resize(((count - 1) >> shift) + 1);
  for_each_block(candidates, work, [&](Index block) {
    std::vector<Candidate> found;
    const Index begin = block << shift, end = std::min((block + 1) << shift, count);
    for (Index v = begin; v < end; ++v) {
      const Candidate candidate = cheapest_collapse(surface, v, no_floor);
      if (candidate.target != kNone) found.push_back(candidate);
    }
    candidates.of_block[block] = std::move(found);
  });
  return candidates;
}

/// Those that cost at most `max_cost` and more than `min_cost`.
Candidates between(const Candidates& all, double min_cost, double max_cost, const Work& work) {
  Candidates chosen{all.shift, {}};
  chosen.of_block.resize(all.of_block.size());
  for_each_block(all, work, [&](Index block) {
    std::copy_if(all.of_block[block].begin(), all.of_block[block].end(),
                 std::back_inserter(chosen.of_block[block]),
                 [&](const Candidate& c) { return c.cost > min_cost && c.cost <= max_cost; });
  });
  return chosen;
}

/// The cost of every stride-th.
std::vector<double> sampled_costs(const Candidates& candidates, Index stride) {
  std::vector<double> costs;
  Index skip = 0;
  for (const auto& block : candidates.of_block) {
    for (; skip < size_of(block); skip += stride) costs.push_back(block[skip].cost);
    skip -= size_of(block);
  }
  return costs;
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

/// A vertex outside that a collapse of v onto the target, both inside, looks at or changes, or
/// kNone.
Index vertex_outside(const ShrinkingSurface& surface, Index v, Index target,
                     const Territory& territory) {
  Index outside = kNone;
  const auto look_at = [&](Index u) {
    if (!territory.has(u)) outside = u;
  };
  surface.for_each_neighbour(v, look_at);
  surface.for_each_neighbour(target, look_at);
  return outside;
}

/// What candidates came to.
struct Collapses {
  Index vertices = 0, faces = 0;
  CollapseHistory history;  ///< where it is asked for
};

/// Those left for later.
struct Left {
  ReachingOut<Candidate> reaching_out;
  std::vector<Candidate> of_boundary;  ///< whose loop is everybody's
};

/// What is asked of collapses.
struct Asked {
  double max_cost;
  Index target_faces;
  const ShapeLimits& limits;
};

/// Tries the candidate, then the next cheapest targets of its vertex up to `max_cost`. Returns
/// kNone, or where that reaches out of the territory a vertex there.
Index try_collapse(ShrinkingSurface& surface, Candidate candidate, const Asked& asked,
                   const Territory& territory, Collapses& done) {
  const Index v = candidate.vertex;
  // Not even a look at what another thread may be changing.
  if (!territory.has(candidate.target)) return candidate.target;
  if (surface.locked[v] || surface.locked[candidate.target]) return kNone;
  if (surface.on_boundary(v) && !surface.may_shorten(v)) return kNone;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const Index outside = vertex_outside(surface, v, candidate.target, territory);
    if (outside != kNone) return outside;
    if (keeps_topology(surface, v, candidate.target) &&
        keeps_shape(surface, v, candidate.target, asked.limits)) {
      if (surface.keeps_history) record(surface, v, candidate.target, done.history);
      done.faces += collapse(surface, v, candidate.target);
      ++done.vertices;
      return kNone;
    }
    candidate = cheapest_collapse(surface, v, candidate);
    if (candidate.target == kNone || candidate.cost > asked.max_cost) return kNone;
  }
  return kNone;
}

Index append(const Collapses& done, ShrinkingSurface& surface) {
  surface.live_faces -= done.faces;
  surface.history.append(done.history);
  return done.vertices;
}

/// Collapses candidates of a part of the surface from the cheapest on.
Left collapse_in_part(ShrinkingSurface& surface, std::vector<Candidate> candidates,
                      const Asked& asked, const Territory& territory, Collapses& done) {
  std::sort(candidates.begin(), candidates.end());
  Left left;
  for (const Candidate& candidate : candidates) {
    if (surface.on_boundary(candidate.vertex)) {
      left.of_boundary.push_back(candidate);
      continue;
    }
    const Index outside = try_collapse(surface, candidate, asked, territory, done);
    if (outside != kNone) left.reaching_out.add(territory.block_of(outside), candidate);
  }
  return left;
}

/// Collapses candidates anywhere from the cheapest on, until the target is reached.
Collapses collapse_in_order(ShrinkingSurface& surface, std::vector<Candidate> candidates,
                            const Asked& asked) {
  std::sort(candidates.begin(), candidates.end());
  Collapses done;
  PollSometimes poll;
  for (const Candidate& candidate : candidates) {
    poll();
    if (surface.live_faces - done.faces <= asked.target_faces) break;
    try_collapse(surface, candidate, asked, Territory::all(), done);
  }
  return done;
}

void add_to(std::vector<Candidate>& all, const std::vector<Candidate>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Collapses candidates, too few to pass the target, in parts side by side. Returns how many took
/// place; adds to `rest` those that reach out of two blocks.
Index collapse_in_parts(ShrinkingSurface& surface, Candidates candidates, const Asked& asked,
                        const Work& work, std::vector<Candidate>& rest) {
  const std::size_t blocks = candidates.of_block.size();
  std::vector<Collapses> of_block(blocks);
  std::vector<ReachingOut<Candidate>> reaching_out(blocks);
  std::vector<std::vector<Candidate>> of_boundary(blocks);
  for_each_block(candidates, work, [&](Index block) {
    Left left = collapse_in_part(surface, std::move(candidates.of_block[block]), asked,
                                 Territory::of_block(candidates.shift, block), of_block[block]);
    reaching_out[block] = std::move(left.reaching_out);
    of_boundary[block] = std::move(left.of_boundary);
  });
  Index collapsed = 0;
  for (const Collapses& done : of_block) collapsed += append(done, surface);
  for (const auto& pairs : rounds_of_pairs(reaching_out)) {
    std::vector<Collapses> of_pair(pairs.size());
    std::vector<Left> left(pairs.size());
    parallel_for(work, size_of(pairs), 1, [&](std::int64_t p, std::int64_t) {
      std::vector<Candidate> both;
      for (const auto* items : pairs[p].items) add_to(both, *items);
      left[p] = collapse_in_part(surface, std::move(both), asked,
                                 Territory::of_pair(candidates.shift, pairs[p].one, pairs[p].other),
                                 of_pair[p]);
    });
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      collapsed += append(of_pair[p], surface);
      for (const auto& into : left[p].reaching_out.into()) add_to(rest, into.items);
    }
  }
  for (const auto& boundary : of_boundary) add_to(rest, boundary);
  return collapsed;
}

/// Collapses those candidates that cost at most `max_cost` and more than `min_cost`. Returns how
/// many took place.
Index collapse_between(ShrinkingSurface& surface, const Candidates& candidates, double min_cost,
                       double max_cost, Index target_faces, const ShapeLimits& limits,
                       const Work& work) {
  Index collapsed = 0;
  double from = min_cost;
  while (surface.live_faces > target_faces) {
    poll_interrupt();
    Candidates chosen = between(candidates, from, max_cost, work);
    Asked asked{max_cost, target_faces, limits};
    // Parts do not know when the target is reached. A collapse takes two faces.
    const Index most = (surface.live_faces - target_faces) / 2;
    const bool too_many = chosen.count() > most;
    if (too_many && most > kFewCollapses) {
      std::vector<double> costs = sampled_costs(chosen, 1);
      std::nth_element(costs.begin(), costs.begin() + (most - 1), costs.end());
      asked.max_cost = costs[most - 1];
      chosen = between(chosen, from, asked.max_cost, work);
    }
    std::vector<Candidate> rest;
    if (chosen.of_block.size() > 1 && chosen.count() <= most) {
      collapsed += collapse_in_parts(surface, std::move(chosen), asked, work, rest);
    } else {
      for (const auto& block : chosen.of_block) add_to(rest, block);
    }
    collapsed += append(collapse_in_order(surface, std::move(rest), asked), surface);
    if (!(asked.max_cost < max_cost)) break;
    from = asked.max_cost;
  }
  return collapsed;
}

/// One pass over the cheaper half of the candidates, or all of them if the half barely helps.
/// Returns whether another one like it is worth its time.
bool run_pass(ShrinkingSurface& surface, Index target_faces, const ShapeLimits& limits,
              const Work& work) {
  begin_pass(surface, work);
  const Candidates candidates = find_candidates(surface, work);
  const Index count = candidates.count();
  if (count == 0) return false;
  const Index worthwhile = 1 + static_cast<Index>(limits.min_progress * count);
  // The middle of a sample splits large lists well enough.
  std::vector<double> costs = sampled_costs(candidates, 1 + count / kSample);
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
