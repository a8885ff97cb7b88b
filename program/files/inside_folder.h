// Names inside files: a stranger's file must not have other files of the machine read.
#pragma once

#include <string>
#include <string_view>

namespace beltrami::cli {

/// Which files the names inside a file may lead to.
enum class Reach {
  kItsFolder,  ///< those in the folder of that file, and in folders within
  kAnywhere    ///< all, since the user said so
};

/// What a name inside a file leads to.
struct NamedFile {
  std::string path;     ///< where the name may be followed: of a regular file, or of nothing yet
  std::string refusal;  ///< else why it may not, to be put behind the name: "leads out of ..."
};

/// Follows `name`, which the file at `file` has. Links are followed before the verdict, as are `..`
/// and, where no file has the name as it is, backslashes for slashes; `path` has none of them any
/// more. Refused are names that have a scheme or a zero byte, that lead to what is no regular file,
/// and, unless `reach` is kAnywhere, out of the folder of `file`. Opens nothing.
NamedFile follow_name(const std::string& file, std::string_view name, Reach reach);

/// The same for a URI reference (RFC 3986): what it escapes by percent signs is decoded first. One
/// that escapes nothing stands for itself, since exporters forget to escape it.
NamedFile follow_uri(const std::string& file, std::string_view uri, Reach reach);

}  // namespace beltrami::cli
