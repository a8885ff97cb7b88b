#include "abi/bake_job.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "abi/buffers.h"
#include "bake/gutters.h"
#include "bake/image.h"
#include "base/error.h"

namespace beltrami {
namespace {

constexpr std::uint64_t kMostFaces = 700'000'000;
constexpr std::uint64_t kMostRays = 4096;
constexpr std::uint64_t kMostTexelsOfImage = 65536, kMostTexelsOfPage = 32768, kMostPages = 1000;
constexpr std::uint64_t kAllBits = std::numeric_limits<std::uint64_t>::max();

[[noreturn]] void refuse(const std::string& message) {
  throw Error(Fault::kInvalidArgument, message);
}

void require_between(std::uint64_t value, std::uint64_t least, std::uint64_t most,
                     const char* what) {
  if (value >= least && value <= most) return;
  refuse(std::string(what) + " is " + std::to_string(value) + ": give " + std::to_string(least) +
         " to " + std::to_string(most));
}

void require_choice(std::int32_t value, std::int32_t last, const char* what) {
  if (value >= 0 && value <= last) return;
  refuse("the field `" + std::string(what) + "` is " + std::to_string(value) +
         ", which is none of its numbers");
}

PixelType type_of(std::int32_t type) {
  switch (type) {
    case BELTRAMI_U8:
      return PixelType::kByte;
    case BELTRAMI_U16:
      return PixelType::kShort;
    case BELTRAMI_F32:
      return PixelType::kFloat;
    default:
      refuse("the type of an image is " + std::to_string(type) +
             ": give BELTRAMI_U8, BELTRAMI_U16 or BELTRAMI_F32");
  }
}

/// Bytes of a row, where rows of `texels` are `stride` bytes apart.
std::size_t row_bytes_of(std::uint64_t stride, std::uint64_t texels, std::uint64_t rows,
                         std::uint64_t texel_bytes, const char* what) {
  const std::uint64_t least = texels * texel_bytes;
  if (stride == 0) stride = least;
  if (stride < least || stride > std::numeric_limits<std::size_t>::max() / 2 / rows) {
    refuse("a stride of " + std::to_string(stride) + " bytes holds no row of " + what +
           ": give 0, or " + std::to_string(least) + " or more");
  }
  return static_cast<std::size_t>(stride);
}

ImageView view_of(const beltrami_image& image, std::int32_t pixels) {
  require_between(image.channels, 1, 4, "the number of channels of an image");
  ImageView view;
  view.type = type_of(image.type);
  if (pixels == BELTRAMI_PIXELS_OCCLUSION) {
    view.width = view.height = 1;
    view.components = static_cast<int>(image.channels);
    return view;
  }
  if (image.pixels == nullptr) refuse("the pixels of an image are NULL");
  require_between(image.width, 1, kMostTexelsOfImage, "the width of an image");
  require_between(image.height, 1, kMostTexelsOfImage, "the height of an image");
  view.pixels = static_cast<const unsigned char*>(image.pixels);
  view.width = static_cast<int>(image.width);
  view.height = static_cast<int>(image.height);
  view.components = static_cast<int>(image.channels);
  view.row_bytes = row_bytes_of(image.stride, image.width, image.height,
                                image.channels * bytes_of(view.type), "an image");
  return view;
}

Beyond beyond_of(std::int32_t wrap) {
  return wrap == BELTRAMI_WRAP_CLAMP    ? Beyond::kClamp
         : wrap == BELTRAMI_WRAP_MIRROR ? Beyond::kMirror
                                        : Beyond::kRepeat;
}

ImageKind kind_of(std::int32_t pixels) {
  switch (pixels) {
    case BELTRAMI_PIXELS_SRGB:
      return ImageKind::kColours;
    case BELTRAMI_PIXELS_SRGB_ALPHA:
      return ImageKind::kTransparent;
    case BELTRAMI_PIXELS_NORMALS:
      return ImageKind::kDirections;
    case BELTRAMI_PIXELS_OCCLUSION:
      return ImageKind::kOcclusion;
    default:
      return ImageKind::kNumbers;
  }
}

void require_finite(const std::vector<double>& values, std::size_t width, const char* what) {
  const auto bad = std::find_if(values.begin(), values.end(),
                                [](double value) { return !std::isfinite(value); });
  if (bad == values.end()) return;
  const auto corner = static_cast<std::uint64_t>(bad - values.begin()) / width;
  throw Error(Fault::kNonFinite,
              std::string(what) + " of corner " + std::to_string(corner) + " is not finite",
              Element::corner(corner));
}

std::vector<UvTriangle> triangles_of(const std::vector<double>& uvs) {
  std::vector<UvTriangle> triangles(uvs.size() / 6);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      triangles[t][k] = {uvs[6 * t + 2 * k], uvs[6 * t + 2 * k + 1]};
    }
  }
  return triangles;
}

