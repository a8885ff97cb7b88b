// Whatever a reader takes is unwrapped: the first byte says which reader.
#include <string_view>

#include "file_promises.h"
#include "files/mesh_file.h"
#include "process/failure.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

cli::MeshFile read(char format, std::string_view bytes) {
  switch (static_cast<unsigned char>(format) % 6) {
    case 0:
      return cli::read_obj(bytes, "a", cli::Content::kSurface);
    case 1:
      return cli::read_off(bytes, "a", cli::Content::kSurface);
    case 2:
      return cli::read_ply(bytes, "a", cli::Content::kSurface);
    case 3:
      return cli::read_stl(bytes, "a", cli::Content::kSurface);
    case 4:
      return cli::read_mni(bytes, "a", cli::Content::kSurface);
    default:
      return cli::read_gltf(bytes, "a", cli::Content::kSurface);
  }
}

}  // namespace

void run_one(std::string_view bytes) {
  constexpr int kPolls = 400;
  constexpr std::uint64_t kMostFaces = 24;
  if (bytes.empty()) return;
  try {
    unwrap_file(read(bytes[0], bytes.substr(1)), kPolls, kMostFaces);
  } catch (const cli::Failure&) {
    // Refused: the targets of the readers judge that.
  }
}

}  // namespace beltrami::fuzz
