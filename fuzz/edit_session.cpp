// An editing session as any host drives it: edits, updates, packs, cancels and undos in any order.
// What a failure or a cancel leaves is what was there, what was saved comes back to the bit, and a
// second check agrees with the verdict on each chart.
#include <beltrami/beltrami.h>
#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <map>
#include <string_view>
#include <vector>

#include "target.h"

namespace beltrami::fuzz {
namespace {

using Provider = FuzzedDataProvider;
using Uv = std::array<double, 2>;

/// Updates that took this many looks at the progress are long enough.
constexpr int kMostPolls = 2000;
constexpr std::uint32_t kMostVertices = 16, kMostFaces = 24;

std::int32_t count_down(void* polls, double fraction, const char* stage) {
  promise(fraction >= 0 && fraction <= 1, "progress is a share");
  promise(stage != nullptr, "progress has a stage");
  return --*static_cast<int*>(polls) < 0;
}

template <class Struct>
Struct sized() {
  Struct value{};
  value.struct_size = sizeof value;
  return value;
}

bool same_bits(const std::vector<Uv>& a, const std::vector<Uv>& b) {
  return a.size() == b.size() && (a.empty() || !std::memcmp(a.data(), b.data(), 16 * a.size()));
}

/// A grid with heights, or any triangles at all.
struct Mesh {
  std::vector<double> positions;
  std::vector<std::uint32_t> corners;

  explicit Mesh(Provider& data) {
    const auto side = data.ConsumeIntegralInRange<std::uint32_t>(0, 3);
    if (side > 0) {
      grid(data, side);
      return;
    }
    const auto vertices = data.ConsumeIntegralInRange<std::uint32_t>(3, kMostVertices);
    const auto faces = data.ConsumeIntegralInRange<std::uint32_t>(1, kMostFaces);
    for (std::uint32_t i = 0; i < 3 * vertices; ++i) {
      positions.push_back(data.ConsumeIntegralInRange(-4, 4));
    }
    for (std::uint32_t i = 0; i < 3 * faces; ++i) {
      corners.push_back(data.ConsumeIntegralInRange<std::uint32_t>(0, vertices - 1));
    }
  }

  std::size_t faces() const { return corners.size() / 3; }
  std::size_t vertices() const { return positions.size() / 3; }

  beltrami_surface surface() const {
    auto surface = sized<beltrami_surface>();
    surface.vertex_count = vertices();
    surface.face_count = faces();
    surface.positions = {positions.data(), 0, BELTRAMI_F64, 0};
    surface.indices = {corners.data(), 0, BELTRAMI_U32, 0};
    return surface;
  }

 private:
  void grid(Provider& data, std::uint32_t side) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      for (std::uint32_t k = 0; k <= side; ++k) {
        positions.insert(positions.end(), {static_cast<double>(i), static_cast<double>(k),
                                           data.ConsumeIntegralInRange(-8, 8) / 4.0});
      }
    }
    for (std::uint32_t i = 0; i < side; ++i) {
      for (std::uint32_t k = 0; k < side; ++k) {
        const std::uint32_t a = i * (side + 1) + k, b = a + side + 1;
        corners.insert(corners.end(), {a, b, b + 1, a, b + 1, a + 1});
      }
    }
  }
};

