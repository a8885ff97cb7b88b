#include "local/regions.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "descend/newton.h"
#include "exact/certificate.h"
#include "local/patch_work.h"
#include "local/untangle.h"
#include "mesh/hub.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

constexpr int kNewtonSteps = 30;
constexpr double kTolerance = 1e-3;  // relative decrease of a step: neighbours change anyway
/// Of the vertices, beyond which regions are not widened: their systems are to stay small beside
/// what the mesh takes.
constexpr Index kMostOf = 7;
constexpr std::int64_t kGrain = 256;

/// Vertices that move in a region to be relaxed: that many, or a share of all, but no more than a
/// share of what moves.
constexpr Index kMostTogether = 500, kTogetherOf = 125, kTogetherOfMoving = 16;

/// What several threads make of the time of one region: so many vertices keep each busy, and they
/// are no more times as fast than that, or than a share of their number.
constexpr double kForAThread = 400, kMostTimesAsFast = 3, kShareOfThreads = 0.8;

/// Calls visit(u) for the neighbours of a vertex, on the boundary for some of them twice.
template <class Visit>
void for_each_neighbour(const DiskMesh& mesh, Index vertex, const Visit& visit) {
  const bool on_boundary = mesh.on_boundary[vertex];
  mesh.for_each_outgoing(vertex, [&](Index h) {
    visit(mesh.target(h));
    if (on_boundary) visit(mesh.origin(Surface::previous(h)));
  });
}

/// Where each vertex belongs: to a region, by its place in the list of what moves, to none yet, or
/// to none for good.
class Membership {
 public:
  Membership(const DiskMesh& mesh, std::vector<Index>& of) : mesh_(mesh), of_(of) {
    of_.assign(mesh.positions.size(), kOutside);
  }

  /// Takes the vertex in. Returns whether it was outside and may move.
  bool take(Index vertex) {
    poll_();
    if (of_[vertex] != kOutside) return false;
    const bool hub = is_hub(mesh_, vertex, kLargeHubFaces);
    of_[vertex] = hub ? kHeld : kWaiting;
    return !hub;
  }

  /// Several threads may claim what is outside: it is the lowest chunk's. Returns whether this one
  /// claims it first, or from a higher one.
  bool claim(Index vertex, Index chunk) {
    const std::atomic_ref of(of_[vertex]);
    const Index own = kFirstClaim - chunk;
    Index now = of.load(std::memory_order_relaxed);
    while (now == kOutside || now < own) {
      if (of.compare_exchange_weak(now, own, std::memory_order_relaxed)) return true;
    }
    return false;
  }

  /// Takes in, of what a chunk has claimed, what is its own, and leaves in the list what may move.
  void take_claimed(Index chunk, std::vector<Index>& claimed) {
    std::erase_if(claimed, [&](Index vertex) {
      // Others, which had claimed it before, may look at it.
      const std::atomic_ref of(of_[vertex]);
      if (of.load(std::memory_order_relaxed) != kFirstClaim - chunk) return true;
      const bool hub = is_hub(mesh_, vertex, kLargeHubFaces);
      of.store(hub ? kHeld : kWaiting, std::memory_order_relaxed);
      return hub;
    });
  }

  /// Adds the region that a vertex belongs to, if it waits, to the list. What is beside so many
  /// vertices of it stays, and parts them from the rest. Returns whether there was one.
  bool give_region(Index vertex, Index most, std::vector<Index>& list) {
    poll_();
    if (of_[vertex] != kWaiting) return false;
    const std::size_t begin = list.size(), full = begin + static_cast<std::size_t>(most);
    of_[vertex] = kGiven;
    list.push_back(vertex);
    for (std::size_t i = begin; i < list.size(); ++i) {
      for_each_neighbour(mesh_, list[i], [&](Index u) {
        poll_();
        if (of_[u] != kWaiting) return;
        const bool is_full = list.size() >= full;
        of_[u] = is_full ? kHeld : kGiven;
        if (!is_full) list.push_back(u);
      });
    }
    return true;
  }

  /// Sorts a region, a part of that list, and notes where its vertices have come to.
  void number(std::vector<Index>& list, Index begin, Index end) {
    std::sort(list.begin() + begin, list.begin() + end);
    for (Index place = begin; place < end; ++place) of_[list[place]] = place;
  }

 private:
  static constexpr Index kGiven = 0, kOutside = -1, kWaiting = -2, kHeld = -3, kFirstClaim = -4;

  const DiskMesh& mesh_;
  std::vector<Index>& of_;
  PollSometimes poll_;
};

/// The vertices that are to move, each once; up to `rings` rings, which becomes what it reached.
std::vector<Index> around(const DiskMesh& mesh, const std::vector<Index>& faces, const Work& work,
                          Membership& membership, int& rings) {
  std::vector<Index> found;
  for (const Index face : faces) {
    for (const Index v : mesh.faces[face]) {
      if (membership.take(v)) found.push_back(v);
    }
  }
  std::int64_t inner = 0;  // of those found, all of whose neighbours are
  for (int ring = 0; ring < rings; ++ring) {
    const std::int64_t count = size_of(found);
    if (count > mesh.vertex_count() / kMostOf) {
      rings = ring;
      break;
    }
    std::vector<std::vector<Index>> claimed((count - inner) / kGrain + 1);
    parallel_for(work, count - inner, kGrain, [&](std::int64_t begin, std::int64_t end) {
      const auto chunk = static_cast<Index>(begin / kGrain);
      for (std::int64_t i = inner + begin; i < inner + end; ++i) {
        for_each_neighbour(mesh, found[i], [&](Index u) {
          if (membership.claim(u, chunk)) claimed[chunk].push_back(u);
        });
      }
    });
    parallel_for(work, size_of(claimed), 1, [&](std::int64_t i, std::int64_t) {
      membership.take_claimed(static_cast<Index>(i), claimed[i]);
    });
    inner = count;
    for (const std::vector<Index>& of_chunk : claimed) {
      found.insert(found.end(), of_chunk.begin(), of_chunk.end());
    }
  }
  return found;
}

