#include "files/pins.h"

#include <beltrami/beltrami.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

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

struct Place {
  std::uint32_t kind = BELTRAMI_PIN_POINT;
  double u = 0, v = 0;
  double along_u = 0, along_v = 0;
};

/// A number, or nothing where a - stands for it.
std::optional<double> number_or_dash(TextCursor& cursor, const char* what) {
  cursor.skip_blanks();
  TextCursor ahead = cursor;
  if (ahead.word() != "-") return cursor.number(what);
  cursor.word();
  return std::nullopt;
}

Place read_place(TextCursor& cursor) {
  Place place;
  const auto u = number_or_dash(cursor, "u"), v = number_or_dash(cursor, "v");
  place.u = u.value_or(0);
  place.v = v.value_or(0);
  if (!u && !v) cursor.fail("a pin with two - holds nothing: give a number, or leave it out");
  if (!u || !v) {
    place.kind = u ? BELTRAMI_PIN_U : BELTRAMI_PIN_V;
    return place;
  }
  cursor.skip_blanks();
  if (cursor.at_line_end()) return place;
  place.kind = BELTRAMI_PIN_LINE;
  place.along_u = cursor.number("u of the direction");
  place.along_v = cursor.number("v of the direction");
  return place;
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
      cursor.fail("'" + kind +
                  "' is no pin: a line is 'v VERTEX U V' or 'c CORNER U V', with - for a number "
                  "that is free, or with two numbers more for a direction");
    }
    std::vector<std::uint64_t> corners;
    if (kind == "c") {
      corners.push_back(cursor.index("corner", vertex_of.size()));
    } else {
      const std::uint64_t vertex = cursor.index("vertex", file.vertex_count());
      auto at = std::lower_bound(
          order.begin(), order.end(), vertex,
          [&](std::uint64_t corner, std::uint64_t v) { return vertex_of[corner] < v; });
      for (; at != order.end() && vertex_of[*at] == vertex; ++at) corners.push_back(*at);
      if (corners.empty()) cursor.fail("no face has vertex " + std::to_string(vertex));
    }
    const Place place = read_place(cursor);
    for (const std::uint64_t corner : corners) {
      pins.corners.push_back(corner);
      pins.uvs.insert(pins.uvs.end(), {place.u, place.v});
      pins.kinds.push_back(place.kind);
      pins.directions.insert(pins.directions.end(), {place.along_u, place.along_v});
      pins.lines.push_back(cursor.line());
    }
    cursor.skip_blanks();
    if (!cursor.at_line_end()) cursor.fail("more than a pin: a line holds one");
  }
  return pins;
}

std::string with_lines(const std::string& message, std::string_view item,
                       const std::vector<std::uint64_t>& lines) {
  const std::string counted = std::string(item) + " ";
  std::string text;
  std::size_t done = 0;
  for (std::size_t at = message.find(counted); at != std::string::npos;
       at = message.find(counted, at)) {
    std::size_t number = 0;
    const char* begin = message.data() + at + counted.size();
    const auto [past, error] = std::from_chars(begin, message.data() + message.size(), number);
    const std::size_t start = std::exchange(at, at + counted.size());
    if (error != std::errc() || number >= lines.size()) continue;
    text += message.substr(done, start - done) + "the " + std::string(item) + " of line " +
            std::to_string(lines[number]);
    done = at = static_cast<std::size_t>(past - message.data());
  }
  return text + message.substr(done);
}

}  // namespace beltrami::cli
