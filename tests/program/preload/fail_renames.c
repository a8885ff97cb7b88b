/* Preloaded: the rename number FAIL_AT (from 1) of the process fails, or with KILL set ends the
   process before it. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <unistd.h>

static int renames;

int rename(const char* from, const char* to) {
  int (*real)(const char*, const char*) =
      (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
  const char* at = getenv("FAIL_AT");
  if (!at || ++renames != atoi(at)) return real(from, to);
  if (getenv("KILL")) kill(getpid(), SIGKILL);
  errno = EIO;
  return -1;
}
