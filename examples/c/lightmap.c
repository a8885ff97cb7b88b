/* Lightmap UVs for a level of many parts, as an engine makes them: every face gets a place of its
 * own in one atlas, vertices are split only where seams ask for it, and what is shipped is proven.
 *
 *   cc -std=c99 lightmap.c -lbeltrami -o lightmap && ./lightmap
 */
#include <beltrami/beltrami.h>
#include <stdio.h>
#include <stdlib.h>

enum { CRATES = 200, VERTICES = 8 * CRATES, FACES = 6 * CRATES, CORNERS = 4 * FACES };

static float positions[VERTICES][3];
static uint32_t corners[CORNERS];
static uint32_t sizes[FACES];
static float densities[FACES];

/* Boxes of several sizes on a grid, each of six quads; every tenth is to be lit in more detail. */
static void make_level(void) {
  static const uint32_t sides[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  uint32_t box, i, k;
  for (box = 0; box < CRATES; ++box) {
    const float size = 0.5f + 0.1f * (float)(box % 7);
    const uint32_t column = box % 20, row = box / 20;
    for (i = 0; i < 8; ++i) {
      float* p = positions[8 * box + i];
      p[0] = 3 * (float)column + (i & 1 ? size : 0);
      p[1] = 3 * (float)row + (i & 2 ? size : 0);
      p[2] = i & 4 ? 2 * size : 0;
    }
    for (i = 0; i < 6; ++i) {
      const uint32_t face = 6 * box + i;
      sizes[face] = 4;
      densities[face] = box % 10 == 0 ? 2.0f : 1.0f;
      for (k = 0; k < 4; ++k) corners[4 * face + k] = 8 * box + sides[i][k];
    }
  }
}

static beltrami_surface describe_level(void) {
  beltrami_surface surface = {0};
  surface.struct_size = sizeof surface; /* tells the library which version of the struct this is */
  surface.vertex_count = VERTICES;
  surface.face_count = FACES;
  surface.corner_count = CORNERS;
  surface.positions.data = positions;
  surface.positions.type = BELTRAMI_F32;
  surface.indices.data = corners;
  surface.indices.type = BELTRAMI_U32;
  surface.face_sizes.data = sizes;
  surface.face_sizes.type = BELTRAMI_U32;
  surface.densities.data = densities;
  surface.densities.type = BELTRAMI_F32;
  return surface;
}

static void require(beltrami_status status, const beltrami_context* context, const char* what) {
  if (status >= 0) return;
  fprintf(stderr, "%s failed with %s: %s\n", what, beltrami_status_name(status),
          beltrami_error_message(context));
  exit(EXIT_FAILURE);
}

/* The new vertex buffer: copies of the old vertices, each with its UV; and the index buffer. */
static void print_buffers(beltrami_context* context, uint64_t count) {
  float(*uvs)[2] = malloc((size_t)count * sizeof *uvs);
  uint32_t* origins = malloc((size_t)count * sizeof *origins);
  uint32_t* indices = malloc(CORNERS * sizeof *indices);
  uint64_t i;
  if (uvs && origins && indices) {
    require(beltrami_get_uv_vertices(context, uvs, BELTRAMI_F32, 0), context, "the UVs");
    require(beltrami_get_uv_vertex_origins(context, origins, BELTRAMI_U32, 0), context, "origins");
    require(beltrami_get_corner_uv_vertices(context, indices, BELTRAMI_U32, 0), context, "indices");
    for (i = 0; i < 4; ++i) {
      const uint32_t vertex = indices[i];
      printf("  corner %d: vertex %u, a copy of %u, at (%.4f, %.4f)\n", (int)i, (unsigned)vertex,
             (unsigned)origins[vertex], uvs[vertex][0], uvs[vertex][1]);
    }
  }
  free(uvs);
  free(origins);
  free(indices);
}

int main(void) {
  beltrami_context* context = NULL;
  beltrami_surface surface;
  beltrami_atlas atlas = {0};
  beltrami_packing page = {0};
  beltrami_atlas_certificate shipped = {0};

  make_level();
  surface = describe_level();
  if (beltrami_create(&context) != BELTRAMI_OK) return EXIT_FAILURE;
  /* A page of 256 texels, 4 between charts, in numbers that single precision holds; edges of crates
   * are seams. */
  require(beltrami_set_int(context, BELTRAMI_OPTION_FLOAT32, 1), context, "float32");
  require(beltrami_set_int(context, BELTRAMI_OPTION_RESOLUTION, 256), context, "resolution");
  require(beltrami_set_float(context, BELTRAMI_OPTION_MARGIN, 4), context, "margin");
  require(beltrami_set_int(context, BELTRAMI_OPTION_PRESET, BELTRAMI_PRESET_LIGHTMAP), context,
          "preset");
  require(beltrami_set_float(context, BELTRAMI_OPTION_HARD_ANGLE, 60), context, "hard-angle");
  require(beltrami_unwrap(context, &surface, NULL, NULL), context, "beltrami_unwrap");

  atlas.struct_size = sizeof atlas;
  require(beltrami_get_atlas(context, &atlas), context, "beltrami_get_atlas");
  page.struct_size = sizeof page;
  require(beltrami_get_packing(context, &page), context, "beltrami_get_packing");
  printf("%d faces in %d charts, energy %.4f (2 is an isometry)\n", (int)atlas.faces,
         (int)atlas.charts, atlas.symmetric_dirichlet);
  printf("%.0f%% of the page in use, %.2f texels between charts, %.1f texels per unit\n",
         100 * page.utilisation, page.margin, page.texels_per_unit);
  printf("%d vertices become %d:\n", (int)atlas.vertices, (int)atlas.uv_vertices);
  print_buffers(context, atlas.uv_vertices);

  shipped.struct_size = sizeof shipped;
  require(beltrami_get_atlas_certificate(context, BELTRAMI_F32, &shipped), context, "certificate");
  printf("%d triangles positive, %d overlaps: %s\n", (int)shipped.positive, (int)shipped.overlaps,
         shipped.injective ? "injective" : "NOT injective");
  beltrami_destroy(context);
  return shipped.injective ? EXIT_SUCCESS : EXIT_FAILURE;
}
