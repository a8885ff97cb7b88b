// Pins that no map can meet, whatever it does elsewhere.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atlas/open.h"
#include "atlas/pins.h"
#include "base/types.h"

namespace beltrami {

struct PinConflict {
  Index pin;        ///< its place in the list of pins: the last one that takes part
  std::string why;  ///< the end of a sentence that begins with its name
};

/// The conflict among the pins of a chart that ends with the earliest one; nothing where none is
/// proven. Exact: two vertices at one place, one of them in the inside or beside the other; a face
/// whose three corners do not go counter-clockwise; boundary edges whose insides cross; a boundary
/// that is a simple polygon and runs clockwise.
std::optional<PinConflict> find_conflict(const AtlasChart& part, const std::vector<ChartPin>& pins,
                                         const std::vector<Pin>& all);

}  // namespace beltrami
