#include "files/inside_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;

/// A folder with a model, what is beside it, and a secret outside.
class InsideFolder : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(directory.path("models/maps"));
    directory.file("secret.bin", "secret");
    directory.file("models/a.bin", "a");
    directory.file("models/two words.bin", "b");
    directory.file("models/maps/c.bin", "c");
    directory.file("models_too", "d");
  }
  std::string full(const std::string& name) const {
    return fs::canonical(directory.path(name)).string();
  }
  NamedFile uri(const std::string& name, Reach reach = Reach::kItsFolder) const {
    return follow_uri(directory.path("models/m.gltf"), name, reach);
  }
  NamedFile name(const std::string& name, Reach reach = Reach::kItsFolder) const {
    return follow_name(directory.path("models/m.obj"), name, reach);
  }

  TemporaryDirectory directory;
};

TEST_F(InsideFolder, LeadsToWhatIsBesideAndBelow) {
  EXPECT_EQ(uri("a.bin").path, full("models/a.bin"));
  EXPECT_EQ(uri("./maps/../a.bin").path, full("models/a.bin"));
  EXPECT_EQ(uri("two%20words.bin").path, full("models/two words.bin"));
  EXPECT_EQ(uri("two words.bin").path, full("models/two words.bin"));
  EXPECT_EQ(uri("maps%2Fc.bin").path, full("models/maps/c.bin"));
  EXPECT_EQ(name("maps\\c.bin").path, full("models/maps/c.bin"));
  EXPECT_EQ(uri("yet_to_come.bin").path, full("models") + "/yet_to_come.bin");
  EXPECT_TRUE(uri("a.bin").refusal.empty());
}

TEST_F(InsideFolder, RefusesWhatLeavesTheFolderHoweverItIsWritten) {
  const std::string secret = full("secret.bin");
  for (const std::string& out :
       {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
        std::string("..%2Fsecret.bin"), std::string("..%5csecret.bin"),
        std::string("..\\secret.bin"), std::string("maps/../../secret.bin"),
        std::string("none/../../secret.bin"), std::string("../models_too"), secret,
        std::string("\\\\server\\share\\secret.bin"), "%2F" + secret.substr(1)}) {
    const NamedFile found = uri(out);
    EXPECT_EQ(found.path, "") << out;
    EXPECT_NE(found.refusal.find("--allow-outside"), std::string::npos) << out << found.refusal;
  }
  EXPECT_EQ(uri("../secret.bin", Reach::kAnywhere).path, secret);
  EXPECT_EQ(uri(secret, Reach::kAnywhere).path, secret);
  EXPECT_EQ(name("..\\secret.bin").path, "");
}

TEST_F(InsideFolder, RefusesLinksThatLeaveTheFolder) {
  fs::create_symlink("../secret.bin", directory.path("models/link.bin"));
  fs::create_directory_symlink("..", directory.path("models/up"));
  fs::create_symlink("maps/c.bin", directory.path("models/down.bin"));
  fs::create_symlink("circle.bin", directory.path("models/circle.bin"));
  EXPECT_EQ(uri("link.bin").path, "");
  EXPECT_EQ(uri("up/secret.bin").path, "");
  EXPECT_EQ(uri("circle.bin").path, "");
  EXPECT_EQ(uri("down.bin").path, full("models/maps/c.bin"));
  EXPECT_EQ(uri("link.bin", Reach::kAnywhere).path, full("secret.bin"));
  // A model that is a link itself has its files beside the link.
  fs::create_symlink("models/a.bin", directory.path("m.gltf"));
  EXPECT_EQ(follow_uri(directory.path("m.gltf"), "secret.bin", Reach::kItsFolder).path,
            full("secret.bin"));
}

TEST_F(InsideFolder, RefusesWhatIsNoFileOfAFolderWhateverTheUserAllows) {
  for (const std::string& bad :
       {std::string(), std::string("file:///etc/passwd"), std::string("http://host/a.bin"),
        std::string("C:\\secret.bin"), std::string("maps"), std::string("a%00.bin")}) {
    EXPECT_EQ(uri(bad, Reach::kAnywhere).path, "") << bad;
    EXPECT_NE(uri(bad, Reach::kAnywhere).refusal, "") << bad;
  }
  EXPECT_EQ(name("c:a.bin", Reach::kAnywhere).path, "");
}

}  // namespace
}  // namespace beltrami::cli
