// Each sweep goes over the vertices once, and one that is not locked yet is collapsed onto the
// cheapest of its neighbours if that is cheap enough: nothing is sorted, listed or compacted, and
// the twins of half-edges are kept up to date in place. The cost is the error of Garland & Heckbert
// 1997 under the planes of the faces that a vertex has by then; without memory of what went before
// (Lindstrom & Turk 1998, "Fast and Memory Efficient Polygonal Simplification"), which a few levels
// can do without. As in the passes a collapse locks its two vertices for the rest of the sweep;
// blocks of vertices go side by side, then pairs of them along their borders.
#include "simplify/sweep.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/lanes.h"
#include "base/parallel.h"
#include "base/scratch.h"
#include "base/vectors.h"
#include "simplify/back_ends.h"
#include "simplify/blocks.h"
#include "simplify/history.h"
#include "simplify/shape.h"

namespace beltrami {
namespace {

/// Share of the squared edge length in the cost, as in the passes.
constexpr float kEvenness = 1e-3F;

/// Vertices with more faces stay as they are, and so do their neighbours: one of them would cost as
/// much as a sweep.
constexpr int kMostFaces = 64;

/// Of a face, below which its plane counts for less than the others': next to none.
constexpr float kLeastTwiceArea = 1e-20F;

/// How many targets of one vertex are tried in a sweep.
constexpr int kMaxAttempts = 3;

/// Of the vertices of a sample so large, this share has collapses that are cheap enough. With more
/// fewer sweeps are needed, and faces come out less even.
constexpr double kCheapShare = 0.65;
constexpr Index kSample = 5000;

/// Blocks that there are at least: enough for many threads, and for few deferred collapses.
constexpr Index kBlocks = 48;

/// Blocks of 2^kWider times the vertices are for what reaches into a third block: few of the places
/// where three meet are on the borders of these.
constexpr int kWider = 3;

/// A sweep that takes away less than this share of the faces is the last.
constexpr double kWorthSweep = 0.02;

constexpr std::int64_t kGrain = 4096;  // bits of on_boundary of different chunks share no word
constexpr std::int64_t kSampleGrain = 128;

using Vec3f = Eigen::Vector3f;

/// A number per face of a star, and room for the last lanes.
using Row = Eigen::Array<float, kMostFaces + kLanes, 1>;

/// What is around a vertex. Face k lies between the half-edges k and k + 1.
struct Star {
  int count = 0;                           ///< faces
  std::uint64_t last_bits = 0;             ///< of the numbers in the ring: those that there are
  Index outside = kNone;                   ///< a neighbour out of the territory
  std::array<Index, kMostFaces> halfedge;  ///< outgoing, counter-clockwise
  std::array<Index, kMostFaces> ring;      ///< their targets
  // Measured by costs_of.
  Row x, y, z;                       ///< of the ring from the vertex, the first one once more
  Row normal_x, normal_y, normal_z;  ///< of the faces, as long as twice the area
  Row twice_area;

  int after(int k) const { return k + 1 == count ? 0 : k + 1; }
  Vec3f offset(int k) const { return {x[k], y[k], z[k]}; }
  Vec3f normal(int k) const { return {normal_x[k], normal_y[k], normal_z[k]}; }

  void add(Index h, Index v) {
    halfedge[count] = h;
    ring[count++] = v;
    last_bits |= bit_of(v);
  }
  bool has(Index v) const {
    return (last_bits & bit_of(v)) != 0 &&
           std::find(ring.begin(), ring.begin() + count, v) != ring.begin() + count;
  }
  static std::uint64_t bit_of(Index v) { return std::uint64_t{1} << (v % 64); }
};

/// Calls body(k) for the first of each kLanes faces.
template <class Body>
void for_each_lanes(const Star& star, const Body& body) {
  for (int k = 0; k < star.count; k += kLanes) body(k);
}

Lanes lanes_of(const Row& row, int k) {
  return row.segment<kLanes>(k);
}

/// As shape_quality.
float quality(float twice_area, float squared_lengths) {
  return static_cast<float>(shape_quality(double{twice_area}, double{squared_lengths}));
}

struct Collapses {
  Index count = 0;
  CollapseHistory history;
};

class Sweeps {
 public:
  Sweeps(const Surface& fine, bool keeps_history, const Work& work);

