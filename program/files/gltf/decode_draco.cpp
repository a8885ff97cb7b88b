#include "files/gltf/decode_draco.h"

#ifdef BELTRAMI_DRACO
#include <draco/compression/decode.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>
#endif

namespace beltrami::cli::gltf {

#ifdef BELTRAMI_DRACO

namespace {

/// Takes the values of all points.
template <class T>
bool take_values(const draco::PointAttribute& attribute, std::uint64_t points,
                 const DracoAttribute& wanted, DracoValues& found) {
  std::array<T, 4> value{};
  found.bytes.assign(points * wanted.stride(), '\0');
  for (std::uint64_t i = 0; i < points; ++i) {
    const auto index = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
    if (index.value() >= attribute.size()) return false;
    if (!attribute.ConvertValue<T>(index, static_cast<std::int8_t>(wanted.width), value.data())) {
      return false;
    }
    for (std::size_t k = 0; k < wanted.width; ++k) {
      const auto number = static_cast<double>(value[k]);
      found.low[k] = i == 0 ? number : std::min(found.low[k], number);
      found.high[k] = i == 0 ? number : std::max(found.high[k], number);
    }
    std::memcpy(found.bytes.data() + i * wanted.stride(), value.data(), wanted.width * sizeof(T));
  }
  return true;
}

bool take(const draco::PointAttribute& attribute, std::uint64_t points,
          const DracoAttribute& wanted, DracoValues& found) {
  switch (wanted.component) {
    case Component::kI8:
      return take_values<std::int8_t>(attribute, points, wanted, found);
    case Component::kU8:
      return take_values<std::uint8_t>(attribute, points, wanted, found);
    case Component::kI16:
      return take_values<std::int16_t>(attribute, points, wanted, found);
    case Component::kU16:
      return take_values<std::uint16_t>(attribute, points, wanted, found);
    case Component::kU32:
      return take_values<std::uint32_t>(attribute, points, wanted, found);
    case Component::kF32:
      return take_values<float>(attribute, points, wanted, found);
  }
  return false;
}

}  // namespace

bool reads_draco() {
  return true;
}

std::optional<DracoMesh> decode_draco(std::string_view packed,
                                      const std::vector<DracoAttribute>& wanted) {
  draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return std::nullopt;
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoMesh found;
  found.points = mesh->num_points();
  for (draco::FaceIndex f(0); f < mesh->num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh->face(f)) found.corners.push_back(point.value());
  }
  for (const DracoAttribute& own : wanted) {
    const draco::PointAttribute* const attribute =
        mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(own.id));
    found.values.emplace_back();
    if (attribute == nullptr || own.width > 4 ||
        !take(*attribute, found.points, own, found.values.back())) {
      return std::nullopt;
    }
  }
  return found;
}

#else

bool reads_draco() {
  return false;
}

std::optional<DracoMesh> decode_draco(std::string_view, const std::vector<DracoAttribute>&) {
  return std::nullopt;
}

#endif

}  // namespace beltrami::cli::gltf
