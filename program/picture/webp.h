// WebP, where the program is built with libwebp.
#pragma once

#include <optional>
#include <string_view>

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

/// Whether the program is built with libwebp.
bool has_webp();

/// Whether read_webp may read this; never in a program that is built without libwebp.
bool is_webp(std::string_view bytes);

/// What a WebP file shows, 3 or 4 components of 8 bits; nothing where it is damaged. Of an
/// animation nothing either. Throws std::bad_alloc.
std::optional<Pixels> read_webp(std::string_view bytes);

}  // namespace beltrami::cli
