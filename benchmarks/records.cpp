#include "records.h"

#include <beltrami/beltrami.h>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <array>
#include <cstdio>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace beltrami::benchmarks {
namespace {

std::string first_line_of(const char* command) {
  std::string line;
#if !defined(_WIN32)
  if (FILE* pipe = popen(command, "r")) {
    std::array<char, 256> text{};
    if (std::fgets(text.data(), text.size(), pipe) != nullptr) line = text.data();
    pclose(pipe);
  }
#endif
  line.erase(line.find_last_not_of(" \r\n") + 1);
  return line;
}

/// "" where the system does not tell.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", std::gmtime(&now));
  return text.data();
}

void require_written(const std::ofstream& file, const std::string& path) {
  if (!file) throw std::runtime_error(path + " cannot be written");
}

}  // namespace

void Records::add_to(CLI::App& app) {
  app.add_option("--json", json_, "Write the figures to this file, too");
  app.add_flag("--record", record_,
               "Append the figures to benchmarks/history, with commit and machine");
}

void Records::write() const {
  if (!json_.empty()) {
    std::ofstream file(json_);
    file << Json(rows_).dump(1) << "\n";
    require_written(file, json_);
  }
  if (!record_) return;
  const std::string source = BELTRAMI_SOURCE_DIR;
  const std::string commit =
      first_line_of(("git -C '" + source + "' describe --always --dirty 2>/dev/null").c_str());
  const Json head = {{"date", today()},
                     {"commit", commit},
                     {"processor", processor()},
                     {"build", beltrami_build_info()}};
  const std::filesystem::path path =
      std::filesystem::path(source) / "benchmarks" / "history" / (benchmark_ + ".jsonl");
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::app);
  for (const Json& row : rows_) {
    Json line = head;
    line.update(row);
    file << line.dump() << "\n";
  }
  require_written(file, path.string());
}

int run(CLI::App& app, int argc, char** argv, Records& records, const std::function<int()>& body) {
  records.add_to(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  try {
    const int code = body();
    records.write();
    return code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  }
}

}  // namespace beltrami::benchmarks
