#include "repair/outliers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "exact/certificate.h"
#include "fullspace/assembly.h"
#include "fullspace/newton.h"
#include "repair/patch.h"

namespace beltrami {
namespace {

constexpr std::int64_t kGrain = 8192;
constexpr double kLeastEnergy = 20;
constexpr double kTimesMean = 4;
constexpr int kRounds = 3;
constexpr int kRings = 3;
constexpr int kNewtonSteps = 10;
/// A round that finds more than this share of the faces is no longer about outliers: the global
/// optimisation is faster there.
constexpr double kMostFaces = 0.001;

/// Energy of each face; infinite where it is not positive.
std::vector<double> face_energies(Energy energy, const DiskMesh& mesh,
                                  const std::vector<RestTriangle>& rest,
                                  const std::vector<Vec2>& uvs, int threads) {
  std::vector<double> energies(mesh.faces.size());
  with_density(energy, [&](auto density) {
    parallel_for(threads, mesh.face_count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t f = begin; f < end; ++f) {
        const Triangle& t = mesh.faces[f];
        const SingularValues s =
            singular_values(linear_map(rest[f], uvs[t[0]], uvs[t[1]], uvs[t[2]]));
        energies[f] =
            s.s2 > 0 ? density.value(s.s1, s.s2) : std::numeric_limits<double>::infinity();
      }
    });
  });
  return energies;
}

/// Outliers, worst first.
std::vector<Index> find_outliers(const std::vector<double>& energies,
                                 const std::vector<RestTriangle>& rest) {
  double sum = 0, area = 0;
  for (std::size_t f = 0; f < energies.size(); ++f) {
    if (!std::isfinite(energies[f])) continue;
    sum += rest[f].area() * energies[f];
    area += rest[f].area();
  }
  const double limit = std::max(kLeastEnergy, kTimesMean * sum / area);
  std::vector<Index> outliers;
  for (std::size_t f = 0; f < energies.size(); ++f) {
    if (energies[f] > limit && std::isfinite(energies[f])) {
      outliers.push_back(static_cast<Index>(f));
    }
  }
  std::sort(outliers.begin(), outliers.end(), [&](Index f, Index g) {
    return energies[f] > energies[g] || (energies[f] == energies[g] && f < g);
  });
  const auto most = static_cast<std::size_t>(100 + kMostFaces * static_cast<double>(rest.size()));
  if (outliers.size() > most) outliers.resize(most);
  return outliers;
}

}  // namespace

std::int64_t clean_outliers(Energy energy, const DiskMesh& mesh,
                            const std::vector<RestTriangle>& rest, std::vector<Vec2>& uvs,
                            int threads, const std::vector<Index>& also,
                            const Checkpoint& checkpoint) {
  std::int64_t crossings = -1, patches = 0;
  for (int round = 0; round < kRounds; ++round) {
    auto outliers = find_outliers(face_energies(energy, mesh, rest, uvs, threads), rest);
    if (round == 0) outliers.insert(outliers.end(), also.begin(), also.end());
    std::vector<bool> treated(mesh.faces.size(), false);
    std::size_t done = 0;
    for (const Index face : outliers) {
      checkpoint((round + static_cast<double>(done++) / outliers.size()) / kRounds);
      if (treated[face]) continue;
      Patch patch = cut_patch(mesh, rest, uvs, face, kRings);
      NewtonOptions options;
      options.energy = energy;
      options.max_iterations = kNewtonSteps;
      minimise_energy(patch.faces, patch.rest, patch.fixed, patch.uvs, options);
      if (!non_positive_faces(patch.faces, patch.uvs, 1).empty()) continue;
      if (patch.moves_boundary && crossings < 0) {
        crossings = count_crossings(mesh.boundary, uvs).count;
      }
      patch.exchange(uvs);
      if (patch.moves_boundary) {
        const std::int64_t now = count_crossings(mesh.boundary, uvs).count;
        if (now > crossings) {
          patch.exchange(uvs);
          continue;
        }
        crossings = now;
      }
      ++patches;
      for (const Index f : patch.mesh_faces) treated[f] = true;
    }
    if (outliers.empty()) break;
  }
  return patches;
}

}  // namespace beltrami
