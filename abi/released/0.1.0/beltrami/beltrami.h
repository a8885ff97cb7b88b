/* beltrami: injective, low-distortion flattening of triangle meshes: of disks (beltrami_run), and
 * of any surface as an atlas (beltrami_unwrap); and charts packed onto the pages of a texture
 * (beltrami_pack).
 *
 * The C interface of the library, its only public header.
 *
 * Threads: a context belongs to one thread at a time; contexts share nothing, and the library has
 * no global state. beltrami_cancel may be called from any thread. Functions without a context are
 * reentrant. Nothing is printed, no environment variable is read, no signal handler is set.
 *
 * Statuses: 0 means that every promise was kept; above 0 there is a result, with a reservation;
 * below 0 there is no new result. After a failure the context keeps a sentence that says what to
 * do, and the face, vertex or corner concerned.
 *
 * Structs: the caller sets `struct_size` to sizeof of the struct that it was compiled with. The
 * library reads and writes only the fields that this size covers. */
#ifndef BELTRAMI_BELTRAMI_H
#define BELTRAMI_BELTRAMI_H

#include <stdint.h>

#if defined(_WIN32) && defined(BELTRAMI_SHARED)
#if defined(BELTRAMI_BUILDING)
#define BELTRAMI_API __declspec(dllexport)
#else
#define BELTRAMI_API __declspec(dllimport)
#endif
#elif defined(__GNUC__) && defined(BELTRAMI_BUILDING)
#define BELTRAMI_API __attribute__((visibility("default")))
#else
#define BELTRAMI_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

#define BELTRAMI_VERSION_MAJOR 0
#define BELTRAMI_VERSION_MINOR 1
#define BELTRAMI_VERSION_PATCH 0

/* The number of the binary interface: apart from the product version, raised by a break only. */
#define BELTRAMI_ABI 1

/* "No element" in element fields: all bits set. */
#define BELTRAMI_NO_ELEMENT UINT64_MAX

/* ---- Statuses --------------------------------------------------------------------------- */

typedef int32_t beltrami_status;

enum {
  BELTRAMI_STATUS_FORCE_SIGNED_ = -1,

  /* All promises kept. */
  BELTRAMI_OK = 0,
  /* A map exists and is injective, but an optimisation stopped at its limit of steps or time. */
  BELTRAMI_NOT_CONVERGED = 1,
  /* A map exists, but the exact certificate found flips, zero areas or boundary crossings. */
  BELTRAMI_NOT_INJECTIVE = 2,
  /* With the option float32: the map is injective in double precision, but no rounding to single
   * precision was found that is. The UVs are the best one found. */
  BELTRAMI_NOT_INJECTIVE_FLOAT32 = 3,

  /* The call itself is wrong: NULL, an unknown key, a value out of range, an odd stride. */
  BELTRAMI_E_INVALID_ARGUMENT = -1,
  BELTRAMI_E_OUT_OF_MEMORY = -2,
  /* The program was compiled against another ABI than the library's. */
  BELTRAMI_E_ABI_MISMATCH = -3,
  /* This build does not have what was asked for. */
  BELTRAMI_E_UNSUPPORTED = -4,
  /* The call comes too early, e.g. results before a run, or during a run. */
  BELTRAMI_E_INVALID_STATE = -5,
  BELTRAMI_E_CANCELLED = -6,
  /* A defect of the library: please report it with the mesh. */
  BELTRAMI_E_INTERNAL = -7,

  /* The mesh is not one that can be flattened. The element says where. */
  BELTRAMI_E_EMPTY = -20,               /* no vertices or no faces */
  BELTRAMI_E_INDEX_OUT_OF_RANGE = -21,  /* face: an index >= the vertex count */
  BELTRAMI_E_NON_FINITE = -22,          /* vertex: a NaN or infinite coordinate */
  BELTRAMI_E_REPEATED_VERTEX = -23,     /* face: names one vertex twice */
  BELTRAMI_E_NON_MANIFOLD_EDGE = -24,   /* face: one of its edges has more than two faces */
  BELTRAMI_E_NON_MANIFOLD_VERTEX = -25, /* vertex: its faces form more than one fan */
  BELTRAMI_E_ORIENTATION = -26,         /* face: runs against its neighbour, or is a duplicate */
  BELTRAMI_E_COMPONENTS = -27,          /* face: in a second component */
  BELTRAMI_E_CLOSED = -28,              /* no boundary: cut the mesh open first */
  BELTRAMI_E_BOUNDARIES = -29,          /* vertex: on a second boundary loop */
  BELTRAMI_E_GENUS = -30,               /* has handles: cut them open first */
  BELTRAMI_E_ZERO_AREA = -31,           /* the whole surface has no area, or overflows */

  /* The pins of a surface cannot be met. Corner: the first that cannot, with those before it. Or a
   * chart cannot be straight. Face: that of a rectangle; vertex: of straight edges. */
  BELTRAMI_E_PINS = -32,

  /* The charts do not fit onto the pages that the options allow. */
  BELTRAMI_E_NO_ROOM = -33,

  /* A linear system could not be solved. */
  BELTRAMI_E_SOLVER = -40
};

/* What an element index counts. */
enum {
  BELTRAMI_ELEMENT_FORCE_SIGNED_ = -1,
  BELTRAMI_ELEMENT_NONE = 0,
  BELTRAMI_ELEMENT_FACE = 1,
  BELTRAMI_ELEMENT_VERTEX = 2,
  BELTRAMI_ELEMENT_CORNER = 3 /* of the faces of a beltrami_surface, one after another */
};

/* ---- Library ---------------------------------------------------------------------------- */

/* Version of the library as major * 1000000 + minor * 1000 + patch. Cannot fail. */
BELTRAMI_API uint32_t beltrami_version(void);

/* One line: version, solver, licence of what it links. Static, never NULL. Cannot fail. */
BELTRAMI_API const char* beltrami_build_info(void);

/* 1 if this build has `feature`, else 0: "solver:native", "solver:eigen", "solver:cholmod",
 * "scaffold:own", "scaffold:cgal", "simplifier:native", "simplifier:openmesh", "exact:own",
 * "exact:cgal", "gpl", "lgpl", "allocator" (beltrami_create_with works). NULL and unknown names
 * give 0. Cannot fail. */
BELTRAMI_API int32_t beltrami_has(const char* feature);

/* Name of a status such as "BELTRAMI_E_CLOSED"; "unknown" for other numbers. Static,
 * never NULL. Cannot fail. */
BELTRAMI_API const char* beltrami_status_name(beltrami_status status);

/* One sentence on what a status means and what to do about it. Static, never NULL. Cannot fail. */
BELTRAMI_API const char* beltrami_status_advice(beltrami_status status);

/* ---- Context ---------------------------------------------------------------------------- */

/* Options, a copy of one mesh, and the results of its last run. */
typedef struct beltrami_context beltrami_context;

/* Use the macro beltrami_create: it passes the ABI that the caller was compiled with.
 * On success *out is a new context, to be freed by beltrami_destroy; else *out is NULL.
 * Errors: ABI_MISMATCH, INVALID_ARGUMENT (out is NULL), OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_create_(uint32_t abi, beltrami_context** out);
#define beltrami_create(out) beltrami_create_(BELTRAMI_ABI, (out))

/* A block of at least `bytes` whose address is a multiple of `alignment`, a power of two of at most
 * 4096; or NULL where none is left. */
typedef void* (*beltrami_allocate)(void* user, uint64_t bytes, uint64_t alignment);

/* Takes back a block, with the numbers that it was asked for with. */
typedef void (*beltrami_release)(void* user, void* block, uint64_t bytes, uint64_t alignment);

/* Memory of the host's. Both functions may be called from every thread of a call on the context,
 * several at a time; they neither throw nor call the library. */
typedef struct beltrami_allocator {
  uint32_t struct_size;
  uint32_t reserved; /* 0 */
  void* user;
  beltrami_allocate allocate;
  beltrami_release release;
} beltrami_allocator;

/* As beltrami_create, and all memory of the context, of its calls and of their threads comes from
 * `allocator`, but for exceptions on their way, stacks of threads and CHOLMOD. beltrami_destroy
 * has given it all back. Results have the same bits. Its `user` must live as long as the context;
 * the struct is copied. NULL: the C library's memory. Functions without a context take that as
 * well. Errors: as beltrami_create, INVALID_ARGUMENT (a NULL function), UNSUPPORTED (see
 * beltrami_has). */
BELTRAMI_API beltrami_status beltrami_create_with_(uint32_t abi,
                                                   const beltrami_allocator* allocator,
                                                   beltrami_context** out);
#define beltrami_create_with(allocator, out) beltrami_create_with_(BELTRAMI_ABI, (allocator), (out))

/* Frees a context; NULL is fine. Cannot fail; during a run, a defect of the caller, does nothing.
 */
BELTRAMI_API void beltrami_destroy(beltrami_context* context);

/* What the last failed call on this context said, in one sentence of UTF-8; "" after a success.
 * Valid until the next call on the context. NULL context: "". Cannot fail. */
BELTRAMI_API const char* beltrami_error_message(const beltrami_context* context);

/* The input element of the last failure, from 0, or BELTRAMI_NO_ELEMENT. Cannot fail. */
BELTRAMI_API uint64_t beltrami_error_element(const beltrami_context* context);

/* What beltrami_error_element counts: a BELTRAMI_ELEMENT_ number. Cannot fail. */
BELTRAMI_API int32_t beltrami_error_element_kind(const beltrami_context* context);

/* ---- Options ---------------------------------------------------------------------------- */

