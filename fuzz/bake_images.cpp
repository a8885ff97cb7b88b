// Images through old UVs and new ones, as a host asks for them: of any type, reading and size, on
// several pages, and from another surface. What shows is between the texels that it is made of.
#include <beltrami/beltrami.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <vector>

#include "host.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

constexpr std::uint64_t kNoPage = std::numeric_limits<std::uint64_t>::max();

std::size_t size_of_type(std::int32_t type) {
  return type == BELTRAMI_U8 ? 1 : type == BELTRAMI_U16 ? 2 : 4;
}

double number_at(const std::vector<char>& bytes, std::int32_t type, std::size_t at) {
  if (type == BELTRAMI_U8) return static_cast<unsigned char>(bytes[at]);
  if (type == BELTRAMI_U16) {
    std::uint16_t value = 0;
    std::memcpy(&value, &bytes[2 * at], sizeof value);
    return value;
  }
  float value = 0;
  std::memcpy(&value, &bytes[4 * at], sizeof value);
  return value;
}

/// Images of one type, without a byte between their rows.
struct Images {
  std::int32_t type = BELTRAMI_U8;
  std::uint32_t channels = 1;
  std::vector<std::vector<char>> bytes;
  std::vector<beltrami_image> views;

  explicit Images(Provider& data) {
    constexpr std::array kTypes = {BELTRAMI_U8, BELTRAMI_U16, BELTRAMI_F32};
    type = data.PickValueInArray(kTypes);
    channels = data.ConsumeIntegralInRange(1u, 4u);
    bytes.resize(data.ConsumeIntegralInRange(1u, 2u));
    for (std::vector<char>& image : bytes) {
      const auto width = data.ConsumeIntegralInRange<std::uint64_t>(1, 9);
      const auto height = data.ConsumeIntegralInRange<std::uint64_t>(1, 9);
      const std::size_t count = width * height * channels;
      image.resize(count * size_of_type(type));
      for (std::size_t i = 0; i < count; ++i) {
        const auto number = data.ConsumeIntegral<std::uint8_t>();
        const auto put = [&](auto value) {
          std::memcpy(&image[i * sizeof value], &value, sizeof value);
        };
        if (type == BELTRAMI_U8) put(number);
        if (type == BELTRAMI_U16) put(static_cast<std::uint16_t>(257 * number));
        if (type == BELTRAMI_F32) put(static_cast<float>(number) / 64);
      }
      views.push_back({image.data(), width, height, 0, type, channels});
    }
  }

  /// The least and the greatest number of a channel.
  std::array<double, 2> range(std::uint32_t channel) const {
    std::array<double, 2> out = {1e300, -1e300};
    for (const std::vector<char>& image : bytes) {
      for (std::size_t i = channel; i < image.size() / size_of_type(type); i += channels) {
        const double x = number_at(image, type, i);
        out = {std::min(out[0], x), std::max(out[1], x)};
      }
    }
    return out;
  }
};

/// Numbers of corners; now and then one of them is none.
std::vector<double> of_corners(Provider& data, std::size_t count, double most) {
  std::vector<double> out(count);
  for (double& x : out) x = most * data.ConsumeIntegralInRange(0, 16) / 16;
  if (data.ConsumeIntegralInRange(0, 15) == 0) {
    constexpr std::array kOdd = {std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(), 1e300, -1e18, 1e-310};
    out[data.ConsumeIntegralInRange<std::size_t>(0, count - 1)] = data.PickValueInArray(kOdd);
  }
  return out;
}

std::vector<std::uint64_t> pages(Provider& data, std::size_t count, std::uint64_t pages) {
  std::vector<std::uint64_t> out(count);
  for (std::uint64_t& page : out) {
    page = data.ConsumeIntegralInRange<std::uint64_t>(0, pages);
    if (page == pages && data.ConsumeIntegralInRange(0, 7) != 0) page = kNoPage;
  }
  return out;
}

/// All that a job reads.
struct Scene {
  Images images;
  std::uint64_t faces, source_faces = 0;
  std::vector<double> new_uvs, old_uvs, positions, normals, tangents, source;
  std::vector<std::uint64_t> new_pages, old_pages;
  beltrami_bake_job job = sized<beltrami_bake_job>();

  explicit Scene(Provider& data)
      : images(data), faces(data.ConsumeIntegralInRange<std::uint64_t>(1, 5)) {
    job.pixels = data.ConsumeIntegralInRange(0, 3);
    job.filter = data.ConsumeIntegralInRange(0, 1);
    job.wrap_u = data.ConsumeIntegralInRange(0, 2);
    job.wrap_v = data.ConsumeIntegralInRange(0, 2);
    job.resolution = data.ConsumeIntegralInRange<std::uint64_t>(1, 24);
    job.gutter = data.ConsumeBool() ? kNoPage : data.ConsumeIntegralInRange<std::uint64_t>(0, 5);
    job.page_count = data.ConsumeIntegralInRange<std::uint64_t>(1, 2);
    const bool elsewhere = data.ConsumeIntegralInRange(0, 2) == 0;
    if (elsewhere) source_faces = data.ConsumeIntegralInRange<std::uint64_t>(1, 4);
    const std::uint64_t shown = elsewhere ? source_faces : faces;
    new_uvs = of_corners(data, 6 * faces, 1);
    old_uvs = of_corners(data, 6 * shown, data.ConsumeBool() ? 1 : 5);
    if (data.ConsumeBool()) new_pages = pages(data, faces, job.page_count);
    if (data.ConsumeBool()) old_pages = pages(data, shown, images.views.size());
    if (elsewhere || job.pixels == BELTRAMI_PIXELS_NORMALS || data.ConsumeBool()) {
      positions = of_corners(data, 9 * faces, 1);
    }
    if (elsewhere) source = of_corners(data, 9 * source_faces, 1);
    if (data.ConsumeIntegralInRange(0, 3) == 0) normals = of_corners(data, 9 * faces, 1);
    if (data.ConsumeIntegralInRange(0, 3) == 0) tangents = of_corners(data, 12 * faces, 1);
    fill();
    if (data.ConsumeIntegralInRange(0, 3) == 0) look_along_rays(data);
    if (data.ConsumeIntegralInRange(0, 15) == 0) spoil(data);
  }

