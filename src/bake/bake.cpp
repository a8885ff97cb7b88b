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
#include "bake/other_surface.h"
#include "bake/texture.h"
#include "base/interrupt.h"
#include "base/vectors.h"

namespace beltrami {
namespace {

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
    if (sees_sky()) directions_ = sky_directions(static_cast<std::size_t>(problem.rays));
    if (!problem.source_places.empty()) {
      surface_.emplace(problem.source_places);
    } else if (sees_sky()) {
      const std::vector<std::array<Vec3, 3>> own = own_places();
      surface_.emplace(own);
    }
  }

  BakedTexels bake_one(std::uint32_t page, const PageRoom& room, std::span<Filled> filled,
                       const Work& work) {
    const OfPage of = triangles_of(page);
    std::vector<std::uint8_t> seams;
    PageBake job;
    job.triangles = of.triangles;
    if (shows_points()) {
      job.show = [&](std::size_t t, const std::array<double, 3>& weights, int part,
                     std::size_t& hint, TexelSums& sums) {
        return show({of.numbers[t], weights}, part, hint, sums);
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
    if (shows_points()) return 0;
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
  bool sees_sky() const { return problem_.kind == ImageKind::kOcclusion; }
  /// Whether texels are shown by places in space, and not through old UVs.
  bool shows_points() const { return sees_sky() || !problem_.source_places.empty(); }

  std::vector<std::array<Vec3, 3>> own_places() const {
    std::vector<std::array<Vec3, 3>> places(problem_.new_uvs.size());
    for (std::size_t t = 0; t < places.size(); ++t) places[t] = corners_of(t);
    return places;
  }

  std::array<Vec3, 3> corners_of(std::size_t triangle) const {
    const double* at = &problem_.positions[9 * triangle];
    return {Vec3(at), Vec3(at + 3), Vec3(at + 6)};
  }

  void find_turns(const Work& work) {
    std::vector<double> old_uvs, new_uvs;
    PollSometimes poll;
    for (std::size_t t = 0; t < problem_.new_uvs.size(); ++t) {
      poll();
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
      if (shows_points()) {
        of.numbers.push_back(t);
      } else {
        of.sources.push_back(problem_.sources[t]);
      }
      if (!turns_.empty()) of.turns.push_back(turns_[t]);
    }
    return of;
  }

  /// Adds what the place of the surface shows that a point of a triangle stands for.
  bool show(const PointOfTriangle& point, int part, std::size_t& hint, TexelSums& sums) const {
    const std::optional<PointOfTriangle> found =
        problem_.source_places.empty() ? point : find(point, hint);
    if (!found) return false;
    if (sees_sky()) {
      // The parts of a texel look into their share of the directions each.
      const bool whole = part == kWholeTexel;
      const double open = surface_->open_share(
          *found, directions_, whole ? 0 : static_cast<std::size_t>(part) % directions_.size(),
          whole ? 1 : kPartsOfTexel);
      for (float& sum : sums) sum += 2 * textures_.front().zero() * static_cast<float>(open);
      return true;
    }
    const SourceTriangle& shown = problem_.sources[found->triangle];
    if (shown.page == kNoPage) return false;
    Place place;
    for (std::size_t k = 0; k < 3; ++k) {
      place.u += found->weights[k] * shown.uvs[k][0];
      place.v += found->weights[k] * shown.uvs[k][1];
    }
    textures_[shown.page].add({&place, 1}, problem_.reading, 0, {&sums, 1});
    return true;
  }

  std::optional<PointOfTriangle> find(const PointOfTriangle& of, std::size_t& hint) const {
    const std::array<Vec3, 3> corners = corners_of(of.triangle);
    LookFrom from;
    from.point = Vec3(0, 0, 0);
    for (std::size_t k = 0; k < 3; ++k) from.point += of.weights[k] * corners[k];
    from.face_normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    from.direction = Vec3(0, 0, 0);
    for (std::size_t k = 0; k < 3 && !problem_.normals.empty(); ++k) {
      const Vec3 normal(&problem_.normals[9 * of.triangle + 3 * k]);
      from.direction += of.weights[k] * normal;
    }
    const double length = from.direction.norm();
    const bool given = length > 0 && std::isfinite(length);
    from.direction = given ? Vec3(from.direction / length) : from.face_normal.normalized();
    return surface_->find(from, problem_.cage, hint);
  }

  const BakeProblem& problem_;
  const ColourTables tables_;
  std::vector<Texture> textures_;
  std::vector<AxesTurn> turns_;
  std::vector<Vec3> directions_;         // to the sky
  std::optional<OtherSurface> surface_;  // another one, or what hides the sky
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
