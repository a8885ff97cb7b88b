// Several surfaces at once, with all that can be asked for beside them: polygons, labels, pins that
// stay and that slide, straight edges, rectangles, densities, paint; judged from outside.
#include <beltrami/beltrami.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <string_view>
#include <utility>
#include <vector>

#include "host.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

/// One surface, all of whose numbers are in range, so that what is behind the checks is reached.
struct Part {
  std::vector<double> positions, densities, pin_uvs, pin_directions, vertex_paint, edge_paint;
  std::vector<std::uint32_t> corners, sizes, labels, materials, seams, pins, pin_kinds, painted,
      straight, straight_kinds, rectangles, rectangle_corners;

  std::uint32_t vertices() const { return static_cast<std::uint32_t>(positions.size() / 3); }

  beltrami_surface surface() const {
    auto out = sized<beltrami_surface>();
    out.vertex_count = vertices();
    out.face_count = sizes.size();
    out.corner_count = corners.size();
    out.positions = view(positions);
    out.indices = view(corners);
    out.face_sizes = view(sizes);
    out.face_labels = view(labels);
    out.densities = view(densities);
    out.seams = view(seams);
    out.seam_count = seams.size() / 2;
    out.pins = view(pins);
    out.pin_uvs = view(pin_uvs);
    out.pin_kinds = view(pin_kinds);
    out.pin_directions = view(pin_directions);
    out.pin_count = pins.size();
    out.vertex_paint = view(vertex_paint);
    out.painted_edges = view(painted);
    out.edge_paint = view(edge_paint);
    out.painted_edge_count = edge_paint.size();
    out.materials = view(materials);
    out.straight_edges = view(straight);
    out.straight_kinds = view(straight_kinds);
    out.straight_edge_count = straight_kinds.size();
    out.rectangles = view(rectangles);
    out.rectangle_corners = view(rectangle_corners);
    out.rectangle_count = rectangles.size();
    return out;
  }
};

/// What is asked for goes together, mostly: all calls would be refused otherwise.
struct Plan {
  bool pins, pages, searches, anything;

  explicit Plan(Provider& data) {
    const int kind = data.ConsumeIntegralInRange(0, 15);
    pins = kind < 3;
    pages = kind > 3;
    searches = kind == 5;
    anything = kind == 6;
  }
};

