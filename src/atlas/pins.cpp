#include "atlas/pins.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <utility>

#include "base/interrupt.h"

namespace beltrami {
namespace {

/// Finds the vertex of the charts that a corner of the input has.
class Locator {
 public:
  Locator(const std::vector<Pin>& pins, const std::vector<Triangle>& faces,
          const Admitted& admitted, const std::vector<AtlasChart>& charts)
      : faces_(faces), admitted_(admitted), in_surface_(faces.size(), false) {
    for (const Index f : admitted.input_face) in_surface_[f] = true;
    for (const auto& [copy, first] : admitted.copies) first_of_[copy] = first;
    for (const Pin& pin : pins) {
      for (const auto& [face, corner] : corners_of(pin)) place_of_[{face, corner}];
    }
    for (Index c = 0; c < size_of(charts); ++c) locate(c, charts[c]);
  }

  /// The chart and the vertex; none where the face was set aside.
  std::pair<Index, Index> at(const Pin& pin) const {
    for (const auto& corner : corners_of(pin)) return place_of_.at(corner);
    return {kNone, kNone};
  }

 private:
  using Corner = std::pair<Index, int>;

  /// The corner whose UV vertex it is: of a copy that shares, that of the first of its kind. None
  /// where the face was set aside.
  std::vector<Corner> corners_of(const Pin& pin) const {
    if (in_surface_[pin.face]) return {{pin.face, pin.corner}};
    const auto copy = first_of_.find(pin.face);
    if (copy == first_of_.end()) return {};
    const Index vertex = admitted_.welded(faces_[pin.face][pin.corner]);
    for (int k = 0; k < 3; ++k) {
      if (admitted_.welded(faces_[copy->second][k]) == vertex) return {{copy->second, k}};
    }
    return {};
  }

  void locate(Index c, const AtlasChart& part) {
    PollSometimes poll;
    for (Index f = 0; f < part.real_faces; ++f) {
      poll();
      const Index input = admitted_.input_face[part.chart.input_face[f]];
      for (auto at = place_of_.lower_bound({input, 0});
           at != place_of_.end() && at->first.first == input; ++at) {
        for (int k = 0; k < 3; ++k) {
          if (part.input_corner(admitted_, f, k) != at->first.second) continue;
          at->second = {c, part.chart.mesh.faces[f][k]};
        }
      }
    }
  }

  const std::vector<Triangle>& faces_;
  const Admitted& admitted_;
  std::vector<bool> in_surface_;  // per face of the input
  std::map<Index, Index> first_of_;
  std::map<Corner, std::pair<Index, Index>> place_of_;
};

/// Exactly, or not at all.
Vec2 scaled(const Pin& pin, int exponent) {
  Vec2 place;
  for (int k = 0; k < 2; ++k) {
    place[k] = std::ldexp(pin.uv[k], exponent);
    if (std::isfinite(place[k]) && std::ldexp(place[k], -exponent) == pin.uv[k]) continue;
    throw unmet(pin, "is beyond the range of numbers beside the size of the surface: scale both");
  }
  return place;
}

/// The shortest text that reads back to the value, whatever the host's locale.
std::string written(double x) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

std::string written(const Vec2& uv) {
  return "(" + written(uv.x()) + ", " + written(uv.y()) + ")";
}

}  // namespace

std::string name_of(const Pin& pin) {
  return "pin " + std::to_string(pin.number) + " (corner " + std::to_string(pin.of_caller) + ")";
}

Error unmet(const Pin& pin, const std::string& why) {
  return {Fault::kPins, name_of(pin) + " " + why,
          Element::corner(static_cast<std::uint64_t>(pin.of_caller))};
}

AssignedPins assign_pins(const std::vector<Pin>& pins, const std::vector<Triangle>& faces,
                         const Admitted& admitted, const std::vector<AtlasChart>& charts,
                         int exponent) {
  AssignedPins assigned;
  assigned.of_chart.resize(charts.size());
  if (pins.empty()) return assigned;
  const Locator locator(pins, faces, admitted, charts);
  std::map<std::pair<Index, Index>, Index> first_at;  // the first pin of a vertex or a corner
  for (Index i = 0; i < size_of(pins); ++i) {
    const Pin& pin = pins[i];
    const Vec2 place = scaled(pin, exponent);
    const auto [chart, vertex] = locator.at(pin);
    const bool aside = chart == kNone;
    const auto key = aside ? std::pair(-1 - pin.face, Index{pin.corner}) : std::pair(chart, vertex);
    const auto [at, is_new] = first_at.emplace(key, i);
    if (is_new) {
      if (aside) {
        assigned.aside.push_back({pin.face, pin.corner, place});
      } else {
        assigned.of_chart[chart].push_back({vertex, place, i, pin.kind, pin.along});
      }
      continue;
    }
    const Pin& first = pins[at->second];
    if (first.uv == pin.uv && first.kind == pin.kind && first.along == pin.along) continue;
    if (first.kind != pin.kind || first.kind != PinKind::kPoint) {
      throw unmet(pin, "is to lie elsewhere than " + name_of(first) +
                           ", which has the same UV vertex: give both the same, or one as a point");
    }
    throw unmet(pin, "is to lie at " + written(pin.uv) + ", and " + name_of(first) +
                         ", which has the same UV vertex, at " + written(first.uv) +
                         ": give both one place, or cut a seam between them");
  }
  return assigned;
}

}  // namespace beltrami
