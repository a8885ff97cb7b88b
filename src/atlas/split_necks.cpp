#include "atlas/split_necks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "atlas/chart_parts.h"
#include "atlas/keep_windings.h"
#include "atlas/measure.h"
#include "atlas/pack_maps.h"
#include "base/interrupt.h"
#include "base/parallel.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/edge_marks.h"
#include "cut/necks.h"
#include "mesh/chart.h"
#include "mesh/disk_mesh.h"
#include "pack/outline.h"
#include "pack/pack.h"

namespace beltrami {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Of a chart, in the lesser part: less is a crumb.
constexpr double kLeastShare = 0.12;
/// By so much a split may save more than its neck promises: packings tell.
constexpr double kHope = 2;
/// Charts that are longer than a page this full are worth splitting for that alone.
constexpr double kFull = 0.75;
/// Sides of such a page that what is too long for it has: its diagonal is shorter.
constexpr double kOverlong = 1.5;
/// Charts of fewer faces were modelled one face after the other, and stay what is expected of them,
/// a box a cross; but not what is too long. The nets of a cube have 1.4 to 1.9 sides of such a
/// page.
constexpr Index kLeastFaces = 32;
constexpr double kOverlongOfFew = 2;
/// Of all charts: smaller ones are not split, unless they are longer than such a page, and are left
/// out of sketches, for they fill gaps. Where they are more than half of all, pages are full as
/// they are.
constexpr double kLeastPiece = 0.005;
/// Of the necks of a chart so many are looked at. Of the splits next to one another so many are
/// tried in sketches of packings, and the search ends when so many in a row gained nothing: one may
/// pay only with the next. Of the numbers of splits that come of it so many are packed as the
/// charts whole are, before none is made.
constexpr int kTries = 3;
/// Texels a side of the pages of these, and turns of their charts, at most: they are compared with
/// one another alone.
constexpr int kSketch = 256, kSketchTurns = 4;
constexpr Index kMostSplits = 64;

/// A chart, or a part of one.
struct Piece {
  const AtlasChart* chart = nullptr;
  const MappedChart* map = nullptr;
  double scale = 1;
  std::shared_ptr<const ChartPart> part = {};  // which these are of, if it is one
  Outline outline = {};
  std::vector<Neck> necks = {};    // the best first
  std::vector<bool> is_used = {};  // per neck
};

/// A piece that gives way to two.
struct Split {
  Index piece = kNone;
  Index parts[2] = {kNone, kNone};
  double cost = 0;
};

/// Whether real faces are connected by themselves.
bool is_connected(const AtlasChart& chart) {
  const std::vector<Index> pieces = real_pieces(chart);
  return std::all_of(pieces.begin(), pieces.end(), [](Index p) { return p == 0; });
}

double utilisation_of(const std::vector<AtlasChart>& charts, const std::vector<MappedChart>& maps,
                      const Pages& pages) {
  double area = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (Index f = 0; f < charts[c].real_faces; ++f) {
      const auto& [i, j, k] = charts[c].chart.mesh.faces[f];
      const Vec2 p = maps[c].uvs[j] - maps[c].uvs[i], q = maps[c].uvs[k] - maps[c].uvs[i];
      area += 0.5 * std::abs(p.x() * q.y() - p.y() * q.x());
    }
  }
  return area / pages.count;
}

/// Whether all can be delivered where they lie: others are mended whole.
bool are_sound(const std::vector<MappedChart>& maps) {
  return std::all_of(maps.begin(), maps.end(), [](const MappedChart& map) {
    return map.outcome <= Outcome::kNotConverged && map.fits_single;
  });
}