  /// Returns how many collapses took place.
  Index sweep(const Work& work);
  CoarseSurface result(const Work& work);
  /// Per vertex the one it was collapsed onto, or itself.
  std::vector<Index>& into() { return into_; }

 private:
  const Vec3& position(Index v) const { return fine_.positions[v]; }
  Index target(Index h) const { return faces_[h / 3][next_corner(h % 3)]; }
  Index apex(Index h) const { return faces_[h / 3][previous_corner(h % 3)]; }
  bool may_go(Index v) const {
    return outgoing_[v] != kNone && !fine_.on_boundary[v] && valence_[v] <= kMostFaces;
  }
  template <class Visit>
  void for_each_outgoing(Index v, Visit&& visit) const {
    const Index first = outgoing_[v];
    Index h = first;
    do {
      visit(h);
      h = twin_[Surface::previous(h)];
    } while (h != kNone && h != first);
  }

  Star star_of(Index v, const Territory& territory) const;
  Row costs_of(Index v, Star& star) const;
  float cheap_enough(const Work& work) const;
  enum class Verdict { kGranted, kRefused, kReachesOut };
  Verdict judge(Index v, const Star& star, int k, const Territory& territory, Index& outside) const;
  bool keeps_shape(const Star& star, int target) const;
  void collapse(Index v, const Star& star, int k, CollapseHistory& history);
  Index try_vertex(Index v, float max_cost, const Territory& territory, Collapses& done);
  std::vector<Index> try_all(const std::vector<Index>& vertices, float max_cost,
                             const Territory& territory, Collapses& done);
  std::vector<Index> sweep_pairs(const std::vector<ReachingOut<Index>>& reaching_out,
                                 float max_cost, const Work& work, Collapses& all);
  void sweep_rest(const std::vector<Index>& rest, float max_cost, const Work& work, Collapses& all);
  void append(Collapses& done, Collapses& all);

  const Surface& fine_;
  const bool keeps_history_;
  const int shift_;  ///< of the blocks
  std::vector<Index> into_;
  Scratch<Triangle> faces_;  ///< one that is gone has kNone as its first corner
  Scratch<Index> twin_, outgoing_, valence_;
  Scratch<std::uint8_t> locked_;  ///< bytes, since blocks write side by side
  CollapseHistory history_;
};

Sweeps::Sweeps(const Surface& fine, bool keeps_history, const Work& work)
    : fine_(fine),
      keeps_history_(keeps_history),
      shift_(block_shift(fine.vertex_count(), kBlocks)),
      faces_(work, fine.faces.size()),
      twin_(work, fine.twin.size()),
      outgoing_(work, fine.outgoing.size()),
      valence_(work, fine.outgoing.size()),
      locked_(work, fine.outgoing.size()) {
  parallel_assign(work, into_, fine.outgoing.size());
  parallel_for(work, fine.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t f = begin; f < end; ++f) {
      faces_[f] = fine.faces[f];
      for (int k = 0; k < 3; ++k) twin_[3 * f + k] = fine.twin[3 * f + k];
    }
  });
  parallel_for(work, fine.vertex_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
    PollSometimes poll;  // a hub may have all faces
    for (auto v = static_cast<Index>(begin); v < end; ++v) {
      into_[v] = v;
      outgoing_[v] = fine.outgoing[v];
      Index faces = 0;
      if (outgoing_[v] != kNone) {
        fine.for_each_outgoing(v, [&](Index) {
          poll();
          ++faces;
        });
      }
      valence_[v] = faces;
    }
  });
}

Star Sweeps::star_of(Index v, const Territory& territory) const {
  Star star;
  for_each_outgoing(v, [&](Index h) {
    const Index u = target(h);
    if (!territory.has(u)) star.outside = u;
    star.add(h, u);
  });
  return star;
}

