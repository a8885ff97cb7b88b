/* Flattens one bent quad; ends with 0 if the map is injective. */
#include <beltrami/beltrami.h>
#include <stdio.h>
#include <string.h>

static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
static const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};

int main(void) {
  beltrami_context* context = NULL;
  beltrami_mesh mesh;
  beltrami_status status;
  memset(&mesh, 0, sizeof mesh);
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = 4;
  mesh.face_count = 2;
  mesh.positions.data = positions;
  mesh.positions.type = BELTRAMI_F32;
  mesh.indices.data = indices;
  mesh.indices.type = BELTRAMI_U32;
  if (beltrami_create(&context) != BELTRAMI_OK) return 1;
  status = beltrami_set_mesh(context, &mesh);
  if (status == BELTRAMI_OK) status = beltrami_run(context, NULL, NULL);
  printf("%s: %s\n", beltrami_build_info(), beltrami_status_name(status));
  beltrami_destroy(context);
  return status == BELTRAMI_OK ? 0 : 1;
}
