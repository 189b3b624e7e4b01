// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed on surfaces that cut cells, against exact solutions.

#include "small_problems.h"

#include <softcell/discretization/evaluation.h>

#include <cmath>

namespace
{
  using namespace softcell;

  /// Root of the mean square of |u - exact| over the body.
  template <class Function>
  double rms_error(const Solved &solved, const Function &exact)
  {
    const Discretization &cells = solved.simulation->discretization();
    double sum = 0, volume = 0;
    PatchStorage storage;
    std::vector<Point> points;
    for (unsigned int i = 0; i < cells.n_patches(); ++i)
    {
      const Patch patch = cells.patch(i, storage);
      cells.patch_points(i, points);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
      {
        const Direction u =
          interpolate(patch.nodes, patch.shapes->value(q), solved.simulation->displacement());
        sum += patch.weights[q] * (u - exact(points[q])).norm_square();
        volume += patch.weights[q];
      }
    }
    return std::sqrt(dealii::Utilities::MPI::sum(sum, MPI_COMM_WORLD) /
                     dealii::Utilities::MPI::sum(volume, MPI_COMM_WORLD));
  }
} // namespace

/// The octree meets the boundary, so the quadrature is exact, and so is Nitsche's method all
/// around.
TEST(ImmersedSupports, cut_cells_pass_the_patch_test)
{
  for (const std::string model : {"linear", "Neo-Hookean"})
    for (unsigned int degree = 1; degree <= (model == "linear" ? 2 : 1); ++degree)
    {
      SCOPED_TRACE(model + std::to_string(degree));
      // three cells of 1/2 on [-1/4, 5/4]
      Parameters p                = body_of("box", {"finite cell", degree}, 3);
      p.discretization.grid.scale = 1.5;
      p.discretization.cut.levels = 1;
      p.material.model            = model;
      p.regions                   = {{"skin", "1"}};
      p.load_entries      = {{"skin", "displacement 0.1*x+0.2*y, -0.05*x+0.1*z, 0.15*z-0.1*y"}};
      p.loads.imposition  = "Nitsche";
      p.probes            = {{"a", "0.43, 0.51, 0.62"}};
      const Solved solved = solve(p);
      if (is_root())
      {
        const Direction expected({0.043 + 0.102, -0.0215 + 0.062, 0.093 - 0.051});
        EXPECT_LT((vector_in(solved.row, "a_u") - expected).norm(), 1e-10);
      }
    }
}

/// A ball that is imposed u = grad (x^3 - 3 x y^2) / 10 at x, y, z about its centre: harmonic and
/// free of divergence, so in equilibrium. Nitsche's method converges with the cells. The misfit of
/// a penalty of fixed stiffness k, traction / k, does not fall with them.
TEST(ImmersedSupports, nitsche_converges_where_a_penalty_does_not)
{
  const auto error = [](const std::string &imposition, const unsigned int cells) {
    Parameters p                = body_of("sphere", {"finite cell", 1}, cells);
    p.discretization.grid.scale = 1.02;
    p.discretization.cut.levels = 4;
    p.material.model            = "linear";
    p.regions                   = {{"skin", "1"}};
    p.load_entries              = {{"skin", "displacement 0.3*(x*x-y*y), -0.6*x*y, 0"}};
    p.loads.imposition          = imposition;
    p.loads.penalty             = "5000"; // Pa/m
    const Solved solved         = solve(p);
    return rms_error(solved, [](const Point &X) {
      return Direction({0.3 * (X[0] * X[0] - X[1] * X[1]), -0.6 * X[0] * X[1], 0});
    });
  };
  const double nitsche_4 = error("Nitsche", 4), nitsche_8 = error("Nitsche", 8);
  const double penalty_4 = error("penalty", 4), penalty_8 = error("penalty", 8);
  EXPECT_LT(nitsche_8, nitsche_4 / 3); // second order but for the quadrature
  EXPECT_GT(penalty_8, 0.9 * penalty_4);
}
