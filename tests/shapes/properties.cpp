#include "shapes/properties.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "shapes/atlas_of_shape.h"
#include "shapes/exact_triangles.h"
#include "shapes/random.h"

namespace beltrami::shapes {

std::string_view name_of(Way way) {
  switch (way) {
    case Way::kAuto:
      return "auto";
    case Way::kHard:
      return "hard";
    case Way::kLightmap:
      return "lightmap";
    default:
      return "minimal";
  }
}

std::string_view name_of(Fault fault) {
  constexpr std::array<std::string_view, kFaults> kNames = {
      "crash",    "time",   "refused", "lost", "not_injective", "single",  "disagreement",
      "off_page", "margin", "energy",  "bent", "status",        "threads", "scale"};
  return kNames[static_cast<std::size_t>(fault)];
}

namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

using Findings = std::vector<Finding>;

/// Triangles with area, which have a place of their own in the plane.
std::vector<std::size_t> judged(const Shape& shape, const ShapeAtlas& atlas) {
  const std::vector<char> left_out = without_area(shape, atlas.triangles);
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < atlas.triangles.size(); ++t) {
    if (!left_out[t]) out.push_back(t);
  }
  return out;
}

/// The UVs of a triangle; page k lies beside page k - 1.
UvTriangle placed(const ShapeAtlas& atlas, const std::vector<Uv>& uvs, std::size_t t) {
  UvTriangle out;
  for (std::size_t k = 0; k < 3; ++k) out[k] = uvs[atlas.triangles[t][k]];
  return out;
}

/// Whether positive and without overlaps, page by page.
bool is_injective(const ShapeAtlas& atlas, const std::vector<Uv>& uvs,
                  const std::vector<std::size_t>& faces, std::string& what) {
  std::map<std::uint32_t, std::vector<UvTriangle>> pages;
  std::map<std::uint32_t, std::vector<std::size_t>> names;
  for (const std::size_t t : faces) {
    const UvTriangle uv = placed(atlas, uvs, t);
    if (orientation(uv[0], uv[1], uv[2]) <= 0) {
      what = text("triangle %zu of %zu is not positive", t, atlas.triangles.size());
      return false;
    }
    const std::uint32_t page = atlas.pages[atlas.triangles[t][0]];
    pages[page].push_back(uv);
    names[page].push_back(t);
  }
  for (const auto& [page, triangles] : pages) {
    if (const auto pair = find_overlap(triangles)) {
      what = text("triangles %zu and %zu of %zu overlap", names[page][pair->first],
                  names[page][pair->second], atlas.triangles.size());
      return false;
    }
  }
  return true;
}

void judge_numbers(const Shape& shape, const ShapeAtlas& atlas,
                   const std::vector<std::size_t>& faces, Findings& findings) {
  for (const Uv& uv : atlas.uvs) {
    if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
      findings.push_back({Fault::kLost, "a UV is not finite"});
      return;
    }
  }
  for (const std::size_t t : faces) {
    const UvTriangle uv = placed(atlas, atlas.uvs, t);
    if (uv[0] == uv[1] && uv[1] == uv[2]) {
      const double area = areas(shape, {atlas.triangles[t]})[0];
      findings.push_back({Fault::kLost, text("triangle %zu of area %g is a point", t, area)});
      return;
    }
  }
}

void judge_injectivity(const Shape& shape, const ShapeAtlas& atlas,
                       const std::vector<std::size_t>& faces, Findings& findings) {
  std::string what;
  const bool injective = is_injective(atlas, atlas.uvs, faces, what);
  if (!injective) {
    findings.push_back({Fault::kNotInjective, what + (atlas.injective ? ", unsaid" : "")});
  }
  std::string single_what;
  const bool single = is_injective(atlas, atlas.single_uvs, faces, single_what);
  if (!single && injective) {
    findings.push_back({Fault::kSingle, single_what + (atlas.injective_single ? ", unsaid" : "")});
  }
  auto certificate = beltrami_atlas_certificate{};
  certificate.struct_size = sizeof certificate;
  beltrami_surface surface = view(shape);
  surface.corner_uvs = {atlas.uvs.data(), 0, BELTRAMI_F64, 0};
  const bool one_page = *std::max_element(atlas.pages.begin(), atlas.pages.end()) == 0;
  const beltrami_status checked = one_page
                                      ? beltrami_check_atlas(&surface, 1, &certificate, nullptr, 0)
                                  : injective ? BELTRAMI_OK
                                              : BELTRAMI_NOT_INJECTIVE;
  if (injective != atlas.injective || single != atlas.injective_single ||
      injective != (checked == BELTRAMI_OK)) {
    findings.push_back(
        {Fault::kDisagreement,
         text("injective %d, in single precision %d; its certificates %d %d, its "
              "check %d",
              injective, single, atlas.injective, atlas.injective_single, checked == BELTRAMI_OK)});
  }
}

