// One atlas in every format: what is read back is injective, in the numbers that the format holds
// and in single precision, whichever way V is turned.
#include <beltrami/beltrami.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "files/mesh_file.h"
#include "files/surface_view.h"
#include "gltf_builder.h"
#include "run_program.h"
#include "temporary_directory.h"

namespace beltrami::cli {
namespace {

/// Squares whose lower side has a face of a relative height of 1e-6 to 1e-8 on it: low on a page
/// such faces are there or not by the way in which V is rounded.
std::string cards() {
  GltfBuilder builder;
  const auto add = [&](float x, float width, float height) {
    const float middle = x + 0.47f * width;
    builder.mesh({{"POSITION", builder.vectors3({x, 0, 0, x + width, 0, 0, x + width, 1, 0, x, 1, 0,
                                                 middle, height * width, 0})}},
                 builder.indices<std::uint8_t>({0, 1, 4, 0, 4, 3, 4, 1, 2, 4, 2, 3}));
  };
  for (int i = 0; i < 16; ++i) {
    constexpr std::array<float, 4> kHeights = {1e-6f, 1.6e-7f, 4e-8f, 1e-8f};
    add(static_cast<float>(2 * i), 0.75f + 0.011f * static_cast<float>(i), kHeights[i % 4]);
  }
  return builder.glb();
}

using Stored = std::array<double, 2> (*)(double u, double v);

std::array<double, 2> as_it_is(double u, double v) {
  return {u, v};
}
std::array<double, 2> single_up(double u, double v) {
  return {double{static_cast<float>(u)}, double{static_cast<float>(v)}};
}
std::array<double, 2> single_down(double u, double v) {
  return {double{static_cast<float>(u)}, -double{static_cast<float>(1 - v)}};
}
std::array<double, 2> turned_in_single(double u, double v) {
  return {double{static_cast<float>(u)}, -double{1 - static_cast<float>(v)}};
}

/// The verdict on the UVs of a file, stored so.
bool injective(MeshFile file, Stored stored) {
  std::vector<double>& uvs = file.corner_uvs.of_corner.empty() ? file.uvs : file.corner_uvs.values;
  for (std::size_t i = 0; i < uvs.size(); i += 2) {
    const auto [u, v] = stored(uvs[i], uvs[i + 1]);
    uvs[i] = u;
    uvs[i + 1] = v;
  }
  const SurfaceView view(file);
  const beltrami_surface surface = view.surface();
  beltrami_atlas_certificate found{};
  found.struct_size = sizeof found;
  return beltrami_check_atlas(&surface, 0, &found, nullptr, 0) == BELTRAMI_OK;
}

TEST(Formats, HoldOneAtlasWithoutAFold) {
  const TemporaryDirectory directory;
  const std::string input = directory.file("in.glb", cards());
  const std::string again = directory.path("again.glb");
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--cut", "minimal"},
                                                  {"--float32", "--cut", "minimal"},
                                                  {"--preset", "lightmap"}}) {
    for (const char* name : {"out.obj", "out.ply", "out.glb", "out.gltf"}) {
      std::vector<std::string> arguments = {"unwrap", input, directory.path(name)};
      arguments.insert(arguments.end(), options.begin(), options.end());
      const Outcome outcome = run(arguments);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
      const MeshFile file = read_mesh(directory.path(name), Content::kAll);
      EXPECT_TRUE(injective(file, as_it_is)) << name;
      EXPECT_TRUE(injective(file, single_up)) << name;
      EXPECT_TRUE(injective(file, single_down)) << name;
      const bool float32 = options[0] == "--float32";
      const bool exact = float32 || format_of(name) == MeshFormat::kGltf;
      EXPECT_TRUE(!exact || injective(file, turned_in_single)) << name;
    }
    EXPECT_EQ(run({"pack", directory.path("out.glb"), "--output", again}).exit_code, 0);
    const MeshFile packed = read_mesh(again, Content::kAll);
    for (const Stored stored : {as_it_is, single_up, single_down, turned_in_single}) {
      EXPECT_TRUE(injective(packed, stored));
    }
  }
}

TEST(Formats, AreJudgedByWhatTheyHold) {
  const TemporaryDirectory directory;
  const std::string input = directory.file("in.glb", cards());
  const std::string obj = directory.path("out.obj"), glb = directory.path("out.glb");
  // In the unit of the mesh, as it lies there, for which glTF has fewer numbers than OBJ.
  const auto unwrapped = [&](const std::string& output) {
    return run({"unwrap", input, output, "--cut", "minimal", "--pack", "none"});
  };
  EXPECT_EQ(unwrapped(obj).exit_code, 0);
  EXPECT_TRUE(injective(read_mesh(obj, Content::kAll), as_it_is));
  const Outcome outcome = unwrapped(glb);
  const bool is_injective = injective(read_mesh(glb, Content::kAll), as_it_is);
  EXPECT_EQ(outcome.exit_code, is_injective ? 0 : 3);
  const bool is_said = outcome.err.find("have them on pages") != std::string::npos;
  EXPECT_EQ(is_said, !is_injective) << outcome.err;
}

}  // namespace
}  // namespace beltrami::cli
