/* beltrami inside an engine: a job on a thread of its own, a frame loop that looks at the progress
 * and never waits, and a user who gives up after 100 ms.
 *
 *   cc -std=c11 engine.c -lbeltrami -lpthread -lm -o engine && ./engine
 */
#define _POSIX_C_SOURCE 200112L
#include <beltrami/beltrami.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { CELLS = 300, SIDE = CELLS + 1, VERTICES = SIDE * SIDE, FACES = 2 * CELLS * CELLS };
enum { PATIENCE_MS = 100, FRAME_MS = 16 };

static float positions[VERTICES][3];
static uint32_t indices[FACES][3];

/* What the job and the frame loop share. The engine's job system starts it where pthread_create
 * stands here; the library itself starts no thread unless the option threads asks for it. */
typedef struct flatten_job {
  beltrami_context* context;
  pthread_t thread;
  atomic_int permille; /* progress, for the frame loop to draw */
  atomic_int finished;
  beltrami_status status; /* valid once finished is 1 */
} flatten_job;

static double now_ms(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return 1e3 * (double)time.tv_sec + 1e-6 * (double)time.tv_nsec;
}

/* On the job's thread: leave a number behind, lock nothing, call nothing. */
static int32_t note_progress(void* user, double fraction, const char* stage) {
  flatten_job* job = user;
  (void)stage;
  atomic_store(&job->permille, (int)(1000 * fraction));
  return 0;
}

static void* job_main(void* user) {
  flatten_job* job = user;
  beltrami_mesh mesh = {0};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = VERTICES;
  mesh.face_count = FACES;
  mesh.positions.data = positions;
  mesh.positions.type = BELTRAMI_F32;
  mesh.indices.data = indices;
  mesh.indices.type = BELTRAMI_U32;
  job->status = beltrami_set_mesh(job->context, &mesh);
  if (job->status >= 0) job->status = beltrami_run(job->context, note_progress, job);
  atomic_store(&job->finished, 1);
  return NULL;
}

static void make_terrain(void) {
  int i, j;
  for (j = 0; j < SIDE; ++j) {
    for (i = 0; i < SIDE; ++i) {
      float* p = positions[j * SIDE + i];
      p[0] = (float)i;
      p[1] = (float)j;
      p[2] = (float)(20 * sin(0.05 * i) * cos(0.07 * j));
    }
  }
  for (j = 0; j < CELLS; ++j) {
    for (i = 0; i < CELLS; ++i) {
      const uint32_t a = (uint32_t)(j * SIDE + i), b = a + 1, d = a + SIDE, c = d + 1;
      uint32_t(*face)[3] = &indices[2 * (j * CELLS + i)];
      face[0][0] = a, face[0][1] = b, face[0][2] = c;
      face[1][0] = a, face[1][1] = c, face[1][2] = d;
    }
  }
}

static void draw_frame(const flatten_job* job, int frame) {
  const struct timespec frame_time = {0, FRAME_MS * 1000000L};
  if (frame % 3 == 0) printf("frame %3d: %4.1f %%\n", frame, atomic_load(&job->permille) / 10.0);
  nanosleep(&frame_time, NULL);
}

int main(void) {
  static flatten_job job;
  double started, cancelled = 0, waited;
  int frame;
  make_terrain();
  if (beltrami_create(&job.context) != BELTRAMI_OK) return EXIT_FAILURE;
  if (pthread_create(&job.thread, NULL, job_main, &job) != 0) return EXIT_FAILURE;
  started = now_ms();
  for (frame = 0; !atomic_load(&job.finished); ++frame) {
    draw_frame(&job, frame);
    if (now_ms() - started > PATIENCE_MS) {
      if (cancelled == 0) cancelled = now_ms();
      /* Returns at once; the job ends at its next look. Asked in every frame, since setting a mesh
       * drops a request that comes before the run. */
      beltrami_cancel(job.context);
    }
  }
  waited = now_ms() - cancelled;
  pthread_join(job.thread, NULL);
  if (cancelled == 0) {
    printf("%s before the user lost patience\n", beltrami_status_name(job.status));
  } else {
    printf("%s %.0f ms after the request\n", beltrami_status_name(job.status), waited);
  }
  beltrami_destroy(job.context);
  /* A fast machine may be done by then. */
  return job.status >= 0 || job.status == BELTRAMI_E_CANCELLED ? EXIT_SUCCESS : EXIT_FAILURE;
}
