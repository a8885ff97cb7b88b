#include "files/inside_folder.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <new>
#include <optional>
#include <system_error>

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

NamedFile refused(const char* why) {
  return {{}, why};
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Whether a scheme (RFC 3986, 3.1) or a drive stands in front.
bool has_scheme(std::string_view name) {
  const auto goes_on = [](char c) {
    return is_letter(c) || is_digit(c) || c == '+' || c == '-' || c == '.';
  };
  const auto end = std::find_if_not(name.begin(), name.end(), goes_on);
  return end != name.begin() && is_letter(name.front()) && end != name.end() && *end == ':';
}

std::optional<unsigned> hex_digit(char c) {
  if (is_digit(c)) return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return std::nullopt;
}

std::string decode_percent(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const std::optional<unsigned> high = hex_digit(uri[i + 1]), low = hex_digit(uri[i + 2]);
      if (high && low) {
        name += static_cast<char>(16 * *high + *low);
        i += 2;
        continue;
      }
    }
    name += uri[i];
  }
  return name;
}

void require_memory(const std::error_code& error) {
  if (error == std::errc::not_enough_memory) throw std::bad_alloc();
}

/// Links followed, as far as the path exists; nothing where it goes in circles or may not be seen.
std::optional<fs::path> resolved(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  require_memory(error);
  if (error) return std::nullopt;
  fs::path found = fs::weakly_canonical(absolute, error);
  require_memory(error);
  if (error) return std::nullopt;
  return found;
}

bool is_within(const fs::path& folder, const fs::path& path) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

/// The path that a name stands for: Windows' own separators are read wherever the name as it is
/// leads to no file.
fs::path with_separators(const fs::path& folder, std::string name) {
  std::error_code ignored;
  if (name.find('/') == std::string::npos && fs::exists(folder / name, ignored)) return name;
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

NamedFile follow(const std::string& file, const std::string& name, Reach reach) {
  if (name.empty()) return refused("names no file");
  if (name.find('\0') != std::string::npos) return refused("has a zero byte, and names no file");
  const fs::path parent = fs::path(file).parent_path();
  const std::optional<fs::path> folder = resolved(parent.empty() ? fs::path(".") : parent);
  if (!folder) return refused("cannot be followed: the folder of this file cannot be seen");
  const std::optional<fs::path> path = resolved(*folder / with_separators(*folder, name));
  if (!path) return refused("cannot be followed: links lead in a circle, or may not be seen");
  if (reach == Reach::kItsFolder && !is_within(*folder, *path)) {
    return refused(
        "leads out of the folder of this file, and is not followed: move the file there, or allow "
        "it with --allow-outside");
  }
  std::error_code error;
  const fs::file_status status = fs::status(*path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return refused("is no regular file");
  return {path->string(), {}};
}

}  // namespace

NamedFile follow_name(const std::string& file, std::string_view name, Reach reach) {
  if (has_scheme(name)) return refused("has a scheme or a drive, and is not followed");
  return follow(file, std::string(name), reach);
}

NamedFile follow_uri(const std::string& file, std::string_view uri, Reach reach) {
  if (has_scheme(uri)) return refused("has a scheme, and is not followed");
  return follow(file, decode_percent(uri), reach);
}

}  // namespace beltrami::cli
