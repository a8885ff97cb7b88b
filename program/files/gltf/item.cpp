#include "files/gltf/item.h"

#include <cmath>

#include "process/failure.h"

namespace beltrami::cli::gltf {

void Item::fail(const std::string& what) const {
  throw Failure(path + ": " + (name.empty() ? "" : name + ": ") + what);
}

const Json* Item::find(const char* key) const {
  if (!json.is_object()) return nullptr;
  const auto found = json.find(key);
  return found == json.end() ? nullptr : &*found;
}

std::optional<Item> Item::object(const char* key) const {
  const Json* found = find(key);
  if (!found) return std::nullopt;
  if (!found->is_object()) fail(std::string(key) + " is no object");
  return Item{*found, name.empty() ? key : name + "." + key, path};
}

std::optional<Item> Item::array(const char* key) const {
  const Json* found = find(key);
  if (!found) return std::nullopt;
  if (!found->is_array()) fail(std::string(key) + " is no array");
  return Item{*found, name.empty() ? key : name + "." + key, path};
}

std::optional<std::uint64_t> Item::whole(const char* key) const {
  const Json* found = find(key);
  if (!found) return std::nullopt;
  const std::optional<std::uint64_t> value = whole_of(*found);
  if (!value) fail(std::string(key) + " is no whole number from 0");
  return value;
}

std::uint64_t Item::whole(const char* key, std::uint64_t otherwise) const {
  return whole(key).value_or(otherwise);
}

std::uint64_t Item::required(const char* key) const {
  const std::optional<std::uint64_t> value = whole(key);
  if (!value) fail(std::string(key) + " is missing");
  return *value;
}

bool Item::truth(const char* key) const {
  const Json* found = find(key);
  if (!found) return false;
  if (!found->is_boolean()) fail(std::string(key) + " is neither true nor false");
  return found->get<bool>();
}

std::string Item::text(const char* key) const {
  const Json* found = find(key);
  if (!found) return {};
  if (!found->is_string()) fail(std::string(key) + " is no string");
  return found->get<std::string>();
}

bool Item::has_extension(const char* extension) const {
  const std::optional<Item> all = object("extensions");
  return all && all->find(extension);
}

Item Item::operator[](std::uint64_t number) const {
  const std::string entry = name + "[" + std::to_string(number) + "]";
  if (!json.is_array() || number >= json.size()) {
    throw Failure(path + ": " + entry + " is referred to, but there are " +
                  std::to_string(json.size()) + " " + name);
  }
  return {json[number], entry, path};
}

std::optional<std::uint64_t> whole_of(const Json& json) {
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (!json.is_number_float()) return std::nullopt;
  const double value = json.get<double>();
  constexpr double kLimit = 9007199254740992;  // 2^53: whole numbers beyond are not all doubles
  if (!(value >= 0 && value <= kLimit) || value != std::floor(value)) return std::nullopt;
  return static_cast<std::uint64_t>(value);
}

}  // namespace beltrami::cli::gltf
