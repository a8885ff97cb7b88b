// Calls the adapter as xatlas would: charts on several threads, orthogonal projections handed in.
// With xatlas at hand, its own header takes the place of the namespace below.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <thread>
#include <vector>

#include "beltrami_xatlas.h"

namespace xatlas {
using ParameterizeFunc = void (*)(const float* positions, float* texcoords,
                                  std::uint32_t vertexCount, const std::uint32_t* indices,
                                  std::uint32_t indexCount);
struct ChartOptions {
  ParameterizeFunc paramFunc = nullptr;
};
}  // namespace xatlas

namespace {

struct Chart {
  std::vector<float> positions, texcoords;
  std::vector<std::uint32_t> indices;
};

/// Half a tube: seen from above its edges fold under, so that the projection is not injective.
Chart half_tube(int across, int along, double bend) {
  Chart chart;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i <= across; ++i) {
      const double angle = bend * (2.0 * i / across - 1);
      const float p[3] = {static_cast<float>(std::sin(angle)), static_cast<float>(0.1 * j),
                          static_cast<float>(std::cos(angle))};
      chart.positions.insert(chart.positions.end(), p, p + 3);
      chart.texcoords.insert(chart.texcoords.end(), p, p + 2);
      if (i == across || j == along) continue;
      const auto a = static_cast<std::uint32_t>(j * (across + 1) + i);
      const std::uint32_t b = a + 1, d = a + static_cast<std::uint32_t>(across) + 1, c = d + 1;
      const std::uint32_t faces[6] = {a, b, c, a, c, d};
      chart.indices.insert(chart.indices.end(), faces, faces + 6);
    }
  }
  return chart;
}

double area(const Chart& chart, std::size_t face, bool in_uv) {
  double p[3][3] = {};
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = chart.indices[3 * face + static_cast<std::size_t>(k)];
    const float* from = in_uv ? &chart.texcoords[2 * v] : &chart.positions[3 * v];
    for (int c = 0; c < (in_uv ? 2 : 3); ++c) p[k][c] = from[c];
  }
  double n[3];
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3, e = (c + 2) % 3;
    n[c] = (p[1][d] - p[0][d]) * (p[2][e] - p[0][e]) - (p[1][e] - p[0][e]) * (p[2][d] - p[0][d]);
  }
  return 0.5 * (in_uv ? n[2] : std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]));
}

/// Whether every face has about the area in UV that it has in space: a tube unrolls isometrically.
bool is_unrolled(const Chart& chart) {
  for (std::size_t face = 0; face < chart.indices.size() / 3; ++face) {
    const double ratio = area(chart, face, true) / area(chart, face, false);
    if (!(ratio > 0.98 && ratio < 1.02)) return false;
  }
  return true;
}

void parameterize(const xatlas::ChartOptions& options, Chart& chart) {
  options.paramFunc(chart.positions.data(), chart.texcoords.data(),
                    static_cast<std::uint32_t>(chart.positions.size() / 3), chart.indices.data(),
                    static_cast<std::uint32_t>(chart.indices.size()));
}

}  // namespace

int main() {
  xatlas::ChartOptions options;
  options.paramFunc = beltrami_xatlas_parameterize;

  Chart charts[3] = {half_tube(30, 12, 1.2), half_tube(24, 20, 2.5), half_tube(8, 5, 1.0)};
  // No disk: a second chart's faces in one call, as a defect of the host would have it.
  charts[2].indices.push_back(0);
  charts[2].indices.push_back(1);
  charts[2].indices.push_back(0);
  const std::vector<float> projection = charts[2].texcoords;

  std::vector<std::thread> workers;
  for (Chart& chart : charts) workers.emplace_back([&] { parameterize(options, chart); });
  for (std::thread& worker : workers) worker.join();

  const bool unrolled = is_unrolled(charts[0]) && is_unrolled(charts[1]);
  const bool kept = charts[2].texcoords == projection;
  std::printf("tubes %s, the chart that is no disk %s its projection\n",
              unrolled ? "unrolled" : "NOT unrolled", kept ? "kept" : "LOST");
  return unrolled && kept ? 0 : 1;
}
