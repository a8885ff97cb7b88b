// What is misspelt, or could not be meant: said, and not taken in silence.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "commands/spelling.h"
#include "process/failure.h"
#include "run_program.h"
#include "temporary_directory.h"
#include "tiny_meshes.h"

namespace beltrami::cli {
namespace {

/// The lines of a text that are wider than a terminal.
std::vector<std::string> wide_lines(const std::string& text) {
  std::vector<std::string> wide;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.size() > 80) wide.push_back(line);
  }
  return wide;
}

TEST(Help, FitsATerminalAndIsShortOnRequest) {
  const std::string page = run({"--man"}).out;
  for (const std::string command :
       {"", "unwrap", "flatten", "check", "pack", "transfer", "completions"}) {
    std::vector<std::string> words = {"--help"};
    if (!command.empty()) words.insert(words.begin(), command);
    const Outcome all = run(words);
    words.back() = "-h";
    const Outcome brief = run(words);
    EXPECT_EQ(all.exit_code, 0);
    EXPECT_EQ(brief.exit_code, 0);
    EXPECT_EQ(wide_lines(all.out), std::vector<std::string>()) << command;
    EXPECT_EQ(wide_lines(brief.out), std::vector<std::string>()) << command;
    EXPECT_LE(std::count(brief.out.begin(), brief.out.end(), '\n'), 40) << "a screen";
    EXPECT_NE(brief.out.find(command + " --help has all options"), std::string::npos);
    EXPECT_EQ(all.out.find("\n\n\n"), std::string::npos) << command;
    if (command.empty()) continue;
    std::istringstream text(all.out);
    for (std::string word; text >> word;) {
      if (!word.starts_with("--") || word.find_first_of("=,.;:") != std::string::npos) continue;
      std::string dashes;
      for (const char c : word) dashes += c == '-' ? "\\-" : std::string(1, c);
      EXPECT_NE(page.find(dashes), std::string::npos) << word << " is in the manual";
    }
  }
}

TEST(NearestSpelling, IsFoundUpToAThirdOfTheLetters) {
  const std::vector<std::string> known = {"unwrap", "flatten", "check", "pack", "transfer"};
  EXPECT_EQ(nearest_spelling("unwarp", known), "unwrap");
  EXPECT_EQ(nearest_spelling("chekc", known), "check");
  EXPECT_EQ(nearest_spelling("flaten", known), "flatten");
  EXPECT_EQ(nearest_spelling("pakc", known), "pack");
  EXPECT_EQ(nearest_spelling("transfers", known), "transfer");
  EXPECT_EQ(nearest_spelling("simplify", known), "");
  EXPECT_EQ(nearest_spelling("model.obj", known), "");
  EXPECT_EQ(nearest_spelling(std::string(100000, 'x'), known), "");
}

/// What the program says of arguments that it refuses.
std::string refusal(const std::vector<std::string>& arguments) {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, kExitUnusable);
  EXPECT_EQ(outcome.err_lines(), 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  return outcome.err;
}

TEST(Arguments, NameTheNearestSpelling) {
  EXPECT_EQ(refusal({"unwarp", "a.obj", "b.obj"}),
            "beltrami: there is no command 'unwarp': did you mean unwrap?\n");
  EXPECT_EQ(refusal({"unwrap", "a.obj", "b.obj", "--reslution", "64"}),
            "beltrami: there is no option --reslution of unwrap: did you mean --resolution?\n");
  EXPECT_EQ(
      refusal({"unwrap", "a.obj", "b.obj", "--target-enrgy=2.1"}),
      "beltrami: there is no option --target-enrgy of unwrap: did you mean --target-energy?\n");
  EXPECT_EQ(refusal({"transfer", "a.obj", "b.obj", "c.png", "d.png", "--kept", "1"}),
            "beltrami: there is no option --kept of transfer: it is one of pack\n");
  EXPECT_EQ(refusal({"check", "a.obj", "--no-such-thing"}),
            "beltrami: there is no option --no-such-thing of check: see beltrami check --help\n");
  EXPECT_EQ(refusal({"a.obj", "b.obj"}),
            "beltrami: there is no command 'a.obj': the commands are unwrap, flatten, check, pack, "
            "transfer, completions\n");
  EXPECT_EQ(refusal({"--vresion"}),
            "beltrami: there is no option --vresion before a command: did you mean --version?\n");
}

