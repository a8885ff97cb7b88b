// A disk of a larger disk, with its map.
#pragma once

#include <optional>
#include <vector>

#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "cut/edge_marks.h"
#include "cut/layers.h"
#include "mesh/disk_mesh.h"

namespace beltrami {

/// Its order of vertices and faces, and the corners of these, are those of the larger disk.
struct Part {
  DiskMesh mesh;
  std::vector<Vec2> uvs;     ///< one per vertex
  std::vector<double> cost;  ///< per half-edge that of a cut along it; infinite where locked
  Layers layers;             ///< of its faces
  std::vector<Index> face;   ///< per face that of the larger disk, increasing
};

/// The disks that a part falls into along the marks; none unless all are disks.
std::vector<Part> parts_of(const Part& part, const EdgeMarks& marks, const Work& work);

/// Some faces of a disk with its seams between them open: a part if that is a disk. `layers` are
/// those of the whole. Precondition: increasing faces.
std::optional<Part> part_from(const DiskMesh& disk, const std::vector<Vec2>& uvs,
                              const std::vector<double>& cost, const Layers& layers,
                              std::vector<Index> faces, const EdgeMarks& seams, const Work& work);

/// The area of maps, positive where they lie the right way round.
double uv_area(const Triangle& face, const std::vector<Vec2>& uvs);
double uv_area(const std::vector<Triangle>& faces, const std::vector<Vec2>& uvs);

/// Whether the map of the part lies on itself on more than `tolerance` of its area; with a
/// tolerance of 0, at all.
bool lies_on_itself(const Part& part, double tolerance);

}  // namespace beltrami
