#include "atlas/open_and_map.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "atlas/aim.h"
#include "atlas/congruent.h"
#include "atlas/halves.h"
#include "atlas/map_piece.h"
#include "atlas/measure.h"
#include "atlas/open.h"
#include "atlas/rescue.h"
#include "atlas/seams.h"
#include "base/parallel.h"
#include "base/resources.h"
#include "base/types.h"
#include "cut/given.h"
#include "cut/seam_target.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

constexpr double kReady = 0.03;  // where making ready ends in the progress

/// Large pieces one after the other on all threads, the rest side by side; `order`: their numbers.
/// `run(piece, work)`.
template <class Run>
void for_each_piece(const std::vector<SurfacePiece>& pieces, std::vector<Index> order,
                    const Work& work, const Run& run) {
  const auto faces = [&](Index p) -> std::int64_t { return pieces[p].surface.face_count(); };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return faces(a) > faces(b); });
  std::int64_t all = 0, done = 0;
  for (const Index p : order) all += faces(p);
  const auto share = [&](std::int64_t of) {
    return static_cast<double>(of) / static_cast<double>(all);
  };
  std::int64_t large = 0;
  // Others would wait for a piece of more than a thread's share. One thread takes all in turn.
  for (; large < size_of(order); ++large) {
    const Index p = order[large];
    if (work.threads() > 1 && faces(p) * work.threads() < all - done) break;
    run(p, work.part(share(done), share(done + faces(p))));
    done += faces(p);
  }
  std::atomic<std::int64_t> mapped{done};
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(work, size_of(order) - large, 1, [&](std::int64_t i, std::int64_t) {
    const Index p = order[large + i];
    run(p, work.aside());
    mapped += faces(p);
    if (std::this_thread::get_id() == caller) work.report(share(mapped));
  });
}

/// The stages of pieces that ran side by side, one of each name, in all the time that they took.
void add_up(const std::vector<std::vector<StageStatistics>>& of_pieces, double seconds,
            double cpu_seconds, std::vector<StageStatistics>& stages) {
  std::vector<StageStatistics> sums = {{"cut"}, {"flatten"}};
  double all = 0;
  for (const auto& own : of_pieces) {
    for (const StageStatistics& stage : own) {
      sums[std::string_view(stage.name) == "cut" ? 0 : 1].seconds += stage.seconds;
      all += stage.seconds;
    }
  }
  for (StageStatistics& sum : sums) {
    const double share = all > 0 ? sum.seconds / all : 0;
    sum.seconds = share * seconds;
    sum.cpu_seconds = share * cpu_seconds;
    stages.push_back(sum);
  }
}

/// Stacks the faces of a piece on those of one that has maps; whether it lies on that.
bool stack(const SurfacePiece& piece, const SurfacePiece& on, bool mirrored,
           const Admitted& admitted, MappedSurface& all) {
  const std::optional<Laid> laid = laid_onto(on, piece, mirrored);
  if (!laid) return false;
  for (Index f = 0; f < on.real_faces; ++f) {
    const Index own = piece.face[laid->onto[3 * f] / 3];
    StackedFace face{.face = admitted.input_face[own],
                     .on = admitted.input_face[on.face[f]],
                     .corner = {},
                     .runs_against = laid->reflected !=
                                     (admitted.reversed[own] != admitted.reversed[on.face[f]])};
    for (int k = 0; k < 3; ++k) {
      const Index h = laid->onto[3 * f + k], from = laid->reflected ? Surface::next(h) : h;
      face.corner[admitted.input_corner(own, from % 3)] = admitted.input_corner(on.face[f], k);
    }
    all.stacked.push_back(face);
  }
  ++all.stacked_parts;
  return true;
}

/// The charts of a piece, in the unit of the whole.
void collect(const SurfacePiece& piece, const std::optional<SeamTarget>& target, Mapped mapped,
             const Admitted& admitted, MappedSurface& all) {
  const AtlasEnergy& energy = mapped.energy;
  if (target && (energy.symmetric_dirichlet > target->energy + kEnergyTolerance ||
                 exceeds(energy.p99, target->p99))) {
    Index first = first_input_face(mapped.opened.charts.front(), admitted);
    for (const AtlasChart& chart : mapped.opened.charts) {
      first = std::min(first, first_input_face(chart, admitted));
    }
    all.missed.push_back(
        {first, piece.real_faces, mapped.energy.symmetric_dirichlet, mapped.energy.p99});
  }
  for (std::size_t c = 0; c < mapped.maps.size(); ++c) {
    AtlasChart& chart = mapped.opened.charts[c];
    scale_by_power(-piece.exponent, chart.chart.mesh.positions);
    scale_by_power(-piece.exponent, mapped.maps[c].uvs);
    chart.collapsed_into = {};
    chart.local_map = {};
    all.charts.push_back(std::move(chart));
    all.maps.push_back(std::move(mapped.maps[c]));
  }
}

