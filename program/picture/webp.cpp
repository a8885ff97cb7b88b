#include "picture/webp.h"

#include <cstddef>
#include <cstdint>

#ifdef BELTRAMI_WEBP
#include <webp/decode.h>
#endif

namespace beltrami::cli {

#ifdef BELTRAMI_WEBP

namespace {

std::optional<WebPBitstreamFeatures> features_of(std::string_view bytes) {
  WebPBitstreamFeatures features;
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  if (WebPGetFeatures(data, bytes.size(), &features) != VP8_STATUS_OK) return std::nullopt;
  if (features.has_animation != 0) return std::nullopt;
  return features;
}

}  // namespace

bool has_webp() {
  return true;
}

bool is_webp(std::string_view bytes) {
  return features_of(bytes).has_value();
}

std::optional<Pixels> read_webp(std::string_view bytes) {
  const std::optional<WebPBitstreamFeatures> features = features_of(bytes);
  if (!features) return std::nullopt;
  Pixels image{features->width, features->height, features->has_alpha != 0 ? 4 : 3, {}};
  image.values.resize(image.row_size() * static_cast<std::size_t>(image.height));
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto row = static_cast<int>(image.row_size());
  const auto decode = image.components == 4 ? WebPDecodeRGBAInto : WebPDecodeRGBInto;
  if (!decode(data, bytes.size(), image.values.data(), image.values.size(), row)) {
    return std::nullopt;
  }
  return image;
}

#else

bool has_webp() {
  return false;
}

bool is_webp(std::string_view) {
  return false;
}

std::optional<Pixels> read_webp(std::string_view) {
  return std::nullopt;
}

#endif

}  // namespace beltrami::cli
