// Matrices of either order are the same mesh; none is read in the wrong one.
#include <gtest/gtest.h>
#include <beltrami/adaptors/eigen.hpp>
#include <beltrami/beltrami.hpp>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

template <class Scalar>
using ByRows = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
template <class Scalar>
using ByColumns = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor>;

/// The hump in matrices, and its UVs from plain arrays.
struct Hump {
  Triangles mesh = hump(6);
  ByColumns<double> positions = matrix_of<ByColumns<double>>(mesh.positions);
  ByColumns<std::int32_t> faces = matrix_of<ByColumns<std::int32_t>>(mesh.faces);
  std::vector<Uv> uvs = Context().flatten(Surface(mesh.positions, mesh.faces)).uvs();
};

TEST(CppEigen, EitherOrderIsTheSameSurface) {
  const Hump hump;
  const ByRows<double> rows = hump.positions;
  const ByRows<std::int64_t> faces = hump.faces.cast<std::int64_t>();
  Context context;
  EXPECT_EQ(context.flatten(surface_of(hump.positions, hump.faces)).uvs(), hump.uvs);
  EXPECT_EQ(context.flatten(surface_of(rows, faces)).uvs(), hump.uvs);
  EXPECT_EQ(context.flatten(surface_of(rows, hump.faces)).uvs(), hump.uvs);
  EXPECT_EQ(context.flatten(surface_of(hump.positions, faces)).uvs(), hump.uvs);
}

TEST(CppEigen, FixedWidthsBlocksMapsAndExpressionsAreTaken) {
  const Hump hump;
  Context context;
  const Eigen::Matrix<double, Eigen::Dynamic, 3> fixed = hump.positions;
  const Eigen::Matrix<std::uint32_t, Eigen::Dynamic, 3, Eigen::RowMajor> faces =
      hump.faces.cast<std::uint32_t>();
  EXPECT_EQ(context.flatten(surface_of(fixed, faces)).uvs(), hump.uvs);

  ByRows<double> wide = ByRows<double>::Constant(hump.positions.rows(), 5, 77);
  wide.middleCols(1, 3) = hump.positions;
  const auto block = wide.middleCols(1, 3);
  EXPECT_EQ(context.flatten(surface_of(block, faces)).uvs(), hump.uvs);
  EXPECT_EQ(context.flatten(surface_of(wide.middleCols(1, 3), faces)).uvs(), hump.uvs);

  const Eigen::Map<const ByRows<double>> map(hump.mesh.positions[0].data(), hump.positions.rows(),
                                             3);
  EXPECT_EQ(context.flatten(surface_of(map, faces)).uvs(), hump.uvs);
  // What has no memory of its own is kept by the surface.
  const Surface kept = surface_of(2 * (hump.positions / 2), hump.faces + hump.faces - hump.faces);
  EXPECT_EQ(context.flatten(kept).uvs(), hump.uvs);
  const Eigen::Ref<const ByColumns<double>> ref = hump.positions;
  EXPECT_EQ(context.flatten(surface_of(ref, faces)).uvs(), hump.uvs);
}

TEST(CppEigen, RowsAreReadWhereTheyAreAndColumnsAreCopied) {
  const Hump hump;
  const ByRows<float> rows = hump.positions.cast<float>();
  const ByColumns<float> columns = rows;
  EXPECT_EQ(rows_of<3>(rows).view.data()->data(), rows.data());
  EXPECT_EQ(rows_of<3>(rows).copy, nullptr);
  EXPECT_NE(rows_of<3>(columns).copy, nullptr);
  const auto copied = rows_of<3>(columns);
  for (std::size_t i = 0; i < copied.view.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(copied.view[i][k], rows(static_cast<int>(i), static_cast<int>(k)));
    }
  }
  // A map that steps over every other number of a row.
  const std::vector<double> numbers{0, 9, 1, 9, 2, 9, 3, 9, 4, 9, 5, 9};
  const Eigen::Map<const ByRows<double>, 0, Eigen::Stride<6, 2>> stepping(numbers.data(), 2, 3);
  EXPECT_EQ(rows_of<3>(stepping).view[1], (std::array<double, 3>{3, 4, 5}));
}

TEST(CppEigen, NoMatrixIsTakenAsAnArray) {
  static_assert(!std::is_constructible_v<Reals<3>, const Eigen::MatrixXd&>);
  static_assert(!std::is_constructible_v<Reals<3>, const ByRows<double>&>);
  static_assert(!std::is_constructible_v<Indices<3>, const Eigen::MatrixXi&>);
  const Hump hump;
  const ByColumns<double> transposed = hump.positions.transpose();
  const Result<Atlas> result = Context().try_unwrap(surface_of(transposed, hump.faces));
  EXPECT_EQ(result.status(), Status::kInvalidArgument);
  EXPECT_NE(std::string(result.error().what()).find("three columns"), std::string::npos);
}

TEST(CppEigen, UvsComeBackAsMatricesOfEitherOrder) {
  const Hump hump;
  const Flattening flat = Context().flatten(surface_of(hump.positions, hump.faces));
  const auto columns = matrix_of<Eigen::MatrixXd>(flat.uvs());
  const auto rows = matrix_of<ByRows<float>>(flat.uvs<Uv32>());
  ASSERT_EQ(columns.rows(), hump.positions.rows());
  ASSERT_EQ(columns.cols(), 2);
  EXPECT_EQ(columns(5, 1), hump.uvs[5][1]);
  EXPECT_EQ(rows(5, 1), static_cast<float>(hump.uvs[5][1]));
  EXPECT_TRUE(check_injective(rows_of<3>(hump.faces), rows_of<2>(columns)).injective);
  EXPECT_EQ(matrix_of<Eigen::MatrixXi>(flat.triangles()), hump.faces);
}

TEST(CppEigen, AttributesComeFromRows) {
  const Hump hump;
  const Eigen::MatrixXd corner_uvs = Eigen::MatrixXd::Random(hump.faces.rows() * 3, 2);
  const auto rows = rows_of<2>(corner_uvs);
  const Surface surface = surface_of(hump.positions, hump.faces).corner_uvs(rows);
  EXPECT_FALSE(check_atlas(surface).injective());
}

}  // namespace
}  // namespace beltrami::host
