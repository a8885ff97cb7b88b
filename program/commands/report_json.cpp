#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands/page_layout.h"
#include "commands/report.h"
#include "process/system.h"

namespace beltrami::cli {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json element(std::uint64_t index) {
  return index == BELTRAMI_NO_ELEMENT ? Json(nullptr) : Json(index);
}

template <class T>
Json optional(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json element_json(const Report& report) {
  if (report.element_kind == BELTRAMI_ELEMENT_NONE) return nullptr;
  return {{"kind", element_name(report.element_kind)}, {"index", element(report.element)}};
}

Json input_json(const Report& report) {
  return {
      {"path", report.input_path},
      {"vertices", optional(report.vertices)},
      {"faces", optional(report.faces)},
      {"triangles", optional(report.triangles)},
      {"boundary_edges", optional(report.boundary_edges)},
      {"area", report.area ? number(*report.area) : Json(nullptr)},
      {"unreferenced_vertices", optional(report.unreferenced_vertices)},
      {"degenerate_faces", report.result ? Json(report.result->degenerate_faces) : Json(nullptr)},
      {"first_degenerate_face",
       report.result ? element(report.result->first_degenerate_face) : Json(nullptr)},
      {"welded_vertices", optional(report.welded_vertices)},
      {"short_faces", optional(report.short_faces)}};
}

Json options_json(const Report& report) {
  Json options = Json::object();
  for (const auto& [name, value] : report.options) {
    std::visit([&, &key = name](const auto& known) { options[key] = known; }, value);
  }
  return options;
}

Json overlap_json(const beltrami_atlas_certificate& found) {
  if (found.first_overlap[0] == BELTRAMI_NO_ELEMENT) return nullptr;
  return {found.first_overlap[0], found.first_overlap[1]};
}

Json atlas_injective_json(const Report& report) {
  const beltrami_atlas_certificate& found = *report.atlas_certificate;
  return {{"result", found.injective != 0},
          {"positive", found.positive},
          {"negative", found.negative},
          {"degenerate", found.degenerate},
          {"excepted", found.excepted},
          {"mirrored_charts", found.mirrored_charts},
          {"mirrored_faces", found.mirrored_faces},
          {"overlaps", found.overlaps},
          {"first_overlap", overlap_json(found)},
          {"first_bad_face", element(found.first_bad_face)},
          {"touching_places", found.touching_places},
          {"float32", optional(report.float32_injective)}};
}

Json injective_json(const Report& report) {
  if (report.atlas_certificate) return atlas_injective_json(report);
  if (!report.certificate) return nullptr;
  const beltrami_certificate& found = *report.certificate;
  return {{"result", found.injective != 0},
          {"positive", found.positive},
          {"negative", found.negative},
          {"degenerate", found.degenerate},
          {"boundary_crossings", found.boundary_crossings},
          {"first_bad_face", element(found.first_bad_face)},
          {"float32", optional(report.float32_injective)}};
}

Json admitted_json(const Report& report) {
  if (!report.atlas) return nullptr;
  const beltrami_atlas& found = *report.atlas;
  return {{"area", number(found.area)},
          {"triangles", found.triangles},
          {"unused_vertices", found.unused_vertices},
          {"welded_vertices", found.welded_vertices},
          {"repeated_faces", found.repeated_faces},
          {"faces_without_area", found.faces_without_area},
          {"copies", found.copies},
          {"crowded_edges", found.crowded_edges},
          {"one_sided_edges", found.one_sided_edges},
          {"split_vertices", found.split_vertices},
          {"reversed_faces", found.reversed_faces},
          {"components", found.components},
          {"closed_components", found.closed_components},
          {"holes", found.holes},
          {"filled_holes", found.filled_holes},
          {"stacked_parts", found.stacked_parts}};
}

Json failed_charts_json(const Report& report) {
  if (!report.atlas) return nullptr;
  Json charts = Json::array();
  for (const auto& [index, chart] : report.failed_charts) {
    charts.push_back(
        {{"chart", index},
         {"first_face", chart.first_face},
         {"triangles", chart.triangles},
         {"status", beltrami_status_name(chart.status)},
         {"error", chart.error < 0 ? Json(beltrami_status_name(chart.error)) : Json(nullptr)}});
  }
  return charts;
}

Json atlas_energy_json(const beltrami_atlas& found) {
  return {{"symmetric_dirichlet", number(found.symmetric_dirichlet)},
          {"p99", number(found.p99)},
          {"max", number(found.max)},
          {"left_out", found.left_out},
          {"slivers", found.slivers},
          {"with_slivers", number(found.symmetric_dirichlet_with_slivers)},
          {"max_with_slivers", number(found.max_with_slivers)}};
}

Json energy_json(const Report& report) {
  if (report.atlas) return atlas_energy_json(*report.atlas);
  if (!report.energy) return nullptr;
  const beltrami_energy& found = *report.energy;
  return {{"symmetric_dirichlet", number(found.symmetric_dirichlet)},
          {"symmetric_arap", number(found.symmetric_arap)},
          {"max", number(found.max)},
          {"worst_face", element(found.worst_face)},
          {"left_out", found.left_out}};
}

Json target_json(const Report& report) {
  if (!report.atlas || !report.target) return nullptr;
  const beltrami_atlas& atlas = *report.atlas;
  Json worst = nullptr;
  if (atlas.missed_parts > 0) {
    worst = {{"first_face", atlas.missed_face},
             {"triangles", atlas.missed_triangles},
             {"energy", number(atlas.missed_energy)}};
  }
  return {{"energy", number(report.target->energy)},
          {"reached", atlas.reached != 0},
          {"missed_parts", atlas.missed_parts},
          {"worst_part", std::move(worst)}};
}

Json packing_json(const Report& report) {
  if (!report.packing) return nullptr;
  const beltrami_packing& found = *report.packing;
  Json labels = Json::array();
  for (const auto& [name, first, last] : report.label_pages) {
    labels.push_back({{"name", name}, {"first_page", first}, {"last_page", last}});
  }
  return {{"pages", found.pages},
          {"resolution", found.resolution},
          {"texels_per_unit", number(found.texels_per_unit)},
          {"utilisation", number(found.utilisation)},
          {"page_utilisations", report.page_utilisations},
          {"labels", std::move(labels)},
          {"margin", number(found.margin)},
          {"tiny_charts", report.atlas ? Json(report.tiny_charts) : Json(nullptr)},
          {"splits", found.splits},
          {"split_length", number(found.split_length)},
          {"unsplit_utilisation", number(found.unsplit_utilisation)}};
}

Json densities_json(const std::vector<Density>& densities) {
  Json all = Json::array();
  for (const Density& density : densities) {
    Json one = {{"first_face", density.first_face},
                {"area", number(density.area)},
                {"texels_per_unit", number(density.texels_per_unit)}};
    if (!density.name.empty()) one["name"] = density.name;
    all.push_back(std::move(one));
  }
  return all;
}

Json layout_json(const Report& report) {
  if (!report.layout) return nullptr;
  const PageLayout& found = *report.layout;
  return {
      {"bounds", {found.low[0], found.low[1], found.high[0], found.high[1]}},
      {"tiles", found.tiles},
      {"outside", found.outside},
      {"astride", found.astride},
      {"resolution", found.resolution},
      {"margin", number(found.margin)},
      {"chart_distance", found.chart_distance ? number(*found.chart_distance) : Json(nullptr)},
      {"edge_distance", number(found.edge_distance)},
      {"texels_per_unit", found.density ? number(*found.density) : Json(nullptr)},
      {"least_texels_per_unit", found.least_density ? number(*found.least_density) : Json(nullptr)},
      {"greatest_texels_per_unit",
       found.greatest_density ? number(*found.greatest_density) : Json(nullptr)},
      {"utilisation", number(found.utilisation)},
      {"charts", densities_json(found.of_charts)},
      {"labels", densities_json(found.of_labels)},
      {"unmet", report.unmet}};
}

Json charts_json(const Report& report) {
  if (report.layout) return report.layout->charts;
  if (report.atlas) return report.atlas->charts;
  return report.packing ? Json(report.packing->charts) : Json(nullptr);
}

Json utilisation_json(const Report& report) {
  if (report.atlas) return number(report.atlas->utilisation);
  return report.packing ? number(report.packing->utilisation) : Json(nullptr);
}

Json repair_json(const Report& report) {
  if (!report.result) return nullptr;
  const beltrami_result& run = *report.result;
  return {{"kernel_fixes", run.kernel_fixes},
          {"patch_fixes", run.patch_fixes},
          {"global_fixes", run.global_fixes},
          {"cleaned_patches", run.cleaned_patches},
          {"restarts", run.restarts},
          {"float32_moves", run.float32_moves},
          {"delaunay_flips", run.delaunay_flips},
          {"delaunay_refused", run.delaunay_refused}};
}

Json stages_json(const Report& report) {
  Json stages = Json::array();
  for (const StageTime& stage : report.stages) {
    stages.push_back({{"name", stage.name},
                      {"seconds", number(stage.seconds)},
                      {"cpu_seconds", number(stage.cpu_seconds)},
                      {"iterations", stage.iterations}});
  }
  return stages;
}

std::string library_version() {
  const std::uint32_t version = beltrami_version();
  return std::to_string(version / 1000000) + "." + std::to_string(version / 1000 % 1000) + "." +
         std::to_string(version % 1000);
}

Json textures_json(const Report& report) {
  if (!report.textures) return nullptr;
  const auto [textures, texels, without_source] = *report.textures;
  return {{"baked", textures}, {"texels", texels}, {"without_source", without_source}};
}

}  // namespace

std::string to_json(const Report& report) {
  const Json json = {
      {"schema", kReportSchema},
      {"version", library_version()},
      {"command", report.command},
      {"status", report.status},
      {"message", report.message.empty() ? Json(nullptr) : Json(report.message)},
      {"element", element_json(report)},
      {"input", input_json(report)},
      {"options", options_json(report)},
      {"admitted", admitted_json(report)},
      {"charts", charts_json(report)},
      {"failed_charts", failed_charts_json(report)},
      {"uv_vertices", report.atlas ? Json(report.atlas->uv_vertices) : Json(nullptr)},
      {"seam_over_root_area",
       report.atlas ? number(seam_over_root_area(*report.atlas)) : Json(nullptr)},
      {"seams", report.atlas ? Json(report.atlas->seams) : Json(nullptr)},
      {"target", target_json(report)},
      {"utilisation", utilisation_json(report)},
      {"packing", packing_json(report)},
      {"layout", layout_json(report)},
      {"textures", textures_json(report)},
      {"injective", injective_json(report)},
      {"energy", energy_json(report)},
      {"coarse_faces", optional(report.coarse_faces)},
      {"coarse_energy", report.result ? number(report.result->coarse_energy) : Json(nullptr)},
      {"flips_before_repair", optional(report.flips_before_repair)},
      {"repair", repair_json(report)},
      {"not_kept", report.not_kept},
      {"notes", report.notes},
      {"stages", stages_json(report)},
      {"seconds", number(report.seconds)},
      {"peak_memory_bytes", peak_memory_bytes()},
      {"estimated_memory_bytes", optional(report.estimated_memory_bytes)},
      {"threads", optional(report.threads)}};
  // Paths need not be UTF-8, but JSON must be.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace beltrami::cli