/// As open_and_map, by one search within all bounds of the options.
MappedSurface map_within(const AtlasInput& input, const Admitted& admitted, int exponent,
                         const AtlasOptions& options, const Work& work,
                         std::vector<StageStatistics>& stages) {
  Task task{input, admitted, options, exponent};
  MappedSurface all;
  std::vector<SurfacePiece> pieces;
  run_stage("cut", work.part(0, kReady), stages, [&](StageStatistics&, const Work& inner) {
    GivenCuts cuts = input.cuts;
    if (options.stack == Stack::kHalves) {
      const auto between = edges_between_halves(input, admitted, options, inner.aside());
      cuts.edges.insert(cuts.edges.end(), between.begin(), between.end());
    }
    ReadySurface ready =
        make_ready(admitted, cuts, options.fill_limit, options.admit.polygons, input.hints, inner);
    all.filled_holes = ready.filled_holes;
    const bool is_one = is_asked_of_whole(input, options);
    if (is_one && (options.target || options.stack == Stack::kNone || !input.pins.empty())) {
      pieces.push_back(std::move(ready.whole));
    } else {
      pieces = components_of(std::move(ready.whole), inner);
    }
  });
  for (const SurfacePiece& piece : pieces) task.area += area_of(piece, work.aside());
  std::vector<Mapped> mapped(pieces.size());
  std::vector<std::vector<StageStatistics>> spent(pieces.size());
  const double wall = wall_seconds(), cpu = cpu_seconds();
  std::vector<Index> first(pieces.size()), searched, copies;
  std::iota(first.begin(), first.end(), 0);
  if (options.target || pieces.size() > 1) first = first_congruent(pieces);
  const bool mirrors = options.stack == Stack::kMirrored || options.stack == Stack::kHalves;
  for (Index p = 0; p < size_of(pieces); ++p) {
    const bool is_stacked = first[p] != p && options.stack != Stack::kNone &&
                            stack(pieces[p], pieces[first[p]], mirrors, admitted, all);
    if (is_stacked) continue;
    (first[p] == p || !options.target ? searched : copies).push_back(p);
  }
  const double share = kReady + (1 - kReady) * static_cast<double>(searched.size()) /
                                    static_cast<double>(pieces.size());
  for_each_piece(
      pieces, searched, work.part(kReady, share).named("cut"),
      [&](Index p, const Work& own) { mapped[p] = map_piece(task, pieces[p], own, spent[p]); });
  for_each_piece(pieces, copies, work.part(share, 1).named("cut"), [&](Index p, const Work& own) {
    mapped[p] = map_likewise(task, pieces[p], pieces[first[p]], mapped[first[p]], own, spent[p]);
  });
  add_up(spent, wall_seconds() - wall, cpu_seconds() - cpu, stages);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    if (mapped[p].maps.empty()) continue;  // it is stacked
    if (!mapped[p].pins.aside.empty()) all.pins_aside = std::move(mapped[p].pins.aside);
    collect(pieces[p], options.target, std::move(mapped[p]), admitted, all);
  }
  sort_by_first_face(admitted, all.charts, all.maps);
  return all;
}

/// Whether charts reach their target, and are within the number and the length that are asked for.
bool is_within_bounds(const MappedSurface& mapped, const Admitted& admitted,
                      const SeamTarget& target) {
  if (!mapped.missed.empty()) return false;
  const Index most = std::max(target.max_charts, admitted.counts.components);
  if (target.max_charts > 0 && size_of(mapped.charts) > most) return false;
  const double length = seam_length(mapped.charts, admitted.input_vertex);
  return target.seam_budget == 0 ||
         length <= target.seam_budget * std::sqrt(area_of(mapped.charts));
}

}  // namespace

MappedSurface open_and_map(const AtlasInput& input, const Admitted& admitted, int exponent,
                           const AtlasOptions& options, const Work& work,
                           std::vector<StageStatistics>& stages) {
  AtlasOptions unbounded = options;
  if (options.target) {
    unbounded.target->max_charts = 0;
    unbounded.target->seam_budget = 0;
  }
  if (is_asked_of_whole(input, options) == is_asked_of_whole(input, unbounded)) {
    return map_within(input, admitted, exponent, options, work, stages);
  }
  // Each component by itself finds better seams than a search over all, and often within bounds.
  MappedSurface free = map_within(input, admitted, exponent, unbounded, work.part(0, 0.5), stages);
  if (is_within_bounds(free, admitted, *options.target)) return free;
  return map_within(input, admitted, exponent, options, work.part(0.5, 1), stages);
}

}  // namespace beltrami