enum {
  BELTRAMI_OPTION_FORCE_SIGNED_ = -1,
  BELTRAMI_OPTION_METHOD = 0,         /* choice: BELTRAMI_METHOD_ */
  BELTRAMI_OPTION_ENERGY = 1,         /* choice: BELTRAMI_ENERGY_ */
  BELTRAMI_OPTION_COARSE_FACES = 2,   /* int: faces of the simplified mesh; 0: max(1%, 10,000) */
  BELTRAMI_OPTION_TOLERANCE = 3,      /* float: relative energy decrease at which CM stops */
  BELTRAMI_OPTION_MAX_ITERATIONS = 4, /* int: limit of CM iterations */
  BELTRAMI_OPTION_THREADS = 5,        /* int: threads to use; the result does not depend on it */
  BELTRAMI_OPTION_UNIT_SQUARE = 6,    /* int: 1 scales and shifts the UVs into [0,1]^2 */
  BELTRAMI_OPTION_FLATTEN = 7,        /* choice: BELTRAMI_FLATTEN_ */
  BELTRAMI_OPTION_INJECTIVITY = 8,    /* choice: BELTRAMI_INJECTIVITY_ */
  BELTRAMI_OPTION_REFINE = 9,         /* int: 1 goes on with CM on the fine mesh */
  BELTRAMI_OPTION_REFINE_ITERATIONS = 10, /* int: limit of its iterations; 0: CM's stopping rule */
  BELTRAMI_OPTION_TIME_LIMIT = 11,        /* float: wall seconds of iterations; 0: any */
  BELTRAMI_OPTION_FLOAT32 = 12,           /* int: 1 delivers single-precision numbers */
  BELTRAMI_OPTION_DELAUNAY = 13,          /* choice: 1 flattens on intrinsic Delaunay faces */
  BELTRAMI_OPTION_MEMORY_LIMIT = 14,      /* int: bytes that a run is to stay within; 0: any */
  /* Of beltrami_unwrap alone; beltrami_run takes no notice of them. */
  BELTRAMI_OPTION_CUT = 15,           /* choice: BELTRAMI_CUT_ */
  BELTRAMI_OPTION_HARD_ANGLE = 16,    /* float: degrees; sharper edges are seams; 180: none */
  BELTRAMI_OPTION_WELD = 17,          /* choice: BELTRAMI_WELD_ */
  BELTRAMI_OPTION_WELD_DISTANCE = 18, /* float: welds vertices this close, in the mesh's unit */
  BELTRAMI_OPTION_FILL_HOLES = 19,    /* float: longest boundary of a hole that costs no seam */
  BELTRAMI_OPTION_SHARE_COPIES = 20,  /* int: 1 gives copies of a face the UVs of the first */
  /* Of the search for seams, with the cut AUTO. */
  BELTRAMI_OPTION_PRESET = 21,         /* choice: BELTRAMI_PRESET_; sets the options below */
  BELTRAMI_OPTION_TARGET_ENERGY = 22,  /* float: mean symmetric Dirichlet energy that is sought */
  BELTRAMI_OPTION_TARGET_P99 = 23,     /* float: energy that 1% of the area may exceed; 0: any */
  BELTRAMI_OPTION_MAX_CHARTS = 24,     /* int: charts that are enough; 0: any number */
  BELTRAMI_OPTION_SEAM_BUDGET = 25,    /* float: seam length over the root of the area; 0: any */
  BELTRAMI_OPTION_CONCAVE_SEAMS = 26,  /* float: how far seams seek concave edges; 0: not */
  BELTRAMI_OPTION_HIDDEN_SEAMS = 27,   /* float: how far seams hide from view; 0: not */
  BELTRAMI_OPTION_HARD_SEAMS = 28,     /* float: factor of what a seam along a hard edge costs */
  BELTRAMI_OPTION_MATERIAL_SEAMS = 29, /* float: the same where the materials of faces differ */
  /* Of pages, for beltrami_unwrap and, but for the first, beltrami_pack. */
  BELTRAMI_OPTION_PACK = 30,            /* choice: BELTRAMI_PACK_ */
  BELTRAMI_OPTION_RESOLUTION = 31,      /* int: texels to the side of a page */
  BELTRAMI_OPTION_MARGIN = 32,          /* float: texels between charts, half to a page's edge */
  BELTRAMI_OPTION_TEXELS_PER_UNIT = 33, /* float: density; 0: the greatest that fits */
  BELTRAMI_OPTION_MAX_PAGES = 34,       /* int: 0: one, or with a density as many as it takes */
  BELTRAMI_OPTION_PACK_TURNS = 35,      /* choice: BELTRAMI_PACK_TURNS_ */
  BELTRAMI_OPTION_PACK_BLOCK = 36,      /* int: charts share no block of so many texels a side */
  BELTRAMI_OPTION_FILL_WEIGHT = 37,     /* float: seam length that a full page is worth; 10 */
  /* Of the search, too. */
  BELTRAMI_OPTION_SYMMETRIC_SEAMS =
      38,                              /* float: share that symmetry may cost more; 0: not sought */
  BELTRAMI_OPTION_STRAIGHT_SEAMS = 39, /* float: what turns of seams cost; 0: nothing */
  BELTRAMI_OPTION_EFFORT = 40,         /* choice: BELTRAMI_EFFORT_ */
  BELTRAMI_OPTION_FLAT_SEAMS = 41,     /* float: how much longer, where parts then unfold flat; 0 */
  BELTRAMI_OPTION_STACK = 42,          /* choice: BELTRAMI_STACK_ */
  /* Of the maps of charts and of their pages, for beltrami_unwrap. */
  BELTRAMI_OPTION_RECTIFY = 43,     /* choice: BELTRAMI_RECTIFY_ */
  BELTRAMI_OPTION_SNAP_TEXELS = 44, /* int: 1 puts straight borders onto the edges of texels */
  BELTRAMI_OPTION_LABEL_PAGES = 45  /* int: 1 gives each label pages of its own */
};

/* How long short seams are searched for, and a dense packing. Every level has the same promises. */
enum {
  BELTRAMI_EFFORT_FORCE_SIGNED_ = -1,
  /* Half the time of NORMAL, seams some 2% longer. */
  BELTRAMI_EFFORT_QUICK = 0,
  /* The default. */
  BELTRAMI_EFFORT_NORMAL = 1,
  /* Some three times the time of NORMAL, seams some 2% shorter. */
  BELTRAMI_EFFORT_HIGH = 2
};

/* Where the charts of an atlas lie. */
enum {
  BELTRAMI_PACK_FORCE_SIGNED_ = -1,
  /* On square pages of a texture, each chart moved and turned, and all scaled alike: the UVs of a
   * page are in [0,1]^2. Rounded to single precision their charts keep all faces, also where v is
   * stored as 1 - v. With the option float32 they are multiples of 2^-24 (of more on further
   * pages), of which v and 1 - v are exact. A surface with pins is not packed. */
  BELTRAMI_PACK_PAGES = 0,
  /* Side by side, in the surface's own unit of length. */
  BELTRAMI_PACK_NONE = 1
};

/* How charts may be turned on a page; they are never mirrored. */
enum {
  BELTRAMI_PACK_TURNS_FORCE_SIGNED_ = -1,
  BELTRAMI_PACK_TURNS_ANY = 0,
  /* By 90 degrees and multiples. */
  BELTRAMI_PACK_TURNS_QUARTER = 1,
  BELTRAMI_PACK_TURNS_NONE = 2
};

/* What is cut beside the seams that come with a surface. */
enum {
  BELTRAMI_CUT_FORCE_SIGNED_ = -1,
  /* Nothing but a short cut graph where a piece is no disk. */
  BELTRAMI_CUT_MINIMAL = 0,
  /* Also where the corner UVs of the surface part: its charts stay what they are. */
  BELTRAMI_CUT_ISLANDS = 1,
  /* The default: short seams that are searched for, along which the maps have the energy asked for
   * by the option target-energy. */
  BELTRAMI_CUT_AUTO = 2,
  /* Nothing: the seams that come with the surface are used as they are. What is no disk then is
   * opened as by MINIMAL, which does the same; seams of an earlier atlas leave nothing to open. */
  BELTRAMI_CUT_GIVEN = 3
};

/* What the seams are for: setting one writes its values to the options of the search. */
enum {
  BELTRAMI_PRESET_FORCE_SIGNED_ = -1,
  /* The defaults. */
  BELTRAMI_PRESET_NONE = 0,
  /* Light that is baked: target-energy 2.1, and short seams wherever they are seen, sooner along
   * hard edges: hidden-seams 0, hard-seams 0.5, flat-seams 2. */
  BELTRAMI_PRESET_LIGHTMAP = 1,
  /* Textures that are painted or photographed: seams where nobody looks, though they be longer:
   * concave-seams 0.6, hidden-seams 2. */
  BELTRAMI_PRESET_TEXTURING = 2,
  /* One chart for each component, at the energy that it can have: max-charts 1. */
  BELTRAMI_PRESET_ONE_CHART = 3,
  /* Machined and built things: seams along hard edges and flat faces, though there be more:
   * hard-seams 0.5, flat-seams 6. */
  BELTRAMI_PRESET_HARD_SURFACE = 4
};

/* Whether components of one shape share texels: each corner of such a component has the UV of the
 * corner that it lies on. Its UV vertices are its own, its faces are not judged. */
enum {
  BELTRAMI_STACK_FORCE_SIGNED_ = -1,
  BELTRAMI_STACK_NONE = 0,
  /* Those that a rigid motion carries onto one before them, lengths within a ten thousandth. */
  BELTRAMI_STACK_COPIES = 1,
  /* Mirror images, too. */
  BELTRAMI_STACK_MIRRORED = 2,
  /* And the halves of what is symmetric to the plane of the whole surface: it is cut along the
   * edges in that, if no face lies across it. */
  BELTRAMI_STACK_HALVES = 3
};

/* Which charts become rectangles, beside those that a surface names. */
enum {
  BELTRAMI_RECTIFY_FORCE_SIGNED_ = -1,
  BELTRAMI_RECTIFY_NONE = 0,
  /* Those that are rows and columns of quads: each column gets the mean length of its edges as its
   * width, each row as its height. */
  BELTRAMI_RECTIFY_GRIDS = 1
};

/* What is held of a pin, and what edges that are straight have in common. */
enum {
  BELTRAMI_PIN_FORCE_SIGNED_ = -1,
  BELTRAMI_PIN_POINT = 0, /* u and v */
  BELTRAMI_PIN_U = 1,     /* u: it may slide along v */
  BELTRAMI_PIN_V = 2,     /* v: it may slide along u */
  BELTRAMI_PIN_LINE = 3   /* that it lies on a line, along which it may slide */
};

/* Whether vertices at one place are one. */
enum {
  BELTRAMI_WELD_FORCE_SIGNED_ = -1,
  /* Yes; but a surface that is one disk as it stands stays so. */
  BELTRAMI_WELD_AUTO = 0,
  BELTRAMI_WELD_ON = 1,
  BELTRAMI_WELD_OFF = 2
};

