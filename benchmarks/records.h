// The harness of every benchmark: its command line, its failures, and its figures as records that
// stay, so that a regression can be seen.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace beltrami::benchmarks {

using Json = nlohmann::ordered_json;

/// Figures of one run of a benchmark: each a JSON object whose keys name what it is of.
class Records {
 public:
  /// `benchmark`: "pipeline", as ./dev bench calls it.
  explicit Records(std::string benchmark) : benchmark_(std::move(benchmark)) {}

  /// --json FILE: the rows, as an array. --record: appends the rows to benchmarks/history, a line
  /// each, with the commit, the date, the processor and the build.
  void add_to(CLI::App& app);
  void add(Json row) { rows_.push_back(std::move(row)); }
  /// Throws std::runtime_error where a file cannot be written.
  void write() const;

 private:
  std::string benchmark_, json_;
  bool record_ = false;
  std::vector<Json> rows_;
};

/// Parses the command line, runs the body, writes its records. Returns the exit code: that of the
/// body, or 2 after what it threw, in a line.
int run(CLI::App& app, int argc, char** argv, Records& records, const std::function<int()>& body);

}  // namespace beltrami::benchmarks
