#include "abi/option_table.h"

#include <beltrami/beltrami.h>

#include "abi/option_members.h"
#include "abi/options.h"
#include "abi/options_of_charts.h"
#include "cut/seam_costs.h"
#include "cut/seam_target.h"

namespace beltrami {
namespace {

constexpr const char* kMethods[] = {"beltrami", "cm", "tutte", "gif", "bff", "uv-prolongation"};
constexpr const char* kFlattens[] = {"metric", "dirichlet", "gif", "flim", "bff"};
constexpr const char* kInjectivities[] = {"auto", "global", "local"};
constexpr const char* kSwitch[] = {"off", "on"};
constexpr const char* kCuts[] = {"minimal", "islands", "auto", "given"};
constexpr const char* kPresets[] = {"none", "lightmap", "texturing", "one-chart", "hard-surface"};
constexpr const char* kWelds[] = {"auto", "on", "off"};
constexpr const char* kPacks[] = {"pages", "none"};
constexpr const char* kTurns[] = {"any", "quarter", "none"};
constexpr const char* kEfforts[] = {"quick", "normal", "high"};
constexpr const char* kEnergies[] = {"symmetric-dirichlet", "symmetric-arap",
                                     "exponential-dirichlet"};

void set_preset(Options& options, double value) {
  apply_preset(options, static_cast<std::int32_t>(value));
}

/// Whoever asks for a distortion wants the shortest seams that it buys, and none that are longer
/// for less of it.
template <auto Member>
void set_target(Options& options, double value) {
  options.target.*Member = value;
  if (value > 0) options.target.flat_seams = 0;
}

constexpr std::int32_t kEveryCall = BELTRAMI_CALL_RUN | BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK;

/// No map has an energy of 2 but of what is flat by itself: a mean below this one is none that
/// rounding lets anything else have.
constexpr double kLeastTarget = 2.0001;

const OptionEntry kOptions[] = {
    {
        .key = BELTRAMI_OPTION_METHOD,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "method",
        .summary =
            "How the map is computed: beltrami (fast and low in distortion), cm (composite "
            "majorization on the full mesh, the slow reference) or tutte (into a circle, highly "
            "distorted). Baselines to compare with are gif and bff on the surface's own metric, "
            "and uv-prolongation of the coarse UVs; bff and uv-prolongation may flip.",
        .minimum = 0,
        .maximum = std::size(kMethods) - 1,
        .choices = kMethods,
        .get = get<&Options::method>,
        .set = set<&Options::method>,
    },
    {
        .key = BELTRAMI_OPTION_ENERGY,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "energy",
        .summary = "The distortion that is minimised; exponential-dirichlet lowers it where it is "
                   "highest, at a mean that is a little higher.",
        .minimum = 0,
        .maximum = std::size(kEnergies) - 1,
        .choices = kEnergies,
        .get = get<&Options::energy>,
        .set = set<&Options::energy>,
    },
    {
        .key = BELTRAMI_OPTION_COARSE_FACES,
        .type = BELTRAMI_TYPE_INT,
        .name = "coarse-faces",
        .summary = "Faces of the simplified mesh that composite majorization runs on. 0 chooses 1% "
                   "of the faces, at least 10,000; or 1,000 to 5,000 where meshes from 4,000 faces "
                   "on go through levels.",
        .minimum = 0,
        .maximum = 700e6,
        .get = get<&Options::coarse_faces>,
        .set = set<&Options::coarse_faces>,
    },
    {
        .key = BELTRAMI_OPTION_TOLERANCE,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "tolerance",
        .summary = "Relative decrease of the energy in one iteration below which composite "
                   "majorization stops.",
        .minimum = 0,
        .maximum = 1,
        .get = get<&Options::tolerance>,
        .set = set<&Options::tolerance>,
    },
    {
        .key = BELTRAMI_OPTION_MAX_ITERATIONS,
        .type = BELTRAMI_TYPE_INT,
        .name = "max-iterations",
        .summary = "Iterations after which composite majorization stops even if it has not "
                   "converged.",
        .minimum = 1,
        .maximum = 1e6,
        .get = get<&Options::max_iterations>,
        .set = set<&Options::max_iterations>,
    },
    {
        .key = BELTRAMI_OPTION_THREADS,
        .type = BELTRAMI_TYPE_INT,
        .name = "threads",
        .summary = "Threads to use, the calling one included; the result does not depend on it.",
        .minimum = 1,
        .maximum = 1024,
        .get = get<&Options::threads>,
        .set = set<&Options::threads>,
        .calls = kEveryCall | BELTRAMI_CALL_BAKE,
    },
    {
        .key = BELTRAMI_OPTION_UNIT_SQUARE,
        .type = BELTRAMI_TYPE_INT,
        .name = "unit-square",
        .summary = "1 scales and shifts the UVs into the unit square, where those of pages are in "
                   "any case; 0 keeps them in the mesh's unit of length.",
        .minimum = 0,
        .maximum = 1,
        .get = get<&Options::unit_square>,
        .set = set<&Options::unit_square>,
    },
    {
        .key = BELTRAMI_OPTION_FLATTEN,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "flatten",
        .summary =
            "How the method beltrami flattens the fine mesh. metric: a Poisson solve with a free "
            "boundary, and a polish. dirichlet: harmonic, boundary from the coarse map, faster, "
            "energy a little higher. gif: a harmonic subspace of a few boundary vertices with a "
            "scaffold. flim: the same, local injectivity only. bff: conformal, may flip.",
        .minimum = 0,
        .maximum = std::size(kFlattens) - 1,
        .choices = kFlattens,
        .get = get<&Options::flatten>,
        .set = set<&Options::flatten>,
    },
    {
        .key = BELTRAMI_OPTION_INJECTIVITY,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "injectivity",
        .summary = "What the optimisation sees to: global (no flips, no boundary crossings), local "
                   "(no flips: parts may overlap, at a slightly lower energy) or auto. That is "
                   "global, but for the method cm, which is left as the literature has it.",
        .minimum = 0,
        .maximum = std::size(kInjectivities) - 1,
        .choices = kInjectivities,
        .get = get<&Options::injectivity>,
        .set = set<&Options::injectivity>,
    },
    {
        .key = BELTRAMI_OPTION_REFINE,
        .type = BELTRAMI_TYPE_INT,
        .name = "refine",
        .summary = "1 goes on with composite majorization on the fine mesh from the result, to a "
                   "little less energy in much more time.",
        .minimum = 0,
        .maximum = 1,
        .get = get<&Options::refine>,
        .set = set<&Options::refine>,
    },
    {
        .key = BELTRAMI_OPTION_REFINE_ITERATIONS,
        .type = BELTRAMI_TYPE_INT,
        .name = "refine-iterations",
        .summary = "Iterations after which the refinement stops; 0 leaves it to the tolerance.",
        .minimum = 0,
        .maximum = 1e6,
        .get = get<&Options::refine_iterations>,
        .set = set<&Options::refine_iterations>,
    },
    {
        .key = BELTRAMI_OPTION_TIME_LIMIT,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "time-limit",
        .summary =
            "Seconds since the start of the run after which iterations stop with the best map "
            "so far; 0 sets no limit.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::time_limit>,
        .set = set<&Options::time_limit>,
    },
    {
        .key = BELTRAMI_OPTION_FLOAT32,
        .type = BELTRAMI_TYPE_INT,
        .name = "float32",
        .summary = "1 delivers UVs that single precision holds exactly, rounded so that the map "
                   "stays injective.",
        .minimum = 0,
        .maximum = 1,
        .get = get<&Options::float32>,
        .set = set<&Options::float32>,
        .calls = kEveryCall,
    },
    {
        .key = BELTRAMI_OPTION_DELAUNAY,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "delaunay",
        .summary = "on flips edges to the intrinsic Delaunay triangulation of the prolonged "
                   "metric before the fine mesh is flattened: what is injective then are its own "
                   "triangles on the same vertices.",
        .minimum = 0,
        .maximum = std::size(kSwitch) - 1,
        .choices = kSwitch,
        .get = get<&Options::delaunay>,
        .set = set<&Options::delaunay>,
        .calls = BELTRAMI_CALL_RUN,
    },
    {
        .key = BELTRAMI_OPTION_MEMORY_LIMIT,
        .type = BELTRAMI_TYPE_INT,
        .name = "memory-limit",
        .summary =
            "Bytes of memory that a run is to stay within by its estimate; 0 sets no limit. A run "
            "that needs more ends before it starts. Steps that only hard meshes need are left out "
            "where they would exceed it, or end the run if there is no map without them.",
        .minimum = 0,
        .maximum = 1e14,
        .get = get<&Options::memory_limit>,
        .set = set<&Options::memory_limit>,
    },
    {
        .key = BELTRAMI_OPTION_CUT,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "cut",
        .summary =
            "Where seams go beside those that are given. auto: short ones are searched for, along "
            "which the atlas has the target-energy. minimal: a short cut graph where a piece is no "
            "disk. islands: around the charts of the UVs that the mesh has, of which what is no "
            "disk is opened. given: nowhere, and what is no disk is opened as by minimal.",
        .minimum = 0,
        .maximum = std::size(kCuts) - 1,
        .choices = kCuts,
        .get = get<&Options::cut>,
        .set = set<&Options::cut>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_HARD_ANGLE,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "hard-angle",
        .summary = "Degrees between the normals of two faces above which the edge between them is "
                   "a seam, but for creases that end within the surface and part nothing; 180 "
                   "makes none.",
        .minimum = 0,
        .maximum = 180,
        .get = get<&Options::hard_angle>,
        .set = set<&Options::hard_angle>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_WELD,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "weld",
        .summary = "Whether vertices at one place, to the last bit, count as one: auto (yes, but a "
                   "mesh that is one disk as it stands stays so), on or off.",
        .minimum = 0,
        .maximum = std::size(kWelds) - 1,
        .choices = kWelds,
        .get = get<&Options::weld>,
        .set = set<&Options::weld>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_WELD_DISTANCE,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "weld-distance",
        .summary = "Vertices no further apart, in the mesh's unit of length, count as one; 0 those "
                   "at one place.",
        .minimum = 0,
        .maximum = 1e100,
        .get = get<&Options::weld_distance>,
        .set = set<&Options::weld_distance>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_FILL_HOLES,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "fill-holes",
        .summary = "Holes whose boundary is no longer than this many roots of their component's "
                   "area cost no seam, larger ones are joined to one; 0 joins all. The longest of "
                   "a component is its outline.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::fill_holes>,
        .set = set<&Options::fill_holes>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_SHARE_COPIES,
        .type = BELTRAMI_TYPE_INT,
        .name = "share-copies",
        .summary = "1 gives copies of a face, as of double-sided surfaces, the UVs of the first "
                   "instead of a layer of their own.",
        .minimum = 0,
        .maximum = 1,
        .get = get<&Options::share_copies>,
        .set = set<&Options::share_copies>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_PRESET,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "preset",
        .summary = "What the seams are for: sets options of the search that are not set otherwise. "
                   "none: their defaults. lightmap: target-energy 2.1, hidden-seams 0, hard-seams "
                   "0.5, flat-seams 2. texturing: concave-seams 0.6, hidden-seams 2. one-chart: "
                   "max-charts 1. hard-surface: hard-seams 0.5, flat-seams 6.",
        .minimum = 0,
        .maximum = std::size(kPresets) - 1,
        .choices = kPresets,
        .get = get<&Options::preset>,
        .set = set_preset,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_TARGET_ENERGY,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "target-energy",
        .summary = "Mean symmetric Dirichlet energy of the atlas that seams are searched for, 2 "
                   "for lengths that all stay: the nearer to 2, the longer the seams.",
        .minimum = kLeastTarget,
        .maximum = 1e9,
        .get = get<&Options::target, &SeamTarget::energy>,
        .set = set_target<&SeamTarget::energy>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_TARGET_P99,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "target-p99",
        .summary = "Energy that no more than 1% of the area is to exceed; 0 leaves it to the mean.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::target, &SeamTarget::p99>,
        .set = set_target<&SeamTarget::p99>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_MAX_CHARTS,
        .type = BELTRAMI_TYPE_INT,
        .name = "max-charts",
        .summary = "Charts that the search is to stay within, or one for each component where "
                   "there are more of these, if there is a way; 0 takes any number.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::target, &SeamTarget::max_charts>,
        .set = set<&Options::target, &SeamTarget::max_charts>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_SEAM_BUDGET,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "seam-budget",
        .summary = "Length of the seams, over the root of the area, that the search is to stay "
                   "within; 0 takes any length.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::target, &SeamTarget::seam_budget>,
        .set = set<&Options::target, &SeamTarget::seam_budget>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_CONCAVE_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "concave-seams",
        .summary = "How far seams seek concave edges and avoid convex ones; 0 does not tell them "
                   "apart. At a weight a one costs exp(-a c) of its length, where c goes from -1, "
                   "convex, to 1, concave.",
        .minimum = 0,
        .maximum = 10,
        .get = get<&Options::weights, &SeamWeights::concavity>,
        .set = set<&Options::weights, &SeamWeights::concavity>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_HIDDEN_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "hidden-seams",
        .summary = "How far seams hide; 0: not at all. At a weight b a seam costs 1 + b v times "
                   "its length, where v goes from 0, seen from nowhere, to 1, seen from all sides.",
        .minimum = 0,
        .maximum = 100,
        .get = get<&Options::weights, &SeamWeights::visibility>,
        .set = set<&Options::weights, &SeamWeights::visibility>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_HARD_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "hard-seams",
        .summary = "What a seam costs, times its length, along an edge whose faces turn by more "
                   "than 60 degrees: below 1 such edges are sought.",
        .minimum = 0.01,
        .maximum = 100,
        .get = get<&Options::weights, &SeamWeights::hard_edges>,
        .set = set<&Options::weights, &SeamWeights::hard_edges>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_MATERIAL_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "material-seams",
        .summary = "What a seam costs, times its length, along an edge between faces of different "
                   "materials, where these are given: below 1 such edges are sought.",
        .minimum = 0.01,
        .maximum = 100,
        .get = get<&Options::weights, &SeamWeights::materials>,
        .set = set<&Options::weights, &SeamWeights::materials>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_PACK,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "pack",
        .summary = "Where charts lie: pages (on square pages of a texture, all at one scale, UVs "
                   "in the unit square) or none (side by side, in the mesh's unit of length). "
                   "Charts with pins always lie as for none.",
        .minimum = 0,
        .maximum = std::size(kPacks) - 1,
        .choices = kPacks,
        .get = get<&Options::pack>,
        .set = set<&Options::pack>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_RESOLUTION,
        .type = BELTRAMI_TYPE_INT,
        .name = "resolution",
        .summary = "Texels to the side of a page.",
        .minimum = 8,
        .maximum = 32768,
        .get = get<&Options::resolution>,
        .set = set<&Options::resolution>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_MARGIN,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "margin",
        .summary = "Texels between two charts at least, and half as many to the edges of a page.",
        .minimum = 0,
        .maximum = 1024,
        .get = get<&Options::margin>,
        .set = set<&Options::margin>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_TEXELS_PER_UNIT,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "texels-per-unit",
        .summary = "Texels for a unit of length of the surface; 0 makes charts as large as they "
                   "fit into max-pages.",
        .minimum = 0,
        .maximum = 1e30,
        .get = get<&Options::texels_per_unit>,
        .set = set<&Options::texels_per_unit>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_MAX_PAGES,
        .type = BELTRAMI_TYPE_INT,
        .name = "max-pages",
        .summary = "Pages to fill at most; 0 takes one, or with texels-per-unit as many as there "
                   "have to be.",
        .minimum = 0,
        .maximum = 1000,
        .get = get<&Options::max_pages>,
        .set = set<&Options::max_pages>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_PACK_TURNS,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "pack-turns",
        .summary = "How charts may be turned on their page: any (as it fits best), quarter (their "
                   "least box along the texels) or none; they are never mirrored.",
        .minimum = 0,
        .maximum = std::size(kTurns) - 1,
        .choices = kTurns,
        .get = get<&Options::pack_turns>,
        .set = set<&Options::pack_turns>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_PACK_BLOCK,
        .type = BELTRAMI_TYPE_INT,
        .name = "pack-block",
        .summary = "Texels to the side of the blocks that no two charts share, as compressed "
                   "textures want it: 4; 1 leaves it to the margin.",
        .minimum = 1,
        .maximum = 64,
        .get = get<&Options::pack_block>,
        .set = set<&Options::pack_block>,
        .calls = BELTRAMI_CALL_UNWRAP | BELTRAMI_CALL_PACK,
    },
    {
        .key = BELTRAMI_OPTION_FILL_WEIGHT,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "fill-weight",
        .summary = "Length of seams, in roots of the area, that all of a page is worth to the "
                   "search for seams; 0 splits no chart. At 10 a chart is split in two where a "
                   "tenth of the root of the area lets a hundredth more of the pages be filled. "
                   "Charts of fewer than 32 triangles and those without a seam stay whole.",
        .minimum = 0,
        .maximum = 1e9,
        .get = get<&Options::fill_weight>,
        .set = set<&Options::fill_weight>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_SYMMETRIC_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "symmetric-seams",
        .summary = "How much more seams may cost for being symmetric where the surface is: 0.5 for "
                   "half as much again. They lie in the plane that it is mirrored by, or come in "
                   "pairs, to within a few edges; 0 does not look for one.",
        .minimum = 0,
        .maximum = 100,
        .get = get<&Options::weights, &SeamWeights::symmetry>,
        .set = set<&Options::weights, &SeamWeights::symmetry>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_STRAIGHT_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "straight-seams",
        .summary = "How far seams avoid turns: at a weight w one by an angle t, in the surface, "
                   "costs w (1 - cos t) times an edge there; 0 counts lengths alone.",
        .minimum = 0,
        .maximum = 100,
        .get = get<&Options::weights, &SeamWeights::straightness>,
        .set = set<&Options::weights, &SeamWeights::straightness>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_EFFORT,
        .type = BELTRAMI_TYPE_CHOICE,
        .name = "effort",
        .summary = "How long short seams are searched for, and a dense packing: quick, normal or "
                   "high. quick takes half the time of normal, for seams some 2% longer. high "
                   "takes some three times the time of normal, for seams some 2% shorter.",
        .minimum = 0,
        .maximum = std::size(kEfforts) - 1,
        .choices = kEfforts,
        .get = get<&Options::effort>,
        .set = set<&Options::effort>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    {
        .key = BELTRAMI_OPTION_FLAT_SEAMS,
        .type = BELTRAMI_TYPE_FLOAT,
        .name = "flat-seams",
        .summary = "How many times as long the seams of a part may be if it then unfolds without "
                   "distortion, as boxes and machined parts do along their edges. 0 spends all of "
                   "target-energy. Setting that or target-p99 sets this to 0: set it after them.",
        .minimum = 0,
        .maximum = 100,
        .get = get<&Options::target, &SeamTarget::flat_seams>,
        .set = set<&Options::target, &SeamTarget::flat_seams>,
        .calls = BELTRAMI_CALL_UNWRAP,
    },
    kStack,
    kRectify,
    kSnapTexels,
    kLabelPages,
};

}  // namespace

std::span<const OptionEntry> option_table() {
  return kOptions;
}

const OptionEntry* find_option(std::int32_t key) {
  if (key < 0 || static_cast<std::size_t>(key) >= std::size(kOptions)) return nullptr;
  return &kOptions[key];
}

}  // namespace beltrami