enum {
  BELTRAMI_METHOD_FORCE_SIGNED_ = -1,
  /* Coarse CM, prolongation of its Beltrami coefficients, one harmonic solve in their metric. */
  BELTRAMI_METHOD_BELTRAMI = 0,
  /* Composite majorization on the full mesh: the slow reference. */
  BELTRAMI_METHOD_CM = 1,
  /* Tutte's embedding into a circle: injective, fast, highly distorted. */
  BELTRAMI_METHOD_TUTTE = 2,
  /* Baseline: globally injective, in the harmonic subspace of the surface's own metric. */
  BELTRAMI_METHOD_GIF = 3,
  /* Baseline: boundary first flattening, conformal. May flip and overlap. */
  BELTRAMI_METHOD_BFF = 4,
  /* Baseline: the UVs of the coarse mesh carried over by closest points. Flips. */
  BELTRAMI_METHOD_UV_PROLONGATION = 5
};

/* How the method BELTRAMI flattens the fine mesh. */
enum {
  BELTRAMI_FLATTEN_FORCE_SIGNED_ = -1,
  /* Poisson solve for the whole prolonged metric, free boundary, then a few L-BFGS steps. */
  BELTRAMI_FLATTEN_METRIC = 0,
  /* Harmonic in the prolonged Beltrami coefficients with the boundary of the coarse map: faster,
   * and 0.3% to 3% higher in energy. */
  BELTRAMI_FLATTEN_DIRICHLET = 1,
  /* The paper's: the harmonic subspace of a few boundary vertices, with a scaffold. */
  BELTRAMI_FLATTEN_GIF = 2,
  /* The same without a scaffold: no flips, but the boundary may overlap itself. */
  BELTRAMI_FLATTEN_FLIM = 3,
  /* Conformal with the boundary lengths that the coarse map asks for. May flip and overlap. */
  BELTRAMI_FLATTEN_BFF = 4
};

/* What the optimisation sees to. The certificate always judges global injectivity. */
enum {
  BELTRAMI_INJECTIVITY_FORCE_SIGNED_ = -1,
  /* Global, but for the method CM: that is left as the literature has it, the reference. */
  BELTRAMI_INJECTIVITY_AUTO = 0,
  /* No flips, and no part of the boundary may cross another. */
  BELTRAMI_INJECTIVITY_GLOBAL = 1,
  /* No flips; the boundary may overlap itself, at a slightly lower energy. */
  BELTRAMI_INJECTIVITY_LOCAL = 2
};

enum {
  BELTRAMI_ENERGY_FORCE_SIGNED_ = -1,
  /* 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), minimum 2. */
  BELTRAMI_ENERGY_SYMMETRIC_DIRICHLET = 0,
  /* (s1 - 1)^2 + (1/s2 - 1)^2, minimum 0. */
  BELTRAMI_ENERGY_SYMMETRIC_ARAP = 1,
  /* 1 + exp(D - 2) of the symmetric Dirichlet energy D, minimum 2: what is distorted most counts
   * most. The worst faces are better for it, at a mean that is a little higher. From D = 14 on a
   * parabola instead of the exponential. */
  BELTRAMI_ENERGY_EXPONENTIAL_DIRICHLET = 2
};

/* How an option's value is given. */
enum {
  BELTRAMI_TYPE_FORCE_SIGNED_ = -1,
  BELTRAMI_TYPE_INT = 0,   /* beltrami_set_int */
  BELTRAMI_TYPE_FLOAT = 1, /* beltrami_set_float */
  BELTRAMI_TYPE_CHOICE = 2 /* beltrami_set_int with one of the named values */
};

/* What an option is for. */
enum {
  BELTRAMI_CALL_FORCE_SIGNED_ = -1,
  BELTRAMI_CALL_RUN = 1,    /* beltrami_run */
  BELTRAMI_CALL_UNWRAP = 2, /* beltrami_unwrap */
  BELTRAMI_CALL_PACK = 4,   /* beltrami_pack */
  BELTRAMI_CALL_BAKE = 8    /* beltrami_bake */
};

typedef struct beltrami_option_info {
  uint32_t struct_size;
  int32_t key;      /* BELTRAMI_OPTION_ */
  int32_t type;     /* BELTRAMI_TYPE_ */
  int32_t reserved; /* 0 */
  double minimum;   /* inclusive */
  double maximum;   /* inclusive */
  double default_value;
  const char* name;    /* "coarse-faces": the flag of the program, static */
  const char* summary; /* one sentence, static */
  int32_t calls;       /* sum of the BELTRAMI_CALL_ numbers of those that take it */
  int32_t reserved_2;  /* 0 */
} beltrami_option_info;

/* Key of the option with this name ("coarse-faces"); -1 for NULL and unknown names. Cannot fail. */
BELTRAMI_API int32_t beltrami_option_find(const char* name);

/* Describes option `key`; keys count from 0 without gaps, so a loop that ends at the first
 * INVALID_ARGUMENT lists them all. Errors: INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_option_describe(int32_t key, beltrami_option_info* out);

/* Name of a value of the choice option `key` ("cm"), or NULL past its last. Static, cannot fail. */
BELTRAMI_API const char* beltrami_option_choice(int32_t key, int32_t value);

/* Sets an option for later runs, in any order: whether options go together is judged by the run.
 * Errors: INVALID_ARGUMENT (unknown key, wrong type, out of range; the old value stays),
 * INVALID_STATE (during a run). */
BELTRAMI_API beltrami_status beltrami_set_int(beltrami_context* context, int32_t key,
                                              int64_t value);
BELTRAMI_API beltrami_status beltrami_set_float(beltrami_context* context, int32_t key,
                                                double value);

/* One job of a loop of the library. */
typedef void (*beltrami_job)(void* data, int32_t index);

/* A host's loop: calls `job(data, index)` once for each index from 0 to count - 1, and returns when
 * all calls have returned. They may come from any threads, also that of the loop itself, several at
 * a time or one after the other. A thread wants a stack of 512 KiB. Neither the loop nor the
 * threads may leave a job by an exception. */
typedef void (*beltrami_parallel_for)(void* user, int32_t count, beltrami_job job, void* data);

/* Lends the threads of the host to later calls on this context: loops go to `parallel_for`, and the
 * library starts no threads of its own. It is called on the thread of the call alone, never from a
 * job, thousands of times in a long run, with `count` of at most the option threads. The results
 * have the same bits. NULL takes them back. Errors: INVALID_ARGUMENT (context is NULL),
 * INVALID_STATE (during a run). */
BELTRAMI_API beltrami_status beltrami_set_parallel_for(beltrami_context* context,
                                                       beltrami_parallel_for parallel_for,
                                                       void* user);

/* Writes the value that option `key` has: its default, what it was set to, or what the preset wrote
 * there if that was set later. Errors: INVALID_ARGUMENT, INVALID_STATE (during a run). */
BELTRAMI_API beltrami_status beltrami_get_option(beltrami_context* context, int32_t key,
                                                 double* value);

/* ---- Mesh ------------------------------------------------------------------------------- */

/* Element types of buffers. */
enum {
  BELTRAMI_SCALAR_FORCE_SIGNED_ = -1,
  BELTRAMI_F32 = 0,
  BELTRAMI_F64 = 1,
  BELTRAMI_U32 = 2,
  BELTRAMI_U64 = 3,
  BELTRAMI_U8 = 4, /* of pixels alone */
  BELTRAMI_U16 = 5 /* of pixels, and of integers wherever U32 may stand: those that are written are
                    * below 65,535 then, or the call fails with INVALID_ARGUMENT */
};

/* Items of 2 or 3 consecutive elements, `stride` bytes from one item to the next (0: packed).
 * The library never writes to a buffer that it takes as input. No alignment is required. */
typedef struct beltrami_buffer {
  const void* data;
  uint64_t stride;
  int32_t type;      /* BELTRAMI_F32, ... */
  uint32_t reserved; /* 0 */
} beltrami_buffer;

/* A triangle mesh in the caller's memory. Its faces must form one consistently oriented disk: one
 * component, edge- and vertex-manifold, one boundary loop, no handles. Vertices that no face uses
 * are allowed: they get the UV (0, 0) and are counted in beltrami_result.unreferenced_vertices. */
typedef struct beltrami_mesh {
  uint32_t struct_size;
  uint32_t flags;            /* 0 */
  uint64_t vertex_count;     /* at most 2^31 - 1 */
  uint64_t face_count;       /* at most 700,000,000 */
  beltrami_buffer positions; /* vertex_count items of 3: F32 or F64, in any unit of length */
  beltrami_buffer indices;   /* face_count items of 3: U32 or U64, counter-clockwise */
  /* NULL, or where the caller asks for an end. The function that this mesh is given to looks there
   * every few milliseconds, and returns CANCELLED if the number is not 0. Any thread and any signal
   * handler may set it. */
  const int32_t* cancel;
} beltrami_mesh;

/* Copies and validates a mesh; the caller's memory is free to go afterwards. A valid mesh drops the
 * results of the old one; an invalid mesh, or a cancel, leaves the context with its old mesh and
 * results. A request to cancel that is pending is dropped; one that comes meanwhile ends the call,
 * or where it comes too late for that the next run. Errors: INVALID_ARGUMENT, INVALID_STATE,
 * CANCELLED, OUT_OF_MEMORY, and the mesh statuses (-20 to -31) with their element. */
BELTRAMI_API beltrami_status beltrami_set_mesh(beltrami_context* context,
                                               const beltrami_mesh* mesh);

/* ---- Run -------------------------------------------------------------------------------- */

/* Called on the thread that called beltrami_run, only. `fraction` is in [0, 1] and never
 * decreases; `stage` is the name of the stage under way. Return non-zero to cancel. */
typedef int32_t (*beltrami_progress)(void* user, double fraction, const char* stage);

