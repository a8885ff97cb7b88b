#include "files/paint.h"

#include <cmath>

#include "files/text_cursor.h"
#include "process/descriptor.h"

namespace beltrami::cli {
namespace {

std::uint64_t vertex(TextCursor& cursor, std::uint64_t count) {
  const std::int64_t number = cursor.integer("vertex");
  if (number >= 0 && static_cast<std::uint64_t>(number) < count) {
    return static_cast<std::uint64_t>(number);
  }
  cursor.fail("there is no vertex " + std::to_string(number) + ": there are " +
              std::to_string(count) + ", counted from 0");
}

}  // namespace

Paint read_paint(const std::string& path, const MeshFile& file) {
  const std::string text = read_file(path);
  const std::uint64_t count = file.vertex_count();
  Paint paint;
  TextCursor cursor(text, path);
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word()) {
    const std::string kind(cursor.word());
    if (kind != "v" && kind != "e") {
      cursor.fail("'" + kind +
                  "' is no paint: a line is 'v VERTEX FACTOR' or 'e VERTEX VERTEX FACTOR'");
    }
    const std::uint64_t first = vertex(cursor, count);
    const std::uint64_t second = kind == "e" ? vertex(cursor, count) : first;
    const double factor = cursor.number("factor");
    if (!(factor >= 0 && std::isfinite(factor))) {
      cursor.fail("a factor is a finite number of 0 or more: below 1 it draws seams");
    }
    if (kind == "e") {
      paint.edges.insert(paint.edges.end(), {first, second});
      paint.of_edges.push_back(factor);
    } else {
      paint.of_vertices.resize(count, 1);
      paint.of_vertices[first] = factor;
    }
    cursor.skip_blanks();
    if (!cursor.at_line_end()) cursor.fail("more than one factor: a line holds one");
  }
  return paint;
}

}  // namespace beltrami::cli
