#include "pack/pack.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/types.h"
#include "pack/groups.h"
#include "pack/outline.h"
#include "pack/problem.h"
#include "pack/search.h"

namespace beltrami {
namespace {

[[noreturn]] void refuse(const std::string& sentence) {
  throw Error(Fault::kInvalidArgument, sentence);
}

void check(const PackOptions& options) {
  if (options.resolution < 8 || options.resolution > 32768) {
    refuse("the resolution of a page is to be in [8, 32768] texels");
  }
  if (!(options.margin >= 0) || options.margin > options.resolution / 4.0) {
    refuse("the margin is to be in [0, a quarter of the resolution]");
  }
  if (!(options.texels_per_unit >= 0) || !std::isfinite(options.texels_per_unit)) {
    refuse("the texels per unit are to be a number >= 0");
  }
  if (options.turns != 1 && options.turns != 4 && (options.turns < 16 || options.turns > 360)) {
    refuse("the turns are to be 1, 4, or in [16, 360]");
  }
  if (options.block < 1 || options.block > options.resolution / 8) {
    refuse("the block is to be in [1, an eighth of the resolution]");
  }
  if (options.max_pages < 1) refuse("there is to be one page at least");
  if (!(options.effort >= 0) || !std::isfinite(options.effort)) {
    refuse("the effort is to be a number >= 0");
  }
}

void check(std::span<const PackChart> charts, const PackOptions& options) {
  for (std::size_t c = 0; c < charts.size(); ++c) {
    if (!(charts[c].scale > 0) || !std::isfinite(charts[c].scale)) {
      refuse("the scale of chart " + std::to_string(c) + " is to be a number > 0");
    }
    if (charts[c].kept && !(options.texels_per_unit > 0)) {
      refuse("chart " + std::to_string(c) +
             " keeps its place: give the texels per unit at which it was placed");
    }
  }
}

Packing pack(std::span<const PackChart> charts, std::vector<Outline> outlines,
             const PackOptions& options, const Work& work) {
  const Problem problem(charts, std::move(outlines), options, work);
  Index longest = 0;
  for (Index c = 1; c < problem.size(); ++c) {
    if (problem.length(c) > problem.length(longest)) longest = c;
  }
  // Points alone fit at any density.
  const double given = problem.length(longest) > 0 ? options.texels_per_unit : 1;
  Packed packed = given > 0 ? pack_at_density(problem, given) : pack_at_largest(problem);
  return problem.packing(std::move(packed.placements), packed.texels_per_unit);
}

/// Charts of one group.
Packing pack_group(std::span<const PackChart> charts, const PackOptions& options,
                   const Work& work) {
  std::vector<Outline> outlines(charts.size());
  parallel_for(work, size_of(outlines), 16, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) outlines[c] = outline_of(charts[c]);
  });
  return pack(charts, std::move(outlines), options, work);
}

}  // namespace

Packing pack_charts(std::span<const PackChart> charts, const PackOptions& options,
                    const Work& work) {
  check(options);
  check(charts, options);
  if (charts.empty()) return {};
  if (!has_groups(charts)) return pack_group(charts, options, work);
  return pack_groups(charts, options,
                     [&](const std::vector<PackChart>& group, const PackOptions& own) {
                       return pack_group(group, own, work.aside());
                     });
}

Packing pack_outlines(std::vector<Outline> outlines, const PackOptions& options, const Work& work) {
  check(options);
  if (outlines.empty()) return {};
  const std::vector<PackChart> charts(outlines.size());
  return pack(charts, std::move(outlines), options, work);
}

}  // namespace beltrami
