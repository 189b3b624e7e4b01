// SPDX-License-Identifier: LGPL-2.1-or-later
// A lattice of springs, on any number of ranks.
#pragma once

#include <softcell/solvers/linear_solver.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

namespace softcell
{
  /// n x n x n cells whose eight corners are joined by springs, each with each: stiffness without
  /// bending, with the six rigid-body modes and no other, held at z = 0. Every rank owns a range of
  /// planes z = const.
  struct SpringLattice
  {
    const unsigned int n;
    std::shared_ptr<const Partitioner> unknowns;
    std::vector<std::vector<unsigned int>> cells;
    std::vector<Point> positions;   // of owned nodes and then of ghosts
    std::vector<unsigned int> held; // owned local unknowns
    std::unique_ptr<BlockMatrix> matrix;

    Point position(const unsigned int node) const
    {
      return Point(node % (n + 1), node / (n + 1) % (n + 1), node / (n + 1) / (n + 1));
    }

    /// @param shift is taken off the diagonal of every cell's matrix.
    explicit SpringLattice(const unsigned int cells_per_side, const double shift = 0)
        : n(cells_per_side)
    {
      const unsigned int plane = (n + 1) * (n + 1), n_nodes = plane * (n + 1);
      const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
      const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      const unsigned int first = (n + 1) * rank / n_ranks, end = (n + 1) * (rank + 1) / n_ranks;

      dealii::IndexSet owned(3 * n_nodes), ghosts(3 * n_nodes);
      owned.add_range(3 * plane * first, 3 * plane * end);
      const unsigned int top = first < end ? std::min(end + 1, n + 1) : end; // ghosts included
      if (top > end)
        ghosts.add_range(3 * plane * end, 3 * plane * (end + 1));
      unknowns = std::make_shared<const Partitioner>(owned, ghosts, MPI_COMM_WORLD);
      for (unsigned int node = plane * first; node < plane * top; ++node)
        positions.push_back(position(node));

      for (unsigned int z = 0; z < std::min(end, n) - std::min(first, n); ++z)
        for (unsigned int y = 0; y < n; ++y)
          for (unsigned int x = 0; x < n; ++x)
          {
            cells.emplace_back();
            for (unsigned int v = 0; v < 8; ++v)
              cells.back().push_back((z + v / 4) * plane + (y + v / 2 % 2) * (n + 1) + x + v % 2);
          }
      if (first == 0 && end > 0)
        for (unsigned int i = 0; i < 3 * plane; ++i)
          held.push_back(i);

      matrix = std::make_unique<BlockMatrix>(unknowns, cells);
      assemble(shift);
    }

    /// @param twist couples x with y in every cell's matrix, with opposite signs.
    void assemble(const double shift, const double twist = 0)
    {
      matrix->set_zero();
      for (const std::vector<unsigned int> &cell : cells)
      {
        std::vector<double> values(24 * 24);
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int j = 0; j < 8; ++j)
            for (unsigned int a = 0; a < 3; ++a)
              for (unsigned int b = 0; b < 3; ++b)
              {
                const Direction d = positions[cell[j]] - positions[cell[i]];
                const double k    = i == j ? 0. : d[a] * d[b] / d.norm_square();
                values[(a * 8 + i) * 24 + b * 8 + j] -= k;
                values[(a * 8 + i) * 24 + b * 8 + i] += k - (i == j && a == b ? shift : 0.);
              }
        for (unsigned int i = 0; i < 8; ++i)
        {
          values[i * 24 + 8 + i] += twist;
          values[(8 + i) * 24 + i] -= twist;
        }
        matrix->add(dealii::make_array_view(cell), values.data());
      }
      matrix->compress();
      matrix->constrain(held, 1.);
    }

    /// Some displacement that is zero where the lattice is held.
    Vector displacement() const
    {
      Vector u(unknowns);
      for (unsigned int i = 0; i < unknowns->locally_owned_size(); ++i)
        u.local_element(i) = std::sin(0.3 * unknowns->local_to_global(i)) + 0.5 * (i % 3);
      for (const unsigned int i : held)
        u.local_element(i) = 0.;
      return u;
    }

    /// The iterations that a solver takes, whose solution is compared with the displacement.
    unsigned int expect_solution(LinearSolver &solver, const double tolerance) const
    {
      const Vector u = displacement();
      Vector b(unknowns), x(unknowns);
      matrix->vmult(b, u);
      const unsigned int iterations = solver.solve(x, b);
      EXPECT_LE(solver.history().back(), tolerance);
      x -= u;
      EXPECT_LE(x.l2_norm(), 100. * n * n * tolerance * u.l2_norm()) << "n = " << n;
      return iterations;
    }
  };
} // namespace softcell
