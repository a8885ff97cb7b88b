/* What the wheel takes from glibc 2.28 or older though it is linked on a newer system. Each
   function below stands, by the linker's --wrap, for the one that it is named after: the headers
   and the static libstdc++ ask for versions of them that came later. CMakeLists.txt reads the names
   from here. */
#include <stddef.h>
#include <stdint.h>
#include <sys/random.h>

#ifndef __x86_64__
#error "The versions of symbols below are those of x86-64."
#endif

struct stat;

#define OLD(result, name, ...)                             \
  __asm__(".symver old_" #name ", " #name "@GLIBC_2.2.5"); \
  result old_##name(__VA_ARGS__)

/* glibc 2.29 and 2.35 made errors of these the callers' affair. */
OLD(double, log, double);
double __wrap_log(double x) {
  return old_log(x);
}
OLD(double, log2, double);
double __wrap_log2(double x) {
  return old_log2(x);
}
OLD(double, exp2, double);
double __wrap_exp2(double x) {
  return old_exp2(x);
}
OLD(double, pow, double, double);
double __wrap_pow(double x, double y) {
  return old_pow(x, y);
}
OLD(double, hypot, double, double);
double __wrap_hypot(double x, double y) {
  return old_hypot(x, y);
}

/* Until glibc 2.33 these were inline, with the number of the struct's layout. */
enum { kLayout = 1 };
OLD(int, __xstat, int, const char*, struct stat*);
int __wrap_stat(const char* path, struct stat* out) {
  return old___xstat(kLayout, path, out);
}
OLD(int, __lxstat, int, const char*, struct stat*);
int __wrap_lstat(const char* path, struct stat* out) {
  return old___lxstat(kLayout, path, out);
}
OLD(int, __fxstat, int, int, struct stat*);
int __wrap_fstat(int file, struct stat* out) {
  return old___fxstat(kLayout, file, out);
}
int __wrap_fstat64(int file, struct stat* out) {
  return old___fxstat(kLayout, file, out);
}

/* glibc 2.34 moved these from libpthread, which CMakeLists.txt therefore links. */
typedef unsigned long thread;
OLD(int, pthread_create, thread*, const void*, void* (*)(void*), void*);
int __wrap_pthread_create(thread* id, const void* how, void* (*body)(void*), void* data) {
  return old_pthread_create(id, how, body, data);
}
OLD(int, pthread_join, thread, void**);
int __wrap_pthread_join(thread id, void** result) {
  return old_pthread_join(id, result);
}
OLD(int, pthread_detach, thread);
int __wrap_pthread_detach(thread id) {
  return old_pthread_detach(id);
}
OLD(int, pthread_once, int*, void (*)(void));
int __wrap_pthread_once(int* done, void (*body)(void)) {
  return old_pthread_once(done, body);
}
OLD(int, pthread_key_create, unsigned*, void (*)(void*));
int __wrap_pthread_key_create(unsigned* key, void (*destroy)(void*)) {
  return old_pthread_key_create(key, destroy);
}
OLD(int, pthread_key_delete, unsigned);
int __wrap_pthread_key_delete(unsigned key) {
  return old_pthread_key_delete(key);
}
OLD(void*, pthread_getspecific, unsigned);
void* __wrap_pthread_getspecific(unsigned key) {
  return old_pthread_getspecific(key);
}
OLD(int, pthread_setspecific, unsigned, const void*);
int __wrap_pthread_setspecific(unsigned key, const void* value) {
  return old_pthread_setspecific(key, value);
}
OLD(int, pthread_rwlock_rdlock, void*);
int __wrap_pthread_rwlock_rdlock(void* lock) {
  return old_pthread_rwlock_rdlock(lock);
}
OLD(int, pthread_rwlock_wrlock, void*);
int __wrap_pthread_rwlock_wrlock(void* lock) {
  return old_pthread_rwlock_wrlock(lock);
}
OLD(int, pthread_rwlock_unlock, void*);
int __wrap_pthread_rwlock_unlock(void* lock) {
  return old_pthread_rwlock_unlock(lock);
}

/* Since glibc 2.36; std::random_device asks for it. */
uint32_t __wrap_arc4random(void) {
  uint32_t number;
  if (getentropy(&number, sizeof number) != 0) __builtin_trap();
  return number;
}

/* Since glibc 2.32: whether reference counts may do without atomic operations. */
char __wrap___libc_single_threaded = 0;

/* Since glibc 2.34 it is the C library that runs the constructors of a program. One that asks for
   the older function is to bring that loop along, and newer C libraries then call it, too. */
extern void _init(void);
extern void (*__init_array_start[])(int, char**, char**) __attribute__((visibility("hidden")));
extern void (*__init_array_end[])(int, char**, char**) __attribute__((visibility("hidden")));

static void run_constructors(int argc, char** argv, char** environment) {
  _init();
  const ptrdiff_t count = __init_array_end - __init_array_start;
  for (ptrdiff_t i = 0; i < count; ++i) __init_array_start[i](argc, argv, environment);
}

typedef int main_function(int, char**, char**);
OLD(int, __libc_start_main, main_function*, int, char**, void (*)(int, char**, char**),
    void (*)(void), void (*)(void), void*);
int __wrap___libc_start_main(main_function* main, int argc, char** argv,
                             void (*init)(int, char**, char**), void (*fini)(void),
                             void (*unload)(void), void* stack_end) {
  (void)init;
  return old___libc_start_main(main, argc, argv, run_constructors, fini, unload, stack_end);
}
