// The solver against dense algebra, and the face-wise assembly against plain sums.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "base/types.h"
#include "linear/mesh_matrix.h"
#include "linear/shifted_factor.h"
#include "linear/spd_solver.h"
#include "mesh/disk_mesh.h"
#include "mesh/face_chunks.h"
#include "support/disks.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using disks::Random;

/// Sparse, symmetric, diagonally dominant.
DenseMatrix random_spd(Random& random, int n) {
  DenseMatrix a = DenseMatrix::Zero(n, n);
  for (int i = 0; i < 4 * n; ++i) {
    const int r = random.below(n), c = random.below(n);
    if (r != c) a(r, c) = a(c, r) = random.between(-1, 1);
  }
  for (int i = 0; i < n; ++i) a(i, i) = 0.1 + a.row(i).cwiseAbs().sum();
  return a;
}

SparseMatrix lower_of(const DenseMatrix& a) {
  SparseMatrix lower = DenseMatrix(a.triangularView<Eigen::Lower>()).sparseView();
  lower.makeCompressed();
  return lower;
}

DenseMatrix random_matrix(Random& random, int rows, int columns) {
  DenseMatrix m(rows, columns);
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) m(r, c) = random.between(-1, 1);
  }
  return m;
}

TEST(SpdSolver, AgreesWithADenseFactorForSeveralRightHandSides) {
  Random random(1);
  for (const int n : {1, 2, 10, 80}) {
    const DenseMatrix a = random_spd(random, n), rhs = random_matrix(random, n, 3);
    const auto solver = make_spd_solver({}, Work(1));
    const SparseMatrix lower = lower_of(a);
    solver->analyze(lower);
    ASSERT_TRUE(solver->factorize(lower));
    const DenseMatrix expected = a.llt().solve(rhs);
    EXPECT_LE((solver->solve(rhs) - expected).norm(), 1e-10 * expected.norm()) << n;
  }
}

TEST(SpdSolver, FactorizesNewValuesOfThePatternItAnalyzed) {
  Random random(2);
  const DenseMatrix a = random_spd(random, 40), rhs = random_matrix(random, 40, 1);
  const auto solver = make_spd_solver({}, Work(1));
  solver->analyze(lower_of(a));
  for (const double factor : {1.0, 3.0, 0.25}) {
    ASSERT_TRUE(solver->factorize(lower_of(factor * a)));
    EXPECT_LE((factor * a * solver->solve(rhs) - rhs).norm(), 1e-10 * rhs.norm());
  }
}

TEST(SpdSolver, RefusesAnIndefiniteMatrixAndRecovers) {
  Random random(3);
  const DenseMatrix good = random_spd(random, 20), rhs = random_matrix(random, 20, 1);
  DenseMatrix bad = good;
  bad(7, 7) = -bad(7, 7);
  const auto solver = make_spd_solver({}, Work(1));
  solver->analyze(lower_of(good));
  EXPECT_FALSE(solver->factorize(lower_of(bad)));
  ASSERT_TRUE(solver->factorize(lower_of(good)));
  EXPECT_LE((good * solver->solve(rhs) - rhs).norm(), 1e-10 * rhs.norm());
}

TEST(SpdSolver, RefusesAMatrixOfZeros) {
  SparseMatrix lower = lower_of(DenseMatrix::Identity(3, 3));
  const auto solver = make_spd_solver({}, Work(1));
  solver->analyze(lower);
  for (int i = 0; i < 3; ++i) lower.valuePtr()[i] = 0;
  EXPECT_FALSE(solver->factorize(lower));
}

TEST(FactorizeShifted, ShiftsWhatRoundingMadeIndefiniteAndNothingElse) {
  Random random(7);
  DenseMatrix a = random_spd(random, 30);
  SparseMatrix lower = lower_of(a);
  const auto solver = make_spd_solver({}, Work(1));
  solver->analyze(lower);
  EXPECT_EQ(factorize_shifted(*solver, lower), 0);

  // Singular, and negative by a rounding error.
  DenseMatrix path = DenseMatrix::Zero(20, 20);
  for (int i = 0; i + 1 < 20; ++i) {
    path(i, i) += 1;
    path(i + 1, i + 1) += 1;
    path(i, i + 1) = path(i + 1, i) = -1;
  }
  path(19, 19) -= 1e-12;
  lower = lower_of(path);
  const SparseMatrix before = lower;
  solver->analyze(lower);
  const double shift = factorize_shifted(*solver, lower);
  EXPECT_GT(shift, 0);
  EXPECT_LT(shift, 1e-8);
  EXPECT_EQ(DenseMatrix(lower), DenseMatrix(before));

  lower = lower_of(-path);
  solver->analyze(lower);
  EXPECT_LT(factorize_shifted(*solver, lower), 0);
  lower.valuePtr()[0] = std::nan("");
  EXPECT_LT(factorize_shifted(*solver, lower), 0);
}

TEST(SpdSolver, AnalyzesAnotherPatternAfterTheFirst) {
  Random random(4);
  const auto solver = make_spd_solver({}, Work(1));
  for (const int n : {30, 12, 50}) {
    const DenseMatrix a = random_spd(random, n), rhs = random_matrix(random, n, 2);
    solver->analyze(lower_of(a));
    ASSERT_TRUE(solver->factorize(lower_of(a)));
    EXPECT_LE((a * solver->solve(rhs) - rhs).norm(), 1e-10 * rhs.norm());
  }
}