class Host {
 public:
  explicit Host(Provider& data) : data_(data), mesh_(data) {
    promise(beltrami_create(&context_) == BELTRAMI_OK, "a context is made");
    beltrami_set_int(context_, BELTRAMI_OPTION_RESOLUTION, 32);
    beltrami_set_int(context_, BELTRAMI_OPTION_FLOAT32, data.ConsumeBool() ? 1 : 0);
    beltrami_surface surface = mesh_.surface();
    if (data.ConsumeIntegralInRange(0, 3) == 0) {
      for (std::size_t i = 0; i < 2 * mesh_.corners.size(); ++i) {
        given_.push_back(data.ConsumeIntegralInRange(-8, 8) / 8.0);
      }
      surface.corner_uvs = {given_.data(), 0, BELTRAMI_F64, 0};
    }
    has_begun_ = judged(beltrami_session_begin(context_, &surface, nullptr, nullptr)) >= 0;
    if (has_begun_) uvs_ = uvs();
  }
  ~Host() { beltrami_destroy(context_); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  bool has_begun() const { return has_begun_; }

  void call() {
    switch (data_.ConsumeIntegralInRange(0, 12)) {
      case 0:
      case 1:
        return set_seams();
      case 2:
        return set_pins();
      case 3:
        return select();
      case 4:
        return of_charts(beltrami_session_lock);
      case 5:
        return of_charts(beltrami_session_renew);
      case 12:
        return set_flags();
      case 6:
        return pack();
      case 7:
        return save();
      case 8:
        return restore();
      default:
        return update();
    }
  }

 private:
  beltrami_status judged(beltrami_status status) {
    promise(status != BELTRAMI_E_INTERNAL, "no call shows a defect");
    const bool has_sentence = *beltrami_error_message(context_) != '\0';
    promise(has_sentence == (status < BELTRAMI_OK), "failures and nothing else have a sentence");
    return status;
  }

  std::vector<Uv> uvs() {
    auto session = sized<beltrami_session>();
    judged(beltrami_get_session(context_, &session));
    std::vector<Uv> uvs(session.corners);
    judged(beltrami_get_session_uvs(context_, uvs.data(), BELTRAMI_F64, 0));
    return uvs;
  }

  std::uint32_t below(std::size_t end) {
    return data_.ConsumeIntegralInRange<std::uint32_t>(0, static_cast<std::uint32_t>(end) - 1);
  }

  /// An edit is noted, and moves nothing.
  void noted(beltrami_status status) {
    judged(status);
    promise(same_bits(uvs(), uvs_), "an edit moves nothing");
  }

  void set_seams() {
    std::vector<std::uint32_t> ends;
    for (std::uint32_t left = below(4); left > 0; --left) {
      const std::uint32_t corner = below(mesh_.corners.size());
      const std::uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
      ends.push_back(mesh_.corners[corner]);
      ends.push_back(mesh_.corners[next]);
    }
    const beltrami_buffer edges = {ends.data(), 0, BELTRAMI_U32, 0};
    noted(beltrami_session_set_seams(context_, &edges, ends.size() / 2, data_.ConsumeBool()));
  }

  void set_pins() {
    std::vector<std::uint32_t> corners;
    std::vector<double> places;
    for (std::uint32_t left = below(4); left > 0; --left) {
      corners.push_back(below(mesh_.corners.size()));
      for (int k = 0; k < 2; ++k) {
        const double off = data_.ConsumeIntegralInRange(-8, 8) / 64.0;
        places.push_back(static_cast<float>(uvs_[corners.back()][k] + off));
      }
    }
    const beltrami_buffer at = {corners.data(), 0, BELTRAMI_U32, 0};
    const beltrami_buffer uv = {places.data(), 0, BELTRAMI_F64, 0};
    noted(beltrami_session_set_pins(context_, &at, &uv, corners.size()));
  }

  void select() {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t left = below(6); left > 0; --left) faces.push_back(below(mesh_.faces()));
    const beltrami_buffer buffer = {faces.data(), 0, BELTRAMI_U32, 0};
    noted(beltrami_session_select(context_, &buffer, faces.size()));
  }

  std::vector<std::uint64_t> some_charts() {
    auto session = sized<beltrami_session>();
    judged(beltrami_get_session(context_, &session));
    std::vector<std::uint64_t> ids;
    for (std::uint64_t c = 0; c < session.charts; ++c) {
      auto chart = sized<beltrami_session_chart>();
      judged(beltrami_get_session_chart(context_, c, &chart));
      if (data_.ConsumeBool()) ids.push_back(chart.id);
    }
    return ids;
  }

  template <class Function>
  void of_charts(Function function) {
    const std::vector<std::uint64_t> ids = some_charts();
    const beltrami_buffer buffer = {ids.data(), 0, BELTRAMI_U64, 0};
    noted(function(context_, &buffer, ids.size(), data_.ConsumeBool() ? 1 : 0));
  }

  void set_flags() {
    const std::vector<std::uint64_t> ids = some_charts();
    const beltrami_buffer buffer = {ids.data(), 0, BELTRAMI_U64, 0};
    noted(beltrami_session_set_flags(context_, &buffer, ids.size(),
                                     data_.ConsumeIntegralInRange<std::uint32_t>(0, 16)));
  }

  int polls() { return data_.ConsumeBool() ? kMostPolls : data_.ConsumeIntegralInRange(0, 60); }

  /// What a call that may move charts has led to.
  void moved(beltrami_status status) {
    judged(status);
    if (status < BELTRAMI_OK) {
      promise(same_bits(uvs(), uvs_), "a failure leaves the maps as they were");
      return;
    }
    const std::vector<Uv> now = uvs();
    read_changes(now);
    uvs_ = now;
    judge_charts();
  }

