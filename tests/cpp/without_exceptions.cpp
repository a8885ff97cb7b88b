// Compiled with -fno-exceptions: every call that has a result instead.
#include "cpp/units.h"

#include <beltrami/beltrami.hpp>

#include <utility>
#include <vector>

#if BELTRAMI_CPP_EXCEPTIONS
#error "this file is to be compiled without exceptions"
#endif

namespace beltrami::host {

beltrami_status unwrap_without_exceptions() {
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 1};
  const std::vector<int> good{0, 1, 2}, bad{0, 1, 3};
  Result<Context> context = Context::create();
  if (!context || !context->try_set(option::kEffort, Effort::kQuick)) return BELTRAMI_E_INTERNAL;
  double last = 0;
  const Result<Atlas> atlas =
      context->try_unwrap(Surface(positions, good), [&](double fraction) { last = fraction; });
  if (!atlas || last <= 0) return BELTRAMI_E_INTERNAL;
  const Result<std::vector<Uv>> uvs = atlas->try_corner_uvs();
  if (!uvs || uvs->size() != 3 || !atlas->try_certificate()->injective) return BELTRAMI_E_INTERNAL;
  const Result<Flattening> flat = context->try_flatten(Surface(positions, good));
  if (!flat || !flat->try_uvs()) return BELTRAMI_E_INTERNAL;
  if (!context->try_pack(UvMesh(*uvs, good))) return BELTRAMI_E_INTERNAL;
  Result<Editor> editor = Editor::begin(*context, Surface(positions, good));
  if (!editor || !editor->try_update() || !editor->try_changes()) return BELTRAMI_E_INTERNAL;
  return static_cast<beltrami_status>(context->try_unwrap(Surface(positions, bad)).status());
}

}  // namespace beltrami::host
