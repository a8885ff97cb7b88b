#include "repair/rounding.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/portable_math.h"
#include "base/sort_unique.h"
#include "base/types.h"
#include "exact/crossings.h"
#include "exact/orientation.h"
#include "local/hub_turns.h"
#include "local/kernel.h"
#include "local/patch.h"
#include "local/untangle.h"
#include "mesh/boundary.h"
#include "repair/touching.h"
#include "ring/ring_faces.h"
#include "ring/triangulate_ring.h"

namespace beltrami {
namespace {

/// Units in the last place between the places that are tried, sweep by sweep.
constexpr std::array<int, 6> kSpacings = {1, 1, 2, 4, 8, 16};
constexpr int kReach = 2;  // of these to each side
/// Of the way into a kernel, the first that is tried; each next one is twice as much.
constexpr double kLeastShare = 0x1p-12;
constexpr std::array<int, 4> kPatchRings = {1, 2, 4, 8};
constexpr std::size_t kMostPatches = 2000;
constexpr int kCrossingRounds = 4;
/// Units in the last place by which sides that touch are parted.
constexpr std::array<int, 6> kSideSpacings = {1, 2, 4, 8, 16, 32};
constexpr std::int64_t kGrain = 16384;

/// Mends the faces of one triangulated disk whose vertices are at such numbers.
class Rounding {
 public:
  /// The vertices `held`, per vertex of the first ones, do not move, and those of `rim` by no more
  /// than some units in the last place: further out, what they bound would be where others are.
  Rounding(const DiskMesh& mesh, const std::vector<bool>& held, const std::vector<Index>& rim,
           const Numbers& numbers, std::vector<Vec2>& uvs, const Work& work)
      : mesh_(mesh),
        held_(held),
        stays_near_(mesh.on_boundary),
        numbers_(numbers),
        uvs_(uvs),
        work_(work) {
    held_.resize(mesh.positions.size(), false);
    for (const Index v : rim) stays_near_[v] = true;
  }

  /// Tries to make `faces` positive, and never makes another face worse.
  void mend(std::vector<Index> faces) {
    for (const int spacing : kSpacings) {
      HubTurns turns(mesh_);
      for (const Index face : faces) {
        poll_interrupt();
        for (const Index v : mesh_.faces[face]) {
          if (!positive(face) && !held_[v] && turns.take(v)) improve(v, spacing);
        }
      }
      keep_bad(faces);
      if (faces.empty()) return;
      work_.report(0);
    }
    if (faces.size() > kMostPatches) return;
    for (const int rings : kPatchRings) {
      std::vector<bool> tried(mesh_.faces.size(), false);
      for (const Index face : faces) {
        work_.report(0);
        if (!positive(face) && !tried[face]) mend_patch(face, rings, tried);
      }
      keep_bad(faces);
      if (faces.empty()) return;
    }
  }

 private:
  /// How well the faces at a vertex lie: fewest that are not positive, then the greatest least
  /// height.
  struct Quality {
    int bad = 0;
    double least_height = std::numeric_limits<double>::infinity();
    bool operator<(const Quality& other) const {  // worse than
      return bad != other.bad ? bad > other.bad : least_height < other.least_height;
    }
  };

  bool positive(Index face) const {
    const Triangle& t = mesh_.faces[face];
    return orientation(uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]) > 0;
  }

  void keep_bad(std::vector<Index>& faces) const {
    std::erase_if(faces, [&](Index face) { return positive(face); });
  }

  Quality quality_at(Index vertex) const {
    Quality quality;
    PollSometimes poll;
    mesh_.for_each_outgoing(vertex, [&](Index h) {
      poll();
      const Triangle& t = mesh_.faces[h / 3];
      if (orientation(uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]) <= 0) ++quality.bad;
      const Vec2 a = uvs_[t[1]] - uvs_[t[0]], b = uvs_[t[2]] - uvs_[t[0]];
      const double longest = std::max({a.norm(), b.norm(), (b - a).norm()});
      const double height = (a.x() * b.y() - a.y() * b.x()) / longest;
      quality.least_height = std::min(quality.least_height, std::isnan(height) ? 0 : height);
    });
    return quality;
  }

