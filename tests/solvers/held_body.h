// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies on uniform grids for tests of multigrid.
#pragma once

#include <softcell/discretization/methods.h>
#include <softcell/operators/lattice_unknowns.h>

#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// A body held at z = 0.
  struct HeldBody
  {
    /// @param n  cells along the cylinder of length 3 and radius 0.5, at any place across.
    HeldBody(const std::string &type,
             const unsigned int n,
             const std::string &method = "weighted cell")
    {
      GeometryParameters geometry;
      geometry.type   = type;
      geometry.radius = 0.5;
      geometry.length = 3;
      std::vector<std::string> remarks;
      body = make_body(geometry, remarks);
      DiscretizationParameters parameters;
      parameters.method         = method;
      parameters.grid.cell_size = 3. / n;
      parameters.cut.levels     = 3;
      discretization = make_discretization(parameters, geometry, *body, MPI_COMM_SELF, remarks);
      cells          = std::make_unique<CellLattice>(cell_lattice(*discretization));
      const double cell_size = cells->spacing[2];
      for (unsigned int node = 0; node < discretization->n_owned_nodes(); ++node)
        if (discretization->node_positions()[node][2] < 0.01 * cell_size)
          for (unsigned int c = 0; c < 3; ++c)
          {
            constrained.push_back(3 * node + c);
            held.push_back(c * cells->nodes.size() + cells->entries[node]);
          }
    }

    /// Bends it along x and stretches it by a part along z; tapers it.
    Vector bent(const double amplitude, const double stretch) const
    {
      Vector u = discretization->make_vector();
      for (unsigned int node = 0; node < discretization->n_owned_nodes(); ++node)
      {
        const Point &X                = discretization->node_positions()[node];
        u.local_element(3 * node)     = amplitude * X[2] * X[2];
        u.local_element(3 * node + 2) = stretch * X[2] - 2 * amplitude * X[2] * X[0];
      }
      return u;
    }

    std::unique_ptr<Body> body;
    std::unique_ptr<Discretization> discretization;
    std::unique_ptr<CellLattice> cells;
    std::vector<unsigned int> constrained;
    std::vector<std::size_t> held;
  };
} // namespace softcell
