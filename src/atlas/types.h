// What an atlas is made from, how, and what it is.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "admit/admit.h"
#include "atlas/open.h"
#include "atlas/pages.h"
#include "atlas/pins.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"
#include "chart/flattening.h"
#include "cut/given.h"
#include "cut/seam_costs.h"
#include "cut/seam_target.h"
#include "cut/search_effort.h"
#include "exact/atlas_certificate.h"
#include "multilevel/chart_map.h"
#include "multilevel/options.h"
#include "pack/types.h"
#include "pins/hold.h"

namespace beltrami {

/// An edge of the input, by its vertices, that is to be straight with those that it meets: kU with
/// one u, kV with one v, kLine on any line.
struct StraightEdge {
  Index from, to;
  PinKind kind;
};

/// That the chart of a face is to be a rectangle.
struct ChartRectangle {
  Index face;                                        ///< of the input
  Index of_caller;                                   ///< that face, as the caller counts
  std::optional<std::array<Index, 4>> corners = {};  ///< vertices of the input; none: the four that
                                                     ///< the border of its free map has
};

/// Any triangles, and what comes with them. Lists are empty where nothing is given.
struct AtlasInput {
  std::vector<Vec3> positions;
  std::vector<Triangle> faces;
  GivenCuts cuts = {};
  std::vector<double> densities = {};  ///< per face: lengths in the plane per length on the surface
  InputHints hints = {};
  std::vector<Pin> pins = {};  ///< their places single-precision numbers with `float32`
  std::vector<StraightEdge> straight = {};
  std::vector<ChartRectangle> rectangles = {};
};

/// Which components of one shape lie on each other; with kHalves those that are symmetric to the
/// plane of the whole surface are cut along it, and their halves do.
enum class Stack { kNone, kCopies, kMirrored, kHalves };

struct AtlasOptions {
  AdmitOptions admit = {};
  /// A mesh that is one disk as it stands is not welded: its seams may run between vertices at one
  /// place.
  bool keep_disk = true;
  /// Boundary loops no longer than so many roots of their component's area are filled.
  double fill_limit = 0.5;
  std::optional<SeamTarget> target = {};  ///< seams are searched for it; none: short ones open what
                                          ///< is no disk
  SearchEffort effort = search_effort(Effort::kNormal);  ///< of that search, and of the packer
  SeamWeights weights = {};                              ///< likewise
  ChartOptions chart = {};                               ///< of every chart, but for what follows
  /// Components that a rigid motion, or one and a reflection, carries onto one before them get its
  /// UVs. Not with pins, nor with what the target asks of the whole.
  Stack stack = Stack::kNone;
  /// Pages to pack the charts onto, its texels per unit of the surface; none, and where there are
  /// pins: they lie side by side in that unit.
  std::optional<PackOptions> pack = {};
  /// Seams that charts are split along for the sake of the pages: their length, in roots of the
  /// area, that all of the utilisation is worth; 0: none. Without texels per unit and paint alone.
  double fill_weight = 0;
  bool label_pages = false;    ///< charts of faces with different labels share no page
  bool unit_square = false;    ///< scale what is not packed by a power of two into the unit square
  bool float32 = false;        ///< deliver single-precision numbers
  bool rectify_grids = false;  ///< charts that are grids of quads are laid out as such
};

struct ChartInfo {
  Index faces = 0;
  Index first_face = 0;  ///< of the input, the least one
  double area = 0;       ///< of the surface, in the input's unit squared
  double density = 1;    ///< lengths in the plane were scaled by it: the mean of its faces, those
                         ///< included that were split off, or what its pins ask for
  bool pinned = false;
  Eigen::AlignedBox2d box;  ///< of its UVs, on its page
  Outcome outcome = Outcome::kOk;
  std::optional<Fault> error;               ///< why it has no map, but one point, where that is so
  double symmetric_dirichlet = 0, max = 0;  ///< as those of the atlas
};

/// Symmetric Dirichlet energy, at least 2, over the faces weighted by area, at one scale for all:
/// the input's unit, or where densities are given the chart's, whatever the scale of the pages.
/// Faces that are flipped or have no area in the plane are left out; NaN where none is left. The
/// worst faces, of no area to speak of, have no say: see kSliverShare.
struct AtlasEnergy {
  double symmetric_dirichlet = 0;  ///< mean
  double p99 = 0;                  ///< exceeded on no more than 1% of the area
  double max = 0;
  Index left_out = 0;                                  ///< faces
  Index slivers = 0;                                   ///< faces that have no say
  double mean_with_slivers = 0, max_with_slivers = 0;  ///< what it would be with them
};

/// A component of the surface, as it is parted by the cuts that are given, whose maps have more
/// energy than was asked for.
struct MissedTarget {
  Index first_face = 0;  ///< of the input, the least one
  Index faces = 0;
  double symmetric_dirichlet = 0, p99 = 0;  ///< as those of the atlas, of its own area
};

/// Charts come by their least face, UV vertices by their chart. Faces that were set aside are in no
/// chart: each is a point in the plane, with a UV vertex for each corner, of that corner's vertex.
/// Copies that share the UV vertices of another face are in its chart, and not judged; so are faces
/// that are stacked on others, which have UV vertices of their own at the same numbers.
struct Atlas {
  Outcome outcome = Outcome::kOk;
  std::vector<Vec2> uvs;             ///< one per UV vertex, in the input's unit, or where the atlas
                                     ///< is packed in the plane of the pages: see tile_of
  std::vector<Index> page_of_uv;     ///< per UV vertex, where the atlas is packed
  std::vector<Index> input_vertex;   ///< per UV vertex: the least of those welded
  std::vector<Triangle> faces;       ///< per face of the input: UV vertices of its corners
  std::vector<Index> chart_of_face;  ///< per face of the input, or kNone
  std::vector<bool> reversed;  ///< per face of the input: positive in the plane the other way round
  std::vector<bool> excepted;  ///< per face of the input: not judged, set aside or sharing
  std::vector<ChartInfo> charts;
  AdmitCounts admitted;
  Index filled_holes = 0;
  Index stacked_parts = 0;  ///< components that lie on others
  double area = 0;          ///< of the surface but for these, in the input's unit squared
  AtlasEnergy energy;
  std::vector<MissedTarget> missed;  ///< by their least face; none without a target
  double seam_length = 0;  ///< in the input's unit, each seam once, and no border of the surface
  double seam_over_root_area = 0;
  double utilisation = 0;               ///< area of the UVs over that of their bounding box, or of
                                        ///< the pages
  std::optional<Pages> pages;           ///< where it is packed
  AtlasCertificate certificate;         ///< of the numbers delivered
  AtlasCertificate single_certificate;  ///< of the single-precision numbers nearest to them
  std::vector<StageStatistics> stages;  ///< in the order in which they ran
};

}  // namespace beltrami
