// Pictures of light and of lengths, in single precision: Radiance HDR, and OpenEXR where the
// program is built with it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// What the extension of a path says of a picture in single precision.
enum class LightFormat { kNone, kHdr, kExr };
LightFormat light_format_of(const std::string& path);

/// Whether the program is built with OpenEXR.
bool has_exr();

/// What an HDR or EXR file shows, 1 to 4 components of 4 bytes; nothing where it is none, or is
/// damaged. Of an EXR file R, G and B are read, or else Y, with A; or the only
/// channel.
std::optional<Pixels> read_light(std::string_view bytes);

/// The bytes of a file. HDR has three components, of positive numbers alone. Precondition: the
/// image has components of 4 bytes, and the program can write the format. Throws std::bad_alloc.
std::string light_bytes(const Pixels& image, LightFormat format);

}  // namespace beltrami::cli
