#include "files/straight.h"

#include <beltrami/beltrami.h>

#include "files/text_cursor.h"
#include "process/descriptor.h"

namespace beltrami::cli {
namespace {

void read_rectangle(TextCursor& cursor, const MeshFile& file, Straight& straight) {
  straight.rectangles.push_back(cursor.index("face", file.polygons.size()));
  straight.rectangle_lines.push_back(cursor.line());
  cursor.skip_blanks();
  const bool named = !cursor.at_line_end();
  for (int k = 0; k < 4; ++k) {
    straight.rectangle_corners.push_back(named ? cursor.index("vertex", file.vertex_count())
                                               : BELTRAMI_NO_ELEMENT);
  }
}

}  // namespace

Straight read_straight(const std::string& path, const MeshFile& file) {
  const std::string text = read_file(path);
  Straight straight;
  TextCursor cursor(text, path);
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word()) {
    const std::string kind(cursor.word());
    if (kind == "r") {
      read_rectangle(cursor, file, straight);
    } else if (kind == "u" || kind == "v" || kind == "l") {
      for (int k = 0; k < 2; ++k) {
        straight.edges.push_back(cursor.index("vertex", file.vertex_count()));
      }
      straight.kinds.push_back(kind == "u"   ? BELTRAMI_PIN_U
                               : kind == "v" ? BELTRAMI_PIN_V
                                             : BELTRAMI_PIN_LINE);
      straight.edge_lines.push_back(cursor.line());
    } else {
      cursor.fail("'" + kind +
                  "' makes nothing straight: a line is 'r FACE', 'r FACE VERTEX VERTEX VERTEX "
                  "VERTEX', or 'u', 'v' or 'l' with two vertices of an edge");
    }
    cursor.skip_blanks();
    if (!cursor.at_line_end()) cursor.fail("more than one thing: a line holds one");
  }
  return straight;
}

}  // namespace beltrami::cli
