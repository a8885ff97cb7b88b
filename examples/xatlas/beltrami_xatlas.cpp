#include "beltrami_xatlas.h"

#include <beltrami/beltrami.h>

#include <algorithm>
#include <memory>
#include <vector>

void beltrami_xatlas_parameterize(const float* positions, float* texcoords,
                                  std::uint32_t vertex_count, const std::uint32_t* indices,
                                  std::uint32_t index_count) {
  // A context for each chart: charts come on several threads at a time, and contexts share nothing.
  beltrami_context* raw = nullptr;
  if (beltrami_create(&raw) != BELTRAMI_OK) return;
  const std::unique_ptr<beltrami_context, void (*)(beltrami_context*)> context(raw,
                                                                               beltrami_destroy);
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = vertex_count;
  mesh.face_count = index_count / 3;
  mesh.positions = {positions, 0, BELTRAMI_F32, 0};
  mesh.indices = {indices, 0, BELTRAMI_U32, 0};
  if (beltrami_set_mesh(raw, &mesh) != BELTRAMI_OK) return;
  if (beltrami_run(raw, nullptr, nullptr) < 0) return;

  // xatlas keeps floats, so floats are what has to be injective.
  std::vector<float> uvs(std::size_t{2} * vertex_count);
  if (beltrami_get_uvs(raw, uvs.data(), BELTRAMI_F32, 0) != BELTRAMI_OK) return;
  const beltrami_buffer view = {uvs.data(), 0, BELTRAMI_F32, 0};
  beltrami_certificate certificate{};
  certificate.struct_size = sizeof certificate;
  if (beltrami_check_injective(&mesh, &view, &certificate) != BELTRAMI_OK) return;
  std::copy(uvs.begin(), uvs.end(), texcoords);
}
