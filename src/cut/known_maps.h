// Maps of charts that a search has made from nothing: it comes back to most of its seams.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "mesh/chart.h"
#include "multilevel/options.h"

namespace beltrami {

/// What a map from nothing depends on, beside the chart.
struct MapSetting {
  Injectivity injectivity = Injectivity::kLocal;
  double tolerance = 0;

  bool operator==(const MapSetting&) const = default;
};

/// Of charts of one surface, from any thread. What is found is what would be made anew.
class KnownMaps {
 public:
  /// One UV per vertex of the chart; nothing where the same chart was not kept.
  std::optional<std::vector<Vec2>> find(const Chart& chart, const MapSetting& setting) const;

  void keep(const Chart& chart, const MapSetting& setting, const std::vector<Vec2>& uvs);

 private:
  struct Known {
    std::vector<Index> input_face;
    std::vector<Triangle> faces;
    MapSetting setting;
    std::vector<Vec2> uvs;
  };

  mutable std::mutex mutex_;
  std::unordered_multimap<std::size_t, Known> known_;  ///< by a hash of the chart
};

}  // namespace beltrami
