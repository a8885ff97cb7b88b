#include "repair/outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_set>
#include <utility>

#include "base/parallel.h"
#include "descend/newton.h"
#include "exact/certificate.h"
#include "local/patch.h"
#include "local/patch_tries.h"
#include "local/patch_work.h"
#include "mesh/face_block.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;
constexpr double kLeastEnergy = 20;
constexpr double kTimesMean = 4;
constexpr int kRounds = 3;
constexpr int kRings = 3;
constexpr int kNewtonSteps = 10;
constexpr double kLittle = 3e-3;  // relative gain of a patch, at which it is left as it is
/// A round that finds more than this share of the faces is no longer about outliers: the global
/// optimisation is faster there.
constexpr double kMostFaces = 0.001;

/// Energies of single faces of a map, and the one above which a face is an outlier.
template <class Density>
class FaceEnergies {
 public:
  FaceEnergies(const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
               const std::vector<Vec2>& uvs)
      : mesh_(mesh), rest_(rest), uvs_(uvs) {}

  /// Infinite where the face is not positive.
  double of(std::int64_t face) const {
    const Triangle& t = mesh_.faces[face];
    const LinearMap map = linear_map(rest_[face], uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]);
    const bool positive = std::norm(map.fz) > std::norm(map.fzbar);
    return positive ? Density::slopes(map).value : std::numeric_limits<double>::infinity();
  }

  /// The same of all faces of a block.
  static void energies_of(const FaceBlock& block, FaceBlock::Numbers& energies) {
    FaceBlock::Numbers det;
    for (int i = 0; i < FaceBlock::kFaces; ++i) {
      const LinearMap map = block.map(i);
      energies[i] = Density::slopes(map).value;
      det[i] = std::norm(map.fz) - std::norm(map.fzbar);
    }
    for (int i = 0; i < FaceBlock::kFaces; ++i) {  // apart, so that the loop above has no branch
      if (!(det[i] > 0)) energies[i] = std::numeric_limits<double>::infinity();
    }
  }

  /// Sets the limit by the mean over all positive faces. Returns the faces above it.
  std::vector<Index> find_all(const Work& work) {
    const double least = from_dirichlet<Density>(kLeastEnergy);
    std::vector<double> sums(mesh_.faces.size() / kGrain + 1, 0), areas(sums);
    std::vector<std::vector<std::pair<Index, double>>> high(sums.size());
    parallel_for(work, mesh_.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
      double sum = 0, area = 0;
      FaceBlock block;
      FaceBlock::Numbers energies;
      for (std::int64_t first = begin; first < end; first += FaceBlock::kFaces) {
        block.load(mesh_.faces, rest_, uvs_, first, end);
        energies_of(block, energies);
        const auto count = std::min<std::int64_t>(FaceBlock::kFaces, end - first);
        for (int i = 0; i < count; ++i) {
          if (!std::isfinite(energies[i])) continue;
          sum += block.rest(i).area() * energies[i];
          area += block.rest(i).area();
          if (energies[i] > least) {
            high[begin / kGrain].emplace_back(static_cast<Index>(first + i), energies[i]);
          }
        }
      }
      sums[begin / kGrain] = sum;
      areas[begin / kGrain] = area;
    });
    const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) /
                        std::accumulate(areas.begin(), areas.end(), 0.0);
    limit_ = std::max(least, kTimesMean * mean);
    std::vector<Index> found;
    for (const auto& of_chunk : high) {
      for (const auto& [f, energy] : of_chunk) {
        if (is_outlier(energy)) found.push_back(f);
      }
    }
    return found;
  }

  /// Leaves the outliers among the faces, each once, worst first, and no more than are worth it.
  void keep_outliers(std::vector<Index>& faces) const {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::vector<std::pair<double, Index>> ranked;
    for (const Index f : faces) {
      const double energy = of(f);
      if (is_outlier(energy)) ranked.emplace_back(-energy, f);
    }
    std::sort(ranked.begin(), ranked.end());
    const auto most =
        static_cast<std::size_t>(100 + kMostFaces * static_cast<double>(rest_.size()));
    if (ranked.size() > most) ranked.resize(most);
    faces.clear();
    for (const auto& [rank, f] : ranked) faces.push_back(f);
  }

 private:
  bool is_outlier(double energy) const { return energy > limit_ && std::isfinite(energy); }

  const DiskMesh& mesh_;
  const std::vector<RestTriangle>& rest_;
  const std::vector<Vec2>& uvs_;
  double limit_ = 0;
};