/// How many of the regions of these sizes, from the largest on, are to be treated one after the
/// other by all threads, so that all of them take the shortest time.
Index most_in_turn(const std::vector<double>& sizes, int threads) {
  double rest = std::accumulate(sizes.begin(), sizes.end(), 0.0), in_turn = 0;
  double best = std::numeric_limits<double>::infinity();
  Index most = 0;
  for (Index i = 0; i < size_of(sizes); ++i) {
    const double all = in_turn + std::max(sizes[i], rest / threads);
    if (all < best) {
      best = all;
      most = i;
    }
    const double together = std::min(kMostTimesAsFast, kShareOfThreads * threads);
    in_turn += sizes[i] / std::clamp(sizes[i] / kForAThread, 1.0, std::max(1.0, together));
    rest -= sizes[i];
  }
  return in_turn < best ? size_of(sizes) : most;
}

}  // namespace

Regions::Regions(const DiskMesh& mesh, const std::vector<Index>& faces, const RegionSize& size,
                 const Work& work)
    : mesh_(mesh), rings_(size.rings) {
  Membership membership(mesh, of_);
  const std::vector<Index> moving = around(mesh, faces, work, membership, rings_);
  const Index share = size_of(moving) / kTogetherOfMoving;
  const Index most = std::min(size.most_vertices, std::max(size.few_vertices, share));
  vertices_.reserve(moving.size());
  for (const Index v : moving) {
    if (membership.give_region(v, most, vertices_)) begins_.push_back(size_of(vertices_));
  }
  parallel_for(work, count(), 1, [&](std::int64_t i, std::int64_t) {
    membership.number(vertices_, begins_[i], begins_[i + 1]);
  });
}

Patch Regions::patch(Index region, const std::vector<RestTriangle>& rest,
                     const std::vector<Vec2>& uvs) const {
  const std::vector<Index> moving(vertices_.begin() + begins_[region],
                                  vertices_.begin() + begins_[region + 1]);
  const auto moves = [&](Index v) {
    return of_[v] >= begins_[region] && of_[v] < begins_[region + 1];
  };
  std::vector<Index> faces;
  PollSometimes poll;
  for (const Index v : moving) {
    poll();
    mesh_.for_each_outgoing(v, [&](Index h) {
      // Each face comes with the first of its corners that moves.
      const Triangle& corners = mesh_.faces[h / 3];
      if (std::none_of(corners.begin(), corners.end(),
                       [&](Index u) { return u < v && moves(u); })) {
        faces.push_back(h / 3);
      }
    });
  }
  sort_interruptibly(faces.begin(), faces.end(), std::less<>());
  return make_patch(mesh_, rest, uvs, std::move(faces), moving);
}

std::vector<std::optional<Patch>> Regions::treat(const std::vector<RestTriangle>& rest,
                                                 const std::vector<Vec2>& uvs,
                                                 const Treatment& treatment,
                                                 const Work& work) const {
  std::vector<Index> order(count());
  std::iota(order.begin(), order.end(), Index{0});
  const auto size_of_region = [&](Index region) { return begins_[region + 1] - begins_[region]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return size_of_region(a) > size_of_region(b); });
  std::vector<std::optional<Patch>> treated(count());
  const auto treat_one = [&](Index region, const Work& on) {
    Patch own = patch(region, rest, uvs);
    if (!treatment(own, region, on)) return;
    own.faces = {};
    own.rest = {};
    treated[region] = std::move(own);
  };
  std::vector<double> sizes;
  for (const Index region : order) sizes.push_back(size_of_region(region));
  const Index first = most_in_turn(sizes, work.threads());
  const Work all = work.part(0, 0), alone = work.aside();
  for (Index i = 0; i < first; ++i) treat_one(order[i], all);
  parallel_for(work, size_of(order) - first, 1,
               [&](std::int64_t i, std::int64_t) { treat_one(order[first + i], alone); });
  return treated;
}

std::int64_t relax_regions(Energy energy, const DiskMesh& mesh,
                           const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                           const std::vector<Index>& faces, int rings, const Work& work) {
  const Index most = std::max(kMostTogether, mesh.vertex_count() / kTogetherOf);
  const RegionSize size{rings, most, kMostTogether};
  const Regions regions(mesh, faces, size, work);
  NewtonOptions options;
  options.energy = energy;
  options.tolerance = kTolerance;
  options.max_iterations = kNewtonSteps;
  options.proxy_steps = 0;  // the map is near its minimum but for some faces
  const auto minimise = [&](Patch& patch, Index, const Work& on) {
    const auto descend = [&] {
      return minimise_energy(patch.faces, patch.rest, patch.fixed, patch.uvs, options, on);
    };
    // Faces that are positive by exact predicates may have no positive determinant in floats.
    if (!std::isfinite(descend().energies.front())) {
      if (!untangle(patch.faces, patch.rest, patch.fixed, patch.uvs, on)) return false;
      descend();
    }
    return non_positive_faces(patch.faces, patch.uvs, on).empty();
  };
  std::vector<std::optional<Patch>> patches = regions.treat(rest, uvs, minimise, work);
  PatchWork taken(mesh, uvs);
  std::int64_t changed = 0;
  for (std::optional<Patch>& patch : patches) {
    if (patch && taken.take(*patch)) ++changed;
  }
  return changed;
}

}  // namespace beltrami
