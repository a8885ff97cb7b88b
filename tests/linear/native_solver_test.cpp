// The native solver on matrices of many shapes, against dense and simplicial factors.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "base/types.h"
#include "linear/cholesky/native_solver.h"
#include "linear/mesh_matrix.h"
#include "mesh/disk_mesh.h"
#include "support/disks.h"
#include "support/meshes.h"
#include "support/polls.h"

namespace beltrami {
namespace {

using disks::Random;
using Triplets = std::vector<Eigen::Triplet<double>>;

struct System {
  std::string name;
  SparseMatrix lower;
  std::vector<Place> places = {};
};

/// The lower triangle with the given off-diagonal entries and a diagonal that dominates them.
SparseMatrix dominant(int n, const Triplets& entries, double excess = 0.1) {
  std::vector<double> diagonal(n, excess);
  Triplets all;
  for (const auto& t : entries) {
    if (t.row() == t.col()) continue;
    all.emplace_back(std::max(t.row(), t.col()), std::min(t.row(), t.col()), t.value());
    diagonal[t.row()] += std::abs(t.value());
    diagonal[t.col()] += std::abs(t.value());
  }
  for (int i = 0; i < n; ++i) all.emplace_back(i, i, diagonal[i]);
  SparseMatrix lower(n, n);
  lower.setFromTriplets(all.begin(), all.end());
  lower.makeCompressed();
  return lower;
}

/// The Laplacian of a grid of nx * ny * nz points in a random numbering, and their places.
System grid(int nx, int ny, int nz, Random& random) {
  const int n = nx * ny * nz;
  std::vector<int> number(n);
  std::iota(number.begin(), number.end(), 0);
  for (int i = n; i-- > 1;) std::swap(number[i], number[random.below(i + 1)]);
  System system{"grid " + std::to_string(nx) + "x" + std::to_string(ny) + "x" + std::to_string(nz),
                {},
                std::vector<Place>(n)};
  Triplets entries;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        const auto at = [&](int i, int j, int k) { return number[i + nx * (j + ny * k)]; };
        const int v = at(x, y, z);
        system.places[v] = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        if (x + 1 < nx) entries.emplace_back(v, at(x + 1, y, z), -1.0);
        if (y + 1 < ny) entries.emplace_back(v, at(x, y + 1, z), -1.0);
        if (z + 1 < nz) entries.emplace_back(v, at(x, y, z + 1), -1.0);
      }
    }
  }
  system.lower = dominant(n, entries, 1e-3);
  return system;
}

SparseMatrix random_sparse(Random& random, int n, int entries) {
  Triplets list;
  for (int i = 0; i < entries; ++i) {
    list.emplace_back(random.below(n), random.below(n), random.between(-1, 1));
  }
  return dominant(n, list);
}

/// Every entry of the lower triangle becomes a dense block of two by two.
SparseMatrix in_blocks(const SparseMatrix& lower, Random& random) {
  Triplets entries;
  for (int c = 0; c < lower.cols(); ++c) {
    entries.emplace_back(2 * c, 2 * c + 1, random.between(-1, 1));
    for (SparseMatrix::InnerIterator e(lower, c); e; ++e) {
      if (e.row() == c) continue;
      for (int i = 0; i < 4; ++i) {
        entries.emplace_back(2 * static_cast<int>(e.row()) + i / 2, 2 * c + i % 2,
                             random.between(-1, 1));
      }
    }
  }
  return dominant(2 * static_cast<int>(lower.cols()), entries);
}

