// SPDX-License-Identifier: LGPL-2.1-or-later
// The grids of a multigrid as a graphics card takes them.

#include <softcell/solvers/card_levels.h>

#include <softcell/solvers/grid_levels.h>

#include <deal.II/lac/full_matrix.h>

#include <cmath>

namespace softcell
{
  template <class Real>
  CardLevels<Real>::CardLevels(const CellLattice &cells, const std::vector<std::size_t> &held)
      : levels_(std::make_unique<std::vector<GridLevel>>(grid_levels(cells, held)))
  {
  }

  template <class Real>
  CardLevels<Real>::~CardLevels() = default;

  template <class Real>
  unsigned int CardLevels<Real>::size() const
  {
    return levels_->size();
  }

  template <class Real>
  CardLevel<Real> CardLevels<Real>::level(const unsigned int l) const
  {
    const auto &[cells, unknowns]   = (*levels_)[l];
    const auto &n                   = cells.nodes.n_cells();
    const LatticeVector<Real> rough = softcell::rough_field<Real>(unknowns);
    CardLevel<Real> result{CellBricks<Real>(cells),
                           {{n[0] + 1, n[1] + 1, n[2] + 1}},
                           std::vector<unsigned char>(cells.nodes.size(), 7),
                           {rough.entries().begin(), rough.entries().end()}};
    for (const std::size_t entry : unknowns.free_entries())
      result.held[entry % cells.nodes.size()] &= ~(1U << entry / cells.nodes.size());
    return result;
  }

  template <class Real>
  std::vector<Real> CardLevels<Real>::coarse(const unsigned int l,
                                             const std::vector<Real> &displacement) const
  {
    const GridLevel &fine = (*levels_)[l], &next = (*levels_)[l + 1];
    LatticeVector<Real> u(fine.cells.nodes);
    std::copy(displacement.begin(), displacement.end(), u.entries().begin());
    const LatticeVector<Real> result =
      coarse_displacement(fine.unknowns, u, next.unknowns, next.cells.spacing);
    return {result.entries().begin(), result.entries().end()};
  }

  template <class Real>
  std::vector<int> CardLevels<Real>::coarsest_entries() const
  {
    const std::vector<std::size_t> entries = levels_->back().unknowns.free_entries();
    return {entries.begin(), entries.end()};
  }

  std::vector<double> symmetric_inverse(const std::vector<double> &matrix)
  {
    const std::size_t n = std::lround(std::sqrt(matrix.size()));
    dealii::FullMatrix<double> inverse(n, n, matrix.data());
    inverse.symmetrize();
    inverse.gauss_jordan();
    std::vector<double> result;
    for (std::size_t i = 0; i < n; ++i)
      result.insert(result.end(), inverse.begin(i), inverse.end(i));
    return result;
  }

  template class CardLevels<double>;
  template class CardLevels<float>;
} // namespace softcell