/// A search for the splits that pay. Keeps references to the charts whole.
class Splitter {
 public:
  Splitter(const Admitted& admitted, const SplitRules& rules, const PackOptions& options,
           const SplitCharts& whole, const Work& work)
      : admitted_(admitted), rules_(rules), options_(options), work_(work) {
    options_.effort = 0;
    options_.turns = std::min(options.turns, kSketchTurns);
    options_.upright = true;
    if (options.resolution > kSketch) {
      options_.margin *= static_cast<double>(kSketch) / options.resolution;
      options_.resolution = kSketch;
      options_.block = 1;
    }
    double covered = 0;
    for (std::size_t c = 0; c < whole.charts.size(); ++c) {
      pieces_.push_back({&whole.charts[c], &whole.maps[c], whole.scales[c]});
    }
    whole_ = size_of(pieces_);
    root_ = std::sqrt(area_of(whole.charts));
    room_ = rules.seam_budget > 0
                ? rules.seam_budget * root_ - seam_length(whole.charts, admitted.input_vertex)
                : kFar;
    parallel_for(work_, size_of(pieces_), 1, [&](std::int64_t p, std::int64_t) {
      pieces_[p].outline = outline_of(*pieces_[p].chart, pieces_[p].map->uvs);
    });
    for (const Piece& piece : pieces_) covered += piece.map->error ? 0 : piece.outline.area;
    covered_ = covered;
  }

  /// The length of seams that is worth a gain of utilisation.
  double worth(double utilisation) const { return rules_.price * root_ * utilisation; }

