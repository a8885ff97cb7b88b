#include "files/ply_header.h"

#include <algorithm>

#include "files/mesh_file.h"

namespace beltrami::cli {
namespace {

/// More elements, or properties of one, than any file has: each is looked up among the others.
constexpr std::size_t kMostNames = 4096;
/// Of a keyword that is passed over, and only named.
constexpr std::size_t kLongestKeyword = 64;

std::string lower(std::string_view word) {
  std::string text(word);
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string_view next_word(TextCursor& cursor) {
  cursor.skip_blanks();
  return cursor.word();
}

Scalar read_type(const TextCursor& cursor, std::string_view word) {
  const std::optional<Scalar> type = scalar_named(lower(word));
  if (!type) cursor.fail("unknown property type '" + std::string(word.substr(0, 40)) + "'");
  return *type;
}

PlyProperty read_property(TextCursor& cursor) {
  PlyProperty property;
  std::string_view word = next_word(cursor);
  if (lower(word) == "list") {
    property.count_type = read_type(cursor, next_word(cursor));
    word = next_word(cursor);
  }
  property.type = read_type(cursor, word);
  property.name = next_word(cursor);
  if (property.name.empty()) cursor.fail("a property without a name");
  return property;
}

PlyEncoding read_encoding(TextCursor& cursor) {
  const std::string word = lower(next_word(cursor));
  if (word == "ascii") return PlyEncoding::kText;
  if (word == "binary_little_endian") return PlyEncoding::kLittle;
  if (word == "binary_big_endian") return PlyEncoding::kBig;
  cursor.fail("unknown PLY format '" + word.substr(0, 40) + "'");
}

PlyElement read_element(TextCursor& cursor) {
  PlyElement element;
  element.name = next_word(cursor);
  if (element.name.empty()) cursor.fail("an element without a name");
  const std::int64_t count = cursor.integer("an element count");
  if (count < 0 || count > kMaxIndex) {
    cursor.fail("an element count is out of range: " + std::to_string(count));
  }
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

/// Adds `item` to a list in which names are different.
template <class Item>
void add_named(const TextCursor& cursor, const char* what, Item item, std::vector<Item>& items) {
  const bool known = std::any_of(items.begin(), items.end(),
                                 [&](const Item& other) { return other.name == item.name; });
  if (known) cursor.fail(std::string("a second ") + what + " '" + item.name.substr(0, 40) + "'");
  if (items.size() == kMostNames) {
    cursor.fail("more than " + std::to_string(kMostNames) + " of a kind: " + what);
  }
  items.push_back(std::move(item));
}

std::string line_from(const char* begin, const TextCursor& cursor) {
  std::string line(begin, cursor.position());
  line.erase(line.find_last_not_of(" \t\r\n") + 1);
  return line;
}

}  // namespace

const PlyProperty* PlyElement::find(std::string_view wanted) const {
  for (const PlyProperty& property : properties) {
    if (property.name == wanted && !property.count_type) return &property;
  }
  return nullptr;
}

const PlyProperty* PlyElement::find_list(std::string_view wanted) const {
  for (const PlyProperty& property : properties) {
    if (property.name == wanted && property.count_type) return &property;
  }
  return nullptr;
}

const PlyElement* PlyHeader::find(std::string_view name) const {
  for (const PlyElement& element : elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

PlyHeader read_ply_header(TextCursor& cursor) {
  cursor.skip_blanks();
  if (lower(cursor.word()) != "ply")
    cursor.fail("this is not a PLY file: it does not begin with 'ply'");
  PlyHeader header;
  bool has_format = false;
  cursor.skip_line();
  for (;;) {
    if (cursor.at_end()) cursor.fail("the header has no end_header");
    cursor.skip_blanks();
    const char* begin = cursor.position();
    const std::string keyword = lower(cursor.word());
    if (keyword == "end_header") break;
    if (keyword == "comment" || keyword == "obj_info") {
      cursor.skip_line();
      header.comments.push_back(line_from(begin, cursor));
      continue;
    }
    if (keyword == "format") {
      header.encoding = read_encoding(cursor);
      has_format = true;
    } else if (keyword == "element") {
      add_named(cursor, "element", read_element(cursor), header.elements);
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property before the first element");
      add_named(cursor, "property", read_property(cursor), header.elements.back().properties);
    } else if (!keyword.empty() && header.unknown.size() < kMostNames) {
      header.unknown.push_back(keyword.substr(0, kLongestKeyword));
    }
    cursor.skip_line();
  }
  if (!has_format) cursor.fail("the header names no format");
  cursor.skip_line();
  return header;
}

}  // namespace beltrami::cli
