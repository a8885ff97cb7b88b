#include "cut/known_maps.h"

#include <cstdint>

namespace beltrami {
namespace {

/// FNV-1a, a number at a time.
std::size_t hash_of(const Chart& chart) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](Index number) {
    hash = (hash ^ static_cast<std::uint64_t>(number)) * 0x100000001b3;
  };
  for (const Index f : chart.input_face) add(f);
  for (const Triangle& face : chart.mesh.faces) {
    for (const Index v : face) add(v);
  }
  return static_cast<std::size_t>(hash);
}

}  // namespace

std::optional<std::vector<Vec2>> KnownMaps::find(const Chart& chart,
                                                 const MapSetting& setting) const {
  const std::size_t hash = hash_of(chart);
  const std::lock_guard lock(mutex_);
  const auto [begin, end] = known_.equal_range(hash);
  for (auto i = begin; i != end; ++i) {
    const Known& known = i->second;
    if (known.setting == setting && known.input_face == chart.input_face &&
        known.faces == chart.mesh.faces) {
      return known.uvs;
    }
  }
  return std::nullopt;
}

void KnownMaps::keep(const Chart& chart, const MapSetting& setting, const std::vector<Vec2>& uvs) {
  const std::size_t hash = hash_of(chart);
  const std::lock_guard lock(mutex_);
  known_.emplace(hash, Known{chart.input_face, chart.mesh.faces, setting, uvs});
}

}  // namespace beltrami