TEST(SpdSolver, NamesItsBackEnd) {
  const std::string name = spd_solver_name();
  EXPECT_TRUE(name == "native" || name == "eigen" || name == "cholmod" ||
              name == "cholmod-simplicial")
      << name;
}

/// Adds random blocks to a MeshMatrix and to a dense matrix, which must agree.
void expect_sum_of_blocks(const DiskMesh& mesh, const std::vector<bool>& fixed, int size,
                          Random& random) {
  MeshMatrix assembled(mesh.vertex_count(), mesh.faces, fixed, size, Work(1));
  const int n = size * assembled.free_count();
  for (int pass = 0; pass < 2; ++pass) {  // the second starts from zero again
    DenseMatrix expected = DenseMatrix::Zero(n, n);
    assembled.set_zero(Work(1));
    for (Index f = 0; f < mesh.face_count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) {
          DenseMatrix block = random_matrix(random, size, size);
          if (i == j) block = (block + block.transpose()).eval();
          // Either order of two different corners names the same pair.
          const bool turned = i != j && random.below(2) == 1;
          const int a = turned ? j : i, b = turned ? i : j;
          assembled.add(f, mesh.faces[f], a, b, block);
          const Index ra = assembled.row(mesh.faces[f][a]), rb = assembled.row(mesh.faces[f][b]);
          if (ra == kNone || rb == kNone) continue;
          expected.block(size * ra, size * rb, size, size) += block;
          if (a != b) expected.block(size * rb, size * ra, size, size) += block.transpose();
        }
      }
    }
    const DenseMatrix lower = DenseMatrix(expected.triangularView<Eigen::Lower>());
    EXPECT_LE((DenseMatrix(assembled.matrix()) - lower).norm(), 1e-13 * (1 + lower.norm()));
  }
}

TEST(MeshMatrix, IsTheSumOfItsBlocksWithRandomVerticesFixed) {
  Random random(5);
  for (const auto& list : {meshes::grid(5, 4), meshes::fan(7), meshes::cap(3, 8, 1.0)}) {
    const DiskMesh mesh = disks::disk(list);
    for (const int size : {1, 2}) {
      for (const int share : {0, 3, 8, 10}) {  // tenths that are fixed
        std::vector<bool> fixed(mesh.positions.size());
        for (std::size_t v = 0; v < fixed.size(); ++v) fixed[v] = random.below(10) < share;
        expect_sum_of_blocks(mesh, fixed, size, random);
      }
    }
  }
}

TEST(MeshMatrix, AddsUpManyChunksToTheSameBitsAtAnyNumberOfThreads) {
  const DiskMesh mesh = disks::disk(meshes::grid(120, 110));
  ASSERT_GT(mesh.face_count(), 3 * FaceChunks::grain_of(mesh.face_count()));
  for (const int size : {1, 2}) {
    const auto block = [](Index f, int i, int j) {
      return [=](int r, int c) { return std::sin(1.0 + f + 7 * i * j + 3 * (r + c)); };
    };
    MeshMatrix one_by_one(mesh.vertex_count(), mesh.faces, mesh.on_boundary, size, Work(1));
    for (Index f = 0; f < mesh.face_count(); ++f) {
      for (int i = 0; i < 3; ++i) {
        for (int j = i; j < 3; ++j) one_by_one.add(f, mesh.faces[f], i, j, block(f, i, j));
      }
    }
    SparseMatrix first;
    for (const int threads : {1, 2, 5}) {
      MeshMatrix assembled(mesh.vertex_count(), mesh.faces, mesh.on_boundary, size, Work(threads));
      assembled.add_up(Work(threads), mesh.faces, [&](Index f, const auto& add) {
        for (int i = 0; i < 3; ++i) {
          for (int j = i; j < 3; ++j) add(i, j, block(f, i, j));
        }
      });
      if (threads == 1) first = assembled.matrix();
      EXPECT_EQ((assembled.matrix() - first).norm(), 0) << threads;
      EXPECT_LE((assembled.matrix() - one_by_one.matrix()).norm(), 1e-12 * first.norm());
    }
  }
}

TEST(MeshMatrix, StoresSortedColumnsOfTheLowerTriangleThatStartOnTheDiagonal) {
  const DiskMesh mesh = disks::disk(meshes::grid(4, 4));
  const MeshMatrix assembled(mesh.vertex_count(), mesh.faces,
                             std::vector<bool>(mesh.positions.size(), false), 2, Work(1));
  const SparseMatrix& matrix = assembled.matrix();
  ASSERT_EQ(matrix.cols(), 2 * mesh.vertex_count());
  for (int c = 0; c < matrix.cols(); ++c) {
    const int begin = matrix.outerIndexPtr()[c], end = matrix.outerIndexPtr()[c + 1];
    ASSERT_LT(begin, end);
    EXPECT_EQ(matrix.innerIndexPtr()[begin], c);
    for (int i = begin + 1; i < end; ++i) {
      EXPECT_LT(matrix.innerIndexPtr()[i - 1], matrix.innerIndexPtr()[i]);
    }
  }
}

TEST(MeshMatrix, IsEmptyWhereAllVerticesAreFixed) {
  const DiskMesh mesh = disks::disk(meshes::quad());
  const MeshMatrix assembled(4, mesh.faces, {true, true, true, true}, 2, Work(1));
  EXPECT_EQ(assembled.free_count(), 0);
  EXPECT_EQ(assembled.matrix().nonZeros(), 0);
}

}  // namespace
}  // namespace beltrami