/// Boundary edges of charts, as corners of triangles; the chart of each.
struct Border {
  std::size_t chart;
  std::uint32_t page;
  Uv from, to;
};

/// The UV vertex of each corner: those at one place in space and in the plane are one.
std::vector<std::size_t> uv_vertices(const Shape& shape, const ShapeAtlas& atlas) {
  std::map<std::pair<Point3, Uv>, std::size_t> names;
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < atlas.uvs.size(); ++c) {
    const std::pair place = {shape.positions[shape.corners[c]], atlas.uvs[c]};
    out.push_back(names.try_emplace(place, names.size()).first->second);
  }
  return out;
}

std::vector<Border> borders(const Shape& shape, const ShapeAtlas& atlas,
                            const std::vector<std::size_t>& faces) {
  const std::vector<std::size_t> names = uv_vertices(shape, atlas);
  using Side = std::pair<std::size_t, std::size_t>;
  const auto edge_of = [&](const Side& side) -> Side {
    const auto& [t, k] = side;
    return std::minmax(names[atlas.triangles[t][k]], names[atlas.triangles[t][(k + 1) % 3]]);
  };
  std::vector<std::size_t> parent(atlas.triangles.size());
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  // Faces without area join those beside them to a chart as well.
  std::map<Side, std::size_t> first_at;
  for (std::size_t t = 0; t < atlas.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      parent[root(t)] = root(first_at.try_emplace(edge_of({t, k}), t).first->second);
    }
  }
  std::map<Side, std::vector<Side>> sides;
  for (const std::size_t t : faces) {
    for (std::size_t k = 0; k < 3; ++k) sides[edge_of({t, k})].push_back({t, k});
  }
  std::vector<Border> out;
  for (const auto& [edge, of] : sides) {
    if (of.size() != 1) continue;
    const auto& [t, k] = of[0];
    const UvTriangle uv = placed(atlas, atlas.uvs, t);
    out.push_back({root(t), atlas.pages[atlas.triangles[t][k]], uv[k], uv[(k + 1) % 3]});
  }
  return out;
}

/// Least distance of two charts, in UVs, but nothing above `far`.
double least_distance(std::vector<Border> edges, double far) {
  std::sort(edges.begin(), edges.end(), [](const Border& a, const Border& b) {
    return std::min(a.from[0], a.to[0]) < std::min(b.from[0], b.to[0]);
  });
  double least = far;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Border& a = edges[i];
    const double right = std::max(a.from[0], a.to[0]) + far;
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Border& b = edges[j];
      if (std::min(b.from[0], b.to[0]) > right) break;
      if (b.chart == a.chart || b.page != a.page) continue;
      if (std::min(b.from[1], b.to[1]) > std::max(a.from[1], a.to[1]) + far) continue;
      if (std::max(b.from[1], b.to[1]) < std::min(a.from[1], a.to[1]) - far) continue;
      least = std::min(least, distance(a.from, a.to, b.from, b.to));
    }
  }
  return least;
}

void judge_page(const Shape& shape, const ShapeAtlas& atlas, const std::vector<std::size_t>& faces,
                Findings& findings) {
  constexpr double kRounding = 1e-3;  // texels that single precision may take away
  double low = 1, high = 0;
  for (const std::vector<Uv>* uvs : {&atlas.uvs, &atlas.single_uvs}) {
    for (const Uv& uv : *uvs) {
      low = std::min({low, uv[0], uv[1]});
      high = std::max({high, uv[0], uv[1]});
    }
  }
  if (low < 0 || high > 1) {
    const bool unsaid = atlas.status == BELTRAMI_OK;
    findings.push_back(
        {Fault::kOffPage, text("UVs from %.6g to %.6g%s", low, high, unsaid ? ", unsaid" : "")});
    return;
  }
  double edge = 1;
  for (const std::size_t t : faces) {
    for (const Uv& uv : placed(atlas, atlas.uvs, t)) {
      for (const double x : uv) edge = std::min({edge, x, 1 - x});
    }
  }
  const double texels = shape.resolution, asked = shape.margin - kRounding;
  const double between =
      texels * least_distance(borders(shape, atlas, faces), shape.margin / texels);
  if (between < asked || 2 * texels * edge < asked) {
    findings.push_back({Fault::kMargin, text("%.4g texels between charts, twice %.4g to the edge, "
                                             "of %g; it says %.4g",
                                             between, texels * edge, shape.margin, atlas.margin)});
  }
}

