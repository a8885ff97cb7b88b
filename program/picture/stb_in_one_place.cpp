#include <cstdlib>
#include <limits>
#include <memory>
#include <new>

namespace {

/// stb's own use of malloc writes through null pointers where memory runs out. The blocks of a call
/// that ends so are lost; the program ends, too.
void* allocate(std::size_t size) {
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* reallocate(void* old, std::size_t size) {
  if (void* memory = std::realloc(old, size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// The stb headers carry code that does not pass our warnings: it is compiled here and only here.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wshadow"
#endif
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_JPEG
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_MALLOC(size) allocate(size)
#define STBI_REALLOC(old, size) reallocate(old, size)
#define STBI_FREE(old) std::free(old)
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STBIW_MALLOC(size) allocate(size)
#define STBIW_REALLOC(old, size) reallocate(old, size)
#define STBIW_FREE(old) std::free(old)
#include <stb_easy_font.h>
#include <stb_image.h>
#include <stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "picture/stb_in_one_place.h"

namespace beltrami::cli {

std::string png_bytes(int width, int height, int components, const std::uint8_t* pixels) {
  std::string bytes;
  const auto append = [](void* target, void* data, int size) {
    static_cast<std::string*>(target)->append(static_cast<const char*>(data),
                                              static_cast<std::size_t>(size));
  };
  stbi_write_png_to_func(append, &bytes, width, height, components, pixels, components * width);
  return bytes;
}

bool is_image(std::string_view bytes) {
  // More texels than 16384 x 16384 would be gigabytes, which a small file may ask for.
  constexpr double kMostTexels = 268435456;
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
  int width = 0, height = 0, components = 0;
  return stbi_info_from_memory(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                               static_cast<int>(bytes.size()), &width, &height, &components) != 0 &&
         double(width) * height <= kMostTexels;
}

std::optional<Pixels> read_image(std::string_view bytes) {
  if (!is_image(bytes)) return std::nullopt;
  Pixels image;
  std::uint8_t* pixels = stbi_load_from_memory(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                               static_cast<int>(bytes.size()), &image.width,
                                               &image.height, &image.components, 0);
  if (pixels == nullptr) return std::nullopt;
  const std::unique_ptr<std::uint8_t, void (*)(void*)> owner(pixels, &std::free);
  image.values.assign(pixels, pixels + image.row_size() * static_cast<std::size_t>(image.height));
  return image;
}

std::vector<TextQuad> text_quads(const std::string& text) {
  struct Corner {  // the layout that stb_easy_font documents
    float x, y, z;
    unsigned char color[4];
  };
  std::vector<Corner> corners(4 * 64 * (text.size() + 1));
  std::string copy = text;
  const int count = stb_easy_font_print(0, 0, copy.data(), nullptr, corners.data(),
                                        static_cast<int>(corners.size() * sizeof(Corner)));
  std::vector<TextQuad> quads;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const Corner& low = corners[4 * i];
    const Corner& high = corners[4 * i + 2];
    quads.push_back({low.x, low.y, high.x, high.y});
  }
  return quads;
}

double text_width(const std::string& text) {
  std::string copy = text;
  return stb_easy_font_width(copy.data());
}

}  // namespace beltrami::cli