std::vector<std::uint32_t> read_pages(const beltrami_buffer& buffer, std::uint64_t faces,
                                      std::uint64_t pages, const char* what, const Work& work) {
  std::vector<std::uint32_t> found(static_cast<std::size_t>(faces), 0);
  if (buffer.data == nullptr) return found;
  const std::vector<std::uint64_t> given = read_integers(buffer, faces, 1, what, work);
  const std::uint64_t none = all_bits_of(buffer.type);
  for (std::size_t f = 0; f < given.size(); ++f) {
    if (given[f] == none) {
      found[f] = kNoPage;
    } else if (given[f] >= pages) {
      throw Error(Fault::kInvalidArgument,
                  "face " + std::to_string(f) + " has the number " + std::to_string(given[f]) +
                      " in the " + what + ", and there are " + std::to_string(pages) +
                      ", counted from 0",
                  Element::face(f));
    } else {
      found[f] = static_cast<std::uint32_t>(given[f]);
    }
  }
  return found;
}

/// Old UVs of greater numbers are no place: doubles tell no texels apart there.
constexpr double kFarthest = 1e15;

std::vector<SourceTriangle> read_sources(const beltrami_bake_job& job, std::uint64_t faces,
                                         const Work& work) {
  const std::vector<UvTriangle> uvs =
      triangles_of(read_numbers(job.old_uvs, 3 * faces, 2, "old UVs", work));
  const std::vector<std::uint32_t> pages =
      read_pages(job.old_pages, faces, job.image_count, "old pages", work);
  std::vector<SourceTriangle> sources(uvs.size());
  for (std::size_t t = 0; t < uvs.size(); ++t) {
    const bool is_there = std::all_of(uvs[t].begin(), uvs[t].end(), [](const auto& uv) {
      return std::abs(uv[0]) <= kFarthest && std::abs(uv[1]) <= kFarthest;
    });
    sources[t].page = is_there ? pages[t] : kNoPage;
    if (is_there) sources[t].uvs = uvs[t];
  }
  return sources;
}

/// What looks along rays.
void require_rays(const beltrami_bake_job& job) {
  if (job.pixels == BELTRAMI_PIXELS_OCCLUSION) {
    require_between(job.rays, 1, kMostRays, "rays");
    require_between(job.image_count, 1, 1, "image_count of OCCLUSION");
  } else if (job.rays != 0) {
    refuse("rays are for OCCLUSION: leave them at 0");
  }
  if (!(job.cage >= 0 && std::isfinite(job.cage))) {
    refuse("the cage is negative or not finite: give 0, or a length above it");
  }
  if (job.cage > 0 && job.source_positions.data == nullptr) {
    refuse("a cage is for another surface: give source_positions, or leave it at 0");
  }
}

}  // namespace

beltrami_bake_job read_bake_header(const beltrami_bake_job* theirs) {
  const beltrami_bake_job job = read_sized(theirs, "job");
  if (job.flags != 0) refuse("the field `flags` of job is not 0");
  if (job.face_count == 0) throw Error(Fault::kEmpty, "there are no faces to bake for");
  require_between(job.face_count, 1, kMostFaces, "face_count");
  require_between(job.image_count, 1, kMostPages, "image_count");
  require_between(job.page_count, 1, kMostPages, "page_count");
  require_between(job.resolution, 1, kMostTexelsOfPage, "resolution");
  require_choice(job.pixels, BELTRAMI_PIXELS_OCCLUSION, "pixels");
  require_choice(job.filter, BELTRAMI_FILTER_NEAREST, "filter");
  require_choice(job.wrap_u, BELTRAMI_WRAP_MIRROR, "wrap_u");
  require_choice(job.wrap_v, BELTRAMI_WRAP_MIRROR, "wrap_v");
  if (job.images == nullptr) refuse("the images are NULL");
  for (std::uint64_t i = 0; i < job.image_count; ++i) {
    const ImageView image = view_of(job.images[i], job.pixels),
                    first = view_of(job.images[0], job.pixels);
    if (image.type != first.type || image.components != first.components) {
      refuse("image " + std::to_string(i) + " has another type or other channels than image 0");
    }
  }
  require_rays(job);
  const bool normals = job.pixels == BELTRAMI_PIXELS_NORMALS;
  if (normals && job.images[0].channels < 3) refuse("an image of normals has 3 or 4 channels");
  if (job.source_positions.data != nullptr) {
    if (normals)
      refuse("images of normals are baked for the same faces: leave out source_positions");
    require_between(job.source_face_count, 1, kMostFaces, "source_face_count");
  }
  return job;
}

