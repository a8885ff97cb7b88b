// What beltrami_bake gives back: images for new UVs.
#ifndef BELTRAMI_CPP_BAKE_HPP
#define BELTRAMI_CPP_BAKE_HPP

#include <beltrami/beltrami.h>
#include <beltrami/cpp/config.hpp>
#include <beltrami/cpp/result.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

BELTRAMI_CPP_BEGIN

/// Images for new UVs, of numbers as those that were read have them.
template <class Number>
struct Baked {
  /// One page after another: rows from the top, of as many channels as the images; 0 where nothing
  /// is baked.
  std::vector<Number> pixels;
  std::vector<std::uint8_t> masks;  ///< per texel a BELTRAMI_TEXEL_ number
  std::uint64_t texels = 0;         ///< that a face covers, at least in part
  std::uint64_t without_source = 0;
  double old_texels = 0;  ///< of the images along the side of a new texel, in the mean
};

namespace detail {

/// The BELTRAMI_ number of a type of pixels.
template <class Number>
constexpr std::int32_t pixel_type() noexcept {
  static_assert(std::is_same_v<Number, std::uint8_t> || std::is_same_v<Number, std::uint16_t> ||
                    std::is_same_v<Number, float>,
                "pixels are std::uint8_t, std::uint16_t or float");
  return std::is_same_v<Number, std::uint8_t>    ? BELTRAMI_U8
         : std::is_same_v<Number, std::uint16_t> ? BELTRAMI_U16
                                                 : BELTRAMI_F32;
}

/// Makes room for the pages of a job; a failure where the job would not fit into any.
template <class Number>
std::optional<Failure> make_room(const beltrami_bake_job& job, Baked<Number>& baked) {
  constexpr std::uint64_t kMostTexels = 32768, kMostPages = 1000;
  if (job.images == nullptr || job.image_count == 0 || job.images[0].channels > 4) {
    return Failure(Status::kInvalidArgument, "there is no image of 1 to 4 channels");
  }
  if (job.images[0].type != pixel_type<Number>()) {
    return Failure(Status::kInvalidArgument, "the images are of another type than what is wanted");
  }
  if (job.resolution > kMostTexels || job.page_count > kMostPages) {
    return Failure(Status::kInvalidArgument, "the pages are more than 1000, or above 32768 texels");
  }
  const std::uint64_t texels = job.resolution * job.resolution * job.page_count;
  if (!has_room_for([&] {
        baked.pixels.resize(static_cast<std::size_t>(texels * job.images[0].channels));
        baked.masks.resize(static_cast<std::size_t>(texels));
      })) {
    return Failure(Status::kOutOfMemory);
  }
  return std::nullopt;
}

}  // namespace detail

BELTRAMI_CPP_END

#endif  // BELTRAMI_CPP_BAKE_HPP