/// Measures the star. Returns the costs of the collapses onto each vertex of the ring.
Row Sweeps::costs_of(Index v, Star& star) const {
  const Vec3& origin = position(v);
  const auto set_offset = [&](int k, const Vec3f& offset) {
    star.x[k] = offset.x();
    star.y[k] = offset.y();
    star.z[k] = offset.z();
  };
  for (int k = 0; k < star.count; ++k) {
    set_offset(k, (position(star.ring[k]) - origin).cast<float>());
  }
  set_offset(star.count, star.offset(0));
  for (int k = star.count + 1; k % kLanes != 1; ++k) set_offset(k, Vec3f::Zero());
  // The planes go through the vertex: a quadratic form is all there is of the quadric.
  std::array<Row, 6> form;
  for_each_lanes(star, [&](int k) {
    const Lanes x = lanes_of(star.x, k), y = lanes_of(star.y, k), z = lanes_of(star.z, k);
    const Lanes next_x = lanes_of(star.x, k + 1), next_y = lanes_of(star.y, k + 1),
                next_z = lanes_of(star.z, k + 1);
    const Lanes nx = y * next_z - z * next_y, ny = z * next_x - x * next_z,
                nz = x * next_y - y * next_x;
    const Lanes twice_area = root(nx * nx + (ny * ny + nz * nz));
    const Lanes weight = 0.5F / twice_area.max(kLeastTwiceArea);
    star.normal_x.segment<kLanes>(k) = nx;
    star.normal_y.segment<kLanes>(k) = ny;
    star.normal_z.segment<kLanes>(k) = nz;
    star.twice_area.segment<kLanes>(k) = twice_area;
    const Lanes wx = weight * nx, wy = weight * ny, wz = weight * nz;
    form[0].segment<kLanes>(k) = wx * nx;
    form[1].segment<kLanes>(k) = wx * ny;
    form[2].segment<kLanes>(k) = wx * nz;
    form[3].segment<kLanes>(k) = wy * ny;
    form[4].segment<kLanes>(k) = wy * nz;
    form[5].segment<kLanes>(k) = wz * nz;
  });
  std::array<float, 6> sum{};
  for (int k = 0; k < star.count; ++k) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += form[i][k];
  }
  const auto [xx, xy, xz, yy, yz, zz] = sum;
  const float evenness = kEvenness * (xx + yy + zz);
  Row costs;
  for_each_lanes(star, [&, xx = xx, xy = xy, xz = xz, yy = yy, yz = yz, zz = zz](int k) {
    const Lanes x = lanes_of(star.x, k), y = lanes_of(star.y, k), z = lanes_of(star.z, k);
    const Lanes change =
        x * (xx * x + 2 * (xy * y + xz * z)) + y * (yy * y + 2 * yz * z) + z * zz * z;
    costs.segment<kLanes>(k) = change.max(0.0F) + evenness * (x * x + (y * y + z * z));
  });
  return costs;
}

float Sweeps::cheap_enough(const Work& work) const {
  const Index count = fine_.vertex_count(), stride = 1 + count / kSample;
  constexpr float kNoCost = -1;
  std::vector<float> least((count + stride - 1) / stride, kNoCost);
  parallel_for(work, size_of(least), kSampleGrain, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<Index>(begin); i < end; ++i) {
      const Index v = i * stride;
      if (!may_go(v)) continue;
      Star star = star_of(v, Territory::all());
      const Row costs = costs_of(v, star);
      least[i] = costs.head(star.count).minCoeff();
    }
  });
  std::erase(least, kNoCost);
  if (least.empty()) return kNoCost;
  const auto limit =
      least.begin() + static_cast<std::ptrdiff_t>(kCheapShare * (size_of(least) - 1));
  std::nth_element(least.begin(), limit, least.end());
  return *limit;
}

