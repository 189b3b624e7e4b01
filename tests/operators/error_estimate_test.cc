// SPDX-License-Identifier: LGPL-2.1-or-later
// The estimated error against true ones.

#include "../box_of_cells.h"
#include "lattice.h"

#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/operators/error_estimate.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace softcell
{
  namespace
  {
    const std::vector<Material> linear = {Material("linear", 2.6, 0.3)};

    Direction displacement(const Point &X)
    {
      return Direction({std::sin(2 * X[0] + X[1]), std::cos(1.5 * X[1] - X[2]) + X[0] * X[1] * X[2],
                        std::exp(X[0] / 2) * std::sin(2 * X[2])});
    }

    dealii::Tensor<2, 3> gradient(const Point &X)
    {
      const auto [x, y, z] = std::array{X[0], X[1], X[2]};
      dealii::Tensor<2, 3> H;
      H[0][0] = 2 * std::cos(2 * x + y);
      H[0][1] = std::cos(2 * x + y);
      H[1][0] = y * z;
      H[1][1] = -1.5 * std::sin(1.5 * y - z) + x * z;
      H[1][2] = std::sin(1.5 * y - z) + x * y;
      H[2][0] = std::exp(x / 2) * std::sin(2 * z) / 2;
      H[2][2] = 2 * std::exp(x / 2) * std::cos(2 * z);
      return H;
    }

    double sum(const double value)
    {
      return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
    }

    /// Estimated by true error of the displacement's interpolant, whose gradient errs as that of
    /// the finite element solution up to what is of higher order. The true one is the integral of
    /// 2 mu e : e + lambda tr(e)^2 for the error e of the strain.
    double effectivity(const Discretization &discretization)
    {
      constexpr double mu = 1, lambda = 1.5; // of this Young modulus and Poisson ratio
      const Vector u                  = nodal_values(discretization, displacement);
      const std::vector<double> found = squared_errors(discretization, linear, false, u);
      double error                    = 0;
      PatchStorage storage;
      std::vector<Point> points;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
      {
        const Patch patch = discretization.patch(i, storage);
        discretization.patch_points(i, points);
        for (unsigned int q = 0; q < patch.n_points(); ++q)
        {
          auto H = -1. * gradient(points[q]);
          for (unsigned int k = 0; k < patch.n_nodes(); ++k)
            for (unsigned int c = 0; c < 3; ++c)
              for (unsigned int d = 0; d < 3; ++d)
                H[c][d] += u.local_element(3 * patch.nodes[k] + c) *
                           patch.shapes->gradient(q)[d * patch.n_nodes() + k];
          const auto e = 0.5 * (H + transpose(H));
          error += patch.weights[q] * (2 * mu * e.norm_square() + lambda * trace(e) * trace(e));
        }
      }
      return std::sqrt(sum(std::accumulate(found.begin(), found.end(), 0.)) / sum(error));
    }

    std::unique_ptr<Immersed>
    immersed(const Body &body, const std::string &rule, const unsigned int cells)
    {
      GridParameters grid;
      grid.cells = {cells};
      return std::make_unique<Immersed>(rule, 1, grid, CutParameters{3, 0}, body, MPI_COMM_WORLD);
    }
  } // namespace

  /// Averages of the stress are asymptotically exact on uniform grids (Zienkiewicz and Zhu 1992;
  /// Ainsworth and Oden 2000, chapter 4), but for the averages on the boundary, which have cells
  /// on one side only: the estimate errs there by a part of the error itself, and the cells
  /// concerned have a volume of O(h).
  TEST(ErrorEstimate, IsAsymptoticallyExactOnABox)
  {
    const auto body     = make_box(Point(1, 1, 1));
    const double coarse = effectivity(*immersed(*body, "weighted cell", 4)),
                 fine   = effectivity(*immersed(*body, "weighted cell", 8));
    EXPECT_NEAR(coarse, 1, 0.1);
    EXPECT_LT(std::abs(fine - 1), 0.6 * std::abs(coarse - 1));
  }

  TEST(ErrorEstimate, IsNearlySoOnCutCells)
  {
    const auto body = make_sphere(0.5);
    for (const std::string rule : {"finite cell", "weighted cell"})
    {
      const double coarse = effectivity(*immersed(*body, rule, 5)),
                   fine   = effectivity(*immersed(*body, rule, 10));
      EXPECT_NEAR(coarse, 1, 0.2) << rule;
      EXPECT_LT(std::abs(fine - 1), 0.7 * std::abs(coarse - 1)) << rule;
    }
  }

  TEST(ErrorEstimate, FindsNoErrorWhereStressIsUniform)
  {
    UnitCells lattice({{3, 2, 2}}, 2);
    for (unsigned int i = 0; i < lattice.cells.size(); ++i)
      if (i % 3 == 2)
        lattice.cells[i].labels = {1}; // stress jumps where materials meet
    const Vector u = nodal_values(lattice, [](const Point &X) {
      return Direction({0.1 * X[0] + 0.2 * X[1], 0., 0.05 * X[0] - 0.1 * X[2]});
    });
    for (const std::string model : {"linear", "Neo-Hookean", "Saint-Venant-Kirchhoff"})
      for (const double error : squared_errors(
             lattice, {Material(model, 1000, 0.3), Material(model, 5000, 0.4)}, false, u))
        EXPECT_LT(error, 1e-24 * 1000);
  }

  /// The interpolant of (xy, -y^2/2, 0), whose change of volume is y less its mean in a cell. There
  /// is no pressure but for its projection, and then a larger lambda leaves less energy to the
  /// stress.
  TEST(ErrorEstimate, SeesTheProjectedPressure)
  {
    const UnitCells lattice({{2, 3, 2}}, 2);
    const Vector u      = nodal_values(lattice, [](const Point &X) {
      return Direction({X[0] * X[1], -X[1] * X[1] / 2, 0.});
    });
    const auto estimate = [&](const double nu, const bool has_projection) {
      const std::vector<double> errors =
        squared_errors(lattice, {Material("linear", 2 * (1 + nu), nu)}, has_projection, u);
      return std::accumulate(errors.begin(), errors.end(), 0.);
    };
    EXPECT_LT(estimate(0.4999, true), estimate(0, true));
    EXPECT_GT(estimate(0.4999, false), 100 * estimate(0, false));
  }

  TEST(ErrorEstimate, TakesTheFewestCellsThatHoldTheFraction)
  {
    using List                     = std::vector<unsigned int>;
    const std::vector<double> some = {1, 4, 2, 3};
    EXPECT_EQ(largest_errors(some, 0.3, MPI_COMM_SELF), List({1}));
    EXPECT_EQ(largest_errors(some, 0.5, MPI_COMM_SELF), List({1, 3}));
    EXPECT_EQ(largest_errors(some, 1, MPI_COMM_SELF), List({0, 1, 2, 3}));
    EXPECT_EQ(largest_errors({1, 0, 0}, 1, MPI_COMM_SELF), List({0, 1, 2}));
    EXPECT_EQ(largest_errors({0, 0, 0}, 0.5, MPI_COMM_SELF), List()); // nothing to gain
    // alike to round-off
    EXPECT_EQ(largest_errors({2, 1, 2 + 1e-15, 2 - 1e-15}, 0.2, MPI_COMM_SELF), List({0, 2, 3}));
    // each rank has its own; the last holds three quarters at least
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                       last = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;
    EXPECT_EQ(largest_errors({std::pow(4., rank)}, 0.6, MPI_COMM_WORLD),
              rank == last ? List({0}) : List());
  }
} // namespace softcell
