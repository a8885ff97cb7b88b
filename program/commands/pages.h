// What commands say and write of the pages that charts lie on.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "commands/report.h"
#include "files/atomic_file.h"

namespace beltrami::cli {

/// "folder/name.1002.png" of page 1 for "folder/name.png", "folder/name.1001.png", "folder/name".
std::string path_of_page(const std::string& path, std::uint64_t page);
/// The same for a picture to read, which keeps its extension.
std::string texture_of_page(const std::string& path, std::uint64_t page);

/// Puts what was packed last into the report.
void report_pages(beltrami_context* context, Report& report);

/// Which pages the labels of faces are on, as they come up.
class PagesOfLabels {
 public:
  /// The number of a label, by its name: equal names of several files are one label.
  std::uint64_t number(const std::string& name);
  void add(std::uint64_t label, std::uint64_t page);
  /// By their first pages, without those that are on none.
  std::vector<LabelPages> taken() const;

 private:
  std::map<std::string, std::uint64_t> numbers_;
  std::vector<LabelPages> pages_;
  std::vector<bool> has_page_;
};

/// Writes a PNG for each page that was packed last: black is free, grey a gutter, white covered.
/// `base` is a folder and a name: "masks/bust" writes masks/bust.1001.png.
void write_masks(beltrami_context* context, const std::string& base,
                 std::deque<AtomicFile>& outputs);

}  // namespace beltrami::cli
