// beltrami from C++: a context that frees itself, errors as exceptions, progress as any callable.
//
//   c++ -std=c++17 flatten.cpp -lbeltrami -o flatten && ./flatten
#include <beltrami/beltrami.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

// ---- The wrapper: copy it into your program
// ------------------------------------------------------

/// A failed call: its status, the context's sentence, and the face or vertex that caused it.
class BeltramiError : public std::runtime_error {
 public:
  BeltramiError(beltrami_status failed, const beltrami_context* context)
      : std::runtime_error(*beltrami_error_message(context) ? beltrami_error_message(context)
                                                            : beltrami_status_advice(failed)),
        status(failed),
        element(beltrami_error_element(context)),
        element_kind(beltrami_error_element_kind(context)) {}

  const beltrami_status status;
  const std::uint64_t element;
  const std::int32_t element_kind;
};

class Flattener {
 public:
  using Position = std::array<float, 3>;
  using Face = std::array<std::uint32_t, 3>;
  using Uv = std::array<float, 2>;
  /// Returns whether to go on.
  using Progress = std::function<bool(double fraction, const char* stage)>;

  Flattener() {
    beltrami_context* context = nullptr;
    const beltrami_status status = beltrami_create(&context);
    context_.reset(context);
    require(status);
  }

  void set(std::int32_t option, std::int64_t value) {
    require(beltrami_set_int(context_.get(), option, value));
  }

  /// Returns true if every promise was kept, false if the map comes with a reservation.
  bool flatten(const std::vector<Position>& positions, const std::vector<Face>& faces,
               Progress progress = {}) {
    beltrami_mesh mesh{};
    mesh.struct_size = sizeof mesh;
    mesh.vertex_count = positions.size();
    mesh.face_count = faces.size();
    mesh.positions = {positions.data(), sizeof(Position), BELTRAMI_F32, 0};
    mesh.indices = {faces.data(), sizeof(Face), BELTRAMI_U32, 0};
    require(beltrami_set_mesh(context_.get(), &mesh));
    Call call{std::move(progress), nullptr};
    const beltrami_status status = beltrami_run(context_.get(), &Flattener::report, &call);
    if (call.thrown) std::rethrow_exception(call.thrown);
    require(status);
    vertex_count_ = positions.size();
    return status == BELTRAMI_OK;
  }

  std::vector<Uv> uvs() const {
    std::vector<Uv> uvs(vertex_count_);
    require(beltrami_get_uvs(context_.get(), uvs.data(), BELTRAMI_F32, sizeof(Uv)));
    return uvs;
  }

  beltrami_energy energy() const {
    beltrami_energy energy{};
    energy.struct_size = sizeof energy;
    require(beltrami_get_energy(context_.get(), &energy));
    return energy;
  }

  /// Ends the run that is under way. From any thread.
  void cancel() { beltrami_cancel(context_.get()); }

 private:
  struct Call {
    Progress progress;
    std::exception_ptr thrown;
  };
  struct Destroy {
    void operator()(beltrami_context* context) const { beltrami_destroy(context); }
  };

  void require(beltrami_status status) const {
    if (status < 0) throw BeltramiError(status, context_.get());
  }

  /// What the progress throws is carried round the C interface, not through it.
  static std::int32_t report(void* user, double fraction, const char* stage) {
    Call& call = *static_cast<Call*>(user);
    try {
      return !call.progress || call.progress(fraction, stage) ? 0 : 1;
    } catch (...) {
      call.thrown = std::current_exception();
      return 1;
    }
  }

  std::unique_ptr<beltrami_context, Destroy> context_;
  std::size_t vertex_count_ = 0;
};

// ---- A program that uses it
// ----------------------------------------------------------------------

namespace {

constexpr int kRings = 40, kSpokes = 90;

/// A cup: a disk of rings and spokes, bent up to a hemisphere.
void make_cup(std::vector<Flattener::Position>& positions, std::vector<Flattener::Face>& faces) {
  positions.push_back({0, 0, -1});
  for (int ring = 1; ring <= kRings; ++ring) {
    const double down = 1.5 * ring / kRings;
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double turn = 2 * 3.14159265358979 * spoke / kSpokes;
      positions.push_back({static_cast<float>(std::sin(down) * std::cos(turn)),
                           static_cast<float>(std::sin(down) * std::sin(turn)),
                           static_cast<float>(-std::cos(down))});
    }
  }
  const auto at = [](int ring, int spoke) {
    return static_cast<std::uint32_t>(1 + (ring - 1) * kSpokes + spoke % kSpokes);
  };
  for (int spoke = 0; spoke < kSpokes; ++spoke) {
    faces.push_back({0, at(1, spoke), at(1, spoke + 1)});
    for (int ring = 1; ring < kRings; ++ring) {
      faces.push_back({at(ring, spoke), at(ring + 1, spoke), at(ring + 1, spoke + 1)});
      faces.push_back({at(ring, spoke), at(ring + 1, spoke + 1), at(ring, spoke + 1)});
    }
  }
}

}  // namespace

int main() try {
  std::vector<Flattener::Position> positions;
  std::vector<Flattener::Face> faces;
  make_cup(positions, faces);

  Flattener flattener;
  flattener.set(BELTRAMI_OPTION_COARSE_FACES, 1000);
  const bool kept = flattener.flatten(positions, faces);
  const auto uvs = flattener.uvs();
  std::printf("%zu faces: %s, symmetric Dirichlet energy %.4f, first UV (%g, %g)\n", faces.size(),
              kept ? "injective" : "see the certificate", flattener.energy().symmetric_dirichlet,
              uvs[0][0], uvs[0][1]);

  faces.push_back({7, 8, 99999});
  try {
    flattener.flatten(positions, faces);
  } catch (const BeltramiError& error) {
    std::printf("%s, face %llu: %s\n", beltrami_status_name(error.status),
                static_cast<unsigned long long>(error.element), error.what());
    return error.status == BELTRAMI_E_INDEX_OUT_OF_RANGE && kept ? 0 : 1;
  }
  return 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
