// SPDX-License-Identifier: LGPL-2.1-or-later
// Nitsche's method.

#include "tangent_check.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/loads/nitsche.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    const Region bottom("bottom", "nz < -0.5"), top("top", "nz > 0.5"), all("all", "1");

    std::unique_ptr<Nitsche> nitsche(const Discretization &body,
                                     const std::vector<Material> &materials,
                                     const Region &region,
                                     const std::string &displacement,
                                     const double factor = 10)
    {
      return std::make_unique<Nitsche>(body, body.surface_patches(region),
                                       Expression(displacement, 3, ""), materials, factor,
                                       region.name());
    }
    /// Adds int P : grad N, the internal force.
    void
    add_internal_force(const BoxOfCells &body, const Material &material, const Vector &u, Vector &r)
    {
      PatchStorage storage;
      for (unsigned int p = 0; p < body.n_patches(); ++p)
      {
        const Patch patch = body.patch(p, storage);
        for (unsigned int q = 0; q < 8; ++q)
        {
          const double *const G = patch.shapes->gradient(q);
          const Gradient H      = interpolate_gradient(patch.nodes, G, u);
          Matrix3<double> F     = identity<double>();
          for (unsigned int a = 0; a < 9; ++a)
            F.entries[a] += H[a / 3][a % 3];
          const Matrix3<double> P =
            material.visit([&](const auto &law) { return law.first_piola_stress(F); });
          for (unsigned int i = 0; i < 8; ++i)
            for (unsigned int a = 0; a < 3; ++a)
              for (unsigned int d = 0; d < 3; ++d)
                r.local_element(3 * patch.nodes[i] + a) +=
                  patch.weights[q] * P(a, d) * G[d * 8 + i];
        }
      }
      r.compress(dealii::VectorOperation::add);
    }

    /// A box whose topmost cells are filled to a fraction only, as weighted cells are.
    class Sliver : public BoxOfCells
    {
    public:
      Sliver(const std::array<unsigned int, 3> &cells, const double filled)
          : BoxOfCells(cells, Point(1, 1, 1)),
            first_(cells[0] * cells[1] * (cells[2] - 1)),
            filled_(filled)
      {
      }
      Patch patch(const unsigned int i, PatchStorage &storage) const override
      {
        const Patch patch = BoxOfCells::patch(i, storage);
        for (double &weight : storage.weights)
          weight *= i < first_ ? 1. : filled_;
        return patch;
      }

    private:
      const unsigned int first_;
      const double filled_;
    };

    /// Smallest eigenvalue of body and support at rest, scaled to ones on the diagonal.
    /// @param displacement that is imposed.
    double smallest_eigenvalue(const BoxOfCells &body,
                               const double factor,
                               const std::string &model        = "linear",
                               const std::string &displacement = "0, 0, 0")
    {
      const std::vector<Material> materials{Material(model, 5000, 0.45)};
      const Material at_rest("linear", 5000, 0.45); // what all laws are there
      const auto support   = nitsche(body, materials, top, displacement, factor);
      const unsigned int n = body.partitioner()->size();
      const Vector nowhere = body.make_vector();
      const BlockMatrix K  = tangent_of(body, *support, nowhere, 1);
      dealii::FullMatrix<double> sum(n, n);
      for (unsigned int j = 0; j < n; ++j)
      {
        Vector u = body.make_vector(), column = body.make_vector();
        u.local_element(j) = 1;
        K.vmult(column, u);
        add_internal_force(body, at_rest, u, column);
        for (unsigned int i = 0; i < n; ++i)
          sum(i, j) = column.local_element(i);
      }
      dealii::LAPACKFullMatrix<double> scaled(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          scaled(i, j) = sum(i, j) / std::sqrt(sum(i, i) * sum(j, j));
      dealii::Vector<double> eigenvalues(n);
      dealii::FullMatrix<double> eigenvectors;
      scaled.compute_eigenvalues_symmetric(-1e3, 1e3, 1e-14, eigenvalues, eigenvectors);
      return eigenvalues[0];
    }
  } // namespace

  TEST(Nitsche, ResidualIsTheDerivativeOfItsPotential)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, bottom, "0.1*y, free, 0.02");
      EXPECT_LT(energy_error(body, *support, some_displacement(body), some_direction(body), 0.8),
                1e-7)
        << model;
    }
  }

  TEST(Nitsche, TangentIsTheDerivativeOfItsResidual)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, all, "0.1*y, free, 0.02");
      EXPECT_LT(tangent_error(body, *support, some_displacement(body), some_direction(body), 0.8),
                1e-7)
        << model;
    }
  }

  TEST(Nitsche, TangentIsSymmetric)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const auto support = nitsche(body, materials, bottom, "0.1*y, free, 0.02");
    const Vector u = some_displacement(body), v = some_direction(body);
    const BlockMatrix K = tangent_of(body, *support, u, 1);
    Vector Ku = body.make_vector(), Kv = body.make_vector();
    K.vmult(Ku, u);
    K.vmult(Kv, v);
    EXPECT_NEAR(v * Ku, u * Kv, 1e-9 * std::abs(v * Ku));
  }

  // On one cell of height h that strains along z alone, v = z - z0, body and support have the
  // energy (lambda + 2 mu) A h (1 - 1 / factor) at their lowest.
  TEST(Nitsche, IsStableFromFactorOneOn)
  {
    const BoxOfCells cell({1, 1, 1}, Point(1, 1, 1));
    EXPECT_LT(smallest_eigenvalue(cell, 0.9), -1e-3);
    EXPECT_GT(smallest_eigenvalue(cell, 1.1), 1e-3);
  }

  // The full cells hang on the slivers alone, whose stiffness is in proportion to their volume.
  TEST(Nitsche, IsStableOnSlivers)
  {
    for (const double filled : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8})
      for (const double factor : {1.5, 10.})
        EXPECT_GT(smallest_eigenvalue(Sliver({2, 2, 2}, filled), factor), 0.01 * filled)
          << "filled to " << filled << ", factor " << factor;
  }

  // As when Newton's method starts: third derivatives of the energy, times a misfit far above the
  // height of the slivers, would outweigh their stiffness.
  TEST(Nitsche, IsStableOnSliversFarFromWhereTheyAreHeld)
  {
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
      for (const double filled : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8})
        for (const std::string displacement : {"0.1, 0.1, 0.1", "-0.1, -0.1, -0.1"})
          EXPECT_GT(smallest_eigenvalue(Sliver({2, 2, 2}, filled), 10, model, displacement),
                    0.01 * filled)
            << model << ", filled to " << filled << ", held at " << displacement;
  }

  // Gradients of degree p - 1 survive the projection, in cells that are cut too. On the face z = 1
  // of u = (z^p, 0, x z^(p-1)) the traction is mu (p + 1) along x and (lambda + 2 mu) (p - 1) x
  // along z.
  TEST(Nitsche, TractionOfAPolynomialIsExact)
  {
    const auto box = make_box(Point(1, 1, 1));
    GridParameters grid;
    grid.cells     = {3};
    grid.scale     = 1.5;
    const double E = 5000, nu = 0.3, mu = E / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
    const std::vector<Material> materials{Material("linear", E, nu)};
    for (unsigned int p = 1; p <= 3; ++p)
      for (const std::string rule : {"finite cell", "weighted cell"})
      {
        if (p == 3 && rule == "weighted cell") // has two planes of points in half a cell
          continue;
        const Immersed body(rule, p, grid, {1, 0}, *box, MPI_COMM_WORLD);
        const std::string exponent = "^" + std::to_string(p);
        const auto support =
          nitsche(body, materials, top, "z" + exponent + ", 0, x*z" + exponent + "/z");
        const Vector u = nodal_values(body, [p](const Point &X) {
          return Direction({std::pow(X[2], p), 0, X[0] * std::pow(X[2], p - 1)});
        });
        const Direction expected({mu * (p + 1), 0, (lambda + 2 * mu) * (p - 1) / 2});
        EXPECT_LT((support->total_force(u, 1) - expected).norm(), 1e-9 * expected.norm())
          << rule << ", degree " << p;
      }
  }

  // The exact solution satisfies the discrete equations: a linear displacement imposed all around.
  TEST(Nitsche, PassesThePatchTest)
  {
    const BoxOfCells body({2, 2, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    for (const std::string model : {"Neo-Hookean", "linear"})
    {
      const std::vector<Material> materials{Material(model, 5000, 0.3)};
      const auto support = nitsche(body, materials, all, "0.1*y, 0.2*z - 0.1*x, 0.3*z");
      const Vector u     = nodal_values(body, [](const Point &X) {
        return Direction({0.1 * X[1], 0.2 * X[2] - 0.1 * X[0], 0.3 * X[2]});
      });
      Vector r           = body.make_vector();
      add_internal_force(body, materials[0], u, r);
      const double scale = r.linfty_norm();
      EXPECT_GT(scale, 10.);
      r += residual_of(body, *support, u, 1);
      EXPECT_LT(r.linfty_norm(), 1e-12 * scale) << model;
    }
  }

  TEST(Nitsche, ReportsAnInvertedSurfaceOnAllRanks)
  {
    const BoxOfCells body({1, 1, 3}, Point(1, 1, 1), MPI_COMM_WORLD);
    const std::vector<Material> materials{Material("Neo-Hookean", 5000, 0.3)};
    const auto support = nitsche(body, materials, bottom, "0, 0, 0");
    const Vector u     = nodal_values(body, [](const Point &X) {
      return Direction({0, 0, X[2] < 0.1 ? 0.5 : 0.});
    });
    Vector r           = body.make_vector();
    EXPECT_THROW(support->add_residual(u, 1, r), InvertedPoint);
  }
} // namespace softcell
