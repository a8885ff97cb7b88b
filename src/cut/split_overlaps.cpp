#include "cut/split_overlaps.h"

#include <numeric>
#include <utility>

#include "cut/layers.h"
#include "cut/merge_parts.h"
#include "cut/part.h"
#include "cut/separate.h"
#include "cut/sheets.h"
#include "exact/crossings.h"

namespace beltrami {
namespace {

/// A map that lies on itself more often is no atlas to be: bounds the time of pathological ones.
constexpr Index kMostParts = 512;
/// Pairs of sheets between which locked edges may leave no cut before a part is left as it is.
constexpr Index kMostTries = 8;

/// The parts that a first cut which leaves disks parts it into; none if there is no such cut.
std::vector<Part> split(const Part& part, double tolerance, const Work& work) {
  for (Index rank = 0; rank <= kMostTries; ++rank) {
    Sheets sheets;
    if (rank < kMostTries) sheets = largest_sheets(part.mesh, part.uvs, part.layers, rank);
    const bool is_last = sheets.none();
    if (is_last && tolerance == 0) sheets = crossing_faces(part.mesh, part.uvs);
    if (sheets.none()) break;
    const Separation cut = separate(part, sheets, work);
    if (!cut.none()) {
      std::vector<Part> parts = parts_of(part, cut.marks, work);
      if (parts.size() > 1) return parts;
    }
    if (is_last) break;
  }
  return {};
}

EdgeMarks seams_between(const DiskMesh& disk, const std::vector<Part>& parts) {
  EdgeMarks seams(disk.twin.size(), false);
  for (const Part& part : parts) {
    for (Index h = 0; h < size_of(part.mesh.twin); ++h) {
      const Index of_disk = 3 * part.face[h / 3] + h % 3;
      if (part.mesh.twin[h] == kNone && disk.twin[of_disk] != kNone) seams[of_disk] = true;
    }
  }
  return seams;
}

}  // namespace

OverlapSplit split_overlaps(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                            const std::vector<double>& cost, double tolerance, const Work& work) {
  OverlapSplit result;
  result.seams.assign(disk.twin.size(), false);
  if (is_simple(disk.boundary, uvs)) return result;
  const Layers layers = layers_of(disk, uvs);
  if (tolerance > 0 && overlapped_area(layers) <= tolerance * uv_area(disk.faces, uvs)) {
    return result;
  }
  std::vector<Index> all(disk.faces.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Part> open, done;
  open.push_back({disk, uvs, cost, layers, std::move(all)});
  while (!open.empty()) {
    Part part = std::move(open.back());
    open.pop_back();
    const bool is_bad = lies_on_itself(part, tolerance);
    std::vector<Part> parts;
    if (is_bad && size_of(open) + size_of(done) < kMostParts) parts = split(part, tolerance, work);
    if (parts.empty()) {
      result.overlapping += is_bad ? 1 : 0;
      done.push_back(std::move(part));
    }
    for (Part& child : parts) open.push_back(std::move(child));
  }
  PartedMap map{disk,          uvs,
                cost,          layers,
                tolerance,     std::vector<Index>(disk.faces.size()),
                size_of(done), seams_between(disk, done)};
  for (Index i = 0; i < size_of(done); ++i) {
    for (const Index f : done[i].face) map.part_of_face[f] = i;
  }
  done.clear();
  if (map.parts > 1) merge_parts(map, work);
  result.seams = std::move(map.seams);
  result.parts = map.parts;
  for (Index h = 0; h < size_of(disk.twin); ++h) {
    if (result.seams[h] && disk.edge(h) == h) result.cost += cost[h];
  }
  return result;
}

}  // namespace beltrami
