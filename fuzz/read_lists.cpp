// Seams, pins, paint and straight borders beside a mesh: the first byte says which.
#include <sys/mman.h>
#include <unistd.h>

#include <beltrami/beltrami.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "files/given_cuts.h"
#include "files/mesh_file.h"
#include "files/paint.h"
#include "files/pins.h"
#include "files/straight.h"
#include "process/failure.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

/// A file without a place on a disk.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : descriptor_(memfd_create("list", 0)) {
    promise(descriptor_ >= 0, "there is room for a file in memory");
    while (!bytes.empty()) {
      const ssize_t written = write(descriptor_, bytes.data(), bytes.size());
      promise(written > 0, "there is room for a file in memory");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

void judge_pins(const cli::Pins& pins, const cli::MeshFile& file) {
  promise(pins.uvs.size() == 2 * pins.corners.size(), "every pin has a UV");
  promise(pins.lines.size() == pins.corners.size(), "every pin has a line");
  promise(pins.kinds.size() == pins.corners.size(), "every pin has a kind");
  promise(pins.directions.size() == 2 * pins.corners.size(), "every pin has a direction");
  for (const std::uint64_t corner : pins.corners) {
    promise(corner < file.polygons.corners().size(), "every pin is on a corner");
  }
  for (const char* word : {"pin 0", "pin 99999999999999999999", "pin"}) {
    cli::with_lines(word, "pin", pins.lines);
  }
}

void judge_paint(const cli::Paint& paint, const cli::MeshFile& file) {
  promise(paint.of_vertices.empty() || paint.of_vertices.size() == file.vertex_count(),
          "every vertex has a factor");
  promise(paint.edges.size() == 2 * paint.of_edges.size(), "every edge has a factor");
  for (const std::uint64_t v : paint.edges) promise(v < file.vertex_count(), "ends are vertices");
  for (const double x : paint.of_vertices) promise(std::isfinite(x) && x >= 0, "factors count");
  for (const double x : paint.of_edges) promise(std::isfinite(x) && x >= 0, "factors count");
}

void judge_straight(const cli::Straight& straight, const cli::MeshFile& file) {
  promise(straight.edges.size() == 2 * straight.kinds.size(), "every edge has a kind");
  promise(straight.edge_lines.size() == straight.kinds.size(), "every edge has a line");
  promise(straight.rectangle_corners.size() == 4 * straight.rectangles.size(),
          "every rectangle has corners, or none");
  promise(straight.rectangle_lines.size() == straight.rectangles.size(),
          "every rectangle has a line");
  for (const std::uint64_t v : straight.edges)
    promise(v < file.vertex_count(), "ends are vertices");
  for (const std::uint64_t f : straight.rectangles) {
    promise(f < file.polygons.size(), "a rectangle is that of a face");
  }
  for (const std::uint64_t v : straight.rectangle_corners) {
    promise(v < file.vertex_count() || v == BELTRAMI_NO_ELEMENT, "corners are vertices");
  }
}

}  // namespace

void run_one(std::string_view bytes) {
  static const cli::MeshFile mesh =
      cli::read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\nf 1 3 4\n", "a",
                    cli::Content::kSurface);
  if (bytes.empty()) return;
  const MemoryFile list(bytes.substr(1));
  try {
    switch (static_cast<unsigned char>(bytes[0]) % 4) {
      case 0:
        for (const std::uint32_t v : cli::read_seams(list.path(), mesh)) {
          promise(v < mesh.vertex_count(), "ends of seams are vertices");
        }
        break;
      case 1:
        judge_pins(cli::read_pins(list.path(), mesh), mesh);
        break;
      case 2:
        judge_straight(cli::read_straight(list.path(), mesh), mesh);
        break;
      default:
        judge_paint(cli::read_paint(list.path(), mesh), mesh);
    }
  } catch (const cli::Failure& failure) {
    promise(*failure.what() != '\0', "a refusal has a sentence");
  }
}

}  // namespace beltrami::fuzz