  /// Finds splits in an order. Returns how many of the first are best, by what they gain beyond
  /// their price, and others that gain, the better first.
  std::vector<Index> find() {
    if (!(covered_ > 0)) return {};
    double large = 0;
    for (Index p = 0; p < size_of(pieces_); ++p) {
      if (is_crumb(pieces_[p])) continue;
      alive_.push_back(p);
      large += pieces_[p].outline.area;
    }
    if (large < covered_ / 2) return {};
    const double before = sketched(alive_, work_);
    utilisation_ = before;
    parallel_for(work_, size_of(alive_), 1,
                 [&](std::int64_t i, std::int64_t) { find_necks_of(pieces_[alive_[i]]); });
    std::vector<double> net{before};
    double cost = split_overlong();
    if (!splits_.empty()) {
      // Some alone are worth nothing: the longest of those that are left sets the density.
      net.resize(splits_.size(), -kFar);
      net.push_back(sketched(alive_, work_) - cost / worth(1));
    }
    const std::size_t first = splits_.size();
    std::size_t best = net.back() > before ? first : 0;
    while (splits_.size() < std::max(best, first) + kTries && size_of(splits_) < kMostSplits) {
      if (work_.out_of_time() || !may_have_more()) break;
      const std::optional<double> found = split_best(cost);
      if (!found) break;
      cost += splits_.back().cost;
      net.push_back(*found - cost / worth(1));
      if (net.back() > net[best]) best = net.size() - 1;
      utilisation_ = std::max(utilisation_, *found);
    }
    std::vector<Index> order;
    for (Index k = 1; k < size_of(net); ++k) {
      if (net[k] > before) order.push_back(k);
    }
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return net[a] > net[b]; });
    return order;
  }

  /// The charts after the first `count` splits, by their least face.
  void take(Index count, SplitCharts out) const {
    std::vector<bool> is_there(pieces_.size(), false);
    for (Index p = 0; p < whole_; ++p) is_there[p] = true;
    for (Index s = 0; s < count; ++s) {
      is_there[splits_[s].piece] = false;
      for (const Index part : splits_[s].parts) is_there[part] = true;
    }
    std::vector<std::pair<Index, Index>> order;
    for (Index p = 0; p < size_of(pieces_); ++p) {
      if (is_there[p]) order.emplace_back(first_input_face(*pieces_[p].chart, admitted_), p);
    }
    std::sort(order.begin(), order.end());
    out.charts.clear();
    out.maps.clear();
    out.scales.clear();
    for (const auto& [face, p] : order) {
      out.charts.push_back(*pieces_[p].chart);
      out.maps.push_back(*pieces_[p].map);
      out.scales.push_back(pieces_[p].scale);
    }
  }

  double root() const { return root_; }

 private:
  struct Candidate {
    double gain = 0;
    Index piece = kNone, neck = 0;
  };

  bool may_have_more() const {
    return rules_.most_charts == 0 || whole_ + size_of(splits_) < rules_.most_charts;
  }

  /// Of one that is well filled.
  double page_area() const { return covered_ / (kFull * options_.max_pages); }

  void find_necks_of(Piece& piece) const {
    const AtlasChart& chart = *piece.chart;
    const bool is_sound = !piece.map->error && piece.map->outcome < Outcome::kNotInjective;
    const bool overlong = is_overlong(piece);
    const bool is_worth_it = overlong || piece.outline.area > kLeastPiece * covered_;
    const bool stays = !overlong && (chart.real_faces < kLeastFaces || !has_seam(chart));
    if (!is_sound || !is_worth_it || stays) return;
    // What is too long takes a page for itself: pages may be full once it is split.
    const double filled = overlong ? kFull : utilisation_;
    const NeckOptions options{.worth = kHope * worth(filled * filled / covered_),
                              .page = page_area(),
                              .least_share = kLeastShare,
                              .most = kTries};
    piece.necks =
        find_necks(chart.chart.mesh, piece.map->uvs, costs(chart), chart.real_faces, options);
    piece.is_used.assign(piece.necks.size(), false);
  }

  /// Whether its border is another than the surface's: what lies flat without a seam stays whole.
  bool has_seam(const AtlasChart& chart) const {
    for (Index h = 0; h < 3 * chart.real_faces; ++h) {
      const bool is_border = chart.chart.mesh.twin[h] == kNone;
      if (is_border && admitted_.surface.twin[chart.on_surface(h)] != kNone) return true;
    }
    return false;
  }

  /// Whether a piece fits on no page that is well filled, however it is turned.
  bool is_overlong(const Piece& piece) const {
    const Vec2 along = turn_to_least_box(piece.outline.hull);
    double least = kFar, most = -kFar;
    for (const Vec2& p : piece.outline.hull) {
      const double place = along.x() * p.x() - along.y() * p.y();
      least = std::min(least, place);
      most = std::max(most, place);
    }
    const double length = most - least;
    const bool is_few = piece.chart->real_faces < kLeastFaces;
    return length > (is_few ? kOverlongOfFew : kOverlong) * std::sqrt(page_area());
  }

  /// Per half-edge the length of a seam there: what fills holes costs nothing.
  std::vector<double> costs(const AtlasChart& chart) const {
    const DiskMesh& mesh = chart.chart.mesh;
    std::vector<double> costs(mesh.twin.size(), kFar);
    PollSometimes poll;
    for (Index h = 0; h < size_of(mesh.twin); ++h) {
      poll();
      const Index twin = mesh.twin[h];
      if (twin == kNone) continue;
      if (h >= 3 * chart.real_faces || twin >= 3 * chart.real_faces) {
        costs[h] = 0;
      } else if (rules_.polygons.polygon.empty() ||
                 !is_inside_polygon(admitted_, rules_.polygons, chart.on_surface(h),
                                    chart.on_surface(twin))) {
        costs[h] = (mesh.positions[mesh.target(h)] - mesh.positions[mesh.origin(h)]).norm();
      }
    }
    return costs;
  }

  bool is_crumb(const Piece& piece) const {
    return piece.map->error ||
           (piece.outline.area <= kLeastPiece * covered_ && !is_overlong(piece));
  }

  double sketched(const std::vector<Index>& alive, const Work& work) const {
    std::vector<Outline> outlines;
    for (const Index p : alive) outlines.push_back(pieces_[p].outline);
    return pack_outlines(std::move(outlines), options_, work).utilisation;
  }

  /// The two parts of a piece along one of its necks; none where they are no two connected disks of
  /// some size.
  std::vector<Piece> parts_of(const Piece& piece, const Neck& neck) const {
    const DiskMesh& mesh = piece.chart->chart.mesh;
    EdgeMarks marks(mesh.twin.size(), false);
    for (const Index h : neck.halfedges) mark_edge(mesh, h, marks);
    std::vector<ChartPart> found = parts_along(*piece.chart, *piece.map, marks, work_.aside());
    if (found.size() != 2) return {};
    std::vector<Piece> parts;
    for (ChartPart& half : found) {
      Piece& part = parts.emplace_back();
      part.part = std::make_shared<const ChartPart>(std::move(half));
      part.chart = &part.part->chart;
      part.map = &part.part->map;
      part.scale = piece.scale;
      if (!is_connected(*part.chart)) return {};
      part.outline = outline_of(*part.chart, part.map->uvs);
      if (part.outline.area < kLeastShare * piece.outline.area) return {};
    }
    return parts;
  }

  /// The necks that promise most, of all pieces.
  std::vector<Candidate> candidates(double cost) const {
    std::vector<Candidate> found;
    for (const Index p : alive_) {
      const Piece& piece = pieces_[p];
      for (Index n = 0; n < size_of(piece.necks); ++n) {
        const Neck& neck = piece.necks[n];
        const double saved = worth(utilisation_ * utilisation_ * neck.saved / covered_);
        if (!piece.is_used[n] && kHope * saved > neck.cost && cost + neck.cost <= room_) {
          found.push_back({saved - neck.cost, p, n});
        }
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
    return found;
  }

  /// A split that is tried.
  struct Trial {
    Candidate candidate;
    std::vector<Piece> parts = {};
    double utilisation = 0, net = 0;
  };

  /// The first of these that make parts, without what comes of them.
  std::vector<Trial> trials_of(const std::vector<Candidate>& candidates) {
    std::vector<Trial> trials;
    for (auto next = candidates.begin(); next != candidates.end() && size_of(trials) < kTries;) {
      const Index first = size_of(trials);
      while (next != candidates.end() && size_of(trials) < kTries) trials.push_back({*next++});
      parallel_for(work_, size_of(trials) - first, 1, [&](std::int64_t t, std::int64_t) {
        Trial& trial = trials[first + t];
        const Piece& piece = pieces_[trial.candidate.piece];
        trial.parts = parts_of(piece, piece.necks[trial.candidate.neck]);
      });
      for (const Trial& trial : trials) {
        if (!trial.parts.empty()) continue;
        pieces_[trial.candidate.piece].is_used[trial.candidate.neck] = true;
      }
      std::erase_if(trials, [](const Trial& trial) { return trial.parts.empty(); });
    }
    return trials;
  }

  /// Splits one piece more, whatever that gains: the best of those that promise most. Returns the
  /// utilisation then; none where there is nothing to split.
  std::optional<double> split_best(double cost) {
    std::vector<Trial> trials = trials_of(candidates(cost));
    if (trials.empty()) return std::nullopt;
    parallel_for(work_, size_of(trials), 1, [&](std::int64_t t, std::int64_t) {
      Trial& trial = trials[t];
      std::vector<Outline> outlines;
      for (const Index p : alive_) {
        if (p != trial.candidate.piece) outlines.push_back(pieces_[p].outline);
      }
      for (const Piece& part : trial.parts) outlines.push_back(part.outline);
      trial.utilisation = pack_outlines(std::move(outlines), options_, work_.aside()).utilisation;
      const Neck& neck = pieces_[trial.candidate.piece].necks[trial.candidate.neck];
      trial.net = trial.utilisation - neck.cost / worth(1);
    });
    Trial& best = *std::max_element(trials.begin(), trials.end(),
                                    [](const Trial& a, const Trial& b) { return a.net < b.net; });
    split(best.candidate.piece, best.candidate.neck, std::move(best.parts));
    return best.utilisation;
  }

  /// Lets a piece give way to two.
  void split(Index piece, Index neck, std::vector<Piece> parts) {
    splits_.push_back(
        {piece, {size_of(pieces_), size_of(pieces_) + 1}, pieces_[piece].necks[neck].cost});
    std::erase(alive_, piece);
    parallel_for(work_, size_of(parts), 1,
                 [&](std::int64_t i, std::int64_t) { find_necks_of(parts[i]); });
    for (Piece& part : parts) {
      alive_.push_back(size_of(pieces_));
      pieces_.push_back(std::move(part));
    }
  }

  /// The numbers of necks by what they save for their cost, the most first.
  static std::vector<Index> cheapest_first(const std::vector<Neck>& necks) {
    std::vector<Index> order(necks.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
      return necks[a].saved * necks[b].cost > necks[b].saved * necks[a].cost;
    });
    return order;
  }

  /// Splits what is too long for a page where most is saved for the cost, until nothing is: as long
  /// as one is left it alone sets the density. Returns what that costs.
  double split_overlong() {
    double cost = 0;
    for (std::size_t i = 0; i < alive_.size() && size_of(splits_) < kMostSplits;) {
      const Index p = alive_[i];
      std::vector<Piece> parts;
      Index chosen = kNone;
      if (may_have_more() && !work_.out_of_time() && is_overlong(pieces_[p])) {
        for (const Index neck : cheapest_first(pieces_[p].necks)) {
          if (cost + pieces_[p].necks[neck].cost > room_) continue;
          parts = parts_of(pieces_[p], pieces_[p].necks[neck]);
          chosen = neck;
          if (!parts.empty()) break;
        }
      }
      if (parts.empty()) {
        ++i;
        continue;
      }
      split(p, chosen, std::move(parts));
      cost += splits_.back().cost;
    }
    return cost;
  }

  const Admitted& admitted_;
  const SplitRules& rules_;
  PackOptions options_;  // of sketches
  const Work work_;
  double root_ = 0;         // of the area of the surface
  double covered_ = 0;      // area of all maps
  double room_ = kFar;      // for seams
  double utilisation_ = 0;  // before any split
  std::vector<Piece> pieces_;
  Index whole_ = 0;  // of these: charts that are not split, the first ones
  std::vector<Index> alive_;
  std::vector<Split> splits_;
};

}  // namespace

