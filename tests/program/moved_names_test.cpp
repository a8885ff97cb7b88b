// Names of other files, when a mesh is written to another folder.
#include "files/moved_names.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "files/inside_folder.h"
#include "files/mesh_file.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Moved : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(directory.path("in/sub"));
    fs::create_directories(directory.path("out"));
    for (const char* name : {"in/a.mtl", "in/two words.mtl", "in/sub/b.mtl", "other.mtl"}) {
      directory.file(name, "newmtl red\n");
    }
    mesh.path = directory.path("in/m.obj");
  }
  std::string moved(const std::string& line, const std::string& to = "out/m.obj") {
    return MovedNames(mesh, directory.path(to)).line(line);
  }

  TemporaryDirectory directory;
  MeshFile mesh;
};

TEST_F(Moved, LeadToTheSameFiles) {
  EXPECT_EQ(moved("mtllib a.mtl"), "mtllib ../in/a.mtl");
  EXPECT_EQ(moved("mtllib two words.mtl"), "mtllib ../in/two words.mtl");
  EXPECT_EQ(moved("mtllib a.mtl sub/b.mtl"), "mtllib ../in/a.mtl ../in/sub/b.mtl");
  EXPECT_EQ(moved("mtllib sub\\b.mtl"), "mtllib ../in/sub/b.mtl");
  EXPECT_EQ(moved("mtllib sub/b.mtl", "in/sub/m.obj"), "mtllib b.mtl");
  EXPECT_EQ(moved("comment TextureFile a.mtl"), "comment TextureFile ../in/a.mtl");
}

TEST_F(Moved, StayWhereTheyLeadOnOrLeadNowhere) {
  EXPECT_EQ(moved("mtllib a.mtl", "in/new.obj"), "mtllib a.mtl");
  EXPECT_EQ(moved("mtllib none.mtl"), "mtllib none.mtl");
  EXPECT_EQ(moved("mtllib"), "mtllib");
  EXPECT_EQ(moved("mtllibs a.mtl"), "mtllibs a.mtl");
  EXPECT_EQ(moved("usemtl a.mtl"), "usemtl a.mtl");
  EXPECT_EQ(moved("comment a.mtl"), "comment a.mtl");
}

TEST_F(Moved, AreNotFollowedOutOfTheFolderUnlessTheUserSaysSo) {
  EXPECT_EQ(moved("mtllib ../other.mtl"), "mtllib ../other.mtl");
  MovedNames names(mesh, directory.path("out/m.obj"));
  names.line("mtllib ../other.mtl");
  ASSERT_EQ(names.notes().size(), 1u);
  EXPECT_NE(names.notes()[0].find("--allow-outside"), std::string::npos);
  mesh.reach = Reach::kAnywhere;
  EXPECT_EQ(moved("mtllib ../other.mtl", "out/m.obj"), "mtllib ../other.mtl");
  EXPECT_EQ(moved("mtllib ../other.mtl", "m.obj"), "mtllib other.mtl");
}

TEST_F(Moved, StandInWhatIsWritten) {
  directory.file("in/m.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
  MeshFile mesh = read_mesh(directory.path("in/m.obj"), Content::kSurface);
  mesh.uvs.assign(6, 0);
  std::string text;
  write_mesh(mesh, directory.path("out/m.obj"), [&](std::string_view bytes) { text += bytes; });
  EXPECT_NE(text.find("\nmtllib ../in/a.mtl\n"), std::string::npos) << text;
  EXPECT_EQ(not_kept(mesh, directory.path("out/m.obj")), Words{});
}

}  // namespace
}  // namespace beltrami::cli
