// Contexts, statuses, and what becomes of meshes that are no disks.
#include <cmath>
#include <limits>
#include <set>

#include "abi/host.h"
#include "base/vectors.h"
#include "support/meshes.h"

extern "C" int beltrami_c_client_works(void);

namespace beltrami {
namespace {

using namespace host;
using meshes::TriangleList;

TEST(Library, TellsItsVersion) {
  EXPECT_EQ(beltrami_version(), 1000000u * BELTRAMI_VERSION_MAJOR + 1000u * BELTRAMI_VERSION_MINOR +
                                    BELTRAMI_VERSION_PATCH);
  const std::string info = beltrami_build_info();
  const std::string version = std::to_string(BELTRAMI_VERSION_MAJOR) + "." +
                              std::to_string(BELTRAMI_VERSION_MINOR) + "." +
                              std::to_string(BELTRAMI_VERSION_PATCH);
  EXPECT_NE(info.find(version), std::string::npos) << info;
  EXPECT_NE(info.find("GPL"), std::string::npos) << info;
}

TEST(Library, HasOneSolver) {
  EXPECT_EQ(beltrami_has("solver:native") + beltrami_has("solver:eigen") +
                beltrami_has("solver:cholmod") + beltrami_has("solver:cholmod-simplicial"),
            1);
  EXPECT_EQ(beltrami_has("scaffold:own") + beltrami_has("scaffold:cgal"), 1);
  EXPECT_EQ(beltrami_has("simplifier:native") + beltrami_has("simplifier:openmesh"), 1);
  EXPECT_EQ(beltrami_has("exact:own") + beltrami_has("exact:cgal"), 1);
  EXPECT_EQ(beltrami_has("lgpl"), beltrami_has("exact:cgal") || beltrami_has("solver:cholmod") ||
                                      beltrami_has("solver:cholmod-simplicial"));
  EXPECT_EQ(beltrami_has("gpl"), beltrami_has("solver:cholmod") || beltrami_has("scaffold:cgal"));
  EXPECT_EQ(beltrami_has("solver:"), 0);
  EXPECT_EQ(beltrami_has(""), 0);
  EXPECT_EQ(beltrami_has(nullptr), 0);
}

TEST(Library, WorksFromC) {
  EXPECT_EQ(beltrami_c_client_works(), 1);
}

TEST(Status, EachHasANameAndAdvice) {
  std::set<std::string> names;
  for (const beltrami_status status : {2,   1,   0,   -1,  -2,  -3,  -4,  -5,  -6,  -7,  -20, -21,
                                       -22, -23, -24, -25, -26, -27, -28, -29, -30, -31, -40}) {
    const std::string name = beltrami_status_name(status);
    EXPECT_EQ(name.rfind("BELTRAMI_", 0), 0u) << status;
    EXPECT_TRUE(names.insert(name).second) << name;
    EXPECT_EQ(std::string(beltrami_status_advice(status)).back(), '.') << name;
  }
  EXPECT_STREQ(beltrami_status_name(BELTRAMI_E_CLOSED), "BELTRAMI_E_CLOSED");
  EXPECT_STREQ(beltrami_status_name(12345), "unknown");
  EXPECT_NE(beltrami_status_advice(-12345), nullptr);
}

TEST(Create, RefusesAnotherAbi) {
  auto* context = reinterpret_cast<beltrami_context*>(8);
  EXPECT_EQ(beltrami_create_(BELTRAMI_ABI + 1, &context), BELTRAMI_E_ABI_MISMATCH);
  EXPECT_EQ(context, nullptr);
  EXPECT_EQ(beltrami_create(nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Context, SurvivesNullEverywhere) {
  beltrami_destroy(nullptr);
  beltrami_cancel(nullptr);
  EXPECT_STREQ(beltrami_error_message(nullptr), "");
  EXPECT_EQ(beltrami_error_element(nullptr), BELTRAMI_NO_ELEMENT);
  EXPECT_EQ(beltrami_error_element_kind(nullptr), BELTRAMI_ELEMENT_NONE);
  EXPECT_EQ(beltrami_set_int(nullptr, 0, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_set_float(nullptr, 0, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_set_mesh(nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_run(nullptr, nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_result(nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_uvs(nullptr, nullptr, 0, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_certificate(nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_energy(nullptr, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_face_energies(nullptr, nullptr, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_stage_count(nullptr), 0);
  EXPECT_EQ(beltrami_get_stage(nullptr, 0, nullptr), BELTRAMI_E_INVALID_ARGUMENT);

  const Context context = loaded(meshes::quad());
  EXPECT_EQ(beltrami_set_mesh(context.get(), nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_FALSE(message(context).empty());
  ASSERT_EQ(run(context), BELTRAMI_OK);
  EXPECT_EQ(beltrami_get_result(context.get(), nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_uvs(context.get(), nullptr, BELTRAMI_F64, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_certificate(context.get(), nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_energy(context.get(), nullptr), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_face_energies(context.get(), nullptr, 0), BELTRAMI_E_INVALID_ARGUMENT);
  EXPECT_EQ(beltrami_get_stage(context.get(), 0, nullptr), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(Context, ASuccessClearsTheMessage) {
  const Context context = create();
  EXPECT_EQ(message(context), "");
  EXPECT_EQ(set_mesh(context, meshes::two_components()), BELTRAMI_E_COMPONENTS);
  EXPECT_NE(message(context), "");
  EXPECT_EQ(beltrami_error_element(context.get()), 1u);
  EXPECT_EQ(beltrami_set_int(context.get(), BELTRAMI_OPTION_THREADS, 1), BELTRAMI_OK);
  EXPECT_EQ(message(context), "");
  EXPECT_EQ(beltrami_error_element(context.get()), BELTRAMI_NO_ELEMENT);
  EXPECT_EQ(beltrami_error_element_kind(context.get()), BELTRAMI_ELEMENT_NONE);
}

struct Refusal {
  const char* name;
  TriangleList mesh;
  beltrami_status status;
  int32_t kind;
  uint64_t element;  // BELTRAMI_NO_ELEMENT - 1: any
};
constexpr uint64_t kAny = BELTRAMI_NO_ELEMENT - 1;

std::vector<Refusal> refusals() {
  TriangleList nan = meshes::quad();
  nan.positions[3].y() = std::nan("");
  TriangleList repeated = meshes::quad();
  repeated.faces[1] = {0, 2, 0};
  TriangleList collapsed = meshes::quad();
  for (Vec3& p : collapsed.positions) p = {1, 2, 3};
  const int32_t face = BELTRAMI_ELEMENT_FACE, vertex = BELTRAMI_ELEMENT_VERTEX;
  const int32_t none = BELTRAMI_ELEMENT_NONE;
  return {
      {"nan", nan, BELTRAMI_E_NON_FINITE, vertex, 3},
      {"repeated", repeated, BELTRAMI_E_REPEATED_VERTEX, face, 1},
      {"edge", meshes::three_on_an_edge(), BELTRAMI_E_NON_MANIFOLD_EDGE, face, 2},
      {"vertex", meshes::bowtie(), BELTRAMI_E_NON_MANIFOLD_VERTEX, vertex, 0},
      {"orientation", meshes::against_each_other(), BELTRAMI_E_ORIENTATION, face, 1},
      {"components", meshes::two_components(), BELTRAMI_E_COMPONENTS, face, 1},
      {"closed", meshes::octahedron(), BELTRAMI_E_CLOSED, none, BELTRAMI_NO_ELEMENT},
      {"boundaries", meshes::annulus(5), BELTRAMI_E_BOUNDARIES, vertex, kAny},
      {"genus", meshes::torus_with_hole(3), BELTRAMI_E_GENUS, none, BELTRAMI_NO_ELEMENT},
      {"area", collapsed, BELTRAMI_E_ZERO_AREA, none, BELTRAMI_NO_ELEMENT},
  };
}

TEST(SetMesh, RefusesWhatIsNoDiskWithTheElement) {
  for (const Refusal& refusal : refusals()) {
    SCOPED_TRACE(refusal.name);
    const Context context = create();
    EXPECT_EQ(set_mesh(context, refusal.mesh), refusal.status) << message(context);
    EXPECT_EQ(beltrami_error_element_kind(context.get()), refusal.kind);
    if (refusal.element != kAny) {
      EXPECT_EQ(beltrami_error_element(context.get()), refusal.element);
    }
    EXPECT_GT(message(context).size(), 20u);
  }
}

TEST(SetMesh, CountsElementsAsTheInputDoes) {
  // Unused vertices in front shift every vertex number, and no face number.
  for (const Refusal& refusal : refusals()) {
    SCOPED_TRACE(refusal.name);
    const Context plain = create(), shifted = create();
    set_mesh(plain, refusal.mesh);
    EXPECT_EQ(set_mesh(shifted, meshes::with_unused_in_front(refusal.mesh, 1000)), refusal.status);
    const uint64_t before = beltrami_error_element(plain.get());
    const uint64_t after = beltrami_error_element(shifted.get());
    if (refusal.kind == BELTRAMI_ELEMENT_VERTEX) {
      EXPECT_EQ(after, before + 1000);
      EXPECT_NE(message(shifted).find("vertex " + std::to_string(after)), std::string::npos)
          << message(shifted);
    } else {
      EXPECT_EQ(after, before);
    }
    EXPECT_EQ(beltrami_error_element_kind(shifted.get()), refusal.kind);
  }
  const Context context = create();
  set_mesh(context, meshes::with_unused_in_front(meshes::three_on_an_edge(), 1000));
  EXPECT_NE(message(context).find("100"), std::string::npos) << message(context);
}

TEST(SetMesh, NamesTheTrueIndexThatIsOutOfRange) {
  TriangleList mesh = meshes::quad();
  mesh.faces[1][1] = -1;
  const Context context = create();
  EXPECT_EQ(set_mesh(context, mesh), BELTRAMI_E_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(beltrami_error_element(context.get()), 1u);
  EXPECT_EQ(beltrami_error_element_kind(context.get()), BELTRAMI_ELEMENT_FACE);
  EXPECT_NE(message(context).find("4294967295"), std::string::npos) << message(context);

  const uint64_t wide[6] = {0, 1, 2, 0, uint64_t{1} << 32, 3};
  beltrami_mesh narrow = view(mesh);
  narrow.indices = {wide, 0, BELTRAMI_U64, 0};
  EXPECT_EQ(beltrami_set_mesh(context.get(), &narrow), BELTRAMI_E_INDEX_OUT_OF_RANGE)
      << "2^32 must not be taken for 0";
  EXPECT_NE(message(context).find("4294967296"), std::string::npos) << message(context);
}

TEST(SetMesh, RefusesEmptyMeshesWithoutLookingAtTheData) {
  const Context context = create();
  beltrami_mesh mesh = view(meshes::quad());
  mesh.positions.data = mesh.indices.data = nullptr;
  mesh.vertex_count = 0;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_EMPTY);
  mesh.vertex_count = 4;
  mesh.face_count = 0;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_EMPTY);
}

TEST(SetMesh, RefusesCountsBeyondTheLimits) {
  const TriangleList quad = meshes::quad();
  const Context context = create();
  beltrami_mesh mesh = view(quad);
  mesh.vertex_count = uint64_t{1} << 31;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT);
  mesh = view(quad);
  mesh.face_count = 700'000'001;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT);
  mesh.face_count = std::numeric_limits<uint64_t>::max();
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT);
  mesh = view(quad);
  mesh.flags = 1;
  EXPECT_EQ(beltrami_set_mesh(context.get(), &mesh), BELTRAMI_E_INVALID_ARGUMENT);
}

TEST(SetMesh, AnInvalidMeshLeavesTheOldOneAndItsResults) {
  const TriangleList good = meshes::bumps(4, 3);
  const Context context = loaded(good);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const auto before = uvs(context, good.positions.size());
  EXPECT_EQ(set_mesh(context, meshes::octahedron()), BELTRAMI_E_CLOSED);
  EXPECT_TRUE(same_bits(uvs(context, good.positions.size()), before));
  EXPECT_EQ(run(context), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(uvs(context, good.positions.size()), before));
}

TEST(SetMesh, AValidMeshDropsTheOldResults) {
  const Context context = loaded(meshes::bumps(4, 3));
  ASSERT_EQ(run(context), BELTRAMI_OK);
  ASSERT_EQ(set_mesh(context, meshes::quad()), BELTRAMI_OK);
  auto result = sized<beltrami_result>();
  EXPECT_EQ(beltrami_get_result(context.get(), &result), BELTRAMI_E_INVALID_STATE);
  EXPECT_EQ(beltrami_stage_count(context.get()), 0);
}

TEST(SetMesh, CopiesAndLeavesTheInputAlone) {
  TriangleList mesh = meshes::bumps(6, 6);
  const TriangleList copy = mesh;
  const Context context = loaded(mesh);
  EXPECT_EQ(mesh.positions, copy.positions);
  EXPECT_EQ(mesh.faces, copy.faces);
  mesh = meshes::triangle();  // the caller's memory is gone
  ASSERT_EQ(run(context), BELTRAMI_OK);
  const Context other = loaded(copy);
  ASSERT_EQ(run(other), BELTRAMI_OK);
  EXPECT_TRUE(same_bits(uvs(context, 49), uvs(other, 49)));
}

TEST(SetMesh, UnusedVerticesGetUvZeroAndAreCounted) {
  const TriangleList disk = meshes::bumps(3, 3);
  const TriangleList mesh = meshes::with_unused_in_front(disk, 5);
  const Context context = loaded(mesh), plain = loaded(disk);
  ASSERT_EQ(run(context), BELTRAMI_OK);
  ASSERT_EQ(run(plain), BELTRAMI_OK);
  auto got = uvs(context, mesh.positions.size());
  for (int v = 0; v < 5; ++v) EXPECT_EQ(got[v], (std::array<double, 2>{0, 0}));
  got.erase(got.begin(), got.begin() + 5);
  EXPECT_TRUE(same_bits(got, uvs(plain, disk.positions.size())));
  auto result = sized<beltrami_result>();
  ASSERT_EQ(beltrami_get_result(context.get(), &result), BELTRAMI_OK);
  EXPECT_EQ(result.unreferenced_vertices, 5u);
  EXPECT_EQ(result.vertices, mesh.positions.size());
  EXPECT_EQ(result.faces, mesh.faces.size());
  EXPECT_EQ(result.boundary_edges, 12u);
}

TEST(SetMesh, IgnoresThePositionsOfUnusedVertices) {
  TriangleList mesh = meshes::with_unused_in_front(meshes::bumps(3, 3), 2);
  mesh.positions[1].x() = std::nan("");
  const Context context = loaded(mesh);
  EXPECT_EQ(run(context), BELTRAMI_OK);
}

}  // namespace
}  // namespace beltrami
