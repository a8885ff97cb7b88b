/* Preloaded: appends a line to the file LOG_TO for each fsync ("sync PATH") and each rename
   ("rename FROM TO"), in order. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void log_line(const char* what, const char* first, const char* second) {
  FILE* file = fopen(getenv("LOG_TO"), "a");
  if (!file) abort();
  fprintf(file, "%s %s %s\n", what, first, second);
  fclose(file);
}

int fsync(int descriptor) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  path[length > 0 ? length : 0] = '\0';
  log_line("sync", path, "");
  int (*real)(int) = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
  return real(descriptor);
}

int rename(const char* from, const char* to) {
  log_line("rename", from, to);
  int (*real)(const char*, const char*) =
      (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  return real(from, to);
}
