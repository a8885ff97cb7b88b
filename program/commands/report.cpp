#include "commands/report.h"
#include "commands/tiles.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <utility>

#include "files/mesh_file.h"
#include "process/system.h"

namespace beltrami::cli {
namespace {

/// Text by printf, for the summary: streams have no short way to align numbers.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  char line[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

void append_yes(const Report& report, std::string& text) {
  append(text, "injective  yes%s\n",
         !report.float32_injective   ? ""
         : *report.float32_injective ? " (also when rounded to float32)"
         : report.float32_possible.value_or(false)
             ? " (NOT when rounded to float32: give --float32 for that)"
             : " (NOT when rounded to float32: keep the UVs in double precision)");
}

void append_verdict(const Report& report, std::string& text) {
  const beltrami_certificate& found = *report.certificate;
  if (found.injective) {
    append_yes(report, text);
    return;
  }
  append(text, "injective  NO: %llu flipped, %llu of zero area, %llu boundary crossings",
         static_cast<unsigned long long>(found.negative),
         static_cast<unsigned long long>(found.degenerate),
         static_cast<unsigned long long>(found.boundary_crossings));
  if (found.first_bad_face != BELTRAMI_NO_ELEMENT) {
    append(text, "; first bad face %llu", static_cast<unsigned long long>(found.first_bad_face));
  }
  text += "\n";
}

/// " by the mean and the seams" where these are missed by the whole; "" where only parts miss them.
std::string missed_bounds(const beltrami_atlas& atlas, const Target& target) {
  constexpr double kTolerance = 1e-4;  // as the search has it
  const auto most_charts =
      std::max(static_cast<std::uint64_t>(std::max<std::int64_t>(target.charts, 0)),
               static_cast<std::uint64_t>(atlas.components));
  const std::pair<bool, const char*> bounds[] = {
      {atlas.symmetric_dirichlet > target.energy + kTolerance, "the mean"},
      {target.p99 > 0 && atlas.p99 > target.p99, "the 99th percentile"},
      {target.charts > 0 && atlas.charts > most_charts, "the charts"},
      {target.seams > 0 && seam_over_root_area(atlas) > target.seams, "the seams"}};
  std::string names;
  for (const auto& [is_missed, name] : bounds) {
    if (is_missed) names += (names.empty() ? " by " : " and ") + std::string(name);
  }
  // Over all it is met then.
  if (names.empty() && atlas.missed_parts > 0)
    return atlas.missed_parts == 1 ? " by a part" : " by parts";
  return names;
}

void append_atlas(const Report& report, std::string& text) {
  const beltrami_atlas& atlas = *report.atlas;
  append(text, "charts     %llu, seams of %.4g root areas\n",
         static_cast<unsigned long long>(atlas.charts), seam_over_root_area(atlas));
  append(text, "energy     %.6g mean, %.6g at the 99th percentile, %.6g max (2 is isometric)\n",
         atlas.symmetric_dirichlet, atlas.p99, atlas.max);
  if (atlas.slivers > 0) {
    append(text, "note       %llu %s of no area to speak of %s not count: with %s %.6g mean\n",
           static_cast<unsigned long long>(atlas.slivers),
           atlas.slivers == 1 ? "sliver" : "slivers", atlas.slivers == 1 ? "does" : "do",
           atlas.slivers == 1 ? "it" : "them", atlas.symmetric_dirichlet_with_slivers);
  }
  if (!report.target) return;
  const Target& target = *report.target;
  text +=
      "target     " + (atlas.reached != 0 ? "reached" : "MISSED" + missed_bounds(atlas, target));
  append(text, ": %.6g mean", target.energy);
  if (target.p99 > 0) append(text, ", %.6g at the 99th percentile", target.p99);
  if (target.charts > 0) append(text, ", charts up to %lld", static_cast<long long>(target.charts));
  if (target.seams > 0) append(text, ", seams up to %.4g root areas", target.seams);
  text += "\n";
  if (atlas.missed_parts > 0) {
    append(text,
           "note       %llu %s it, the worst with %.6g mean: %llu triangles from face %llu "
           "(counted from 0)\n",
           static_cast<unsigned long long>(atlas.missed_parts),
           atlas.missed_parts == 1 ? "part misses" : "parts miss", atlas.missed_energy,
           static_cast<unsigned long long>(atlas.missed_triangles),
           static_cast<unsigned long long>(atlas.missed_face));
  }
}

double asked_margin(const Report& report) {
  for (const auto& [name, value] : report.options) {
    if (name != "margin") continue;
    if (const double* texels = std::get_if<double>(&value)) return *texels;
  }
  return 0;
}

void append_packing(const Report& report, std::string& text) {
  const beltrami_packing& found = *report.packing;
  if (!report.atlas) {
    append(text, "charts     %llu\n", static_cast<unsigned long long>(found.charts));
  }
  append(text, "pages      %llu of %llu texels, %.1f%% used, margin %.3f texels",
         static_cast<unsigned long long>(found.pages),
         static_cast<unsigned long long>(found.resolution), 100 * found.utilisation, found.margin);
  // Of a surface that is small enough no double holds the density.
  if (std::isfinite(found.texels_per_unit)) append(text, ", %.4g per unit", found.texels_per_unit);
  text += "\n";
  for (const auto& [name, first, last] : report.label_pages) {
    append(text, "label      %llu", static_cast<unsigned long long>(kFirstTile + first));
    if (last > first) append(text, " to %llu", static_cast<unsigned long long>(kFirstTile + last));
    text += ": " + one_line(name) + "\n";
  }
  const double asked = asked_margin(report);
  if (found.margin < asked) {
    append(text,
           "note       the margin is less than the %.4g texels that were asked for: raise "
           "--resolution or lower --margin\n",
           asked);
  }
  if (report.tiny_charts > 0) {
    append(text, "note       %llu %s less than %.4g texels: raise --resolution\n",
           static_cast<unsigned long long>(report.tiny_charts),
           report.tiny_charts == 1 ? "chart has" : "charts have", kFewTexels);
  }
  if (found.splits == 0) return;
  append(text, "splits     %llu, of %.4g root areas: %.1f%% would be used without them\n",
         static_cast<unsigned long long>(found.splits), found.split_length,
         100 * found.unsplit_utilisation);
}

/// "1001", "1001 to 1004" or "1001, 1003 and 12 more".
std::string tiles_text(const std::vector<std::uint64_t>& tiles) {
  constexpr std::size_t kMost = 4;  // named one by one
  if (tiles.empty()) return "none";
  if (tiles.size() > 2 && tiles.back() - tiles.front() == tiles.size() - 1) {
    return std::to_string(tiles.front()) + " to " + std::to_string(tiles.back());
  }
  std::string text;
  for (std::size_t i = 0; i < std::min(tiles.size(), kMost); ++i) {
    text += (text.empty() ? "" : ", ") + std::to_string(tiles[i]);
  }
  if (tiles.size() > kMost) text += " and " + std::to_string(tiles.size() - kMost) + " more";
  return text;
}

void append_layout(const Report& report, std::string& text) {
  const PageLayout& found = *report.layout;
  append(text, "charts     %llu\n", static_cast<unsigned long long>(found.charts));
  append(text, "bounds     u from %.6g to %.6g, v from %.6g to %.6g\n", found.low[0], found.high[0],
         found.low[1], found.high[1]);
  text += "tiles      " + tiles_text(found.tiles);
  if (found.outside > 0) {
    append(text, "; %llu charts leave [0,1]^2, %llu the tiles of UDIM",
           static_cast<unsigned long long>(found.outside),
           static_cast<unsigned long long>(found.astride));
  }
  append(text, "\nmargin     %.3f texels at %llu a side: ", found.margin,
         static_cast<unsigned long long>(found.resolution));
  if (found.chart_distance) append(text, "%.3f between charts, ", *found.chart_distance);
  append(text, "%.3f to the edge of a page\n", found.edge_distance);
  if (found.density) {
    append(text, "density    %.4g texels per unit, charts from %.4g to %.4g; %.1f%% used\n",
           *found.density, found.least_density.value_or(0), found.greatest_density.value_or(0),
           100 * found.utilisation);
  }
  for (const Density& density : found.of_labels) {
    append(text, "density    %.4g texels per unit of ", density.texels_per_unit);
    text += one_line(density.name) + "\n";
  }
  for (const std::string& what : report.unmet) text += "unmet      " + what + "\n";
}

/// What had to be done to the input, where that is anything.
void append_admitted(const Report& report, std::string& text) {
  const beltrami_atlas& atlas = *report.atlas;
  struct Count {
    std::uint64_t count;
    const char *one, *several;
  };
  const Count counts[] = {
      {report.short_faces.value_or(0), "face of fewer than three corners",
       "faces of fewer than three corners"},
      {atlas.welded_vertices, "vertex welded", "vertices welded"},
      {atlas.unused_vertices, "vertex unused", "vertices unused"},
      {atlas.repeated_faces, "face with a vertex twice", "faces with a vertex twice"},
      {atlas.faces_without_area, "face without area", "faces without area"},
      {atlas.copies, "copy of a face", "copies of faces"},
      {atlas.crowded_edges, "edge of three faces or more", "edges of three faces or more"},
      {atlas.one_sided_edges, "edge of a one-sided surface", "edges of a one-sided surface"},
      {atlas.split_vertices, "vertex split", "vertices split"},
      {atlas.reversed_faces, "face turned over", "faces turned over"},
      {atlas.filled_holes, "hole filled", "holes filled"},
      {atlas.stacked_parts, "part stacked on another", "parts stacked on others"}};
  std::string line;
  for (const auto& [count, one, several] : counts) {
    if (count == 0) continue;
    line += (line.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : several);
  }
  if (!line.empty()) text += "admitted   " + line + "\n";
}

void append_atlas_verdict(const Report& report, std::string& text) {
  const beltrami_atlas_certificate& found = *report.atlas_certificate;
  if (found.injective != 0) {
    append_yes(report, text);
    return;
  }
  append(text, "injective  NO: %llu flipped, %llu of zero area, %llu overlaps",
         static_cast<unsigned long long>(found.negative),
         static_cast<unsigned long long>(found.degenerate),
         static_cast<unsigned long long>(found.overlaps));
  if (found.first_bad_face != BELTRAMI_NO_ELEMENT) {
    append(text, "; first bad face %llu", static_cast<unsigned long long>(found.first_bad_face));
  } else if (found.first_overlap[0] != BELTRAMI_NO_ELEMENT) {
    append(text, "; faces %llu and %llu overlap",
           static_cast<unsigned long long>(found.first_overlap[0]),
           static_cast<unsigned long long>(found.first_overlap[1]));
  }
  text += "\n";
}

void append_memory(const Report& report, std::string& text) {
  constexpr double kMebibyte = 1 << 20;
  const std::uint64_t peak = peak_memory_bytes();
  if (peak == 0 || !report.estimated_memory_bytes) return;
  append(text,
         "memory     %.0f MiB at the peak of the program; %.0f MiB were estimated for the run\n",
         static_cast<double>(peak) / kMebibyte,
         static_cast<double>(*report.estimated_memory_bytes) / kMebibyte);
}

void append_textures(const BakedCounts& counts, std::string& text) {
  text += "textures   " + std::to_string(counts.textures) + " baked, " +
          std::to_string(counts.texels) + " texels, " + std::to_string(counts.without_source) +
          " of them without a source\n";
}

}  // namespace

double seam_over_root_area(const beltrami_atlas& atlas) {
  // Without seams the area, which may be too small for a double, does not matter.
  return atlas.seam_length > 0 ? atlas.seam_length / std::sqrt(atlas.area) : 0;
}

const char* element_name(std::int32_t kind) {
  if (kind == BELTRAMI_ELEMENT_CORNER) return "corner";
  return kind == BELTRAMI_ELEMENT_FACE ? "face" : "vertex";
}

void Report::set_input(const MeshFile& file, const Surface& surface) {
  vertices = file.vertex_count();
  faces = file.polygons.size();
  triangles = surface.view().face_count();
  welded_vertices = file.welded_corners + surface.welded_vertices();
  short_faces = file.short_faces;
}

void Report::set_failure(const Failure& failure) {
  status = failure.status;
  message = failure.what();
  element_kind = failure.element_kind;
  element = failure.element;
}

std::string to_note(const Report& report, const std::string& written) {
  std::string lines;
  const auto add = [&](const std::string& text) {
    lines += one_line("beltrami: note: " + written + text) + "\n";
  };
  if (!report.not_kept.empty()) {
    std::string text = " does not keep ";
    for (std::size_t i = 0; i < report.not_kept.size(); ++i) {
      text += (i ? ", " : "") + report.not_kept[i];
    }
    add(text);
  }
  for (const std::string& note : report.notes) add(": " + note);
  return lines;
}

std::string to_summary(const Report& report, const std::string& written) {
  std::string text;
  append(text, "vertices   %llu\n", static_cast<unsigned long long>(report.vertices.value_or(0)));
  append(text, "faces      %llu\n", static_cast<unsigned long long>(report.faces.value_or(0)));
  if (report.triangles.value_or(0) != report.faces.value_or(0)) {
    append(text, "triangles  %llu\n", static_cast<unsigned long long>(*report.triangles));
  }
  if (report.welded_vertices.value_or(0) > 0) {
    append(text, "welded     %llu\n", static_cast<unsigned long long>(*report.welded_vertices));
  }
  if (report.energy && std::isfinite(report.energy->symmetric_dirichlet)) {
    append(text, "energy     %.6g mean, %.6g max (symmetric Dirichlet; 2 is isometric)\n",
           report.energy->symmetric_dirichlet, report.energy->max);
  }
  if (report.atlas) {
    append_admitted(report, text);
    append_atlas(report, text);
  }
  if (report.packing) append_packing(report, text);
  if (report.textures) append_textures(*report.textures, text);
  if (report.layout) append_layout(report, text);
  if (report.certificate) append_verdict(report, text);
  if (report.atlas_certificate) append_atlas_verdict(report, text);
  if (!report.failed_charts.empty()) {
    append(text, "note       %zu charts failed, the first at face %llu (counted from 0)\n",
           report.failed_charts.size(),
           static_cast<unsigned long long>(report.failed_charts.front().chart.first_face));
  }
  if (report.status == "BELTRAMI_NOT_INJECTIVE_FLOAT32") {
    // Charts that came overlapping are so in any numbers, and of which kind they are is not known.
    text +=
        report.command == "pack"
            ? "note       single precision is to blame, or charts that overlapped before: write "
              ".obj or .ply, without --float32\n"
            : "note       injective in double precision only: write .obj or .ply, without "
              "--float32\n";
  }
  if (report.result && report.result->degenerate_faces > 0) {
    append(text, "note       %llu faces have no area, the first is %llu (counted from 0)\n",
           static_cast<unsigned long long>(report.result->degenerate_faces),
           static_cast<unsigned long long>(report.result->first_degenerate_face));
  }
  if (report.result && report.result->delaunay_refused > 0) {
    append(text, "note       %llu edges are not Delaunay: flipping them would repeat an edge\n",
           static_cast<unsigned long long>(report.result->delaunay_refused));
  }
  if (report.status == "BELTRAMI_NOT_CONVERGED") {
    append(text, "note       stopped at a limit of iterations or time before it converged\n");
  }
  if (!report.advice.empty()) text += "note       " + report.advice + "\n";
  append(text, "time       %.2f s\n", report.seconds);
  append_memory(report, text);
  if (!written.empty()) text += "written    " + one_line(written) + "\n";
  return text;
}

void StageClock::finish() {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  const double cpu = static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
  report_.stages.push_back({name_, wall.count(), cpu, 0});
}

}  // namespace beltrami::cli
