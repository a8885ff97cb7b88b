#include "commands/page_layout.h"

#include <beltrami/beltrami.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/tiles.h"
#include "commands/uv_mesh.h"
#include "files/given_cuts.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

using Pair = std::array<double, 2>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kNoTile = std::numeric_limits<std::uint64_t>::max();

/// Triangles that share a UV vertex, as beltrami_pack has them.
struct Chart {
  Pair low{kInfinity, kInfinity}, high{-kInfinity, -kInfinity};
  double uv_area = 0, area = 0;
  std::uint64_t tile = kNoTile;  ///< counted from 0; of those that it does not leave
};

/// The chart of each triangle, in the order of their first triangles.
std::vector<std::uint32_t> charts_of(const UvMesh& mesh, std::uint32_t& count) {
  std::vector<std::uint32_t> parent(mesh.uvs.size() / 2), number(parent.size(), 0), charts;
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::size_t i = 0; i < mesh.uv_indices.size(); i += 3) {
    for (std::size_t k = 1; k < 3; ++k) {
      parent[root(mesh.uv_indices[i + k])] = root(mesh.uv_indices[i]);
    }
  }
  count = 0;
  for (std::size_t i = 0; i < mesh.uv_indices.size(); i += 3) {
    std::uint32_t& chart = number[root(mesh.uv_indices[i])];
    if (chart == 0) chart = ++count;
    charts.push_back(chart - 1);
  }
  return charts;
}

double area_in_space(const MeshFile& file, const std::uint32_t* vertices) {
  std::array<Pair, 3> sides{};
  const double *a = &file.positions[3 * std::size_t{vertices[0]}],
               *b = &file.positions[3 * std::size_t{vertices[1]}],
               *c = &file.positions[3 * std::size_t{vertices[2]}];
  for (std::size_t d = 0; d < 3; ++d) sides[d] = {b[d] - a[d], c[d] - a[d]};
  double square = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const Pair &p = sides[d], &q = sides[(d + 1) % 3];
    const double part = p[0] * q[1] - p[1] * q[0];
    square += part * part;
  }
  return std::sqrt(square) / 2;
}

double area_in_plane(const UvMesh& mesh, std::size_t corner) {
  const double *a = &mesh.uvs[2 * std::size_t{mesh.uv_indices[corner]}],
               *b = &mesh.uvs[2 * std::size_t{mesh.uv_indices[corner + 1]}],
               *c = &mesh.uvs[2 * std::size_t{mesh.uv_indices[corner + 2]}];
  return std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
}

/// The tile that holds all of a chart: its edges belong to it.
std::uint64_t tile_of(const Chart& chart) {
  Pair first{};
  for (std::size_t d = 0; d < 2; ++d) {
    first[d] = std::floor((chart.low[d] + chart.high[d]) / 2);
    // A chart that is on an edge as a whole is in the tile below.
    if (chart.high[d] == first[d] && first[d] > 0) first[d] -= 1;
    if (chart.low[d] < first[d] || chart.high[d] > first[d] + 1) return kNoTile;
  }
  const bool is_page = first[0] >= 0 && first[0] < static_cast<double>(kPagesInARow) &&
                       first[1] >= 0 && first[1] < static_cast<double>(kMostRowsOfPages);
  if (!is_page) return kNoTile;
  return static_cast<std::uint64_t>(first[0]) + kPagesInARow * static_cast<std::uint64_t>(first[1]);
}

/// Charts moved into the middle of pages, each by the same scale: their distances, which the
/// library measures, are those of the input times the scale, and edges of pages are further away.
class Measured {
 public:
  Measured(const UvMesh& mesh, const std::vector<std::uint32_t>& chart_of_triangle,
           const std::vector<Chart>& charts, const PageLayout& layout)
      : mesh_(mesh), chart_of_triangle_(chart_of_triangle), charts_(charts), layout_(layout) {}