TEST(Arguments, SeamsAreNumbersAndNothingElse) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kTetrahedron), out = directory.path("out.obj");
  for (const std::string& seams : {std::string("0 1\n1 2 # and back\n"),
                                   std::string("[[0,1],[1,2]]"), std::string("(0, 1); (1, 2)")}) {
    EXPECT_EQ(run({"unwrap", in, out, "--seams", directory.file("s.txt", seams)}).exit_code, 0)
        << seams;
  }
  const std::string text = directory.file("s.txt", "0 1\nvertices 1 and 2\n");
  EXPECT_EQ(refusal({"unwrap", in, out, "--seams", text}),
            "beltrami: " + text + ": line 2: 'vertices' is no vertex: seams are pairs of vertex " +
                "numbers, counted from 0\n");
  for (const char* bad : {"0 -1", "0 1.5", "0 1x", "0x1 2", "99999999999999999999 1", "v 0 1"}) {
    const std::string error = refusal({"unwrap", in, out, "--seams", directory.file("s.txt", bad)});
    EXPECT_NE(error.find("is no vertex"), std::string::npos) << bad << error;
  }
}

TEST(Arguments, SetsOfUvsArePicturesArePngAndFormatsAreListed) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", kSquareWithUvs), out = directory.path("out.obj");
  for (const std::string command : {"unwrap", "pack"}) {
    EXPECT_NE(refusal({command, in, out, "--uv-set", "1"}).find("--uv-set 1"), std::string::npos);
    EXPECT_EQ(run({command, in, out, "--uv-set", "0"}).exit_code, 0);
    std::filesystem::remove(out);
  }
  for (const std::string picture : {"p.jpg", "p.JPEG", "p.webp", "p.obj"}) {
    const std::string path = directory.path(picture);
    for (const std::vector<std::string>& command : {std::vector<std::string>{"unwrap", in, out},
                                                    {"flatten", in, out},
                                                    {"pack", in, out},
                                                    {"check", in}}) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {"--picture", path});
      EXPECT_EQ(refusal(arguments),
                "beltrami: " + path + ": pictures are written as PNG: use the extension .png\n");
    }
    EXPECT_FALSE(std::filesystem::exists(path));
  }
  for (const std::string command : {"unwrap", "pack", "flatten"}) {
    const std::string fbx = directory.path("out.fbx");
    const std::string error = refusal({command, in, fbx});
    for (const std::string format : {".obj", ".ply", ".gltf", ".glb"}) {
      EXPECT_NE(error.find(format), std::string::npos) << error;
    }
    EXPECT_EQ(error.find(".stl"), std::string::npos) << error;
  }
}

TEST(Arguments, AMeshWithUvsIsNotWrittenOverUnlessSaid) {
  const TemporaryDirectory directory;
  const std::string a = directory.file("a.obj", kSquareWithUvs);
  const std::string b = directory.file("b.obj", kSquareWithUvs);
  EXPECT_NE(refusal({"pack", a, b}).find("--output"), std::string::npos);
  EXPECT_NE(refusal({"pack", a, a}).find("--output"), std::string::npos);
  EXPECT_EQ(directory.read("b.obj"), kSquareWithUvs);
  EXPECT_EQ(run({"pack", a, "--output", b}).exit_code, 0);
  EXPECT_NE(directory.read("b.obj"), kSquareWithUvs);
  EXPECT_EQ(run({"pack", a, "--output", a}).exit_code, 0) << "in place";
  // What has no UVs cannot be meant to be packed.
  EXPECT_EQ(run({"pack", a, directory.file("c.obj", kSquare)}).exit_code, 0);
}

