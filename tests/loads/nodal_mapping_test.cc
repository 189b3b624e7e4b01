// SPDX-License-Identifier: LGPL-2.1-or-later
// Brunet's mapping of surface nodes to cells.

#include "../box_of_cells.h"
#include "../box_surface.h"

#include <softcell/base/exceptions.h>
#include <softcell/loads/dead_loads.h>
#include <softcell/loads/nodal_mapping.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    /// Has shapes at all points on all ranks: below y = 1/2 the first rank's cells are nearest,
    /// else all are equally near, those of the last rank with the highest precedence.
    class ClaimsOfRanks : public BoxOfCells
    {
    public:
      using BoxOfCells::BoxOfCells;
      std::optional<PointShapes> shapes_at(const Point &X, const double) const override
      {
        const int rank = dealii::Utilities::MPI::this_mpi_process(communicator());
        auto shapes    = BoxOfCells::shapes_at(X, 1);
        shapes->claim  = {X[1] < 0.5 && rank == 0 ? 0.05 : 0.1, double(rank)};
        return shapes;
      }
    };
  } // namespace

  // The mapping keeps the resultant and the moment of the nodal forces T^s, since the shapes sum to
  // 1 and reproduce X. With T^s of a uniform traction these are those of the traction itself.
  TEST(NodalMapping, KeepsResultantAndMoment)
  {
    const Surface surface = box_surface(Point(1, 1, 1), 3);
    const BoxOfCells grid({2, 2, 5}, Point(1, 1, 1), MPI_COMM_WORLD, false);
    const Region side("side", "nx > 0.5");
    const auto patches = nodal_surface_patches(grid, surface, side, 0.1);
    EXPECT_EQ(dealii::Utilities::MPI::sum(unsigned(patches.size()), MPI_COMM_WORLD), 16u);
    for (const SurfacePatch &patch : patches)
      EXPECT_EQ(patch.normals[0], Direction({1, 0, 0}));

    const Traction traction(grid, patches, Expression("0, -30, 2", 3, ""), "side");
    Vector r = grid.make_vector();
    EXPECT_LT((traction.total_force(r, 1) - Direction({0, -30, 2})).norm(), 1e-12);
    traction.add_residual(r, 1, r);
    r.compress(dealii::VectorOperation::add);
    const Vector about_z = nodal_values(grid, [](const Point &X) {
      return Direction({-X[1], X[0], 0});
    });
    EXPECT_NEAR(-(r * about_z), -30, 1e-12); // force (0, -30, 2) at (1, 1/2, 1/2)
  }

  // So the result does not depend on what cells a rank has.
  TEST(NodalMapping, TakesTheNearestCellAndThenThatOfHighestPrecedence)
  {
    const int rank      = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
              last_rank = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;
    const ClaimsOfRanks grid({2, 2, 5}, Point(1, 1, 1), MPI_COMM_WORLD, false);
    const auto patches =
      nodal_surface_patches(grid, box_surface(Point(1, 1, 1), 3), Region("side", "nx > 0.5"), 0.2);
    EXPECT_EQ(patches.size(), 8u * (rank == 0) + 8u * (rank == last_rank));
    for (const SurfacePatch &patch : patches)
      EXPECT_EQ(rank, patch.points[0][1] < 0.5 ? 0 : last_rank);
  }

  TEST(NodalMapping, SaysWhereTheGridDoesNotReach)
  {
    const Surface surface = box_surface(Point(1, 1, 2), 2);
    const BoxOfCells grid({2, 2, 5}, Point(1, 1, 1), MPI_COMM_WORLD, false);
    EXPECT_THROW(nodal_surface_patches(grid, surface, Region("top", "nz > 0.5"), 0.1), BadInput);
    EXPECT_NO_THROW(nodal_surface_patches(grid, surface, Region("low", "nz < -0.5"), 0.1));
  }
} // namespace softcell