  void improve(Index vertex, int spacing) {
    const Vec2 start = uvs_[vertex];
    Quality best = quality_at(vertex);
    Vec2 place = start;
    const auto attempt = [&](const Vec2& trial) {
      uvs_[vertex] = numbers_.nearest(trial);
      const Quality quality = quality_at(vertex);
      if (!(best < quality)) return;
      best = quality;
      place = uvs_[vertex];
    };
    const Vec2 unit = spacing * Vec2(numbers_.spacing(start.x()), numbers_.spacing(start.y()));
    for (int i = -kReach; i <= kReach; ++i) {
      for (int j = -kReach; j <= kReach; ++j) {
        attempt({start.x() + i * unit.x(), start.y() + j * unit.y()});
      }
    }
    // Far away, so only where nothing near serves.
    if (best.bad > 0 && !stays_near_[vertex]) {
      std::vector<Vec2> ring;
      mesh_.for_each_outgoing(vertex, [&](Index h) { ring.push_back(uvs_[mesh_.target(h)]); });
      const auto centre = kernel_centroid(ring);
      // No further into the kernel than serves: its faces may be large beside the one that is not.
      for (double share = kLeastShare; centre && share <= 1 && best.bad > 0; share *= 2) {
        attempt(start + share * (*centre - start));
      }
    }
    uvs_[vertex] = place;
  }

  /// Towards equilateral faces of the mean size, whatever their shapes in space: what the
  /// numbers cannot hold is a sliver. Marks the faces of the patch as tried.
  void mend_patch(Index face, int rings, std::vector<bool>& tried) {
    Patch patch = cut_patch(mesh_, {}, uvs_, face, rings);
    for (const Index f : patch.mesh_faces) tried[f] = true;
    for (std::size_t v = 0; v < patch.fixed.size(); ++v) {
      const Index own = patch.mesh_vertices[v];
      patch.fixed[v] = patch.fixed[v] || stays_near_[own] || held_[own];
    }
    double area = 0;
    for (const Triangle& t : patch.faces) {
      const Vec2 a = patch.uvs[t[1]] - patch.uvs[t[0]], b = patch.uvs[t[2]] - patch.uvs[t[0]];
      area += 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    }
    const double side = std::sqrt(area / static_cast<double>(patch.faces.size()) / kEquilateral);
    if (!(side > 0)) return;
    patch.rest.assign(patch.faces.size(), {side, 0.5 * side, 2 * kEquilateral * side});
    if (!untangle(patch.faces, patch.rest, patch.fixed, patch.uvs, work_.aside())) return;
    for (Vec2& w : patch.uvs) w = numbers_.nearest(w);
    if (non_positive_faces(patch.faces, patch.uvs, work_.aside()).empty()) patch.exchange(uvs_);
  }

  static constexpr double kEquilateral = 0.43301270189221932;  // area for a side of 1

  const DiskMesh& mesh_;
  std::vector<bool> held_;        // per vertex
  std::vector<bool> stays_near_;  // per vertex
  const Numbers numbers_;
  std::vector<Vec2>& uvs_;
  const Work work_;
};

/// The mesh and the ring around its boundary as one disk; the circle's points come last. Nothing
/// where the boundary is not simple to begin with, or too small for a circle around it.
std::optional<DiskMesh> surround(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                                 const Work& work) {
  const std::vector<Vec2> polygon = boundary_polygon(mesh, uvs);
  std::vector<Triangle> faces = mesh.faces;
  std::size_t vertices = uvs.size();
  try {
    const RingTriangulation ring = triangulate_ring(polygon, scaffold_circle(polygon));
    glue_ring(ring.faces, mesh.boundary, size_of(uvs), faces);
    vertices += ring.points.size() - polygon.size();
  } catch (const Error& error) {
    if (error.fault() != Fault::kInternal) throw;
    return std::nullopt;
  }
  return build_disk(std::vector<Vec3>(vertices, Vec3::Zero()), std::move(faces), work);
}