Pages pack_split_maps(const Admitted& admitted, const SplitRules& rules, const PackOptions& options,
                      bool float32, SplitCharts charts, const Work& work) {
  constexpr double kFound = 0.5;  // in the progress
  const double whole_packed = std::midpoint(kFound, 1.0);
  struct Packed {
    std::vector<AtlasChart> charts;
    std::vector<MappedChart> maps;
    std::vector<double> scales;
    Pages pages;
    double utilisation = 0;
    double length = 0;  // of seams
  };
  Splitter splitter(admitted, rules, options, charts, work.part(0, kFound));
  const auto packed = [&](Index count, double from, double to) {
    Packed made;
    splitter.take(count, {made.charts, made.maps, made.scales});
    keep_windings(admitted, made.charts, made.maps, work.aside());
    made.length = seam_length(made.charts, admitted.input_vertex);
    made.pages = pack_maps(made.charts, options, float32, made.maps, work.part(from, to));
    made.utilisation = utilisation_of(made.charts, made.maps, made.pages);
    return made;
  };
  const std::vector<Index> counts = splitter.find();
  if (counts.empty()) {
    Pages pages = pack_maps(charts.charts, options, float32, charts.maps, work.part(kFound, 1));
    pages.split = SplitFigures{utilisation_of(charts.charts, charts.maps, pages), 0, 0};
    return pages;
  }
  Packed best = packed(0, kFound, whole_packed);
  SplitFigures chosen{best.utilisation, 0, 0};
  for (const Index count : std::span(counts).first(std::min<std::size_t>(counts.size(), kTries))) {
    if (work.out_of_time()) break;
    Packed trial = packed(count, whole_packed, 1);
    const double gained = trial.utilisation - best.utilisation;
    const double longer = trial.length - best.length;
    if (gained <= 0 || splitter.worth(gained) < longer || !are_sound(trial.maps)) continue;
    chosen.count = count;
    chosen.length = longer / splitter.root();
    best = std::move(trial);
    break;
  }
  charts.charts = std::move(best.charts);
  charts.maps = std::move(best.maps);
  charts.scales = std::move(best.scales);
  best.pages.split = chosen;
  return std::move(best.pages);
}

}  // namespace beltrami