/// Minimises the energy of each patch from the map as it is now, side by side. Returns for each
/// whether that gained little.
std::vector<std::uint8_t> minimise(Energy energy, const std::vector<Vec2>& uvs, const Work& work,
                                   std::vector<PatchTry>& tries) {
  NewtonOptions options;
  options.energy = energy;
  options.max_iterations = kNewtonSteps;
  const Work alone = work.aside();
  std::vector<std::uint8_t> little(tries.size(), 0);
  parallel_for(work, size_of(tries), 1, [&](std::int64_t i, std::int64_t) {
    Patch& patch = tries[i].patch;
    patch.refresh(uvs);
    const NewtonResult ended =
        minimise_energy(patch.faces, patch.rest, patch.fixed, patch.uvs, options, alone);
    const double gain = ended.energies.front() - ended.energies.back();
    const double enough = kLittle * comparable_energy(energy, ended.energies.back());
    little[i] = ended.converged && gain <= enough;
    tries[i].positive = non_positive_faces(patch.faces, patch.uvs, alone).empty();
  });
  return little;
}

template <class Density>
std::int64_t clean(Energy energy, const DiskMesh& mesh, const std::vector<RestTriangle>& rest,
                   std::vector<Vec2>& uvs, const std::vector<Index>& also, const Work& work) {
  FaceEnergies<Density> energies(mesh, rest, uvs);
  PatchWork taken(mesh, uvs);
  std::int64_t patches = 0;
  std::vector<Index> outliers = energies.find_all(work);
  energies.keep_outliers(outliers);
  outliers.insert(outliers.end(), also.begin(), also.end());
  std::unordered_set<Index> treated, at_rest;  // of this round; by the last patch at them
  for (int round = 0; round < kRounds && !outliers.empty(); ++round) {
    treated.clear();
    for (std::size_t begin = 0; begin < outliers.size(); begin += kTogether) {
      const std::span<const Index> all = outliers;
      const auto some = all.subspan(begin, std::min(kTogether, all.size() - begin));
      std::vector<PatchTry> waiting;
      for (const Index face : some) waiting.push_back({face, {}});
      const auto is_treated = [&](Index face) { return treated.contains(face); };
      while (!waiting.empty()) {
        if (work.out_of_time()) return patches;
        work.report((round + static_cast<double>(begin) / outliers.size()) / kRounds);
        std::vector<PatchTry> tries =
            take_apart(mesh, rest, uvs, kRings, is_treated, work, waiting);
        const std::vector<std::uint8_t> little = minimise(energy, uvs, work, tries);
        for (std::size_t i = 0; i < tries.size(); ++i) {
          Patch& patch = tries[i].patch;
          if (!tries[i].positive || !taken.take(patch)) continue;
          ++patches;
          treated.insert(patch.mesh_faces.begin(), patch.mesh_faces.end());
          for (const Index face : patch.mesh_faces) {
            if (little[i] != 0) {
              at_rest.insert(face);
            } else {
              at_rest.erase(face);
            }
          }
        }
      }
    }
    // No other face has changed.
    outliers.insert(outliers.end(), treated.begin(), treated.end());
    energies.keep_outliers(outliers);
    std::erase_if(outliers, [&](Index face) { return at_rest.contains(face); });
  }
  return patches;
}

}  // namespace

std::int64_t clean_outliers(Energy energy, const DiskMesh& mesh,
                            const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                            const std::vector<Index>& also, const Work& work) {
  return with_density(energy, [&]<class Density>(Density) {
    return clean<Density>(energy, mesh, rest, uvs, also, work);
  });
}

}  // namespace beltrami
