// Objects of a glTF document, with names for messages.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace beltrami::cli::gltf {

/// Objects keep the order of their keys.
using Json = nlohmann::ordered_json;

/// A value of the document. Nothing is known of its type: a member of what is no object is missing.
struct Item {
  const Json& json;
  std::string name;         ///< "meshes[2].primitives[0]"
  const std::string& path;  ///< of the file

  /// Throws Failure "path: name: what".
  [[noreturn]] void fail(const std::string& what) const;

  /// The member, or null.
  const Json* find(const char* key) const;
  /// The member, which must be an object or an array, or null.
  std::optional<Item> object(const char* key) const;
  std::optional<Item> array(const char* key) const;
  /// The member, a whole number from 0; 1.0 is one too. Throws Failure for what is something else.
  std::optional<std::uint64_t> whole(const char* key) const;
  std::uint64_t whole(const char* key, std::uint64_t otherwise) const;
  std::uint64_t required(const char* key) const;
  bool truth(const char* key) const;        ///< false where it is missing
  std::string text(const char* key) const;  ///< empty where it is missing
  bool has_extension(const char* extension) const;

  /// Of an array: how many, and which. Precondition of [ ]: number < size(), or Failure.
  std::uint64_t size() const { return json.size(); }
  Item operator[](std::uint64_t number) const;
};

/// The whole number that `json` is, if it is one.
std::optional<std::uint64_t> whole_of(const Json& json);

}  // namespace beltrami::cli::gltf
