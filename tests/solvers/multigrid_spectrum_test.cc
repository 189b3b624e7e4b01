// SPDX-License-Identifier: LGPL-2.1-or-later
// What a V-cycle makes of a tangent's spectrum.

#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/grid_levels.h>
#include <softcell/solvers/lanczos.h>
#include <softcell/solvers/matrix_free_solver.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  /// n x n x 2 n / 3 full cells, held below, perhaps with a knob of one cell above.
  struct Block
  {
    CellLattice cells;
    std::vector<std::size_t> held;

    explicit Block(const int n, const bool has_knob = false)
        : cells{NodeLattice(std::array<int, 3>{{n, n, 2 * n / 3 + 1}}),
                Direction({1, 1, 1}),
                {},
                {},
                {}}
    {
      std::array<double, 8> full;
      full.fill(0.125);
      for (int k = 0; k < 2 * n / 3; ++k)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
            cells.gauss_cells.push_back({{{i, j, k}}, full});
      if (has_knob)
        cells.gauss_cells.push_back({{{5, 5, 2 * n / 3}}, full});
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i)
          for (unsigned int c = 0; c < 3; ++c)
            held.push_back(c * cells.nodes.size() + cells.nodes.entry(i, j, 0));
    }

    LatticeVector<double> rest() const
    {
      return LatticeVector<double>(cells.nodes);
    }

    /// A cell on the edge squeezed to a part of its height, from above.
    LatticeVector<double> flat_at_the_edge(const double height) const
    {
      LatticeVector<double> u = rest();
      for (int j = 0; j <= 1; ++j)
        for (int i = 0; i <= 1; ++i)
          u.component(2)[cells.nodes.entry(i, j, cells.nodes.n_cells()[2] - 1)] = height - 1;
      return u;
    }

    /// Extreme eigenvalues of the definite tangent times a V-cycle, from conjugate gradients, whose
    /// last ten steps change no more than the fourth digit.
    std::pair<double, double> spectrum(const Material &material,
                                       const LatticeVector<double> &u,
                                       const unsigned int degree) const
    {
      GeometricMultigrid<double> multigrid(cells, material, held, degree);
      multigrid.set_state(u);
      return spectrum(multigrid, material, u);
    }

    std::pair<double, double> spectrum(const GeometricMultigrid<double> &multigrid,
                                       const Material &material,
                                       const LatticeVector<double> &u) const
    {
      const LatticeUnknowns &unknowns = multigrid.unknowns();
      LatticeTangent<double> tangent(cells, material, unknowns);
      tangent.elasticity().set_state(u, Tangent::definite);
      LatticeVector<double> r = rough_field<double>(unknowns), z(rest()), p(z), Kp(z);
      LanczosMatrix lanczos;
      double rz_before = 1;
      for (unsigned int step = 0; step < 30; ++step)
      {
        multigrid.vmult(z, r);
        const double rz = unknowns.dot(r, z), share = step == 0 ? 0 : rz / rz_before;
        unknowns.for_each(p, z, [&](double &p_i, const double z_i) { p_i = share * p_i + z_i; });
        tangent.vmult(Kp, p);
        const double curvature = unknowns.dot(p, Kp) / rz;
        unknowns.for_each(r, Kp, [&](double &r_i, const double y_i) { r_i -= y_i / curvature; });
        lanczos.add(curvature, share);
        rz_before = rz;
      }
      return lanczos.extreme_eigenvalues();
    }
  };

  const Material linear("linear", 1, 0.3), soft("Neo-Hookean", 1, 0.45);

  // The coarse grids of full cells are Galerkin's, P^T K P with the interpolation P, and what the
  // smoother leaves it leaves in the energy norm. So the error that a V-cycle leaves is positive.
  TEST(MultigridSpectrum, FullCellsGiveGalerkinsVCycle)
  {
    const Block block(12);
    EXPECT_LE(block.spectrum(linear, block.rest(), 4).second, 1 + 1e-10);
  }

  // The knob is an octant of its parent and of that one's, in the grid that is solved exactly.
  // Eight iterations to 1e-6 are certain where 2 q^8 <= 1e-6, q = (c^(1/2) - 1) / (c^(1/2) + 1),
  // with the condition c.
  TEST(MultigridSpectrum, StaysTogetherWhereCoarseCellsAreHardlyFilled)
  {
    const double q = std::pow(5e-7, 1. / 8), bound = std::pow((1 + q) / (1 - q), 2);
    const Block block(12, true);
    const auto [least, largest] = block.spectrum(linear, block.rest(), 4);
    EXPECT_GT(least, 0);
    EXPECT_LE(largest, bound * least);
  }

  // As an iteration the V-cycle converges while all eigenvalues are below 2. The stiffness of a
  // flat cell belongs to few of many unknowns: a smoother that estimates its largest eigenvalue in
  // too few steps does not see it, and amplifies it.
  TEST(MultigridSpectrum, StaysBelowTwoWhereOneCellIsSqueezedFlat)
  {
    const Block block(24);
    LatticeVector<double> u = block.rest();
    for (int j = 5; j <= 6; ++j)
      for (int i = 5; i <= 6; ++i)
        u.component(2)[block.cells.nodes.entry(i, j, 5)] = -0.9;
    const auto [least, largest] = block.spectrum(soft, u, MatrixFreeSolver::smoother_degree);
    EXPECT_GT(least, 0);
    EXPECT_LT(largest, 2);
  }

  // Multigrid for the body at rest amplifies the stiffness of a squeezed cell.
  TEST(MultigridSpectrum, TheFinestGridsStateTamesASqueezedCell)
  {
    const Block block(12);
    for (const double height : {0.5, 0.2, 0.1})
    {
      const LatticeVector<double> u = block.flat_at_the_edge(height);
      GeometricMultigrid<double> multigrid(block.cells, soft, block.held, 1);
      multigrid.set_state(block.rest());
      const double at_rest = block.spectrum(multigrid, soft, u).second;
      multigrid.set_finest_state(u);
      const auto [least, largest] = block.spectrum(multigrid, soft, u);
      EXPECT_GT(at_rest, 2);
      EXPECT_GT(least, 0);
      EXPECT_LT(largest, at_rest / 3);
    }
  }

  /// The mode of the largest eigenvalue of the inverse diagonal blocks times the tangent.
  LatticeVector<double> stiffest_mode(const LatticeTangent<double> &tangent)
  {
    constexpr unsigned int entry[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}}; // of a block
    const LatticeUnknowns &unknowns    = tangent.unknowns();
    const std::size_t n                = unknowns.nodes().size();
    LatticeBlocks<double> D(unknowns.nodes());
    tangent.inverse_diagonal(D);
    LatticeVector<double> x = rough_field<double>(unknowns), Kx(x);
    for (unsigned int step = 0; step < 200; ++step) // of the power method
    {
      tangent.vmult(Kx, x);
      const double norm = std::sqrt(unknowns.dot(x, x));
      for (const std::size_t i : unknowns.free_entries())
      {
        x.entries()[i] = 0;
        for (unsigned int d = 0; d < dim; ++d)
          x.entries()[i] += D.component(entry[i / n][d])[i % n] * Kx.component(d)[i % n] / norm;
      }
    }
    return x;
  }

  /// The least eigenvalue of a symmetric operator on the free unknowns.
  template <class Operator>
  double least_eigenvalue(const LatticeUnknowns &unknowns, const Operator &A)
  {
    const std::vector<std::size_t> entries = unknowns.free_entries();
    dealii::LAPACKFullMatrix<double> matrix(entries.size());
    LatticeVector<double> x(unknowns.nodes()), y(x);
    for (unsigned int j = 0; j < entries.size(); ++j)
    {
      x.entries()[entries[j]] = 1;
      A.vmult(y, x);
      x.entries()[entries[j]] = 0;
      for (unsigned int i = 0; i < entries.size(); ++i)
        matrix(i, j) = y.entries()[entries[i]];
    }
    dealii::Vector<double> eigenvalues;
    dealii::FullMatrix<double> eigenvectors;
    const double all = 2 * matrix.frobenius_norm();
    matrix.compute_eigenvalues_symmetric(-all, all, 0, eigenvalues, eigenvectors);
    return eigenvalues[0];
  }

  // See GeometricMultigrid::set_smoother().
  TEST(MultigridSpectrum, IsPositiveWithTheSmootherOfAnIndefiniteTangent)
  {
    const Block block(6);
    GeometricMultigrid<double> multigrid(block.cells, soft, block.held,
                                         MatrixFreeSolver::smoother_degree);
    const LatticeVector<double> u = block.flat_at_the_edge(0.1);
    multigrid.set_state(u, {}, Tangent::exact);
    LatticeTangent<double> tangent(block.cells, soft, multigrid.unknowns());
    tangent.elasticity().set_state(u);
    EXPECT_LT(least_eigenvalue(multigrid.unknowns(), tangent), 0);
    EXPECT_GT(least_eigenvalue(multigrid.unknowns(), multigrid), 0);
  }

  // Of the mode at the largest eigenvalue, which is a flat cell's, Chebyshev's polynomial of degree
  // k leaves at most 1 / (2 k + 1): smoothing twice, and what other grids add, is nearly its
  // inverse. With the definite tangent's largest eigenvalue for the exact one, which is stiffer, it
  // would be a thousand times that.
  TEST(MultigridSpectrum, SmootherKnowsTheStiffestModeOfItsTangent)
  {
    const Block block(12);
    GeometricMultigrid<double> multigrid(block.cells, soft, block.held,
                                         MatrixFreeSolver::smoother_degree);
    const LatticeUnknowns &unknowns = multigrid.unknowns();
    LatticeTangent<double> tangent(block.cells, soft, unknowns);
    const LatticeVector<double> u = block.flat_at_the_edge(0.2);
    multigrid.set_state(u);
    for (const Tangent kind : {Tangent::definite, Tangent::exact, Tangent::definite})
    {
      tangent.elasticity().set_state(u, kind);
      multigrid.set_smoother(kind);
      const LatticeVector<double> x = stiffest_mode(tangent);
      LatticeVector<double> Kx(x), z(x);
      tangent.vmult(Kx, x);
      multigrid.vmult(z, Kx);
      EXPECT_NEAR(unknowns.dot(z, Kx) / unknowns.dot(x, Kx), 1, 0.1);
    }
  }
} // namespace
