// Results as a table of hashes, to be the same on any processor, at any number of threads, and
// after any change that is not meant to change them.
//
//     beltrami_hashes [--write] FOLDER GROUP...
//
// A group (functions, small, bust, random) is a file FOLDER/GROUP.txt, a row a run: mesh and
// options, status, flipped + empty faces and crossings of the boundary, mean symmetric Dirichlet
// energy, and a hash of all that was delivered, to the last bit. Rows that differ are printed, and
// the exit code is 1; with --write the file then has the new ones.
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "hashes/rows.h"

namespace beltrami::hashes {
namespace {

const std::map<std::string, std::vector<std::string> (*)()> kGroups = {{"functions", function_rows},
                                                                       {"small", small_rows},
                                                                       {"bust", bust_rows},
                                                                       {"random", random_rows}};

std::vector<std::string> read_lines(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// What a row is about: all before the first two spaces.
std::string key_of(const std::string& row) {
  return row.substr(0, row.find("  "));
}

int print_differences(const std::vector<std::string>& known, const std::vector<std::string>& rows) {
  std::map<std::string, std::string> old;
  for (const std::string& row : known) old[key_of(row)] = row;
  int differing = 0;
  for (const std::string& row : rows) {
    const auto entry = old.find(key_of(row));
    const std::string before = entry == old.end() ? "" : entry->second;
    if (entry != old.end()) old.erase(entry);
    if (before == row) continue;
    ++differing;
    if (!before.empty()) std::printf("- %s\n", before.c_str());
    std::printf("+ %s\n", row.c_str());
  }
  for (const auto& [key, row] : old) std::printf("- %s\n", row.c_str());
  return differing + static_cast<int>(old.size());
}

/// Whether the group's rows are those of its file.
bool compare(const std::string& folder, const std::string& group, bool write) {
  const auto entry = kGroups.find(group);
  if (entry == kGroups.end()) throw std::runtime_error("there is no group " + group);
  const std::string path = folder + "/" + group + ".txt";
  const std::vector<std::string> rows = entry->second(), known = read_lines(path);
  const int differing = print_differences(known, rows);
  std::printf("%s: %d of %zu rows differ\n", group.c_str(), differing, rows.size());
  if (differing == 0 && known == rows) return true;
  if (!write) return false;
  std::ofstream file(path);
  for (const std::string& row : rows) file << row << "\n";
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
  return true;
}

int run(std::vector<std::string> words) {
  const bool write = !words.empty() && words.front() == "--write";
  if (write) words.erase(words.begin());
  if (words.size() < 2)
    throw std::runtime_error("usage: beltrami_hashes [--write] FOLDER GROUP...");
  bool same = true;
  for (std::size_t i = 1; i < words.size(); ++i) {
    same = compare(words.front(), words[i], write) && same;
  }
  if (same) return 0;
  std::puts("Where a change of the results is meant, ./dev hashes takes the new rows.");
  return 1;
}

}  // namespace
}  // namespace beltrami::hashes

int main(int argc, char** argv) {
  try {
    return beltrami::hashes::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "beltrami_hashes: %s\n", error.what());
    return 2;
  }
}