/// The ring's faces at the edges that cross.
std::vector<Index> faces_at_crossings(const DiskMesh& mesh, const DiskMesh& surrounded,
                                      const std::vector<Vec2>& uvs) {
  const Index count = size_of(mesh.boundary);
  std::vector<Index> vertices, faces;
  for (const auto& pair : find_crossings(mesh.boundary, uvs)) {
    for (const Index edge : pair) {
      vertices.push_back(mesh.boundary[edge]);
      vertices.push_back(mesh.boundary[(edge + 1) % count]);
    }
  }
  sort_unique(vertices);
  for (const Index v : vertices) {
    surrounded.for_each_outgoing(v, [&](Index h) {
      if (h / 3 >= mesh.face_count()) faces.push_back(h / 3);
    });
  }
  sort_unique(faces);
  return faces;
}

std::int64_t faults(const Certificate& certificate) {
  return certificate.orientations.negative + certificate.orientations.degenerate +
         certificate.crossings.count;
}

/// Mends boundary crossings, and flips that need the boundary to move. `uvs`: before rounding.
void mend_with_ring(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                    const std::vector<bool>& held, const Numbers& numbers, const Work& work,
                    Rounded& result) {
  const auto surrounded = surround(mesh, uvs, work);
  if (!surrounded) return;
  std::vector<Vec2> places = result.uvs;
  for (const Vec2& w : scaffold_circle(result.uvs)) {
    places.push_back(numbers.nearest(w));
  }
  for (int round = 0; round < kCrossingRounds && !result.certificate.injective(); ++round) {
    auto faces = non_positive_faces(mesh.faces, places, work);
    const auto beside = faces_at_crossings(mesh, *surrounded, places);
    faces.insert(faces.end(), beside.begin(), beside.end());
    Rounding(*surrounded, held, mesh.boundary, numbers, places, work).mend(std::move(faces));
    const std::vector<Vec2> mended(places.begin(),
                                   places.begin() + static_cast<std::ptrdiff_t>(uvs.size()));
    const Certificate after = certify(mesh.faces, mesh.boundary, mended, work);
    if (faults(after) >= faults(result.certificate)) return;
    result.uvs = mended;
    result.certificate = after;
  }
}

/// Parts sides that rounding has laid on each other, by the least of some multiples of the spacing
/// of the numbers, and mends what that folds. Whether the map is injective then; else the result is
/// left as it is.
bool part_sides(const DiskMesh& mesh, const std::vector<bool>& held, const Numbers& numbers,
                const Work& work, Rounded& result) {
  double greatest = 0;
  for (const Index v : mesh.boundary) {
    greatest = std::max(greatest, result.uvs[v].cwiseAbs().maxCoeff());
  }
  const double spacing = numbers.spacing(greatest);
  for (const int multiple : kSideSpacings) {
    auto moved = with_sides_apart(mesh.boundary, result.uvs, multiple * spacing,
                                  [&](const Vec2& place) { return numbers.nearest(place); });
    if (!moved) continue;
    for (std::size_t v = 0; v < held.size(); ++v) {
      if (held[v] && (*moved)[v] != result.uvs[v]) return false;
    }
    auto bad = non_positive_faces(mesh.faces, *moved, work);
    if (!bad.empty()) Rounding(mesh, held, {}, numbers, *moved, work).mend(std::move(bad));
    const Certificate certificate = certify(mesh.faces, mesh.boundary, *moved, work);
    if (!certificate.injective()) continue;
    result.uvs.swap(*moved);
    result.certificate = certificate;
    return true;
  }
  return false;
}

template <class Real>
double nearest_of(double x) {
  const double greatest = std::numeric_limits<Real>::max();
  return static_cast<double>(static_cast<Real>(std::clamp(x, -greatest, greatest)));
}

template <class Real>
double spacing_of(double x) {
  const auto number = static_cast<Real>(std::abs(x));
  const Real next = std::nextafter(number, std::numeric_limits<Real>::infinity());
  return static_cast<double>(next) - static_cast<double>(number);
}

}  // namespace

double Numbers::delivered(double x) const {
  const double number = portable::times_power_of_two(x, -exponent);
  if (step > 0) return step * std::floor(number / step + 0.5);
  return single ? nearest_of<float>(number) : nearest_of<double>(number);
}

