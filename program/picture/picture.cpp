#include "picture/picture.h"

#include <cstdio>
#include <utility>

#include "files/vector3.h"
#include "picture/edges.h"
#include "picture/raster.h"
#include "picture/stb_in_one_place.h"
#include "picture/view.h"

namespace beltrami::cli {
namespace {

constexpr int kPanel = 800;     // pixels: two square panels side by side
constexpr int kSamples = 3;     // per pixel and axis
constexpr double kMargin = 40;  // pixels
constexpr double kLegend = 56;  // pixels kept free below the layout
constexpr double kCells = 40;   // of the checkerboard, across the longer side of the layout
/// Edges shorter than this many pixels would turn the layout grey.
constexpr double kMinEdgePixels = 5;

constexpr Color kInk = {0.13f, 0.14f, 0.17f};
constexpr Color kBad = {0.90f, 0.10f, 0.15f};
constexpr Color kLightCell = {0.97f, 0.95f, 0.90f};
constexpr Color kDarkCell = {0.20f, 0.43f, 0.60f};

/// Viridis (CC0, van der Walt and Smith) as a polynomial that is within 1% of the table.
Color viridis(double t) {
  constexpr double kCoefficients[7][3] = {
      {0.2777273272, 0.0054073445, 0.3340998053},   {0.1050930431, 1.4046135299, 1.3845901626},
      {-0.3308618287, 0.2148475595, 0.0950951630},  {-4.6342304990, -5.7991009734, -19.3324409563},
      {6.2282699363, 14.1799333668, 56.6905526007}, {4.7763849977, -13.7451453777, -65.3530326334},
      {-5.4354558559, 4.6458526122, 26.3124352495}};
  Color color{};
  for (std::size_t k = 0; k < 3; ++k) {
    double value = 0;
    for (int power = 6; power >= 0; --power) value = value * t + kCoefficients[power][k];
    color[k] = static_cast<float>(value);
  }
  return color;
}

/// Energies to colours: logarithmic, from 2 (isometric) to a round number that few faces exceed.
class EnergyScale {
 public:
  explicit EnergyScale(const std::vector<double>& energies) {
    std::vector<double> finite;
    for (const double energy : energies) {
      if (std::isfinite(energy)) finite.push_back(energy);
    }
    if (finite.empty()) return;
    const auto rank = finite.begin() + static_cast<std::ptrdiff_t>((finite.size() - 1) * 0.98);
    std::nth_element(finite.begin(), rank, finite.end());
    for (const double round :
         {2.1, 2.2, 2.5, 3.0, 4.0, 5.0, 7.0, 10.0, 20.0, 50.0, 100.0, 1000.0}) {
      top_ = round;
      if (*rank <= round) break;
    }
  }

  double top() const { return top_; }
  Color color(double energy) const {
    if (!std::isfinite(energy)) return kBad;
    return viridis(std::clamp(std::log(energy / 2) / std::log(top_ / 2), 0.0, 1.0));
  }
  double energy_at(double t) const { return 2 * std::pow(top_ / 2, t); }

 private:
  double top_ = 10;
};

/// A similarity from the plane to a rectangle of a canvas.
class Fit {
 public:
  void include(double x, double y) {
    low_[0] = std::min(low_[0], x);
    low_[1] = std::min(low_[1], y);
    high_[0] = std::max(high_[0], x);
    high_[1] = std::max(high_[1], y);
  }

  /// Longer side of the box of what was included.
  double extent() const { return std::max(high_[0] - low_[0], high_[1] - low_[1]); }
  double left() const { return low_[0]; }
  double bottom() const { return low_[1]; }

  /// To the rectangle from (0, 0) to (width, height) within the margin, in samples.
  void place(double width, double height) {
    const double room_x = width - 2 * kMargin * kSamples;
    const double room_y = height - 2 * kMargin * kSamples;
    const double dx = high_[0] - low_[0], dy = high_[1] - low_[1];
    scale_ = std::min(dx > 0 ? room_x / dx : INFINITY, dy > 0 ? room_y / dy : INFINITY);
    if (!std::isfinite(scale_)) scale_ = 0;
    center_x_ = width / 2;
    center_y_ = height / 2;
  }

  double scale() const { return scale_; }
  Point map(double x, double y, double depth = 0) const {
    return {center_x_ + scale_ * (x - low_[0] - (high_[0] - low_[0]) / 2),
            center_y_ - scale_ * (y - low_[1] - (high_[1] - low_[1]) / 2), scale_ * depth};
  }

