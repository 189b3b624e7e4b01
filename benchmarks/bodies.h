// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies on uniform grids for benchmarks.
#pragma once

#include <softcell/discretization/methods.h>
#include <softcell/operators/lattice_unknowns.h>

#include <fstream>
#include <string>
#include <vector>

namespace softcell
{
  /// Of what scripts/fetch-liver fetches.
  inline GeometryParameters liver()
  {
    GeometryParameters geometry;
    geometry.type   = "image";
    geometry.file   = SOFTCELL_LIVER;
    geometry.scale  = 0.001;
    geometry.labels = {255};
    return geometry;
  }

  inline bool has_liver()
  {
    return bool(std::ifstream(SOFTCELL_LIVER));
  }

  /// Of a body, n across its shortest side.
  inline CellLattice cells_of(const GeometryParameters &geometry,
                              const unsigned int n,
                              const unsigned int cut_levels = 2,
                              const std::string &method     = "weighted cell")
  {
    std::vector<std::string> remarks;
    const auto body = make_body(geometry, remarks);
    DiscretizationParameters parameters;
    parameters.method     = method;
    parameters.grid.cells = {n};
    parameters.cut.levels = cut_levels;
    return cell_lattice(*make_discretization(parameters, geometry, *body, MPI_COMM_SELF, remarks));
  }

  /// Entries of all nodes of cells.
  inline std::vector<std::size_t> node_entries(const CellLattice &cells)
  {
    std::vector<std::size_t> entries = LatticeUnknowns(cells, {}).free_entries();
    entries.resize(entries.size() / 3);
    return entries;
  }

  /// A cube of 1 m, n x n x n full cells.
  inline CellLattice cube_cells(const int n)
  {
    const double h = 1. / n;
    CellLattice cells{NodeLattice(std::array<int, 3>{{n, n, n}}), Direction({h, h, h}), {}, {}, {}};
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
        {
          cells.gauss_cells.push_back({{{i, j, k}}, {}});
          cells.gauss_cells.back().weights.fill(h * h * h / 8);
        }
    cells.entries = node_entries(cells);
    return cells;
  }
} // namespace softcell
