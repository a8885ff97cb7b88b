// Files that appear whole or not at all.
#include "files/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <deque>
#include <thread>

#include "process/failure.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

TEST(AtomicFile, ReplacesOnCommitOnly) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.txt", "old");
  {
    AtomicFile file(path);
    file.write("new");
    EXPECT_EQ(directory.read("a.txt"), "old");
    EXPECT_EQ(directory.names().size(), 2u);
  }
  EXPECT_EQ(directory.read("a.txt"), "old");
  EXPECT_EQ(directory.names().size(), 1u);
  AtomicFile file(path);
  file.write("new");
  file.commit();
  EXPECT_EQ(directory.read("a.txt"), "new");
  EXPECT_EQ(directory.names().size(), 1u);
}

TEST(AtomicFile, FollowsLinksAndKeepsPermissions) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("real.txt", "old");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real.txt", directory.path("link.txt"));
  AtomicFile file(directory.path("link.txt"));
  file.write("new");
  file.commit();
  EXPECT_TRUE(fs::is_symlink(directory.path("link.txt")));
  EXPECT_EQ(directory.read("real.txt"), "new");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(AtomicFile, RefusesWhatCannotBeWritten) {
  const TemporaryDirectory directory;
  EXPECT_THROW(require_writable(directory.path("none/a.txt")), Failure);
  EXPECT_THROW(require_writable(directory.path("")), Failure) << "a directory";
  EXPECT_THROW(require_writable(""), Failure);
  EXPECT_NO_THROW(require_writable(directory.path("a.txt")));
  EXPECT_TRUE(directory.names().empty());
  const std::string long_name(250, 'x');
  EXPECT_NO_THROW(require_writable(directory.path(long_name)));
}

TEST(AtomicFile, LeavesDevicesInPlace) {
  if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  AtomicFile file("/dev/full");
  EXPECT_THROW(file.write("text"), Failure);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(AtomicFile, LeavesOtherNamesOfTheTargetWithTheOldFile) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.txt", "old");
  fs::create_hard_link(path, directory.path("b.txt"));
  AtomicFile file(path);
  file.write("new");
  file.commit();
  EXPECT_EQ(directory.read("a.txt"), "new");
  EXPECT_EQ(directory.read("b.txt"), "old");
}

TEST(AtomicFile, IsRemovedByWhatEndsTheProcessAtOnce) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.txt", "old");
  AtomicFile file(path);
  file.write("new");
  remove_leftovers();
  EXPECT_EQ(directory.names(), std::vector<std::string>{"a.txt"});
  EXPECT_THROW(file.commit(), Failure);
  EXPECT_EQ(directory.read("a.txt"), "old");
  AtomicFile next(path);
  next.write("new");
  next.commit();
  remove_leftovers();
  EXPECT_EQ(directory.read("a.txt"), "new") << "what has its name is no leftover";
}

TEST(AtomicFile, TellsThePipesReaderNothingBeforeTheWrite) {
  const TemporaryDirectory directory;
  const std::string path = directory.path("pipe");
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_NO_THROW(require_writable(path)) << "nobody reads it yet";
  std::string got;
  std::thread reader([&] { got = directory.read("pipe"); });
  require_writable(path);
  const std::string text(1 << 20, 'x');  // more than a pipe holds
  AtomicFile file(path);
  file.write(text);
  file.commit();
  reader.join();
  EXPECT_EQ(got, text);
  EXPECT_TRUE(fs::is_fifo(path));
}

TEST(AtomicFile, OfSeveralWritersHasTheWholeOfOne) {
  constexpr int kRounds = 200;
  const TemporaryDirectory directory;
  const std::string path = directory.file("a.txt", std::string(10000, '0'));
  const auto write = [&](char letter) {
    for (int i = 0; i < kRounds; ++i) {
      AtomicFile file(path);
      for (int part = 0; part < 10; ++part) file.write(std::string(1000, letter));
      file.commit();
    }
  };
  std::thread first(write, '1'), second(write, '2');
  for (int i = 0; i < kRounds; ++i) {
    const std::string seen = directory.read("a.txt");
    EXPECT_EQ(seen, std::string(10000, seen.empty() ? '?' : seen[0]));
  }
  first.join();
  second.join();
  EXPECT_EQ(directory.names().size(), 1u) << "a temporary is left";
}

TEST(Commit, ReplacesAllOrNone) {
  const TemporaryDirectory directory;
  directory.file("a.txt", "old");
  fs::create_directory(directory.path("folder"));
  const std::string last = directory.file("folder/c.txt", "old");
  const auto write = [&](std::deque<AtomicFile>& files) {
    for (const std::string& path : {directory.path("a.txt"), directory.path("b.txt"), last}) {
      files.emplace_back(path).write("new");
    }
  };
  {
    std::deque<AtomicFile> files;
    write(files);
    // What is in the way of the last one comes after all were opened.
    fs::remove(last);
    fs::create_directories(last + "/full");
    EXPECT_THROW(commit(files), Failure);
    EXPECT_EQ(directory.read("a.txt"), "old");
    EXPECT_FALSE(fs::exists(directory.path("b.txt")));
  }
  EXPECT_EQ(directory.names().size(), 2u) << "a temporary is left";
  fs::remove_all(last);
  std::deque<AtomicFile> files;
  write(files);
  commit(files);
  for (const char* name : {"a.txt", "b.txt", "folder/c.txt"}) {
    EXPECT_EQ(directory.read(name), "new") << name;
  }
  EXPECT_EQ(directory.names().size(), 3u) << "a temporary is left";
}

}  // namespace
}  // namespace beltrami::cli