/// Rows and columns of quads, rolled up or not, some of them cut into triangles.
void add_grid(Provider& data, Part& part) {
  const auto columns = data.ConsumeIntegralInRange<std::uint32_t>(1, 4);
  const auto rows = data.ConsumeIntegralInRange<std::uint32_t>(1, 4);
  const bool rolled = columns > 2 && data.ConsumeIntegralInRange(0, 3) == 0;
  const std::uint32_t first = part.vertices(), across = rolled ? columns : columns + 1;
  for (std::uint32_t j = 0; j <= rows; ++j) {
    for (std::uint32_t i = 0; i < across; ++i) {
      const double turn = 6.2831853 * i / across;
      const double x = rolled ? std::cos(turn) : i, z = rolled ? std::sin(turn) : 0;
      part.positions.insert(part.positions.end(), {x, static_cast<double>(j), z});
    }
  }
  const bool quads = data.ConsumeBool();
  for (std::uint32_t j = 0; j < rows; ++j) {
    for (std::uint32_t i = 0; i < columns; ++i) {
      const auto at = [&](std::uint32_t x, std::uint32_t y) {
        return first + y * across + x % across;
      };
      const std::array quad = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      if (quads) {
        part.corners.insert(part.corners.end(), quad.begin(), quad.end());
        part.sizes.push_back(4);
      } else {
        part.corners.insert(part.corners.end(),
                            {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
        part.sizes.insert(part.sizes.end(), {3, 3});
      }
    }
  }
}

/// Polygons of any vertices.
void add_chaos(Provider& data, Part& part) {
  const std::uint32_t first = part.vertices();
  const auto points = data.ConsumeIntegralInRange<std::uint32_t>(3, 7);
  for (std::uint32_t i = 0; i < 3 * points; ++i) {
    part.positions.push_back(data.ConsumeIntegralInRange(-2, 2));
  }
  for (int f = data.ConsumeIntegralInRange(1, 6); f > 0; --f) {
    const auto size = data.ConsumeIntegralInRange<std::uint32_t>(3, 5);
    for (std::uint32_t k = 0; k < size; ++k) {
      part.corners.push_back(first + data.ConsumeIntegralInRange(0u, points - 1));
    }
    part.sizes.push_back(size);
  }
}

std::vector<std::uint32_t> numbers(Provider& data, std::size_t count, std::uint32_t most) {
  std::vector<std::uint32_t> out(count);
  for (std::uint32_t& x : out) x = data.ConsumeIntegralInRange(0u, most);
  return out;
}

std::vector<double> factors(Provider& data, std::size_t count) {
  std::vector<double> out(count);
  for (double& x : out) x = data.ConsumeIntegralInRange(1, 16) / 4.0;
  return out;
}

void add_pins(Provider& data, Part& part) {
  const auto count = data.ConsumeIntegralInRange<std::size_t>(1, 4);
  const bool slide = data.ConsumeBool();
  for (std::size_t i = 0; i < count; ++i) {
    const auto last = static_cast<std::uint32_t>(part.corners.size() - 1);
    const std::uint32_t corner = data.ConsumeIntegralInRange(0u, last);
    const double* at = &part.positions[3 * std::size_t{part.corners[corner]}];
    part.pins.push_back(corner);
    for (std::size_t k = 0; k < 2; ++k) {
      const double shift =
          data.ConsumeIntegralInRange(0, 3) ? 0 : data.ConsumeIntegralInRange(-2, 2);
      part.pin_uvs.push_back(at[k] + shift / 4);
      if (slide) part.pin_directions.push_back(data.ConsumeIntegralInRange(0, 3) - 1.5);
    }
    if (slide) part.pin_kinds.push_back(data.ConsumeIntegralInRange(0u, 3u));
  }
}

/// An edge of a face.
std::array<std::uint32_t, 2> edge(Provider& data, const Part& part) {
  const auto faces = static_cast<std::uint32_t>(part.sizes.size());
  const std::uint32_t face = data.ConsumeIntegralInRange(0u, faces - 1);
  std::size_t begin = 0;
  for (std::uint32_t f = 0; f < face; ++f) begin += part.sizes[f];
  const std::uint32_t k = data.ConsumeIntegralInRange(0u, part.sizes[face] - 1);
  return {part.corners[begin + k], part.corners[begin + (k + 1) % part.sizes[face]]};
}

void add_straight(Provider& data, Part& part) {
  for (int i = data.ConsumeIntegralInRange(0, 4); i > 0; --i) {
    const auto ends = edge(data, part);
    part.straight.insert(part.straight.end(), ends.begin(), ends.end());
    part.straight_kinds.push_back(data.ConsumeIntegralInRange(1u, 3u));
  }
  if (data.ConsumeBool()) return;
  const auto last = static_cast<std::uint32_t>(part.sizes.size() - 1);
  part.rectangles = numbers(data, data.ConsumeIntegralInRange<std::size_t>(1, 2), last);
  if (data.ConsumeBool()) return;
  part.rectangle_corners = numbers(data, 4 * part.rectangles.size(), part.vertices() - 1);
}

Part part(Provider& data, const Plan& plan) {
  Part out;
  for (int n = data.ConsumeIntegralInRange(1, 2); n > 0; --n) {
    data.ConsumeIntegralInRange(0, 3) ? add_grid(data, out) : add_chaos(data, out);
  }
  if (data.ConsumeBool()) {
    for (double& x : out.positions) x += data.ConsumeIntegralInRange(-2, 2) / 8.0;
  }
  const auto has = [&](int one_of) { return data.ConsumeIntegralInRange(1, one_of) == 1; };
  if (has(4)) out.labels = numbers(data, out.sizes.size(), 1);
  const bool paints = plan.searches || plan.anything, pins = plan.pins || plan.anything;
  if (paints && has(2)) out.materials = numbers(data, out.sizes.size(), 1);
  if (paints && has(2)) out.vertex_paint = factors(data, out.vertices());
  if ((!plan.pins || plan.anything) && has(6)) out.densities = factors(data, out.sizes.size());
  for (int i = has(3) ? 3 : 0; i > 0; --i) {
    const auto ends = edge(data, out);
    out.seams.insert(out.seams.end(), ends.begin(), ends.end());
  }
  if (paints && has(2)) {
    const auto ends = edge(data, out);
    out.painted = {ends[0], ends[1]};
    out.edge_paint = {0.5};
  }
  if ((!plan.pins || plan.anything) && has(3)) add_straight(data, out);
  if (pins && has(2)) add_pins(data, out);
  return out;
}

void set_options(Provider& data, const Plan& plan, beltrami_context* context) {
  const auto set = [&](std::int32_t key, std::int64_t value) {
    promise(beltrami_set_int(context, key, value) == BELTRAMI_OK, "an option is set");
  };
  set(BELTRAMI_OPTION_CUT, plan.searches ? BELTRAMI_CUT_AUTO : BELTRAMI_CUT_MINIMAL);
  set(BELTRAMI_OPTION_THREADS, 1);
  set(BELTRAMI_OPTION_FLOAT32, data.ConsumeBool());
  set(BELTRAMI_OPTION_SHARE_COPIES, data.ConsumeIntegralInRange(0, 7) == 0);
  if (!plan.pins) {
    set(BELTRAMI_OPTION_RECTIFY, data.ConsumeIntegralInRange(0, 3) == 0);
    set(BELTRAMI_OPTION_STACK, std::max(0, data.ConsumeIntegralInRange(-6, 2)));
    if (!plan.pages) set(BELTRAMI_OPTION_PACK, BELTRAMI_PACK_NONE);
  }
  if (!plan.pages && !plan.anything) return;
  set(BELTRAMI_OPTION_EFFORT, BELTRAMI_EFFORT_QUICK);
  set(BELTRAMI_OPTION_RESOLUTION, data.ConsumeBool() ? 64 : 32);
  set(BELTRAMI_OPTION_SNAP_TEXELS, data.ConsumeIntegralInRange(0, 3) == 0);
  set(BELTRAMI_OPTION_PACK_TURNS, data.ConsumeIntegralInRange(0, 2));
  beltrami_set_float(context, BELTRAMI_OPTION_MARGIN, data.ConsumeIntegralInRange(0, 4) / 2.0);
}

std::int64_t option(beltrami_context* context, std::int32_t key) {
  double value = 0;
  beltrami_get_option(context, key, &value);
  return static_cast<std::int64_t>(value);
}

/// All surfaces as one, as corners, faces and vertices count in results.
Part joined(const std::deque<Part>& parts) {
  Part all;
  for (const Part& part : parts) {
    const std::uint32_t first = all.vertices();
    for (const std::uint32_t v : part.corners) all.corners.push_back(first + v);
    all.sizes.insert(all.sizes.end(), part.sizes.begin(), part.sizes.end());
    all.positions.insert(all.positions.end(), part.positions.begin(), part.positions.end());
  }
  return all;
}

std::vector<double> corner_uvs(beltrami_context* context, std::size_t corners) {
  std::vector<double> uvs(2 * corners);
  promise(beltrami_get_corner_uvs(context, uvs.data(), BELTRAMI_F64, 0) == BELTRAMI_OK,
          "an atlas has UVs");
  return uvs;
}

void judge_pins(const std::deque<Part>& parts, const std::vector<double>& uvs) {
  std::size_t first = 0;
  for (const Part& part : parts) {
    for (std::size_t i = 0; i < part.pins.size(); ++i) {
      const std::uint32_t kind = part.pin_kinds.empty() ? 0u : part.pin_kinds[i];
      const double* const is = &uvs[2 * (first + part.pins[i])];
      const double* const asked = &part.pin_uvs[2 * i];
      const bool holds_u = kind == BELTRAMI_PIN_POINT || kind == BELTRAMI_PIN_U;
      const bool holds_v = kind == BELTRAMI_PIN_POINT || kind == BELTRAMI_PIN_V;
      promise((!holds_u || is[0] == asked[0]) && (!holds_v || is[1] == asked[1]),
              "pins are met to the bit");
    }
    first += part.corners.size();
  }
}

void judge_pages(beltrami_context* context, const std::vector<double>& uvs) {
  auto packing = sized<beltrami_packing>();
  promise(beltrami_get_packing(context, &packing) == BELTRAMI_OK, "an atlas is packed");
  double margin = 0;
  beltrami_get_option(context, BELTRAMI_OPTION_MARGIN, &margin);
  constexpr double kRounding = 1e-3;  // texels
  promise(packing.margin >= margin - kRounding, "charts keep their margin");
  for (const double x : uvs) promise(x >= 0 && x <= 1, "UVs are on their page");
}

/// Each number of an index is below its count.
void judge_indices(beltrami_context* context, const beltrami_atlas& atlas) {
  const auto all_below = [&](std::uint64_t items, std::uint64_t count, auto function) {
    if (items == 0) return;
    std::vector<std::uint32_t> out(items);
    promise(function(context, out.data(), BELTRAMI_U32, 0) == BELTRAMI_OK, "an atlas has indices");
    for (const std::uint32_t i : out) promise(i < count, "indices of an atlas are in range");
  };
  all_below(atlas.corners, std::max<std::uint64_t>(atlas.pages, 1), beltrami_get_corner_pages);
  all_below(atlas.corners, atlas.uv_vertices, beltrami_get_corner_uv_vertices);
  all_below(atlas.uv_vertices, atlas.vertices, beltrami_get_uv_vertex_origins);
  all_below(2 * atlas.seams, atlas.vertices, beltrami_get_seams);
  all_below(3 * atlas.triangles, atlas.corners, beltrami_get_triangles);
}

void judge(beltrami_context* context, const std::deque<Part>& parts, beltrami_status status) {
  Part all = joined(parts);
  auto atlas = sized<beltrami_atlas>();
  promise(beltrami_get_atlas(context, &atlas) == BELTRAMI_OK, "an atlas has counts");
  promise(atlas.corners == all.corners.size() && atlas.faces == all.sizes.size() &&
              atlas.vertices == all.vertices(),
          "an atlas is of all its surfaces");
  const std::vector<double> uvs = corner_uvs(context, all.corners.size());
  for (const double x : uvs) promise(std::isfinite(x), "UVs are finite");
  judge_indices(context, atlas);
  auto own = sized<beltrami_atlas_certificate>(), other = own;
  promise(beltrami_get_atlas_certificate(context, BELTRAMI_F64, &own) == BELTRAMI_OK,
          "an atlas has a certificate");
  const bool kept = status == BELTRAMI_OK || status == BELTRAMI_NOT_CONVERGED;
  promise(!kept || own.injective, "a map without a reservation is injective");
  if (kept) judge_pins(parts, uvs);
  if (kept && atlas.pages > 0) judge_pages(context, uvs);
  // What shares UVs on purpose overlaps to others' eyes.
  if (atlas.pages > 1 || atlas.stacked_parts > 0) return;
  if (option(context, BELTRAMI_OPTION_SHARE_COPIES) != 0) return;
  beltrami_surface surface = all.surface();
  surface.corner_uvs = view(uvs);
  // A chart of faces that run against most of their component is mirrored in their own winding.
  const beltrami_status verdict =
      beltrami_check_atlas(&surface, atlas.reversed_faces > 0, &other, nullptr, 0);
  promise((verdict == BELTRAMI_OK) == (own.injective != 0), "both checks agree");
}

}  // namespace

void run_one(std::string_view bytes) {
  constexpr int kPolls = 2000;
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const Context context = make_context();
  const Plan plan(data);
  set_options(data, plan, context.get());
  std::deque<Part> parts;
  for (int n = data.ConsumeIntegralInRange(1, 3); n > 0; --n) parts.push_back(part(data, plan));
  const bool again = data.ConsumeIntegralInRange(0, 7) == 0;
  std::vector<beltrami_surface> surfaces;
  for (const Part& one : parts) surfaces.push_back(one.surface());
  std::vector<const beltrami_surface*> pointers;
  for (const beltrami_surface& one : surfaces) pointers.push_back(&one);
  int polls = kPolls;
  const beltrami_status status =
      beltrami_unwrap_surfaces(context.get(), pointers.data(), pointers.size(), count_down, &polls);
  judge_status(context.get(), status);
  if (status < BELTRAMI_OK) return;
  judge(context.get(), parts, status);
  if (!again) return;
  const std::size_t corners = joined(parts).corners.size();
  const std::vector<double> first = corner_uvs(context.get(), corners);
  beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 2);
  const beltrami_status second =
      beltrami_unwrap_surfaces(context.get(), pointers.data(), pointers.size(), nullptr, nullptr);
  promise(second == status, "two threads end as one does");
  const std::vector<double> uvs = corner_uvs(context.get(), corners);
  promise(std::memcmp(uvs.data(), first.data(), uvs.size() * sizeof(double)) == 0,
          "two threads give the bits of one");
}

}  // namespace beltrami::fuzz