TEST(Arguments, NamesFromFilesReachNoTerminalRaw) {
  const TemporaryDirectory directory;
  const std::string in =
      directory.file("in.obj", "\x1b]0;x\x07 1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Outcome outcome = run({"unwrap", in, directory.path("out.obj")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("statements ' ]0;x '"), std::string::npos) << outcome.err;
  EXPECT_EQ((outcome.err + outcome.out).find('\x1b'), std::string::npos);
  const Outcome missing = run({"check", directory.path("no\x1b[31m\nwhere.obj")});
  EXPECT_EQ(missing.exit_code, kExitUnusable);
  EXPECT_EQ(missing.err.find('\x1b'), std::string::npos);
  EXPECT_EQ(missing.err_lines(), 1);
}

TEST(ReportOnStandardOutput, IsAllThatIsPrintedThere) {
  const TemporaryDirectory directory;
  const std::string in = directory.file("in.obj", grid(4));
  const std::string out = directory.path("out.obj");
  for (const std::vector<std::string>& command : {std::vector<std::string>{"flatten", in, out},
                                                  {"unwrap", in, out},
                                                  {"pack", out, directory.path("packed.obj")},
                                                  {"check", out}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--report", "-", "--quiet"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto report = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(report["command"], command[0]);
    EXPECT_EQ(report["injective"]["result"], true);
    arguments.pop_back();
    EXPECT_TRUE(nlohmann::json::accept(run(arguments).out));
  }
}

TEST(ReportOnStandardOutput, TellsAFailure) {
  const TemporaryDirectory directory;
  const Outcome outcome = run({"check", directory.path("none.obj"), "--report", "-"});
  EXPECT_EQ(outcome.exit_code, kExitUnusable);
  EXPECT_EQ(outcome.err_lines(), 1);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["status"], "FILE_ERROR");
}

TEST(ManPage, HasEveryOptionOfEveryCommandAndOneTitle) {
  const Outcome page = run({"--man"});
  EXPECT_EQ(page.exit_code, 0);
  EXPECT_EQ(page.err, "");
  EXPECT_EQ(page.out.rfind(".TH BELTRAMI 1 ", 0), 0u);
  for (const char* name : {"UNWRAP", "FLATTEN", "CHECK", "PACK", "TRANSFER", "COMPLETIONS"}) {
    EXPECT_NE(page.out.find(std::string(".SH BELTRAMI ") + name + "\n"), std::string::npos);
  }
  for (const char* option : {"\\-\\-target\\-energy", "\\-\\-report", "\\-q, \\-\\-quiet"}) {
    EXPECT_NE(page.out.find(std::string("\\fB") + option + "\\fR"), std::string::npos) << option;
  }
  EXPECT_EQ(page.out, run({"--man"}).out);
}

TEST(ManPage, IsWellFormed) {
  if (std::system("command -v groff > /dev/null 2>&1") != 0) GTEST_SKIP() << "there is no groff";
  const TemporaryDirectory directory;
  const std::string page = directory.file("beltrami.1", run({"--man"}).out);
  const std::string said = directory.path("said");
  ASSERT_EQ(std::system(("groff -man -Tascii -ww -z '" + page + "' > '" + said + "' 2>&1").c_str()),
            0);
  EXPECT_EQ(std::filesystem::file_size(said), 0u);
}

/// What a shell says to a script, of which "$1" is the file of completions.
std::string answer_of(const std::string& shell, const std::string& script,
                      const std::string& completions) {
  const TemporaryDirectory directory;
  const std::string file = directory.file("completions", completions);
  const std::string command = shell + " -c '" + script + "' - " + file;
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  std::array<char, 256> part;
  while (pipe != nullptr && std::fgets(part.data(), part.size(), pipe) != nullptr) {
    text += part.data();
  }
  EXPECT_EQ(pipe != nullptr ? pclose(pipe) : -1, 0) << shell;
  return text;
}

TEST(Completions, AreOfEveryCommandAndOption) {
  for (const std::string& shell : {std::string("bash"), std::string("zsh"), std::string("fish")}) {
    const Outcome outcome = run({"completions", shell});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err, "");
    for (const char* word : {"unwrap", "flatten", "check", "pack", "transfer", "target-energy",
                             "within-tiles", "hard-surface", "quiet"}) {
      EXPECT_NE(outcome.out.find(word), std::string::npos) << shell << ": " << word;
    }
  }
  EXPECT_EQ(run({"completions", "tcsh"}).exit_code, kExitUnusable);
}

