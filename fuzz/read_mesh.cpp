// A reader of OBJ, OFF, PLY, STL or MNI, whichever the build names.
#include <string_view>
#include <utility>

#include "file_promises.h"
#include "files/mesh_file.h"
#include "process/failure.h"
#include "target.h"

namespace beltrami::fuzz {

void run_one(std::string_view bytes) {
  using cli::Content;
  for (const Content content : {Content::kSurface, Content::kUvs, Content::kAll}) {
    cli::MeshFile file;
    try {
      file = cli::BELTRAMI_FUZZ_READER(bytes, "a", content);
    } catch (const cli::Failure& failure) {
      promise(*failure.what() != '\0', "a refusal has a sentence");
      continue;
    }
    judge_file(std::move(file));
  }
}

}  // namespace beltrami::fuzz
