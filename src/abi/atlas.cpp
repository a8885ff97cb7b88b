// The entry points that make an atlas and hand it out.
#include <beltrami/beltrami.h>
#include <algorithm>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "abi/buffers.h"
#include "abi/context.h"
#include "abi/failure.h"
#include "abi/reports.h"
#include "abi/unwrapped.h"
#include "admit/admit.h"
#include "atlas/atlas.h"
#include "base/error.h"
#include "base/types.h"

namespace beltrami {
namespace {

std::uint64_t count(std::int64_t number) {
  return static_cast<std::uint64_t>(number);
}

void describe_admitted(beltrami_atlas& report, const AdmitCounts& counts) {
  report.unused_vertices = count(counts.unused_vertices);
  report.welded_vertices = count(counts.welded_vertices);
  report.repeated_faces = count(counts.repeated_faces);
  report.faces_without_area = count(counts.faces_without_area);
  report.copies = count(counts.copies);
  report.crowded_edges = count(counts.crowded_edges);
  report.one_sided_edges = count(counts.one_sided_edges);
  report.split_vertices = count(counts.split_vertices);
  report.reversed_faces = count(counts.reversed_faces);
  report.components = count(counts.components);
  report.closed_components = count(counts.closed_components);
  report.holes = count(counts.holes);
}

void describe_missed(const Unwrapped& result, beltrami_atlas& report) {
  const std::vector<MissedTarget>& missed = result.atlas.missed;
  report.missed_parts = missed.size();
  report.missed_face = BELTRAMI_NO_ELEMENT;
  if (missed.empty()) return;
  const auto worst = std::max_element(missed.begin(), missed.end(),
                                      [](const MissedTarget& a, const MissedTarget& b) {
                                        return a.symmetric_dirichlet < b.symmetric_dirichlet;
                                      });
  report.missed_face = result.face_of(worst->first_face);
  report.missed_triangles = count(worst->faces);
  report.missed_energy = worst->symmetric_dirichlet;
}

beltrami_atlas describe(const Unwrapped& result) {
  const Atlas& atlas = result.atlas;
  beltrami_atlas report{};
  report.status = status_of(atlas.outcome);
  report.vertices = result.vertices;
  report.faces = result.faces;
  report.corners = result.uv_vertex.size();
  report.triangles = result.triangles.size();
  report.charts = atlas.charts.size();
  report.uv_vertices = result.uvs.size();
  describe_admitted(report, atlas.admitted);
  report.filled_holes = count(atlas.filled_holes);
  report.stacked_parts = count(atlas.stacked_parts);
  report.left_out = count(atlas.energy.left_out);
  report.area = atlas.area;
  report.seam_length = atlas.seam_length;
  report.utilisation = atlas.utilisation;
  report.symmetric_dirichlet = atlas.energy.symmetric_dirichlet;
  report.p99 = atlas.energy.p99;
  report.max = atlas.energy.max;
  report.seconds = result.seconds;
  report.cpu_seconds = result.cpu_seconds;
  report.peak_memory_bytes = result.peak_memory_bytes;
  report.seams = result.seams.size() / 2;
  report.searched = result.searched ? 1 : 0;
  report.reached = result.reached ? 1 : 0;
  report.pages = atlas.pages ? count(atlas.pages->count) : 0;
  report.slivers = count(atlas.energy.slivers);
  report.symmetric_dirichlet_with_slivers = atlas.energy.mean_with_slivers;
  report.max_with_slivers = atlas.energy.max_with_slivers;
  describe_missed(result, report);
  return report;
}

beltrami_chart describe(const Unwrapped& result, std::size_t index) {
  const Atlas& atlas = result.atlas;
  const ChartInfo& chart = atlas.charts[index];
  beltrami_chart report{};
  if (atlas.pages) report.page = count(atlas.pages->page_of_chart[index]);
  report.status = status_of(chart.outcome);
  report.error = chart.error ? status_of(*chart.error) : BELTRAMI_OK;
  report.triangles = count(chart.faces);
  report.first_face = result.face_of(chart.first_face);
  report.area = chart.area;
  report.density = chart.density;
  report.symmetric_dirichlet = chart.symmetric_dirichlet;
  report.max = chart.max;
  for (int k = 0; k < 2; ++k) {
    report.box[k] = chart.box.min()[k];
    report.box[2 + k] = chart.box.max()[k];
  }
  return report;
}

/// The body of a getter of an atlas: body(const Unwrapped&) writes.
template <class Body>
beltrami_status get(beltrami_context* context, const Body& body) noexcept {
  return enter(context, [&](beltrami_context& self) {
    body(self.atlas());
    return BELTRAMI_OK;
  });
}

/// Calls value(i) for each of `items` UVs and writes them.
template <class Value>
void write_uvs(void* out, std::int32_t type, std::uint64_t stride, std::size_t items,
               const Value& value) {
  Writer writer(out, type, stride, items, 2);
  for (std::size_t i = 0; i < items; ++i) writer.write(i, value(i).data());
}

template <class Item>
[[noreturn]] void refuse_index(const char* what, Item index, std::size_t size) {
  throw Error(Fault::kInvalidArgument, std::string("there is no ") + what + " " +
                                           std::to_string(index) + ": there are " +
                                           std::to_string(size) + ", counted from 0");
}

}  // namespace
}  // namespace beltrami