  /// The least distance of two charts of a page; where one leaves its tile all are in one plane.
  std::optional<double> least_distance() {
    move();
    const Context context = make_context();
    set(context.get(), BELTRAMI_OPTION_RESOLUTION, kResolution);
    set(context.get(), BELTRAMI_OPTION_MAX_PAGES,
        static_cast<std::int64_t>(std::max<std::size_t>(layout_.tiles.size(), 1)));
    set(context.get(), BELTRAMI_OPTION_FLOAT32, 0);
    const beltrami_uv_mesh view = uv_view();
    const beltrami_uv_mesh* meshes = &view;
    const beltrami_status status = beltrami_pack(context.get(), &meshes, 1, nullptr, nullptr);
    require_ok(status, "the pages", beltrami_error_message(context.get()), BELTRAMI_ELEMENT_NONE,
               BELTRAMI_NO_ELEMENT);
    beltrami_packing packing{};
    packing.struct_size = sizeof packing;
    require_ok(beltrami_get_packing(context.get(), &packing), "the pages", "",
               BELTRAMI_ELEMENT_NONE, BELTRAMI_NO_ELEMENT);
    // Twice the distance to the edges of pages is no less than this; so far apart, charts are not
    // what the margin is of.
    if (!(packing.margin < kRoom * double(kResolution) * (1 - 1e-9))) return std::nullopt;
    return packing.margin / (scale_ * double(kResolution)) *
           static_cast<double>(layout_.resolution);
  }

 private:
  /// Of a page: the part that charts are moved into, and what is left beside it on both sides.
  static constexpr double kPart = 0.5, kRoom = 0.5;
  static constexpr std::int64_t kResolution = 64;  // nothing is drawn: the least work

  static void set(beltrami_context* context, std::int32_t key, std::int64_t value) {
    require_ok(beltrami_set_int(context, key, value), "the pages", beltrami_error_message(context),
               BELTRAMI_ELEMENT_NONE, BELTRAMI_NO_ELEMENT);
  }

  void move() {
    const bool plane = layout_.astride > 0;
    Pair origin{0, 0};
    double extent = 1;
    if (plane) {
      origin = layout_.low;
      extent = std::max(layout_.high[0] - layout_.low[0], layout_.high[1] - layout_.low[1]);
      if (!(extent > 0)) extent = 1;
    }
    scale_ = kPart / extent;
    uvs_ = mesh_.uvs;
    std::vector<bool> moved(uvs_.size() / 2, false);
    for (std::size_t i = 0; i < mesh_.uv_indices.size(); ++i) {
      const Chart& chart = charts_[chart_of_triangle_[i / 3]];
      const std::uint64_t tile = plane ? 0 : chart.tile;
      if (i % 3 == 0) pages_.push_back(plane ? 0 : rank_of(tile));
      const std::size_t uv = mesh_.uv_indices[i];
      if (moved[uv]) continue;
      moved[uv] = true;
      const auto [u, v] = corner_of_page(tile);
      const Pair corner{plane ? origin[0] : u, plane ? origin[1] : v};
      for (std::size_t d = 0; d < 2; ++d) {
        double& x = uvs_[2 * uv + d];
        x = std::clamp((1 - kPart) / 2 + scale_ * (x - corner[d]), 0.0, 1.0);
      }
    }
  }

  std::uint32_t rank_of(std::uint64_t tile) const {
    const auto at = std::lower_bound(layout_.tiles.begin(), layout_.tiles.end(), tile + kFirstTile);
    return static_cast<std::uint32_t>(at - layout_.tiles.begin());
  }

  beltrami_uv_mesh uv_view() const {
    beltrami_uv_mesh view{};
    view.struct_size = sizeof view;
    view.uv_count = uvs_.size() / 2;
    view.face_count = mesh_.uv_indices.size() / 3;
    view.uvs = {uvs_.data(), 0, BELTRAMI_F64, 0};
    view.uv_indices = {mesh_.uv_indices.data(), 0, BELTRAMI_U32, 0};
    view.kept_pages = {pages_.data(), 0, BELTRAMI_U32, 0};
    view.cancel = interrupt_number();
    return view;
  }

