// The program `beltrami`: the command line.
#include <beltrami/beltrami.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <vector>

#include "commands/command.h"
#include "commands/completions.h"
#include "commands/help_format.h"
#include "commands/help_texts.h"
#include "commands/man_page.h"
#include "commands/options.h"
#include "commands/spelling.h"
#include "files/inside_folder.h"
#include "process/descriptor.h"
#include "process/failure.h"
#include "process/interrupt.h"
#include "process/system.h"

namespace beltrami::cli {
namespace {

/// Takes the name "-" of a report for standard output.
template <class Arguments>
void take_standard_output(Arguments& arguments) {
  if (arguments.report != "-") return;
  arguments.report.clear();
  arguments.print_report = true;
}

void add_reach(CLI::App& command, Reach& reach) {
  command.add_flag_callback(
      "--allow-outside", [&reach] { reach = Reach::kAnywhere; },
      "Follow names inside a mesh (buffers of glTF, materials of OBJ) out of its folder;\n"
      "without it a file of a stranger has none read but those beside it");
}

void add_masks(CLI::App& command, std::string& masks) {
  command
      .add_option("--masks", masks,
                  "Write the texels of each page as FOLDER/NAME.1001.png and so on: white\n"
                  "covered by charts, grey a gutter of the margin's width, black free")
      ->group("Pages")
      ->type_name("FOLDER/NAME");
}

CLI::App* add_pack(CLI::App& app, PackArguments& arguments, Options& options) {
  CLI::App* command = app.add_subcommand("pack", "Pack the charts of meshes with UVs onto pages");
  command
      ->add_option("IN", arguments.files,
                   "Meshes with UVs to read: .obj, .ply, .gltf or .glb; without --output one,\n"
                   "and behind it the mesh to write")
      ->required();
  command
      ->add_option("-o,--output", arguments.outputs,
                   "Meshes to write, one for each IN: .obj or .ply; .gltf or .glb where IN is glTF")
      ->type_name("OUT");
  command
      ->add_option("--kept", arguments.kept,
                   "The charts of the first N meshes stay where they are, in [0,1]^2 and the\n"
                   "tiles of UDIM; the others go beside them, at their density")
      ->group("Pages")
      ->type_name("N");
  command
      ->add_option(
          "--labels", arguments.labels,
          "Give each of the materials, groups or objects of an OBJ file pages of its own,\n"
          "all at one density; or each value of a property of the faces of PLY, or of\n"
          "glTF (material). --max-pages counts those of each")
      ->group("Pages")
      ->type_name("NAME");
  command
      ->add_flag("--keep-scales", arguments.keep_scales,
                 "Charts keep their sizes to each other, whatever their areas in space")
      ->group("Pages");
  command
      ->add_flag(
          "--mirrored", arguments.mirrored,
          "Charts that are mirrored as a whole, as in UVs of two like halves, are no fault:\n"
          "they stay mirrored, and the exit code is that of their mirror images")
      ->group("Pages");
  add_masks(*command, arguments.masks);
  command
      ->add_option(
          "--uv-set", arguments.uv_set,
          "The UVs of a glTF file that are written: TEXCOORD_0 (the default), TEXCOORD_1...")
      ->type_name("NUMBER");
  options.add_to(*command);
  command->add_option("--report", arguments.report, kReportHelp)->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the pages")
      ->type_name("FILE.png");
  add_reach(*command, arguments.reach);
  command->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(std::string(kPack) + "\n\n" + kPages + "\n\n" + kExitCodes);
  return command;
}

CLI::App* add_transfer(CLI::App& app, TransferArguments& arguments) {
  CLI::App* command = app.add_subcommand("transfer", "Bake a texture for other UVs of a mesh");
  command->add_option("OLD", arguments.old_mesh, "Mesh with the UVs of TEXTURE")->required();
  command->add_option("NEW", arguments.new_mesh, "The mesh with other UVs, or another of its shape")
      ->required();
  command
      ->add_option("TEXTURE", arguments.texture,
                   "Texture to read: .png, .jpg, .webp, .hdr or .exr; or 'normals', 'heights' or\n"
                   "'occlusion' of OLD itself, which needs no UVs then")
      ->required();
  command
      ->add_option("OUT", arguments.output,
                   "Texture to write: .png; .hdr or .exr of one of these; heights also as .exr")
      ->required();
  command
      ->add_option(
          "--wrap", arguments.wrap,
          "What UVs of OLD beyond [0,1]^2 show: TEXTURE again (repeat), again and mirrored\n"
          "in turn (mirror), its edge (clamp), or the next of its tiles of UDIM (tiles);\n"
          "auto takes the tiles where they are beside TEXTURE, else repeats it\n"
          "[default auto]")
      ->check(CLI::IsMember({"auto", "repeat", "mirror", "clamp", "tiles"}))
      ->type_name("auto|repeat|mirror|clamp|tiles");
  command
      ->add_option("--resolution", arguments.resolution,
                   "Texels to the side of a page of OUT; 0 takes those of TEXTURE [0 to 32768]")
      ->check(CLI::Range(0, 32768))
      ->type_name("N");
  command
      ->add_option("--margin", arguments.margin, "Texels of gutters to fill [0 to 1024; default 2]")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
  command
      ->add_option("--cage", arguments.cage,
                   "How far rays along the smooth normals of NEW look for OLD, outwards and\n"
                   "inwards, in the unit of the meshes; 0 takes the nearest places [default 0]")
      ->check(CLI::Range(0.0, 1e9))
      ->type_name("D");
  command
      ->add_option("--rays", arguments.rays,
                   "Rays to the sky of each texel, for 'occlusion' [1 to 4096; default 128]")
      ->check(CLI::Range(1, 4096))
      ->type_name("N");
  add_reach(*command, arguments.reach);
  command->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(std::string(kTransfer) +
                  "\n\nExit codes: 0 done, 2 unusable arguments or files, 4 out of memory or an\n"
                  "internal failure, 130 cancelled.");
  return command;
}

void add_bake(CLI::App& command, UnwrapArguments& arguments) {
  command
      .add_flag(
          "--bake", arguments.bake,
          "Bake the textures of the materials of IN (OBJ or glTF) for the new UVs, on a page\n"
          "of --resolution texels each, and write them with OUT: in .glb, beside .gltf and\n"
          ".obj")
      ->group("Pages");
  command
      .add_flag("--merge-materials", arguments.merge_materials,
                "With --bake, to glTF: one material of all, and one set of pictures for it.\n"
                "Materials stay apart that differ in more than textures and factors")
      ->group("Pages");
}

/// What says where charts end, and where that is written.
void add_seams(CLI::App& command, UnwrapArguments& arguments) {
  command
      .add_option("--seams", arguments.seams,
                  "Edges to cut: a text of pairs of vertex numbers, counted from 0")
      ->group("Charts")
      ->type_name("FILE");
  command
      .add_option("--labels", arguments.labels,
                  "Cut where these differ: the materials, groups or objects of an OBJ file,\n"
                  "or a property of the faces of PLY, or of glTF (material)")
      ->group("Charts")
      ->type_name("NAME");
  command
      .add_option(
          "--paint", arguments.paint,
          "What draws seams, with --cut auto: a text with a line for each, 'v VERTEX FACTOR'\n"
          "or 'e VERTEX VERTEX FACTOR' for an edge; vertices count from 0, and a seam costs\n"
          "its length times the factors, from 0.05 to 20: less than 1 draws it")
      ->group("Charts")
      ->type_name("FILE");
  command
      .add_option("--materials", arguments.materials,
                  "Draw seams, with --cut auto, to where these differ: named as for --labels")
      ->group("Charts")
      ->type_name("NAME");
  command
      .add_option("--write-seams", arguments.written_seams,
                  "Write the seams, those given and those found, as --seams reads them")
      ->group("Charts")
      ->type_name("FILE");
}

/// What is held of UVs, and what is to be straight.
void add_pins(CLI::App& command, UnwrapArguments& arguments) {
  command
      .add_option("--pins", arguments.pins,
                  "UVs to hold: a text with a line for each, 'v VERTEX U V' for all corners of a\n"
                  "vertex or 'c CORNER U V' for one; vertices and the corners of all faces one\n"
                  "after another count from 0, UVs are in the unit of IN; - for a number leaves\n"
                  "it free, and two numbers more are the direction of a line to stay on")
      ->group("Charts")
      ->type_name("FILE");
  command
      .add_option("--straighten", arguments.straighten,
                  "What is to be straight: a text with a line for each, 'r FACE' for the chart of\n"
                  "a face as a rectangle (and its corners, four vertices, where its border has no\n"
                  "clear ones), or 'u', 'v' or 'l' and the two vertices of an edge, which lies at\n"
                  "one u, at one v or on a line with those that it meets; all count from 0")
      ->group("Charts")
      ->type_name("FILE");
}

CLI::App* add_unwrap(CLI::App& app, UnwrapArguments& arguments, Options& options) {
  CLI::App* command = app.add_subcommand("unwrap", "Unwrap any mesh to an atlas of UVs");
  command->add_option("IN", arguments.input, "Mesh to read: .obj, .off, .ply, .stl, .gltf or .glb")
      ->required();
  command->add_option("OUT", arguments.output, "Mesh with UVs to write: .obj, .ply, .gltf or .glb")
      ->required();
  add_seams(*command, arguments);
  add_pins(*command, arguments);
  command
      ->add_option(
          "--uv-set", arguments.uv_set,
          "The UVs of a glTF file that are written: TEXCOORD_0 (the default), TEXCOORD_1...")
      ->type_name("NUMBER");
  add_bake(*command, arguments);
  add_masks(*command, arguments.masks);
  options.add_to(*command);
  command->add_flag("--triangulate", arguments.triangulate,
                    "Write the triangles that were computed on, in the orientation in which their\n"
                    "UVs are positive");
  command->add_option("--report", arguments.report, kReportHelp)->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the atlas")
      ->type_name("FILE.png");
  command
      ->add_option("--html", arguments.html,
                   "Write a page for browsers that shows the model beside its layout; it is one\n"
                   "file, and needs no network")
      ->type_name("FILE.html");
  add_reach(*command, arguments.reach);
  command->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(std::string(kAnyMesh) + "\n\n" + kSeams + "\n\n" + kPages + "\n\n" + kKept +
                  "\n\n" + kExitCodes);
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
  command->add_option("--report", arguments.report, kReportHelp)->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  add_reach(*command, arguments.reach);
  command->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
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
  command
      ->add_option(
          "--uv-set", arguments.uv_set,
          "The UVs of a glTF file that are judged: TEXCOORD_0 (the default), TEXCOORD_1...")
      ->type_name("NUMBER");
  command
      ->add_option("--resolution", arguments.resolution,
                   "Texels to the side of a page, which margin and density are said in\n"
                   "[8 to 32768; default 1024]")
      ->check(CLI::Range(8, 32768))
      ->group("Pages")
      ->type_name("N");
  command
      ->add_option("--margin", arguments.margin,
                   "Fail where there are fewer texels between two charts, or half as many to the\n"
                   "edge of a page [0 to 1024; default 0]")
      ->check(CLI::Range(0.0, 1024.0))
      ->group("Pages")
      ->type_name("X");
  command
      ->add_option("--labels", arguments.labels,
                   "Say the density of each of the materials, groups or objects of an OBJ file,\n"
                   "or of each value of a property of the faces of PLY, or of glTF (material)")
      ->group("Pages")
      ->type_name("NAME");
  command->add_flag("--within-page", arguments.within_page, "Fail where UVs leave [0,1]^2")
      ->group("Pages");
  command
      ->add_flag("--within-tiles", arguments.within_tiles,
                 "Fail where a chart is not within one of the tiles of UDIM")
      ->group("Pages");
  command->add_option("--report", arguments.report, kReportHelp)->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  add_reach(*command, arguments.reach);
  command->add_flag("-q,--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(
      std::string(kExitCodes) +
      "\nUVs that are not as --margin, --within-page and --within-tiles ask end with 3.");
  return command;
}

constexpr std::array<const char*, 3> kShells = {"bash", "zsh", "fish"};

/// The last command.
CLI::App* add_completions(CLI::App& app, std::string& shell) {
  CLI::App* command = app.add_subcommand("completions", "Print what a shell completes commands by");
  command->add_option("SHELL", shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(std::vector<std::string>(kShells.begin(), kShells.end())));
  command->footer(
      "  beltrami completions bash \\\n"
      "    > ~/.local/share/bash-completion/completions/beltrami\n"
      "  beltrami completions zsh > ~/.zfunc/_beltrami   where fpath names that folder\n"
      "  beltrami completions fish > ~/.config/fish/completions/beltrami.fish");
  return command;
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// What a shell completes of a command, or of what stands before it.
CompletedCommand completed(const CLI::App& command) {
  CompletedCommand all{command.get_name(), command.get_description(), {}, {}};
  for (const CLI::Option* option : command.get_options()) {
    CompletedOption own;
    for (const std::string& name : option->get_snames()) own.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) own.names.push_back("--" + name);
    if (own.names.empty()) continue;  // a file, in its place
    own.takes_value = option->get_items_expected_max() > 0;
    const std::string type = option->get_type_name();
    if (own.takes_value && type.find('|') != std::string::npos) {
      std::istringstream choices(type);
      for (std::string choice; std::getline(choices, choice, '|');) own.choices.push_back(choice);
    }
    const std::string text = option->get_description();
    own.summary = text.substr(0, text.find_first_of(".,:(\n"));
    all.options.push_back(std::move(own));
  }
  return all;
}

std::vector<CompletedCommand> completed_commands(const CLI::App& app) {
  std::vector<CompletedCommand> all;
  for (const CLI::App* command : app.get_subcommands({})) all.push_back(completed(*command));
  return all;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// What an option of no command was to be, or whose it is.
std::string unknown_option(const CLI::App& app, const CLI::App& command, const std::string& name) {
  std::string text = "there is no option " + name + " of " + command.get_name();
  const std::string nearest = nearest_spelling(name, option_names(command));
  if (!nearest.empty()) return text + ": did you mean " + nearest + "?";
  std::vector<std::string> others;
  for (const CLI::App* other : app.get_subcommands({})) {
    if (contains(option_names(*other), name)) others.push_back(other->get_name());
  }
  if (!others.empty()) return text + ": it is one of " + joined(others);
  return text + ": see beltrami " + command.get_name() + " --help";
}

/// The command that a command line names, and a space; "" where it names none.
std::string command_of(const CLI::App& app, const std::vector<std::string>& words) {
  const std::vector<std::string> names = command_names(app);
  for (const std::string& word : words) {
    if (contains(names, word)) return word + " ";
  }
  return "";
}

/// The first word of the command line that is no command or no option, with what it was to be; ""
/// where there is none.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* command = nullptr;
  for (const std::string& word : words) {
    if (word == "--") break;
    const std::string name = word.substr(0, word.find('='));
    if (word.starts_with("--")) {
      const CLI::App& owner = command != nullptr ? *command : app;
      if (contains(option_names(owner), name)) continue;
      if (command != nullptr) return unknown_option(app, owner, name);
      const std::string nearest = nearest_spelling(name, option_names(app));
      return "there is no option " + name + " before a command" +
             (nearest.empty() ? "" : ": did you mean " + nearest + "?");
    }
    if (command != nullptr || word.starts_with("-")) continue;
    const std::vector<std::string> names = command_names(app);
    if (contains(names, word)) {
      command = app.get_subcommand(word);
      continue;
    }
    const std::string nearest = nearest_spelling(word, names);
    return "there is no command '" + word + "': " +
           (nearest.empty() ? "the commands are " + joined(names)
                            : "did you mean " + nearest + "?");
  }
  return "";
}

std::string version_text() {
  const std::uint32_t version = beltrami_version();
  return std::to_string(version / 1000000) + "." + std::to_string(version / 1000 % 1000) + "." +
         std::to_string(version % 1000);
}

int run(int argc, char** argv) {
  CLI::App app("Injective, low-distortion UVs: atlases of any mesh, packed, and maps of disks",
               "beltrami");
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  app.formatter(std::make_shared<HelpFormat>(asks_briefly(words)));
  app.set_help_flag("-h,--help", "Print help, -h the most of it, and exit");
  app.set_version_flag("--version", beltrami_build_info());
  app.require_subcommand(1);
  app.allow_windows_style_options(false);  // a path may begin with a slash there, too
  app.footer(kExitCodes);
  Options of_flatten(BELTRAMI_CALL_RUN), of_unwrap(BELTRAMI_CALL_UNWRAP),
      of_pack(BELTRAMI_CALL_PACK);
  FlattenArguments flatten;
  UnwrapArguments unwrap;
  CheckArguments check;
  PackArguments pack;
  TransferArguments transfer;
  const CLI::App* unwrap_app = add_unwrap(app, unwrap, of_unwrap);
  const CLI::App* flatten_app = add_flatten(app, flatten, of_flatten);
  add_check(app, check);
  const CLI::App* pack_app = add_pack(app, pack, of_pack);
  const CLI::App* transfer_app = add_transfer(app, transfer);
  std::string shell;
  const CLI::App* completions_app = add_completions(app, shell);
  app.add_flag_callback(
         "--man", [&app] { throw CLI::CallForVersion(man_page(app, version_text()), 0); },
         "Print the manual page, beltrami.1")
      ->configurable(false);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text, none;
    const int code = app.exit(help, text, none);
    return print(text.str(), "the text", code);
  } catch (const CLI::ParseError& error) {
    const std::string unknown = unknown_word(app, words);
    if (!unknown.empty()) return tell(kExitUnusable, {"beltrami: ", unknown});
    return tell(kExitUnusable,
                {"beltrami: ", error.what(), " (see beltrami ", command_of(app, words), "--help)"});
  }
  if (completions_app->parsed()) {
    std::vector<CompletedCommand> commands = completed_commands(app);
    commands.back().words = {kShells.begin(), kShells.end()};
    return print(completions(shell, completed(app).options, commands), "the completions", 0);
  }
  take_standard_output(flatten);
  take_standard_output(unwrap);
  take_standard_output(pack);
  take_standard_output(check);
  if (pack_app->parsed()) return pack_command(pack, of_pack);
  if (transfer_app->parsed()) return transfer_command(transfer);
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
  prepare_console();
  install_signal_handlers();
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return tell(kExitInternal, {"beltrami: out of memory"});
  } catch (const std::exception& error) {
    return tell(kExitInternal, {"beltrami: ", error.what()});
  }
}
