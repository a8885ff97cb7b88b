// The C interface as a host of any manners calls it: any functions in any order, with any options,
// sizes and strides. Arrays are as long as the calls say, so that the sanitizer sees what is read
// and written beyond them.
#include <beltrami/beltrami.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "host.h"
#include "target.h"

namespace beltrami::fuzz {
namespace {

/// Keys count from 0, without gaps.
std::int32_t option_count() {
  static const std::int32_t count = [] {
    std::int32_t key = 0;
    auto info = sized<beltrami_option_info>();
    while (beltrami_option_describe(key, &info) == BELTRAMI_OK) ++key;
    return key;
  }();
  return count;
}

/// A surface, a mesh and UV triangles over the same arrays.
struct Input {
  std::uint64_t vertices, faces;
  Array positions, indices, uvs, labels, densities, seams, pins, pin_uvs, paint, edges, edge_paint;
  std::int32_t stop = 0;

  explicit Input(Provider& data)
      : vertices(data.ConsumeIntegralInRange(0u, 9u)), faces(data.ConsumeIntegralInRange(0u, 10u)) {
    const auto last = static_cast<std::uint32_t>(vertices ? vertices - 1 : 0);
    const std::uint32_t limit = data.ConsumeIntegralInRange(0, 20) ? last : last + 2;
    positions = array(data, vertices, 3, true, 0);
    indices = array(data, faces, 3, false, limit);
    uvs = array(data, 3 * faces, 2, true, 0);
    if (data.ConsumeBool()) labels = array(data, faces, 1, false, 2);
    if (data.ConsumeIntegralInRange(0, 7) == 0) densities = array(data, faces, 1, true, 0);
    if (data.ConsumeBool()) seams = array(data, 2, 2, false, limit);
    if (data.ConsumeIntegralInRange(0, 3) == 0) {
      pins = array(data, 3, 1, false, static_cast<std::uint32_t>(3 * faces));
      pin_uvs = array(data, 3, 2, true, 0);
    }
    if (data.ConsumeIntegralInRange(0, 3) == 0) paint = array(data, vertices, 1, true, 0);
    if (data.ConsumeIntegralInRange(0, 3) == 0) {
      edges = array(data, 2, 2, false, limit);
      edge_paint = array(data, 2, 1, true, 0);
    }
    stop = data.ConsumeIntegralInRange(0, 30) == 0;
    if (data.ConsumeBool()) be_a_sheet(data);
  }

  /// A sheet of two squares, or of eight triangles in a square: a disk, which arrays of any numbers
  /// hardly ever are.
  void be_a_sheet(Provider& data) {
    const std::uint64_t columns = 2, rows = data.ConsumeIntegralInRange(1u, 2u);
    vertices = (columns + 1) * (rows + 1);
    faces = 2 * columns * rows;
    std::vector<double> places;
    std::vector<std::uint32_t> corners;
    for (std::uint64_t v = 0; v < vertices; ++v) {
      const double height = data.ConsumeIntegralInRange(-2, 2);
      places.insert(places.end(), {double(v % (columns + 1)), double(v / (columns + 1)), height});
    }
    for (std::uint64_t q = 0; q < columns * rows; ++q) {
      const auto a = static_cast<std::uint32_t>(q + q / columns), b = a + 1;
      const auto c = static_cast<std::uint32_t>(a + columns + 1), d = c + 1;
      corners.insert(corners.end(), {a, b, d, a, d, c});
    }
    const auto items = [&](const auto& numbers, std::size_t width, bool real) {
      return array_of(data, numbers.size() / width, width, real,
                      [&](std::size_t i, std::size_t k) { return numbers[i * width + k]; });
    };
    positions = items(places, 3, true);
    indices = items(corners, 3, false);
    uvs = items(std::vector<double>(6 * faces, 0.5), 2, true);
    for (Array* given :
         {&labels, &densities, &seams, &pins, &pin_uvs, &paint, &edges, &edge_paint}) {
      *given = {};
    }
  }

