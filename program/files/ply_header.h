// The header of a PLY file: what its body holds, in which order and types.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/column.h"
#include "files/text_cursor.h"

namespace beltrami::cli {

enum class PlyEncoding { kText, kLittle, kBig };

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::kF32;
  std::optional<Scalar> count_type;  ///< of a list
};

struct PlyElement {
  std::string name;  ///< no other element has it
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;  ///< names differ

  /// The scalar property called `name`, or null.
  const PlyProperty* find(std::string_view name) const;
  /// The list property called so, or null.
  const PlyProperty* find_list(std::string_view name) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kText;
  std::vector<PlyElement> elements;
  std::vector<std::string> comments;  ///< whole lines: "comment by hand", "obj_info x"
  std::vector<std::string> unknown;   ///< keywords of lines that are passed over

  /// The element called `name`, or null.
  const PlyElement* find(std::string_view name) const;
};

/// Reads the header, keywords in any case, and leaves the cursor on the first byte after the line
/// of end_header. Throws Failure for what is not PLY, for names that are used twice, and for
/// thousands of them.
PlyHeader read_ply_header(TextCursor& cursor);

}  // namespace beltrami::cli