/* Estimates how many bytes of memory the library will hold at the peak of the next beltrami_run,
 * with the mesh and the options as they are set. The stored mesh and the results of the last run
 * count, arrays of the caller and other contexts do not. Valid for solver:native. It is told from
 * the options and from counts of vertices, faces and boundary edges, and is at least 40 MiB.
 *
 * It is the least memory-limit that the run can do with. Without a limit a run of a hard mesh may
 * take several times as much, of ten million noisy faces ten times: Newton steps end a blocked
 * polish, the repair embeds the whole layout anew, or noise takes a factor of the whole mesh. With
 * a limit it does without these, or ends. Errors: INVALID_STATE (no mesh), INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_estimate_memory(beltrami_context* context, uint64_t* bytes);

/* Flattens the mesh. `progress` may be NULL. The context's earlier results are kept if it fails.
 * Returns OK, or with a result NOT_CONVERGED, NOT_INJECTIVE or NOT_INJECTIVE_FLOAT32, or an error:
 *
 *   INVALID_STATE     there is no mesh
 *   INVALID_ARGUMENT  an option that another one leaves without effect is not at its default:
 *                     flatten with another method than beltrami; delaunay with cm, tutte or
 *                     uv-prolongation; injectivity with tutte, or with gif or bff unless refined;
 *                     refine-iterations without refine
 *   OUT_OF_MEMORY     also before any work, if the estimate exceeds the option memory-limit, and
 *                     later, if it has no room for what noise takes
 *   INTERNAL          also if `progress` throws a C++ exception
 *   CANCELLED, SOLVER */
BELTRAMI_API beltrami_status beltrami_run(beltrami_context* context, beltrami_progress progress,
                                          void* user);

/* Asks the run or beltrami_set_mesh under way (or, where none is, the next run) to end with
 * CANCELLED. From any thread, and from a signal handler. It takes effect at the next solver step:
 * at the latest after one ordering or factorization. NULL is ignored. Cannot fail. */
BELTRAMI_API void beltrami_cancel(beltrami_context* context);

/* ---- Results ---------------------------------------------------------------------------- */

/* The exact verdict on a map. Signs of areas and crossings are decided by exact predicates on the
 * very floats given. Injective: every face positive, no boundary crossing, on one oriented disk. */
typedef struct beltrami_certificate {
  uint32_t struct_size;
  int32_t injective; /* 1 or 0 */
  uint64_t positive; /* faces of positive, negative, zero area in UV */
  uint64_t negative;
  uint64_t degenerate;
  uint64_t boundary_crossings; /* pairs of boundary edges that meet where they should not: of n
                                * edges all pairs while they are fewer than about n log n, else
                                * at least so many */
  uint64_t first_bad_face;     /* a face that is not positive, or BELTRAMI_NO_ELEMENT */
  uint64_t first_crossing[2];  /* a vertex of each of two crossing edges, or BELTRAMI_NO_ELEMENT */
  uint64_t error_element;      /* the element of an error status, or BELTRAMI_NO_ELEMENT */
  int32_t error_element_kind;  /* BELTRAMI_ELEMENT_ */
  int32_t reserved;            /* 0 */
} beltrami_certificate;

/* Distortion energies: means over the faces weighted by 3D area, at the scale of the UVs as given.
 * NaN where no face is left to count.
 * s1 >= s2 are the singular values of the map of a face. Faces without 3D area, or whose map has no
 * finite energy (flipped or degenerate), are left out and counted. */
typedef struct beltrami_energy {
  uint32_t struct_size;
  uint32_t reserved;          /* 0 */
  double symmetric_dirichlet; /* 1/2 (s1^2 + s2^2 + s1^-2 + s2^-2), >= 2 */
  double symmetric_arap;      /* (s1 - 1)^2 + (1/s2 - 1)^2, >= 0 */
  double max;                 /* greatest symmetric Dirichlet energy of a face */
  uint64_t worst_face;        /* where, or BELTRAMI_NO_ELEMENT */
  uint64_t left_out;          /* faces left out */
} beltrami_energy;

typedef struct beltrami_result {
  uint32_t struct_size;
  beltrami_status status; /* what beltrami_run returned */
  uint64_t vertices;      /* of the input */
  uint64_t faces;
  uint64_t boundary_edges;
  uint64_t unreferenced_vertices; /* vertices that no face uses: UV (0, 0) */
  uint64_t coarse_faces;          /* of the mesh that CM ran on */
  uint64_t flips_before_repair;   /* faces that were not positive before repair */
  double area;                    /* of the input, in its unit squared */
  double seconds;                 /* wall time of the run */
  double cpu_seconds;             /* of the whole process during the run */
  uint64_t peak_memory_bytes;     /* of the whole process so far */
  uint64_t kernel_fixes;          /* vertices that repair moved into the kernel of their one-ring */
  uint64_t patch_fixes;           /* patches that repair untangled */
  uint64_t global_fixes;          /* layouts that repair embedded anew, with a scaffold */
  uint64_t cleaned_patches;       /* patches optimised around faces of enormous energy */
  uint64_t restarts;              /* tries after the first, whose map was not injective */
  uint64_t float32_moves;         /* vertices that are not at the nearest float in F32 */
  uint64_t delaunay_flips;        /* with the option delaunay: edges flipped */
  uint64_t delaunay_refused;      /* edges that are not Delaunay: their flip would repeat an edge */
  uint64_t degenerate_faces;      /* of the input: faces without area, which no energy counts */
  uint64_t first_degenerate_face; /* the first of them, or BELTRAMI_NO_ELEMENT */
  double coarse_energy;           /* mean energy of the coarse map; 0 where CM did not run */
} beltrami_result;

typedef struct beltrami_stage {
  uint32_t struct_size;
  int32_t iterations; /* 0 where a stage does not iterate */
  double seconds;     /* wall time */
  double cpu_seconds; /* of the whole process */
  const char* name;   /* static: "simplify", "coarse", "prolong", "flatten", "repair", ... */
} beltrami_stage;

/* The functions below that return a status fail with INVALID_STATE before the first run with a
 * result, and with INVALID_ARGUMENT for NULL, an unset struct_size, an odd type or stride. */

/* Counts, area and cost of the last run with a result; the counts are those of the try whose map
 * was kept. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_result(beltrami_context* context, beltrami_result* out);

/* Writes one (u, v) per input vertex, in input order, into the caller's memory: `type` BELTRAMI_F32
 * or BELTRAMI_F64, `stride` bytes from one vertex to the next (0: packed). In the mesh's unit of
 * length (or in [0,1]^2 with the unit-square option). F32 is rounded to nearest, but for vertices
 * that must move further for the map to stay injective (float32_moves in beltrami_result):
 * beltrami_get_float32_certificate tells. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_uvs(beltrami_context* context, void* out, int32_t type,
                                              uint64_t stride);

/* The certificate of the UVs as returned in F64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_certificate(beltrami_context* context,
                                                      beltrami_certificate* out);

/* The certificate of the UVs as returned in F32. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_float32_certificate(beltrami_context* context,
                                                              beltrami_certificate* out);

/* The triangles that the map, its certificates and its face energies speak of: the input's, or with
 * the option delaunay those of the intrinsic Delaunay triangulation on the same vertices. Writes
 * face_count items of 3 indices into the caller's memory: `type` BELTRAMI_U32 or BELTRAMI_U64,
 * `stride` bytes from one face to the next (0: packed). Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_faces(beltrami_context* context, void* out, int32_t type,
                                                uint64_t stride);

/* Energies of the UVs as returned in F64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_energy(beltrami_context* context, beltrami_energy* out);

/* Symmetric Dirichlet energy of every face, in input order: face_count doubles, `stride` bytes
 * apart (0: packed). Infinite where a face is flipped, degenerate, or without 3D area. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_face_energies(beltrami_context* context, void* out,
                                                        uint64_t stride);

/* Number of stages of the last run; 0 before it. Cannot fail. */
BELTRAMI_API int32_t beltrami_stage_count(const beltrami_context* context);

/* Statistics of stage `index`, in the order in which they ran. Errors: INVALID_STATE,
 * INVALID_ARGUMENT (also for an index that is none). */
BELTRAMI_API beltrami_status beltrami_get_stage(beltrami_context* context, int32_t index,
                                                beltrami_stage* out);

/* ---- Atlases: any surface --------------------------------------------------------------- */

/* Polygons in the caller's memory: any number of components, with holes and handles or without,
 * closed or open, of any quality. Nothing is refused but indices out of range, numbers that are not
 * finite, and surfaces without any area. What is not manifold is parted, faces that disagree are
 * turned, and every corner gets its UV. A corner is one vertex of one face; corners are counted
 * from 0, face after face. Buffers said to be optional are left out by data NULL. */
typedef struct beltrami_surface {
  uint32_t struct_size;
  uint32_t flags;              /* 0 */
  uint64_t vertex_count;       /* at most 2^31 - 1 */
  uint64_t face_count;         /* at most 700,000,000 triangles, polygons counted by theirs */
  uint64_t corner_count;       /* of all faces; 0 where all are triangles */
  beltrami_buffer positions;   /* vertex_count items of 3: F32 or F64, in any unit of length */
  beltrami_buffer indices;     /* the vertex of each corner, U32 or U64: face_count items of 3
                                * where face_sizes is left out, else corner_count items of 1 */
  beltrami_buffer face_sizes;  /* optional: face_count items of 1, U32 or U64: corners, 3 or more */
  beltrami_buffer corner_uvs;  /* optional: an item of 2 per corner, F32 or F64 */
  beltrami_buffer face_labels; /* optional: face_count items of 1, U32 or U64: materials, groups;
                                * seams run where they differ */
  beltrami_buffer densities;   /* optional: face_count items of 1, F32 or F64, above 0: how much
                                * larger the face is to be in the plane. A chart has the mean */
  beltrami_buffer seams;       /* optional: seam_count items of 2, U32 or U64: edges to cut, by
                                * their vertices; pairs that are no edge are ignored */
  uint64_t seam_count;
  const int32_t* cancel; /* as in beltrami_mesh */

  /* Pins, for beltrami_unwrap: corners whose UVs are given. The UV vertex of the corner is
   * delivered at exactly these numbers, which with the option float32 must be single-precision
   * numbers. Pins of corners that share a UV vertex must agree. */
  beltrami_buffer pins;    /* optional: pin_count items of 1, U32 or U64: corners */
  beltrami_buffer pin_uvs; /* pin_count items of 2, F32 or F64, in the unit of positions */
  uint64_t pin_count;

  /* What draws the seams that the cut AUTO searches for, and drives them off; with another cut
   * they are refused. Factors of what a seam costs are finite and at least 0, less than 1 to draw
   * it; they count from 0.05 to 20, and force nothing. */
  beltrami_buffer vertex_paint;  /* optional: vertex_count items of 1, F32 or F64: factors; an edge
                                  * has the geometric mean of its ends */
  beltrami_buffer painted_edges; /* optional: painted_edge_count items of 2, U32 or U64: edges by
                                  * their vertices; pairs that are no edge are ignored */
  beltrami_buffer edge_paint;    /* painted_edge_count items of 1, F32 or F64: factors, which
                                  * multiply those of the ends; those of one edge multiply */
  uint64_t painted_edge_count;
  beltrami_buffer materials; /* optional: face_count items of 1, U32 or U64: where they differ a
                              * seam costs the factor of the option material-seams */

  /* Pins that slide. Of kind U and V the other number of pin_uvs is read, and says nothing. */
  beltrami_buffer pin_kinds; /* optional: pin_count items of 1, U32 or U64: BELTRAMI_PIN_; else
                              * all are POINT */
  /* Of kind LINE, which goes through the pin's UV; optional without any: pin_count items of 2, F32
   * or F64, that kind's not both 0. */
  beltrami_buffer pin_directions;

  /* Straight borders, for beltrami_unwrap. Edges of one kind that hang together become one straight
   * line in each chart that has them: U gives all their vertices one u, V one v, LINE any line. */
  beltrami_buffer straight_edges; /* optional: straight_edge_count items of 2, U32 or U64: edges by
                                   * their vertices */
  beltrami_buffer straight_kinds; /* straight_edge_count items of 1, U32 or U64: BELTRAMI_PIN_U, V
                                   * or LINE */
  uint64_t straight_edge_count;
  beltrami_buffer rectangles;        /* optional: rectangle_count items of 1, U32 or U64: faces; the
                                      * chart of each becomes a rectangle along the axes */
  beltrami_buffer rectangle_corners; /* optional: rectangle_count items of 4, U32 or U64: vertices
                                      * of its border, in any order; four BELTRAMI_NO_ELEMENT of
                                      * U64, or left out: the four where its border turns most */
  uint64_t rectangle_count;
} beltrami_surface;