double Numbers::nearest(double x) const {
  constexpr int kModerate = 400;  // the product of two such powers is far from both ends
  const double size = std::abs(x);
  const bool moderate = size > 0x1p-400 && size < 0x1p400 && std::abs(exponent) < kModerate;
  if (!single && step == 0 && moderate) return x;
  return portable::times_power_of_two(delivered(x), exponent);
}

double Numbers::spacing(double x) const {
  const double number = delivered(x);
  if (step > 0) return portable::times_power_of_two(step, exponent);
  const double spacing = single ? spacing_of<float>(number) : spacing_of<double>(number);
  return portable::times_power_of_two(spacing, exponent);
}

bool Numbers::hold(const std::vector<Vec2>& places, const Work& work) const {
  const double greatest =
      single ? std::numeric_limits<float>::max() : std::numeric_limits<double>::max();
  const auto out_of_range = [&](const Vec2& place) {
    const Vec2 number(portable::times_power_of_two(place.x(), -exponent),
                      portable::times_power_of_two(place.y(), -exponent));
    return !(number.cwiseAbs().maxCoeff() <= greatest);
  };
  std::vector<Eigen::AlignedBox2d> of_chunk(places.size() / kGrain + 1);
  std::atomic<bool> in_range{true};
  parallel_for(work, size_of(places), kGrain, [&](std::int64_t begin, std::int64_t end) {
    Eigen::AlignedBox2d box;
    for (std::int64_t v = begin; v < end; ++v) {
      if (out_of_range(places[v])) in_range = false;
      box.extend(nearest(places[v]));
    }
    of_chunk[begin / kGrain] = box;
  });
  if (!in_range) return false;
  Eigen::AlignedBox2d box;
  for (const Eigen::AlignedBox2d& own : of_chunk) box.extend(own);
  return box.sizes().minCoeff() > 0;
}

bool unfold_nearby(const DiskMesh& mesh, const Numbers& numbers, const Work& work,
                   std::vector<Vec2>& uvs) {
  Rounding(mesh, {}, {}, numbers, uvs, work).mend(non_positive_faces(mesh.faces, uvs, work));
  return non_positive_faces(mesh.faces, uvs, work).empty();
}

Rounded round_map(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<Vec2>& placed, const Numbers& numbers, const Work& work) {
  return round_map(mesh, uvs, placed, {}, numbers, work);
}

Rounded round_map(const DiskMesh& mesh, const std::vector<Vec2>& uvs,
                  const std::vector<Vec2>& placed, const std::vector<bool>& held,
                  const Numbers& numbers, const Work& work) {
  Rounded result;
  parallel_assign(work, result.uvs, placed.size());
  parallel_for(work, size_of(placed), kGrain, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t v = begin; v < end; ++v) result.uvs[v] = numbers.nearest(placed[v]);
  });
  const auto judge = [&] {
    result.certificate = certify(mesh.faces, mesh.boundary, result.uvs, work);
    return result.certificate.injective();
  };
  if (judge()) return result;
  // Of what falls onto a line, few faces may still find room beside it.
  const bool may_find_room = numbers.step > 0 && mesh.faces.size() <= kMostPatches;
  if (!may_find_room && !numbers.hold(placed, work)) return result;
  const Certificate exact = certify(mesh.faces, mesh.boundary, uvs, work);
  const std::vector<Vec2> nearest = result.uvs;
  auto bad = non_positive_faces(mesh.faces, result.uvs, work);
  if (!bad.empty() && exact.orientations.first_bad_face == kNone) {
    Rounding(mesh, held, {}, numbers, result.uvs, work).mend(std::move(bad));
    judge();
  }
  if (exact.injective() && !result.certificate.injective() &&
      !part_sides(mesh, held, numbers, work, result)) {
    mend_with_ring(mesh, uvs, held, numbers, work, result);
  }
  for (std::size_t v = 0; v < placed.size(); ++v) result.moved += result.uvs[v] != nearest[v];
  return result;
}

}  // namespace beltrami
