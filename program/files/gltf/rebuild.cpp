#include "files/gltf/rebuild.h"

#include <algorithm>
#include <optional>

#include "files/gltf/references.h"

namespace beltrami::cli::gltf {
namespace {

/// Old bytes keep their place modulo this, more than any number in them needs.
constexpr std::uint64_t kAlignment = 8;

/// The places that nothing refers to, and behind them new ones.
class Places {
 public:
  explicit Places(const std::vector<bool>& used) : end_(used.size()) {
    for (std::uint64_t i = used.size(); i-- > 0;) {
      if (!used[i]) free_.push_back(i);
    }
  }
  std::uint64_t take() {
    if (free_.empty()) return end_++;
    const std::uint64_t place = free_.back();
    free_.pop_back();
    return place;
  }
  const std::vector<std::uint64_t>& left() const { return free_; }

 private:
  std::vector<std::uint64_t> free_;  ///< the first is the last
  std::uint64_t end_;
};

void put(Json& list, std::uint64_t place, Json value) {
  if (place == list.size()) {
    list.push_back(std::move(value));
  } else {
    list[place] = std::move(value);
  }
}

/// Calls visit(number) for every number of an accessor in a primitive.
template <class Visit>
void visit_accessors(Json& primitive, const Visit& visit) {
  const auto visit_members = [&](Json& object) {
    for (auto& [name, value] : object.items()) visit(value);
  };
  if (primitive.contains("attributes")) visit_members(primitive["attributes"]);
  if (primitive.contains("indices")) visit(primitive["indices"]);
  if (!primitive.contains("targets")) return;
  for (Json& target : primitive["targets"]) visit_members(target);
}

/// Puts the accessors in their places. Returns the places.
std::vector<std::uint64_t> place_accessors(Json& json, const std::vector<NewAccessor>& added) {
  Json& accessors = json["accessors"];
  const std::uint64_t old_count = accessors.size();
  Places places(references_in(json).accessors);
  std::vector<std::uint64_t> place_of;
  for (const NewAccessor& accessor : added) {
    place_of.push_back(places.take());
    put(accessors, place_of.back(), accessor.json);
  }
  for (const std::uint64_t place : places.left()) {
    // One zero: an accessor must be something.
    accessors[place] = {{"componentType", 5121}, {"count", 1}, {"type", "SCALAR"}};
  }
  for (Json& mesh : json["meshes"]) {
    if (!mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"]) {
      visit_accessors(primitive, [&](Json& value) {
        const std::optional<std::uint64_t> number = whole_of(value);
        if (!number || *number < old_count || *number - old_count >= added.size()) return;
        value = place_of[*number - old_count];
      });
    }
  }
  return place_of;
}

class Layout {
 public:
  explicit Layout(Buffer& buffer) : buffer_(buffer) {}

  /// Appends bytes at the next offset that is `phase` modulo kAlignment. Returns the offset.
  std::uint64_t append(std::string bytes, std::uint64_t phase) {
    const std::uint64_t gap = (phase + kAlignment - buffer_.size % kAlignment) % kAlignment;
    if (gap != 0) buffer_.pieces.emplace_back(gap, '\0');
    const std::uint64_t offset = buffer_.size + gap;
    buffer_.size = offset + bytes.size();
    buffer_.pieces.push_back(std::move(bytes));
    return offset;
  }

 private:
  Buffer& buffer_;
};

/// Copies what the views show, a stretch that several show once, and points them there.
void copy_views(const Document& document, const std::vector<bool>& used, Json& views,
                Layout& layout) {
  struct Part {
    std::uint64_t number;
    BufferView view;
  };
  std::vector<Part> parts;
  for (std::uint64_t i = 0; i < used.size(); ++i) {
    if (used[i]) parts.push_back({i, buffer_view(document, i)});
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    if (a.view.buffer != b.view.buffer) return a.view.buffer < b.view.buffer;
    if (a.view.offset != b.view.offset) return a.view.offset < b.view.offset;
    return a.number < b.number;
  });
  for (std::size_t first = 0, last = 0; first < parts.size(); first = last) {
    const auto [buffer, begin, length, stride] = parts[first].view;
    std::uint64_t end = begin + length;
    for (last = first + 1; last < parts.size(); ++last) {
      const BufferView& next = parts[last].view;
      if (next.buffer != buffer || next.offset > end) break;
      end = std::max(end, next.offset + next.length);
    }
    const std::uint64_t offset =
        layout.append(document.buffers[buffer].substr(begin, end - begin), begin % kAlignment);
    for (std::size_t i = first; i < last; ++i) {
      Json& view = views[parts[i].number];
      view["buffer"] = 0;
      view["byteOffset"] = offset + (parts[i].view.offset - begin);
    }
  }
}

}  // namespace

Buffer rebuild(const Document& document, Json& json, std::vector<NewAccessor> added,
               const std::vector<NewImage>& images) {
  const std::vector<std::uint64_t> place_of = place_accessors(json, added);
  Json& views = json["bufferViews"];
  const std::vector<bool> used = references_in(json).views;
  Buffer buffer;
  Layout layout(buffer);
  copy_views(document, used, views, layout);
  Places places(used);
  for (std::size_t k = 0; k < added.size(); ++k) {
    if (added[k].bytes.empty()) continue;
    Json view = {{"buffer", 0}, {"byteLength", added[k].bytes.size()}};
    view["byteOffset"] = layout.append(std::move(added[k].bytes), 0);
    if (added[k].stride != 0) view["byteStride"] = added[k].stride;
    view["target"] = static_cast<std::uint16_t>(added[k].target);
    const std::uint64_t place = places.take();
    put(views, place, std::move(view));
    json["accessors"][place_of[k]]["bufferView"] = place;
  }
  for (const NewImage& image : images) {
    const std::uint64_t place = places.take();
    put(views, place,
        {{"buffer", 0},
         {"byteLength", image.bytes->size()},
         {"byteOffset", layout.append(*image.bytes, 0)}});
    for (const std::uint64_t entry : image.places) json["images"][entry]["bufferView"] = place;
  }
  for (const std::uint64_t place : places.left()) {
    views[place] = {{"buffer", 0}, {"byteLength", 1}};  // a view must be of something
  }
  Json all = json["buffers"][0];
  all.erase("uri");
  all["byteLength"] = buffer.size;
  json["buffers"] = Json::array({std::move(all)});
  return buffer;
}

}  // namespace beltrami::cli::gltf
