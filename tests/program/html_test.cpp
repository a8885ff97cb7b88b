// The page for browsers: it parses, needs nothing else, and holds the numbers of the atlas.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "files/mesh_file.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::json;

const std::string kCubeOfQuads =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// The text of the script with this id.
std::string script(const std::string& page, const std::string& id) {
  const std::string mark = "id=\"" + id + "\">";
  const std::size_t begin = page.find(mark);
  if (begin == std::string::npos) return "";
  const std::size_t first = begin + mark.size();
  return page.substr(first, page.find("</script>", first) - first);
}

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    if (letter == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(letter));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// The numbers of 32 bits of the arrays, `count` of them; empty where there are not so many.
std::vector<std::uint32_t> words_of(const std::string& text, std::size_t count) {
  const std::string packed = from_base64(text);
  std::vector<Bytef> planes(4 * count + 1);
  uLongf size = planes.size();
  const int status = uncompress(planes.data(), &size, reinterpret_cast<const Bytef*>(packed.data()),
                                packed.size());
  if (status != Z_OK || size != 4 * count) return {};
  std::vector<std::uint32_t> words(count);
  for (std::size_t i = 0; i < 4 * count; ++i) {
    words[i % count] |= std::uint32_t{planes[i]} << (8 * (i / count));
  }
  return words;
}

struct Shown {
  Json report;
  std::vector<double> positions, uvs, energies;
  std::vector<std::uint32_t> faces, charts;
};

Shown shown_by(const std::string& page) {
  const Json json = Json::parse(script(page, "report"));
  const std::size_t vertices = json["mesh"]["vertices"], triangles = json["mesh"]["triangles"];
  const auto words = words_of(script(page, "arrays"), 5 * vertices + 5 * triangles);
  Shown shown;
  shown.report = json["report"];
  if (words.empty()) return shown;
  auto at = words.begin();
  for (auto [numbers, count] :
       {std::pair(&shown.positions, 3 * vertices), std::pair(&shown.uvs, 2 * vertices),
        std::pair(&shown.energies, triangles)}) {
    for (; count > 0; --count) numbers->push_back(std::bit_cast<float>(*at++));
  }
  for (std::uint32_t vertex = 0; shown.faces.size() < 3 * triangles;) {
    shown.faces.push_back(vertex += *at++);
  }
  shown.charts.assign(at, words.end());
  return shown;
}

TEST(Html, HoldsTheAtlas) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("a<b.obj", kCubeOfQuads), out = directory.path("out.obj");
  const Outcome outcome = run({"unwrap", in, out, "--hard-angle", "60", "--report",
                               directory.path("r.json"), "--html", directory.path("p.html")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const std::string page = directory.read("p.html");
  const Shown shown = shown_by(page);
  const Json report = Json::parse(directory.read("r.json"));
  for (const char* key : {"charts", "energy", "injective", "packing", "input", "seconds"}) {
    EXPECT_EQ(shown.report[key], report[key]) << key;
  }
  EXPECT_EQ(report["stages"].back()["name"], "html");
  ASSERT_EQ(shown.faces.size(), 36u);
  EXPECT_EQ(*std::max_element(shown.charts.begin(), shown.charts.end()), 5u);
  for (const double energy : shown.energies) EXPECT_NEAR(energy, 2, 1e-6);
  for (std::size_t i = 0; i < shown.positions.size(); ++i) {
    EXPECT_EQ(std::abs(shown.positions[i]), 0.5);
  }
  // Each UV of the output is one of the page's, in single precision.
  const MeshFile written = read_mesh(out, Content::kUvs);
  const std::vector<double>& uvs = written.corner_uvs.values;
  for (std::size_t i = 0; i < uvs.size(); i += 2) {
    bool found = false;
    for (std::size_t k = 0; k < shown.uvs.size(); k += 2) {
      found = found || (std::abs(shown.uvs[k] - uvs[i]) < 1e-6 &&
                        std::abs(shown.uvs[k + 1] - uvs[i + 1]) < 1e-6);
    }
    EXPECT_TRUE(found) << i;
  }
}

TEST(Html, NeedsNothingElse) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare);
  ASSERT_EQ(
      run({"unwrap", in, directory.path("out.obj"), "--html", directory.path("p.html")}).exit_code,
      0);
  const std::string page = directory.read("p.html");
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
  for (const char* part :
       {"http://", "https://", "src=", "<link", "import ", "@report@", "@arrays@", "@viewer"}) {
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  }
}

TEST(Html, KeepsTheOutputWhereThePageCannotBeWritten) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquare), out = directory.path("out.obj");
  EXPECT_EQ(run({"unwrap", in, out, "--html", directory.path("none/p.html")}).exit_code, 2);
  EXPECT_EQ(directory.names(), std::vector<std::string>{"in.obj"});
  EXPECT_EQ(run({"unwrap", in, out, "--html", in}).exit_code, 2);
  EXPECT_EQ(directory.read("in.obj"), kSquare);
}

TEST(Html, ShowsTriangulatedFacesInTheirCharts) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kCubeOfQuads), page = directory.path("p.html");
  const auto charts = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {
        "unwrap", in, directory.path("out.obj"), "--hard-angle", "60", "--html", page};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run(words).exit_code, 0);
    return shown_by(directory.read("p.html")).charts;
  };
  EXPECT_EQ(charts({}), charts({"--triangulate"}));
}

}  // namespace
}  // namespace beltrami::cli
