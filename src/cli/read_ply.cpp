// Stanford PLY: text, and binary of either byte order. Elements and properties that are of no use
// here are passed over, whatever their order and types.
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <optional>

#include "failure.h"
#include "mesh_file.h"
#include "text_cursor.h"

namespace beltrami::cli {
namespace {

enum class Type { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };
enum class Encoding { kText, kLittle, kBig };

struct Property {
  std::string name;
  Type type = Type::kF32;
  std::optional<Type> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
};

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

Type parse_type(const TextCursor& cursor, std::string_view word) {
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames = {{{"char", "int8"},
                                                                      {"uchar", "uint8"},
                                                                      {"short", "int16"},
                                                                      {"ushort", "uint16"},
                                                                      {"int", "int32"},
                                                                      {"uint", "uint32"},
                                                                      {"float", "float32"},
                                                                      {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (word == kNames[i][0] || word == kNames[i][1]) return static_cast<Type>(i);
  }
  cursor.fail("unknown property type '" + std::string(word) + "'");
}

std::string_view next_word(TextCursor& cursor) {
  cursor.skip_blanks();
  return cursor.word();
}

Property parse_property(TextCursor& cursor) {
  Property property;
  std::string_view word = next_word(cursor);
  if (word == "list") {
    property.count_type = parse_type(cursor, next_word(cursor));
    word = next_word(cursor);
  }
  property.type = parse_type(cursor, word);
  property.name = next_word(cursor);
  return property;
}

Encoding parse_format(TextCursor& cursor) {
  const std::string_view word = next_word(cursor);
  if (word == "ascii") return Encoding::kText;
  if (word == "binary_little_endian") return Encoding::kLittle;
  if (word == "binary_big_endian") return Encoding::kBig;
  cursor.fail("unknown PLY format '" + std::string(word) + "'");
}

/// Leaves the cursor on the first byte after the line of end_header.
Header parse_header(TextCursor& cursor) {
  if (cursor.word() != "ply") cursor.fail("this is not a PLY file: it does not begin with 'ply'");
  Header header;
  bool has_format = false;
  for (;;) {
    cursor.skip_line();
    if (cursor.at_end()) cursor.fail("the header has no end_header");
    const std::string_view keyword = next_word(cursor);
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.encoding = parse_format(cursor);
      has_format = true;
    } else if (keyword == "element") {
      Element element;
      element.name = next_word(cursor);
      const std::int64_t count = cursor.integer("an element count");
      if (count < 0 || count > std::numeric_limits<std::int32_t>::max()) {
        cursor.fail("an element count is out of range: " + std::to_string(count));
      }
      element.count = static_cast<std::uint64_t>(count);
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) cursor.fail("a property before the first element");
      header.elements.back().properties.push_back(parse_property(cursor));
    } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
      cursor.fail("unknown keyword '" + std::string(keyword.substr(0, 40)) + "' in the header");
    }
  }
  if (!has_format) cursor.fail("the header names no format");
  cursor.skip_line();
  return header;
}

/// The values of the body one after another. Every PLY type fits a double without loss.
class Values {
 public:
  Values(TextCursor& cursor, Encoding encoding, const char* end)
      : cursor_(cursor), encoding_(encoding), at_(cursor.position()), end_(end) {}

  /// False at the end of the file.
  bool next(Type type, double& value) {
    if (encoding_ == Encoding::kText) {
      cursor_.skip_to_word();
      if (cursor_.at_end()) return false;
      value = cursor_.number("a value");
      return true;
    }
    const std::size_t size = size_of(type);
    if (static_cast<std::size_t>(end_ - at_) < size) return false;
    std::array<char, 8> bytes{};
    std::memcpy(bytes.data(), at_, size);
    at_ += size;
    const bool file_is_little = encoding_ == Encoding::kLittle;
    if (file_is_little != (std::endian::native == std::endian::little)) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    value = decode(type, bytes.data());
    return true;
  }

  /// Passes over `count` values; false at the end of the file.
  bool skip(Type type, std::uint64_t count) {
    if (encoding_ != Encoding::kText) {
      if (static_cast<std::uint64_t>(end_ - at_) / size_of(type) < count) return false;
      at_ += count * size_of(type);
      return true;
    }
    double ignored = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      if (!next(type, ignored)) return false;
    }
    return true;
  }

  /// For messages: the line in text, nothing in binary.
  std::string place(const std::string& path) const {
    return encoding_ == Encoding::kText ? cursor_.place() : path + ": ";
  }

 private:
  template <class T>
  static double decode_as(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  }

  static double decode(Type type, const char* bytes) {
    switch (type) {
      case Type::kI8:
        return decode_as<std::int8_t>(bytes);
      case Type::kU8:
        return decode_as<std::uint8_t>(bytes);
      case Type::kI16:
        return decode_as<std::int16_t>(bytes);
      case Type::kU16:
        return decode_as<std::uint16_t>(bytes);
      case Type::kI32:
        return decode_as<std::int32_t>(bytes);
      case Type::kU32:
        return decode_as<std::uint32_t>(bytes);
      case Type::kF32:
        return decode_as<float>(bytes);
      default:
        return decode_as<double>(bytes);
    }
  }

