// The program `beltrami`: the command line.
#include <beltrami/beltrami.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <exception>
#include <new>
#include <sstream>

#include "commands/command.h"
#include "commands/options.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"

namespace beltrami::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 injective, 3 not injective, 2 unusable arguments, files or mesh, 4 out of\n"
    "memory or an internal failure, 130 cancelled, 1 files written but no summary on stdout.";

constexpr const char* kKept =
    "OUT is IN with new texture coordinates: faces stay polygons (triangles for the computation, "
    "and\n"
    "for the verdict), and normals, colours, groups, materials and other attributes are kept "
    "where\n"
    "the format can hold them; a line says what is not kept.";

constexpr const char* kAnyMesh =
    "IN is any mesh: closed or open, in one piece or thousands, soups and broken files too. It is\n"
    "cut into charts, each is flattened, and the whole atlas is proven to be injective. Every\n"
    "corner of every face gets its UV.";

constexpr const char* kSeams =
    "Name your distortion, and the seams follow: --target-energy is the mean over the area of the\n"
    "symmetric Dirichlet energy, 2 where all lengths are kept. Short seams are searched for that\n"
    "bring the atlas there; the summary says whether they do. To shorten the seams raise it, to\n"
    "stretch less lower it towards 2. --preset sets what suits a purpose, and options beside it\n"
    "count more. Paint draws seams and drives them off, but forces nothing; --seams, --labels and\n"
    "--hard-angle force.\n\n"
    "  beltrami unwrap bust.obj out.obj                        an energy of 2.05\n"
    "  beltrami unwrap bust.obj out.obj --target-energy 2.2    more stretch, shorter seams\n"
    "  beltrami unwrap bust.obj out.obj --preset one-chart     no more charts than pieces\n"
    "  beltrami unwrap bust.obj out.obj --write-seams cut.txt  and, once that is edited:\n"
    "  beltrami unwrap bust.obj out.obj --seams cut.txt --cut given";

CLI::App* add_unwrap(CLI::App& app, UnwrapArguments& arguments, Options& options) {
  CLI::App* command = app.add_subcommand("unwrap", "Unwrap any mesh to an atlas of UVs");
  command->add_option("IN", arguments.input, "Mesh to read: .obj, .off, .ply, .stl, .gltf or .glb")
      ->required();
  command
      ->add_option("OUT", arguments.output,
                   "Mesh with UVs to write: .obj or .ply; .gltf or .glb where IN is glTF")
      ->required();
  command
      ->add_option("--seams", arguments.seams,
                   "Edges to cut: a text of pairs of vertex numbers, counted from 0")
      ->group("Charts")
      ->type_name("FILE");
  command
      ->add_option("--labels", arguments.labels,
                   "Cut where these differ: the materials, groups or objects of an OBJ file,\n"
                   "or a property of the faces of a PLY file")
      ->group("Charts")
      ->type_name("NAME");
  command
      ->add_option(
          "--paint", arguments.paint,
          "What draws seams, with --cut auto: a text with a line for each, 'v VERTEX FACTOR'\n"
          "or 'e VERTEX VERTEX FACTOR' for an edge; vertices count from 0, and a seam costs\n"
          "its length times the factors, from 0.05 to 20: less than 1 draws it")
      ->group("Charts")
      ->type_name("FILE");
  command
      ->add_option("--materials", arguments.materials,
                   "Draw seams, with --cut auto, to where these differ: named as for --labels")
      ->group("Charts")
      ->type_name("NAME");
  command
      ->add_option("--write-seams", arguments.written_seams,
                   "Write the seams, those given and those found, as --seams reads them")
      ->group("Charts")
      ->type_name("FILE");
  command
      ->add_option(
          "--uv-set", arguments.uv_set,
          "The UVs of a glTF file that are written: TEXCOORD_0 (the default), TEXCOORD_1...")
      ->type_name("NUMBER");
  command
      ->add_option("--pins", arguments.pins,
                   "UVs to hold: a text with a line for each, 'v VERTEX U V' for all corners of a\n"
                   "vertex or 'c CORNER U V' for one; vertices and the corners of all faces one\n"
                   "after another count from 0, UVs are in the unit of IN")
      ->group("Charts")
      ->type_name("FILE");
  options.add_to(*command);
  command->add_flag("--triangulate", arguments.triangulate,
                    "Write the triangles that were computed on, in the orientation in which their\n"
                    "UVs are positive");
  command->add_option("--report", arguments.report, "Write a report")->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the atlas")
      ->type_name("FILE.png");
  command->add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(std::string(kAnyMesh) + "\n\n" + kSeams + "\n\n" + kKept + "\n\n" + kExitCodes);
  return command;
}

