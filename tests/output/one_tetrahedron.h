// SPDX-License-Identifier: LGPL-2.1-or-later
// The smallest discretization to write: a tetrahedron for every rank, next to each other along x.
#pragma once

#include "../bare_discretization.h"

#include <deal.II/base/index_set.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

namespace softcell::test
{
  class OneTetrahedronPerRank : public BareDiscretization
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
