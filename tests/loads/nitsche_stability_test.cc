// SPDX-License-Identifier: LGPL-2.1-or-later
// Nitsche's method on cells that are hardly filled: the tangent of body and support.

#include "nitsche_on_a_box.h"
#include "tangent_check.h"

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
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
      const Region held("top", "nz > 0.5");
      const auto support   = nitsche(body, materials, held, displacement, factor);
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

  // On one cell of height h that strains along z alone, v = z - z0, body and support have the
  // energy (lambda + 2 mu) A h (1 - 1 / factor) at their lowest.
  TEST(NitscheOnSlivers, IsStableFromFactorOneOn)
  {
    const BoxOfCells cell({1, 1, 1}, Point(1, 1, 1));
    EXPECT_LT(smallest_eigenvalue(cell, 0.9), -1e-3);
    EXPECT_GT(smallest_eigenvalue(cell, 1.1), 1e-3);
  }

  // The full cells hang on the slivers alone, whose stiffness is in proportion to their volume.
  TEST(NitscheOnSlivers, IsStable)
  {
    for (const double filled : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8})
      for (const double factor : {1.5, 10.})
        EXPECT_GT(smallest_eigenvalue(Sliver({2, 2, 2}, filled), factor), 0.01 * filled)
          << "filled to " << filled << ", factor " << factor;
  }

  // As when Newton's method starts: third derivatives of the energy, times a misfit far above the
  // height of the slivers, would outweigh their stiffness.
  TEST(NitscheOnSlivers, IsStableFarFromWhereTheyAreHeld)
  {
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
      for (const double filled : {1e-1, 1e-2, 1e-4, 1e-6, 1e-8})
        for (const std::string displacement : {"0.1, 0.1, 0.1", "-0.1, -0.1, -0.1"})
          EXPECT_GT(smallest_eigenvalue(Sliver({2, 2, 2}, filled), 10, model, displacement),
                    0.01 * filled)
            << model << ", filled to " << filled << ", held at " << displacement;
  }

  // The whole tangent is taken up to a misfit of mu / (4 (lambda + 2 mu) C), where C is 20. Ten
  // times as large, it would be indefinite.
  TEST(NitscheOnSlivers, IsStableAndExactNearWhereTheyAreHeld)
  {
    const Sliver body({2, 2, 2}, 0.1);
    const double largest = (1 - 2 * 0.45) / (2 * (1 - 0.45)) / (4 * 20);
    const Vector nowhere = body.make_vector();
    const Vector stretch = nodal_values(body, [](const Point &X) {
      return (1 - X[2]) * Direction({0.5, 0.3, 1}); // vanishes where the body is held
    });
    for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
      for (const double ratio : {-10., -1.1, -0.9, 0.9, 1.1, 10.})
      {
        const std::vector<Material> materials{Material(model, 5000, 0.45)};
        const std::string imposed = "0, 0, " + std::to_string(ratio * largest);
        EXPECT_GT(smallest_eigenvalue(body, 10, model, imposed), 0.01 * 0.1) << model << imposed;
        const auto support = nitsche(body, materials, Region("top", "nz > 0.5"), imposed);
        const double error = tangent_error(body, *support, nowhere, stretch, 1);
        if (std::abs(ratio) < 1)
          EXPECT_LT(error, 1e-7) << model << imposed;
        else
          EXPECT_GT(error, 1e-4) << model << imposed;
      }
  }
} // namespace softcell