/* Cuts polygons into triangles as every function below does: by ears, the best-shaped first. Writes
 * items of 3 corners, n - 2 for a face of n corners, those of one face after another: `type` U32 or
 * U64, `stride` bytes apart (0: packed). `repeating`: NULL or where to put the first face that
 * names a vertex twice, or that cannot be cut without repeating an edge, or BELTRAMI_NO_ELEMENT.
 * Errors: INVALID_ARGUMENT, EMPTY, INDEX_OUT_OF_RANGE, CANCELLED, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_triangulate(const beltrami_surface* surface, void* out,
                                                  int32_t type, uint64_t stride,
                                                  uint64_t* repeating);

/* Cuts a surface into charts that are disks, flattens each with the options of beltrami_run (but
 * for delaunay), packs them onto pages, and judges the whole. With the option pack at NONE they lie
 * side by side at the surface's own scale. The surface is read, not kept. The context's mesh and
 * the results of beltrami_run stay; those of an earlier beltrami_unwrap are kept if it fails.
 * Returns OK, or with a result one of these:
 *
 *   NOT_CONVERGED, NOT_INJECTIVE_FLOAT32
 *   NOT_INJECTIVE     a chart has no map, or one that is not injective, as beltrami_get_chart says;
 *                     or charts with pins lie on each other, as the certificate says
 *
 * or an error: INVALID_ARGUMENT, EMPTY, INDEX_OUT_OF_RANGE, NON_FINITE, ZERO_AREA, PINS, NO_ROOM,
 * CANCELLED, OUT_OF_MEMORY, INVALID_STATE (during a run), INTERNAL. OUT_OF_MEMORY also comes before
 * any chart is flattened, if a large one is estimated to need more than the option memory-limit.
 *
 * Charts with pins stay where the pins put them, and the others lie above their box. With one pin
 * the free map is moved there, with two it is turned and scaled as well. With more its energy is
 * minimised with the pins held, at the scale of the similarity that fits them best, which is the
 * chart's density then. It is never mirrored. The certificate judges pins like all else; where the
 * boundary of a chart is pinned so that it touches itself, that is no overlap. Where pins cannot be
 * met the call fails with PINS and the first corner that cannot be met together with those before
 * it. Proven before the flattening: two UV vertices at one place, a face turned over, boundary
 * edges that cross, a boundary that runs clockwise. Else every attempt to reach the pins without
 * folding a face has failed. Pins go with neither densities nor the option unit-square, nor with
 * those of pages: INVALID_ARGUMENT. Pins of faces without area set their corners alone. Pins of
 * kind U, V and LINE slide; with none or one of kind POINT, and lines that leave the scale open, a
 * chart keeps its own.
 *
 * Charts with straight borders are turned by quarters alone, those with edges of kind U or V by
 * halves. What is straight keeps one number to the bit (of LINE: within rounding). Its vertices
 * slide until the energy is least. A rectangle without given corners that is rows and
 * columns of quads becomes a grid. An edge may cut off a part of a chart whose border is all on one
 * line: that part is left out, for its faces would have no area. Where no injective map is found
 * the call fails with PINS and the face of the rectangle, or a vertex of the straight edges. Edges
 * that are none, of two kinds, branch or form a loop, and charts with pins: INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_unwrap(beltrami_context* context,
                                             const beltrami_surface* surface,
                                             beltrami_progress progress, void* user);

/* The same for several surfaces at once: their charts share pages, at one scale, and one verdict.
 * Vertices, faces, corners and triangles count through all of them, one surface after another, in
 * results and in errors. So do UV vertices: those of a surface are consecutive, too.
 * Vertices of two surfaces are never welded. What is left out of some has no effect on those:
 * densities of 1, no labels, no paint. `cancel` of the first counts. Errors: as above, and
 * INVALID_ARGUMENT for NULL, EMPTY for no surfaces at all. */
BELTRAMI_API beltrami_status beltrami_unwrap_surfaces(beltrami_context* context,
                                                      const beltrami_surface* const* surfaces,
                                                      uint64_t surface_count,
                                                      beltrami_progress progress, void* user);

/* What was made of a surface. Triangles are those of beltrami_triangulate, faces the input's. */
typedef struct beltrami_atlas {
  uint32_t struct_size;
  beltrami_status status; /* what beltrami_unwrap returned */
  uint64_t vertices;      /* of the input */
  uint64_t faces;
  uint64_t corners;
  uint64_t triangles;
  uint64_t charts;
  uint64_t uv_vertices;        /* what a vertex buffer needs: vertices, split along the seams */
  uint64_t unused_vertices;    /* that no face names */
  uint64_t welded_vertices;    /* that count as one with a vertex before them */
  uint64_t repeated_faces;     /* triangles that name a vertex twice: each gets a point */
  uint64_t faces_without_area; /* others without area (of the largest triangle, or the square of
                                * their longest edge, 1e-14): each gets a point */
  uint64_t copies;             /* triangles with the vertices of one before them: each lies in a
                                * layer of its own, or shares the UVs of the first */
  uint64_t crowded_edges;      /* of more than two triangles: those stay together that continue
                                * each other */
  uint64_t one_sided_edges;    /* where the sides of a one-sided surface part */
  uint64_t split_vertices;     /* where fans of faces met in one point only */
  uint64_t reversed_faces;     /* triangles turned over to agree with most of their component; those
                                * with a short border part from it instead */
  uint64_t components;
  uint64_t closed_components; /* without a boundary */
  uint64_t holes;             /* boundaries but for the first of each component */
  uint64_t filled_holes;      /* boundaries that cost no seam */
  uint64_t left_out;          /* triangles that no energy counts: flipped, or without area */
  double area;                /* of the surface, in its unit squared */
  double seam_length;         /* on the surface, each seam once, no open border */
  double utilisation;         /* area of the UVs over that of the pages, or where it is not packed
                               * of their bounding box */
  double symmetric_dirichlet; /* mean over the area, at one scale for all: >= 2 */
  double p99;                 /* exceeded on 1% of the area at most */
  double max;
  double seconds;             /* wall time of the run */
  double cpu_seconds;         /* of the whole process during the run */
  uint64_t peak_memory_bytes; /* of the whole process so far */
  uint64_t seams;             /* edges, see beltrami_get_seams */
  int32_t searched;           /* 1 where seams were searched for: with the cut AUTO; else 0 */
  int32_t reached;            /* 1 where those meet what was asked for: energy (to 0.0001), p99,
                               * charts (or one for each component), seam length; else 0 */
  uint64_t pages;             /* 0 where it is not packed: beltrami_get_packing has the rest */
  uint64_t slivers;           /* triangles that no energy above counts: the worst ones, which
                               * together have less than a millionth of the area */
  double symmetric_dirichlet_with_slivers; /* what it would be with them */
  double max_with_slivers;                 /* likewise */
  uint64_t missed_parts; /* components, as the cuts that are given part them, that miss the energy
                          * or p99 that seams were searched for: each is to have it */
  uint64_t missed_face;  /* the first face of the worst of them, or BELTRAMI_NO_ELEMENT */
  uint64_t missed_triangles; /* of that part */
  double missed_energy;      /* its mean */
  uint64_t stacked_parts;    /* components that lie on others of their shape, by the option stack:
                              * no area, energy or verdict counts them */
} beltrami_atlas;

/* A chart: a connected piece of the surface. */
typedef struct beltrami_chart {
  uint32_t struct_size;
  beltrami_status status; /* OK, NOT_CONVERGED, NOT_INJECTIVE or NOT_INJECTIVE_FLOAT32 */
  beltrami_status error;  /* why it has no map but one point, e.g. SOLVER; else OK */
  int32_t reserved;       /* 0 */
  uint64_t triangles;
  uint64_t first_face;        /* of the input, the least */
  double area;                /* on the surface, in its unit squared */
  double density;             /* mean of its faces' densities, or what its pins ask for; else 1 */
  double symmetric_dirichlet; /* as of the atlas */
  double max;
  double box[4]; /* of its UVs: least u, least v, greatest u, greatest v */
  uint64_t page; /* counted from 0; 0 where the atlas is not packed */
} beltrami_chart;

/* The exact verdict on an atlas: every triangle positive, no two with a common inner point, in one
 * chart or in two. Signs are decided by exact predicates on the very floats given. */
