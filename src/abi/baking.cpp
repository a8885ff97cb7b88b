// The entry point that bakes images for new UVs.
#include <beltrami/beltrami.h>

#include "abi/context.h"

beltrami_status beltrami_bake(beltrami_context* context, const beltrami_bake_job* job,
                              beltrami_baked* out, beltrami_progress progress, void* user) {
  return beltrami::enter(
      context, [&](beltrami_context& self) { return self.bake(job, out, progress, user); });
}
