// SPDX-License-Identifier: LGPL-2.1-or-later
// The simplest discretization, for tests and benchmarks of operators: a lattice of trilinear cubes.
#pragma once

#include "../bare_discretization.h"

#include <deal.II/base/partitioner.h>
#include <deal.II/base/quadrature_lib.h>

#include <array>

namespace softcell
{
  enum class LatticePatches
  {
    congruent,  // one per cell, which share one table, as weighted cells do
    own_tables, // one per cell, each with its own table, as finite cells have
    merged      // a single one with all nodes and all points
  };

  /// Cubes of 1 m on this rank alone, with Gauss points. Only what the operators ask for is there.
  class UnitCells : public BareDiscretization
  {
  public:
    UnitCells(const std::array<unsigned int, 3> &n_cells,
              const unsigned int n_gauss,
              const LatticePatches kind = LatticePatches::congruent)
    {
      const std::array<unsigned int, 3> n_nodes{{n_cells[0] + 1, n_cells[1] + 1, n_cells[2] + 1}};
      for (unsigned int k = 0; k < n_nodes[2]; ++k)
        for (unsigned int j = 0; j < n_nodes[1]; ++j)
          for (unsigned int i = 0; i < n_nodes[0]; ++i)
            node_positions_.emplace_back(i, j, k);
      partitioner_ = std::make_shared<Partitioner>(3 * node_positions_.size());

      const dealii::QGauss<3> gauss(n_gauss);
      for (unsigned int k = 0; k < n_cells[2]; ++k)
        for (unsigned int j = 0; j < n_cells[1]; ++j)
          for (unsigned int i = 0; i < n_cells[0]; ++i)
          {
            Cell cell;
            for (unsigned int v = 0; v < 8; ++v)
              cell.nodes.push_back(i + v % 2 +
                                   n_nodes[0] * (j + v / 2 % 2 + n_nodes[1] * (k + v / 4)));
            cell.weights = gauss.get_weights();
            cells.push_back(cell);
          }

      ShapeTable table;
      table.resize(gauss.size(), 8);
      for (unsigned int q = 0; q < gauss.size(); ++q)
        for (unsigned int v = 0; v < 8; ++v)
          set_shape(table, q, v, v, gauss.point(q));
      tables_.assign(kind == LatticePatches::own_tables ? cells.size() : 1, table);
      if (kind == LatticePatches::merged)
        merge(gauss);
    }

    struct Cell
    {
      std::vector<unsigned int> nodes;
      std::vector<double> weights;
      std::vector<unsigned char> labels{0};
    };
    std::vector<Cell> cells; // weights and labels may be changed

    unsigned int n_patches() const override
    {
      return cells.size();
    }
    Patch patch(const unsigned int i, PatchStorage &) const override
    {
      const Cell &cell = cells[i];
      return {{cell.nodes.data(), cell.nodes.size()},
              {cell.weights.data(), cell.weights.size()},
              &tables_[tables_.size() == 1 ? 0 : i],
              {cell.labels.data(), cell.labels.size()}};
    }

  private:
    // The trilinear function of corner v of the unit cube, for the given node of the table.
    static void set_shape(ShapeTable &table,
                          const unsigned int q,
                          const unsigned int node,
                          const unsigned int v,
                          const Point &x)
    {
      const unsigned int upper[3] = {v % 2, v / 2 % 2, v / 4};
      double values[3];
      for (unsigned int d = 0; d < 3; ++d)
        values[d] = upper[d] ? x[d] : 1 - x[d];
      const unsigned int n       = table.n_nodes;
      table.values[q * n + node] = values[0] * values[1] * values[2];
      for (unsigned int d = 0; d < 3; ++d)
        table.gradients[(q * 3 + d) * n + node] =
          (upper[d] ? 1 : -1) * values[(d + 1) % 3] * values[(d + 2) % 3];
    }

    void merge(const dealii::QGauss<3> &gauss)
    {
      Cell all;
      for (unsigned int node = 0; node < node_positions_.size(); ++node)
        all.nodes.push_back(node);
      ShapeTable &table = tables_[0];
      table             = {};
      table.resize(cells.size() * gauss.size(), all.nodes.size());
      for (unsigned int c = 0, point = 0; c < cells.size(); ++c)
        for (unsigned int q = 0; q < gauss.size(); ++q, ++point)
        {
          all.weights.push_back(gauss.weight(q));
          for (unsigned int v = 0; v < 8; ++v)
            set_shape(table, point, cells[c].nodes[v], v, gauss.point(q));
        }
      cells = {all};
    }

    std::vector<ShapeTable> tables_;
  };
} // namespace softcell
