#include "pack/groups.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "base/error.h"

namespace beltrami {
namespace {

/// From a density at which not all groups fit to the next. The packer fills a page to within about
/// as much.
constexpr double kStepDown = 0.99;
constexpr int kMostSteps = 30;
/// Tiles that UDIM numbers by four digits, of a hundred rows.
constexpr int kMostTiles = 1000;

struct Group {
  std::vector<std::size_t> members;  // of all charts
  std::vector<PackChart> charts;
  Packing packing;
};

std::vector<Group> groups_of(std::span<const PackChart> charts) {
  std::map<std::uint64_t, Group> by_number;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    Group& group = by_number[charts[c].group];
    group.members.push_back(c);
    group.charts.push_back(charts[c]);
  }
  std::vector<Group> groups;
  for (auto& [number, group] : by_number) groups.push_back(std::move(group));
  return groups;
}

/// Each by itself: an error counts charts within their group.
void pack_each(const PackOptions& options, const PackGroup& pack, std::vector<Group>& groups) {
  for (Group& group : groups) {
    try {
      group.packing = pack(group.charts, options);
    } catch (const Error& error) {
      throw Error(error.fault(), std::string("of the charts of one label, ") + error.what(),
                  error.element());
    }
  }
}

/// Packs all groups at one density, but for those that are packed at it. Whether they fit.
bool pack_at(double density, PackOptions options, const PackGroup& pack,
             std::vector<Group>& groups) {
  options.texels_per_unit = density;
  for (Group& group : groups) {
    if (group.packing.texels_per_unit == density) continue;
    try {
      group.packing = pack(group.charts, options);
    } catch (const Error& error) {
      if (error.fault() != Fault::kInvalidArgument) throw;
      return false;
    }
  }
  return true;
}

/// So many pages have numbers.
void require_numbers(std::int64_t pages, std::size_t groups) {
  if (pages <= kMostTiles) return;
  throw Error(Fault::kInvalidArgument,
              "there are more than 1000 pages, of " + std::to_string(groups) +
                  " labels that share none: take labels of which there are fewer");
}

/// The pages of all groups one behind another.
Packing joined(const std::vector<Group>& groups, std::size_t charts) {
  Packing all;
  all.placements.resize(charts);
  all.texels_per_unit = groups.front().packing.texels_per_unit;
  for (const Group& group : groups) {
    for (std::size_t i = 0; i < group.members.size(); ++i) {
      Placement& placement = all.placements[group.members[i]];
      placement = group.packing.placements[i];
      placement.page += all.pages;
    }
    all.pages += group.packing.pages;
    all.utilisation += group.packing.utilisation * group.packing.pages;
    const std::vector<double>& shares = group.packing.page_utilisation;
    all.page_utilisation.insert(all.page_utilisation.end(), shares.begin(), shares.end());
  }
  require_numbers(all.pages, groups.size());
  all.utilisation /= all.pages;
  return all;
}

}  // namespace

bool has_groups(std::span<const PackChart> charts) {
  return std::any_of(charts.begin(), charts.end(),
                     [&](const PackChart& chart) { return chart.group != charts.front().group; });
}

Packing pack_groups(std::span<const PackChart> charts, const PackOptions& options,
                    const PackGroup& pack) {
  std::vector<Group> groups = groups_of(charts);
  require_numbers(static_cast<std::int64_t>(groups.size()), groups.size());
  pack_each(options, pack, groups);
  if (options.texels_per_unit > 0) return joined(groups, charts.size());
  double density = groups.front().packing.texels_per_unit;
  for (const Group& group : groups) density = std::min(density, group.packing.texels_per_unit);
  for (int step = 0; !pack_at(density, options, pack, groups); ++step) {
    if (step == kMostSteps) {
      throw Error(Fault::kInvalidArgument,
                  "no density was found at which the charts of all labels fit: raise the "
                  "resolution or the number of pages");
    }
    density *= kStepDown;
  }
  return joined(groups, charts.size());
}

}  // namespace beltrami
