// Anybody's charts -> pages of a texture: packing without unwrapping.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/pages.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "pack/types.h"

namespace beltrami {

/// Triangles in the plane. Faces that share a UV vertex are of one chart.
struct UvMesh {
  std::vector<Vec2> uvs;
  std::vector<Triangle> faces;  ///< indices of `uvs`
  /// Per face its area on the surface: charts get the same texels for the same area. Empty: they
  /// keep the sizes that they have to each other.
  std::vector<double> areas = {};
  std::vector<bool> excepted = {};  ///< per face, whether it is not judged; empty: all are
  /// Per face the page on which its chart stays where it is, in [0, 1]^2, or kNone; empty: none
  /// stays. Equal for the faces of a chart.
  std::vector<Index> kept_page = {};
  /// Per face the turns of its chart, as PackChart has them; empty: 0. Equal for the faces of a
  /// chart.
  std::vector<int> own_turns = {};
  /// Per face the label of its chart: charts of different labels share no page; empty: all may. A
  /// chart has that of its least face. Not where charts stay.
  std::vector<std::uint64_t> page_labels = {};
};

struct PackedUvs {
  Outcome outcome = Outcome::kOk;
  std::vector<Vec2> uvs;             ///< one per UV vertex, in the plane of the pages (tile_of);
                                     ///< (0, 0) for those that no face uses
  std::vector<Index> page_of_uv;     ///< per UV vertex
  std::vector<Index> chart_of_face;  ///< charts by their least face with an area in the plane
  Pages pages;
  AtlasCertificate certificate;         ///< of the numbers delivered
  AtlasCertificate single_certificate;  ///< of the single-precision numbers nearest to them
};

/// Moves every chart by a rigid motion, none mirrored, and scales it as `areas` and `options` say.
/// Charts that are flipped, folded or lie on themselves stay so, as the certificate tells; what
/// rounding alone would fold of a disk is mended. Faces that run against most of their chart are
/// taken the other way round. Faces without area in the plane that have none on the surface either,
/// or hang together with no others, are no charts: unless they are to stay, corners of theirs that
/// are in no chart become points of the first one. With `float32` in single-precision numbers. With
/// charts that stay and no texels per unit, the others get the density of those. Throws Error
/// INVALID_ARGUMENT, with the face of `mesh`, which the sentence leaves to the caller, where faces
/// of a chart are to stay on different pages or beyond [0, 1]^2, NO_ROOM where charts do not fit,
/// and ZERO_AREA where there are none. Precondition: finite, indices in range.
PackedUvs pack_uvs(UvMesh mesh, const PackOptions& options, bool float32, const Work& work);

}  // namespace beltrami
