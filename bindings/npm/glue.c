/* What JavaScript cannot do by itself: give the library functions, and help in its loops. */
#include <beltrami/beltrami.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

__attribute__((import_module("beltrami"), import_name("progress"))) int32_t js_progress(
    double fraction, const char* stage);

static int32_t progress(void* user, double fraction, const char* stage) {
  (void)user;
  return js_progress(fraction, stage);
}

__attribute__((export_name("progress_function"))) beltrami_progress progress_function(void) {
  return progress;
}

/* Looks at memory, some tens of microseconds of them: what a helper waits awake for the next loop.
 * A run has thousands, many as short as it takes to wake a thread that sleeps. */
static const int kLooks = 20000;

/* The loop at hand. It changes only while no helper is inside. */
static beltrami_job loop_job;
static void* loop_data;
static int32_t loop_count;
static _Atomic int32_t loop_next; /* the first index that nobody has taken */
static _Atomic bool loop_open;    /* whether a helper may take some */
static _Atomic int32_t loop_number;
static _Atomic int32_t helpers_inside;
static _Atomic bool helper_lost;
static bool has_helpers = true; /* of the calling thread alone */

static void take_jobs(void) {
  for (int32_t index; (index = atomic_fetch_add(&loop_next, 1)) < loop_count;) {
    loop_job(loop_data, index);
  }
}

/* beltrami_parallel_for, on the calling thread and on the helpers. The thread of a page must not
 * sleep, so that the last jobs are waited for awake. */
static void run_loop(void* user, int32_t count, beltrami_job job, void* data) {
  (void)user;
  loop_job = job;
  loop_data = data;
  loop_count = count;
  atomic_store(&loop_next, 0);
  if (!has_helpers) {
    take_jobs();
    return;
  }
  atomic_store(&loop_open, true);
  atomic_fetch_add(&loop_number, 1);
  __builtin_wasm_memory_atomic_notify((int*)&loop_number, (unsigned)count);
  take_jobs();
  atomic_store(&loop_open, false);
  while (atomic_load(&helpers_inside) > 0) {
    if (atomic_load(&helper_lost)) __builtin_trap();
  }
}

__attribute__((export_name("loop_function"))) beltrami_parallel_for loop_function(void) {
  return run_loop;
}

/* A helper's life: it takes part in one loop after the other. */
__attribute__((export_name("help"))) void help(void) {
  int32_t seen = 0;
  for (;;) {
    for (int i = 0; i < kLooks && atomic_load(&loop_number) == seen; ++i) {
    }
    if (atomic_load(&loop_number) == seen) {
      __builtin_wasm_memory_atomic_wait32((int*)&loop_number, seen, -1);
    }
    seen = atomic_load(&loop_number);
    atomic_fetch_add(&helpers_inside, 1);
    if (atomic_load(&loop_open)) take_jobs();
    atomic_fetch_sub(&helpers_inside, 1);
  }
}

/* Loops of contexts that are still open have no helper from now on: one that is ended somewhere in
 * `help` may never leave it. Not during a loop. */
__attribute__((export_name("end_help"))) void end_help(void) {
  has_helpers = false;
}

/* A helper has trapped: whoever waits for it is to trap as well. */
__attribute__((export_name("lose_helper"))) void lose_helper(void) {
  atomic_store(&helper_lost, true);
}