std::vector<System> systems() {
  Random random(11);
  std::vector<System> all;
  all.push_back({"empty", SparseMatrix(0, 0)});
  all.push_back({"one", dominant(1, {})});
  all.push_back({"two", dominant(2, {{1, 0, 0.5}})});
  all.push_back({"two apart", dominant(2, {})});
  all.push_back({"diagonal", dominant(500, {})});
  Triplets chain, arrow_first, arrow_last, dense_rows, all_pairs;
  for (int i = 1; i < 700; ++i) chain.emplace_back(i, i - 1, -1.0);
  for (int i = 1; i < 300; ++i) arrow_first.emplace_back(i, 0, 0.3);
  for (int i = 0; i < 299; ++i) arrow_last.emplace_back(299, i, 0.3);
  for (int d = 0; d < 5; ++d) {
    for (int i = 0; i < 400; ++i) dense_rows.emplace_back(37 * d + 11, i, random.between(-1, 1));
  }
  for (int i = 0; i < 170; ++i) {
    for (int j = 0; j < i; ++j) all_pairs.emplace_back(i, j, random.between(-1, 1));
  }
  all.push_back({"tridiagonal", dominant(700, chain)});
  all.push_back({"arrow, head first", dominant(300, arrow_first)});
  all.push_back({"arrow, head last", dominant(300, arrow_last)});
  all.push_back({"dense rows", dominant(400, dense_rows)});
  all.push_back({"dense", dominant(170, all_pairs)});
  for (const int n : {3, 17, 100, 600}) {
    all.push_back({"random " + std::to_string(n), random_sparse(random, n, 3 * n)});
  }
  Triplets apart;  // chains of 50 that do not touch
  for (int i = 1; i < 500; ++i) {
    if (i % 50 != 0) apart.emplace_back(i, i - 1, -1.0);
  }
  all.push_back({"disconnected", dominant(500, apart)});
  all.push_back(grid(40, 37, 1, random));
  all.push_back(grid(11, 9, 10, random));
  all.push_back({"blocks", in_blocks(grid(25, 20, 1, random).lower, random)});
  all.push_back({"blocks of random", in_blocks(random_sparse(random, 60, 100), random)});
  for (const double scale : {1e-12, 1e12}) {
    System system = grid(20, 20, 1, random);
    system.lower *= scale;
    system.name += scale < 1 ? ", tiny" : ", huge";
    all.push_back(std::move(system));
  }
  return all;
}

DenseMatrix random_matrix(Random& random, int rows, int columns) {
  DenseMatrix m(rows, columns);
  for (int c = 0; c < columns; ++c) {
    for (int r = 0; r < rows; ++r) m(r, c) = random.between(-1, 1);
  }
  return m;
}

double residual(const SparseMatrix& lower, const DenseMatrix& x, const DenseMatrix& rhs) {
  return (lower.selfadjointView<Eigen::Lower>() * x - rhs).norm() / rhs.norm();
}

bool same_bits(const DenseMatrix& a, const DenseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         (a.size() == 0 || std::memcmp(a.data(), b.data(),
                                       sizeof(double) * static_cast<std::size_t>(a.size())) == 0);
}

TEST(NativeSolver, SolvesMatricesOfManyShapesInBothPrecisions) {
  Random random(12);
  for (const System& system : systems()) {
    const int n = static_cast<int>(system.lower.cols());
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
      const auto solver = make_native_solver({precision}, 0, Work(1));
      solver->analyze(system.lower, system.places);
      ASSERT_TRUE(solver->factorize(system.lower)) << system.name;
      for (const int columns : {0, 1, 2, 3, 5}) {
        const DenseMatrix rhs = random_matrix(random, n, columns);
        const DenseMatrix x = solver->solve(rhs);
        ASSERT_EQ(x.rows(), n);
        ASSERT_EQ(x.cols(), columns);
        if (rhs.size() == 0) continue;
        EXPECT_LE(residual(system.lower, x, rhs), precision == Precision::kDouble ? 1e-12 : 5e-9)
            << system.name;
      }
    }
  }
}

TEST(NativeSolver, AgreesWithASimplicialFactor) {
  Random random(13);
  for (const System& system : systems()) {
    if (system.lower.cols() == 0) continue;
    const DenseMatrix rhs = random_matrix(random, static_cast<int>(system.lower.cols()), 2);
    const Eigen::SimplicialLLT<SparseMatrix> reference(system.lower);
    const DenseMatrix expected = reference.solve(rhs);
    const auto solver = make_native_solver({}, kLeastSingle, Work(1));
    solver->analyze(system.lower, system.places);
    ASSERT_TRUE(solver->factorize(system.lower));
    EXPECT_LE((solver->solve(rhs) - expected).norm(), 1e-9 * expected.norm()) << system.name;
  }
}

