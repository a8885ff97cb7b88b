#include "files/given_cuts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include "files/column.h"
#include "files/polygons.h"
#include "files/text_cursor.h"
#include "process/descriptor.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 3> kStatements = {
    {{"materials", "usemtl"}, {"groups", "g"}, {"objects", "o"}}};

std::string_view keyword_of(const Statement& statement) {
  const std::string_view text = statement.text;
  return text.substr(0, text.find_first_of(" \t"));
}

bool has_statement(const MeshFile& file, std::string_view name) {
  return std::any_of(kStatements.begin(), kStatements.end(), [&](const auto& known) {
    return known.first == name &&
           std::any_of(file.statements.begin(), file.statements.end(),
                       [&](const Statement& s) { return keyword_of(s) == known.second; });
  });
}

/// The name that the file has for it: OBJ has "materials", glTF "material", and either is meant.
std::string name_in(const MeshFile& file, const std::string& name) {
  const auto holds = [&](const std::string& known) {
    return has_statement(file, known) || find_column(file.face_columns, known) != nullptr;
  };
  const bool plural = name.ends_with('s');
  const std::string other = plural ? name.substr(0, name.size() - 1) : name + "s";
  return !holds(name) && holds(other) ? other : name;
}

/// Faces by the last statement of this kind before them; 0 where there is none.
std::vector<std::uint64_t> by_statements(const MeshFile& file, std::string_view keyword) {
  std::vector<std::uint64_t> labels(file.polygons.size(), 0);
  std::map<std::string, std::uint64_t> number_of;
  std::uint64_t label = 0, from = 0;
  const auto fill_to = [&](std::uint64_t end) {
    for (; from < end; ++from) labels[from] = label;
  };
  for (const Statement& statement : file.statements) {
    if (keyword_of(statement) != keyword) continue;
    fill_to(statement.polygon);
    label = number_of.emplace(statement.text, number_of.size() + 1).first->second;
  }
  fill_to(labels.size());
  return labels;
}

/// Blanks, line ends, comments, and what lists of pairs are written with: commas, brackets.
void skip_separators(TextCursor& cursor) {
  constexpr std::string_view kSeparators = ",;()[]{}";
  for (cursor.skip_to_word(); !cursor.at_end(); cursor.skip_to_word()) {
    if (kSeparators.find(cursor.peek()) == std::string_view::npos) return;
    cursor.advance();
  }
}

/// The digits here; Failure where anything else stands here or joins them.
std::uint64_t read_vertex_number(TextCursor& cursor) {
  constexpr std::size_t kMostDigits = 19;  // of 64 bits
  const auto is_digit = [&] { return cursor.peek() >= '0' && cursor.peek() <= '9'; };
  std::string digits;
  for (; !cursor.at_end() && is_digit() && digits.size() < kMostDigits; cursor.advance()) {
    digits += cursor.peek();
  }
  constexpr std::string_view kEnds = " \t\r\n\v\f#,;()[]{}";
  if (digits.empty() || (!cursor.at_end() && kEnds.find(cursor.peek()) == std::string_view::npos)) {
    cursor.fail("'" + digits + std::string(cursor.word().substr(0, 40)) +
                "' is no vertex: seams are pairs of vertex numbers, counted from 0");
  }
  std::uint64_t vertex = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), vertex);
  return vertex;
}

}  // namespace

std::vector<std::uint64_t> face_labels(const MeshFile& file, const std::string& given,
                                       const std::string& flag, const std::string& to) {
  const std::string name = name_in(file, given);
  for (const auto& [label, keyword] : kStatements) {
    if (label != name) continue;
    const auto found =
        std::find_if(file.statements.begin(), file.statements.end(),
                     [&, &key = keyword](const auto& s) { return keyword_of(s) == key; });
    if (found == file.statements.end()) {
      throw Failure(file.path + ": the file has no " + name + " to " + to + " (" + flag + ")");
    }
    return by_statements(file, keyword);
  }
  const Column* column = find_column(file.face_columns, name);
  if (column == nullptr || column->is_list()) {
    throw Failure(file.path + ": faces have no property '" + name + "' to " + to + ": " + flag +
                  " takes materials, groups, objects, or a property of the faces of a PLY file, "
                  "and of glTF material");
  }
  std::vector<std::uint64_t> labels;
  for (std::uint64_t i = 0; i < file.polygons.size(); ++i) {
    labels.push_back(std::bit_cast<std::uint64_t>((*column)[i] + 0.0));  // -0 becomes 0
  }
  return labels;
}

std::map<std::uint64_t, std::string> label_texts(const MeshFile& file, const std::string& given,
                                                 const std::vector<std::uint64_t>& labels) {
  const std::string name = name_in(file, given);
  std::map<std::uint64_t, std::string> texts;
  for (const std::uint64_t label : labels) texts.try_emplace(label);
  for (const auto& [list, keyword] : kStatements) {
    if (list != name) continue;
    for (auto& [label, text] : texts) text = "none of the " + name;
    std::set<std::string_view> known;
    for (const Statement& statement : file.statements) {
      if (keyword_of(statement) != keyword || !known.insert(statement.text).second) continue;
      if (const auto found = texts.find(known.size()); found != texts.end()) {
        found->second = statement.text;
      }
    }
    return texts;
  }
  for (auto& [label, text] : texts) {
    std::array<char, 32> digits{};
    const auto value = std::bit_cast<double>(label);
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text = name + " " + std::string(digits.data(), end);
  }
  return texts;
}

std::vector<std::uint32_t> read_seams(const std::string& path, const MeshFile& file) {
  const std::string text = read_file(path);
  std::vector<std::uint32_t> ends;
  TextCursor cursor(text, path);
  for (skip_separators(cursor); !cursor.at_end(); skip_separators(cursor)) {
    const std::uint64_t vertex = read_vertex_number(cursor);
    if (vertex >= file.vertex_count()) {
      cursor.fail("there is no vertex " + std::to_string(vertex) + ": " + file.path + " has " +
                  std::to_string(file.vertex_count()) + ", counted from 0");
    }
    ends.push_back(static_cast<std::uint32_t>(vertex));
  }
  if (ends.size() % 2 == 1) {
    throw Failure(path + ": seams are pairs of vertices, and these are " +
                  std::to_string(ends.size()) + " numbers");
  }
  return ends;
}

SeamsWithoutEdge seams_without_edge(const std::vector<std::uint32_t>& seams, const MeshFile& file) {
  using Place = std::array<double, 3>;
  const auto place = [&](std::uint32_t v) {
    const double* p = &file.positions[3 * std::size_t{v}];
    return Place{p[0], p[1], p[2]};
  };
  const auto between = [&](std::uint32_t a, std::uint32_t b) -> std::pair<Place, Place> {
    return std::minmax({place(a), place(b)});
  };
  std::set<std::pair<Place, Place>> missing;
  for (std::size_t i = 0; i < seams.size(); i += 2) missing.insert(between(seams[i], seams[i + 1]));
  for (std::uint64_t f = 0; f < file.polygons.size(); ++f) {
    const std::span<const std::uint32_t> corners = file.polygons[f];
    for (std::size_t k = 0; k < corners.size(); ++k) {
      missing.erase(between(corners[k], corners[(k + 1) % corners.size()]));
    }
  }
  SeamsWithoutEdge found;
  for (std::size_t i = 0; i < seams.size(); i += 2) {
    if (!missing.contains(between(seams[i], seams[i + 1]))) continue;
    if (found.count++ == 0) std::tie(found.from, found.to) = std::tie(seams[i], seams[i + 1]);
  }
  return found;
}

}  // namespace beltrami::cli
