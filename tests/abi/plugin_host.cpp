// A host that loads the library at run time, uses it, and unloads it, twice: nothing of it may
// stay.
#include <beltrami/beltrami.h>
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

namespace {

template <class Function>
Function* symbol(void* library, const char* name) {
  void* found = dlsym(library, name);
  if (found == nullptr) {
    std::printf("%s\n", dlerror());
    std::exit(1);
  }
  return reinterpret_cast<Function*>(found);
}

bool use(void* library) {
  const float positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 1}, {0, 1, 0}};
  const uint32_t indices[2][3] = {{0, 1, 2}, {0, 2, 3}};
  beltrami_mesh mesh{};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = 4;
  mesh.face_count = 2;
  mesh.positions = {positions, 0, BELTRAMI_F32, 0};
  mesh.indices = {indices, 0, BELTRAMI_U32, 0};
  beltrami_context* context = nullptr;
  const bool works = symbol<decltype(beltrami_create_)>(library, "beltrami_create_")(
                         BELTRAMI_ABI, &context) == BELTRAMI_OK &&
                     symbol<decltype(beltrami_set_mesh)>(library, "beltrami_set_mesh")(
                         context, &mesh) == BELTRAMI_OK &&
                     symbol<decltype(beltrami_run)>(library, "beltrami_run")(
                         context, nullptr, nullptr) == BELTRAMI_OK;
  symbol<decltype(beltrami_destroy)>(library, "beltrami_destroy")(context);
  return works;
}

}  // namespace

int main(int, char** arguments) {
  for (int round = 0; round < 2; ++round) {
    void* library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      std::printf("%s\n", dlerror());
      return 1;
    }
    if (!use(library) || dlclose(library) != 0) return 1;
    if (dlopen(arguments[1], RTLD_NOW | RTLD_NOLOAD) != nullptr) {
      std::printf("the library is still loaded after dlclose\n");
      return 1;
    }
  }
  return 0;
}
