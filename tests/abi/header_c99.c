/* The header in strict C99, and a C client's view of the calls. */
#include <beltrami/beltrami.h>

int beltrami_c_client_works(void);

int beltrami_c_client_works(void) {
  beltrami_context* context = 0;
  beltrami_option_info info = {0};
  info.struct_size = sizeof info;
  if (beltrami_create(&context) != BELTRAMI_OK || !context) return 0;
  if (beltrami_option_describe(BELTRAMI_OPTION_METHOD, &info) != BELTRAMI_OK) return 0;
  if (info.struct_size != sizeof info || info.type != BELTRAMI_TYPE_CHOICE) return 0;
  beltrami_destroy(context);
  return 1;
}
