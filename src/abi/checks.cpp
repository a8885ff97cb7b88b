// The checks of the caller's own arrays: no context, nothing kept.
#include <beltrami/beltrami.h>

#include "abi/buffers.h"
#include "abi/failure.h"
#include "abi/input_mesh.h"
#include "abi/reports.h"
#include "base/interrupt.h"
#include "base/types.h"
#include "base/vectors.h"
#include "base/work.h"
#include "energy/measure.h"
#include "exact/certificate.h"
#include "exact/crossings.h"
#include "mesh/disk_mesh.h"
#include "mesh/surface.h"

namespace beltrami {
namespace {

constexpr int kThreads = 1;  // a check takes no options, and threads must be asked for

enum class Scope { kTriangles, kBoundary, kInjective };

/// Fills `report` and returns OK or NOT_INJECTIVE; throws Error.
beltrami_status judge(Scope scope, const beltrami_mesh* theirs, const beltrami_buffer* uvs,
                      beltrami_certificate& report) {
  const beltrami_mesh mesh = read_mesh_header(theirs);
  const InterruptScope interruptible({nullptr, mesh.cancel, {}});
  const Work work(kThreads);
  if (scope == Scope::kTriangles) {
    const InputTriangles triangles = read_triangles(mesh, work);
    const std::vector<Vec2> points = read_uvs(uvs, mesh.vertex_count, triangles.original, work);
    const Orientations found = count_orientations(triangles.faces, points, work);
    describe_orientations(report, found);
    return found.negative + found.degenerate == 0 ? BELTRAMI_OK : BELTRAMI_NOT_INJECTIVE;
  }
  const InputDisk input = read_topology(mesh, work);
  const std::vector<Vec2> points = read_uvs(uvs, mesh.vertex_count, input.original, work);
  if (scope == Scope::kBoundary) {
    const Crossings found = count_crossings(input.disk.boundary, points);
    describe_crossings(report, found, input.original);
    return found.count == 0 ? BELTRAMI_OK : BELTRAMI_NOT_INJECTIVE;
  }
  const Certificate found = certify(input.disk.faces, input.disk.boundary, points, work);
  describe_orientations(report, found.orientations);
  describe_crossings(report, found.crossings, input.original);
  report.injective = found.injective() ? 1 : 0;
  return found.injective() ? BELTRAMI_OK : BELTRAMI_NOT_INJECTIVE;
}

beltrami_status check(Scope scope, const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                      beltrami_certificate* out) noexcept {
  Failure failure;
  beltrami_status status = guarded(failure, [&] {
    require_sized(out, "out");
    return BELTRAMI_OK;
  });
  if (status != BELTRAMI_OK) return status;
  beltrami_certificate report = empty_certificate();
  status = guarded(failure, [&] { return judge(scope, mesh, uvs, report); });
  if (status < 0) {
    report = empty_certificate();
    report.error_element = failure.element();
    report.error_element_kind = failure.element_kind();
  }
  write_sized(out, report);
  return status;
}

/// What a measure takes: any triangles, with positions and UVs.
struct Measured {
  InputTriangles triangles;
  std::vector<Vec3> positions;
  std::vector<Vec2> uvs;
};

/// Throws Error.
Measured read_measured(const beltrami_mesh& mesh, const beltrami_buffer* uvs, const Work& work) {
  Measured input{read_triangles(mesh, work), {}, {}};
  input.positions = read_positions(mesh, input.triangles.original, work);
  validate_positions(input.positions, work);
  input.uvs = read_uvs(uvs, mesh.vertex_count, input.triangles.original, work);
  return input;
}

}  // namespace
}  // namespace beltrami

beltrami_status beltrami_check_triangles(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                         beltrami_certificate* out) {
  return beltrami::check(beltrami::Scope::kTriangles, mesh, uvs, out);
}

beltrami_status beltrami_check_boundary(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                        beltrami_certificate* out) {
  return beltrami::check(beltrami::Scope::kBoundary, mesh, uvs, out);
}

beltrami_status beltrami_check_injective(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                         beltrami_certificate* out) {
  return beltrami::check(beltrami::Scope::kInjective, mesh, uvs, out);
}

beltrami_status beltrami_measure(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                 beltrami_energy* out, double* face_energies) {
  beltrami::Failure unused;
  return beltrami::guarded(unused, [&] {
    beltrami::require_sized(out, "out");
    const beltrami_mesh header = beltrami::read_mesh_header(mesh);
    const beltrami::InterruptScope interruptible({nullptr, header.cancel, {}});
    const beltrami::Work work(beltrami::kThreads);
    const beltrami::Measured input = beltrami::read_measured(header, uvs, work);
    beltrami::write_sized(
        out, beltrami::describe_distortion(beltrami::measure_distortion(
                 input.positions, input.triangles.faces, input.uvs, face_energies, work)));
    return BELTRAMI_OK;
  });
}

beltrami_status beltrami_measure_faces(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                       void* out, uint64_t stride) {
  beltrami::Failure unused;
  return beltrami::guarded(unused, [&] {
    const beltrami_mesh header = beltrami::read_mesh_header(mesh);
    const beltrami::InterruptScope interruptible({nullptr, header.cancel, {}});
    const beltrami::Work work(beltrami::kThreads);
    const beltrami::Measured input = beltrami::read_measured(header, uvs, work);
    const std::vector<beltrami::Triangle>& faces = input.triangles.faces;
    beltrami::Writer writer(out, BELTRAMI_F64, stride, faces.size(), 4);
    beltrami::PollSometimes poll;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      poll();
      const auto [a, b, c] = faces[f];
      const beltrami::FaceDistortion found =
          beltrami::measure_face({input.positions[a], input.positions[b], input.positions[c]},
                                 {input.uvs[a], input.uvs[b], input.uvs[c]});
      const double item[] = {found.s1, found.s2, found.symmetric_dirichlet, found.symmetric_arap};
      writer.write(f, item);
    }
    return BELTRAMI_OK;
  });
}
