#include "files/gltf/accessor.h"

#include <algorithm>
#include <array>

#include "files/gltf/little.h"

namespace beltrami::cli::gltf {
namespace {

/// As many zeros as the greatest element, a matrix of 4 x 4 floats.
constexpr std::array<char, 64> kZeros{};

struct Shape {
  std::string_view name;
  std::uint64_t rows, columns;
};
constexpr std::array<Shape, 7> kShapes = {{{"SCALAR", 1, 1},
                                           {"VEC2", 2, 1},
                                           {"VEC3", 3, 1},
                                           {"VEC4", 4, 1},
                                           {"MAT2", 2, 2},
                                           {"MAT3", 3, 3},
                                           {"MAT4", 4, 4}}};

std::uint64_t element_size_of(const Item& item, const std::string& type, Component component) {
  const auto shape = std::find_if(kShapes.begin(), kShapes.end(),
                                  [&](const Shape& known) { return known.name == type; });
  if (shape == kShapes.end()) item.fail("its type is none of glTF 2.0");
  const std::uint64_t column = shape->rows * size_of(component);
  // Columns of matrices begin at multiples of four bytes.
  return shape->columns == 1 ? column : shape->columns * ((column + 3) / 4 * 4);
}

/// The bytes of `count` items from `offset` on, `stride` apart. Nothing here can overflow: no
/// number is taken that the view has no room for.
std::string_view items_in(const Document& document, const Item& item, std::uint64_t view_number,
                          std::uint64_t offset, std::uint64_t count, std::uint64_t size,
                          std::uint64_t stride) {
  const BufferView view = buffer_view(document, view_number);
  const bool fits = offset <= view.length && size <= view.length - offset &&
                    count - 1 <= (view.length - offset - size) / stride;
  if (!fits) {
    item.fail("its " + std::to_string(count) + " elements reach beyond bufferViews[" +
              std::to_string(view_number) + "]: the file is damaged, export it again");
  }
  return std::string_view(document.buffers[view.buffer])
      .substr(view.offset + offset, view.length - offset);
}

std::uint32_t index_at(const char* bytes, Component component) {
  switch (component) {
    case Component::kU8:
      return little<std::uint8_t>(bytes);
    case Component::kU16:
      return little<std::uint16_t>(bytes);
    default:
      return little<std::uint32_t>(bytes);
  }
}

bool is_index(Component component) {
  return component == Component::kU8 || component == Component::kU16 ||
         component == Component::kU32;
}

}  // namespace

std::uint64_t width_of(const std::string& type) {
  const auto shape = std::find_if(kShapes.begin(), kShapes.end(),
                                  [&](const Shape& known) { return known.name == type; });
  return shape != kShapes.end() && shape->columns == 1 ? shape->rows : 0;
}

Component component_of(const Item& item) {
  const std::uint64_t number = item.required("componentType");
  for (const Component known : {Component::kI8, Component::kU8, Component::kI16, Component::kU16,
                                Component::kU32, Component::kF32}) {
    if (number == static_cast<std::uint64_t>(known)) return known;
  }
  item.fail("componentType " + std::to_string(number) + " is none of glTF 2.0");
}

std::uint64_t size_of(Component component) {
  switch (component) {
    case Component::kI8:
    case Component::kU8:
      return 1;
    case Component::kI16:
    case Component::kU16:
      return 2;
    default:
      return 4;
  }
}

Accessor::Accessor(const Document& document, std::uint64_t number,
                   std::optional<std::uint64_t> count) {
  const Item item = document.entry("accessors", number);
  component_ = component_of(item);
  type_ = item.text("type");
  normalized_ = item.truth("normalized");
  element_size_ = element_size_of(item, type_, component_);
  count_ = item.required("count");
  if (count_ == 0) item.fail("its count is 0: export the file again");
  if (count && count_ != *count) {
    item.fail("its count is " + std::to_string(count_) + ", but that of the positions beside it " +
              "is " + std::to_string(*count) + ": export the file again");
  }
  if (!count && !item.find("bufferView")) {
    item.fail(
        "it has no bufferView, so its values are all zero: that is no mesh, export the file again");
  }
  find_bytes(document, item);
  if (item.find("sparse")) put_sparse_values(document, item);
}

void Accessor::find_bytes(const Document& document, const Item& item) {
  const std::optional<std::uint64_t> view = item.whole("bufferView");
  if (!view) {
    bytes_ = {kZeros.data(), kZeros.size()};
    stride_ = 0;
    return;
  }
  stride_ = buffer_view(document, *view).stride;
  if (stride_ == 0) stride_ = element_size_;
  if (stride_ < element_size_) {
    item.fail("its elements overlap: bufferViews[" + std::to_string(*view) +
              "].byteStride is too small");
  }
  bytes_ =
      items_in(document, item, *view, item.whole("byteOffset", 0), count_, element_size_, stride_);
}

void Accessor::put_sparse_values(const Document& document, const Item& item) {
  const std::optional<Item> sparse = item.object("sparse");
  const std::optional<Item> indices = sparse->object("indices");
  const std::optional<Item> values = sparse->object("values");
  if (!indices || !values) sparse->fail("indices or values are missing");
  const std::uint64_t count = sparse->required("count");
  if (count == 0 || count > count_) sparse->fail("its count is not from 1 to that of the accessor");
  const Component component = component_of(*indices);
  if (!is_index(component)) indices->fail("its componentType is not unsigned");
  const std::uint64_t size = size_of(component);
  const std::string_view places = items_in(document, *indices, indices->required("bufferView"),
                                           indices->whole("byteOffset", 0), count, size, size);
  const std::string_view elements =
      items_in(document, *values, values->required("bufferView"), values->whole("byteOffset", 0),
               count, element_size_, element_size_);

  std::string dense;
  dense.reserve(count_ * element_size_);
  for (std::uint64_t i = 0; i < count_; ++i) dense.append(element(i));
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint32_t place = index_at(places.data() + i * size, component);
    if (place >= count_) indices->fail("an index is not below the count of the accessor");
    dense.replace(place * element_size_, element_size_, elements, i * element_size_, element_size_);
  }
  dense_ = std::move(dense);
  stride_ = element_size_;
}