typedef struct beltrami_atlas_certificate {
  uint32_t struct_size;
  int32_t injective; /* 1 or 0 */
  uint64_t positive; /* triangles of positive, negative, zero area in UV */
  uint64_t negative;
  uint64_t degenerate;
  uint64_t excepted;        /* not judged: without area on the surface, sharing UVs, or stacked */
  uint64_t mirrored_charts; /* all of whose triangles were negative, taken as their mirror images */
  uint64_t mirrored_faces;  /* triangles in them */
  uint64_t overlaps;        /* pairs of triangles that overlap, one at least at a seam or border:
                             * all of them while they are few, else at least so many */
  uint64_t first_overlap[2];  /* two faces that overlap, or BELTRAMI_NO_ELEMENT */
  uint64_t first_bad_face;    /* a face that is not positive, or BELTRAMI_NO_ELEMENT */
  uint64_t touching_places;   /* where borders touch, which is allowed */
  uint64_t error_element;     /* the element of an error status, or BELTRAMI_NO_ELEMENT */
  int32_t error_element_kind; /* BELTRAMI_ELEMENT_ */
  int32_t reserved;           /* 0 */
} beltrami_atlas_certificate;

/* The functions below fail with INVALID_STATE before the first beltrami_unwrap with a result, and
 * with INVALID_ARGUMENT for NULL, an unset struct_size, an index out of range, odd types. */

/* Counts, energy and cost. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_atlas(beltrami_context* context, beltrami_atlas* out);

/* Chart `index` from 0, by their least faces. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_chart(beltrami_context* context, uint64_t index,
                                                beltrami_chart* out);

/* The certificate of the UVs in F64, or with `type` BELTRAMI_F32 of those in F32. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_atlas_certificate(beltrami_context* context, int32_t type,
                                                            beltrami_atlas_certificate* out);

/* Writes one (u, v) per corner: `type` F32 or F64, `stride` bytes from one corner to the next (0:
 * packed). F32 is rounded to nearest. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_corner_uvs(beltrami_context* context, void* out,
                                                     int32_t type, uint64_t stride);

/* Writes the page of each corner's UV: `type` U32 or U64; 0 where the atlas is not packed. It is
 * that of the face's chart, but for corners of faces that lie in two charts or in none. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_corner_pages(beltrami_context* context, void* out,
                                                       int32_t type, uint64_t stride);

/* Writes the UV vertex of each corner: `type` U32 or U64. With the UV vertices below it is an index
 * buffer: they are split at seams alone. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_corner_uv_vertices(beltrami_context* context, void* out,
                                                             int32_t type, uint64_t stride);

/* Writes the (u, v) of each UV vertex: F32 or F64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_uv_vertices(beltrami_context* context, void* out,
                                                      int32_t type, uint64_t stride);

/* Writes the input vertex that each UV vertex is a copy of: `type` U32 or U64. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_uv_vertex_origins(beltrami_context* context, void* out,
                                                            int32_t type, uint64_t stride);

/* Writes the chart of each face, all bits set for a face without area: `type` U32 or U64. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_face_charts(beltrami_context* context, void* out,
                                                      int32_t type, uint64_t stride);

/* Writes the seams, those given and those found, as items of 2 vertices of the input, of vertices
 * that count as one the least: `type` U32 or U64. They are the edges of the surface at which UVs
 * part, each once, the lesser vertex first, in increasing order; open borders are none. Given back
 * as `seams` of the surface, with the cut GIVEN, they make the same charts; but an edge of several
 * layers of faces is cut in all of them. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_seams(beltrami_context* context, void* out, int32_t type,
                                                uint64_t stride);

/* Writes the triangles that were computed on, as items of 3 corners in the orientation in which
 * they are positive: `type` U32 or U64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_triangles(beltrami_context* context, void* out,
                                                    int32_t type, uint64_t stride);

/* Number of stages of the last beltrami_unwrap; 0 before it. Cannot fail. */
BELTRAMI_API int32_t beltrami_atlas_stage_count(const beltrami_context* context);

/* Statistics of stage `index` of beltrami_unwrap, in the order in which they ran. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_atlas_stage(beltrami_context* context, int32_t index,
                                                      beltrami_stage* out);

/* Judges the corner_uvs of a surface, from anywhere: its charts are the triangles joined by edges
 * with the same UVs on both sides. Triangles without area on the surface are not judged, and
 * triangles that disagree in orientation with their chart are turned over, for a winding that
 * changes is no fold. `allow_mirrored`: 1 takes charts that are negative as a whole for their
 * mirror images. `pairs`: NULL or room for `capacity` pairs of faces that overlap; those that are
 * not used become BELTRAMI_NO_ELEMENT. Returns OK or NOT_INJECTIVE. Errors: INVALID_ARGUMENT,
 * EMPTY, INDEX_OUT_OF_RANGE, NON_FINITE, CANCELLED, OUT_OF_MEMORY, with out->error_element set. */
BELTRAMI_API beltrami_status beltrami_check_atlas(const beltrami_surface* surface,
                                                  int32_t allow_mirrored,
                                                  beltrami_atlas_certificate* out, uint64_t* pairs,
                                                  uint64_t capacity);

/* ---- Packing: charts onto the pages of a texture ----------------------------------------- */

/* Triangles in the plane, in the caller's memory: what beltrami_pack packs. Triangles that share a
 * UV vertex are of one chart. Buffers said to be optional are left out by data NULL. */
typedef struct beltrami_uv_mesh {
  uint32_t struct_size;
  uint32_t flags;             /* 0 */
  uint64_t uv_count;          /* UV vertices, at most 2^31 - 1, those of all meshes together */
  uint64_t face_count;        /* at most 700,000,000, likewise */
  beltrami_buffer uvs;        /* uv_count items of 2: F32 or F64 */
  beltrami_buffer uv_indices; /* face_count items of 3: U32 or U64, the UV vertices of corners */
  uint64_t vertex_count;      /* of positions */
  beltrami_buffer positions;  /* optional: vertex_count items of 3: F32 or F64. With them charts get
                               * equally many texels for equal areas on the surface, else they keep
                               * their sizes to each other. All meshes have them, or none */
  beltrami_buffer indices;    /* with positions: face_count items of 3: U32 or U64, the vertices of
                               * corners; left out where UV vertices are vertices */
  beltrami_buffer kept_pages; /* optional: face_count items of 1: U32 or U64. All bits set: the
                               * chart of the face is placed anew; else it stays where its UVs, in
                               * [0,1]^2, are on this page. The same for all faces of a chart */
  const int32_t* cancel;      /* of the first mesh: as in beltrami_mesh */
  /* Optional: face_count items of 1: U32 or U64. Charts of different labels get different pages, in
   * the order of the labels; a chart has that of its first face. All meshes have them, or none, and
   * none has kept_pages. */
  beltrami_buffer page_labels;
} beltrami_uv_mesh;

/* Packs the charts of `mesh_count` meshes onto common pages: each is moved and turned as the
 * options of pages say, and scaled, never mirrored. With charts that stay and no texels-per-unit
 * the others get the density that those have. The meshes are read, not kept, and so are the
 * context's mesh and other results; those of an earlier beltrami_pack stay if it fails. Charts that
 * are folded, flipped or lie on themselves are packed as they are. Triangles without area between
 * their UVs are no charts: they become points of another one. Returns OK, or with a result
 * NOT_INJECTIVE or NOT_INJECTIVE_FLOAT32, of which beltrami_get_packing_certificate says where.
 * Coordinates beyond 1e100 are NON_FINITE, too. Errors: INVALID_ARGUMENT, EMPTY,
 * INDEX_OUT_OF_RANGE, NON_FINITE (each with its element, counted in the mesh that the sentence
 * names), ZERO_AREA (there is no chart), NO_ROOM, CANCELLED, OUT_OF_MEMORY, INVALID_STATE (during a
 * run), INTERNAL. */
BELTRAMI_API beltrami_status beltrami_pack(beltrami_context* context,
                                           const beltrami_uv_mesh* const* meshes,
                                           uint64_t mesh_count, beltrami_progress progress,
                                           void* user);

/* What lies on the pages. */
typedef struct beltrami_packing {
  uint32_t struct_size;
  beltrami_status status; /* of the call that packed it */
  uint64_t charts;
  uint64_t triangles;
  uint64_t pages;
  uint64_t resolution;    /* texels to the side of a page */
  double texels_per_unit; /* of the surface, or without positions of the UVs that were packed */
  double utilisation;     /* area of the UVs over that of the pages */
  double margin;          /* texels: the least of the distances of two charts and of twice those to
                           * the edges of pages, in the numbers that are delivered */
  double seconds;         /* wall time of the call */
  double cpu_seconds;     /* of the whole process during the call */
  uint64_t splits;        /* charts that were made two of, with the option fill-weight */
  double split_length;    /* of the seams of those, in roots of the surface's area */
  double unsplit_utilisation; /* utilisation without splits; the same where there are none */
} beltrami_packing;

/* The functions below speak of what was packed last, by beltrami_pack or beltrami_unwrap. They fail
 * with INVALID_STATE where nothing was, and with INVALID_ARGUMENT for NULL, an unset struct_size,
 * an index out of range, or an odd type or stride. */

/* Counts, density, margin and cost. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_packing(beltrami_context* context, beltrami_packing* out);

/* Writes the covered share of each page: F32 or F64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_page_utilisations(beltrami_context* context, void* out,
                                                            int32_t type, uint64_t stride);

/* Writes the page of each chart, counted from 0: `type` U32 or U64. As tiles (UDIM) page k is
 * 1001 + k: there u is greater by k mod 10, and v by k div 10. No rounding to the type of the UVs
 * folds what the certificate found whole. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_chart_pages(beltrami_context* context, void* out,
                                                      int32_t type, uint64_t stride);

/* The certificate of the UVs in F64, or with `type` BELTRAMI_F32 of those in F32, page by page.
 * Faces count through the meshes, one after another. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_packing_certificate(beltrami_context* context,
                                                              int32_t type,
                                                              beltrami_atlas_certificate* out);

/* What a byte of a mask says of its texel. */
enum {
  BELTRAMI_TEXEL_FORCE_SIGNED_ = -1,
  BELTRAMI_TEXEL_FREE = 0,
  BELTRAMI_TEXEL_GUTTER = 1, /* no further than the margin asked for from a covered one */
  BELTRAMI_TEXEL_COVERED = 2 /* a face has a point in common with it */
};