  TextCursor& cursor_;
  Encoding encoding_;
  const char* at_;
  const char* end_;
};

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& path, Content content)
      : text_(text), path_(path), content_(content), cursor_(text, path) {}

  MeshFile read() {
    const Header header = parse_header(cursor_);
    vertices_ = count_of(header, "vertex");
    if (vertices_ == 0) throw Failure(path_ + ": no vertices");
    if (count_of(header, "face") == 0) throw Failure(path_ + ": no faces");
    Values values(cursor_, header.encoding, text_.data() + text_.size());
    for (const Element& element : header.elements) read_element(element, values);
    return std::move(mesh_);
  }

 private:
  static std::uint64_t count_of(const Header& header, std::string_view name) {
    for (const Element& element : header.elements) {
      if (element.name == name) return element.count;
    }
    return 0;
  }

  void read_element(const Element& element, Values& values) {
    // A wrong count must not make us reserve what is not there: an item has a byte at least.
    const std::uint64_t plausible = std::min<std::uint64_t>(element.count, text_.size());
    if (element.properties.empty()) return;
    if (element.name == "vertex") {
      mesh_.positions.reserve(3 * plausible);
      read_vertices(element, values);
    } else if (element.name == "face") {
      mesh_.faces.reserve(3 * plausible);
      read_faces(element, values);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) skip(property, element, i, values);
      }
    }
  }

  /// Which of x y z u v each property of a vertex is; -1 for others.
  std::vector<int> vertex_slots(const Element& element) const {
    constexpr std::array<std::array<std::string_view, 2>, 3> kUvNames = {
        {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}};
    const auto has = [&](std::string_view name) {
      return std::any_of(element.properties.begin(), element.properties.end(),
                         [&](const Property& p) { return p.name == name && !p.count_type; });
    };
    std::array<std::string_view, 5> names = {"x", "y", "z", "", ""};
    if (!has("x") || !has("y") || !has("z")) {
      throw Failure(path_ + ": vertices without the properties x, y and z");
    }
    for (const auto& pair : kUvNames) {
      if (names[3].empty() && has(pair[0]) && has(pair[1])) {
        names[3] = pair[0];
        names[4] = pair[1];
      }
    }
    if (content_ == Content::kUvs && names[3].empty()) {
      throw Failure(path_ +
                    ": no texture coordinates: vertices need the properties s and t, u and v, or "
                    "texture_u and texture_v");
    }
    std::vector<int> slots;
    for (const Property& property : element.properties) {
      const auto found = std::find(names.begin(), names.end(), property.name);
      slots.push_back(found == names.end() ? -1 : static_cast<int>(found - names.begin()));
    }
    return slots;
  }

  void read_vertices(const Element& element, Values& values) {
    const std::vector<int> slots = vertex_slots(element);
    const std::size_t properties = element.properties.size();
    std::array<double, 5> vertex{};
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t k = 0; k < properties; ++k) {
        const Property& property = element.properties[k];
        if (property.count_type || slots[k] < 0) {
          skip(property, element, i, values);
        } else if (!values.next(property.type, vertex[static_cast<std::size_t>(slots[k])])) {
          fail_truncated(element, i);
        }
      }
      mesh_.positions.insert(mesh_.positions.end(), vertex.begin(), vertex.begin() + 3);
      if (content_ == Content::kUvs) {
        mesh_.uvs.insert(mesh_.uvs.end(), vertex.begin() + 3, vertex.end());
      }
    }
  }

  void read_faces(const Element& element, Values& values) {
    const auto corners =
        std::find_if(element.properties.begin(), element.properties.end(), [](const Property& p) {
          return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
        });
    if (corners == element.properties.end()) {
      throw Failure(path_ + ": faces without the list property vertex_indices");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (&property == &*corners) {
          read_face(property, element, i, values);
        } else {
          skip(property, element, i, values);
        }
      }
    }
  }

  void read_face(const Property& property, const Element& element, std::uint64_t face,
                 Values& values) {
    double count = 0;
    if (!values.next(*property.count_type, count)) fail_truncated(element, face);
    if (count != 3) {
      throw Failure(values.place(path_) + "face " + std::to_string(face) +
                        " (counted from 0) has " + short_number(count) +
                        " corners: triangulate the mesh first",
                    BELTRAMI_ELEMENT_FACE, face);
    }
    for (int k = 0; k < 3; ++k) {
      double index = 0;
      if (!values.next(property.type, index)) fail_truncated(element, face);
      // Negated so that NaN fails too.
      if (!(index >= 0 && index < static_cast<double>(vertices_))) {
        throw Failure(BELTRAMI_E_INDEX_OUT_OF_RANGE,
                      values.place(path_) + "face " + std::to_string(face) +
                          " (counted from 0) names vertex " + short_number(index) +
                          ", but the file has " + std::to_string(vertices_),
                      BELTRAMI_ELEMENT_FACE, face);
      }
      mesh_.faces.push_back(static_cast<std::uint32_t>(index));
    }
  }

  void skip(const Property& property, const Element& element, std::uint64_t item, Values& values) {
    double count = 1;
    if (property.count_type && !values.next(*property.count_type, count)) {
      fail_truncated(element, item);
    }
    if (!(count >= 0 && count <= 4294967295.0)) {
      throw Failure(values.place(path_) + "a list has " + short_number(count) + " items");
    }
    if (!values.skip(property.type, static_cast<std::uint64_t>(count))) {
      fail_truncated(element, item);
    }
  }

  [[noreturn]] void fail_truncated(const Element& element, std::uint64_t item) const {
    throw Failure(path_ + ": the file is truncated: it ends in " + element.name + " " +
                  std::to_string(item) + " (counted from 0) of " + std::to_string(element.count));
  }

  static std::string short_number(double value) {
    std::array<char, 32> digits;
    return {digits.data(), std::to_chars(digits.data(), digits.data() + 32, value).ptr};
  }

  std::string_view text_;
  const std::string& path_;
  Content content_;
  TextCursor cursor_;
  std::uint64_t vertices_ = 0;
  MeshFile mesh_;
};

}  // namespace

MeshFile read_ply(std::string_view text, const std::string& path, Content content) {
  return PlyReader(text, path, content).read();
}

}  // namespace beltrami::cli
