// Accessors: arrays of numbers, or of vectors and matrices of them, in the buffers of a document.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/gltf/document.h"
#include "files/gltf/item.h"

namespace beltrami::cli::gltf {

/// The numbers that OpenGL gave the types.
enum class Component : std::uint16_t {
  kI8 = 5120,
  kU8 = 5121,
  kI16 = 5122,
  kU16 = 5123,
  kU32 = 5125,
  kF32 = 5126
};

std::uint64_t size_of(Component component);

/// Numbers of a scalar or a vector of this type; 0 for a matrix and for what is none.
std::uint64_t width_of(const std::string& type);

/// Of an accessor or of its sparse indices. Throws Failure where it is none.
Component component_of(const Item& item);

/// Every element lies within the bytes.
class Accessor {
 public:
  /// Accessor `number`. Throws Failure for what is out of range or not of glTF, for a count other
  /// than `count` where one is given, and for one without bytes where none is: nothing would bound
  /// its count. std::bad_alloc. `document` must outlive it.
  Accessor(const Document& document, std::uint64_t number,
           std::optional<std::uint64_t> count = std::nullopt);

  std::uint64_t count() const { return count_; }
  Component component() const { return component_; }
  /// "SCALAR", "VEC3".
  const std::string& type() const { return type_; }
  std::uint64_t element_size() const { return element_size_; }
  /// The bytes of an element, whatever sparse values stand in its place.
  std::string_view element(std::uint64_t i) const {
    return {(dense_.empty() ? bytes_.data() : dense_.data()) + i * stride_, element_size_};
  }
  /// Number k of a vector, from -1 or 0 to 1 where the accessor is normalized.
  double value(std::uint64_t i, std::uint64_t k) const;
  /// The same as it is stored.
  double stored_value(std::uint64_t i, std::uint64_t k) const;

 private:
  void find_bytes(const Document& document, const Item& item);
  void put_sparse_values(const Document& document, const Item& item);

  Component component_ = Component::kF32;
  std::string type_;
  bool normalized_ = false;
  std::uint64_t count_ = 0, element_size_ = 0, stride_ = 0;
  std::string_view bytes_;
  std::string dense_;  ///< all elements, where some are sparse
};

/// The elements of a SCALAR accessor of whole numbers. Throws Failure for others.
std::vector<std::uint32_t> indices_of(const Document& document, std::uint64_t number);

}  // namespace beltrami::cli::gltf
