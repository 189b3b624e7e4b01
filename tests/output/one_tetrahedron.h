// SPDX-License-Identifier: LGPL-2.1-or-later
// The smallest discretization to write: a tetrahedron for every rank, next to each other along x.
#pragma once

#include <softcell/discretization/discretization.h>

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

namespace softcell::test
{
  class OneTetrahedronPerRank : public Discretization
  {
  public:
    OneTetrahedronPerRank()
    {
      using namespace dealii;
      const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
      IndexSet owned(12 * Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
      owned.add_range(12 * rank, 12 * (rank + 1));
      partitioner_ =
        std::make_shared<const Partitioner>(owned, IndexSet(owned.size()), MPI_COMM_WORLD);
      node_positions_ = {Point(rank, 0, 0), Point(rank + 1, 0, 0), Point(rank, 1, 0),
                         Point(rank, 0, 1)};
    }
    Size size() const override
    {
      return {};
    }
    unsigned int degree() const override
    {
      return 1;
    }
    unsigned int n_patches() const override
    {
      return 1;
    }
    Patch patch(unsigned int, PatchStorage &) const override
    {
      return {};
    }
    void patch_points(unsigned int, std::vector<Point> &) const override {}
    std::vector<SurfacePatch> surface_patches(const Region &) const override
    {
      return {};
    }
    std::optional<std::vector<unsigned int>> nodes_on(const Region &) const override
    {
      return {};
    }
    std::optional<PointShapes> shapes_at(const Point &, double) const override
    {
      return {};
    }
    Box owned_box() const override
    {
      return {};
    }
    DrawnCells drawn_cells() const override
    {
      DrawnCells cells;
      cells.types        = {10}; // VTK_TETRA
      cells.offsets      = {0, 4};
      cells.connectivity = {0, 1, 2, 3};
      cells.points       = node_positions_;
      for (unsigned int i = 0; i < 4; ++i)
        cells.shapes.push_back({{i}, {1.}, {}, 0});
      cells.patches      = {0};
      cells.cut_fraction = {0.25};
      return cells;
    }
  };
} // namespace softcell::test