  beltrami_surface surface(Provider& data) const {
    auto out = sized<beltrami_surface>(data);
    out.vertex_count = vertices;
    out.face_count = faces;
    out.corner_count = data.ConsumeBool() ? 3 * faces : 0;
    out.positions = positions.buffer;
    out.indices = indices.buffer;
    out.corner_uvs = uvs.buffer;
    out.face_labels = labels.buffer;
    out.densities = densities.buffer;
    out.seams = seams.buffer;
    out.seam_count = seams.bytes.empty() ? 0 : 2;
    out.cancel = &stop;
    out.pins = pins.buffer;
    out.pin_uvs = pin_uvs.buffer;
    out.pin_count = pins.bytes.empty() ? 0 : 3;
    out.vertex_paint = paint.buffer;
    out.painted_edges = edges.buffer;
    out.edge_paint = edge_paint.buffer;
    out.painted_edge_count = edges.bytes.empty() ? 0 : 2;
    return out;
  }

  beltrami_mesh mesh(Provider& data) const {
    auto out = sized<beltrami_mesh>(data);
    out.vertex_count = vertices;
    out.face_count = faces;
    out.positions = positions.buffer;
    out.indices = indices.buffer;
    out.cancel = &stop;
    return out;
  }

  beltrami_uv_mesh uv_mesh(Provider& data) const {
    auto out = sized<beltrami_uv_mesh>(data);
    out.uv_count = uvs.bytes.empty() ? 0 : vertices;  // indices are below it, or refused
    out.uv_count = std::min(out.uv_count, 3 * faces);
    out.face_count = faces;
    out.uvs = uvs.buffer;
    out.uv_indices = indices.buffer;
    if (data.ConsumeIntegralInRange(0, 3) == 3) out.page_labels = labels.buffer;
    out.cancel = &stop;
    return out;
  }
};

/// Memory of the host's, which ends now and then.
class Memory {
 public:
  Memory() = default;
  ~Memory() { promise(living_ == 0, "a context gives back what it took"); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  beltrami_allocator allocator() {
    auto made = sized<beltrami_allocator>();
    made.user = this;
    made.allocate = [](void* user, std::uint64_t bytes, std::uint64_t alignment) {
      return static_cast<Memory*>(user)->take(bytes, alignment);
    };
    made.release = [](void* user, void* block, std::uint64_t, std::uint64_t) {
      --static_cast<Memory*>(user)->living_;
      std::free(block);
    };
    return made;
  }

  /// From now on so many blocks are given, and after one that is not all are again; negative: all.
  void give(long blocks) { left_ = blocks; }

 private:
  void* take(std::uint64_t bytes, std::uint64_t alignment) {
    if (left_.fetch_sub(1) == 0) return nullptr;
    ++living_;
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  }

  std::atomic<long> left_ = -1, living_ = 0;
};

class Host {
 public:
  explicit Host(Provider& data) : data_(data), input_(data) {
    beltrami_allocator allocator = memory_.allocator();
    if (data.ConsumeIntegralInRange(0, 31) == 0) {
      allocator.reserved = 1;
      promise(beltrami_create_with(&allocator, &context_) == BELTRAMI_E_INVALID_ARGUMENT,
              "what is reserved is 0");
      allocator.reserved = 0;
    }
    promise(beltrami_create_with(&allocator, &context_) == BELTRAMI_OK, "a context is made");
    // Small pages and no search, so that there are many runs; calls may set them otherwise.
    beltrami_set_int(context_, BELTRAMI_OPTION_RESOLUTION, 16);
    beltrami_set_int(context_, BELTRAMI_OPTION_THREADS, 1);
    beltrami_set_int(context_, BELTRAMI_OPTION_EFFORT, BELTRAMI_EFFORT_QUICK);
    if (data.ConsumeIntegralInRange(0, 3)) {
      beltrami_set_int(context_, BELTRAMI_OPTION_CUT, BELTRAMI_CUT_MINIMAL);
    }
  }
  ~Host() { beltrami_destroy(context_); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  void call() {
    beltrami_context* const context = data_.ConsumeIntegralInRange(0, 60) ? context_ : nullptr;
    switch (data_.ConsumeIntegralInRange(0, 11)) {
      case 0:
      case 1:
        set_option(context);
        break;
      case 2: {
        const beltrami_mesh mesh = input_.mesh(data_);
        judged(context, beltrami_set_mesh(context, &mesh));
        break;
      }
      case 3:
        polls_ = data_.ConsumeIntegralInRange(0, 300);
        judged(context, beltrami_run(context, count_down, &polls_));
        break;
      case 4: {
        const beltrami_surface surface = input_.surface(data_);
        polls_ = data_.ConsumeIntegralInRange(0, 300);
        judged(context, beltrami_unwrap(context, &surface, count_down, &polls_));
        break;
      }
      case 5: {
        const beltrami_uv_mesh mesh = input_.uv_mesh(data_);
        const beltrami_uv_mesh* const meshes[] = {&mesh, &mesh};
        polls_ = data_.ConsumeIntegralInRange(0, 300);
        const std::uint64_t count = data_.ConsumeIntegralInRange(0u, 2u);
        judged(context, beltrami_pack(context, meshes, count, count_down, &polls_));
        break;
      }
      case 6:
        read_structs(context);
        break;
      case 7:
        read_arrays(context);
        break;
      case 8:
        check();
        break;
      case 9:
        memory_.give(data_.ConsumeIntegralInRange(-1, 2000));
        break;
      case 10:
        judged(context, beltrami_set_parallel_for(
                            context, data_.ConsumeBool() ? run_backwards : nullptr, nullptr));
        break;
      default:
        beltrami_cancel(context);
    }
  }

 private:
  static void run_backwards(void*, std::int32_t count, beltrami_job job, void* data) {
    for (std::int32_t i = count; i-- > 0;) job(data, i);
  }

  void judged(beltrami_context* context, beltrami_status status) {
    judge_status(context, status);
    const std::int32_t kind = beltrami_error_element_kind(context);
    promise(
        (kind == BELTRAMI_ELEMENT_NONE) == (beltrami_error_element(context) == BELTRAMI_NO_ELEMENT),
        "an element has a kind");
  }

  void set_option(beltrami_context* context) {
    const std::int32_t key = data_.ConsumeIntegralInRange(-1, option_count());
    if (key == BELTRAMI_OPTION_THREADS || key == BELTRAMI_OPTION_RESOLUTION) {
      // What is only slow: the memory of threads, and pages of a billion texels.
      beltrami_set_int(context, key, data_.ConsumeIntegralInRange(8, 64) / 8);
      return;
    }
    beltrami_option_info info{};
    info.struct_size = sizeof info;
    const bool known = beltrami_option_describe(key, &info) == BELTRAMI_OK;
    promise(known == (key >= 0 && key < option_count()), "all keys are described");
    if (known) promise(beltrami_option_find(info.name) == key, "names find their keys");
    const std::int64_t number = data_.ConsumeBool() ? data_.ConsumeIntegralInRange(-1, 4)
                                                    : data_.ConsumeIntegral<std::int64_t>();
    beltrami_option_choice(key, static_cast<std::int32_t>(number));
    const bool real = data_.ConsumeBool() || (known && info.type == BELTRAMI_TYPE_FLOAT);
    const double value = data_.ConsumeBool() ? data_.ConsumeFloatingPointInRange(0.0, 10.0)
                                             : data_.ConsumeFloatingPoint<double>();
    const beltrami_status status =
        real ? beltrami_set_float(context, key, value) : beltrami_set_int(context, key, number);
    judged(context, status);
    double back = 0;
    if (status != BELTRAMI_OK) return;
    judged(context, beltrami_get_option(context, key, &back));
    promise(back >= info.minimum && back <= info.maximum, "an option is in its range");
  }

  void read_structs(beltrami_context* context) {
    auto atlas = sized<beltrami_atlas>(data_);
    judged(context, beltrami_get_atlas(context, &atlas));
    auto result = sized<beltrami_result>(data_);
    judged(context, beltrami_get_result(context, &result));
    auto packing = sized<beltrami_packing>(data_);
    judged(context, beltrami_get_packing(context, &packing));
    auto chart = sized<beltrami_chart>(data_);
    judged(context, beltrami_get_chart(context, data_.ConsumeIntegral<std::uint8_t>(), &chart));
    auto certificate = sized<beltrami_atlas_certificate>(data_);
    const std::int32_t type = data_.ConsumeIntegralInRange(-1, 4);
    judged(context, beltrami_get_atlas_certificate(context, type, &certificate));
    judged(context, beltrami_get_packing_certificate(context, type, &certificate));
    auto disk = sized<beltrami_certificate>(data_);
    judged(context, beltrami_get_certificate(context, &disk));
    judged(context, beltrami_get_float32_certificate(context, &disk));
    auto energy = sized<beltrami_energy>(data_);
    judged(context, beltrami_get_energy(context, &energy));
    auto stage = sized<beltrami_stage>(data_);
    const std::int32_t index = data_.ConsumeIntegralInRange(-1, 30);
    judged(context, beltrami_get_stage(context, index, &stage));
    judged(context, beltrami_get_atlas_stage(context, index, &stage));
    promise(beltrami_stage_count(context) >= 0, "stages are counted");
    promise(beltrami_atlas_stage_count(context) >= 0, "stages of an atlas are counted");
    std::uint64_t bytes = 0;
    judged(context, beltrami_estimate_memory(context, &bytes));
    beltrami_get_atlas(context, nullptr);
    beltrami_get_option(context, BELTRAMI_OPTION_CUT, nullptr);
  }

  /// `call` writes `items` of `width` numbers, real ones or whole ones.
  template <class Call>
  void read(beltrami_context* context, std::uint64_t items, std::size_t width, bool real,
            const Call& call) {
    std::int32_t type = data_.ConsumeIntegralInRange(0, 1) + (real ? 0 : 2);
    if (data_.ConsumeIntegralInRange(0, 15) == 0) type = data_.ConsumeIntegralInRange(-2, 5);
    const std::size_t packed = width * (is_wide(type) ? 8 : 4);
    const std::size_t gap = data_.ConsumeIntegralInRange<std::size_t>(0, 9);
    std::vector<char> out(items ? (items - 1) * (packed + gap) + packed : 0);
    const std::uint64_t stride = gap ? packed + gap : 0;
    judged(context, call(out.data(), type, stride));
  }

  void read_arrays(beltrami_context* context) {
    beltrami_atlas atlas{};
    atlas.struct_size = sizeof atlas;
    const bool unwrapped = beltrami_get_atlas(context, &atlas) == BELTRAMI_OK;
    if (unwrapped) {
      const auto get = [&](std::uint64_t items, std::size_t width, bool real, auto function) {
        read(context, items, width, real, [&](void* out, std::int32_t type, std::uint64_t stride) {
          return function(context, out, type, stride);
        });
      };
      get(atlas.corners, 2, true, beltrami_get_corner_uvs);
      get(atlas.corners, 1, false, beltrami_get_corner_pages);
      get(atlas.corners, 1, false, beltrami_get_corner_uv_vertices);
      get(atlas.uv_vertices, 2, true, beltrami_get_uv_vertices);
      get(atlas.uv_vertices, 1, false, beltrami_get_uv_vertex_origins);
      get(atlas.faces, 1, false, beltrami_get_face_charts);
      get(atlas.seams, 2, false, beltrami_get_seams);
      get(atlas.triangles, 3, false, beltrami_get_triangles);
    } else {
      double nothing = 0;
      judged(context, beltrami_get_corner_uvs(context, &nothing, BELTRAMI_F64, 0));
    }
    read_disk(context);
    read_packing(context);
  }

  void read_disk(beltrami_context* context) {
    beltrami_result result{};
    result.struct_size = sizeof result;
    if (beltrami_get_result(context, &result) != BELTRAMI_OK) return;
    read(context, result.vertices, 2, true,
         [&](void* out, std::int32_t type, std::uint64_t stride) {
           return beltrami_get_uvs(context, out, type, stride);
         });
    std::vector<double> energies(result.faces);
    judged(context, beltrami_get_face_energies(context, energies.data(), 0));
    read(context, result.faces, 3, false, [&](void* out, std::int32_t type, std::uint64_t stride) {
      return beltrami_get_faces(context, out, type, stride);
    });
  }

  void read_packing(beltrami_context* context) {
    beltrami_packing packing{};
    packing.struct_size = sizeof packing;
    if (beltrami_get_packing(context, &packing) != BELTRAMI_OK) return;
    read(context, packing.pages, 1, true, [&](void* out, std::int32_t type, std::uint64_t stride) {
      return beltrami_get_page_utilisations(context, out, type, stride);
    });
    read(context, packing.charts, 1, false,
         [&](void* out, std::int32_t type, std::uint64_t stride) {
           return beltrami_get_chart_pages(context, out, type, stride);
         });
    std::vector<std::uint8_t> texels(packing.resolution * packing.resolution);
    const std::uint64_t page = data_.ConsumeIntegralInRange(0u, 2u);
    judged(context, beltrami_get_page_mask(context, page, texels.data(), 0));
  }

  /// What needs no context and cannot fail.
  void ask_the_library() {
    static constexpr std::array<const char*, 6> kFeatures = {
        "gpl", "lgpl", "allocator", "solver:native", "exact:own", "none"};
    for (const char* feature : kFeatures) {
      const std::int32_t has = beltrami_has(feature);
      promise(has == 0 || has == 1, "a build has a feature or not");
    }
    promise(beltrami_has(nullptr) == 0, "no build has nothing");
    promise(beltrami_option_find("none") < 0, "what is no option has no key");
    const std::int32_t status = data_.ConsumeIntegralInRange(-50, 5);
    promise(beltrami_status_advice(status) != nullptr, "every number has an advice");
    promise(beltrami_version() > 0 && beltrami_build_info() != nullptr,
            "the library has a version");
  }

  void check() {
    ask_the_library();
    const beltrami_surface surface = input_.surface(data_);
    auto certificate = sized<beltrami_atlas_certificate>(data_);
    std::array<std::uint64_t, 8> pairs{};
    const std::uint64_t capacity = data_.ConsumeIntegralInRange(0u, 4u);
    beltrami_check_atlas(&surface, data_.ConsumeBool(), &certificate, pairs.data(), capacity);
    const beltrami_mesh mesh = input_.mesh(data_);
    auto disk = sized<beltrami_certificate>(data_);
    auto energy = sized<beltrami_energy>(data_);
    if (input_.vertices > 3 * input_.faces) return;  // as many UVs as vertices
    beltrami_check_triangles(&mesh, &input_.uvs.buffer, &disk);
    beltrami_check_boundary(&mesh, &input_.uvs.buffer, &disk);
    beltrami_check_injective(&mesh, &input_.uvs.buffer, &disk);
    std::vector<double> energies(input_.faces);
    beltrami_measure(&mesh, &input_.uvs.buffer, &energy, energies.data());
    std::vector<double> four(4 * input_.faces);
    beltrami_measure_faces(&mesh, &input_.uvs.buffer, four.data(), 0);
    std::vector<std::uint64_t> triangles(3 * input_.faces);
    beltrami_triangulate(&surface, triangles.data(), BELTRAMI_U64, 0, nullptr);
  }

  Provider& data_;
  Input input_;
  Memory memory_;
  beltrami_context* context_ = nullptr;
  int polls_ = 0;
};

}  // namespace

void run_one(std::string_view bytes) {
  constexpr int kCalls = 12;
  Provider data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  Host host(data);
  for (int i = 0; i < kCalls && data.remaining_bytes() > 0; ++i) host.call();
}

}  // namespace beltrami::fuzz
