// The entry points that pack charts and hand out what lies on pages.
#include <beltrami/beltrami.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

#include "abi/buffers.h"
#include "abi/context.h"
#include "abi/packed.h"
#include "abi/reports.h"
#include "atlas/page_mask.h"
#include "atlas/pages.h"
#include "base/error.h"
#include "base/types.h"
#include "base/vectors.h"

namespace beltrami {
namespace {

beltrami_packing describe(const OnPages& result) {
  const Pages& pages = result.pages;
  beltrami_packing report{};
  report.status = status_of(result.outcome);
  report.charts = pages.page_of_chart.size();
  report.triangles = result.faces.size();
  report.pages = static_cast<std::uint64_t>(pages.count);
  report.resolution = static_cast<std::uint64_t>(pages.resolution);
  report.texels_per_unit = pages.texels_per_unit;
  report.utilisation = pages.utilisation;
  report.margin = pages.margin;
  report.seconds = result.seconds;
  report.cpu_seconds = result.cpu_seconds;
  report.unsplit_utilisation = pages.utilisation;
  if (pages.split && pages.split->count > 0) {
    report.splits = static_cast<std::uint64_t>(pages.split->count);
    report.split_length = pages.split->length;
    report.unsplit_utilisation = pages.split->before;
  }
  return report;
}

template <class Body>
beltrami_status get(beltrami_context* context, const Body& body) noexcept {
  return enter(context, [&](beltrami_context& self) {
    body(self.on_pages());
    return BELTRAMI_OK;
  });
}

/// The body of a getter of beltrami_pack: body(const PackedMeshes&, mesh).
template <class Body>
beltrami_status get_of_mesh(beltrami_context* context, std::uint64_t mesh,
                            const Body& body) noexcept {
  return enter(context, [&](beltrami_context& self) {
    const PackedMeshes& packed = self.packing();
    const std::size_t meshes = packed.first_uv.size() - 1;
    if (mesh >= meshes) {
      throw Error(Fault::kInvalidArgument, "there is no mesh " + std::to_string(mesh) +
                                               ": there are " + std::to_string(meshes) +
                                               ", counted from 0");
    }
    body(packed, static_cast<std::size_t>(mesh));
    return BELTRAMI_OK;
  });
}

void write_mask(const OnPages& result, std::uint64_t page, std::uint8_t* out,
                std::uint64_t stride) {
  const Pages& pages = result.pages;
  const auto side = static_cast<std::size_t>(pages.resolution);
  if (page >= static_cast<std::uint64_t>(pages.count)) {
    throw Error(Fault::kInvalidArgument, "there is no page " + std::to_string(page) +
                                             ": there are " + std::to_string(pages.count) +
                                             ", counted from 0");
  }
  if (out == nullptr) throw Error(Fault::kInvalidArgument, "the memory to write to is NULL");
  const std::uint64_t most = std::numeric_limits<std::size_t>::max() / side;
  if (stride != 0 && (stride < side || stride > most)) {
    throw Error(Fault::kInvalidArgument, "a stride of " + std::to_string(stride) +
                                             " bytes holds no row of " + std::to_string(side) +
                                             " texels: give 0 or more than that");
  }
  const std::size_t step = stride == 0 ? side : static_cast<std::size_t>(stride);
  const std::vector<Texel> texels =
      page_mask(result.faces, result.uvs, result.chart_of_face, pages, static_cast<Index>(page));
  static_assert(static_cast<int>(Texel::kFree) == BELTRAMI_TEXEL_FREE);
  static_assert(static_cast<int>(Texel::kGutter) == BELTRAMI_TEXEL_GUTTER);
  static_assert(static_cast<int>(Texel::kCovered) == BELTRAMI_TEXEL_COVERED);
  for (std::size_t row = 0; row < side; ++row) {
    std::memcpy(out + row * step, texels.data() + row * side, side);
  }
}

}  // namespace
}  // namespace beltrami

using beltrami::get;
using beltrami::get_of_mesh;
using beltrami::OnPages;

beltrami_status beltrami_pack(beltrami_context* context, const beltrami_uv_mesh* const* meshes,
                              uint64_t mesh_count, beltrami_progress progress, void* user) {
  return beltrami::enter(context, [&](beltrami_context& self) {
    return self.pack(meshes, mesh_count, progress, user);
  });
}

beltrami_status beltrami_get_packing(beltrami_context* context, beltrami_packing* out) {
  return get(context, [&](const OnPages& result) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(result));
  });
}

beltrami_status beltrami_get_page_utilisations(beltrami_context* context, void* out, int32_t type,
                                               uint64_t stride) {
  return get(context, [&](const OnPages& result) {
    const std::vector<double>& shares = result.pages.page_utilisation;
    beltrami::Writer writer(out, type, stride, shares.size(), 1);
    for (std::size_t i = 0; i < shares.size(); ++i) writer.write(i, &shares[i]);
  });
}

beltrami_status beltrami_get_chart_pages(beltrami_context* context, void* out, int32_t type,
                                         uint64_t stride) {
  return get(context, [&](const OnPages& result) {
    beltrami::write_integers(result.pages.page_of_chart, 1, out, type, stride);
  });
}

beltrami_status beltrami_get_packing_certificate(beltrami_context* context, int32_t type,
                                                 beltrami_atlas_certificate* out) {
  return get(context, [&](const OnPages& result) {
    beltrami::require_sized(out, "out");
    if (type != BELTRAMI_F32 && type != BELTRAMI_F64) {
      throw beltrami::Error(
          beltrami::Fault::kInvalidArgument,
          "the type is " + std::to_string(type) + ": give BELTRAMI_F32 or BELTRAMI_F64");
    }
    beltrami::write_sized(out,
                          beltrami::describe_atlas(type == BELTRAMI_F32 ? result.single_certificate
                                                                        : result.certificate));
  });
}

beltrami_status beltrami_get_page_mask(beltrami_context* context, uint64_t page, uint8_t* out,
                                       uint64_t stride) {
  return get(context,
             [&](const OnPages& result) { beltrami::write_mask(result, page, out, stride); });
}

beltrami_status beltrami_get_packed_uvs(beltrami_context* context, uint64_t mesh, void* out,
                                        int32_t type, uint64_t stride) {
  return get_of_mesh(context, mesh, [&](const beltrami::PackedMeshes& packed, std::size_t m) {
    const beltrami::Index first = packed.first_uv[m], end = packed.first_uv[m + 1];
    beltrami::Writer writer(out, type, stride, static_cast<std::uint64_t>(end - first), 2);
    for (beltrami::Index v = first; v < end; ++v) {
      const beltrami::Vec2 place =
          packed.result.uvs[v] - beltrami::tile_of(packed.result.page_of_uv[v]);
      writer.write(static_cast<std::size_t>(v - first), place.data());
    }
  });
}

beltrami_status beltrami_get_packed_charts(beltrami_context* context, uint64_t mesh, void* out,
                                           int32_t type, uint64_t stride) {
  return get_of_mesh(context, mesh, [&](const beltrami::PackedMeshes& packed, std::size_t m) {
    const auto& all = packed.result.chart_of_face;
    const std::vector<beltrami::Index> own(all.begin() + packed.first_face[m],
                                           all.begin() + packed.first_face[m + 1]);
    beltrami::write_integers(own, 1, out, type, stride);
  });
}
