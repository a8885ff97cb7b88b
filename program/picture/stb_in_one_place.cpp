#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

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
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#define STBI_MALLOC(size) allocate(size)
#define STBI_REALLOC(old, size) reallocate(old, size)
#define STBI_FREE(old) std::free(old)
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBIW_MALLOC(size) allocate(size)
#define STBIW_REALLOC(old, size) reallocate(old, size)
#define STBIW_FREE(old) std::free(old)
#include <stb_easy_font.h>
#include <stb_image.h>
#include <stb_image_write.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

#include "picture/deflate.h"
#include "picture/stb_in_one_place.h"
#include "picture/webp.h"

namespace beltrami::cli {

namespace {

/// A filter of PNG: what is left of a row where a byte is expected to be that on its left (1), that
/// above (2), or that of both and the one between that is nearest to their plane (4). Rows begin
/// with a texel of zeros. Returns the sum of what is left.
template <int kFilter>
std::uint64_t filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                         std::size_t step, char* left_over) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const int left = row[i], up = above[i + step], corner = above[i];
    int expected = kFilter == 1 ? left : up;
    if constexpr (kFilter == 4) {
      const int a = std::abs(up - corner), b = std::abs(left - corner);
      const int c = std::abs(left + up - 2 * corner);
      expected = a <= b && a <= c ? left : b <= c ? up : corner;
    }
    const auto rest = static_cast<std::int8_t>(row[i + step] - expected);
    left_over[i] = static_cast<char>(rest);
    sum += static_cast<std::uint64_t>(std::abs(int{rest}));
  }
  return sum;
}

/// What a PNG file is made of: rows from the top, numbers in the order of the machine.
struct PngPixels {
  int width = 0, height = 0, components = 0;
  std::size_t bytes = 1;  ///< of a component
  const std::uint8_t* pixels = nullptr;
};

/// Gives each row, by the filter that leaves the least, as the specification of PNG advises. The
/// upper byte of 16 bits comes first there.
void filter_rows(const PngPixels& image, const std::function<void(std::string_view)>& take) {
  const std::size_t step = static_cast<std::size_t>(image.components) * image.bytes;
  const std::size_t size = static_cast<std::size_t>(image.width) * step;
  const bool swaps = image.bytes == 2 && std::endian::native == std::endian::little;
  std::vector<std::uint8_t> row(size + step, 0), above(size + step, 0);
  // The number of the filter comes before what it leaves.
  std::array<std::string, 3> tried = {std::string(size + 1, 1), std::string(size + 1, 2),
                                      std::string(size + 1, 4)};
  const std::uint8_t* pixels = image.pixels;
  for (int y = 0; y < image.height; ++y, pixels += size) {
    if (swaps) {
      for (std::size_t i = 0; i < size; ++i) row[step + i] = pixels[i ^ 1];
    } else {
      std::copy_n(pixels, size, row.data() + step);
    }
    const std::array<std::uint64_t, 3> sums = {
        filter_row<1>(row.data(), above.data(), size, step, tried[0].data() + 1),
        filter_row<2>(row.data(), above.data(), size, step, tried[1].data() + 1),
        filter_row<4>(row.data(), above.data(), size, step, tried[2].data() + 1)};
    const auto best =
        static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
    take(tried[best]);
    row.swap(above);
  }
}

void append_big(std::uint32_t number, std::string& bytes) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xFF);
}

void append_chunk(std::string_view type, std::string_view data, std::string& bytes) {
  append_big(static_cast<std::uint32_t>(data.size()), bytes);
  bytes += type;
  bytes += data;
  append_big(crc32(data, crc32(type)), bytes);
}