TEST(NativeSolver, GivesTheSameBitsAtAnyNumberOfThreads) {
  Random random(14);
  std::vector<System> list;
  list.push_back(grid(160, 150, 1, random));
  list.push_back(grid(22, 20, 21, random));  // its last fronts are worth several threads each
  list.push_back({"blocks", in_blocks(grid(60, 50, 1, random).lower, random)});
  for (const System& system : list) {
    const int n = static_cast<int>(system.lower.cols());
    const DenseMatrix rhs = random_matrix(random, n, 3);
    SparseMatrix unit(n, 20);
    for (int c = 0; c < 20; ++c) unit.insert(random.below(n), c) = 1;
    unit.makeCompressed();
    std::vector<int> rows(40);
    for (int& r : rows) r = random.below(n);
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
      DenseMatrix x, p, h;
      for (const int threads : {1, 2, 3, 8}) {
        const auto solver = make_native_solver({precision}, 0, Work(threads));
        solver->analyze(system.lower, system.places);
        ASSERT_TRUE(solver->factorize(system.lower));
        const DenseMatrix x_now = solver->solve(rhs), p_now = solver->precondition(rhs),
                          h_now = solver->solve_rows(unit, rows);
        if (threads == 1) {
          x = x_now;
          p = p_now;
          h = h_now;
        }
        EXPECT_TRUE(same_bits(x, x_now)) << system.name << ", " << threads;
        EXPECT_TRUE(same_bits(p, p_now)) << system.name << ", " << threads;
        EXPECT_TRUE(same_bits(h, h_now)) << system.name << ", " << threads;
      }
    }
  }
}

TEST(NativeSolver, GivesSingleRowsOfTheSolution) {
  Random random(15);
  for (const System& system : systems()) {
    const int n = static_cast<int>(system.lower.cols());
    if (n == 0) continue;
    SparseMatrix rhs(n, 35);
    for (int c = 0; c < 35; ++c) {
      if (c % 7 != 3) rhs.coeffRef(random.below(n), c) = random.between(1, 2);  // some are empty
      if (c % 3 == 0) rhs.coeffRef(random.below(n), c) = random.between(-2, -1);
    }
    rhs.makeCompressed();
    std::vector<int> rows;
    for (int i = 0; i < 25; ++i) rows.push_back(random.below(n));  // repeats are allowed
    for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
      const auto solver = make_native_solver({precision}, 0, Work(1));
      solver->analyze(system.lower, system.places);
      ASSERT_TRUE(solver->factorize(system.lower));
      const DenseMatrix all = solver->solve(DenseMatrix(rhs)), some = solver->solve_rows(rhs, rows);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto expected = all.row(rows[i]);
        EXPECT_LE((some.row(static_cast<Eigen::Index>(i)) - expected).norm(), 1e-6 * all.norm())
            << system.name;
      }
      EXPECT_EQ(solver->solve_rows(rhs, {}).rows(), 0);
      // Columns do not see what lies beside them.
      for (const int count : {1, 5, 12}) {
        const SparseMatrix last = rhs.rightCols(count);
        EXPECT_TRUE(same_bits(solver->solve_rows(last, rows), some.rightCols(count)))
            << system.name;
      }
    }
  }
}

TEST(NativeSolver, PreconditionsByAFixedSymmetricDefiniteOperator) {
  Random random(16);
  const System system = grid(30, 31, 1, random);
  const int n = static_cast<int>(system.lower.cols());
  const auto solver = make_native_solver({Precision::kSingle}, 0, Work(1));
  solver->analyze(system.lower, system.places);
  ASSERT_TRUE(solver->factorize(system.lower));
  const DenseMatrix rhs = random_matrix(random, n, 2);
  const DenseMatrix x = solver->precondition(rhs);
  EXPECT_LE(residual(system.lower, x, rhs), 1e-3);
  EXPECT_NEAR(rhs.col(0).dot(x.col(1)) / rhs.col(1).dot(x.col(0)), 1, 1e-3);
  EXPECT_GT(rhs.col(0).dot(x.col(0)), 0);
  EXPECT_TRUE(same_bits(x * 0x1p60, solver->precondition(rhs * 0x1p60)));
  EXPECT_TRUE(same_bits(x * 0x1p-200, solver->precondition(rhs * 0x1p-200)));
  EXPECT_EQ(solver->precondition(DenseMatrix::Zero(n, 1)).norm(), 0);
}

TEST(NativeSolver, ReachesTheResidualWhereSinglePrecisionIsNotEnough) {
  // Weights over twelve decades: the factor in single precision is a poor inverse, or none.
  Random random(17);
  System system = grid(30, 30, 1, random);
  Triplets entries;
  for (int c = 0; c < system.lower.cols(); ++c) {
    for (SparseMatrix::InnerIterator e(system.lower, c); e; ++e) {
      if (e.row() != c) entries.emplace_back(e.row(), c, -std::pow(10, random.between(-6, 6)));
    }
  }
  for (const double excess : {1e-3, 1e-7, 1e-9}) {
    system.lower = dominant(900, entries, excess);
    const auto solver = make_native_solver({Precision::kSingle}, 0, Work(1));
    solver->analyze(system.lower, system.places);
    ASSERT_TRUE(solver->factorize(system.lower));
    const DenseMatrix rhs = random_matrix(random, 900, 2);
    const auto exact = make_native_solver({}, kLeastSingle, Work(1));
    exact->analyze(system.lower, system.places);
    ASSERT_TRUE(exact->factorize(system.lower));
    const double attainable = residual(system.lower, exact->solve(rhs), rhs);
    EXPECT_LE(residual(system.lower, solver->solve(rhs), rhs), std::max(1e-8, 4 * attainable))
        << excess;
  }
}

