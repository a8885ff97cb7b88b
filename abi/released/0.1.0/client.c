/* A program of its time: compiled against the header beside it and run with today's library. It
 * calls every function, and knows when the library writes behind a struct that it hands over. */
#include <beltrami/beltrami.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 9, VERTICES = SIDE * SIDE, FACES = 2 * (SIDE - 1) * (SIDE - 1), CANARY = 0xa5 };

/* A struct with room behind it that nobody may write to. */
#define GUARDED(type)          \
  struct {                     \
    type value;                \
    unsigned char canary[256]; \
  }
#define ARM(guarded) \
  (memset(&(guarded), CANARY, sizeof(guarded)), (guarded).value.struct_size = sizeof(guarded).value)
#define ALIVE(guarded) \
  REQUIRE(untouched((guarded).canary) && (guarded).value.struct_size == sizeof(guarded).value)
#define REQUIRE(condition)                                       \
  do {                                                           \
    if (!(condition)) {                                          \
      printf("client.c:%d: not so: %s\n", __LINE__, #condition); \
      exit(EXIT_FAILURE);                                        \
    }                                                            \
  } while (0)

static float positions[VERTICES][3];
static uint32_t indices[FACES][3];
static uint32_t triangles[FACES + 1][3];
static double uvs[VERTICES + 1][2];
static double energies[FACES + 1];
static double distortions[FACES + 1][4];
static double corner_uvs[3 * FACES + 1][2];
static double uv_vertices[3 * FACES + 1][2];
static uint32_t uv_faces[FACES + 1][3];
static uint64_t numbers[3 * FACES + 1];

static int untouched(const unsigned char* canary) {
  int i;
  for (i = 0; i < 256; ++i) {
    if (canary[i] != CANARY) return 0;
  }
  return 1;
}

static int32_t count_calls(void* user, double fraction, const char* stage) {
  REQUIRE(fraction >= 0 && fraction <= 1 && stage[0] != '\0');
  ++*(int*)user;
  return 0;
}

static void make_sheet(void) {
  uint32_t i, j;
  for (j = 0; j < SIDE; ++j) {
    for (i = 0; i < SIDE; ++i) {
      float* p = positions[j * SIDE + i];
      p[0] = (float)i;
      p[1] = (float)j;
      p[2] = (float)sin(0.7 * i + 0.3 * j);
    }
  }
  for (j = 0; j + 1 < SIDE; ++j) {
    for (i = 0; i + 1 < SIDE; ++i) {
      const uint32_t a = j * SIDE + i;
      uint32_t(*face)[3] = &indices[2 * (j * (SIDE - 1) + i)];
      face[0][0] = a, face[0][1] = a + 1, face[0][2] = a + 1 + SIDE;
      face[1][0] = a, face[1][1] = a + 1 + SIDE, face[1][2] = a + SIDE;
    }
  }
}

static beltrami_mesh describe_sheet(void) {
  beltrami_mesh mesh;
  memset(&mesh, 0, sizeof mesh);
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = VERTICES;
  mesh.face_count = FACES;
  mesh.positions.data = positions;
  mesh.positions.type = BELTRAMI_F32;
  mesh.indices.data = indices;
  mesh.indices.type = BELTRAMI_U32;
  return mesh;
}

static void ask_the_library(void) {
  REQUIRE(beltrami_version() >= 1000);
  REQUIRE(strstr(beltrami_build_info(), "beltrami") != NULL);
  REQUIRE(beltrami_has("no such feature") == 0);
  REQUIRE(strcmp(beltrami_status_name(BELTRAMI_E_GENUS), "BELTRAMI_E_GENUS") == 0);
  REQUIRE(beltrami_status_advice(BELTRAMI_E_GENUS)[0] != '\0');
}

static void ask_the_options(beltrami_context* context) {
  GUARDED(beltrami_option_info) info;
  const int32_t key = beltrami_option_find("coarse-faces");
  double values[2] = {0, -7};
  REQUIRE(key == BELTRAMI_OPTION_COARSE_FACES);
  ARM(info);
  REQUIRE(beltrami_option_describe(key, &info.value) == BELTRAMI_OK);
  ALIVE(info);
  REQUIRE(info.value.key == key && info.value.type == BELTRAMI_TYPE_INT);
  REQUIRE(info.value.minimum == 0 && info.value.default_value == 0);
  REQUIRE(strcmp(info.value.name, "coarse-faces") == 0 && info.value.summary[0] != '\0');
  REQUIRE(strcmp(beltrami_option_choice(BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_CM), "cm") == 0);
  REQUIRE(beltrami_set_int(context, key, 64) == BELTRAMI_OK);
  REQUIRE(beltrami_set_float(context, BELTRAMI_OPTION_TOLERANCE, 1e-3) == BELTRAMI_OK);
  REQUIRE(beltrami_get_option(context, BELTRAMI_OPTION_TOLERANCE, values) == BELTRAMI_OK);
  REQUIRE(values[0] == 1e-3 && values[1] == -7);
}

static void fail_with_an_element(beltrami_context* context) {
  beltrami_mesh mesh = describe_sheet();
  indices[5][0] = VERTICES;
  REQUIRE(beltrami_set_mesh(context, &mesh) == BELTRAMI_E_INDEX_OUT_OF_RANGE);
  REQUIRE(beltrami_error_message(context)[0] != '\0');
  REQUIRE(beltrami_error_element(context) == 5);
  REQUIRE(beltrami_error_element_kind(context) == BELTRAMI_ELEMENT_FACE);
  make_sheet();
}

static void run_jobs(void* user, int32_t count, beltrami_job job, void* data) {
  int32_t i;
  REQUIRE(user == uvs && count > 0);
  for (i = 0; i < count; ++i) job(data, i);
}

static void flatten(beltrami_context* context) {
  const beltrami_mesh mesh = describe_sheet();
  uint64_t bytes[2] = {0, 7};
  int calls = 0;
  REQUIRE(beltrami_set_parallel_for(context, run_jobs, uvs) == BELTRAMI_OK);
  REQUIRE(beltrami_set_mesh(context, &mesh) == BELTRAMI_OK);
  REQUIRE(beltrami_estimate_memory(context, bytes) == BELTRAMI_OK);
  REQUIRE(bytes[0] > sizeof positions && bytes[1] == 7);
  beltrami_cancel(context);
  REQUIRE(beltrami_run(context, NULL, NULL) == BELTRAMI_E_CANCELLED);
  REQUIRE(beltrami_run(context, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(calls > 0);
}

static void read_results(beltrami_context* context) {
  GUARDED(beltrami_result) result;
  GUARDED(beltrami_certificate) certificate;
  GUARDED(beltrami_energy) energy;
  GUARDED(beltrami_stage) stage;
  ARM(result);
  ARM(certificate);
  ARM(energy);
  ARM(stage);
  REQUIRE(beltrami_get_result(context, &result.value) == BELTRAMI_OK);
  ALIVE(result);
  REQUIRE(result.value.status == BELTRAMI_OK && result.value.vertices == VERTICES);
  REQUIRE(result.value.faces == FACES && result.value.boundary_edges == 4 * (SIDE - 1));
  REQUIRE(result.value.unreferenced_vertices == 0 && result.value.area > 64);
  REQUIRE(result.value.coarse_faces > 0 && result.value.seconds >= 0);
  REQUIRE(beltrami_get_certificate(context, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1 && certificate.value.positive == FACES);
  REQUIRE(certificate.value.first_bad_face == BELTRAMI_NO_ELEMENT);
  ARM(certificate);
  REQUIRE(beltrami_get_float32_certificate(context, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1);
  triangles[FACES][0] = 7;
  REQUIRE(beltrami_get_faces(context, triangles, BELTRAMI_U32, 0) == BELTRAMI_OK);
  REQUIRE(triangles[FACES][0] == 7 && triangles[0][0] < VERTICES);
  REQUIRE(beltrami_get_energy(context, &energy.value) == BELTRAMI_OK);
  ALIVE(energy);
  REQUIRE(energy.value.symmetric_dirichlet >= 2 && energy.value.worst_face < FACES);
  REQUIRE(energy.value.max >= energy.value.symmetric_dirichlet && energy.value.left_out == 0);
  REQUIRE(beltrami_stage_count(context) > 0);
  REQUIRE(beltrami_get_stage(context, 0, &stage.value) == BELTRAMI_OK);
  ALIVE(stage);
  REQUIRE(stage.value.name[0] != '\0' && stage.value.seconds >= 0);

  uvs[VERTICES][0] = energies[FACES] = -7;
  REQUIRE(beltrami_get_uvs(context, uvs, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_get_face_energies(context, energies, 0) == BELTRAMI_OK);
  REQUIRE(uvs[VERTICES][0] == -7 && energies[FACES] == -7);
  REQUIRE(energies[energy.value.worst_face] == energy.value.max);
}

static void check_without_a_context(void) {
  const beltrami_mesh mesh = describe_sheet();
  GUARDED(beltrami_certificate) certificate;
  GUARDED(beltrami_energy) energy;
  beltrami_buffer buffer;
  memset(&buffer, 0, sizeof buffer);
  buffer.data = uvs;
  buffer.type = BELTRAMI_F64;
  ARM(certificate);
  REQUIRE(beltrami_check_triangles(&mesh, &buffer, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.positive == FACES && certificate.value.injective == 0);
  ARM(certificate);
  REQUIRE(beltrami_check_boundary(&mesh, &buffer, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.boundary_crossings == 0);
  ARM(certificate);
  REQUIRE(beltrami_check_injective(&mesh, &buffer, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1);
  REQUIRE(certificate.value.error_element == BELTRAMI_NO_ELEMENT);
  ARM(energy);
  energies[FACES] = -7;
  REQUIRE(beltrami_measure(&mesh, &buffer, &energy.value, energies) == BELTRAMI_OK);
  ALIVE(energy);
  REQUIRE(energy.value.symmetric_dirichlet >= 2 && energies[FACES] == -7);
  distortions[FACES][0] = -7;
  REQUIRE(beltrami_measure_faces(&mesh, &buffer, distortions, 0) == BELTRAMI_OK);
  REQUIRE(distortions[0][2] == energies[0] && distortions[FACES][0] == -7);
}

static beltrami_surface describe_surface(void) {
  beltrami_surface surface;
  memset(&surface, 0, sizeof surface);
  surface.struct_size = sizeof surface;
  surface.vertex_count = VERTICES;
  surface.face_count = FACES;
  surface.positions.data = positions;
  surface.positions.type = BELTRAMI_F32;
  surface.indices.data = indices;
  surface.indices.type = BELTRAMI_U32;
  return surface;
}

static void read_atlas(beltrami_context* context) {
  GUARDED(beltrami_atlas) atlas;
  GUARDED(beltrami_chart) chart;
  GUARDED(beltrami_atlas_certificate) certificate;
  GUARDED(beltrami_stage) stage;
  uint64_t i;
  ARM(atlas);
  ARM(chart);
  ARM(certificate);
  ARM(stage);
  REQUIRE(beltrami_get_atlas(context, &atlas.value) == BELTRAMI_OK);
  ALIVE(atlas);
  REQUIRE(atlas.value.status == BELTRAMI_OK && atlas.value.vertices == VERTICES);
  REQUIRE(atlas.value.triangles == FACES && atlas.value.charts == 1);
  REQUIRE(atlas.value.uv_vertices == VERTICES && atlas.value.seam_length == 0);
  REQUIRE(beltrami_get_chart(context, 0, &chart.value) == BELTRAMI_OK);
  ALIVE(chart);
  REQUIRE(chart.value.triangles == FACES && chart.value.first_face == 0);
  REQUIRE(chart.value.error == BELTRAMI_OK && chart.value.box[0] < chart.value.box[2]);
  REQUIRE(beltrami_get_atlas_certificate(context, BELTRAMI_F64, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1 && certificate.value.positive == FACES);
  REQUIRE(beltrami_atlas_stage_count(context) > 0);
  REQUIRE(beltrami_get_atlas_stage(context, 0, &stage.value) == BELTRAMI_OK);
  ALIVE(stage);
  REQUIRE(stage.value.name[0] != '\0');

  corner_uvs[3 * FACES][0] = uv_vertices[VERTICES][0] = -7;
  uv_faces[FACES][0] = triangles[FACES][0] = 7;
  REQUIRE(beltrami_get_corner_uvs(context, corner_uvs, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_get_uv_vertices(context, uv_vertices, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_get_corner_uv_vertices(context, uv_faces, BELTRAMI_U32, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_get_triangles(context, triangles, BELTRAMI_U32, 0) == BELTRAMI_OK);
  REQUIRE(corner_uvs[3 * FACES][0] == -7 && uv_vertices[VERTICES][0] == -7);
  REQUIRE(uv_faces[FACES][0] == 7 && triangles[FACES][0] == 7);
  for (i = 0; i < 3 * FACES; ++i) {
    REQUIRE(corner_uvs[i][0] == uv_vertices[uv_faces[i / 3][i % 3]][0]);
  }
  numbers[0] = 7;
  REQUIRE(atlas.value.seams == 0 && atlas.value.searched == 1 && atlas.value.reached == 1);
  REQUIRE(beltrami_get_seams(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK && numbers[0] == 7);
  numbers[VERTICES] = 7;
  REQUIRE(beltrami_get_uv_vertex_origins(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[VERTICES] == 7 && numbers[uv_faces[3][1]] == indices[3][1]);
  numbers[FACES] = 7;
  REQUIRE(beltrami_get_face_charts(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[FACES] == 7 && numbers[0] == 0);
}

static void unwrap(beltrami_context* context) {
  GUARDED(beltrami_atlas_certificate) certificate;
  beltrami_surface surface = describe_surface();
  const beltrami_surface* surfaces[1];
  uint64_t repeating = 7, pairs[3] = {7, 7, 7};
  int calls = 0;
  surfaces[0] = &surface;
  triangles[FACES][0] = 7;
  REQUIRE(beltrami_triangulate(&surface, triangles, BELTRAMI_U32, 0, &repeating) == BELTRAMI_OK);
  REQUIRE(triangles[FACES][0] == 7 && triangles[0][1] == 1 && repeating == BELTRAMI_NO_ELEMENT);
  REQUIRE(beltrami_unwrap_surfaces(context, surfaces, 1, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(beltrami_unwrap(context, &surface, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(calls > 0);
  read_atlas(context);

  surface.corner_uvs.data = corner_uvs;
  surface.corner_uvs.type = BELTRAMI_F64;
  ARM(certificate);
  REQUIRE(beltrami_check_atlas(&surface, 0, &certificate.value, pairs, 1) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1 && certificate.value.overlaps == 0);
  REQUIRE(pairs[0] == BELTRAMI_NO_ELEMENT && pairs[2] == 7);
}

static void bake(beltrami_context* context) {
  GUARDED(beltrami_baked) baked;
  static const double uvs[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
  static const uint8_t pixels[4] = {1, 2, 3, 4};
  uint8_t room[5] = {0, 0, 0, 0, 7};
  beltrami_image image;
  beltrami_bake_job job;
  int calls = 0;
  memset(&image, 0, sizeof image);
  image.pixels = pixels;
  image.width = image.height = 2;
  image.type = BELTRAMI_U8;
  image.channels = 1;
  memset(&job, 0, sizeof job);
  job.struct_size = sizeof job;
  job.images = &image;
  job.image_count = 1;
  job.face_count = 2;
  job.new_uvs.data = job.old_uvs.data = uvs;
  job.new_uvs.type = job.old_uvs.type = BELTRAMI_F64;
  job.resolution = 2;
  job.page_count = 1;
  ARM(baked);
  baked.value.pixels = room;
  baked.value.stride = 0;
  baked.value.masks = NULL;
  REQUIRE(beltrami_bake(context, &job, &baked.value, count_calls, &calls) == BELTRAMI_OK);
  ALIVE(baked);
  REQUIRE(baked.value.texels == 4 && baked.value.without_source == 0 && calls > 0);
  REQUIRE(memcmp(room, pixels, 4) == 0 && room[4] == 7);
}

static void pack(beltrami_context* context) {
  GUARDED(beltrami_packing) packing;
  GUARDED(beltrami_atlas_certificate) certificate;
  beltrami_uv_mesh mesh;
  const beltrami_uv_mesh* meshes[1];
  uint8_t mask[64 * 64 + 1];
  double shares[2] = {0, -7};
  int calls = 0;
  numbers[3 * FACES] = 7;
  REQUIRE(beltrami_get_corner_pages(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[0] == 0 && numbers[3 * FACES] == 7);
  memset(&mesh, 0, sizeof mesh);
  mesh.struct_size = sizeof mesh;
  mesh.uv_count = VERTICES;
  mesh.face_count = FACES;
  mesh.uvs.data = uv_vertices;
  mesh.uvs.type = BELTRAMI_F64;
  mesh.uv_indices.data = uv_faces;
  mesh.uv_indices.type = BELTRAMI_U32;
  meshes[0] = &mesh;
  REQUIRE(beltrami_set_int(context, BELTRAMI_OPTION_RESOLUTION, 64) == BELTRAMI_OK);
  REQUIRE(beltrami_pack(context, meshes, 1, count_calls, &calls) == BELTRAMI_OK);
  ARM(packing);
  REQUIRE(beltrami_get_packing(context, &packing.value) == BELTRAMI_OK);
  ALIVE(packing);
  REQUIRE(packing.value.charts == 1 && packing.value.pages == 1);
  REQUIRE(packing.value.resolution == 64 && packing.value.margin >= 2);
  REQUIRE(beltrami_get_page_utilisations(context, shares, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(shares[0] == packing.value.utilisation && shares[1] == -7);
  ARM(certificate);
  REQUIRE(beltrami_get_packing_certificate(context, BELTRAMI_F64, &certificate.value) ==
          BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1);
  uv_vertices[VERTICES][0] = -7;
  REQUIRE(beltrami_get_packed_uvs(context, 0, uv_vertices, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(uv_vertices[VERTICES][0] == -7 && uv_vertices[0][0] >= 0 && uv_vertices[0][0] <= 1);
  numbers[FACES] = 7;
  REQUIRE(beltrami_get_packed_charts(context, 0, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[0] == 0 && numbers[FACES] == 7);
  numbers[1] = 7;
  REQUIRE(beltrami_get_chart_pages(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[0] == 0 && numbers[1] == 7);
  mask[64 * 64] = 7;
  REQUIRE(beltrami_get_page_mask(context, 0, mask, 0) == BELTRAMI_OK);
  REQUIRE(mask[64 * 64] == 7 && mask[64 * 32 + 32] <= BELTRAMI_TEXEL_COVERED);
}

static beltrami_buffer integers(const uint64_t* data) {
  beltrami_buffer buffer;
  memset(&buffer, 0, sizeof buffer);
  buffer.data = data;
  buffer.type = BELTRAMI_U64;
  return buffer;
}

static void edit(beltrami_context* context) {
  GUARDED(beltrami_session) session;
  GUARDED(beltrami_session_chart) chart;
  GUARDED(beltrami_atlas_certificate) certificate;
  static const uint64_t edge[2] = {0, 1}, inner[4] = {SIDE, SIDE + 1, SIDE + 1, SIDE + 2};
  static const uint64_t zero[1] = {0};
  beltrami_surface surface = describe_surface();
  beltrami_buffer edges = integers(inner), first = integers(zero), places;
  double place[2];
  uint64_t mark = 0;
  int calls = 0;
  memset(&places, 0, sizeof places);
  places.data = place;
  places.type = BELTRAMI_F64;
  REQUIRE(beltrami_session_update(context, 0, 0, NULL, NULL) == BELTRAMI_E_INVALID_STATE);
  REQUIRE(beltrami_session_begin(context, &surface, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(beltrami_session_update(context, 0, 0, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(beltrami_session_save(context, &mark) == BELTRAMI_OK && mark > 0);
  REQUIRE(beltrami_session_set_seams(context, &edges, 2, 1) == BELTRAMI_OK);
  edges = integers(edge);
  REQUIRE(beltrami_session_set_seams(context, &edges, 1, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_session_lock(context, &first, 1, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_session_set_flags(context, &first, 1, BELTRAMI_CHART_ALIGN) == BELTRAMI_OK);
  REQUIRE(beltrami_session_renew(context, &first, 1, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_session_select(context, &first, 1) == BELTRAMI_OK);
  REQUIRE(beltrami_session_select(context, NULL, 0) == BELTRAMI_OK);
  REQUIRE(beltrami_session_update(context, 0, 2, count_calls, &calls) >= BELTRAMI_OK);
  corner_uvs[3 * FACES][0] = -7;
  REQUIRE(beltrami_get_session_uvs(context, corner_uvs, BELTRAMI_F64, 0) == BELTRAMI_OK);
  REQUIRE(corner_uvs[3 * FACES][0] == -7);
  place[0] = corner_uvs[0][0] + 1;
  place[1] = corner_uvs[0][1];
  REQUIRE(beltrami_session_set_pins(context, &first, &places, 1) == BELTRAMI_OK);
  REQUIRE(beltrami_session_set_pin_kinds(context, &first, NULL, 1) == BELTRAMI_OK);
  REQUIRE(beltrami_session_update(context, 0, 2, count_calls, &calls) >= BELTRAMI_OK);
  ARM(session);
  REQUIRE(beltrami_get_session(context, &session.value) == BELTRAMI_OK);
  ALIVE(session);
  REQUIRE(session.value.charts == 1 && session.value.corners == 3 * FACES);
  REQUIRE(session.value.changes == 3 * FACES && session.value.opened == 0);
  numbers[3 * FACES] = 7;
  REQUIRE(beltrami_get_session_changes(context, numbers, BELTRAMI_U64, corner_uvs, BELTRAMI_F64) ==
          BELTRAMI_OK);
  REQUIRE(numbers[1] == 1 && numbers[3 * FACES] == 7 && corner_uvs[3 * FACES][0] == -7);
  REQUIRE(corner_uvs[0][0] == place[0] && corner_uvs[0][1] == place[1]);
  ARM(chart);
  REQUIRE(beltrami_get_session_chart(context, 0, &chart.value) == BELTRAMI_OK);
  ALIVE(chart);
  REQUIRE(chart.value.id == 0 && chart.value.triangles == FACES && chart.value.locked == 0);
  ARM(certificate);
  REQUIRE(beltrami_session_check(context, &certificate.value) == BELTRAMI_OK);
  ALIVE(certificate);
  REQUIRE(certificate.value.injective == 1 && certificate.value.positive == FACES);
  numbers[FACES] = 7;
  REQUIRE(beltrami_get_session_face_charts(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[0] == 0 && numbers[FACES] == 7);
  numbers[0] = 7;
  REQUIRE(beltrami_get_session_opened(context, numbers, BELTRAMI_U64, 0) == BELTRAMI_OK);
  REQUIRE(numbers[0] == 7);
  REQUIRE(beltrami_session_restore(context, mark) == BELTRAMI_OK);
  REQUIRE(beltrami_session_forget(context, mark) == BELTRAMI_OK);
  REQUIRE(beltrami_session_restore(context, mark) == BELTRAMI_E_INVALID_ARGUMENT);
  REQUIRE(beltrami_session_pack(context, NULL, 0, count_calls, &calls) == BELTRAMI_OK);
  REQUIRE(beltrami_session_end(context) == BELTRAMI_OK);
}

static void* take(void* user, uint64_t bytes, uint64_t alignment) {
  ++*(int*)user;
  return alignment <= 16 ? malloc((size_t)bytes) : NULL;
}
static void give(void* user, void* block, uint64_t bytes, uint64_t alignment) {
  REQUIRE(bytes > 0 && alignment <= 16);
  --*(int*)user;
  free(block);
}

static void lend_memory(void) {
  int living = 0;
  beltrami_context* context = NULL;
  beltrami_allocator allocator;
  memset(&allocator, 0, sizeof allocator);
  allocator.struct_size = sizeof allocator;
  allocator.user = &living;
  allocator.allocate = take;
  allocator.release = give;
  if (!beltrami_has("allocator")) {
    REQUIRE(beltrami_create_with(&allocator, &context) == BELTRAMI_E_UNSUPPORTED);
    return;
  }
  REQUIRE(beltrami_create_with(&allocator, &context) == BELTRAMI_OK && living > 0);
  beltrami_destroy(context);
  REQUIRE(living == 0);
}

int main(void) {
  beltrami_context* context = NULL;
  ask_the_library();
  make_sheet();
  REQUIRE(beltrami_create_(BELTRAMI_ABI + 1, &context) == BELTRAMI_E_ABI_MISMATCH);
  REQUIRE(beltrami_create(&context) == BELTRAMI_OK && context != NULL);
  lend_memory();
  ask_the_options(context);
  fail_with_an_element(context);
  flatten(context);
  read_results(context);
  unwrap(context);
  pack(context);
  bake(context);
  edit(context);
  beltrami_destroy(context);
  check_without_a_context();
  return EXIT_SUCCESS;
}