 private:
  std::array<double, 2> low_ = {INFINITY, INFINITY}, high_ = {-INFINITY, -INFINITY};
  double scale_ = 0, center_x_ = 0, center_y_ = 0;
};

Vector3 position_of(const TriangleView& mesh, std::uint32_t vertex) {
  const double* p = &mesh.positions[3 * std::size_t{vertex}];
  return {p[0], p[1], p[2]};
}

Fit fit_uvs(const TriangleView& mesh) {
  Fit fit;
  for (const std::uint32_t vertex : mesh.faces) {
    fit.include(mesh.uvs[2 * std::size_t{vertex}], mesh.uvs[2 * std::size_t{vertex} + 1]);
  }
  return fit;
}

void draw_text(Canvas& canvas, double x, double y, const std::string& text) {
  constexpr double kSize = 1.5 * kSamples;  // samples per unit of the font
  for (const TextQuad& quad : text_quads(text)) {
    canvas.fill_rectangle(x + kSize * quad.x0, y + kSize * quad.y0, x + kSize * quad.x1,
                          y + kSize * quad.y1, kInk);
  }
}

double drawn_text_width(const std::string& text) {
  return 1.5 * kSamples * text_width(text);
}

void draw_legend(Canvas& canvas, const EnergyScale& scale) {
  const double width = 320 * kSamples, height = 14 * kSamples;
  const double left = (canvas.width() - width) / 2;
  const double top = canvas.height() - (kLegend + 4) * kSamples;
  for (int x = 0; x < width; ++x) {
    canvas.fill_rectangle(left + x, top, left + x + 1, top + height,
                          scale.color(scale.energy_at(x / width)));
  }
  for (const double t : {0.0, 0.5, 1.0}) {
    char label[32];
    std::snprintf(label, sizeof label, t == 1 ? "%.4g+" : "%.3g", scale.energy_at(t));
    const double center = left + t * width;
    canvas.fill_rectangle(center - 2, top + height, center + 2, top + height + 4 * kSamples, kInk);
    draw_text(canvas, center - drawn_text_width(label) / 2, top + height + 7 * kSamples, label);
  }
  const std::string title = "symmetric Dirichlet energy";
  draw_text(canvas, (canvas.width() - drawn_text_width(title)) / 2, top + height + 23 * kSamples,
            title);
}

Canvas draw_layout(const TriangleView& mesh, const std::vector<double>& energies,
                   const Edges& edges) {
  Canvas canvas(kPanel * kSamples, kPanel * kSamples);
  Fit fit = fit_uvs(mesh);
  fit.place(canvas.width(), canvas.height() - kLegend * kSamples);
  const auto point = [&](std::uint32_t vertex) {
    return fit.map(mesh.uvs[2 * std::size_t{vertex}], mesh.uvs[2 * std::size_t{vertex} + 1]);
  };
  const EnergyScale scale(energies);
  // Faces of infinite energy last: what is wrong must not hide under what is right.
  for (const bool bad : {false, true}) {
    for (std::size_t i = 0; i < mesh.face_count(); ++i) {
      if (std::isfinite(energies[i]) == bad) continue;
      const Color color = scale.color(energies[i]);
      canvas.fill_triangle(point(mesh.faces[3 * i]), point(mesh.faces[3 * i + 1]),
                           point(mesh.faces[3 * i + 2]), [&](const Weights&) { return color; });
    }
  }
  double length = 0;
  for (const auto& [a, b] : edges.inner) {
    const Point p = point(a), q = point(b);
    length += std::hypot(p.x - q.x, p.y - q.y);
  }
  if (length > kMinEdgePixels * kSamples * static_cast<double>(edges.inner.size())) {
    for (const auto& [a, b] : edges.inner) canvas.draw_line(point(a), point(b), 2, kInk, 0.3f);
  }
  for (const auto& [a, b] : edges.boundary) {
    canvas.draw_line(point(a), point(b), 1.6 * kSamples, kInk, 1);
  }
  draw_legend(canvas, scale);
  return canvas;
}

/// Normals of the vertices in the frame of `view`, weighted by area.
std::vector<std::array<float, 3>> smooth_normals(const TriangleView& mesh, const View& view) {
  std::vector<std::array<float, 3>> normals(mesh.vertex_count(), {0, 0, 0});
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    const Vector3 a = position_of(mesh, mesh.faces[i]);
    const Vector3 normal =
        cross(position_of(mesh, mesh.faces[i + 1]) - a, position_of(mesh, mesh.faces[i + 2]) - a);
    const Vector3 seen = {dot(normal, view.right), dot(normal, view.up), dot(normal, view.toward)};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        normals[mesh.faces[i + k]][d] += static_cast<float>(seen[d]);
      }
    }
  }
  return normals;
}

