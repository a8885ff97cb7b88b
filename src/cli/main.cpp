// The program `beltrami`: the command line.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>

#include "command.h"
#include "interrupt.h"

namespace beltrami::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 injective, 3 not injective, 2 unusable arguments, files or mesh, 4 out of\n"
    "memory or an internal failure, 130 cancelled.";

CLI::App* add_flatten(CLI::App& app, FlattenArguments& arguments, Options& options) {
  CLI::App* command = app.add_subcommand("flatten", "Flatten a disk-like triangle mesh to UVs");
  command->add_option("IN", arguments.input, "Mesh to read: .obj, .off, .ply or .stl")->required();
  command->add_option("OUT", arguments.output, "Mesh with UVs to write: .obj or .ply")->required();
  options.add_to(*command);
  command->add_option("--report", arguments.report, "Write a report")->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  command->add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(kExitCodes);
  return command;
}

CLI::App* add_check(CLI::App& app, CheckArguments& arguments) {
  CLI::App* command = app.add_subcommand("check", "Judge the UVs that a mesh file carries");
  command->add_option("MESH", arguments.input, "Mesh with UVs: .obj or .ply")->required();
  command->add_flag("--float32", arguments.float32, "Judge the UVs rounded to single precision");
  command->add_option("--report", arguments.report, "Write a report")->type_name("FILE.json");
  command->add_option("--picture", arguments.picture, "Write a picture of the map")
      ->type_name("FILE.png");
  command->add_flag("--quiet", arguments.quiet, "Print nothing but errors");
  command->footer(kExitCodes);
  return command;
}

int run(int argc, char** argv) {
  install_interrupt_handler();
  CLI::App app("Injective, low-distortion flattening of disk-like triangle meshes", "beltrami");
  app.set_version_flag("--version", beltrami_build_info());
  app.require_subcommand(1);
  app.footer(kExitCodes);
  Options options;
  FlattenArguments flatten;
  CheckArguments check;
  const CLI::App* flatten_app = add_flatten(app, flatten, options);
  add_check(app, check);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "beltrami: %s (see beltrami --help)\n", one_line(error.what()).c_str());
    return kExitUnusable;
  }
  return flatten_app->parsed() ? flatten_command(flatten, options) : check_command(check);
}

}  // namespace
}  // namespace beltrami::cli

int main(int argc, char** argv) {
  try {
    return beltrami::cli::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "beltrami: %s\n", beltrami::cli::one_line(error.what()).c_str());
    return beltrami::cli::kExitInternal;
  }
}
