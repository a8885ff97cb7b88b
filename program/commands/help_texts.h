// What --help says of each command, below its options.
#pragma once

namespace beltrami::cli {

inline constexpr const char* kExitCodes =
    "Exit codes: 0 injective, 3 not injective, 2 unusable arguments, files or mesh, 4 out of\n"
    "memory or an internal failure, 130 cancelled, 1 files written but no summary on stdout.";

inline constexpr const char* kKept =
    "OUT is IN with new texture coordinates: faces stay polygons (triangles for the computation, "
    "and\n"
    "for the verdict), and normals, colours, groups, materials and other attributes are kept "
    "where\n"
    "the format can hold them; a line says what is not kept.";

inline constexpr const char* kAnyMesh =
    "IN is any mesh: closed or open, in one piece or thousands, soups and broken files too. It is\n"
    "cut into charts, each is flattened, and the whole atlas is proven to be injective. Every\n"
    "corner of every face gets its UV.";

inline constexpr const char* kSeams =
    "Name your distortion, and the seams follow: --target-energy is the mean over the area of the\n"
    "symmetric Dirichlet energy, 2 where all lengths are kept. Short seams are searched for that\n"
    "bring the atlas there; the summary says whether they do. To shorten the seams raise it, to\n"
    "stretch less lower it towards 2. --preset sets what suits a purpose, and options beside it\n"
    "count more. Paint draws seams and drives them off, but forces nothing; --seams, --labels and\n"
    "--hard-angle force.\n\n"
    "  beltrami unwrap a.obj b.obj                       an energy of 2.05\n"
    "  beltrami unwrap a.obj b.obj --target-energy 2.2   more stretch, shorter seams\n"
    "  beltrami unwrap a.obj b.obj --preset one-chart    no more charts than pieces\n"
    "  beltrami unwrap a.obj b.obj --write-seams cut.txt and, once that is edited:\n"
    "  beltrami unwrap a.obj b.obj --seams cut.txt --cut given";

inline constexpr const char* kPages =
    "Charts are packed onto square pages of a texture, as large as they fit and all at one scale;\n"
    "--texels-per-unit sets the scale instead, and takes as many pages as it needs. In OUT page k "
    "is\n"
    "the tile of UDIM 1001 + k: u is greater by k mod 10, v by k div 10. Between charts are at "
    "least\n"
    "--margin texels, measured on the numbers that are written, and no chart is mirrored.";

inline constexpr const char* kPack =
    "The charts of the UVs that meshes have are packed anew: each is moved, turned and scaled, so\n"
    "that equal areas of all surfaces get equally many texels (--keep-scales: so that charts keep\n"
    "their sizes to each other). Charts that fold or overlap themselves stay so, and the summary\n"
    "says it.\n\n"
    "  beltrami pack bust.obj out.obj --resolution 2048 --margin 4\n"
    "  beltrami pack a.obj b.ply --output a2.obj b2.ply     one atlas for two meshes\n"
    "  beltrami pack old.obj new.obj --output old2.obj new2.obj --kept 1\n"
    "                          old.obj stays where it is, new.obj goes beside it\n"
    "  beltrami pack town.obj out.obj --texels-per-unit 64 --masks masks/town";

inline constexpr const char* kTransfer =
    "OLD and NEW are one mesh with two layouts of UVs, or two meshes of one shape. What TEXTURE\n"
    "shows on OLD, OUT shows on NEW: each texel reads the old page between its texels, and "
    "gutters\n"
    "are filled from their neighbours. Where NEW has the faces of OLD in the same order, a texel\n"
    "shows what its place on the face did. Where it has others (cut into other triangles, "
    "decimated,\n"
    "in another order), a texel shows the nearest place of OLD within 2% of its size that looks "
    "to\n"
    "the same side, so that thin walls keep their two sides; how many texels find none is said, "
    "and\n"
    "it is refused where most do not. The pages of OLD, where there are several, are "
    "name.1001.png,\n"
    "name.1002.png and so on for TEXTURE name.png, and so are those of NEW for OUT.\n\n"
    "With 'normals' OUT is a normal map of what the fine mesh OLD has and the coarse mesh NEW has\n"
    "not, along the tangents of MikkTSpace; with 'heights' it is how far OLD is from NEW along "
    "the\n"
    "normals of NEW; with 'occlusion' how much of a grey sky OLD sees there.\n\n"
    "With --cage a texel shows what is seen of OLD from outside: a ray comes along the smooth "
    "normal\n"
    "of NEW, from D above it to D below it. Where it meets nothing, the nearest place is taken.\n\n"
    "  beltrami unwrap painted.obj better.obj\n"
    "  beltrami transfer painted.obj better.obj paint.png better.png --margin 4\n"
    "  beltrami transfer scan.ply coarse.glb normals bumps.png --resolution 2048\n"
    "  beltrami transfer scan.ply coarse.glb occlusion shade.png --cage 0.05";

inline constexpr const char* kReportHelp =
    "Write a report; - prints it on standard output instead of the summary";

}  // namespace beltrami::cli