/// The link condition, no vertex of too few faces, and the shapes. `outside`: set to a neighbour of
/// the target that is out of the territory, where there is one.
Sweeps::Verdict Sweeps::judge(Index v, const Star& star, int k, const Territory& territory,
                              Index& outside) const {
  // The star is at hand: what it tells comes before the ring of the target.
  if (!keeps_shape(star, k)) return Verdict::kRefused;
  const Index h = star.halfedge[k], w = star.ring[k];
  int common = 0;
  for_each_outgoing(w, [&](Index g) {
    const Index u = target(g);
    if (!territory.has(u)) outside = u;
    common += star.has(u) ? 1 : 0;
  });
  if (outside != kNone) return Verdict::kReachesOut;
  if (common != 2 || valence_[v] + valence_[w] - 4 < 3) return Verdict::kRefused;
  for (const Index a : {apex(h), apex(twin_[h])}) {
    if (valence_[a] - 1 < (fine_.on_boundary[a] ? 2 : 3)) return Verdict::kRefused;
  }
  return Verdict::kGranted;
}

/// Of the faces of the star.
float worst_quality(const Star& star) {
  float worst = 1;
  for (int k = 0; k < star.count; ++k) {
    const Vec3f u = star.offset(k), w = star.offset(k + 1);
    const float lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    worst = std::min(worst, quality(star.twice_area[k], lengths));
  }
  return worst;
}

Vec3f sum_of_normals(const Star& star) {
  Vec3f sum = Vec3f::Zero();
  for (int k = 0; k < star.count; ++k) sum += star.normal(k);
  return sum;
}

/// Whether the faces left keep their shapes within the first limits of the passes (shape.h).
bool Sweeps::keeps_shape(const Star& star, int target) const {
  constexpr ShapeLimits kLimits = kShapeLimits[0];
  constexpr auto kLeast = static_cast<float>(kLimits.min_quality);
  constexpr auto kRatio = static_cast<float>(kLimits.min_quality_ratio);
  constexpr auto kTurn = static_cast<float>(kLimits.min_turn_cosine);
  const Vec3f to = star.offset(target);
  std::optional<float> allowed;  // of those that are not good
  const int last = target == 0 ? star.count - 1 : target - 1;
  for (int k = star.after(target); k != last; k = star.after(k)) {
    const Vec3f u = star.offset(k) - to, w = star.offset(k + 1) - to;
    const Vec3f after = u.cross(w);
    const float twice_area = after.norm();
    const float lengths = u.squaredNorm() + w.squaredNorm() + (w - u).squaredNorm();
    const float own = quality(twice_area, lengths);
    if (!(own >= kLeast)) {
      if (!allowed) allowed = std::min(kLeast, kRatio * worst_quality(star));
      if (!(own >= *allowed)) return false;
    }
    // A degenerate face has no normal of its own to keep.
    const bool has_normal = star.twice_area[k] > 0;
    const Vec3f before = has_normal ? star.normal(k) : sum_of_normals(star);
    const float before_norm = has_normal ? star.twice_area[k] : before.norm();
    if (!(before.dot(after) >= kTurn * before_norm * twice_area)) return false;
  }
  return true;
}

/// Onto ring[k] of the star of v.
void Sweeps::collapse(Index v, const Star& star, int k, CollapseHistory& history) {
  const Index h = star.halfedge[k], t = twin_[h], w = star.ring[k];
  const std::array<Index, 2> apexes{apex(h), apex(t)};
  into_[v] = w;
  if (keeps_history_) history.steps.push_back({v, w, apexes, size_of(history.renamed)});
  for (int i = 0; i < star.count; ++i) {
    const Index u = star.ring[i];
    const bool renamed = u != w && u != apexes[0] && u != apexes[1];
    if (keeps_history_ && renamed) history.renamed.push_back(u);
    const Index g = star.halfedge[i];
    faces_[g / 3][g % 3] = w;
  }
  // The two other sides of each face that goes become one edge, of w and its apex. Neither of them
  // is on the boundary, since v and w are not.
  for (const Index side : {h, t}) {
    const Index at_apex = twin_[Surface::next(side)], at_w = twin_[Surface::previous(side)];
    twin_[at_apex] = at_w;
    twin_[at_w] = at_apex;
    const Index a = side == h ? apexes[0] : apexes[1];
    if (!fine_.on_boundary[a]) outgoing_[a] = at_apex;  // else the first one is still there
    outgoing_[w] = at_w;
    --valence_[a];
    faces_[side / 3][0] = kNone;
  }
  valence_[w] += valence_[v] - 4;
  outgoing_[v] = kNone;
  locked_[v] = locked_[w] = true;
}