void judge_energy(const Shape& shape, const ShapeAtlas& atlas, Report& report) {
  constexpr double kMore = 1e-3;  // what the target or the minimal cut's may be missed by
  const auto energies = component_energies(shape, atlas);
  double area = 0, sum = 0;
  for (const ComponentEnergy& one : energies) {
    area += one.area;
    sum += one.area * one.energy;
  }
  report.energy = area > 0 ? sum / area : 2;
  if (!shape.fits_single) return;
  std::vector<ComponentEnergy> least;
  for (std::size_t i = 0; i < energies.size(); ++i) {
    const auto& [part, energy] = energies[i];
    if (part < kNoVote * area || energy <= kFlatEnergy) continue;
    if (shape.flat) {
      report.findings.push_back({Fault::kBent, text("component %zu of %zu, %.2g of the area: %.6g",
                                                    i, energies.size(), part / area, energy)});
      return;
    }
    if (atlas.target == 0 || energy <= atlas.target + kMore) continue;
    if (least.empty()) least = component_energies(shape, unwrap(shape, Way::kMinimal));
    if (least.size() != energies.size()) return;
    if (energy > least[i].energy * (1 + kMore)) {
      report.findings.push_back(
          {Fault::kEnergy,
           text("component %zu of %zu, %.2g of the area: %.6g, by the minimal cut "
                "%.6g, target %g",
                i, energies.size(), part / area, energy, least[i].energy, atlas.target)});
      return;
    }
  }
}

void judge_refusal(const Shape& shape, const ShapeAtlas& atlas, Findings& findings) {
  const auto triangles = triangulate(shape);
  const std::vector<char> empty = without_area(shape, triangles);
  const bool no_area = std::all_of(empty.begin(), empty.end(), [](char e) { return e != 0; });
  if (no_area && atlas.status == BELTRAMI_E_ZERO_AREA) return;
  findings.push_back(
      {Fault::kRefused, std::string(beltrami_status_name(atlas.status)) + ": " + atlas.message});
}

}  // namespace

Report judge(const Shape& shape, const ShapeAtlas& atlas) {
  Report report;
  report.status = atlas.status;
  report.cpu_seconds = atlas.cpu_seconds;
  if (atlas.status < BELTRAMI_OK) {
    judge_refusal(shape, atlas, report.findings);
    return report;
  }
  const std::vector<std::size_t> faces = judged(shape, atlas);
  judge_numbers(shape, atlas, faces, report.findings);
  judge_injectivity(shape, atlas, faces, report.findings);
  judge_page(shape, atlas, faces, report.findings);
  judge_energy(shape, atlas, report);
  if (report.findings.empty() && atlas.status != BELTRAMI_OK) {
    report.findings.push_back({Fault::kStatus, beltrami_status_name(atlas.status)});
  }
  return report;
}

Report check(const Shape& shape, Way way) {
  return judge(shape, unwrap(shape, way));
}

Report check_again(const Shape& shape, Way way) {
  const ShapeAtlas atlas = unwrap(shape, way);
  Report report = judge(shape, atlas);
  if (unwrap(shape, way, 2).uvs != atlas.uvs) {
    report.findings.push_back({Fault::kThreads, "two threads give other UVs"});
  }
  for (const double factor : {0.5, 2.0}) {
    Shape scaled = shape;
    scale(scaled, {factor, factor, factor});
    if (unwrap(scaled, way).uvs != atlas.uvs) {
      report.findings.push_back({Fault::kScale, text("at %g times the size: other UVs", factor)});
    }
  }
  Shape turned = shape;
  Random random(shape.seed);
  turn(turned, random);
  const Report after = check(turned, way);
  for (const Finding& finding : after.findings) {
    report.findings.push_back({finding.fault, "turned: " + finding.what});
  }
  return report;
}

}  // namespace beltrami::shapes
