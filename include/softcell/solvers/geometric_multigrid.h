// SPDX-License-Identifier: LGPL-2.1-or-later
// Multigrid on a uniform grid and its coarser ones, without a matrix.
#pragma once

#include <softcell/operators/lattice_tangent.h>

#include <deal.II/lac/full_matrix.h>

#include <memory>
#include <vector>

namespace softcell
{
  /// A symmetric positive definite operator that is near to the inverse of an elastic tangent: a
  /// V-cycle over a grid of cells and those with twice, four times, ... the edges.
  ///
  /// Every grid has the body's weighted cells (coarse_cells()) with the displacement of the finest
  /// one, and the supports as Galerkin's product. The tangents are definite ones, see Tangent,
  /// but for the finest smoother's, see set_smoother(). The displacement is smoothed where coarse
  /// cells are nearly inside out; if that is not enough, their grid is taken at rest. In place of
  /// Saint-Venant-Kirchhoff the law is Neo-Hookean, whose tangent at rest is the same.
  ///
  /// The smoother is Chebyshev's polynomial of the fourth kind over the inverted diagonal blocks,
  /// before and after, of a degree that doubles from grid to grid: coarse corrections become nearly
  /// exact, for little. Source: Lottes, Optimal polynomial smoothers for multigrid V-cycles (2023).
  template <class Real>
  class GeometricMultigrid
  {
  public:
    /// @param held    entries of a LatticeVector whose unknowns are not free.
    /// @param degree  of the finest grid's smoother.
    GeometricMultigrid(const CellLattice &cells,
                       const Material &material,
                       const std::vector<std::size_t> &held,
                       unsigned int degree = 4);

    ~GeometricMultigrid();

    /// Of the operator whose inverse it is near to, from the next set_state() on, see
    /// LatticeTangent::combine().
    void combine(Real stiffness, Real mass);

    /// Takes the displacement at which the tangents are formed, and the supports' tangent.
    /// @param smoother  see set_smoother().
    /// @throws InvertedPoint, or NotConverged if a grid's tangent is not positive definite
    void set_state(const LatticeVector<Real> &u,
                   LatticeMatrix<Real> supports = {},
                   Tangent smoother             = Tangent::definite);

    /// Gives the finest grid's smoother another tangent at the same displacement. The exact one
    /// suits a tangent that is hardly definite. Where a polynomial leaves p of an eigenvalue e,
    /// smoothing twice is (1 - p^2) / e: positive up to the largest one, as |p| < 1, and also where
    /// e < 0 and p > 1, but large.
    void set_smoother(Tangent tangent);

    /// Takes another displacement on the finest grid alone, without a new estimate of its largest
    /// eigenvalue: much faster, and near enough where single cells are squeezed.
    void set_finest_state(const LatticeVector<Real> &u);

    /// y = K^-1 x, nearly, where x is taken as 0 in unknowns that are not free. Nodes without cells
    /// keep their y.
    void vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const;

    const LatticeUnknowns &unknowns() const;

    /// Units: byte
    std::size_t memory() const;

  private:
    struct Level;

    void estimate_eigenvalue(Level &level, Tangent tangent) const;
    void invert_coarsest();
    void smooth(Level &level, bool is_last) const;
    void cycle(unsigned int level) const;

    std::vector<std::unique_ptr<Level>> levels_; // from the finest on
    Tangent smoother_ = Tangent::definite;       // of the finest
    std::vector<std::size_t> coarsest_entries_;  // of the coarsest grid's free unknowns
    dealii::FullMatrix<double> coarsest_inverse_;
  };
} // namespace softcell