using beltrami::get;
using beltrami::Unwrapped;

beltrami_status beltrami_unwrap(beltrami_context* context, const beltrami_surface* surface,
                                beltrami_progress progress, void* user) {
  return beltrami::enter(
      context, [&](beltrami_context& self) { return self.unwrap(&surface, 1, progress, user); });
}

beltrami_status beltrami_unwrap_surfaces(beltrami_context* context,
                                         const beltrami_surface* const* surfaces,
                                         uint64_t surface_count, beltrami_progress progress,
                                         void* user) {
  return beltrami::enter(context, [&](beltrami_context& self) {
    return self.unwrap(surfaces, surface_count, progress, user);
  });
}

beltrami_status beltrami_get_atlas(beltrami_context* context, beltrami_atlas* out) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::require_sized(out, "out");
    beltrami::write_sized(out, beltrami::describe(result));
  });
}

beltrami_status beltrami_get_chart(beltrami_context* context, uint64_t index, beltrami_chart* out) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::require_sized(out, "out");
    const auto& charts = result.atlas.charts;
    if (index >= charts.size()) beltrami::refuse_index("chart", index, charts.size());
    beltrami::write_sized(out, beltrami::describe(result, index));
  });
}

beltrami_status beltrami_get_atlas_certificate(beltrami_context* context, int32_t type,
                                               beltrami_atlas_certificate* out) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::require_sized(out, "out");
    if (type != BELTRAMI_F32 && type != BELTRAMI_F64) {
      throw beltrami::Error(
          beltrami::Fault::kInvalidArgument,
          "the type is " + std::to_string(type) + ": give BELTRAMI_F32 or BELTRAMI_F64");
    }
    const beltrami::Atlas& atlas = result.atlas;
    beltrami_atlas_certificate report = beltrami::describe_atlas(
        type == BELTRAMI_F32 ? atlas.single_certificate : atlas.certificate);
    beltrami::name_faces(report, [&](beltrami::Index t) { return result.face_of(t); });
    beltrami::write_sized(out, report);
  });
}

beltrami_status beltrami_get_corner_uvs(beltrami_context* context, void* out, int32_t type,
                                        uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_uvs(out, type, stride, result.uv_vertex.size(),
                        [&](std::size_t i) { return result.uvs[result.uv_vertex[i]]; });
  });
}

beltrami_status beltrami_get_corner_pages(beltrami_context* context, void* out, int32_t type,
                                          uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    std::vector<beltrami::Index> pages(result.uv_vertex.size(), 0);
    for (std::size_t c = 0; c < pages.size() && result.atlas.pages; ++c) {
      pages[c] = result.page[result.uv_vertex[c]];
    }
    beltrami::write_integers(pages, 1, out, type, stride);
  });
}

beltrami_status beltrami_get_corner_uv_vertices(beltrami_context* context, void* out, int32_t type,
                                                uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_integers(result.uv_vertex, 1, out, type, stride);
  });
}

beltrami_status beltrami_get_uv_vertices(beltrami_context* context, void* out, int32_t type,
                                         uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_uvs(out, type, stride, result.uvs.size(),
                        [&](std::size_t i) { return result.uvs[i]; });
  });
}

beltrami_status beltrami_get_uv_vertex_origins(beltrami_context* context, void* out, int32_t type,
                                               uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_integers(result.origin, 1, out, type, stride);
  });
}

beltrami_status beltrami_get_face_charts(beltrami_context* context, void* out, int32_t type,
                                         uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_integers(result.chart_of_face, 1, out, type, stride);
  });
}

beltrami_status beltrami_get_seams(beltrami_context* context, void* out, int32_t type,
                                   uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_integers(result.seams, 2, out, type, stride);
  });
}

beltrami_status beltrami_get_triangles(beltrami_context* context, void* out, int32_t type,
                                       uint64_t stride) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::write_integers(beltrami::flat(result.triangles), 3, out, type, stride);
  });
}

int32_t beltrami_atlas_stage_count(const beltrami_context* context) {
  if (context == nullptr || !context->unwrapped) return 0;
  return static_cast<int32_t>(context->unwrapped->atlas.stages.size());
}

beltrami_status beltrami_get_atlas_stage(beltrami_context* context, int32_t index,
                                         beltrami_stage* out) {
  return get(context, [&](const Unwrapped& result) {
    beltrami::require_sized(out, "out");
    const auto& stages = result.atlas.stages;
    if (index < 0 || static_cast<std::size_t>(index) >= stages.size()) {
      beltrami::refuse_index("stage", index, stages.size());
    }
    beltrami::write_sized(out, beltrami::describe_stage(stages[static_cast<std::size_t>(index)]));
  });
}
