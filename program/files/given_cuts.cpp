#include "files/given_cuts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <map>
#include <string_view>
#include <utility>

#include "files/column.h"
#include "files/polygons.h"
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

}  // namespace

std::vector<std::uint64_t> face_labels(const MeshFile& file, const std::string& name,
                                       const std::string& flag, const std::string& to) {
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
                  " takes materials, groups, objects, or a property of the faces of a PLY file");
  }
  std::vector<std::uint64_t> labels;
  for (std::uint64_t i = 0; i < file.polygons.size(); ++i) {
    labels.push_back(std::bit_cast<std::uint64_t>((*column)[i] + 0.0));  // -0 becomes 0
  }
  return labels;
}

std::vector<std::uint32_t> read_seams(const std::string& path, const MeshFile& file) {
  const std::string text = read_file(path);
  std::vector<std::uint32_t> ends;
  const char *at = text.data(), *end = at + text.size();
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  while ((at = std::find_if(at, end, is_digit)) != end) {
    std::uint64_t vertex = 0;
    const auto [past, error] = std::from_chars(at, end, vertex);
    if (error != std::errc() || vertex >= file.vertex_count()) {
      throw Failure(path + ": there is no vertex " + std::string(at, past) + ": " + file.path +
                    " has " + std::to_string(file.vertex_count()) + ", counted from 0");
    }
    ends.push_back(static_cast<std::uint32_t>(vertex));
    at = past;
  }
  if (ends.size() % 2 == 1) {
    throw Failure(path + ": seams are pairs of vertices, and these are " +
                  std::to_string(ends.size()) + " numbers");
  }
  return ends;
}

}  // namespace beltrami::cli
