// OBJ and PLY with one UV per vertex. Text comes from std::to_chars in its shortest form: at most
// 17 digits, and the same bits when read back by a reader that rounds correctly.
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "mesh_file.h"

namespace beltrami::cli {
namespace {

/// Collects small pieces into blocks for the sink.
class Writer {
 public:
  explicit Writer(const Sink& sink) : sink_(sink) { block_.reserve(kBlock + 256); }

  void text(std::string_view text) {
    block_.append(text);
    if (block_.size() >= kBlock) flush();
  }

  template <class Number>
  void number(Number value) {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  /// Little endian, on any machine.
  template <class Number>
  void binary(Number value) {
    std::array<char, sizeof value> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) {
      for (std::size_t i = 0; i < sizeof value / 2; ++i) {
        std::swap(bytes[i], bytes[sizeof value - 1 - i]);
      }
    }
    text({bytes.data(), bytes.size()});
  }

  void flush() {
    sink_(block_);
    block_.clear();
  }

 private:
  static constexpr std::size_t kBlock = 1 << 20;
  const Sink& sink_;
  std::string block_;
};

void write_obj(const MeshFile& mesh, Writer& out) {
  out.text("# UVs by beltrami: one vt per vertex, in vertex order\n");
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    out.text("v");
    for (std::size_t k = 0; k < 3; ++k) {
      out.text(" ");
      out.number(mesh.positions[i + k]);
    }
    out.text("\n");
  }
  for (std::size_t i = 0; i < mesh.uvs.size(); i += 2) {
    out.text("vt ");
    out.number(mesh.uvs[i]);
    out.text(" ");
    out.number(mesh.uvs[i + 1]);
    out.text("\n");
  }
  for (std::size_t i = 0; i < mesh.faces.size(); i += 3) {
    out.text("f");
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t number = std::uint64_t{mesh.faces[i + k]} + 1;
      out.text(" ");
      out.number(number);
      out.text("/");
      out.number(number);
    }
    out.text("\n");
  }
}

/// `s` and `t` are the names that Blender and most other readers take for UVs of vertices.
void write_ply(const MeshFile& mesh, Writer& out) {
  out.text("ply\nformat binary_little_endian 1.0\ncomment UVs by beltrami\nelement vertex ");
  out.number(mesh.vertex_count());
  out.text("\nproperty double x\nproperty double y\nproperty double z\nproperty ");
  const std::string_view type = mesh.single_uvs ? "float" : "double";
  out.text(type);
  out.text(" s\nproperty ");
  out.text(type);
  out.text(" t\nelement face ");
  out.number(mesh.face_count());
  out.text("\nproperty list uchar int vertex_indices\nend_header\n");
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out.binary(mesh.positions[3 * i + k]);
    for (std::size_t k = 0; k < 2; ++k) {
      const double w = mesh.uvs[2 * i + k];
      if (mesh.single_uvs) {
        out.binary(static_cast<float>(w));
      } else {
        out.binary(w);
      }
    }
  }
  for (std::size_t i = 0; i < mesh.face_count(); ++i) {
    out.binary(std::uint8_t{3});
    for (std::size_t k = 0; k < 3; ++k) {
      out.binary(static_cast<std::int32_t>(mesh.faces[3 * i + k]));
    }
  }
}

}  // namespace

void write_mesh(const MeshFile& mesh, const std::string& path, const Sink& sink) {
  Writer out(sink);
  if (format_of(path) == MeshFormat::kPly) {
    write_ply(mesh, out);
  } else {
    write_obj(mesh, out);
  }
  out.flush();
}

}  // namespace beltrami::cli
