#include "cut/merge_parts.h"

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <utility>

#include "base/interrupt.h"
#include "cut/max_flow.h"
#include "cut/part.h"
#include "cut/separate.h"
#include "cut/sheets.h"

namespace beltrami {
namespace {

/// A cut that is cheaper by less than this share is none.
constexpr double kGain = 1e-3;
/// Seams of disks of more faces stay as they are: they are mostly as short as can be, and to
/// look for others takes as long as to find them did.
constexpr Index kMostFaces = 100'000;

using PartPair = std::array<Index, 2>;

/// Two parts side by side, and the cost of the seams between them.
struct Neighbours {
  PartPair parts;
  double cost = 0;
};

class Merging {
 public:
  Merging(PartedMap& map, const Work& work) : map_(map), work_(work) {
    area_.assign(map.parts, 0);
    for (Index f = 0; f < map.disk.face_count(); ++f) {
      area_[map.part_of_face[f]] += uv_area(map.disk.faces[f], map.uvs);
    }
  }

  void run() {
    merge();
    for (const Neighbours& pair : neighbours()) shorten(pair);
    merge();
    renumber();
  }

 private:
  std::vector<Neighbours> neighbours() const;
  void merge();
  bool unite(const PartPair& pair);
  void shorten(const Neighbours& pair);
  void renumber();

  bool is_in(const PartPair& pair, Index face) const {
    return map_.part_of_face[face] == pair[0] || map_.part_of_face[face] == pair[1];
  }
  /// Whether a seam is between the two parts, or a slit in one of them.
  bool is_within(const PartPair& pair, Index h) const {
    const Index twin = map_.disk.twin[h];
    return map_.seams[h] && twin != kNone && is_in(pair, h / 3) && is_in(pair, twin / 3);
  }
  std::vector<Index> faces_of(const PartPair& pair) const {
    std::vector<Index> faces;
    for (Index f = 0; f < map_.disk.face_count(); ++f) {
      if (is_in(pair, f)) faces.push_back(f);
    }
    return faces;
  }
  bool overlap_by_pixels(const PartPair& pair) const {
    double count = 0;
    for (Index i = 0; i < map_.layers.count(); ++i) {
      Index depth = 0;
      for (const Index f : map_.layers[i]) depth += is_in(pair, f) ? 1 : 0;
      count += std::max(depth - 1, 0);
    }
    return count * map_.layers.pixel * map_.layers.pixel >
           map_.tolerance * (area_[pair[0]] + area_[pair[1]]);
  }
  std::optional<Part> whole(const PartPair& pair, const EdgeMarks& seams) const {
    return part_from(map_.disk, map_.uvs, map_.cost, map_.layers, faces_of(pair), seams, work_);
  }

  PartedMap& map_;
  const Work& work_;
  std::vector<double> area_;  // per part, of its map
};

/// By falling cost of their seams.
std::vector<Neighbours> Merging::neighbours() const {
  std::vector<Neighbours> all;
  const DiskMesh& disk = map_.disk;
  for (Index h = 0; h < size_of(disk.twin); ++h) {
    if (!map_.seams[h] || disk.twin[h] <= h) continue;
    const auto [low, high] =
        std::minmax(map_.part_of_face[h / 3], map_.part_of_face[disk.twin[h] / 3]);
    if (low != high) all.push_back({{low, high}, map_.cost[h]});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Neighbours& a, const Neighbours& b) { return a.parts < b.parts; });
  std::vector<Neighbours> pairs;
  for (const Neighbours& one : all) {
    if (pairs.empty() || pairs.back().parts != one.parts) pairs.push_back({one.parts, 0});
    pairs.back().cost += one.cost;
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Neighbours& a, const Neighbours& b) { return a.cost > b.cost; });
  return pairs;
}

