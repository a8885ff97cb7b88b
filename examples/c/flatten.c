/* Flattens a bumpy sheet with the C interface of beltrami and prints what came of it.
 *
 *   cc -std=c99 flatten.c -lbeltrami -lm -o flatten && ./flatten
 */
#include <beltrami/beltrami.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { CELLS = 60, SIDE = CELLS + 1, VERTICES = SIDE * SIDE, FACES = 2 * CELLS * CELLS };

static float positions[VERTICES][3];
static uint32_t indices[FACES][3];
static float uvs[VERTICES][2];

/* A height field over a square of 10 by 10. */
static void make_sheet(void) {
  int i, j;
  for (j = 0; j < SIDE; ++j) {
    for (i = 0; i < SIDE; ++i) {
      const double x = 10.0 * i / CELLS, y = 10.0 * j / CELLS;
      float* p = positions[j * SIDE + i];
      p[0] = (float)x;
      p[1] = (float)y;
      p[2] = (float)(sin(x) * cos(0.8 * y));
    }
  }
  for (j = 0; j < CELLS; ++j) {
    for (i = 0; i < CELLS; ++i) {
      const uint32_t a = (uint32_t)(j * SIDE + i), b = a + 1, d = a + SIDE, c = d + 1;
      uint32_t(*face)[3] = &indices[2 * (j * CELLS + i)];
      face[0][0] = a, face[0][1] = b, face[0][2] = c;
      face[1][0] = a, face[1][1] = c, face[1][2] = d;
    }
  }
}

static beltrami_mesh describe_sheet(void) {
  beltrami_mesh mesh = {0};
  mesh.struct_size = sizeof mesh; /* tells the library which version of the struct this is */
  mesh.vertex_count = VERTICES;
  mesh.face_count = FACES;
  mesh.positions.data = positions;
  mesh.positions.type = BELTRAMI_F32; /* a stride of 0 means packed */
  mesh.indices.data = indices;
  mesh.indices.type = BELTRAMI_U32;
  return mesh;
}

/* Called on this thread; non-zero would cancel. */
static int32_t show_progress(void* user, double fraction, const char* stage) {
  int* shown = user;
  const int percent = (int)(100 * fraction);
  if (percent >= *shown + 25) {
    *shown = percent;
    printf("  %3d %%  %s\n", percent, stage);
  }
  return 0;
}

/* Ends the program with what the context says, and the face or vertex concerned. */
static void require(beltrami_status status, const beltrami_context* context, const char* what) {
  if (status >= 0) {
    if (status > 0) printf("%s: %s\n", what, beltrami_status_advice(status));
    return;
  }
  fprintf(stderr, "%s failed with %s: %s\n", what, beltrami_status_name(status),
          beltrami_error_message(context));
  if (beltrami_error_element_kind(context) != BELTRAMI_ELEMENT_NONE) {
    fprintf(stderr, "  see %s %llu\n",
            beltrami_error_element_kind(context) == BELTRAMI_ELEMENT_FACE ? "face" : "vertex",
            (unsigned long long)beltrami_error_element(context));
  }
  exit(EXIT_FAILURE);
}

static void print_results(beltrami_context* context) {
  beltrami_energy energy = {0};
  beltrami_certificate certificate = {0};
  int32_t i;
  energy.struct_size = sizeof energy;
  certificate.struct_size = sizeof certificate;
  require(beltrami_get_energy(context, &energy), context, "beltrami_get_energy");
  require(beltrami_get_certificate(context, &certificate), context, "beltrami_get_certificate");
  printf("symmetric Dirichlet energy %.4f (2 is an isometry), at most %.4f in face %llu\n",
         energy.symmetric_dirichlet, energy.max, (unsigned long long)energy.worst_face);
  printf("%llu faces positive, %llu flipped, %llu degenerate, %llu boundary crossings: %s\n",
         (unsigned long long)certificate.positive, (unsigned long long)certificate.negative,
         (unsigned long long)certificate.degenerate,
         (unsigned long long)certificate.boundary_crossings,
         certificate.injective ? "injective" : "NOT injective");
  printf("stage       iterations  seconds\n");
  for (i = 0; i < beltrami_stage_count(context); ++i) {
    beltrami_stage stage = {0};
    stage.struct_size = sizeof stage;
    require(beltrami_get_stage(context, i, &stage), context, "beltrami_get_stage");
    printf("%-12s %9d  %7.3f\n", stage.name, (int)stage.iterations, stage.seconds);
  }
}

int main(void) {
  beltrami_context* context = NULL;
  beltrami_certificate shipped = {0};
  beltrami_buffer uv_buffer = {0};
  beltrami_mesh mesh;
  beltrami_status status;
  int shown = -25;

  printf("%s\n", beltrami_build_info());
  make_sheet();
  mesh = describe_sheet();
  if (beltrami_create(&context) != BELTRAMI_OK) return EXIT_FAILURE;
  require(beltrami_set_int(context, BELTRAMI_OPTION_METHOD, BELTRAMI_METHOD_BELTRAMI), context,
          "beltrami_set_int");
  require(beltrami_set_int(context, BELTRAMI_OPTION_COARSE_FACES, 1000), context,
          "beltrami_set_int");
  require(beltrami_set_mesh(context, &mesh), context, "beltrami_set_mesh");
  require(beltrami_run(context, show_progress, &shown), context, "beltrami_run");
  print_results(context);

  /* Rounding to F32 can flip a sliver: check the very array that goes into the asset. */
  require(beltrami_get_uvs(context, uvs, BELTRAMI_F32, 0), context, "beltrami_get_uvs");
  beltrami_destroy(context);
  uv_buffer.data = uvs;
  uv_buffer.type = BELTRAMI_F32;
  shipped.struct_size = sizeof shipped;
  status = beltrami_check_injective(&mesh, &uv_buffer, &shipped);
  printf("the F32 array: %s\n", beltrami_status_name(status));
  return status == BELTRAMI_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
