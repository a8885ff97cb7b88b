#include "files/moved_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "files/inside_folder.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t";

/// What stands before the names on a line.
constexpr std::array<std::string_view, 5> kBeginnings = {"mtllib", "maplib", "shadow_obj",
                                                         "trace_obj", "comment TextureFile"};

fs::path folder_of(const std::string& path) {
  std::error_code ignored;  // what cannot be resolved is compared as it is
  return fs::weakly_canonical(fs::absolute(path, ignored).parent_path(), ignored);
}

/// Where the names of this line begin; npos where it has none.
std::size_t begin_of_names(std::string_view line) {
  for (const std::string_view beginning : kBeginnings) {
    if (!line.starts_with(beginning)) continue;
    const std::size_t begin = line.find_first_not_of(kBlanks, beginning.size());
    if (begin != beginning.size()) return begin;
  }
  return std::string_view::npos;
}

std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = text.find_first_not_of(kBlanks, end);
  }
  return words;
}

bool exists(const NamedFile& file) {
  std::error_code ignored;
  return !file.path.empty() && fs::exists(file.path, ignored);
}

}  // namespace

MovedNames::MovedNames(const MeshFile& mesh, const std::string& path) : mesh_(mesh) {
  if (mesh.path.empty()) return;
  const fs::path folder = folder_of(path);
  if (folder != folder_of(mesh.path)) folder_ = folder.string();
}

std::string MovedNames::line(const std::string& line) {
  const std::size_t begin = begin_of_names(line);
  if (folder_.empty() || begin == std::string::npos) return line;
  // A name may have blanks, and there may be several names: the files that there are say which.
  const std::string names = line.substr(begin);
  const std::vector<std::string> words = words_of(names);
  const bool several = words.size() > 1 && std::any_of(words.begin(), words.end(), [&](auto& word) {
                         return exists(follow_name(mesh_.path, word, mesh_.reach));
                       });
  if (!several) return line.substr(0, begin) + moved(names);
  std::string text = line.substr(0, begin);
  for (const std::string& word : words) {
    text += moved(word);
    text += ' ';
  }
  text.pop_back();
  return text;
}

std::string MovedNames::moved(const std::string& name) {
  const NamedFile file = follow_name(mesh_.path, name, mesh_.reach);
  if (file.path.empty()) notes_.push_back("where '" + name + "' leads: it " + file.refusal);
  if (!exists(file)) return name;
  std::error_code error;
  const fs::path relative = fs::relative(file.path, folder_, error);
  // From one drive to another there is no relative path.
  return error || relative.empty() ? fs::path(file.path).generic_string()
                                   : relative.generic_string();
}

}  // namespace beltrami::cli