TEST(Completions, OfBashAreChoicesOfTheOptionBeforeAndNamesOfOptions) {
  const std::string bash = run({"completions", "bash"}).out;
  const auto completed = [&](const std::string& words, int at) {
    return answer_of("bash",
                     ". \"$1\"; COMP_WORDS=(beltrami " + words + "); COMP_CWORD=" +
                         std::to_string(at) + "; _beltrami; echo \"${COMPREPLY[*]}\"",
                     bash);
  };
  EXPECT_EQ(completed("un", 1), "unwrap\n");
  EXPECT_EQ(completed("--m", 1), "--man\n");
  EXPECT_EQ(completed("completions f", 2), "fish\n");
  EXPECT_EQ(completed("unwrap --effort \"\"", 3), "quick normal high\n");
  EXPECT_EQ(completed("unwrap --flat-", 2), "--flat-seams\n");
  EXPECT_EQ(completed("unwrap out.o", 2), "\n");  // a file, which bash itself completes
}

/// Whether a command is there; what it would be asked is skipped else.
bool has_command(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

TEST(Completions, OfFishAreCommandsChoicesAndNamesOfOptions) {
  if (!has_command("fish")) GTEST_SKIP() << "there is no fish here";
  const std::string fish = run({"completions", "fish"}).out;
  const auto completed = [&](const std::string& line) {
    std::istringstream lines(
        answer_of("env HOME=/nonexistent fish --no-config",
                  "source $argv[2]; complete -C \"beltrami " + line + "\" 2>/dev/null", fish));
    std::vector<std::string> words;
    for (std::string word; std::getline(lines, word);)
      words.push_back(word.substr(0, word.find('\t')));
    return words;
  };
  EXPECT_EQ(completed("fl"), std::vector<std::string>({"flatten"}));
  EXPECT_EQ(completed("--m"), std::vector<std::string>({"--man"}));
  EXPECT_EQ(completed("unwrap --effort "), std::vector<std::string>({"high", "normal", "quick"}));
  EXPECT_EQ(completed("unwrap --flat-"), std::vector<std::string>({"--flat-seams"}));
  EXPECT_EQ(completed("completions "), std::vector<std::string>({"bash", "fish", "zsh"}));
}

TEST(Completions, OfZshAreAFunctionOfFpathOrAreMadeKnownBySource) {
  if (!has_command("zsh")) GTEST_SKIP() << "there is no zsh here";
  const std::string zsh = run({"completions", "zsh"}).out;
  EXPECT_TRUE(zsh.starts_with("#compdef beltrami\n"));
  EXPECT_EQ(answer_of("zsh -f",
                      "autoload -Uz compinit; compinit -u -D; source \"$1\"; "
                      "print $_comps[beltrami]; whence -w _beltrami",
                      zsh),
            "_beltrami\n_beltrami: function\n");
  for (const char* part : {"'(-q --quiet)-q[", ":value:(quick normal high)'",
                           "'1:word:(bash zsh fish)'", "--man[Print the manual page]"}) {
    EXPECT_NE(zsh.find(part), std::string::npos) << part;
  }
}

}  // namespace
}  // namespace beltrami::cli
