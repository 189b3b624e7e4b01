// SPDX-License-Identifier: LGPL-2.1-or-later
// What a V-cycle makes of a tangent's spectrum.

#include <softcell/solvers/geometric_multigrid.h>
#include <softcell/solvers/grid_levels.h>
#include <softcell/solvers/lanczos.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace softcell;

  /// 12 x 12 x 8 full cells, held below, perhaps with a knob of one cell above.
  struct Block
  {
    CellLattice cells{NodeLattice(std::array<int, 3>{{12, 12, 9}}),
                      Direction({1, 1, 1}),
                      {},
                      {},
                      {}};
    std::vector<std::size_t> held;

    explicit Block(const bool has_knob)
    {
      std::array<double, 8> full;
      full.fill(0.125);
      for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 12; ++j)
          for (int i = 0; i < 12; ++i)
            cells.gauss_cells.push_back({{{i, j, k}}, full});
      if (has_knob)
        cells.gauss_cells.push_back({{{5, 5, 8}}, full});
      for (int j = 0; j <= 12; ++j)
        for (int i = 0; i <= 12; ++i)
          for (unsigned int c = 0; c < 3; ++c)
            held.push_back(c * cells.nodes.size() + cells.nodes.entry(i, j, 0));
    }

    /// Extreme eigenvalues of the tangent times a V-cycle, from conjugate gradients, whose
    /// last ten steps change no more than the fourth digit.
    std::pair<double, double> spectrum() const
    {
      const Material material("linear", 1, 0.3);
      GeometricMultigrid<double> multigrid(cells, material, held);
      const LatticeUnknowns &unknowns = multigrid.unknowns();
      LatticeTangent<double> tangent(cells, material, unknowns);
      const LatticeVector<double> rest(unknowns.nodes());
      multigrid.set_state(rest);
      tangent.elasticity().set_state(rest);
      LatticeVector<double> r = rough_field<double>(unknowns), z(rest), p(rest), Kp(rest);
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

  // The coarse grids of full cells are Galerkin's, P^T K P with the interpolation P, and what the
  // smoother leaves it leaves in the energy norm. So the error that a V-cycle leaves is positive.
  TEST(MultigridSpectrum, FullCellsGiveGalerkinsVCycle)
  {
    EXPECT_LE(Block(false).spectrum().second, 1 + 1e-10);
  }

  // The knob is an octant of its parent and of that one's, in the grid that is solved exactly.
  // Eight iterations to 1e-6 are certain where 2 q^8 <= 1e-6, q = (c^(1/2) - 1) / (c^(1/2) + 1),
  // with the condition c.
  TEST(MultigridSpectrum, StaysTogetherWhereCoarseCellsAreHardlyFilled)
  {
    const double q = std::pow(5e-7, 1. / 8), bound = std::pow((1 + q) / (1 - q), 2);
    const auto [least, largest] = Block(true).spectrum();
    EXPECT_GT(least, 0);
    EXPECT_LE(largest, bound * least);
  }
} // namespace
