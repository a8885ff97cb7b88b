#include "picture/light.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <limits>
#include <new>
#include <string>
#include <vector>

#ifdef BELTRAMI_OPENEXR
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#endif

namespace beltrami::cli {

LightFormat light_format_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (extension == ".hdr") return LightFormat::kHdr;
  return extension == ".exr" ? LightFormat::kExr : LightFormat::kNone;
}

#ifdef BELTRAMI_OPENEXR

namespace {

/// A file in memory, for OpenEXR to read.
class Source : public Imf::IStream {
 public:
  explicit Source(std::string_view bytes) : IStream("input"), bytes_(bytes) {}
  bool read(char* to, int count) override {
    const auto wanted = static_cast<std::size_t>(std::max(count, 0));
    if (wanted > bytes_.size() - at_) throw std::length_error("the file ends early");
    std::copy_n(bytes_.data() + at_, wanted, to);
    at_ += wanted;
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t place) override {
    at_ = static_cast<std::size_t>(std::min<std::uint64_t>(place, bytes_.size()));
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// The same to write.
class Target : public Imf::OStream {
 public:
  Target() : OStream("output") {}
  void write(const char* from, int count) override {
    const auto size = static_cast<std::size_t>(std::max(count, 0));
    if (at_ + size > bytes.size()) bytes.resize(at_ + size);
    std::copy_n(from, size, bytes.data() + at_);
    at_ += size;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t place) override { at_ = static_cast<std::size_t>(place); }

  std::string bytes;

 private:
  std::size_t at_ = 0;
};

/// The channels that are read, in their order in memory.
std::vector<std::string> channels_of(const Imf::ChannelList& all) {
  std::vector<std::string> names;
  for (const char* name : {"R", "G", "B"}) {
    if (all.findChannel(name) != nullptr) names.emplace_back(name);
  }
  if (names.empty() && all.findChannel("Y") != nullptr) names.emplace_back("Y");
  if (!names.empty()) {
    if (all.findChannel("A") != nullptr) names.emplace_back("A");
    return names;
  }
  for (auto channel = all.begin(); channel != all.end(); ++channel) {
    if (!names.empty()) return {};  // which one is meant is not known
    names.emplace_back(channel.name());
  }
  return names;
}

Imf::FrameBuffer room_of(char* first, const std::vector<std::string>& names, int width) {
  Imf::FrameBuffer room;
  const std::size_t texel = sizeof(float) * names.size();
  for (std::size_t k = 0; k < names.size(); ++k) {
    room.insert(names[k], Imf::Slice(Imf::FLOAT, first + sizeof(float) * k, texel,
                                     texel * static_cast<std::size_t>(width)));
  }
  return room;
}

std::optional<Pixels> read_exr(std::string_view bytes) {
  Source source(bytes);
  Imf::InputFile file(source);
  const Imf::ChannelList& all = file.header().channels();
  const std::vector<std::string> names = channels_of(all);
  const auto& window = file.header().dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (names.empty() || width < 1 || height < 1 || width > kMostTexels / height) {
    return std::nullopt;
  }
  Pixels image{static_cast<int>(width),
               static_cast<int>(height),
               static_cast<int>(names.size()),
               {},
               sizeof(float)};
  image.half = all.findChannel(names.front())->type == Imf::HALF;
  image.values.resize(image.row_size() * static_cast<std::size_t>(height));
  const auto offset =
      static_cast<std::ptrdiff_t>(window.min.y) * static_cast<std::ptrdiff_t>(image.row_size()) +
      static_cast<std::ptrdiff_t>(window.min.x) *
          static_cast<std::ptrdiff_t>(sizeof(float) * names.size());
  // OpenEXR counts rows and columns as the file does.
  auto* first = reinterpret_cast<char*>(image.values.data()) - offset;
  file.setFrameBuffer(room_of(first, names, image.width));
  file.readPixels(window.min.y, window.max.y);
  return image;
}

std::string exr_bytes(const Pixels& image) {
  const std::array<std::vector<std::string>, 5> all = {
      {{}, {"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}}};
  const std::vector<std::string>& names = all[static_cast<std::size_t>(image.components)];
  Imf::Header header(image.width, image.height);
  for (const std::string& name : names) {
    header.channels().insert(name, Imf::Channel(image.half ? Imf::HALF : Imf::FLOAT));
  }
  Target target;
  {
    Imf::OutputFile file(target, header);
    std::vector<std::uint8_t> copy;
    const std::uint8_t* pixels = image.values.data();
    if (image.half) {  // its slices have the type of the file
      copy.resize(image.values.size() / 2);
      for (std::size_t i = 0; i < image.values.size() / 4; ++i) {
        float value = 0;
        std::memcpy(&value, pixels + 4 * i, sizeof value);
        const half number(value);
        std::memcpy(&copy[2 * i], &number, sizeof number);
      }
      pixels = copy.data();
    }
    const std::size_t size = image.half ? 2 : 4, texel = size * names.size();
    Imf::FrameBuffer room;
    for (std::size_t k = 0; k < names.size(); ++k) {
      auto* first = const_cast<char*>(reinterpret_cast<const char*>(pixels + size * k));
      room.insert(names[k], Imf::Slice(image.half ? Imf::HALF : Imf::FLOAT, first, texel,
                                       texel * static_cast<std::size_t>(image.width)));
    }
    file.setFrameBuffer(room);
    file.writePixels(image.height);
  }
  return std::move(target.bytes);
}

}  // namespace

bool has_exr() {
  return true;
}

#else

namespace {

std::optional<Pixels> read_exr(std::string_view) {
  return std::nullopt;
}

std::string exr_bytes(const Pixels&) {
  return {};
}

}  // namespace

bool has_exr() {
  return false;
}

#endif

std::optional<Pixels> read_light(std::string_view bytes) {
  if (bytes.starts_with("#?")) return read_hdr(bytes);
  if (!bytes.starts_with("\x76\x2F\x31\x01")) return std::nullopt;
  try {
    return read_exr(bytes);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;  // what OpenEXR says of a damaged file
  }
}

std::string light_bytes(const Pixels& image, LightFormat format) {
  return format == LightFormat::kExr ? exr_bytes(image) : hdr_bytes(image);
}

}  // namespace beltrami::cli
