#include "picture/html.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "files/vector3.h"
#include "picture/deflate.h"
#include "picture/edges.h"
#include "picture/report_page.h"
#include "picture/view.h"

namespace beltrami::cli {
namespace {

/// Numbers of 32 bits, which deflate finds more in where the first bytes of all stand together,
/// then the second ones.
class Planes {
 public:
  explicit Planes(std::size_t count) : count_(count), bytes_(4 * count, '\0') {}

  void add(std::uint32_t bits) {
    for (std::size_t plane = 0; plane < 4; ++plane) {
      bytes_[plane * count_ + at_] = static_cast<char>(bits >> (8 * plane) & 0xff);
    }
    ++at_;
  }
  void add(double value) { add(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }

  std::string_view bytes() const { return bytes_; }

 private:
  std::size_t count_, at_ = 0;
  std::string bytes_;
};

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

/// The middle of the box around the vertices in use: far from the origin single precision has few
/// digits.
Vector3 middle_of(const TriangleView& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vector3 low = {kInfinity, kInfinity, kInfinity}, high = {-kInfinity, -kInfinity, -kInfinity};
  for (const std::uint32_t vertex : mesh.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = mesh.positions[3 * std::size_t{vertex} + k];
      low[k] = std::min(low[k], x);
      high[k] = std::max(high[k], x);
    }
  }
  return mesh.faces.empty() ? Vector3{} : 0.5 * (low + high);
}

nlohmann::ordered_json frame_of(const TriangleView& mesh) {
  std::vector<Vector3> boundary;
  for (const Edge& edge : find_edges(mesh).boundary) {
    const double* p = &mesh.positions[3 * std::size_t{edge.first}];
    boundary.push_back({p[0], p[1], p[2]});
  }
  const View view = choose_view(mesh, boundary);
  nlohmann::ordered_json frame = nlohmann::ordered_json::array();
  for (const Vector3& row : {view.right, view.up, view.toward}) {
    for (const double x : row) frame.push_back(x);
  }
  return frame;
}

/// For a script of HTML, which ends at "</script": in JSON this sign is in strings alone.
std::string without_tags(std::string_view json) {
  std::string text;
  for (const char letter : json) {
    if (letter == '<') {
      text += "\\u003c";
    } else {
      text += letter;
    }
  }
  return text;
}

}  // namespace

HtmlMesh html_mesh(const TriangleView& mesh, const std::vector<double>& energies,
                   const std::vector<std::uint32_t>& charts) {
  const Vector3 middle = middle_of(mesh);
  Planes planes(mesh.positions.size() + mesh.uvs.size() + energies.size() + mesh.faces.size() +
                charts.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    planes.add(mesh.positions[i] - middle[i % 3]);
  }
  for (const double x : mesh.uvs) planes.add(x);
  for (const double energy : energies) planes.add(energy);
  std::uint32_t last = 0;
  for (const std::uint32_t vertex : mesh.faces) {
    planes.add(vertex - last);
    last = vertex;
  }
  for (const std::uint32_t chart : charts) planes.add(chart);
  const nlohmann::ordered_json description = {{"vertices", mesh.vertex_count()},
                                              {"triangles", mesh.face_count()},
                                              {"frame", frame_of(mesh)}};
  return {description.dump(), base64(zlib_bytes(planes.bytes(), Repetitions::kAll))};
}

void write_html(const HtmlMesh& mesh, std::string_view report,
                const std::function<void(std::string_view)>& sink) {
  const std::string_view page = report_page();
  const std::size_t first = page.find(kReportPlace), second = page.find(kArraysPlace, first);
  sink(page.substr(0, first));
  sink("{\"mesh\":" + mesh.description + ",\"report\":" + without_tags(report) + "}");
  sink(page.substr(first + kReportPlace.size(), second - first - kReportPlace.size()));
  sink(mesh.arrays);
  sink(page.substr(second + kArraysPlace.size()));
}

}  // namespace beltrami::cli