/// Returns kNone, or where it has not been dealt with a vertex outside that it reaches.
Index Sweeps::try_vertex(Index v, float max_cost, const Territory& territory, Collapses& done) {
  Star star = star_of(v, territory);
  // Not even a look at what another thread may be changing.
  if (star.outside != kNone) return star.outside;
  Row costs = costs_of(v, star);
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    int best = -1;
    for (int k = 0; k < star.count; ++k) {
      const Index w = star.ring[k];
      if (costs[k] > max_cost || locked_[w] || !may_go(w)) continue;
      const bool is_less =
          best < 0 || (costs[k] != costs[best] ? costs[k] < costs[best] : w < star.ring[best]);
      if (is_less) best = k;
    }
    if (best < 0) return kNone;
    Index outside = kNone;
    const Verdict verdict = judge(v, star, best, territory, outside);
    if (verdict == Verdict::kReachesOut) return outside;
    if (verdict == Verdict::kGranted) {
      collapse(v, star, best, done.history);
      ++done.count;
      return kNone;
    }
    costs[best] = std::numeric_limits<float>::infinity();
  }
  return kNone;
}

/// Returns those that reach out.
std::vector<Index> Sweeps::try_all(const std::vector<Index>& vertices, float max_cost,
                                   const Territory& territory, Collapses& done) {
  std::vector<Index> left;
  PollSometimes poll;
  for (const Index v : vertices) {
    poll();
    if (!may_go(v) || locked_[v]) continue;
    if (try_vertex(v, max_cost, territory, done) != kNone) left.push_back(v);
  }
  return left;
}

void Sweeps::append(Collapses& done, Collapses& all) {
  all.count += done.count;
  history_.append(done.history);
  done = {};
}

/// What reaches from one block into another. Returns the vertices that reach into a third one.
std::vector<Index> Sweeps::sweep_pairs(const std::vector<ReachingOut<Index>>& reaching_out,
                                       float max_cost, const Work& work, Collapses& all) {
  std::vector<Index> rest;
  for (const auto& pairs : rounds_of_pairs(reaching_out)) {
    std::vector<Collapses> of_pair(pairs.size());
    std::vector<std::vector<Index>> left(pairs.size());
    parallel_for(work, size_of(pairs), 1, [&](std::int64_t p, std::int64_t) {
      const Territory both = Territory::of_pair(shift_, pairs[p].one, pairs[p].other);
      for (const std::vector<Index>* vertices : pairs[p].items) {
        const std::vector<Index> out = try_all(*vertices, max_cost, both, of_pair[p]);
        left[p].insert(left[p].end(), out.begin(), out.end());
      }
    });
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      append(of_pair[p], all);
      rest.insert(rest.end(), left[p].begin(), left[p].end());
    }
  }
  return rest;
}

/// What reaches into a third block, in wider ones, and what reaches out of these.
void Sweeps::sweep_rest(const std::vector<Index>& rest, float max_cost, const Work& work,
                        Collapses& all) {
  const int shift = shift_ + kWider;
  const Index blocks = ((fine_.vertex_count() - 1) >> shift) + 1;
  std::vector<std::vector<Index>> of_block(blocks), left(blocks);
  for (const Index v : rest) of_block[v >> shift].push_back(v);
  std::vector<Collapses> done(blocks);
  parallel_for(work, blocks, 1, [&](std::int64_t number, std::int64_t) {
    const auto block = static_cast<Index>(number);
    left[block] =
        try_all(of_block[block], max_cost, Territory::of_block(shift, block), done[block]);
  });
  for (Collapses& of_one : done) append(of_one, all);
  Collapses last;
  for (const std::vector<Index>& vertices : left) {
    try_all(vertices, max_cost, Territory::all(), last);
  }
  append(last, all);
}