  const UvMesh& mesh_;
  const std::vector<std::uint32_t>& chart_of_triangle_;
  const std::vector<Chart>& charts_;
  const PageLayout& layout_;
  std::vector<double> uvs_;
  std::vector<std::uint32_t> pages_;
  double scale_ = 1;
};

std::vector<Chart> measure_charts(const MeshFile& file, const UvMesh& mesh,
                                  const std::vector<std::uint32_t>& chart_of_triangle,
                                  std::uint32_t count) {
  std::vector<Chart> charts(count);
  for (std::size_t i = 0; i < mesh.uv_indices.size(); i += 3) {
    Chart& chart = charts[chart_of_triangle[i / 3]];
    chart.uv_area += area_in_plane(mesh, i);
    chart.area += area_in_space(file, &mesh.vertices[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t d = 0; d < 2; ++d) {
        const double x = mesh.uvs[2 * std::size_t{mesh.uv_indices[i + k]} + d];
        chart.low[d] = std::min(chart.low[d], x);
        chart.high[d] = std::max(chart.high[d], x);
      }
    }
  }
  for (Chart& chart : charts) chart.tile = tile_of(chart);
  return charts;
}

/// Boxes, tiles and what leaves them.
void place(const std::vector<Chart>& charts, PageLayout& layout) {
  layout.low = {kInfinity, kInfinity};
  layout.high = {-kInfinity, -kInfinity};
  double edge = kInfinity;
  for (const Chart& chart : charts) {
    const bool inside =
        std::min(chart.low[0], chart.low[1]) >= 0 && std::max(chart.high[0], chart.high[1]) <= 1;
    layout.outside += inside ? 0 : 1;
    layout.astride += chart.tile == kNoTile ? 1 : 0;
    if (chart.tile != kNoTile) layout.tiles.push_back(kFirstTile + chart.tile);
    const auto [u, v] = corner_of_page(chart.tile == kNoTile ? 0 : chart.tile);
    const Pair corner{u, v};
    for (std::size_t d = 0; d < 2; ++d) {
      layout.low[d] = std::min(layout.low[d], chart.low[d]);
      layout.high[d] = std::max(layout.high[d], chart.high[d]);
      edge = std::min({edge, chart.low[d] - corner[d], corner[d] + 1 - chart.high[d]});
    }
  }
  layout.edge_distance = edge * static_cast<double>(layout.resolution);
  std::sort(layout.tiles.begin(), layout.tiles.end());
  layout.tiles.erase(std::unique(layout.tiles.begin(), layout.tiles.end()), layout.tiles.end());
}

/// The sums of triangles by what they belong to: one number of `count` for each.
class Densities {
 public:
  explicit Densities(std::size_t count) : sums_(count) {}

  void add(std::size_t number, std::uint64_t face, double uv_area, double area) {
    Sum& sum = sums_[number];
    sum.first_face = std::min(sum.first_face, face);
    sum.uv_area += uv_area;
    sum.area += area;
  }

  /// Those that have a face, by their first ones. `name(number)`.
  template <class Name>
  std::vector<Density> taken(std::uint64_t resolution, const Name& name) const {
    std::vector<Density> all;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const Sum& sum = sums_[i];
      if (sum.first_face == kNoTile) continue;
      const double scale = sum.area > 0 ? std::sqrt(sum.uv_area / sum.area) : 0;
      all.push_back({name(i), sum.first_face, sum.area, scale * static_cast<double>(resolution)});
    }
    std::sort(all.begin(), all.end(),
              [](const Density& a, const Density& b) { return a.first_face < b.first_face; });
    return all;
  }

 private:
  struct Sum {
    std::uint64_t first_face = kNoTile;
    double uv_area = 0, area = 0;
  };
  std::vector<Sum> sums_;
};

