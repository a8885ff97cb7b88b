#include "files/off_header.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "files/mesh_file.h"

namespace beltrami::cli {
namespace {

char upper(char c) {
  return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

bool is_number(std::string_view word) {
  return !word.empty() && std::all_of(word.begin(), word.end(),
                                      [](char c) { return (c >= '0' && c <= '9') || c == '+'; });
}

/// Takes `prefix`, in any case, off the word.
bool take(std::string_view& word, std::string_view prefix) {
  if (word.size() < prefix.size() ||
      !std::equal(prefix.begin(), prefix.end(), word.begin(),
                  [](char a, char b) { return upper(a) == upper(b); })) {
    return false;
  }
  word.remove_prefix(prefix.size());
  return true;
}

/// The letters in front of OFF. Returns whether the dimension follows: a small n says so, but a
/// word that is in small letters as a whole has them for great ones.
bool read_letters(const TextCursor& cursor, std::string_view& word, OffHeader& header) {
  const bool small = word.find_first_of("OFCNST") == std::string_view::npos;
  header.uvs = take(word, "ST");
  header.colours = take(word, "C");
  const bool dimension = !small && word.size() > 3 && (word[0] == 'n' || word.substr(0, 2) == "4n");
  if (!dimension) header.normals = take(word, "N");
  header.homogeneous = take(word, "4");
  if (dimension) take(word, "N");
  if (!take(word, "OFF")) cursor.fail("this is not an OFF file of three-dimensional vertices");
  return dimension;
}

std::uint64_t checked_count(const TextCursor& cursor, std::int64_t count, const char* what) {
  if (count < 0 || count > kMaxIndex) {
    cursor.fail(std::string(what) + " is out of range: " + std::to_string(count));
  }
  return static_cast<std::uint64_t>(count);
}

std::uint64_t read_count(TextCursor& cursor, const char* what) {
  cursor.skip_to_word();
  return checked_count(cursor, cursor.integer(what), what);
}

/// Nobody fills in the count of edges, and some leave it out: it stands on the line of the faces,
/// or below them where each count has a line.
void skip_edge_count(TextCursor& cursor, bool lines_of_their_own) {
  cursor.skip_blanks();
  if (cursor.at_line_end() && !lines_of_their_own) return cursor.skip_line();
  cursor.skip_to_word();
  if (!cursor.at_end()) cursor.integer("the edge count");
}

}  // namespace

OffHeader read_off_header(TextCursor& cursor) {
  OffHeader header;
  TextCursor behind_word = cursor;
  behind_word.skip_to_word();
  std::string_view word = behind_word.word();
  const bool has_word = !is_number(word);
  if (has_word) {
    const bool dimension = read_letters(cursor, word, header);
    // What is left of the word is the first count.
    cursor.skip_to_word();
    while (cursor.position() != word.data()) cursor.advance();
    if (dimension && read_count(cursor, "the dimension") != 3) {
      cursor.fail("this is not an OFF file of three-dimensional vertices");
    }
    cursor.skip_blanks();
    if (upper(cursor.peek()) == 'B') {
      cursor.fail("binary OFF is not read: save the file as text, or as PLY");
    }
  }
  header.vertices = read_count(cursor, "the vertex count");
  cursor.skip_blanks();
  const bool broken = cursor.at_line_end();
  header.faces = read_count(cursor, "the face count");
  skip_edge_count(cursor, broken);
  return header;
}

}  // namespace beltrami::cli
