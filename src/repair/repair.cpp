#include "repair/repair.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/types.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "local/hub_turns.h"
#include "local/kernel.h"
#include "local/patch.h"
#include "local/patch_tries.h"
#include "local/patch_work.h"
#include "local/regions.h"
#include "local/untangle.h"
#include "mesh/hub.h"
#include "repair/global_fix.h"

namespace beltrami {
namespace {

/// A moved vertex must leave every face of its ring at least this share of the mean one: tiny
/// positive areas pass the exact test and give energies of 1e25.
constexpr double kLeastAreaShare = 1e-3;
/// With more faces left by the kernel fix, regions around all of them come before the patches,
/// unless they are so many of all that regions would be the mesh.
constexpr std::size_t kManyFlips = 30;
constexpr double kMostFlips = 0.02;
/// Of the regions around what the first ones, of kRegionRings, left.
constexpr int kWiderRings = 8;
constexpr std::array<int, 4> kPatchRings = {2, 4, 6, 8};
/// Faces that the patches of a repair may have together, as often as each is tried, and so many
/// times those of the mesh: some two seconds. Beyond it patches are most of the mesh, and another
/// start or the global fix is cheaper; a hundred folds near hubs took half a minute.
constexpr std::int64_t kLeastAllowance = 100'000, kAllowance = 4;
constexpr double kLocalShare = 0.6;  // of the work, if the global fix is needed

double cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class Repair {
 public:
  Repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
         const RepairOptions& options, const Work& work)
      : mesh_(mesh),
        rest_(rest),
        uvs_(uvs),
        options_(options),
        work_(work),
        allowance_(std::max(kLeastAllowance, kAllowance * mesh.face_count())) {}

  RepairResult run() {
    std::vector<Index> bad = find_bad();
    result_.flips_before = size_of(bad);
    mend_locally(0, kLocalShare, bad);
    result_.flips_after = size_of(bad);
    if (options_.global_fix &&
        (!bad.empty() || (options_.simple_boundary && !is_simple(mesh_.boundary, uvs_)))) {
      work_.report(kLocalShare);
      mend_globally();
      result_.flips_after = size_of(find_bad());
    }
    return result_;
  }

 private:
  std::vector<Index> find_bad() const { return non_positive_faces(mesh_.faces, uvs_, work_); }

  /// Takes out of `bad` what no longer is, and puts in what has become so: only near what has moved
  /// since the last look.
  void look_again(std::vector<Index>& bad) {
    bad.insert(bad.end(), changed_.begin(), changed_.end());
    changed_.clear();
    sort_interruptibly(bad.begin(), bad.end(), std::less<>());
    bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
    std::erase_if(bad, [&](Index face) { return positive(face); });
  }

  std::int64_t crossings() const { return count_crossings(mesh_.boundary, uvs_).count; }

  /// Kernel and patch fixes of the faces `bad`, all that are not positive; leaves those that still
  /// are not.
  void mend_locally(double from, double until, std::vector<Index>& bad) {
    if (bad.empty()) return;
    for (const bool neighbours_first : {false, true}) {
      HubTurns turns(mesh_);
      for (const Index face : bad) {
        poll_interrupt();
        for (const Index v : mesh_.faces[face]) {
          if (positive(face)) break;
          if (!turns.take(v)) continue;
          if (neighbours_first) move_ring_to_kernels(v);
          if (move_to_kernel(v)) ++result_.kernel_fixes;
        }
      }
      look_again(bad);
      if (bad.empty()) return;
    }
    if (bad.size() > options_.most_patches) return;
    PatchWork patches(mesh_, uvs_);
    const auto count = static_cast<double>(bad.size());
    if (bad.size() > kManyFlips && count <= kMostFlips * mesh_.face_count()) {
      int reached = -1;  // rings
      for (const int rings : {kRegionRings, kWiderRings}) {
        const Regions regions(mesh_, bad, {rings}, work_);
        if (regions.rings() <= reached) break;
        reached = regions.rings();
        untangle_regions(regions, patches);
        look_again(bad);
        if (bad.empty()) return;
      }
    }
    for (std::size_t level = 0; level < kPatchRings.size() && !bad.empty(); ++level) {
      if (kPatchRings[level] > options_.most_rings) break;
      const double share = (until - from) / kPatchRings.size();
      const Work part = work_.part(from + share * level, from + share * (level + 1));
      for (std::size_t begin = 0; begin < bad.size(); begin += kTogether) {
        part.report(static_cast<double>(begin) / static_cast<double>(bad.size()));
        const std::span<const Index> all = bad;
        fix_patches(all.subspan(begin, std::min(kTogether, all.size() - begin)), kPatchRings[level],
                    patches);
      }
      look_again(bad);
    }
  }

