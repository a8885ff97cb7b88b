/* What JavaScript cannot do by itself: hand the library a function to call. */
#include <beltrami/beltrami.h>

__attribute__((import_module("beltrami"), import_name("progress"))) int32_t js_progress(
    double fraction, const char* stage);

static int32_t progress(void* user, double fraction, const char* stage) {
  (void)user;
  return js_progress(fraction, stage);
}

__attribute__((export_name("progress_function"))) beltrami_progress progress_function(void) {
  return progress;
}
