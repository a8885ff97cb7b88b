// From the caller's UV meshes to what the packer takes, and back.
#pragma once

#include <beltrami/beltrami.h>

#include <cstdint>
#include <vector>

#include "abi/unwrapped.h"
#include "atlas/pack_uvs.h"
#include "atlas/pages.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "chart/flattening.h"
#include "exact/atlas_certificate.h"
#include "pack/types.h"

namespace beltrami {

/// What beltrami_pack leaves behind: all meshes in one list.
struct PackedMeshes {
  PackedUvs result;
  std::vector<Triangle> faces;
  std::vector<Index> first_uv, first_face;  ///< per mesh, and the count of all
  double seconds = 0, cpu_seconds = 0;
};

/// What lies on pages, whoever put it there.
struct OnPages {
  const Pages& pages;
  Outcome outcome;
  const std::vector<Triangle>& faces;  ///< indices of `uvs`
  const std::vector<Vec2>& uvs;        ///< in the plane of the pages
  const std::vector<Index>& chart_of_face;
  const AtlasCertificate& certificate;
  const AtlasCertificate& single_certificate;
  double seconds, cpu_seconds;
};
OnPages on_pages(const PackedMeshes& packed);
/// Precondition: the atlas is packed.
OnPages on_pages(const Unwrapped& unwrapped);

/// Copies the meshes' counts with the caller's sizes checked. Throws Error INVALID_ARGUMENT or
/// EMPTY.
std::vector<beltrami_uv_mesh> read_uv_headers(const beltrami_uv_mesh* const* meshes,
                                              std::uint64_t count);

/// Reads meshes that have passed read_uv_headers, and packs them. Throws Error INVALID_ARGUMENT,
/// INDEX_OUT_OF_RANGE or NON_FINITE with the element and a sentence that names the mesh where there
/// are several, NO_ROOM, or Cancelled.
PackedMeshes pack_meshes(const std::vector<beltrami_uv_mesh>& headers, const PackOptions& options,
                         bool float32, const Work& work);

}  // namespace beltrami
