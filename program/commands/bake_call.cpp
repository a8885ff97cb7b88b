#include "commands/bake_call.h"

#include <algorithm>
#include <cstddef>

#include "commands/command.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

std::int32_t pixels_of(Meaning meaning) {
  switch (meaning) {
    case Meaning::kColours:
      return BELTRAMI_PIXELS_SRGB;
    case Meaning::kTransparent:
      return BELTRAMI_PIXELS_SRGB_ALPHA;
    case Meaning::kDirections:
      return BELTRAMI_PIXELS_NORMALS;
    case Meaning::kNumbers:
    case Meaning::kRelief:
      break;
  }
  return BELTRAMI_PIXELS_LINEAR;
}

std::int32_t wrap_of(Beyond beyond) {
  switch (beyond) {
    case Beyond::kClamp:
      return BELTRAMI_WRAP_CLAMP;
    case Beyond::kMirror:
      return BELTRAMI_WRAP_MIRROR;
    case Beyond::kRepeat:
      break;
  }
  return BELTRAMI_WRAP_REPEAT;
}

beltrami_image view_of(const Pixels& image) {
  return {image.values.data(),
          static_cast<std::uint64_t>(image.width),
          static_cast<std::uint64_t>(image.height),
          0,
          image.bytes == 4   ? BELTRAMI_F32
          : image.bytes == 2 ? BELTRAMI_U16
                             : BELTRAMI_U8,
          static_cast<std::uint32_t>(image.components)};
}

beltrami_buffer numbers(const std::vector<double>& values) {
  return {values.empty() ? nullptr : values.data(), 0, BELTRAMI_F64, 0};
}

beltrami_buffer integers(const std::vector<std::uint64_t>& values) {
  return {values.empty() ? nullptr : values.data(), 0, BELTRAMI_U64, 0};
}

}  // namespace

beltrami_bake_job BakeCall::job(const std::vector<beltrami_image>& views) const {
  beltrami_bake_job job{};
  job.struct_size = sizeof job;
  job.images = views.data();
  job.image_count = views.size();
  job.pixels = rays > 0 ? BELTRAMI_PIXELS_OCCLUSION : pixels_of(meaning);
  job.filter = reading.nearest ? BELTRAMI_FILTER_NEAREST : BELTRAMI_FILTER_LINEAR;
  job.wrap_u = wrap_of(reading.along_u);
  job.wrap_v = wrap_of(reading.along_v);
  job.face_count = new_uvs.size() / 6;
  job.new_uvs = numbers(new_uvs);
  job.new_pages = integers(new_pages);
  job.old_uvs = numbers(old_uvs);
  job.old_pages = integers(old_pages);
  job.positions = numbers(positions);
  job.normals = numbers(normals);
  job.tangents = numbers(tangents);
  job.source_face_count = source_positions.size() / 9;
  job.source_positions = numbers(source_positions);
  job.resolution = static_cast<std::uint64_t>(side);
  job.gutter = gutter;
  job.page_count = page_count;
  job.cage = cage;
  job.rays = rays;
  job.cancel = interrupt_number();
  return job;
}

BakeOutcome BakeCall::run(beltrami_context* context, const std::string& name,
                          const BakeProgress& progress) {
  // Of a page that no triangle is on any image will do.
  const auto known = std::find_if(images.begin(), images.end(),
                                  [](const Pixels& image) { return !image.values.empty(); });
  std::vector<beltrami_image> views;
  for (const Pixels& image : images)
    views.push_back(view_of(image.values.empty() ? *known : image));
  Pixels all;
  all.width = side;
  all.height = static_cast<int>(page_count) * side;
  all.components = known->components;
  all.bytes = known->bytes;
  const bool half = known->half;
  pages.assign(page_count, {});
  const std::size_t size = all.row_size() * static_cast<std::size_t>(side);
  all.values.resize(size * page_count);
  beltrami_baked baked{};
  baked.struct_size = sizeof baked;
  baked.pixels = all.values.data();
  const auto tell = [](void* user, double fraction, const char*) -> std::int32_t {
    const auto& told = *static_cast<const BakeProgress*>(user);
    if (told) told(fraction);
    return interrupted();
  };
  const beltrami_bake_job asked = job(views);
  const auto user = const_cast<BakeProgress*>(&progress);
  const beltrami_status status =
      new_uvs.empty() ? BELTRAMI_OK : beltrami_bake(context, &asked, &baked, tell, user);
  throw_if_interrupted();
  if (2 * baked.without_source <= baked.texels) {
    require_ok(status, name, beltrami_error_message(context), beltrami_error_element_kind(context),
               beltrami_error_element(context));
  }
  for (std::size_t i = 0; i < pages.size(); ++i) {
    pages[i].width = pages[i].height = side;
    pages[i].components = all.components;
    pages[i].bytes = all.bytes;
    pages[i].half = half;
    if (pages.size() == 1) {
      pages[i].values = std::move(all.values);
    } else {
      const auto first = all.values.begin() + static_cast<std::ptrdiff_t>(i * size);
      pages[i].values.assign(first, first + static_cast<std::ptrdiff_t>(size));
    }
  }
  return {baked.texels, baked.without_source, baked.old_texels};
}

}  // namespace beltrami::cli
