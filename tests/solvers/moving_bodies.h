// SPDX-License-Identifier: LGPL-2.1-or-later
// Small bodies for tests of their motion.
#pragma once

#include <softcell/discretization/methods.h>
#include <softcell/solvers/lattice_motion.h>

namespace softcell
{
  inline CellLattice cells_of(const std::string &type, const Point &size, const unsigned int n)
  {
    GeometryParameters geometry;
    geometry.type   = type;
    geometry.size   = size;
    geometry.radius = 0.05;
    geometry.length = 0.2;
    std::vector<std::string> remarks;
    const auto body = make_body(geometry, remarks);
    DiscretizationParameters parameters;
    parameters.method     = "weighted cell";
    parameters.grid.cells = {n};
    parameters.cut.levels = 2;
    return cell_lattice(*make_discretization(parameters, geometry, *body, MPI_COMM_SELF, remarks));
  }

  inline Point position(const CellLattice &cells, const std::size_t node)
  {
    const std::size_t in_plane = node % cells.nodes.plane();
    return Point(cells.spacing[0] * double(in_plane % cells.nodes.row()),
                 cells.spacing[1] * double(in_plane / cells.nodes.row()),
                 cells.spacing[2] * double(node / cells.nodes.plane()));
  }

  /// Sets a field at all nodes of cells.
  template <class Real, class F>
  void fill(const CellLattice &cells, LatticeVector<Real> &field, const F &value)
  {
    for (const std::size_t node : cells.entries)
    {
      const Direction at = value(position(cells, node));
      for (unsigned int c = 0; c < dim; ++c)
        field.component(c)[node] = at[c];
    }
  }

  template <class IsInside>
  std::vector<std::size_t> entries_where(const CellLattice &cells, const IsInside &is_inside)
  {
    std::vector<std::size_t> entries;
    for (const std::size_t node : cells.entries)
      for (unsigned int c = 0; c < dim && is_inside(position(cells, node)); ++c)
        entries.push_back(c * cells.nodes.size() + node);
    return entries;
  }
  inline std::vector<std::size_t> entries_below(const CellLattice &cells, const double z)
  {
    return entries_where(cells, [z](const Point &X) { return X[2] < z; });
  }
  inline std::vector<std::size_t> entries_above(const CellLattice &cells, const double z)
  {
    return entries_where(cells, [z](const Point &X) { return X[2] > z; });
  }

  inline LatticeVector<double> weight(const CellLattice &cells, const LatticeMotion<double> &motion)
  {
    LatticeVector<double> force(cells.nodes);
    for (const std::size_t node : cells.entries)
      force.component(2)[node] = -9.81 * motion.tangent().masses().component(0)[node];
    return force;
  }

  const Material soft_tissue("Neo-Hookean", 1000, 0.3, 1000);
  const LatticeMotion<double>::Effort exactly{1e-13, 1000};
} // namespace softcell
