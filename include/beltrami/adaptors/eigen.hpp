// Matrices of Eigen as meshes: positions V, n x 3, and triangles F, m x 3; and results as matrices.
//
//   context.unwrap(beltrami::surface_of(V, F));
//   Eigen::MatrixXd uvs = beltrami::matrix_of<Eigen::MatrixXd>(atlas.corner_uvs());
//
// A matrix that is stored by rows is read where it is. One that is stored by columns, as Eigen's
// are unless they say otherwise, is copied row by row.
#ifndef BELTRAMI_ADAPTORS_EIGEN_HPP
#define BELTRAMI_ADAPTORS_EIGEN_HPP

#include <beltrami/beltrami.hpp>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

BELTRAMI_CPP_BEGIN

/// The rows of a matrix with N columns: a view, and the copy that it shows where one is needed.
template <class Scalar, std::size_t N>
struct Rows {
  Span<const std::array<Scalar, N>> view;
  std::shared_ptr<const void> copy;
};

/// So that Reals and Indices take Rows, which must outlive the calls that read them.
template <class Scalar, std::size_t N>
Span<const std::array<Scalar, N>> span_of(const Rows<Scalar, N>& rows) {
  return rows.view;
}

/// The rows of a matrix, map, block or expression with N columns, which must be as many. What is
/// stored by rows and has a name is not copied: it must outlive the calls that read it.
template <std::size_t N, class Matrix>
auto rows_of(Matrix&& matrix) {
  using Plain = std::decay_t<Matrix>;
  using Scalar = typename Plain::Scalar;
  using Row = std::array<Scalar, N>;
  constexpr bool kByRows = std::is_lvalue_reference_v<Matrix> && Plain::IsRowMajor != 0 &&
                           (Plain::Flags & Eigen::DirectAccessBit) != 0;
  eigen_assert(matrix.cols() == static_cast<Eigen::Index>(N));
  Rows<Scalar, N> rows;
  if (matrix.cols() != static_cast<Eigen::Index>(N)) return rows;
  const auto count = static_cast<std::size_t>(matrix.rows());
  if constexpr (kByRows) {
    // Strides of maps are what the program says when it runs; negative ones are copied.
    if (matrix.innerStride() == 1 && matrix.outerStride() > 0) {
      rows.view = {reinterpret_cast<const Row*>(matrix.data()), count,
                   static_cast<std::size_t>(matrix.outerStride()) * sizeof(Scalar)};
      return rows;
    }
  }
  const auto& values = matrix.derived().eval();
  auto copy = std::make_shared<std::vector<Row>>(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < N; ++k) {
      (*copy)[i][k] = values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
  rows.view = span_of(static_cast<const std::vector<Row>&>(*copy));
  rows.copy = copy;
  return rows;
}

/// Triangles F, m x 3 integers of 32 or 64 bits, on positions V, n x 3 floats or doubles. With
/// another number of columns the call that is given it ends with INVALID_ARGUMENT.
template <
    class Positions, class Triangles,
    class = std::enable_if_t<
        std::is_base_of_v<Eigen::EigenBase<std::decay_t<Positions>>, std::decay_t<Positions>> &&
        std::is_base_of_v<Eigen::EigenBase<std::decay_t<Triangles>>, std::decay_t<Triangles>>>>
Surface surface_of(Positions&& positions, Triangles&& triangles) {
  if (positions.cols() != 3 || triangles.cols() != 3) {
    Surface none{Reals<3>(), Indices<3>()};
    none.note("the matrices of positions and of triangles are to have three columns");
    return none;
  }
  const auto places = rows_of<3>(std::forward<Positions>(positions));
  const auto faces = rows_of<3>(std::forward<Triangles>(triangles));
  Surface surface(places, faces);
  surface.keep(places.copy).keep(faces.copy);
  return surface;
}

/// Items as the rows of a matrix of any order and scalar: UVs n x 2, seams or triangles as they
/// are.
template <class Matrix, class T, std::size_t N>
Matrix matrix_of(const std::vector<std::array<T, N>>& items) {
  Matrix matrix(static_cast<Eigen::Index>(items.size()), static_cast<Eigen::Index>(N));
  for (std::size_t i = 0; i < items.size(); ++i) {
    for (std::size_t k = 0; k < N; ++k) {
      matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) =
          static_cast<typename Matrix::Scalar>(items[i][k]);
    }
  }
  return matrix;
}

BELTRAMI_CPP_END

#endif  // BELTRAMI_ADAPTORS_EIGEN_HPP