void measure_densities(const MeshFile& file, const UvMesh& mesh,
                       const std::vector<std::uint32_t>& corners,
                       const std::vector<std::uint32_t>& chart_of_triangle, const std::string& name,
                       PageLayout& layout) {
  std::vector<std::uint64_t> labels, known;
  std::map<std::uint64_t, std::string> texts;
  if (!name.empty()) {
    labels = face_labels(file, name, "--labels", "tell densities by");
    known = labels;
    std::sort(known.begin(), known.end());
    known.erase(std::unique(known.begin(), known.end()), known.end());
    texts = label_texts(file, name, known);
  }
  Densities charts(layout.charts), by_label(known.size());
  for (std::size_t i = 0; i < mesh.uv_indices.size(); i += 3) {
    const std::uint64_t face = file.polygons.of_corner(corners[i]);
    const double uv_area = area_in_plane(mesh, i), area = area_in_space(file, &mesh.vertices[i]);
    charts.add(chart_of_triangle[i / 3], face, uv_area, area);
    if (name.empty()) continue;
    const auto place = std::lower_bound(known.begin(), known.end(), labels[face]);
    by_label.add(static_cast<std::size_t>(place - known.begin()), face, uv_area, area);
  }
  layout.of_charts = charts.taken(layout.resolution, [](std::size_t) { return std::string(); });
  layout.of_labels =
      by_label.taken(layout.resolution, [&](std::size_t i) { return texts.at(known[i]); });
}

void measure_density(const std::vector<Chart>& charts, PageLayout& layout) {
  double uv_area = 0, area = 0;
  for (const Chart& chart : charts) {
    uv_area += chart.uv_area;
    area += chart.area;
    if (!(chart.area > 0)) continue;
    const double density =
        std::sqrt(chart.uv_area / chart.area) * static_cast<double>(layout.resolution);
    layout.least_density = std::min(layout.least_density.value_or(density), density);
    layout.greatest_density = std::max(layout.greatest_density.value_or(density), density);
  }
  if (area > 0) layout.density = std::sqrt(uv_area / area) * static_cast<double>(layout.resolution);
  layout.utilisation = uv_area / static_cast<double>(std::max<std::size_t>(layout.tiles.size(), 1));
}

/// The corners of triangles that have an area in space, or all where none has: what shows nothing
/// lies anywhere, perhaps across a page, and ties no charts together.
std::vector<std::uint32_t> shown_corners(const MeshFile& file,
                                         const std::vector<std::uint32_t>& corners) {
  const UvMesh mesh = uv_mesh_of(file, corners);
  std::vector<std::uint32_t> shown;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    if (!(area_in_space(file, &mesh.vertices[i]) > 0)) continue;
    shown.insert(shown.end(), {corners[i], corners[i + 1], corners[i + 2]});
  }
  return shown.empty() ? corners : shown;
}

}  // namespace

PageLayout page_layout(const MeshFile& file, const std::vector<std::uint32_t>& all_corners,
                       std::uint64_t resolution, const std::string& labels) {
  PageLayout layout;
  layout.resolution = resolution;
  const std::vector<std::uint32_t> corners = shown_corners(file, all_corners);
  const UvMesh mesh = uv_mesh_of(file, corners);
  std::uint32_t count = 0;
  const std::vector<std::uint32_t> chart_of_triangle = charts_of(mesh, count);
  const std::vector<Chart> charts = measure_charts(file, mesh, chart_of_triangle, count);
  layout.charts = count;
  throw_if_interrupted();
  place(charts, layout);
  measure_density(charts, layout);
  measure_densities(file, mesh, corners, chart_of_triangle, labels, layout);
  layout.chart_distance = Measured(mesh, chart_of_triangle, charts, layout).least_distance();
  const double least =
      std::min(layout.chart_distance.value_or(kInfinity), 2 * layout.edge_distance);
  layout.margin = std::max(least, 0.0);
  return layout;
}

}  // namespace beltrami::cli