 private:
  void look_along_rays(Provider& data) {
    if (source_faces > 0) job.cage = data.ConsumeIntegralInRange(-1, 8) / 8.0;
    if (data.ConsumeBool()) return;
    job.pixels = BELTRAMI_PIXELS_OCCLUSION;
    job.rays = data.ConsumeIntegralInRange<std::uint64_t>(0, 4);
    if (data.ConsumeIntegralInRange(0, 7) != 0) job.image_count = 1;
  }

  /// Numbers that no job has.
  void spoil(Provider& data) {
    switch (data.ConsumeIntegralInRange(0, 7)) {
      case 0:
        images.views[0].type = -1;
        break;
      case 1:
        images.views[0].stride = 1;
        break;
      case 2:
        // Of one image it would be the host's word, which is not checked.
        if (images.views.size() > 1) images.views.back().channels = images.channels % 4 + 1;
        break;
      case 3:
        job.pixels = 77;
        break;
      case 4:
        job.rays = 5000;
        break;
      case 5:
        job.cage = -1;
        break;
      case 6:
        job.page_count = 0;
        break;
      default:
        job.gutter = 1 << 20;
    }
  }

  static beltrami_buffer pages_view(const std::vector<std::uint64_t>& pages) {
    return {pages.empty() ? nullptr : pages.data(), 0, BELTRAMI_U64, 0};
  }
  void fill() {
    job.images = images.views.data();
    job.image_count = images.views.size();
    job.face_count = faces;
    job.new_uvs = view(new_uvs);
    job.old_uvs = view(old_uvs);
    job.new_pages = pages_view(new_pages);
    job.old_pages = pages_view(old_pages);
    job.positions = view(positions);
    job.normals = view(normals);
    job.tangents = view(tangents);
    job.source_face_count = source_faces;
    job.source_positions = view(source);
  }
};

/// Room of exactly the size that a job asks for.
struct Room {
  std::vector<char> pixels;
  std::vector<std::uint8_t> masks;
  beltrami_baked baked = sized<beltrami_baked>();

  explicit Room(const Scene& scene) {
    const beltrami_bake_job& job = scene.job;
    const std::size_t texels = job.page_count * job.resolution * job.resolution;
    pixels.assign(texels * scene.images.channels * size_of_type(scene.images.type), 0);
    masks.assign(texels, 77);
    baked.pixels = pixels.data();
    baked.masks = masks.data();
  }
};

void judge(const Scene& scene, const Room& room) {
  const beltrami_baked& baked = room.baked;
  std::uint64_t covered = 0;
  for (const std::uint8_t texel : room.masks) {
    promise(texel <= BELTRAMI_TEXEL_COVERED, "a mask says what a texel is");
    covered += texel == BELTRAMI_TEXEL_COVERED;
  }
  promise(baked.texels == covered + baked.without_source,
          "texels with a source are counted as the mask has them");
  promise(std::isfinite(baked.old_texels) && baked.old_texels >= 0, "a density is a number");
  // A sky's share has no texel, and a normal's parts are those of another frame.
  const bool turned = scene.job.pixels == BELTRAMI_PIXELS_OCCLUSION ||
                      (scene.job.pixels == BELTRAMI_PIXELS_NORMALS && scene.images.channels >= 3);
  const std::int32_t type = scene.images.type;
  // A unit of whole numbers, and the rounding of single precision in and out of linear light.
  const double rounding = type == BELTRAMI_U16 ? 16 : 1;
  for (std::uint32_t channel = 0; channel < scene.images.channels; ++channel) {
    const auto [least, most] = scene.images.range(channel);
    const double slack = type == BELTRAMI_F32 ? 1e-4 * (1 + std::abs(most)) : rounding;
    for (std::size_t i = channel; i < room.masks.size() * scene.images.channels;
         i += scene.images.channels) {
      const double x = number_at(room.pixels, type, i);
      promise(std::isfinite(x), "what is baked is a number");
      if (turned || x == 0) continue;
      promise(x >= least - slack && x <= most + slack,
              "what is baked is between the texels of its images");
    }
  }
}

}  // namespace

void run_one(std::string_view bytes) {
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const Scene scene(data);
  Room room(scene), again(scene);
  const Context context = make_context();
  beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 1);
  int polls = data.ConsumeIntegralInRange(0, 200) + 3;
  const beltrami_status status =
      beltrami_bake(context.get(), &scene.job, &room.baked, count_down, &polls);
  judge_status(context.get(), status);
  if (status != BELTRAMI_OK) return;
  judge(scene, room);
  if (data.ConsumeIntegralInRange(0, 3) != 0) return;
  beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 2);
  promise(beltrami_bake(context.get(), &scene.job, &again.baked, nullptr, nullptr) == BELTRAMI_OK,
          "two threads end as one does");
  promise(room.pixels == again.pixels && room.masks == again.masks,
          "two threads give the bits of one");
}

}  // namespace beltrami::fuzz
