/* What the snippets of C and C++ in the pages take for given: the numbers of the reader's program.
 */
#include <beltrami/beltrami.h>
#include <stddef.h>

void submit(void* system, beltrami_job job, void* data, int32_t index);
void wait_for_all(void* system);
void* my_aligned_malloc(void* heap, uint64_t bytes, uint64_t alignment);
void my_free(void* heap, void* block);

#ifdef __cplusplus
#include <array>
#include <beltrami/beltrami.hpp>
#include <cstdint>
#include <vector>

/* Of Unreal. */
using int32 = std::int32_t;
using uint32 = std::uint32_t;
struct FVector3f {
  float X, Y, Z;
};
template <class Item>
struct TArray {
  const Item* GetData() const;
  int32 Num() const;
};
struct FMemory {
  static void* Malloc(std::size_t bytes, std::uint32_t alignment);
  static void Free(void* block);
};
template <class Body>
void ParallelFor(int32 count, Body body) {
  body(count);
}
#endif