Index Sweeps::sweep(const Work& work) {
  const float max_cost = cheap_enough(work);
  const Index count = fine_.vertex_count(), blocks = ((count - 1) >> shift_) + 1;
  std::vector<Collapses> of_block(blocks);
  std::vector<ReachingOut<Index>> reaching_out(blocks);
  parallel_for(work, blocks, 1, [&](std::int64_t number, std::int64_t) {
    const auto block = static_cast<Index>(number);
    const Index begin = block << shift_, end = std::min((block + 1) << shift_, count);
    std::fill(&locked_[begin], &locked_[begin] + (end - begin), std::uint8_t{0});
    const Territory territory = Territory::of_block(shift_, block);
    Collapses done;
    ReachingOut<Index> left;
    for (Index v = begin; v < end; ++v) {
      if (!may_go(v) || locked_[v]) continue;
      const Index outside = try_vertex(v, max_cost, territory, done);
      if (outside != kNone) left.add(territory.block_of(outside), v);
    }
    of_block[block] = std::move(done);
    reaching_out[block] = std::move(left);
  });
  Collapses all;
  for (Collapses& done : of_block) append(done, all);
  sweep_rest(sweep_pairs(reaching_out, max_cost, work, all), max_cost, work, all);
  return all.count;
}

/// What is left, numbered anew.
CoarseSurface Sweeps::result(const Work& work) {
  CoarseSurface coarse;
  Surface& mesh = coarse.mesh;
  coarse.fine_vertex = parallel_filter(work, fine_.vertex_count(), kGrain,
                                       [&](Index v) { return outgoing_[v] != kNone; });
  coarse.fine_face = parallel_filter(work, fine_.face_count(), kGrain,
                                     [&](Index f) { return faces_[f][0] != kNone; });
  const Index vertices = size_of(coarse.fine_vertex), faces = size_of(coarse.fine_face);
  // By then only the new numbers count.
  Scratch<Index>& vertex = valence_;
  Scratch<Index> face(work, fine_.faces.size());
  const auto for_each = [&](Index count, const auto& body) {
    parallel_for(work, count, kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (auto i = static_cast<Index>(begin); i < end; ++i) body(i);
    });
  };
  for_each(vertices, [&](Index v) { vertex[coarse.fine_vertex[v]] = v; });
  for_each(faces, [&](Index f) { face[coarse.fine_face[f]] = f; });
  const auto halfedge = [&](Index h) { return h == kNone ? kNone : 3 * face[h / 3] + h % 3; };
  parallel_assign(work, mesh.positions, vertices);
  parallel_assign(work, mesh.outgoing, vertices);
  mesh.on_boundary.resize(vertices);
  for_each(vertices, [&](Index i) {
    const Index v = coarse.fine_vertex[i];
    mesh.positions[i] = fine_.positions[v];
    mesh.outgoing[i] = halfedge(outgoing_[v]);
    mesh.on_boundary[i] = fine_.on_boundary[v];
  });
  parallel_assign(work, mesh.faces, faces);
  parallel_assign(work, mesh.twin, 3 * static_cast<std::size_t>(faces));
  for_each(faces, [&](Index i) {
    const Index f = coarse.fine_face[i];
    for (int k = 0; k < 3; ++k) {
      mesh.faces[i][k] = vertex[faces_[f][k]];
      mesh.twin[3 * i + k] = halfedge(twin_[3 * f + k]);
    }
  });
  coarse.history = std::move(history_);
  return coarse;
}

void run_sweeps(Index faces, Index target_faces, const Work& work, Sweeps& sweeps) {
  const Index start = faces;
  while (faces > target_faces) {
    work.report(double(start - faces) / double(start - target_faces));
    const Index gone = 2 * sweeps.sweep(work);
    faces -= gone;
    if (gone < kWorthSweep * faces) break;
  }
}

}  // namespace

CoarseSurface sweep_surface(const Surface& fine, Index target_faces, const Work& work) {
  Sweeps sweeps(fine, true, work);
  run_sweeps(fine.face_count(), target_faces, work, sweeps);
  return sweeps.result(work);
}

CoarseDisk sweep_disk(const DiskMesh& fine, Index target_faces, const Work& work) {
  Sweeps sweeps(fine, false, work);
  run_sweeps(fine.face_count(), target_faces, work, sweeps);
  CoarseSurface left = sweeps.result(work);
  return coarse_disk(std::move(left.mesh), std::move(left.fine_vertex), std::move(sweeps.into()),
                     work);
}

}  // namespace beltrami
