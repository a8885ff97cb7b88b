// The checks and the measure of the caller's own arrays.
#include <cmath>
#include <cstddef>
#include <limits>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;
using Uvs = std::vector<std::array<double, 2>>;
using Check = beltrami_status(const beltrami_mesh*, const beltrami_buffer*, beltrami_certificate*);

struct Verdict {
  beltrami_status status;
  beltrami_certificate certificate;
};

template <class AnyUvs>
Verdict verdict(Check* check, const TriangleList& mesh, const AnyUvs& uvs) {
  const beltrami_mesh mesh_view = view(mesh);
  const beltrami_buffer uv_view = view(uvs);
  Verdict verdict{0, sized<beltrami_certificate>()};
  verdict.status = check(&mesh_view, &uv_view, &verdict.certificate);
  return verdict;
}

TEST(Checks, AcceptAnInjectiveMap) {
  const TriangleList mesh = meshes::grid(4, 3);
  const Uvs uvs = flat_uvs(mesh);
  const Verdict both = verdict(beltrami_check_injective, mesh, uvs);
  EXPECT_EQ(both.status, BELTRAMI_OK);
  EXPECT_EQ(both.certificate.injective, 1);
  EXPECT_EQ(both.certificate.positive, 24u);
  EXPECT_EQ(both.certificate.negative + both.certificate.degenerate, 0u);
  EXPECT_EQ(both.certificate.boundary_crossings, 0u);
  EXPECT_EQ(both.certificate.first_bad_face, BELTRAMI_NO_ELEMENT);
  EXPECT_EQ(both.certificate.first_crossing[0], BELTRAMI_NO_ELEMENT);
  EXPECT_EQ(both.certificate.first_crossing[1], BELTRAMI_NO_ELEMENT);
  EXPECT_EQ(both.certificate.error_element, BELTRAMI_NO_ELEMENT);

  const Verdict triangles = verdict(beltrami_check_triangles, mesh, uvs);
  EXPECT_EQ(triangles.status, BELTRAMI_OK);
  EXPECT_EQ(triangles.certificate.positive, 24u);
  EXPECT_EQ(triangles.certificate.injective, 0) << "orientations alone prove nothing";
  const Verdict boundary = verdict(beltrami_check_boundary, mesh, uvs);
  EXPECT_EQ(boundary.status, BELTRAMI_OK);
  EXPECT_EQ(boundary.certificate.injective, 0) << "a simple boundary alone proves nothing";
}