  void update() {
    int left = polls();
    const std::int32_t steps = data_.ConsumeIntegralInRange(0, 3);
    moved(beltrami_session_update(context_, 0, steps, count_down, &left));
  }

  void pack() {
    const std::vector<std::uint64_t> ids = some_charts();
    const beltrami_buffer buffer = {ids.data(), 0, BELTRAMI_U64, 0};
    int left = polls();
    const beltrami_status status =
        beltrami_session_pack(context_, &buffer, ids.size(), count_down, &left);
    moved(status);
    if (status != BELTRAMI_OK) return;
    auto certificate = sized<beltrami_atlas_certificate>();
    judged(beltrami_session_check(context_, &certificate));
  }

  void save() {
    std::uint64_t mark = 0;
    if (judged(beltrami_session_save(context_, &mark)) < 0) return;
    promise(saved_.find(mark) == saved_.end(), "a number is given once");
    saved_[mark] = uvs_;
  }

  void restore() {
    if (saved_.empty()) return;
    auto at = saved_.begin();
    std::advance(at, below(saved_.size()));
    promise(judged(beltrami_session_restore(context_, at->first)) == BELTRAMI_OK,
            "what was saved is there");
    const std::vector<Uv> now = uvs();
    promise(same_bits(now, at->second), "what was saved comes back");
    read_changes(now);
    uvs_ = now;
    if (data_.ConsumeBool()) return;
    judged(beltrami_session_forget(context_, at->first));
    saved_.erase(at);
  }

  /// The changes lead from the UVs before to those now.
  void read_changes(const std::vector<Uv>& now) {
    auto session = sized<beltrami_session>();
    judged(beltrami_get_session(context_, &session));
    std::vector<std::uint32_t> corners(session.changes);
    std::vector<Uv> places(session.changes);
    if (session.changes > 0) {
      judged(beltrami_get_session_changes(context_, corners.data(), BELTRAMI_U32, places.data(),
                                          BELTRAMI_F64));
    }
    std::vector<Uv> then = uvs_;
    for (std::size_t i = 0; i < corners.size(); ++i) then[corners[i]] = places[i];
    promise(same_bits(then, now), "changes are what has moved");
  }

  /// A second check of each chart by itself.
  void judge_charts() {
    std::vector<std::uint64_t> of_faces(mesh_.faces());
    judged(beltrami_get_session_face_charts(context_, of_faces.data(), BELTRAMI_U64, 0));
    auto session = sized<beltrami_session>();
    judged(beltrami_get_session(context_, &session));
    for (std::uint64_t c = 0; c < session.charts; ++c) {
      auto chart = sized<beltrami_session_chart>();
      judged(beltrami_get_session_chart(context_, c, &chart));
      if (chart.status == BELTRAMI_NOT_INJECTIVE) continue;
      promise(is_injective(of_faces, chart.id), "a chart is what is said of it");
    }
  }

  bool is_injective(const std::vector<std::uint64_t>& of_faces, std::uint64_t id) {
    std::vector<std::uint32_t> corners;
    std::vector<Uv> places;
    for (std::size_t f = 0; f < of_faces.size(); ++f) {
      if (of_faces[f] != id) continue;
      for (std::size_t k = 3 * f; k < 3 * f + 3; ++k) {
        corners.push_back(mesh_.corners[k]);
        places.push_back(uvs_[k]);
      }
    }
    beltrami_surface surface = mesh_.surface();
    surface.face_count = corners.size() / 3;
    surface.indices = {corners.data(), 0, BELTRAMI_U32, 0};
    surface.corner_uvs = {places.data(), 0, BELTRAMI_F64, 0};
    auto certificate = sized<beltrami_atlas_certificate>();
    // A face may be turned over in the surface, and all of its chart with it.
    const beltrami_status status = beltrami_check_atlas(&surface, 1, &certificate, nullptr, 0);
    return status == BELTRAMI_OK && certificate.overlaps == 0;
  }

  Provider& data_;
  Mesh mesh_;
  std::vector<double> given_;
  beltrami_context* context_ = nullptr;
  bool has_begun_ = false;
  std::vector<Uv> uvs_;
  std::map<std::uint64_t, std::vector<Uv>> saved_;
};

}  // namespace

void run_one(std::string_view bytes) {
  constexpr int kCalls = 24;
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  Host host(data);
  for (int i = 0; host.has_begun() && i < kCalls && data.remaining_bytes() > 0; ++i) host.call();
}

}  // namespace beltrami::fuzz