TEST(NativeSolver, RefusesMatricesThatAreNotDefinite) {
  Random random(18);
  const System system = grid(40, 40, 1, random);
  for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
    for (const double bad :
         {-1.0, 0.0, std::numeric_limits<double>::quiet_NaN(),
          std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}) {
      for (const int at : {0, 700, 1599}) {
        for (const int threads : {1, 2}) {
          SparseMatrix lower = system.lower;
          lower.coeffRef(at, at) = bad;
          const auto solver = make_native_solver({precision}, 0, Work(threads));
          solver->analyze(system.lower, system.places);
          EXPECT_FALSE(solver->factorize(lower)) << bad;
          ASSERT_TRUE(solver->factorize(system.lower));  // and recovers
          const DenseMatrix rhs = random_matrix(random, 1600, 1);
          EXPECT_LE(residual(system.lower, solver->solve(rhs), rhs), 1e-8);
        }
      }
    }
    // Indefinite with a positive diagonal, and not a number off the diagonal.
    for (const double bad : {-100.0, std::numeric_limits<double>::quiet_NaN()}) {
      SparseMatrix lower = system.lower;
      lower.valuePtr()[lower.outerIndexPtr()[500] + 1] = bad;
      const auto solver = make_native_solver({precision}, 0, Work(1));
      solver->analyze(system.lower, system.places);
      EXPECT_FALSE(solver->factorize(lower)) << bad;
    }
  }
}

TEST(NativeSolver, RefusesAMatrixWithoutADiagonalEntry) {
  SparseMatrix lower(3, 3);
  lower.insert(0, 0) = 1;
  lower.insert(2, 1) = 0.1;
  lower.insert(2, 2) = 1;
  lower.makeCompressed();
  for (const Precision precision : {Precision::kDouble, Precision::kSingle}) {
    const auto solver = make_native_solver({precision}, 0, Work(1));
    solver->analyze(lower);
    EXPECT_FALSE(solver->factorize(lower));
  }
}

TEST(NativeSolver, TakesPlacesThatSayNothing) {
  Random random(19);
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Place& place : {Place{0, 0, 0}, Place{infinity, 0, 0}, Place{1e30F, -1e30F, 1e-30F}}) {
    System system = grid(510, 495, 1, random);  // enough for nested dissection
    std::fill(system.places.begin(), system.places.end(), place);
    const auto solver = make_native_solver({Precision::kSingle}, 0, Work(2));
    solver->analyze(system.lower, system.places);
    ASSERT_TRUE(solver->factorize(system.lower));
    const DenseMatrix rhs = random_matrix(random, static_cast<int>(system.lower.cols()), 1);
    EXPECT_LE(residual(system.lower, solver->solve(rhs), rhs), 5e-9);
  }
}

TEST(NativeSolver, CanBeCancelledWhileAnalyzingAndFactorizing) {
  Random random(20);
  const System system = grid(520, 490, 1, random);  // enough for nested dissection
  const auto run = [&] {
    const auto solver = make_native_solver({}, 0, Work(1));
    solver->analyze(system.lower, system.places);
    EXPECT_TRUE(solver->factorize(system.lower));
  };
  const std::int64_t all = count_polls(run);
  EXPECT_GE(all, 6);
  for (const std::int64_t last : {std::int64_t{1}, std::int64_t{4}, all / 2, all}) {
    EXPECT_THROW(count_polls(run, last), Cancelled) << last;
  }
}

TEST(NativeSolver, SolvesTheLaplaciansOfMeshes) {
  Random random(21);
  for (const auto& list : {meshes::grid(60, 45), meshes::fan(50), meshes::cap(20, 60, 1.0)}) {
    const DiskMesh mesh = disks::disk(list);
    for (const int size : {1, 2}) {
      MeshMatrix matrix(mesh.vertex_count(), mesh.faces, mesh.on_boundary, size, Work(1));
      if (matrix.free_count() == 0) continue;
      for (Index f = 0; f < mesh.face_count(); ++f) {
        for (int i = 0; i < 3; ++i) {
          const auto same = [](int r, int c) { return r == c ? 3.0 : 0.5; };
          const auto other = [](int r, int c) { return r == c ? -0.7 : 0.1; };
          matrix.add(f, mesh.faces[f], i, i, same);
          matrix.add(f, mesh.faces[f], i, next_corner(i), other);
        }
      }
      const auto solver = make_native_solver({}, kLeastSingle, Work(1));
      solver->analyze(matrix.matrix(), matrix.places(mesh.positions));
      ASSERT_TRUE(solver->factorize(matrix.matrix()));
      const DenseMatrix rhs = random_matrix(random, size * matrix.free_count(), 2);
      EXPECT_LE(residual(matrix.matrix(), solver->solve(rhs), rhs), 1e-12);
    }
  }
}