void Merging::merge() {
  std::set<PartPair> refused;
  bool again = true;
  while (again) {
    again = false;
    for (const Neighbours& pair : neighbours()) {
      poll_interrupt();
      if (refused.contains(pair.parts)) continue;
      if (overlap_by_pixels(pair.parts) || !unite(pair.parts)) {
        refused.insert(pair.parts);
        continue;
      }
      const auto [kept, gone] = pair.parts;
      std::erase_if(refused, [&, kept = kept, gone = gone](const PartPair& other) {
        return other[0] == kept || other[1] == kept || other[0] == gone || other[1] == gone;
      });
      again = true;
      break;
    }
  }
}

/// Makes one of two parts where that is a disk and keeps to the tolerance: without the slits in
/// them, or with these. Returns whether it did.
bool Merging::unite(const PartPair& pair) {
  for (const bool keeps_slits : {false, true}) {
    EdgeMarks seams = map_.seams;
    bool has_slits = false;
    for (Index h = 0; h < size_of(map_.disk.twin); ++h) {
      if (!is_within(pair, h)) continue;
      const bool is_slit = map_.part_of_face[h / 3] == map_.part_of_face[map_.disk.twin[h] / 3];
      has_slits = has_slits || is_slit;
      if (!is_slit || !keeps_slits) seams[h] = false;
    }
    if (keeps_slits && !has_slits) break;
    const std::optional<Part> one = whole(pair, seams);
    if (!one || lies_on_itself(*one, map_.tolerance)) continue;
    map_.seams = std::move(seams);
    for (Index& part : map_.part_of_face) part = part == pair[1] ? pair[0] : part;
    area_[pair[0]] += area_[pair[1]];
    return true;
  }
  return false;
}

/// Two parts that overlap nothing in themselves: any cut between the faces of one that lie on the
/// other and those below them will do, so the least one.
void Merging::shorten(const Neighbours& pair) {
  if (map_.disk.face_count() > kMostFaces) return;
  EdgeMarks seams = map_.seams;
  double cost = 0;
  for (Index h = 0; h < size_of(map_.disk.twin); ++h) {
    if (!is_within(pair.parts, h)) continue;
    seams[h] = false;
    if (map_.disk.edge(h) == h) cost += map_.cost[h];
  }
  const std::optional<Part> one = whole(pair.parts, seams);
  if (!one) return;
  Sheets sheets;
  sheets.terminals.assign(one->face.size(), Terminal::kNeither);
  const auto side = [&](Index f) {
    return map_.part_of_face[one->face[f]] == pair.parts[0] ? Terminal::kSource : Terminal::kSink;
  };
  for (Index i = 0; i < one->layers.count(); ++i) {
    const auto faces = one->layers[i];
    const auto is_first = [&](Index f) { return side(f) == Terminal::kSource; };
    if (std::all_of(faces.begin(), faces.end(), is_first)) continue;
    if (std::none_of(faces.begin(), faces.end(), is_first)) continue;
    for (const Index f : faces) sheets.terminals[f] = side(f);
  }
  const Separation other = separate(*one, sheets, work_);
  if (other.none() || other.cost >= (1 - kGain) * cost) return;
  const std::vector<Part> parts = parts_of(*one, other.marks, work_);
  if (parts.size() != 2) return;
  for (const Part& part : parts) {
    if (lies_on_itself(part, map_.tolerance)) return;
  }
  for (Index h = 0; h < size_of(other.marks); ++h) {
    if (other.marks[h]) seams[3 * one->face[h / 3] + h % 3] = true;
  }
  map_.seams = std::move(seams);
  for (int i = 0; i < 2; ++i) {
    for (const Index f : parts[i].face) map_.part_of_face[f] = pair.parts[i];
    area_[pair.parts[i]] = uv_area(parts[i].mesh.faces, parts[i].uvs);
  }
}

void Merging::renumber() {
  std::vector<Index> number(area_.size(), kNone);
  map_.parts = 0;
  for (Index& part : map_.part_of_face) {
    if (number[part] == kNone) number[part] = map_.parts++;
    part = number[part];
  }
}

}  // namespace

void merge_parts(PartedMap& map, const Work& work) {
  Merging(map, work).run();
}

}  // namespace beltrami
