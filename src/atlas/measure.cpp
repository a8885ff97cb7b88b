#include "atlas/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "energy/measure.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

constexpr double kNoEnergy = std::numeric_limits<double>::quiet_NaN();
constexpr double kTopShare = 0.01;  // of the area, beyond the percentile

struct Weighted {
  double energy, area;
};

/// Weighted energies of some faces.
struct Sums {
  double area = 0;              // of all faces
  double left = 0, energy = 0;  // of the faces not left out: area, and energy times area
  double max = kNoEnergy;

  void add(const Weighted& face) {
    area += face.area;
    if (!std::isfinite(face.energy)) return;
    left += face.area;
    energy += face.area * face.energy;
    max = std::fmax(max, face.energy);
  }
  double mean() const { return left > 0 ? energy / left : kNoEnergy; }
};

std::vector<Weighted> face_energies(const AtlasChart& part, const std::vector<Vec2>& uvs,
                                    double density) {
  const DiskMesh& mesh = part.chart.mesh;
  std::vector<Weighted> energies;
  energies.reserve(part.real_faces);
  PollSometimes poll;
  for (Index f = 0; f < part.real_faces; ++f) {
    poll();
    const auto [a, b, c] = mesh.faces[f];
    const FaceDistortion face =
        measure_face({mesh.positions[a], mesh.positions[b], mesh.positions[c]},
                     {uvs[a] / density, uvs[b] / density, uvs[c] / density});
    energies.push_back({face.symmetric_dirichlet, face.area});
  }
  return energies;
}

/// The least energy that no more than 1% of the area exceeds. Precondition: finite energies.
double percentile(std::vector<Weighted>& faces) {
  double area = 0;
  for (const Weighted& face : faces) area += face.area;
  sort_interruptibly(faces.begin(), faces.end(), [](const Weighted& a, const Weighted& b) {
    return std::tie(a.energy, a.area) > std::tie(b.energy, b.area);
  });
  double beyond = 0;
  for (const Weighted& face : faces) {
    beyond += face.area;
    if (beyond > kTopShare * area) return face.energy;
  }
  return kNoEnergy;
}

}  // namespace

AtlasEnergy measure_charts(const std::vector<AtlasChart>& parts,
                           const std::vector<MappedChart>& maps, double scale,
                           std::vector<ChartInfo>& charts, const Work& work) {
  std::vector<std::vector<Weighted>> energies(parts.size());
  parallel_for(work, size_of(parts), 1, [&](std::int64_t c, std::int64_t) {
    energies[c] = face_energies(parts[c], maps[c].uvs, charts[c].density * scale);
  });
  AtlasEnergy atlas;
  Sums all;
  std::vector<Weighted> finite;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    Sums own;
    for (const Weighted& face : energies[c]) {
      own.add(face);
      all.add(face);
      if (std::isfinite(face.energy)) {
        finite.push_back(face);
      } else {
        ++atlas.left_out;
      }
    }
    charts[c].area = own.area;
    charts[c].symmetric_dirichlet = own.mean();
    charts[c].max = own.max;
  }
  atlas.symmetric_dirichlet = all.mean();
  atlas.max = all.max;
  atlas.p99 = percentile(finite);
  return atlas;
}

double seam_length(const std::vector<AtlasChart>& charts, const std::vector<Index>& vertex) {
  struct Side {
    Index low, high;
    double length;
  };
  std::vector<Side> sides;
  PollSometimes poll;
  for (const AtlasChart& part : charts) {
    const Chart& chart = part.chart;
    const DiskMesh& mesh = chart.mesh;
    for (Index h = 0; h < 3 * part.real_faces; ++h) {
      poll();
      if (mesh.twin[h] != kNone) continue;
      const Index from = mesh.origin(h), to = mesh.target(h);
      const auto [low, high] =
          std::minmax(vertex[chart.input_vertex[from]], vertex[chart.input_vertex[to]]);
      sides.push_back({low, high, (mesh.positions[to] - mesh.positions[from]).norm()});
    }
  }
  const auto edge = [](const Side& side) { return std::tie(side.low, side.high); };
  sort_interruptibly(sides.begin(), sides.end(),
                     [&](const Side& a, const Side& b) { return edge(a) < edge(b); });
  double length = 0;
  for (std::size_t i = 0, next = 0; i < sides.size(); i = next) {
    while (next < sides.size() && edge(sides[next]) == edge(sides[i])) ++next;
    if (next - i > 1) length += 0.5 * static_cast<double>(next - i) * sides[i].length;
  }
  return length;
}

}  // namespace beltrami