/* Writes one byte for each texel of a page, a BELTRAMI_TEXEL_ number, in rows from the top (v = 1)
 * down. From one row to the next are `stride` bytes (0: as many as the resolution). Errors:
 * INVALID_STATE, INVALID_ARGUMENT, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_get_page_mask(beltrami_context* context, uint64_t page,
                                                    uint8_t* out, uint64_t stride);

/* Of beltrami_pack alone: the new (u, v) of each UV vertex of mesh `mesh`, counted from 0, on the
 * page of its chart, (0, 0) where no face uses it: `type` F32 or F64. F32 is rounded to nearest.
 * Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_packed_uvs(beltrami_context* context, uint64_t mesh,
                                                     void* out, int32_t type, uint64_t stride);

/* Of beltrami_pack alone: the chart of each face of mesh `mesh`: `type` U32 or U64. Charts count
 * through all meshes, by their first faces. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_packed_charts(beltrami_context* context, uint64_t mesh,
                                                        void* out, int32_t type, uint64_t stride);

/* ---- Editing sessions: seams and pins that move -------------------------------------------- */

/* A host with a user in front of it begins a session over one surface, notes edits in it, and asks
 * for an update after each. An update maps the charts that the edits concern and no others, from
 * the maps that they have. A seam that opens leaves its chart as it lies. Sides that are closed are
 * aligned by a similarity. A pin that moves draws its chart along. What cannot start so is
 * mapped anew, near its old place. Each chart's map is judged exactly at once, the atlas by
 * beltrami_session_check. A context holds one session. Its flattening is that of the options when
 * it began; those of packing and the number of threads count at each call.
 *
 * A call that fails leaves the maps as they were; what was asked for before it stays asked for,
 * until it is taken back or beltrami_session_restore is called. The same calls give the same bits,
 * but for updates that a limit of time ends. Every function fails with INVALID_ARGUMENT for NULL
 * and odd numbers, and with INVALID_STATE without a session and during a run. beltrami_cancel ends
 * those that take a progress, and the check. */

/* Reads a surface and begins a session in place of the one before. Its `seams` are cut, and where
 * it has `corner_uvs` also the edges at which they differ: charts keep these UVs until an edit
 * concerns them. Without them all charts are mapped by the first update, which lays them side by
 * side. Of the other optional buffers only face_sizes is taken. Errors: as of beltrami_unwrap. */
BELTRAMI_API beltrami_status beltrami_session_begin(beltrami_context* context,
                                                    const beltrami_surface* surface,
                                                    beltrami_progress progress, void* user);

/* Ends the session, if there is one, and frees its memory. Errors: INVALID_STATE (during a run). */
BELTRAMI_API beltrami_status beltrami_session_end(beltrami_context* context);

/* Opens edges, or with `open` 0 closes them: `count` items of 2 vertices, U32 or U64. A seam that
 * meets no border and no other seam at either end opens nothing until it does. Where the seams
 * leave something that is no disk, further edges are cut, which beltrami_get_session_opened lists;
 * they stay so until they are opened or closed here. Errors: INVALID_ARGUMENT (a pair is no edge,
 * or lies inside a polygon: nothing is noted), INDEX_OUT_OF_RANGE. */
BELTRAMI_API beltrami_status beltrami_session_set_seams(beltrami_context* context,
                                                        const beltrami_buffer* edges,
                                                        uint64_t count, int32_t open);

/* Sets pins, in place of all before: `count` items of 1 corner, U32 or U64, and of 2 numbers, F32
 * or F64, as beltrami_surface has them, in the unit of the session's UVs. One or two of a chart
 * take it along as it is; of more it keeps its scale while they move. Errors: INVALID_ARGUMENT,
 * INDEX_OUT_OF_RANGE, NON_FINITE with the corner. */
BELTRAMI_API beltrami_status beltrami_session_set_pins(beltrami_context* context,
                                                       const beltrami_buffer* corners,
                                                       const beltrami_buffer* uvs, uint64_t count);

/* Says what is held of the pins that are set, which all are POINT at first. `kinds` are `count`
 * items of 1, U32 or U64: BELTRAMI_PIN_ numbers in the order of the pins. `directions` are as many
 * of 2, F32 or F64, of those of kind LINE, or NULL without any. A chart slides and turns as its
 * pins let it. Errors: INVALID_ARGUMENT (also for another count than that of the pins). */
BELTRAMI_API beltrami_status beltrami_session_set_pin_kinds(beltrami_context* context,
                                                            const beltrami_buffer* kinds,
                                                            const beltrami_buffer* directions,
                                                            uint64_t count);

/* Says which faces may move: `count` items of 1, U32 or U64, or with 0 all. Their charts are due;
 * vertices of all other faces stay where they are. Errors: INVALID_ARGUMENT, INDEX_OUT_OF_RANGE. */
BELTRAMI_API beltrami_status beltrami_session_select(beltrami_context* context,
                                                     const beltrami_buffer* faces, uint64_t count);

/* Locks charts, given by their numbers: `count` items of 1, U32 or U64, or with `locked` 0 unlocks
 * them. Faces of locked charts stay where they are whatever happens. Errors: INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_session_lock(beltrami_context* context,
                                                   const beltrami_buffer* charts, uint64_t count,
                                                   int32_t locked);

/* What a chart keeps, beside its lock: a sum of these. */
enum {
  BELTRAMI_CHART_FORCE_SIGNED_ = -1,
  BELTRAMI_CHART_KEEP_FRAME = 1, /* packing does not turn it */
  BELTRAMI_CHART_KEEP_SCALE = 2, /* pins leave its size, and packing those of all charts */
  BELTRAMI_CHART_ALIGN = 4,      /* what is straight of its border lies along the axes */
  BELTRAMI_CHART_STACK = 8       /* packing lays it on the first of its shape with this flag */
};

/* Gives charts flags in place of those that they have. One to be aligned is due; pins overrule it.
 * Charts on others are not judged until one of the two changes. Errors: INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_session_set_flags(beltrami_context* context,
                                                        const beltrami_buffer* charts,
                                                        uint64_t count, uint32_t flags);

/* Makes charts due, given likewise; with `cold` other than 0 they start from nothing. Errors:
 * INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_session_renew(beltrami_context* context,
                                                    const beltrami_buffer* charts, uint64_t count,
                                                    int32_t cold);

/* Cuts and maps what is due. A chart takes at most `steps` Newton steps from the map that it has
 * (0: to its minimum). It takes none where `seconds` of wall time are up (0: those of the option
 * time-limit). Then the call returns NOT_CONVERGED: maps are injective and better than before, and
 * the next call goes on with them. Charts without a map are mapped whatever the time. With 1 or 2
 * steps an update takes some milliseconds for each five thousand faces of a chart that is due.
 * Returns OK, or with a result NOT_CONVERGED or NOT_INJECTIVE; errors: PINS with the corner,
 * INVALID_STATE with a face where parts that may not move cannot be joined, CANCELLED,
 * OUT_OF_MEMORY, SOLVER, INTERNAL. */
BELTRAMI_API beltrami_status beltrami_session_update(beltrami_context* context, double seconds,
                                                     int32_t steps, beltrami_progress progress,
                                                     void* user);

/* Packs charts onto pages by the options of beltrami_pack and effort, of which QUICK takes the
 * first layout that fits. Charts of the numbers given, as for beltrami_session_lock, go among the
 * others, which stay; with a count of 0 all are packed. Locked charts and those with pins stay as
 * well. Charts keep their sizes to each other, and where some stay to these. Where there is no room
 * elsewhere charts stay where they are, if that is on the pages and injective. Page p is the unit
 * square at (p modulo 10, p / 10). Returns OK or NOT_INJECTIVE; errors: NO_ROOM, INVALID_ARGUMENT
 * (also where a chart that stays lies on no page, with a face), INVALID_STATE (also before the
 * first update), CANCELLED, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_session_pack(beltrami_context* context,
                                                   const beltrami_buffer* charts, uint64_t count,
                                                   beltrami_progress progress, void* user);

/* Judges all charts together, in F64 as they are. Errors: CANCELLED, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_session_check(beltrami_context* context,
                                                    beltrami_atlas_certificate* out);

/* Notes seams, pins, locks, selection and maps under a number, which is given once in a session.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_session_save(beltrami_context* context, uint64_t* mark);

/* Goes back to what was noted, which stays noted: the same bits, and so do calls that follow
 * return. Errors: INVALID_ARGUMENT (there is no such number), OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_session_restore(beltrami_context* context, uint64_t mark);

/* Drops what was noted. Errors: INVALID_ARGUMENT (there is no such number). */
BELTRAMI_API beltrami_status beltrami_session_forget(beltrami_context* context, uint64_t mark);

/* How a session stands. */
typedef struct beltrami_session {
  uint32_t struct_size;
  beltrami_status status; /* the greatest reservation of all charts */
  uint64_t charts;
  uint64_t due;               /* charts that are to be mapped further */
  uint64_t corners;           /* of the surface */
  uint64_t changes;           /* corners that the last update, pack or restore moved */
  uint64_t opened;            /* edges cut beside the seams */
  double symmetric_dirichlet; /* mean over the area, each chart at its scale; NaN before the first
                               * update */
  double seconds;             /* of the last update, pack or check */
  double cpu_seconds;
} beltrami_session;

/* A chart of a session. */
typedef struct beltrami_session_chart {
  uint32_t struct_size;
  beltrami_status status; /* OK, NOT_CONVERGED or NOT_INJECTIVE: by itself */
  int32_t due;            /* 1 or 0 */
  int32_t locked;         /* 1: all of its faces are */
  uint64_t id;            /* its number: it stays while most of the chart does, and is given once */
  uint64_t triangles;
  uint64_t first_face; /* of the input, the least */
  double symmetric_dirichlet;
  double scale;        /* lengths in the plane per length on the surface that it is to have */
  uint32_t flags;      /* a sum of BELTRAMI_CHART_ numbers: those of all of its faces */
  uint32_t reserved;   /* 0 */
  uint64_t stacked_on; /* the number of the chart that it lies on; all bits set: none */
} beltrami_session_chart;

/* Counts and cost. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session(beltrami_context* context, beltrami_session* out);

/* Chart `index` from 0, by their least faces. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session_chart(beltrami_context* context, uint64_t index,
                                                        beltrami_session_chart* out);

/* Writes one (u, v) per corner: `type` F32 or F64, `stride` bytes apart (0: packed). Pages lie in
 * the plane as beltrami_session_pack has them. F32 is rounded to nearest: with the option float32
 * no number changes. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session_uvs(beltrami_context* context, void* out,
                                                      int32_t type, uint64_t stride);

/* Writes the corners that the last update, pack or restore moved, increasing, and their UVs: as
 * many as `changes` of beltrami_session says, packed. `corner_type` U32 or U64, `uv_type` F32 or
 * F64. Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session_changes(beltrami_context* context, void* corners,
                                                          int32_t corner_type, void* uvs,
                                                          int32_t uv_type);

/* Writes the number of the chart of each face, or all bits set for faces without area: U32 or U64.
 * Errors: INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session_face_charts(beltrami_context* context, void* out,
                                                              int32_t type, uint64_t stride);

/* Writes the edges that are cut beside the seams, as two vertices each: U32 or U64. Errors:
 * INVALID_STATE, INVALID_ARGUMENT. */