  /// Of many faces most patches have others on their edges, which hold them.
  void untangle_regions(const Regions& regions, PatchWork& patches) {
    const auto unfold = [](Patch& patch, Index, const Work& on) {
      return untangle(patch.faces, patch.rest, patch.fixed, patch.uvs, on);
    };
    for (std::optional<Patch>& unfolded : regions.treat(rest_, uvs_, unfold, work_)) {
      if (!unfolded || !patches.take(*unfolded)) continue;
      ++result_.patch_fixes;
      const std::vector<Index>& faces = unfolded->mesh_faces;
      changed_.insert(changed_.end(), faces.begin(), faces.end());
    }
  }

  void mend_globally() {
    const std::vector<Vec2> before = uvs_;
    const std::size_t bad_before = find_bad().size();
    const std::int64_t crossings_before = crossings();
    if (!embed_with_scaffold(mesh_, uvs_, work_)) return;
    result_.global_fixes = 1;
    std::vector<Index> folded = find_bad();
    // More than it came from: rounding has eaten it, and there is nothing to build on.
    if (folded.size() <= bad_before || bad_before == 0) mend_locally(kLocalShare, 1, folded);
    const std::size_t bad = find_bad().size();
    const bool better = options_.simple_boundary
                            ? std::pair(bad, crossings()) < std::pair(bad_before, crossings_before)
                            : bad < bad_before;
    if (better) return;
    uvs_ = before;
    result_.global_fixes = 0;
  }

  void move_ring_to_kernels(Index vertex) {
    mesh_.for_each_outgoing(vertex, [&](Index h) {
      poll_interrupt();
      // Another hub has its own turn.
      if (is_hub(mesh_, mesh_.target(h), kHubFaces)) return;
      if (move_to_kernel(mesh_.target(h))) ++result_.kernel_fixes;
    });
  }

  bool positive(Index face) const {
    const Triangle& t = mesh_.faces[face];
    return orientation(uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]) > 0;
  }