CLI::App* add_flatten(CLI::App& app, FlattenArguments& arguments, Options& options) {
  CLI::App* command = app.add_subcommand("flatten", "Flatten a disk-like triangle mesh to UVs");
  command->add_option("IN", arguments.input, "Mesh to read: .obj, .off, .ply, .stl, .gltf or .glb")
      ->required();
  command->add_option("OUT", arguments.output, "Mesh with UVs to write: .obj or .ply")->required();
  command->add_flag("--weld", arguments.weld,
                    "Flatten vertices at one place (to the last bit) as one; every vertex of the\n"
                    "file stays in OUT");
  options.add_to(*command);
  command->add_option("--report", arguments.report, "Write a report")->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  command->add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(std::string("IN is one disk; unwrap takes any mesh.\n\n") + kKept + "\n\n" +
                  kExitCodes);
  return command;
}

CLI::App* add_check(CLI::App& app, CheckArguments& arguments) {
  CLI::App* command = app.add_subcommand("check", "Judge the UVs that a mesh file carries");
  command->add_option("MESH", arguments.input, "Mesh with UVs: .obj, .ply, .gltf or .glb")
      ->required();
  command->add_flag("--float32", arguments.float32, "Judge the UVs rounded to single precision");
  command->add_flag("--weld", arguments.weld,
                    "Judge vertices at one place and with one UV (to the last bit) as one");
  command->add_flag("--mirrored", arguments.mirrored,
                    "Take charts of an atlas that are mirrored as a whole for their mirror images");
  command->add_option("--report", arguments.report, "Write a report")->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  command->add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(kExitCodes);
  return command;
}

int run(int argc, char** argv) {
  CLI::App app("Injective, low-distortion UVs: atlases of any mesh, and maps of disks", "beltrami");
  app.set_version_flag("--version", beltrami_build_info());
  app.require_subcommand(1);
  app.footer(kExitCodes);
  Options of_flatten(BELTRAMI_CALL_RUN), of_unwrap(BELTRAMI_CALL_UNWRAP);
  FlattenArguments flatten;
  UnwrapArguments unwrap;
  CheckArguments check;
  const CLI::App* unwrap_app = add_unwrap(app, unwrap, of_unwrap);
  const CLI::App* flatten_app = add_flatten(app, flatten, of_flatten);
  add_check(app, check);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text, none;
    const int code = app.exit(help, text, none);
    return print(text.str(), "the text", code);
  } catch (const CLI::ParseError& error) {
    return tell(kExitUnusable, {"beltrami: ", error.what(), " (see beltrami --help)"});
  }
  if (unwrap_app->parsed()) return unwrap_command(unwrap, of_unwrap);
  return flatten_app->parsed() ? flatten_command(flatten, of_flatten) : check_command(check);
}

/// Before the static objects of CLI11, which need memory, are made.
[[gnu::constructor(101)]] void prepare_for_static_objects() {
  install_terminate_handler();
}

}  // namespace
}  // namespace beltrami::cli

int main(int argc, char** argv) {
  using namespace beltrami::cli;
  reserve_standard_descriptors();
  install_signal_handlers();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return tell(kExitInternal, {"beltrami: out of memory"});
  } catch (const std::exception& error) {
    return tell(kExitInternal, {"beltrami: ", error.what()});
  }
}
