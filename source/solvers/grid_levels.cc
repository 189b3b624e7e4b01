// SPDX-License-Identifier: LGPL-2.1-or-later
// The grids of a multigrid.

#include <softcell/solvers/grid_levels.h>

namespace softcell
{
  namespace
  {
    /// Unknowns of the grid that is solved exactly, at most.
    constexpr std::size_t n_coarsest = 400;

    /// Of cells on coarse grids.
    constexpr double smallest_jacobian = 0.05;
  } // namespace

  std::vector<GridLevel> grid_levels(const CellLattice &cells, const std::vector<std::size_t> &held)
  {
    std::vector<GridLevel> levels{{cells, LatticeUnknowns(cells, held)}};
    while (levels.back().unknowns.free_entries().size() > n_coarsest)
    {
      CellLattice coarse = coarse_cells(levels.back().cells);
      LatticeUnknowns unknowns(coarse, levels.back().unknowns);
      levels.push_back({std::move(coarse), std::move(unknowns)});
    }
    return levels;
  }

  template <class Real>
  LatticeVector<Real> coarse_displacement(const LatticeUnknowns &fine,
                                          const LatticeVector<Real> &u,
                                          const LatticeUnknowns &coarse,
                                          const Direction &coarse_spacing)
  {
    LatticeVector<Real> result(coarse.nodes());
    coarse.take(fine, u, result);
    coarse.untangle(coarse_spacing, smallest_jacobian, result);
    return result;
  }

  template <class Real>
  LatticeVector<Real> rough_field(const LatticeUnknowns &unknowns, unsigned int seed)
  {
    LatticeVector<Real> field(unknowns.nodes());
    for (const std::size_t entry : unknowns.free_entries())
      field.entries()[entry] =
        Real(seed = 1664525 * seed + 1013904223) / Real(4294967296.) - Real(0.5);
    return field;
  }

  template LatticeVector<double> coarse_displacement(const LatticeUnknowns &,
                                                     const LatticeVector<double> &,
                                                     const LatticeUnknowns &,
                                                     const Direction &);
  template LatticeVector<float> coarse_displacement(const LatticeUnknowns &,
                                                    const LatticeVector<float> &,
                                                    const LatticeUnknowns &,
                                                    const Direction &);
  template LatticeVector<double> rough_field(const LatticeUnknowns &, unsigned int);
  template LatticeVector<float> rough_field(const LatticeUnknowns &, unsigned int);
} // namespace softcell
