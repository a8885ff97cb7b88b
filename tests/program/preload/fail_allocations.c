/* Preloaded: lets the allocation number FAIL_AT (from 1) of the process fail, with FAIL_ON set all
   later ones, too; writes the number of allocations to the file COUNT_TO at the end. */
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static atomic_long allocations;

static int fails(void) {
  static long at = -1;
  static int on;
  if (at < 0) {
    const char* text = getenv("FAIL_AT");
    at = text ? atol(text) : 0;
    on = getenv("FAIL_ON") != NULL;
  }
  const long number = ++allocations;
  if (at == 0 || number < at || (number > at && !on)) return 0;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t bytes) {
  return fails() ? NULL : __libc_malloc(bytes);
}
void* calloc(size_t count, size_t bytes) {
  return fails() ? NULL : __libc_calloc(count, bytes);
}
void* realloc(void* old, size_t bytes) {
  return fails() ? NULL : __libc_realloc(old, bytes);
}
void* aligned_alloc(size_t alignment, size_t bytes) {
  return fails() ? NULL : __libc_memalign(alignment, bytes);
}
int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (fails()) return ENOMEM;
  *memory = __libc_memalign(alignment, bytes);
  return *memory ? 0 : ENOMEM;
}

__attribute__((destructor)) static void write_count(void) {
  const char* path = getenv("COUNT_TO");
  const long count = allocations;
  FILE* file = path ? fopen(path, "w") : NULL;
  if (!file) return;
  fprintf(file, "%ld\n", count);
  fclose(file);
}