/// A key light from the upper left, a weaker one from the right; the back of the surface is dim.
Color lit(const Color& base, const Vector3& seen_normal) {
  const bool back = seen_normal[2] < 0;
  const Vector3 n = back ? -1.0 * seen_normal : seen_normal;
  const Vector3 key = normalized({-0.4, 0.55, 0.9}, {0, 0, 1});
  const Vector3 fill = normalized({0.8, 0.1, 0.6}, {0, 0, 1});
  const double light =
      0.30 + 0.58 * std::max(0.0, dot(n, key)) + 0.24 * std::max(0.0, dot(n, fill));
  const auto strength = static_cast<float>(back ? 0.45 * light : light);
  return {strength * base[0], strength * base[1], strength * base[2]};
}

Canvas draw_model(const TriangleView& mesh, const Edges& edges) {
  std::vector<Vector3> boundary;
  for (const Edge& edge : edges.boundary) boundary.push_back(position_of(mesh, edge.first));
  const View view = choose_view(mesh, boundary);
  Fit fit;
  for (const std::uint32_t vertex : mesh.faces) {
    const Vector3 p = position_of(mesh, vertex);
    fit.include(dot(p, view.right), dot(p, view.up));
  }
  Canvas canvas(kPanel * kSamples, kPanel * kSamples);
  fit.place(canvas.width(), canvas.height());

  const auto normals = smooth_normals(mesh, view);
  const Fit uv_fit = fit_uvs(mesh);
  const double cell = uv_fit.extent() > 0 ? uv_fit.extent() / kCells : 1;
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    std::array<Point, 3> points;
    std::array<Vector3, 3> seen;
    std::array<double, 3> u, v;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t vertex = mesh.faces[i + k];
      const Vector3 p = position_of(mesh, mesh.faces[i + k]);
      points[k] = fit.map(dot(p, view.right), dot(p, view.up), dot(p, view.toward));
      const auto& n = normals[vertex];
      seen[k] = normalized({n[0], n[1], n[2]}, {0, 0, 1});
      u[k] = (mesh.uvs[2 * vertex] - uv_fit.left()) / cell;
      v[k] = (mesh.uvs[2 * vertex + 1] - uv_fit.bottom()) / cell;
    }
    canvas.fill_triangle(points[0], points[1], points[2], [&](const Weights& w) {
      const Vector3 n = w[0] * seen[0] + w[1] * seen[1] + w[2] * seen[2];
      const double column = std::floor(w[0] * u[0] + w[1] * u[1] + w[2] * u[2]);
      const double row = std::floor(w[0] * v[0] + w[1] * v[1] + w[2] * v[2]);
      const bool dark = std::fmod(std::abs(column + row), 2) == 1;
      return lit(dark ? kDarkCell : kLightCell, normalized(n, {0, 0, 1}));
    });
  }
  return canvas;
}

/// Averages the samples of each pixel into the panel that begins at column `left`.
void resolve(const Canvas& canvas, int left, Image& image) {
  for (int y = 0; y < kPanel; ++y) {
    for (int x = 0; x < kPanel; ++x) {
      std::array<int, 3> sum = {0, 0, 0};
      for (int sy = 0; sy < kSamples; ++sy) {
        for (int sx = 0; sx < kSamples; ++sx) {
          const std::uint8_t* sample = canvas.sample(kSamples * x + sx, kSamples * y + sy);
          for (std::size_t k = 0; k < 3; ++k) sum[k] += sample[k];
        }
      }
      const std::size_t pixel = static_cast<std::size_t>(y) * image.width + left + x;
      for (std::size_t k = 0; k < 3; ++k) {
        image.rgb[3 * pixel + k] =
            static_cast<std::uint8_t>((sum[k] + kSamples * kSamples / 2) / (kSamples * kSamples));
      }
    }
  }
}

}  // namespace

Image render_picture(const TriangleView& mesh, const std::vector<double>& face_energies) {
  Image image;
  image.width = 2 * kPanel;
  image.height = kPanel;
  image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
  const Edges edges = find_edges(mesh);
  // One after the other: a canvas of samples takes 40 MB.
  resolve(draw_layout(mesh, face_energies, edges), 0, image);
  resolve(draw_model(mesh, edges), kPanel, image);
  return image;
}

std::string encode_png(const Image& image) {
  return png_bytes(image.width, image.height, 3, image.rgb.data());
}

}  // namespace beltrami::cli