std::string png_file(const PngPixels& image) {
  constexpr std::array<char, 5> kColourTypes = {0, 0, 4, 2, 6};
  std::string head;
  append_big(static_cast<std::uint32_t>(image.width), head);
  append_big(static_cast<std::uint32_t>(image.height), head);
  head += {static_cast<char>(8 * image.bytes),
           kColourTypes[static_cast<std::size_t>(image.components)], 0, 0, 0};
  std::string file = "\x89PNG\r\n\x1A\n";
  append_chunk("IHDR", head, file);
  Deflater deflater(Repetitions::kOfOneByte,
                    [&](std::string_view part) { append_chunk("IDAT", part, file); });
  filter_rows(image, [&](std::string_view row) { deflater.add(row); });
  deflater.end();
  append_chunk("IEND", "", file);
  return file;
}

}  // namespace

std::string png_bytes(int width, int height, int components, const std::uint8_t* pixels) {
  return png_file({width, height, components, 1, pixels});
}

std::string png_bytes(const Pixels& image) {
  return png_file({image.width, image.height, image.components, image.bytes, image.values.data()});
}

namespace {

/// Whether stb's reader may read this.
bool is_known(std::string_view bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
  int width = 0, height = 0, components = 0;
  return stbi_info_from_memory(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                               static_cast<int>(bytes.size()), &width, &height, &components) != 0 &&
         double(width) * height <= double(kMostTexels);
}

bool is_hdr(std::string_view bytes) {
  return bytes.starts_with("#?");
}

}  // namespace

bool is_image(std::string_view bytes) {
  return (!is_hdr(bytes) && is_known(bytes)) || is_webp(bytes);
}

std::optional<Pixels> read_hdr(std::string_view bytes) {
  if (!is_hdr(bytes) || !is_known(bytes)) return std::nullopt;
  Pixels image;
  image.components = 3;
  image.bytes = sizeof(float);
  int stored = 0;
  void* pixels = stbi_loadf_from_memory(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                        static_cast<int>(bytes.size()), &image.width, &image.height,
                                        &stored, image.components);
  if (pixels == nullptr) return std::nullopt;
  const std::unique_ptr<void, void (*)(void*)> owner(pixels, &std::free);
  const auto* first = static_cast<const std::uint8_t*>(pixels);
  image.values.assign(first, first + image.row_size() * static_cast<std::size_t>(image.height));
  return image;
}

std::string hdr_bytes(const Pixels& image) {
  std::string bytes;
  const auto append = [](void* to, void* data, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data),
                                          static_cast<std::size_t>(size));
  };
  std::vector<float> values(image.values.size() / sizeof(float));
  std::memcpy(values.data(), image.values.data(), image.values.size());
  stbi_write_hdr_to_func(append, &bytes, image.width, image.height, image.components,
                         values.data());
  return bytes;
}

std::optional<Pixels> read_image(std::string_view bytes) {
  if (is_webp(bytes)) return read_webp(bytes);
  if (!is_image(bytes)) return std::nullopt;
  Pixels image;
  const auto* file = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const auto size = static_cast<int>(bytes.size());
  if (stbi_is_16_bit_from_memory(file, size) != 0) image.bytes = 2;
  void* pixels =
      image.bytes == 2
          ? static_cast<void*>(stbi_load_16_from_memory(file, size, &image.width, &image.height,
                                                        &image.components, 0))
          : stbi_load_from_memory(file, size, &image.width, &image.height, &image.components, 0);
  if (pixels == nullptr) return std::nullopt;
  const std::unique_ptr<void, void (*)(void*)> owner(pixels, &std::free);
  const auto* first = static_cast<const std::uint8_t*>(pixels);
  image.values.assign(first, first + image.row_size() * static_cast<std::size_t>(image.height));
  return image;
}

bool shows_directions(const Pixels& image) {
  if (image.components < 3) return false;
  double red = 0, green = 0, blue = 0;
  // Of 16 bits the upper ones will do, which come last.
  const std::size_t bytes = image.bytes, texel = bytes * static_cast<std::size_t>(image.components);
  for (std::size_t i = bytes - 1; i + 2 * bytes < image.values.size(); i += texel) {
    red += image.values[i];
    green += image.values[i + bytes];
    blue += image.values[i + 2 * bytes];
  }
  return blue > 1.2 * red && blue > 1.2 * green;
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