double Accessor::stored_value(std::uint64_t i, std::uint64_t k) const {
  const char* bytes = element(i).data() + k * size_of(component_);
  switch (component_) {
    case Component::kI8:
      return little<std::int8_t>(bytes);
    case Component::kU8:
      return little<std::uint8_t>(bytes);
    case Component::kI16:
      return little<std::int16_t>(bytes);
    case Component::kU16:
      return little<std::uint16_t>(bytes);
    case Component::kU32:
      return little<std::uint32_t>(bytes);
    default:
      return double{little<float>(bytes)};
  }
}

double Accessor::value(std::uint64_t i, std::uint64_t k) const {
  const double stored = stored_value(i, k);
  if (!normalized_) return stored;
  switch (component_) {
    case Component::kI8:
      return std::max(stored / 127, -1.0);
    case Component::kU8:
      return stored / 255;
    case Component::kI16:
      return std::max(stored / 32767, -1.0);
    case Component::kU16:
      return stored / 65535;
    default:
      return stored;
  }
}

std::vector<std::uint32_t> indices_of(const Document& document, std::uint64_t number) {
  const Accessor accessor(document, number);
  if (accessor.type() != "SCALAR" || !is_index(accessor.component())) {
    document.entry("accessors", number).fail("indices are no unsigned whole numbers");
  }
  std::vector<std::uint32_t> indices(accessor.count());
  for (std::uint64_t i = 0; i < indices.size(); ++i) {
    indices[i] = index_at(accessor.element(i).data(), accessor.component());
  }
  return indices;
}

}  // namespace beltrami::cli::gltf
