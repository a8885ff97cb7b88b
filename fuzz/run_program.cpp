// The whole program in this process: the first line of the bytes is its command line, and behind it
// are its files, each behind a line "@NAME". tests/program runs it as scripts do; here it is run
// thousands of times, in a folder of its own.
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "process/failure.h"
#include "target.h"

/// main() of program/main.cpp, which the build gives this name here.
int beltrami_main(int argc, char** argv);

// Part of the runtime of the sanitizers.
extern "C" void __sanitizer_set_report_fd(void* descriptor);

namespace beltrami::fuzz {
namespace {

namespace fs = std::filesystem;

/// A folder that the program is in while it runs, emptied before each run.
class Folder {
 public:
  Folder() : before_(open(".", O_PATH | O_CLOEXEC)) {
    const char* const shared = "/dev/shm";
    const fs::path parent =
        access(shared, W_OK) == 0 ? fs::path(shared) : fs::temp_directory_path();
    std::string name = (parent / "beltrami_fuzz_XXXXXX").string();
    promise(before_ >= 0 && mkdtemp(name.data()) != nullptr, "there is a folder to run in");
    outer_ = name;
    fs::create_directory(inner());
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(outer_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  fs::path inner() const { return outer_ / "in"; }
  void enter() {
    for (const auto& entry : fs::directory_iterator(inner())) fs::remove_all(entry.path());
    fs::current_path(inner());
  }
  void leave() { promise(fchdir(before_) == 0, "the folder before is there"); }
  std::size_t files() const { return count(inner()); }
  /// Files beside the folder, where nothing is to be written.
  std::size_t beside() const { return count(outer_) - 1; }

 private:
  static std::size_t count(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}));
  }
  int before_;
  fs::path outer_;
};

/// What is written to a descriptor while this lives.
class Caught {
 public:
  explicit Caught(int number)
      : number_(number), kept_(dup(number)), file_(memfd_create("caught", MFD_CLOEXEC)) {
    promise(kept_ >= 0 && file_ >= 0 && dup2(file_, number_) >= 0, "output is caught");
  }
  ~Caught() {
    dup2(kept_, number_);
    close(kept_);
    close(file_);
  }
  Caught(const Caught&) = delete;
  Caught& operator=(const Caught&) = delete;

  std::string text() const {
    std::string out(static_cast<std::size_t>(lseek(file_, 0, SEEK_END)), '\0');
    const ssize_t got = pread(file_, out.data(), out.size(), 0);
    out.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return out;
  }

 private:
  int number_, kept_, file_;
};

/// How a run ended.
struct End {
  int code = 0;
  std::string out, err;
};

End run(std::vector<std::string> words) {
  words.insert(words.begin(), "beltrami");
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  End end;
  std::fflush(nullptr);
  const Caught out(1), err(2);
  cli::forget_what_was_told();
  end.code = beltrami_main(static_cast<int>(words.size()), pointers.data());
  std::fflush(nullptr);
  end.out = out.text();
  end.err = err.text();
  return end;
}

/// Words of the command line. None leads out of the folder, and no number asks for hours.
std::vector<std::string> words_of(std::string_view line) {
  constexpr std::size_t kMostWords = 24, kMostDigits = 3;
  std::vector<std::string> words;
  std::string word;
  std::size_t digits = 0;
  const auto end_word = [&] {
    if (!word.empty() && words.size() < kMostWords) words.push_back(word);
    word.clear();
    digits = 0;
  };
  for (const char c : line) {
    if (c == ' ') {
      end_word();
      continue;
    }
    digits = std::isdigit(static_cast<unsigned char>(c)) ? digits + 1 : 0;
    if (digits > kMostDigits || c == '\0') continue;
    word += c == '/' ? '_' : c;
  }
  end_word();
  return words;
}

bool has(const std::vector<std::string>& words, std::string_view prefix) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word.starts_with(prefix); });
}

/// Small pages and one thread, where nothing else is asked for.
void hold_down(std::vector<std::string>& words) {
  const std::string command = words.empty() ? "" : words[0];
  const bool packs = command == "unwrap" || command == "pack";
  // With pins nothing is packed, and the option is refused.
  if ((packs || command == "transfer") && !has(words, "--res") && !has(words, "--pi")) {
    words.insert(words.end(), {"--resolution", "32"});
  }
  if ((packs || command == "flatten") && !has(words, "--thr")) {
    words.insert(words.end(), {"--threads", "1"});
  }
}