  bool move_to_kernel(Index vertex) {
    if (mesh_.on_boundary[vertex]) return false;
    std::vector<Vec2> ring;
    mesh_.for_each_outgoing(vertex, [&](Index h) { ring.push_back(uvs_[mesh_.target(h)]); });
    const std::optional<Vec2> centre = kernel_centroid(ring);
    if (!centre) return false;
    const Vec2& target = *centre;
    double ring_area = 0, least = std::numeric_limits<double>::infinity();
    bool all_positive = true;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const Vec2 &a = ring[i], &b = ring[i + 1 == ring.size() ? 0 : i + 1];
      const double area = cross(target, a, b);
      ring_area += area;
      least = std::min(least, area);
      all_positive = all_positive && orientation(target, a, b) > 0;
    }
    if (!all_positive || least < kLeastAreaShare * ring_area / ring.size()) return false;
    uvs_[vertex] = target;
    mesh_.for_each_outgoing(vertex, [&](Index h) { changed_.push_back(h / 3); });
    return true;
  }

  /// Mends patches around the faces, side by side where none moves a vertex of another. Most of
  /// those that are in each other's way fail, which changes nothing: after a failure twice as many
  /// layers of them are tried at once, as if in turn, and what was tried after a patch that is put
  /// in waits again.
  void fix_patches(std::span<const Index> faces, int rings, PatchWork& patches) {
    std::vector<PatchTry> waiting;
    for (const Index face : faces) waiting.push_back({face, {}});
    const auto is_positive = [&](Index face) { return positive(face); };
    std::size_t layers = 1;
    while (!waiting.empty() && allowance_ > 0) {
      poll_interrupt();
      std::vector<PatchTry> tries;
      std::vector<std::size_t> ends;  // of each layer
      while (ends.size() < layers && !waiting.empty()) {
        auto apart = take_apart(mesh_, rest_, uvs_, rings, is_positive, work_, waiting);
        std::move(apart.begin(), apart.end(), std::back_inserter(tries));
        ends.push_back(tries.size());
      }
      for (PatchTry& next : tries) next.patch.refresh(uvs_);
      std::vector<Patch> made = untangled([](Patch&) {}, tries);
      std::size_t begin = 0;
      bool any = false;
      for (std::size_t l = 0; l < ends.size() && !any; begin = ends[l++]) {
        any = put_in({made.data() + begin, ends[l] - begin}, patches,
                     {tries.data() + begin, ends[l] - begin});
      }
      layers = any ? 1 : 2 * layers;
      for (; begin < tries.size(); ++begin) waiting.push_back(std::move(tries[begin]));
      std::sort(waiting.begin(), waiting.end(),
                [](const PatchTry& one, const PatchTry& other) { return one.face < other.face; });
    }
  }

  /// The patches of the tries as `prepare` makes them, and untangled where those are positive then.
  std::vector<Patch> untangled(const std::function<void(Patch&)>& prepare,
                               std::span<PatchTry> tries) {
    std::vector<Patch> made;
    for (const PatchTry& next : tries) {
      prepare(made.emplace_back(next.patch));
      allowance_ -= size_of(next.patch.faces);
    }
    const Work alone = work_.aside();
    parallel_for(
        work_, static_cast<std::int64_t>(tries.size()), 1, [&](std::int64_t i, std::int64_t) {
          Patch& patch = made[i];
          tries[i].positive = untangle(patch.faces, patch.rest, patch.fixed, patch.uvs, alone);
        });
    return made;
  }

  /// Puts in what came out positive, in turn; what adds crossings again in other ways. Returns
  /// whether anything has changed.
  bool put_in(std::span<Patch> made, PatchWork& patches, std::span<PatchTry> tries) {
    bool any = false;
    const auto take_all = [&](std::span<Patch> all, std::span<PatchTry> of, bool keep_failed) {
      std::vector<PatchTry> left;
      for (std::size_t i = 0; i < of.size(); ++i) {
        if (of[i].positive && patches.take(all[i])) {
          any = true;
          ++result_.patch_fixes;
          changed_.insert(changed_.end(), all[i].mesh_faces.begin(), all[i].mesh_faces.end());
        } else if (of[i].positive || keep_failed) {
          left.push_back(std::move(of[i]));
        }
      }
      return left;
    };
    std::vector<PatchTry> left = take_all(made, tries, false);
    // The sides of a slit can be in each other's way.
    std::vector<Patch> again = untangled([&](Patch& patch) { hold_boundary(mesh_, patch); }, left);
    left = take_all(again, left, true);
    // From a boundary that is folded, faces can end all positive and twice around a vertex.
    again = untangled([&](Patch& patch) { patches.straighten_boundary(patch); }, left);
    take_all(again, left, true);
    return any;
  }

  const DiskMesh& mesh_;
  const std::vector<RestTriangle>& rest_;
  std::vector<Vec2>& uvs_;
  const RepairOptions options_;
  const Work work_;
  std::int64_t allowance_;      ///< faces of patches that may still be tried
  std::vector<Index> changed_;  ///< faces of which a corner has moved since the last look at all
  RepairResult result_;
};

}  // namespace

RepairResult repair(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                    std::vector<Vec2>& uvs, const RepairOptions& options, const Work& work) {
  return Repair(mesh, rest, uvs, options, work).run();
}

}  // namespace beltrami
