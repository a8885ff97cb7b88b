// Any triangles -> an atlas: charts that are disks, each flattened, laid out side by side and
// judged together. The place that knows the order of the stages.
#pragma once

#include <beltrami/beltrami.h>

#include <vector>

#include "admit/admit.h"
#include "base/types.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"

namespace beltrami {

struct AtlasOptions {
  AdmitOptions admit = {};
  /// A mesh that is one disk as it stands is not welded: its seams may run between vertices at one
  /// place.
  bool keep_disk = true;
  bool float32 = false;  ///< deliver single-precision numbers
};

struct ChartInfo {
  Index faces = 0;
  double area = 0;  ///< of the surface, in the input's unit squared
  Outcome outcome = Outcome::kOk;
  beltrami_status error = BELTRAMI_OK;      ///< why it has no map, but one point, where that is so
  double symmetric_dirichlet = 0, max = 0;  ///< as those of the atlas
};

/// Symmetric Dirichlet energy, at least 2, over the faces weighted by area, at one scale for all:
/// the input's unit. Faces that are flipped or have no area in the plane are left out; NaN where
/// none is left.
struct AtlasEnergy {
  double symmetric_dirichlet = 0;  ///< mean
  double p99 = 0;                  ///< exceeded on no more than 1% of the area
  double max = 0;
  Index left_out = 0;  ///< faces
};

/// Charts come by their least face, UV vertices by their chart. Faces that were set aside are in no
/// chart: each is a point in the plane, with a UV vertex for each corner, of that corner's vertex.
struct Atlas {
  Outcome outcome = Outcome::kOk;
  std::vector<Vec2> uvs;             ///< one per UV vertex, in the input's unit
  std::vector<Index> input_vertex;   ///< per UV vertex: the least of those welded
  std::vector<Triangle> faces;       ///< per face of the input: UV vertices of its corners
  std::vector<Index> chart_of_face;  ///< per face of the input, or kNone
  std::vector<bool> reversed;  ///< per face of the input: positive in the plane the other way round
  std::vector<ChartInfo> charts;
  AdmitCounts admitted;
  double area = 0;  ///< of the surface, in the input's unit squared
  AtlasEnergy energy;
  double seam_over_root_area = 0;       ///< each seam once, and no border of the surface
  AtlasCertificate certificate;         ///< of the numbers delivered
  AtlasCertificate single_certificate;  ///< of the single-precision numbers nearest to them
};

/// Cuts the surface into disks, flattens each and lays them out in rows. A chart that rounding to
/// single precision would fold is delivered in such numbers at once, mended. The same bits at any
/// number of threads; powers of two of the input's unit scale the UVs alone. A chart that fails is
/// named in its info; the others are not touched. Throws what admit does, Cancelled, or
/// std::bad_alloc.
Atlas unwrap(const std::vector<Vec3>& positions, const std::vector<Triangle>& faces,
             const AtlasOptions& options, const Work& work);

}  // namespace beltrami