/// Writes the files that stand behind the first line.
void write_files(std::string_view text) {
  while (!text.empty() && text[0] == '@') {
    const std::size_t line = std::min(text.find('\n'), text.size());
    std::string name(text.substr(1, line - 1));
    text.remove_prefix(std::min(line + 1, text.size()));
    const std::size_t end = std::min(text.find("\n@"), text.size());
    std::erase_if(name, [](char c) { return c == '/' || c == '\0'; });
    constexpr std::size_t kLongestName = 40;
    const bool is_temporary = name.ends_with(".tmp");
    if (!name.empty() && name[0] != '.' && name.size() < kLongestName && !is_temporary) {
      std::ofstream(name, std::ios::binary) << text.substr(0, end);
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

/// Whether a terminal would obey something.
bool has_controls(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if ((c < 0x20 && c != '\n') || c == 0x7f) return true;
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0xff;
    if (c == 0xc2 && next >= 0x80 && next < 0xa0) return true;
  }
  return false;
}

void judge_end(const End& end) {
  constexpr std::array kCodes = {0, 2, 3};
  if (std::find(kCodes.begin(), kCodes.end(), end.code) == kCodes.end()) {
    std::fprintf(stderr, "exit code %d: %s\n", end.code, end.err.c_str());
    broken("an exit code is one of those for what files and arguments can do");
  }
  promise(!has_controls(end.err), "nothing that a terminal obeys is on stderr");
  promise(!has_controls(end.out), "nothing that a terminal obeys is on stdout");
  if (end.code == 2) {
    promise(std::count(end.err.begin(), end.err.end(), '\n') >= 1, "a refusal has a sentence");
  }
}

/// An atlas that is said to be injective is so for `check`, as it is read from its file.
void judge_output(const std::vector<std::string>& words, const End& end) {
  if (end.code != 0 || words.size() < 3 || words[0] != "unwrap") return;
  const std::string& output = words[2];
  if (output.starts_with("-") || !fs::is_regular_file(output)) return;
  // What shares texels on purpose lies on itself, other numbers than the UVs that are read may be
  // written, and other pages than the first are beside [0,1]^2.
  for (const char* word : {"--st", "--sh", "--uv", "--pack", "--max-p", "--tex", "--label-", "-"}) {
    if (word == std::string("-") ? has(words, "-h") : has(words, word)) return;
  }
  std::vector<std::string> asked = {"check", output, "--mirrored"};
  if (!has(words, "--pi")) asked.emplace_back("--within-page");  // pins lie anywhere
  const End check = run(asked);
  if (check.code == 0) return;
  std::fprintf(stderr, "%s%s", check.out.c_str(), check.err.c_str());
  broken("what is written is injective to the program itself");
}

void prepare_once() {
  static const bool done = [] {
    // A fault is to end the process as a finding, not as the program would end.
    std::set_terminate([] { std::abort(); });
    const auto kept = static_cast<std::intptr_t>(dup(2));
    __sanitizer_set_report_fd(reinterpret_cast<void*>(kept));  // NOLINT(performance-no-int-to-ptr)
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace

void run_one(std::string_view bytes) {
  static Folder folder;
  prepare_once();
  const std::size_t line = std::min(bytes.find('\n'), bytes.size());
  std::vector<std::string> words = words_of(bytes.substr(0, line));
  hold_down(words);
  folder.enter();
  write_files(bytes.substr(std::min(line + 1, bytes.size())));
  const End end = run(words);
  judge_end(end);
  for (const auto& entry : fs::directory_iterator(".")) {
    const std::string name = entry.path().filename();
    const bool asked_for = std::find(words.begin(), words.end(), name) != words.end();
    promise(asked_for || !name.ends_with(".tmp"), "nothing is left beside the outputs");
  }
  promise(folder.beside() == 0, "nothing is written beside the folder");
  judge_output(words, end);
  folder.leave();
}

}  // namespace beltrami::fuzz