BakeRoom room_of(const beltrami_bake_job& job, const beltrami_baked* out) {
  const beltrami_baked given = read_sized(out, "out");
  if (given.pixels == nullptr) refuse("the pixels to write to are NULL");
  const ImageView image = view_of(job.images[0], job.pixels);
  const auto components = static_cast<std::uint64_t>(image.components);
  PageRoom page;
  page.side = static_cast<int>(job.resolution);
  page.components = image.components;
  page.type = image.type;
  page.row_bytes = row_bytes_of(given.stride, job.resolution, job.page_count * job.resolution,
                                components * bytes_of(image.type), "a page");
  BakeRoom room;
  const auto side = static_cast<std::size_t>(job.resolution);
  for (std::size_t i = 0; i < job.page_count; ++i) {
    page.pixels = static_cast<unsigned char*>(given.pixels) + i * side * page.row_bytes;
    room.pages.push_back(page);
  }
  static_assert(static_cast<int>(Filled::kNothing) == BELTRAMI_TEXEL_FREE);
  static_assert(static_cast<int>(Filled::kGutter) == BELTRAMI_TEXEL_GUTTER);
  static_assert(static_cast<int>(Filled::kBaked) == BELTRAMI_TEXEL_COVERED);
  if (given.masks != nullptr) {
    room.masks = {reinterpret_cast<Filled*>(given.masks), room.pages.size() * side * side};
  }
  return room;
}

BakeProblem read_bake_problem(const beltrami_bake_job& job, const Work& work) {
  BakeProblem problem;
  for (std::uint64_t i = 0; i < job.image_count; ++i) {
    problem.images.push_back(view_of(job.images[i], job.pixels));
  }
  problem.kind = kind_of(job.pixels);
  problem.reading = {beyond_of(job.wrap_u), beyond_of(job.wrap_v),
                     job.filter == BELTRAMI_FILTER_NEAREST};
  problem.side = static_cast<int>(job.resolution);
  problem.rings = job.gutter == kAllBits
                      ? kWholePage
                      : static_cast<int>(std::min<std::uint64_t>(job.gutter, kMostTexelsOfPage));
  const std::uint64_t corners = 3 * job.face_count;
  const std::vector<double> new_uvs = read_numbers(job.new_uvs, corners, 2, "new UVs", work);
  require_finite(new_uvs, 2, "the new UV");
  problem.new_uvs = triangles_of(new_uvs);
  problem.new_pages = read_pages(job.new_pages, job.face_count, job.page_count, "new pages", work);
  const bool elsewhere = job.source_positions.data != nullptr;
  const bool occlusion = problem.kind == ImageKind::kOcclusion;
  if (!occlusion) {
    problem.sources = read_sources(job, elsewhere ? job.source_face_count : job.face_count, work);
  }
  problem.cage = job.cage;
  problem.rays = static_cast<int>(job.rays);
  const bool normals = problem.kind == ImageKind::kDirections;
  if (!normals && !elsewhere && !occlusion) return problem;
  problem.positions = read_numbers(job.positions, corners, 3, "positions", work);
  require_finite(problem.positions, 3, "the position");
  if (elsewhere) {
    const std::vector<double> places =
        read_numbers(job.source_positions, 3 * job.source_face_count, 3, "source positions", work);
    problem.source_places.resize(places.size() / 9);
    for (std::size_t i = 0; i < places.size(); ++i) {
      problem.source_places[i / 9][i % 9 / 3][i % 3] = places[i];
    }
  }
  if ((normals || job.cage > 0) && job.normals.data != nullptr) {
    problem.normals = read_numbers(job.normals, corners, 3, "normals", work);
  }
  if (normals && job.tangents.data != nullptr) {
    problem.tangents = read_numbers(job.tangents, corners, 4, "tangents", work);
  }
  return problem;
}

void write_baked(const BakeReport& report, double seconds, double cpu_seconds,
                 beltrami_baked* out) {
  beltrami_baked told = read_sized(out, "out");
  told.texels = report.texels.covered;
  told.without_source = report.texels.without_source;
  told.old_texels = report.old_texels;
  told.seconds = seconds;
  told.cpu_seconds = cpu_seconds;
  write_sized(out, told);
}

void require_sources(const BakeReport& report) {
  const auto& [covered, without] = report.texels;
  if (2 * without <= covered) return;
  refuse(std::to_string(without) + " of " + std::to_string(covered) +
         " texels have no source: the old UVs are not finite there, or no face of the source is "
         "near that looks the same way");
}

}  // namespace beltrami