TEST(NativeSolver, PreconditionsNearlyAsBeforeWithItsFactorAlone) {
  Random random(22);
  const SparseMatrix lower = in_blocks(grid(60, 50, 1, random).lower, random);
  const int n = static_cast<int>(lower.cols());
  const DenseMatrix rhs = random_matrix(random, n, 2);
  for (const int least_single : {0, 2 * n}) {
    std::optional<DenseMatrix> alone;
    for (const int threads : {1, 3}) {
      const auto solver = make_native_solver({Precision::kSingle}, least_single, Work(threads));
      for (int time = 0; time < 2; ++time) {  // it can be given a matrix again
        solver->analyze(lower);
        ASSERT_TRUE(solver->factorize(lower));
        const DenseMatrix before = solver->precondition(rhs);
        solver->keep_preconditioner();
        const DenseMatrix after = solver->precondition(rhs);
        EXPECT_LE((after - before).norm(), 1e-3 * before.norm());
        EXPECT_TRUE(same_bits(after, alone.value_or(after)));
        alone = after;
        solver->keep_preconditioner();
        EXPECT_TRUE(same_bits(solver->precondition(rhs), after));
      }
    }
    const double across = rhs.col(0).dot(alone->col(1)), back = rhs.col(1).dot(alone->col(0));
    EXPECT_NEAR(across, back, 1e-5 * rhs.col(0).norm() * alone->col(1).norm());
    EXPECT_GT(rhs.col(0).dot(alone->col(0)), 0);
  }
}

TEST(CompactFactor, TakesNextToNothingForNothing) {
  // Whole numbers would be of a unit that has no inverse in single precision.
  constexpr int kRows = 50;
  for (const double beside : {-1e-30, -1e-36, -1e-42}) {
    Triplets entries;
    for (int i = 0; i < kRows; ++i) {
      entries.emplace_back(i, i, 1);
      if (i + 1 < kRows) entries.emplace_back(i + 1, i, beside);
    }
    SparseMatrix lower(kRows, kRows);
    lower.setFromTriplets(entries.begin(), entries.end());
    const auto solver = make_native_solver({Precision::kSingle}, 0, Work(1));
    solver->analyze(lower);
    ASSERT_TRUE(solver->factorize(lower));
    solver->keep_preconditioner();
    const DenseMatrix ones = DenseMatrix::Ones(kRows, 1);
    EXPECT_LE((solver->precondition(ones) - ones).norm(), 1e-6);
  }
}

TEST(CompactFactor, IsDefiniteAndNearWhereTheMatrixIsNearlySingular) {
  // Of a Laplacian with next to nothing on the diagonal: what is constant costs 1e-6.
  Random random(23);
  const System system = grid(80, 80, 1, random);
  Triplets entries;
  for (int c = 0; c < system.lower.cols(); ++c) {
    for (SparseMatrix::InnerIterator e(system.lower, c); e; ++e) {
      if (e.row() != c) entries.emplace_back(e.row(), c, e.value());
    }
  }
  const SparseMatrix lower = dominant(6400, entries, 1e-6);
  const auto solver = make_native_solver({Precision::kSingle}, 0, Work(1));
  solver->analyze(lower, system.places);
  ASSERT_TRUE(solver->factorize(lower));
  solver->keep_preconditioner();
  const DenseMatrix ones = DenseMatrix::Ones(6400, 1);
  const DenseMatrix solution = solver->precondition(ones);
  const double cost = ones.col(0).dot(solution.col(0)) / 6400;  // the inverse of the excess
  EXPECT_NEAR(cost, 1e6, 2e5);
  for (int i = 0; i < 20; ++i) {
    const DenseMatrix rhs = random_matrix(random, 6400, 1);
    EXPECT_GT(rhs.col(0).dot(solver->precondition(rhs).col(0)), 0);
  }
}

}  // namespace
}  // namespace beltrami
