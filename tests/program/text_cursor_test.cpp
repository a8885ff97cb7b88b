#include "files/text_cursor.h"

#include <gtest/gtest.h>

#include <string>

#include "files/mesh_file.h"
#include "process/failure.h"

namespace beltrami::cli {
namespace {

/// What reading this OBJ file says; it must say something, and end.
std::string refusal(const std::string& text) {
  try {
    read_obj(text, "a.obj", Content::kSurface);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "read";
}

TEST(TextCursor, ACommentEndsWithItsLineWhateverItsLastCharacterIs) {
  const std::string path = "a.obj";
  const std::string text = "v 1 # C:\\models\\\nv 2 # x \\\r\nusemtl a#b \\\nc\nv 3";
  TextCursor cursor(text, path, true);
  std::string firsts;
  for (; !cursor.at_end(); cursor.skip_line()) firsts += std::string(cursor.word()) + ",";
  EXPECT_EQ(firsts, "v,v,usemtl,v,") << "within a word # is no comment";
}

TEST(ReadObj, EndsAtCommentsThatEndInABackslash) {
  EXPECT_EQ(refusal("v 0 0 0 # c \\\nf 1 2 3\n"),
            "a.obj: line 2: face 0 (counted from 0) names vertex number 2, which the file does not "
            "have");
  EXPECT_EQ(refusal("v 0 0 0\nv 1 0 0\nv 0 1 0 # c \\\nf 1 2 3\nf 1 2 9\n"),
            "a.obj: line 5: face 1 (counted from 0) names vertex number 9, which the file does not "
            "have");
}

/// Every construct, and every way to end or continue it, before a face that names nothing: the
/// reader goes through the file a second time to find its line.
TEST(ReadObj, EndsWhateverIsContinued) {
  for (const std::string line :
       {"v 0 0 0", "v 0 0 0 1 1 1", "vt 0 0", "vn 0 0 1", "vn x", "f 1 1 1", "f 1", "l 1", "l x",
        "p", "g a", "usemtl", "mtllib a#b", "call x", "#", "", "f 1/", "o"}) {
    for (const std::string end :
         {"\\\n", " \\\n", " # \\\n", " #\\\r\n", "\\\r\n", " \\", "\\\\\n", "#\\\n", "\r\\\n"}) {
      const std::string text = "v 0 0 0\n" + line + end;
      EXPECT_NE(refusal(text + "\nf 1 2 99\n" + line + end), "read") << text;
      refusal(text);
    }
  }
}

TEST(OneLine, LeavesNothingThatATerminalObeys) {
  EXPECT_EQ(one_line("a\x1b[31mb\r\n\tc\x7f"), "a [31mb   c ");
  EXPECT_EQ(one_line("a\xC2\x9B"
                     "31mb"),
            "a 31mb")
      << "a control character of Latin-1";
  EXPECT_EQ(one_line("\xE2\x80\xAE"
                     "gpj.exe\xE2\x81\xA6"),
            " gpj.exe ")
      << "it turns the direction";
  EXPECT_EQ(one_line("\x9B"
                     "31m\xE9\xFF"),
            "?31m??")
      << "no UTF-8";
  EXPECT_EQ(one_line("\xE2\x82"), "??") << "cut short";
  EXPECT_EQ(one_line("na\xC3\xAFve \xF0\x9F\x98\x80"), "na\xC3\xAFve \xF0\x9F\x98\x80");
}

}  // namespace
}  // namespace beltrami::cli