BELTRAMI_API beltrami_status beltrami_get_session_opened(beltrami_context* context, void* out,
                                                         int32_t type, uint64_t stride);

/* ---- Baking: what images show through old UVs, for new UVs --------------------------------- */

/* What an image shows beyond [0,1]^2. */
enum {
  BELTRAMI_WRAP_FORCE_SIGNED_ = -1,
  BELTRAMI_WRAP_REPEAT = 0,
  BELTRAMI_WRAP_CLAMP = 1, /* its outermost texels */
  BELTRAMI_WRAP_MIRROR = 2 /* itself, mirrored at every other time */
};

/* How texels are read. */
enum {
  BELTRAMI_FILTER_FORCE_SIGNED_ = -1,
  BELTRAMI_FILTER_LINEAR = 0, /* between texels; a mean where many are shown by one */
  BELTRAMI_FILTER_NEAREST = 1 /* each place shows its texel; means of 4 x 4 places in a new one */
};

/* What the channels of an image are, which says how a mean of them is taken. */
enum {
  BELTRAMI_PIXELS_FORCE_SIGNED_ = -1,
  BELTRAMI_PIXELS_LINEAR = 0, /* as they are: roughness, heights, linear light */
  BELTRAMI_PIXELS_SRGB = 1,   /* colours, in linear light; a second or fourth channel is linear */
  BELTRAMI_PIXELS_SRGB_ALPHA = 2, /* the same, and a colour counts by that channel, its alpha */
  BELTRAMI_PIXELS_NORMALS = 3,    /* of tangent space, with 3 or 4 channels: x and y of normals
                                   * are turned from the axes of the old UVs to those of the new
                                   * ones. 0 is the middle of the type's range (F32: 0.5) */
  BELTRAMI_PIXELS_OCCLUSION = 4   /* none are read: the share of a grey sky that a face sees, from
                                   * 0 to 1, is written to all channels */
};

/* An image in the caller's memory: rows from the top (v = 1) down, integers in their whole range.
 */
typedef struct beltrami_image {
  const void* pixels;
  uint64_t width;    /* 1 to 65536 */
  uint64_t height;   /* 1 to 65536 */
  uint64_t stride;   /* bytes from one row to the next (0: packed) */
  int32_t type;      /* BELTRAMI_U8, BELTRAMI_U16 or BELTRAMI_F32 */
  uint32_t channels; /* 1 to 4 */
} beltrami_image;

/* Triangles with two layouts of UVs, and the images of the old one. A corner is one of 3 of each
 * face, one after another. Buffers said to be optional are left out by data NULL. */
typedef struct beltrami_bake_job {
  uint32_t struct_size;
  uint32_t flags;               /* 0 */
  const beltrami_image* images; /* one for each old page, of one type and as many channels. For
                                 * OCCLUSION one, whose type and channels alone are looked at */
  uint64_t image_count;
  int32_t pixels;             /* BELTRAMI_PIXELS_ */
  int32_t filter;             /* BELTRAMI_FILTER_ */
  int32_t wrap_u;             /* BELTRAMI_WRAP_ */
  int32_t wrap_v;             /* BELTRAMI_WRAP_ */
  uint64_t face_count;        /* at most 700,000,000 */
  beltrami_buffer new_uvs;    /* an item of 2 per corner, F32 or F64, on the page of the face:
                               * [0,1]^2 */
  beltrami_buffer new_pages;  /* optional: face_count items of 1, U32 or U64, counted from 0; all
                               * bits set: the face is on none. Left out: all are on page 0 */
  beltrami_buffer old_uvs;    /* an item of 2 per corner, F32 or F64, in units of the image of the
                               * page. A face with one that is not finite has no source */
  beltrami_buffer old_pages;  /* optional: as new_pages, of images; all bits set: no source */
  beltrami_buffer positions;  /* an item of 3 per corner, F32 or F64; optional but for NORMALS
                               * and with source_positions */
  beltrami_buffer normals;    /* optional, for NORMALS and with a cage: an item of 3 per corner, F32
                               * or F64; NaN or left out: that of the face */
  beltrami_buffer tangents;   /* optional, for NORMALS: an item of 4 per corner, F32 or F64: the
                               * axis of the old u, and -1 where UVs are mirrored, else 1. Left
                               * out: as MikkTSpace has them */
  uint64_t source_face_count; /* with source_positions */
  beltrami_buffer source_positions; /* optional: an item of 3 per corner of another surface of the
                                     * same shape in the same place, F32 or F64. Then old_uvs and
                                     * old_pages are of its source_face_count faces. Each texel
                                     * shows the nearest place of it, of a face that looks the same
                                     * way. Not for NORMALS */
  uint64_t resolution;              /* texels to the side of a new page, 1 to 32768 */
  uint64_t gutter;       /* texels around charts that continue them; all bits set: the whole
                          * page */
  uint64_t page_count;   /* new pages, 1 to 1000 */
  const int32_t* cancel; /* as in beltrami_mesh */
  double cage;           /* with source_positions, in their unit: 0, or how far rays along the
                          * normals look for the source. One comes from as far outside and goes as
                          * far inside; the first face that it comes to from outside is shown.
                          * Where it meets none, the nearest place is. Gaps stay closed where
                          * corners in one place have one normal */
  uint64_t rays;         /* for OCCLUSION, 1 to 4096: from each texel to the sky. The faces hide it,
                          * or with source_positions those of the source */
} beltrami_bake_job;

/* Room for what is baked, and what is told of it. */
typedef struct beltrami_baked {
  uint32_t struct_size;
  uint32_t reserved;       /* 0 */
  void* pixels;            /* given: room for page_count pages of resolution rows from the top, one
                            * page after another, of the images' type and channels; 0 where nothing
                            * is baked */
  uint64_t stride;         /* given: bytes from one row to the next (0: packed) */
  uint8_t* masks;          /* given: NULL, or room for a byte per texel of each page, a
                            * BELTRAMI_TEXEL_ number */
  uint64_t texels;         /* that a face covers, at least in part */
  uint64_t without_source; /* of these: nothing was baked there */
  double old_texels;       /* of the images along the side of a new texel, in the mean: above 1 is
                            * coarser than before; 0 with source_positions */
  double seconds;          /* wall time of the call */
  double cpu_seconds;      /* of the whole process during the call */
} beltrami_baked;

/* Reads images through the old UVs of faces, and writes them for the new ones. Where densities
 * agree that is one bilinear reading, else the mean of up to 4 x 4 places of a texel, of a smaller
 * image where these are too few. Where faces overlap the first is shown. It takes the option
 * threads, on which the bits do not depend; the context's mesh and results stay. Returns OK, or an
 * error:
 *
 *   INVALID_ARGUMENT  also where most texels have no source; `out` has all numbers then, and the
 *                     pixels are written
 *   EMPTY             there are no faces
 *   NON_FINITE        with the corner: a new UV or a position
 *   CANCELLED, OUT_OF_MEMORY, INVALID_STATE (during a run)
 *
 * After another error pixels and masks hold anything. */
BELTRAMI_API beltrami_status beltrami_bake(beltrami_context* context, const beltrami_bake_job* job,
                                           beltrami_baked* out, beltrami_progress progress,
                                           void* user);

/* ---- Checks without a context ----------------------------------------------------------- */
/* They judge the caller's own arrays, keep nothing and need no run; `mesh->cancel` ends them.
 * `uvs`: vertex_count items of 2, F32 or F64, judged as stored. `mesh->positions` may be empty
 * (data NULL) except for the beltrami_measure functions. Each returns OK, or NOT_INJECTIVE where it
 * found something, or an error with out->error_element set: INVALID_ARGUMENT, CANCELLED,
 * OUT_OF_MEMORY, NON_FINITE (a UV), and mesh statuses. */

/* Orientation of every face. Needs no topology: any list of triangles will do. Proves no more than
 * that, so out->injective stays 0. Errors: as above, of the mesh INDEX_OUT_OF_RANGE. */
BELTRAMI_API beltrami_status beltrami_check_triangles(const beltrami_mesh* mesh,
                                                      const beltrami_buffer* uvs,
                                                      beltrami_certificate* out);

/* Simplicity of the boundary loop. Verifies that the mesh is one oriented disk. Proves no more than
 * that, so out->injective stays 0. Errors: as above. */
BELTRAMI_API beltrami_status beltrami_check_boundary(const beltrami_mesh* mesh,
                                                     const beltrami_buffer* uvs,
                                                     beltrami_certificate* out);

/* Both: OK proves that the piecewise linear map is injective. Errors: as above. */
BELTRAMI_API beltrami_status beltrami_check_injective(const beltrami_mesh* mesh,
                                                      const beltrami_buffer* uvs,
                                                      beltrami_certificate* out);

/* Distortion of any UVs, in the positions' unit of length. `face_energies`: NULL or face_count
 * doubles for the symmetric Dirichlet energy of each face. Errors: INVALID_ARGUMENT, CANCELLED,
 * INDEX_OUT_OF_RANGE, NON_FINITE, OUT_OF_MEMORY. */
BELTRAMI_API beltrami_status beltrami_measure(const beltrami_mesh* mesh, const beltrami_buffer* uvs,
                                              beltrami_energy* out, double* face_energies);

/* Distortion of every face of any UVs, in the positions' unit of length: face_count items of 4
 * doubles, `stride` bytes from one face to the next (0: packed). They are the singular values
 * s1 >= |s2| of its map, its symmetric Dirichlet and its symmetric ARAP energy. Where it is flipped
 * s2 is negative; there, and where it has no area in the plane, both energies are infinite. All
 * four are NaN where a face has no 3D area. Needs no topology. Errors: as of beltrami_measure. */
BELTRAMI_API beltrami_status beltrami_measure_faces(const beltrami_mesh* mesh,
                                                    const beltrami_buffer* uvs, void* out,
                                                    uint64_t stride);

#ifdef __cplusplus
}
#endif

#endif /* BELTRAMI_BELTRAMI_H */
