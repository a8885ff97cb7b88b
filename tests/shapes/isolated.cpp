#include "shapes/isolated.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>

namespace beltrami::shapes {
namespace {

/// A report as lines of text, which is what a pipe carries.
std::string to_text(const Report& report) {
  std::ostringstream out;
  out.precision(17);
  out << report.status << ' ' << report.cpu_seconds << ' ' << report.energy << '\n';
  for (const Finding& finding : report.findings) {
    std::string what = finding.what;
    std::replace(what.begin(), what.end(), '\n', ' ');
    out << static_cast<int>(finding.fault) << ' ' << what << '\n';
  }
  out << "end\n";
  return out.str();
}

/// False where the text has no end.
bool from_text(const std::string& text, Report& report) {
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  std::istringstream(line) >> report.status >> report.cpu_seconds >> report.energy;
  while (std::getline(in, line)) {
    if (line == "end") return true;
    const auto space = line.find(' ');
    report.findings.push_back(
        {static_cast<Fault>(std::stoi(line.substr(0, space))), line.substr(space + 1)});
  }
  return false;
}

void limit(int resource, rlim_t most) {
  const rlimit value = {most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &value);
}

[[noreturn]] void run_child(const Shape& shape, Way way, int cpu_limit, Check how, int pipe_end) {
  limit(RLIMIT_CPU, static_cast<rlim_t>(cpu_limit));
  limit(RLIMIT_AS, rlim_t{4} << 30);
  limit(RLIMIT_CORE, 0);
  std::string text = to_text(how(shape, way));
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t written = write(pipe_end, text.data() + at, text.size() - at);
    if (written <= 0) break;
    at += static_cast<std::size_t>(written);
  }
  _exit(0);
}

std::string read_all(int pipe_end) {
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(pipe_end, buffer, sizeof buffer)) > 0;) {
    text.append(buffer, static_cast<std::size_t>(n));
  }
  return text;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Report check_isolated(const Shape& shape, Way way, int cpu_limit, Check how) {
  Report report;
  int ends[2];
  std::fflush(nullptr);
  if (pipe(ends) != 0) std::abort();
  const pid_t child = fork();
  if (child < 0) std::abort();
  if (child == 0) {
    close(ends[0]);
    run_child(shape, way, cpu_limit, how, ends[1]);
  }
  close(ends[1]);
  const std::string text = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage used{};
  wait4(child, &status, 0, &used);
  if (from_text(text, report)) return report;
  report.cpu_seconds = seconds(used.ru_utime) + seconds(used.ru_stime);
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  // The hard limit of processor time is told by SIGKILL.
  if (signal == SIGXCPU || (signal == SIGKILL && report.cpu_seconds > cpu_limit - 1)) {
    report.findings = {{Fault::kTime, "more than " + std::to_string(cpu_limit) + " CPU s"}};
  } else {
    report.findings = {{Fault::kCrash, "signal " + std::to_string(signal)}};
  }
  return report;
}

namespace {

class Minimiser {
 public:
  Minimiser(Way way, Fault fault, int runs, int cpu_limit)
      : way_(way), fault_(fault), runs_(runs), cpu_limit_(cpu_limit) {}

  /// Takes `other` for `shape` if it has the fault as well.
  bool take(Shape& shape, const Shape& other) {
    if (runs_-- <= 0 || other.faces() == 0) return false;
    const Report report = check_isolated(other, way_, cpu_limit_);
    const bool has_it = std::any_of(report.findings.begin(), report.findings.end(),
                                    [&](const Finding& f) { return f.fault == fault_; });
    if (has_it) shape = other;
    return has_it;
  }

  void drop_faces(Shape& shape) {
    for (std::size_t chunk = std::max<std::size_t>(1, shape.faces() / 2); runs_ > 0;) {
      bool dropped = false;
      for (std::size_t first = 0; first < shape.faces() && runs_ > 0;) {
        std::vector<char> keep(shape.faces(), 1);
        std::fill(
            keep.begin() + static_cast<std::ptrdiff_t>(first),
            keep.begin() + static_cast<std::ptrdiff_t>(std::min(first + chunk, shape.faces())), 0);
        if (take(shape, only(shape, keep))) {
          dropped = true;
        } else {
          first += chunk;
        }
      }
      if (chunk == 1 && !dropped) return;
      if (!dropped) chunk = std::max<std::size_t>(1, chunk / 2);
    }
  }

  void drop_digits(Shape& shape) {
    for (const double unit : {1e-1, 1e-2, 1e-3, 1e-4, 1e-6}) {
      Shape rounded = shape;
      for (Point3& p : rounded.positions) {
        for (double& x : p) x = std::round(x / unit) * unit;
      }
      if (take(shape, rounded)) return;
    }
  }

 private:
  Way way_;
  Fault fault_;
  int runs_;
  int cpu_limit_;
};

}  // namespace

Shape minimised(const Shape& shape, Way way, Fault fault, int runs, int cpu_limit) {
  Shape least = shape;
  Minimiser minimiser(way, fault, runs, cpu_limit);
  if (std::any_of(least.sizes.begin(), least.sizes.end(), [](auto size) { return size > 3; })) {
    minimiser.take(least, fans(least));
  }
  Shape plain = least;
  plain.resolution = 1024;
  plain.margin = 2;
  if (plain.margin != least.margin || plain.resolution != least.resolution) {
    minimiser.take(least, plain);
  }
  minimiser.drop_faces(least);
  minimiser.drop_digits(least);
  return least;
}

}  // namespace beltrami::shapes
