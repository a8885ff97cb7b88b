#include "atlas/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <tuple>

#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "energy/measure.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"

namespace beltrami {
namespace {

constexpr Index kGrain = 8192;  // faces

/// Some faces of a chart.
struct Share {
  std::size_t chart;
  Index first, end;
};

std::vector<Share> shares_of(const std::vector<AtlasChart>& parts) {
  std::vector<Share> shares;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    for (Index f = 0; f < parts[c].real_faces; f += kGrain) {
      shares.push_back({c, f, std::min(f + kGrain, parts[c].real_faces)});
    }
  }
  return shares;
}

void measure_faces(const AtlasChart& part, const std::vector<Vec2>& uvs, double density,
                   const Share& share, std::vector<WeighedEnergy>& energies) {
  const DiskMesh& mesh = part.chart.mesh;
  for (Index f = share.first; f < share.end; ++f) {
    const auto [a, b, c] = mesh.faces[f];
    const FaceDistortion face =
        measure_face({mesh.positions[a], mesh.positions[b], mesh.positions[c]},
                     {uvs[a] / density, uvs[b] / density, uvs[c] / density});
    energies[f] = {face.symmetric_dirichlet, face.area};
  }
}

/// Whether it is a number; others are left out.
bool counts(const WeighedEnergy& face) {
  return std::isfinite(face.energy);
}

}  // namespace

AtlasEnergy measure_charts(const std::vector<AtlasChart>& parts,
                           const std::vector<MappedChart>& maps, double scale,
                           std::vector<ChartInfo>& charts, const Work& work) {
  std::vector<std::vector<WeighedEnergy>> energies(parts.size());
  for (std::size_t c = 0; c < parts.size(); ++c) energies[c].resize(parts[c].real_faces);
  const std::vector<Share> shares = shares_of(parts);
  parallel_for(work, size_of(shares), 1, [&](std::int64_t i, std::int64_t) {
    const std::size_t c = shares[i].chart;
    measure_faces(parts[c], maps[c].uvs, charts[c].density * scale, shares[i], energies[c]);
  });
  std::vector<Index> left_out(parts.size());
  parallel_for(work, size_of(parts), 1, [&](std::int64_t c, std::int64_t) {
    std::vector<WeighedEnergy>& own = energies[c];
    charts[c].area = 0;
    for (const WeighedEnergy& face : own) charts[c].area += face.area;
    left_out[c] = static_cast<Index>(std::erase_if(own, std::not_fn(counts)));
    const EnergySummary summary = summarise(own);
    charts[c].symmetric_dirichlet = summary.mean;
    charts[c].max = summary.max;
  });
  AtlasEnergy atlas;
  std::vector<WeighedEnergy> all;
  for (std::size_t c = 0; c < parts.size(); ++c) {
    all.insert(all.end(), energies[c].begin(), energies[c].end());
    atlas.left_out += left_out[c];
  }
  const EnergySummary summary = summarise(all);
  atlas.symmetric_dirichlet = summary.mean;
  atlas.max = summary.max;
  atlas.p99 = summary.p99;
  atlas.slivers = summary.slivers;
  atlas.mean_with_slivers = summary.mean_of_all;
  atlas.max_with_slivers = summary.max_of_all;
  return atlas;
}

double area_of(const std::vector<AtlasChart>& charts) {
  double area = 0;
  for (const AtlasChart& chart : charts) {
    const DiskMesh& mesh = chart.chart.mesh;
    for (Index f = 0; f < chart.real_faces; ++f) {
      const auto& [i, j, k] = mesh.faces[f];
      area += triangle_area(mesh.positions[i], mesh.positions[j], mesh.positions[k]);
    }
  }
  return area;
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
