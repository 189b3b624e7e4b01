// SPDX-License-Identifier: LGPL-2.1-or-later
// Simulations on grids that are refined where the error is large.

#include "small_problems.h"

#include "../box_surface.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/geometry/surface_body.h>
#include <softcell/loads/nitsche.h>

namespace softcell
{
  /// Of a linear displacement the internal forces are those that Nitsche's method holds it by. All
  /// cells are cut, at a quarter of the unrefined ones, which two levels meet exactly.
  TEST(Adaptive, cut_cells_with_hanging_nodes_pass_the_patch_test)
  {
    const auto body = make_box(Point(1, 1, 1));
    GridParameters grid;
    grid.cells                            = {2};
    grid.scale                            = 4. / 3;
    const Refinement refinement           = {{Point(0.1, 0.1, 0.1), Point(0.9, 0.9, 0.1)},
                                             {Point(0.4, 0.4, 0.1)}};
    const std::vector<Material> materials = {Material("linear", 1000, 0.3)};
    const Region skin("skin", "1");
    for (unsigned int degree = 1; degree <= 2; ++degree)
    {
      const Immersed cells("finite cell", degree, grid, CutParameters{2, 0}, *body, MPI_COMM_WORLD,
                           refinement);
      // three are halved, and two that were twice as large as a neighbour; four parts lie outside
      EXPECT_EQ(cells.size().cells, 8u + 5 * 7 - 4);
      Vector u = cells.make_vector(), r = cells.make_vector();
      for (unsigned int node = 0; node < cells.node_positions().size(); ++node)
      {
        const Point &X                = cells.node_positions()[node];
        u.local_element(3 * node)     = 0.1 * X[0] + 0.2 * X[1];
        u.local_element(3 * node + 1) = -0.05 * X[0] + 0.1 * X[2];
        u.local_element(3 * node + 2) = 0.15 * X[2] - 0.1 * X[1];
      }
      Elasticity(cells, materials).add_residual(u, r);
      const double internal = r.linfty_norm();
      Nitsche(cells, cells.surface_patches(skin),
              Expression("0.1*x+0.2*y, -0.05*x+0.1*z, 0.15*z-0.1*y", 3, ""), materials, 10, "skin")
        .add_residual(u, 1, r);
      r.compress(dealii::VectorOperation::add);
      EXPECT_GT(internal, 1);
      // pieces of surface are moved inwards by a billionth of a cell
      EXPECT_LT(r.linfty_norm(), 1e-8 * internal) << degree;
    }
  }

  /// A cube held at a small patch of its base, whose rim makes the stress singular. Under dead
  /// loads the energy W of a linear body rises to that of the solution, W - W_h being half of the
  /// error's square in the energy norm: the larger, the better.
  TEST(Adaptive, needs_fewer_unknowns_where_the_solution_is_singular)
  {
    Parameters p         = body_of("surface", {"weighted cell", 1}, 4);
    p.material.model     = "linear";
    p.regions            = {{"patch", "z < 1e-9 && x < 0.25 && y < 0.25"}, {"top", "z > 1 - 1e-9"}};
    p.load_entries       = {{"patch", "clamp"}, {"top", "traction 3, 0, -1"}};
    const auto solved_on = [&p](const unsigned int cells, const unsigned int steps) {
      p.discretization.grid.cells       = {cells};
      p.discretization.refinement.steps = steps;
      return solve(p, std::make_unique<SurfaceBody>(box_surface(Point(1, 1, 1), 8))).row;
    };
    const ResultsRow uniform = solved_on(16, 0), adaptive = solved_on(4, 6);
    EXPECT_LT(adaptive.number("dofs"), uniform.number("dofs"));
    EXPECT_GT(adaptive.number("strain_energy"), uniform.number("strain_energy"));
    EXPECT_LT(adaptive.number("estimated_error"), solved_on(4, 1).number("estimated_error"));
  }

  /// With what else is known of grids: coarser ones first, cells left out, faces that are
  /// penalized, volumes that are projected.
  TEST(Adaptive, goes_together_with_the_rest)
  {
    const auto bent_ball = [](const unsigned int coarse_grids, const unsigned int steps) {
      Parameters p                                   = body_of("sphere", {"moment fitting", 1}, 4);
      p.discretization.cut                           = {2, 0, 0, 0.01};
      p.discretization.grid.smallest_volume_fraction = 1e-3;
      p.discretization.projection                    = true;
      p.discretization.refinement                    = {steps, 0.3};
      p.material.poisson_ratio                       = 0.499;
      p.procedure.coarse_grids                       = coarse_grids;
      p.regions                                      = {{"base", "z < 0.1"}, {"top", "z > 0.9"}};
      p.load_entries = {{"base", "clamp"}, {"top", "traction 20, 0, 0"}};
      return solve(p);
    };
    const Solved refined = bent_ball(0, 2), from_coarse = bent_ball(1, 2);
    Vector difference = from_coarse.simulation->displacement();
    difference -= refined.simulation->displacement();
    EXPECT_LT(difference.l2_norm(), 1e-8 * refined.simulation->displacement().l2_norm());
    EXPECT_GT(refined.row.number("dofs"), bent_ball(0, 0).row.number("dofs"));
  }

  TEST(Adaptive, halves_no_cell_without_a_load)
  {
    Parameters p                      = body_of("box", {"weighted cell", 1}, 2);
    p.regions                         = {{"base", "z < 1e-9"}};
    p.load_entries                    = {{"base", "clamp"}};
    p.discretization.refinement.steps = 1;
    const ResultsRow row              = solve(p).row;
    EXPECT_EQ(row.number("cells"), 8);
    EXPECT_EQ(row.number("estimated_error"), 0);
  }

  TEST(Adaptive, is_refused_where_it_is_not_available)
  {
    for (const Method &method : {Method{"hexahedra", 1}, Method{"weighted cell", 2}})
    {
      Parameters p                      = body_of("box", method, 2);
      p.regions                         = {{"base", "z < 1e-9"}};
      p.load_entries                    = {{"base", "clamp"}};
      p.discretization.refinement.steps = 1;
      EXPECT_THROW(solve(p), BadInput);
    }
  }
} // namespace softcell
