#include "bake/bake.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "bake/axes_turn.h"
#include "bake/gutters.h"
#include "bake/texture.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "mesh/closest_point.h"

namespace beltrami {
namespace {

/// Of the size of the other surface: how far what a texel shows may be from it.
constexpr double kReach = 0.02;
/// Of the work on a page: baking, before its gutters.
constexpr double kBaking = 0.8;

double area_of(const UvTriangle& t, double width, double height) {
  return std::abs((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) -
                  (t[2][0] - t[0][0]) * (t[1][1] - t[0][1])) /
         2 * width * height;
}

/// The triangles of one page.
struct OfPage {
  std::vector<UvTriangle> triangles;  // in texels
  std::vector<SourceTriangle> sources;
  std::vector<AxesTurn> turns;
  std::vector<std::size_t> numbers;
};

class Bake {
 public:
  Bake(const BakeProblem& problem, const Work& work) : problem_(problem) {
    for (const ImageView& image : problem.images) {
      textures_.emplace_back(image, problem.kind, tables_, work);
    }
    if (problem.kind == ImageKind::kDirections) find_turns(work);
    if (reads_surface()) find_surface();
  }

  BakedTexels bake_one(std::uint32_t page, const PageRoom& room, std::span<Filled> filled,
                       const Work& work) {
    const OfPage of = triangles_of(page);
    std::vector<std::uint8_t> seams;
    PageBake job;
    job.triangles = of.triangles;
    if (reads_surface()) {
      job.source_of = [&](std::size_t t, const std::array<double, 3>& weights, std::size_t& hint) {
        return source(of.numbers[t], weights, hint);
      };
    } else {
      job.sources = of.sources;
      seams = inner_seams(of.triangles, of.sources);
      job.seams = seams;
    }
    job.turns = of.turns;
    job.pages = textures_;
    job.reading = problem_.reading;
    job.side = problem_.side;
    const BakedTexels texels = bake_page(job, room, filled, work.part(0, kBaking));
    fill_gutters(room, filled, problem_.rings, work.part(kBaking, 1));
    return texels;
  }

  double old_texels() const {
    if (reads_surface()) return 0;
    double before = 0, after = 0;
    for (std::size_t t = 0; t < problem_.new_uvs.size(); ++t) {
      const SourceTriangle& source = problem_.sources[t];
      if (problem_.new_pages[t] == kNoPage || source.page == kNoPage) continue;
      const ImageView& image = problem_.images[source.page];
      before += area_of(source.uvs, image.width, image.height);
      after += area_of(problem_.new_uvs[t], problem_.side, problem_.side);
    }
    return after > 0 ? std::sqrt(before / after) : 0;
  }

 private:
  /// Whether texels are read by the nearest places of another surface.
  bool reads_surface() const { return !problem_.source_places.empty(); }

  /// Its triangles that are finite: of others no place is the nearest.
  void find_surface() {
    for (std::size_t t = 0; t < problem_.source_places.size(); ++t) {
      const std::array<Vec3, 3>& places = problem_.source_places[t];
      const auto is_finite = [](const Vec3& place) { return place.allFinite(); };
      if (!std::all_of(places.begin(), places.end(), is_finite)) continue;
      const Index first = size_of(positions_);
      positions_.insert(positions_.end(), places.begin(), places.end());
      faces_.push_back({first, first + 1, first + 2});
      numbers_.push_back(t);
    }
    if (!faces_.empty()) surface_.emplace(positions_, faces_);
  }

  void find_turns(const Work& work) {
    std::vector<double> old_uvs, new_uvs;
    for (std::size_t t = 0; t < problem_.new_uvs.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t d = 0; d < 2; ++d) {
          old_uvs.push_back(problem_.sources[t].uvs[k][d]);
          new_uvs.push_back(problem_.new_uvs[t][k][d]);
        }
      }
    }
    turns_ = axes_turns({problem_.positions, problem_.normals, problem_.tangents, old_uvs, new_uvs},
                        work);
  }

  OfPage triangles_of(std::uint32_t page) const {
    OfPage of;
    PollSometimes poll;
    for (std::size_t t = 0; t < problem_.new_uvs.size(); ++t) {
      poll();
      if (problem_.new_pages[t] != page) continue;
      UvTriangle& triangle = of.triangles.emplace_back(problem_.new_uvs[t]);
      for (auto& corner : triangle) {
        for (double& x : corner) x *= problem_.side;
      }
      if (reads_surface()) {
        of.numbers.push_back(t);
      } else {
        of.sources.push_back(problem_.sources[t]);
      }
      if (!turns_.empty()) of.turns.push_back(turns_[t]);
    }
    return of;
  }

  /// Where the images have what a point of a triangle shows, by the nearest place of the other
  /// surface.
  std::optional<TexelSource> source(std::size_t triangle, const std::array<double, 3>& weights,
                                    std::size_t& hint) const {
    if (!surface_) return std::nullopt;
    std::array<Vec3, 3> place;
    Vec3 point(0, 0, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      place[k] = Vec3(&problem_.positions[9 * triangle + 3 * k]);
      point += weights[k] * place[k];
    }
    const Vec3 normal = (place[1] - place[0]).cross(place[2] - place[0]);
    const Index seed = hint < faces_.size() ? static_cast<Index>(hint) : kNone;
    const SurfacePoint at = surface_->find_within(point, normal, kReach * surface_->size(), seed);
    if (at.face == kNone) return std::nullopt;
    hint = static_cast<std::size_t>(at.face);
    const SourceTriangle& shown = problem_.sources[numbers_[hint]];
    if (shown.page == kNoPage) return std::nullopt;
    TexelSource source{shown.page, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      source.u += at.barycentric[k] * shown.uvs[k][0];
      source.v += at.barycentric[k] * shown.uvs[k][1];
    }
    return source;
  }

  const BakeProblem& problem_;
  const ColourTables tables_;
  std::vector<Texture> textures_;
  std::vector<AxesTurn> turns_;
  std::vector<Vec3> positions_;  // of the other surface, three for each triangle
  std::vector<Triangle> faces_;
  std::vector<std::size_t> numbers_;  // of these triangles among all of it
  std::optional<ClosestPoint> surface_;
};

}  // namespace

BakeReport bake(const BakeProblem& problem, std::span<const PageRoom> rooms,
                std::span<Filled> masks, const Work& work) {
  Bake baking(problem, work);
  BakeReport report;
  const std::size_t texels =
      static_cast<std::size_t>(problem.side) * static_cast<std::size_t>(problem.side);
  std::vector<Filled> own(masks.empty() ? texels : 0);
  for (std::size_t page = 0; page < rooms.size(); ++page) {
    const Work part =
        work.part(double(page) / double(rooms.size()), double(page + 1) / double(rooms.size()));
    const BakedTexels found = baking.bake_one(
        static_cast<std::uint32_t>(page), rooms[page],
        masks.empty() ? std::span<Filled>(own) : masks.subspan(page * texels, texels), part);
    report.texels.covered += found.covered;
    report.texels.without_source += found.without_source;
  }
  report.old_texels = baking.old_texels();
  work.report(1);
  return report;
}

}  // namespace beltrami
