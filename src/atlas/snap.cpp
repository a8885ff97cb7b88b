#include "atlas/snap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "base/types.h"
#include "exact/certificate.h"

namespace beltrami {
namespace {

/// Border edges that differ by less than this, as a tangent, are of one direction: half a degree.
constexpr double kOneDirection = 0.009;
/// A map is turned to its border where so much of that lies along two directions at right angles.
constexpr double kWorthTurning = 0.2;
/// Borders whose places differ by less are on one line, in texels.
constexpr double kOneLine = 0.1;
/// What is no farther from a line than rounding may have it lies on it, in texels.
constexpr double kOnLine = 1e-3;
/// Borders along an axis that are shorter are none, in texels.
constexpr double kLeastBorder = 1;

/// A direction up to right angles, as the tangent of its least turn from an axis, within [-1, 1].
double tangent_of(Vec2 edge) {
  if (std::abs(edge.x()) < std::abs(edge.y())) edge = {edge.y(), -edge.x()};
  return edge.y() / edge.x();
}

/// Where borders along an axis lie, and how long they are there.
struct Line {
  double place = 0, length = 0;
  std::vector<Index> vertices;
};

/// Those across axis k, in texels, by their place.
std::vector<Line> lines_across(const DiskMesh& mesh, int k, const std::vector<Vec2>& texels) {
  std::vector<Line> edges;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const Index a = mesh.boundary[i];
    const Index b = mesh.boundary[i + 1 == mesh.boundary.size() ? 0 : i + 1];
    const Vec2 edge = texels[b] - texels[a];
    if (!(std::abs(edge[k]) <= kOneDirection * std::abs(edge[1 - k]))) continue;
    edges.push_back({0.5 * (texels[a][k] + texels[b][k]), std::abs(edge[1 - k]), {a, b}});
  }
  std::sort(edges.begin(), edges.end(), [](const Line& a, const Line& b) {
    return std::pair(a.place, a.vertices) < std::pair(b.place, b.vertices);
  });
  std::vector<Line> lines;
  for (const Line& edge : edges) {
    if (lines.empty() || edge.place - lines.back().place > kOneLine) {
      lines.push_back(edge);
      continue;
    }
    Line& line = lines.back();
    const double length = line.length + edge.length;
    if (length > 0) line.place += (edge.place - line.place) * edge.length / length;
    line.length = length;
    line.vertices.insert(line.vertices.end(), edge.vertices.begin(), edge.vertices.end());
  }
  std::erase_if(lines, [](const Line& line) { return line.length < kLeastBorder; });
  return lines;
}

/// Of lines that would come onto one texel edge the longest alone.
std::vector<Line> apart(std::vector<Line> lines) {
  std::vector<Line> kept;
  for (Line& line : lines) {
    if (kept.empty() || std::round(line.place) > std::round(kept.back().place)) {
      kept.push_back(std::move(line));
    } else if (line.length > kept.back().length) {
      kept.back() = std::move(line);
    }
  }
  return kept;
}

/// Moves coordinate k: lines onto texel edges, and what is between two of them in proportion.
void move(const std::vector<Line>& lines, int k, std::vector<Vec2>& texels) {
  if (lines.empty()) return;
  const auto shift = [](const Line& line) { return std::round(line.place) - line.place; };
  for (Vec2& w : texels) {
    const double old = w[k];
    const auto above =
        std::upper_bound(lines.begin(), lines.end(), w[k],
                         [](double place, const Line& line) { return place < line.place; });
    if (above == lines.begin()) {
      w[k] += shift(lines.front());
    } else if (above == lines.end()) {
      w[k] += shift(lines.back());
    } else {
      const Line& below = *(above - 1);
      const double share = (w[k] - below.place) / (above->place - below.place);
      w[k] += (1 - share) * shift(below) + share * shift(*above);
    }
    for (auto line = above == lines.begin() ? above : above - 1; line != lines.end(); ++line) {
      if (line->place > old + kOnLine) break;
      if (line->place >= old - kOnLine) w[k] = std::round(line->place);
    }
  }
  for (const Line& line : lines) {
    for (const Index v : line.vertices) texels[v][k] = std::round(line.place);
  }
}

}  // namespace

std::optional<Vec2> turn_to_borders(const DiskMesh& mesh, const std::vector<Vec2>& uvs) {
  std::vector<std::pair<double, double>> edges;  // tangents and lengths
  double all = 0;
  for (std::size_t i = 0; i < mesh.boundary.size(); ++i) {
    const std::size_t next = i + 1 == mesh.boundary.size() ? 0 : i + 1;
    const Vec2 edge = uvs[mesh.boundary[next]] - uvs[mesh.boundary[i]];
    const double length = edge.norm();
    if (!(length > 0)) continue;
    const double tangent = tangent_of(edge);
    all += length;
    edges.emplace_back(tangent, length);
    // At 45 degrees the ends of the range meet.
    if (std::abs(tangent) > 1 - 2 * kOneDirection) edges.emplace_back(-1 / tangent, length);
  }
  std::sort(edges.begin(), edges.end());
  double best = 0, along = 0, sum = 0, moment = 0;
  for (std::size_t first = 0, last = 0; last < edges.size(); ++last) {
    sum += edges[last].second;
    moment += edges[last].first * edges[last].second;
    for (; edges[last].first - edges[first].first > kOneDirection; ++first) {
      sum -= edges[first].second;
      moment -= edges[first].first * edges[first].second;
    }
    if (sum > best) {
      best = sum;
      along = moment / sum;
    }
  }
  if (!(best >= kWorthTurning * all) || all == 0) return std::nullopt;
  const double size = portable::hypot(1, along);
  return Vec2(1 / size, -along / size);
}

void align_to_borders(const std::vector<AtlasChart>& charts, std::vector<MappedChart>& maps) {
  for (std::size_t c = 0; c < charts.size(); ++c) {
    MappedChart& map = maps[c];
    if (map.own_turns > 0 || map.error || map.pinned()) continue;
    const std::optional<Vec2> turn = turn_to_borders(charts[c].chart.mesh, map.uvs);
    if (!turn) continue;
    for (Vec2& w : map.uvs) {
      w = {turn->x() * w.x() - turn->y() * w.y(), turn->y() * w.x() + turn->x() * w.y()};
    }
    map.own_turns = 4;
  }
}

void snap_to_texels(const DiskMesh& mesh, int resolution, std::vector<Vec2>& placed,
                    const Work& work) {
  std::vector<Vec2> texels = placed;
  for (Vec2& w : texels) w *= resolution;
  const std::vector<Vec2> before = texels;
  std::array<std::vector<Line>, 2> lines;
  for (int k = 0; k < 2; ++k) {
    lines[k] = apart(lines_across(mesh, k, texels));
    move(lines[k], k, texels);
  }
  if (lines[0].empty() && lines[1].empty()) return;
  if (!certify(mesh.faces, mesh.boundary, texels, work).injective()) {
    texels = before;
    for (int k = 0; k < 2; ++k) {
      const auto longest =
          std::max_element(lines[k].begin(), lines[k].end(),
                           [](const Line& a, const Line& b) { return a.length < b.length; });
      if (longest == lines[k].end()) continue;
      const double shift = std::round(longest->place) - longest->place;
      for (Vec2& w : texels) w[k] += shift;
    }
  }
  for (std::size_t v = 0; v < placed.size(); ++v) placed[v] = texels[v] / resolution;
}

}  // namespace beltrami
