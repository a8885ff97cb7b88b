#include "files/pins.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <string_view>

#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/descriptor.h"

namespace beltrami::cli {
namespace {

/// The corners sorted by their vertices.
std::vector<std::uint64_t> by_vertex(const std::vector<std::uint32_t>& vertex_of) {
  std::vector<std::uint64_t> order(vertex_of.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint64_t a, std::uint64_t b) { return vertex_of[a] < vertex_of[b]; });
  return order;
}

/// A number of those that count from 0.
std::uint64_t index(TextCursor& cursor, const char* what, std::uint64_t count) {
  const std::int64_t number = cursor.integer(what);
  if (number >= 0 && static_cast<std::uint64_t>(number) < count) {
    return static_cast<std::uint64_t>(number);
  }
  cursor.fail("there is no " + std::string(what) + " " + std::to_string(number) + ": there are " +
              std::to_string(count) + ", counted from 0");
}

}  // namespace

Pins read_pins(const std::string& path, const MeshFile& file) {
  const std::string text = read_file(path);
  const std::vector<std::uint32_t>& vertex_of = file.polygons.corners();
  const std::vector<std::uint64_t> order = by_vertex(vertex_of);
  Pins pins;
  TextCursor cursor(text, path);
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word()) {
    const std::string kind(cursor.word());
    if (kind != "v" && kind != "c") {
      cursor.fail("'" + kind + "' is no pin: a line is 'v VERTEX U V' or 'c CORNER U V'");
    }
    std::vector<std::uint64_t> corners;
    if (kind == "c") {
      corners.push_back(index(cursor, "corner", vertex_of.size()));
    } else {
      const std::uint64_t vertex = index(cursor, "vertex", file.vertex_count());
      auto at = std::lower_bound(
          order.begin(), order.end(), vertex,
          [&](std::uint64_t corner, std::uint64_t v) { return vertex_of[corner] < v; });
      for (; at != order.end() && vertex_of[*at] == vertex; ++at) corners.push_back(*at);
      if (corners.empty()) cursor.fail("no face has vertex " + std::to_string(vertex));
    }
    const double u = cursor.number("u"), v = cursor.number("v");
    for (const std::uint64_t corner : corners) {
      pins.corners.push_back(corner);
      pins.uvs.insert(pins.uvs.end(), {u, v});
      pins.lines.push_back(cursor.line());
    }
    cursor.skip_blanks();
    if (!cursor.at_line_end()) cursor.fail("more than a pin: a line holds one");
  }
  return pins;
}

std::string with_lines(const std::string& message, const Pins& pins) {
  constexpr std::string_view kPin = "pin ";
  std::string text;
  std::size_t done = 0;
  for (std::size_t at = message.find(kPin); at != std::string::npos; at = message.find(kPin, at)) {
    std::size_t number = 0;
    const char* begin = message.data() + at + kPin.size();
    const auto [past, error] = std::from_chars(begin, message.data() + message.size(), number);
    at += kPin.size();
    if (error != std::errc() || number >= pins.lines.size()) continue;
    text += message.substr(done, at - kPin.size() - done) + "the pin of line " +
            std::to_string(pins.lines[number]);
    done = at = static_cast<std::size_t>(past - message.data());
  }
  return text + message.substr(done);
}

}  // namespace beltrami::cli