TEST(Checks, CountFlippedAndDegenerateFaces) {
  const TriangleList mesh = meshes::quad();
  Uvs uvs = flat_uvs(mesh);
  uvs[3] = {1, 0.5};  // across the diagonal: face 1 flips
  Verdict found = verdict(beltrami_check_triangles, mesh, uvs);
  EXPECT_EQ(found.status, BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(found.certificate.negative, 1u);
  EXPECT_EQ(found.certificate.first_bad_face, 1u);
  uvs[3] = {0.5, 0.5};  // on the diagonal
  found = verdict(beltrami_check_injective, mesh, uvs);
  EXPECT_EQ(found.status, BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(found.certificate.degenerate, 1u);
  EXPECT_EQ(found.certificate.injective, 0);
}

TEST(Checks, SeeASliverThatF32Flattens) {
  const TriangleList mesh = meshes::triangle();
  const Uvs wide = {{0, 0}, {1, 1}, {0.5, 0.5 + 0x1p-40}};
  std::vector<std::array<float, 2>> narrow;
  for (const auto& uv : wide) {
    narrow.push_back({static_cast<float>(uv[0]), static_cast<float>(uv[1])});
  }
  EXPECT_EQ(verdict(beltrami_check_injective, mesh, wide).status, BELTRAMI_OK);
  const Verdict flattened = verdict(beltrami_check_injective, mesh, narrow);
  EXPECT_EQ(flattened.status, BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(flattened.certificate.degenerate, 1u);
}

TEST(Checks, SeeABoundaryThatCrossesItself) {
  // A long strip bent round onto its own start: every face positive, yet not injective.
  const TriangleList mesh = meshes::strip(24);
  Uvs uvs;
  for (const Vec3& p : mesh.positions) {
    const double angle = -8 * p.x(), radius = 2 + p.y();  // 8 > 2 pi
    uvs.push_back({radius * std::cos(angle), radius * std::sin(angle)});
  }
  ASSERT_EQ(verdict(beltrami_check_triangles, mesh, uvs).status, BELTRAMI_OK);
  for (Check* check : {beltrami_check_boundary, beltrami_check_injective}) {
    const Verdict found = verdict(check, mesh, uvs);
    EXPECT_EQ(found.status, BELTRAMI_NOT_INJECTIVE);
    EXPECT_GE(found.certificate.boundary_crossings, 1u);
    EXPECT_LT(found.certificate.first_crossing[0], uvs.size());
    EXPECT_LT(found.certificate.first_crossing[1], uvs.size());
    EXPECT_EQ(found.certificate.injective, 0);

    const TriangleList shifted = meshes::with_unused_in_front(mesh, 100);
    Uvs padded(100, {std::nan(""), 0});
    padded.insert(padded.end(), uvs.begin(), uvs.end());
    const Verdict again = verdict(check, shifted, padded);
    EXPECT_EQ(again.certificate.first_crossing[0], found.certificate.first_crossing[0] + 100);
    EXPECT_EQ(again.certificate.first_crossing[1], found.certificate.first_crossing[1] + 100);
  }
}

TEST(Checks, TrianglesNeedNoTopology) {
  const TriangleList soup = meshes::three_on_an_edge();
  EXPECT_EQ(verdict(beltrami_check_triangles, soup, flat_uvs(soup)).certificate.positive, 2u);
  TriangleList repeated = meshes::quad();
  repeated.faces[1] = {2, 2, 3};
  const Verdict found = verdict(beltrami_check_triangles, repeated, flat_uvs(repeated));
  EXPECT_EQ(found.status, BELTRAMI_NOT_INJECTIVE);
  EXPECT_EQ(found.certificate.degenerate, 1u);
  EXPECT_EQ(found.certificate.first_bad_face, 1u);
}

TEST(Checks, RefuseWhatIsNoDiskWithTheElement) {
  const TriangleList apart = meshes::with_unused_in_front(meshes::bowtie(), 10);
  for (Check* check : {beltrami_check_boundary, beltrami_check_injective}) {
    const Verdict found = verdict(check, apart, flat_uvs(apart));
    EXPECT_EQ(found.status, BELTRAMI_E_NON_MANIFOLD_VERTEX);
    EXPECT_EQ(found.certificate.error_element, 10u);
    EXPECT_EQ(found.certificate.error_element_kind, BELTRAMI_ELEMENT_VERTEX);
    EXPECT_EQ(found.certificate.injective, 0);
    EXPECT_EQ(found.certificate.positive, 0u);
  }
}

TEST(Checks, NeedNoPositions) {
  const TriangleList mesh = meshes::quad();
  beltrami_mesh mesh_view = view(mesh);
  mesh_view.positions = {};
  const Uvs uvs = flat_uvs(mesh);
  const beltrami_buffer uv_view = view(uvs);
  auto certificate = sized<beltrami_certificate>();
  for (Check* check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    EXPECT_EQ(check(&mesh_view, &uv_view, &certificate), BELTRAMI_OK);
  }
  auto energy = sized<beltrami_energy>();
  EXPECT_EQ(beltrami_measure(&mesh_view, &uv_view, &energy, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Checks, RefuseNonFiniteUvsAndWildIndices) {
  TriangleList mesh = meshes::quad();
  Uvs uvs = flat_uvs(mesh);
  uvs[2][1] = std::numeric_limits<double>::infinity();
  for (Check* check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    const Verdict found = verdict(check, mesh, uvs);
    EXPECT_EQ(found.status, BELTRAMI_E_NON_FINITE);
    EXPECT_EQ(found.certificate.error_element, 2u);
    EXPECT_EQ(found.certificate.error_element_kind, BELTRAMI_ELEMENT_VERTEX);
  }
  mesh.faces[1][2] = 4;
  for (Check* check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    const Verdict found = verdict(check, mesh, uvs);
    EXPECT_EQ(found.status, BELTRAMI_E_INDEX_OUT_OF_RANGE);
    EXPECT_EQ(found.certificate.error_element, 1u);
    EXPECT_EQ(found.certificate.error_element_kind, BELTRAMI_ELEMENT_FACE);
  }
}

TEST(Checks, SurviveNull) {
  const TriangleList mesh = meshes::quad();
  const beltrami_mesh mesh_view = view(mesh);
  const Uvs uvs = flat_uvs(mesh);
  const beltrami_buffer uv_view = view(uvs);
  auto certificate = sized<beltrami_certificate>();
  auto energy = sized<beltrami_energy>();
  for (Check* check :
       {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
    EXPECT_EQ(check(nullptr, &uv_view, &certificate), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_EQ(check(&mesh_view, nullptr, &certificate), BELTRAMI_E_INVALID_ARGUMENT);
    EXPECT_EQ(check(&mesh_view, &uv_view, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  }
  EXPECT_EQ(beltrami_measure(nullptr, &uv_view, &energy, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_measure(&mesh_view, nullptr, &energy, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_measure(&mesh_view, &uv_view, nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Measure, KnowsIsometriesStretchesAndFlips) {
  const TriangleList mesh = meshes::quad();
  const beltrami_mesh mesh_view = view(mesh);
  Uvs uvs = flat_uvs(mesh);
  const beltrami_buffer uv_view = view(uvs);
  auto energy = sized<beltrami_energy>();
  double faces[2];
  ASSERT_EQ(beltrami_measure(&mesh_view, &uv_view, &energy, faces), BELTRAMI_OK);
  EXPECT_NEAR(energy.symmetric_dirichlet, 2, 1e-14);
  EXPECT_NEAR(energy.symmetric_arap, 0, 1e-14);
  EXPECT_EQ(energy.left_out, 0u);

  for (auto& uv : uvs) uv[0] *= 2;  // singular values 2 and 1
  ASSERT_EQ(beltrami_measure(&mesh_view, &uv_view, &energy, faces), BELTRAMI_OK);
  EXPECT_NEAR(energy.symmetric_dirichlet, 0.5 * (4 + 1 + 0.25 + 1), 1e-14);
  EXPECT_NEAR(energy.symmetric_arap, 1, 1e-14);
  EXPECT_NEAR(energy.max, faces[energy.worst_face], 0);

  uvs = flat_uvs(mesh);
  uvs[3] = {1, 0.5};
  const beltrami_buffer flipped = view(uvs);
  ASSERT_EQ(beltrami_measure(&mesh_view, &flipped, &energy, faces), BELTRAMI_OK);
  EXPECT_EQ(energy.left_out, 1u);
  EXPECT_EQ(energy.worst_face, 0u);
  EXPECT_TRUE(std::isinf(faces[1]));
  EXPECT_NEAR(energy.symmetric_dirichlet, 2, 1e-14);
}

TEST(Measure, GivesSingularValuesOfEveryFace) {
  TriangleList mesh = meshes::quad();
  mesh.faces.push_back({0, 1, 1});  // without area
  Uvs uvs = flat_uvs(mesh);
  for (auto& uv : uvs) uv[0] *= 2;
  const beltrami_mesh mesh_view = view(mesh);
  const beltrami_buffer uv_view = view(uvs);
  double faces[3][5];
  ASSERT_EQ(beltrami_measure_faces(&mesh_view, &uv_view, faces, sizeof faces[0]), BELTRAMI_OK);
  for (int f = 0; f < 2; ++f) {
    EXPECT_NEAR(faces[f][0], 2, 1e-14);
    EXPECT_NEAR(faces[f][1], 1, 1e-14);
    EXPECT_NEAR(faces[f][2], 3.125, 1e-14);
    EXPECT_NEAR(faces[f][3], 1, 1e-14);
  }
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(std::isnan(faces[2][i]));

  for (auto& uv : uvs) uv[0] *= -1;  // a mirror image
  ASSERT_EQ(beltrami_measure_faces(&mesh_view, &uv_view, faces, sizeof faces[0]), BELTRAMI_OK);
  EXPECT_NEAR(faces[0][0], 2, 1e-14);
  EXPECT_NEAR(faces[0][1], -1, 1e-14);
  EXPECT_TRUE(std::isinf(faces[0][2]) && std::isinf(faces[0][3]));

  for (auto& uv : uvs) uv = {1, 1};  // to a point
  ASSERT_EQ(beltrami_measure_faces(&mesh_view, &uv_view, faces, sizeof faces[0]), BELTRAMI_OK);
  EXPECT_EQ(faces[0][0], 0);
  EXPECT_EQ(faces[0][1], 0);
  auto energy = sized<beltrami_energy>();
  ASSERT_EQ(beltrami_measure(&mesh_view, &uv_view, &energy, nullptr), BELTRAMI_OK);
  EXPECT_EQ(energy.left_out, 3u);
  EXPECT_TRUE(std::isnan(energy.symmetric_dirichlet));

  EXPECT_EQ(beltrami_measure_faces(&mesh_view, &uv_view, nullptr, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_measure_faces(nullptr, &uv_view, faces, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_measure_faces(&mesh_view, nullptr, faces, 0), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Measure, AgreesWithTheRun) {
  const TriangleList mesh = meshes::bumps(7, 6);
  const Context context = loaded(mesh);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const Uvs got = uvs(context, mesh.positions.size());
  const beltrami_mesh mesh_view = view(mesh);
  const beltrami_buffer uv_view = view(got);
  auto measured = sized<beltrami_energy>(), reported = sized<beltrami_energy>();
  ASSERT_EQ(beltrami_measure(&mesh_view, &uv_view, &measured, nullptr), BELTRAMI_OK);
  ASSERT_EQ(beltrami_get_energy(context.get(), &reported), BELTRAMI_OK);
  EXPECT_NEAR(measured.symmetric_dirichlet / reported.symmetric_dirichlet, 1, 1e-12);
  EXPECT_NEAR(measured.symmetric_arap / reported.symmetric_arap, 1, 1e-12);
  EXPECT_EQ(measured.worst_face, reported.worst_face);
}

// ---- Cancelling -----------------------------------------------------------------------------

TEST(Checks, EndWhereTheCallerAsksForIt) {
  const TriangleList mesh = meshes::grid(10, 10);
  const Uvs uvs = flat_uvs(mesh);
  const beltrami_buffer uv_view = view(uvs);
  beltrami_mesh mesh_view = view(mesh);
  int32_t number = 0;
  mesh_view.cancel = &number;
  std::vector<double> values(4 * mesh.faces.size());
  const Context context = create();
  const auto statuses = [&] {
    std::vector<beltrami_status> all;
    beltrami_certificate certificate = sized<beltrami_certificate>();
    for (Check* check :
         {beltrami_check_triangles, beltrami_check_boundary, beltrami_check_injective}) {
      all.push_back(check(&mesh_view, &uv_view, &certificate));
    }
    beltrami_energy energy = sized<beltrami_energy>();
    all.push_back(beltrami_measure(&mesh_view, &uv_view, &energy, nullptr));
    all.push_back(beltrami_measure_faces(&mesh_view, &uv_view, values.data(), 0));
    all.push_back(beltrami_set_mesh(context.get(), &mesh_view));
    return all;
  };
  EXPECT_EQ(statuses(), std::vector<beltrami_status>(6, BELTRAMI_OK));
  number = 1;
  EXPECT_EQ(statuses(), std::vector<beltrami_status>(6, BELTRAMI_E_CANCELLED));
  EXPECT_EQ(run(context), BELTRAMI_OK) << "the mesh of before is still there";
  // A caller that does not know the field.
  mesh_view.struct_size = offsetof(beltrami_mesh, cancel);
  EXPECT_EQ(statuses(), std::vector<beltrami_status>(6, BELTRAMI_OK));
}

}  // namespace
}  // namespace beltrami
