// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a solution errs most: an estimate of the stress's error in each cell.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/material.h>

#include <vector>

namespace softcell
{
  /// The estimate of Zienkiewicz and Zhu of each cell's error in the energy norm, at degree 1.
  ///
  /// S is the Cauchy stress of u, and S* = sum_i N_i S_i with S_i = int N_i S / int
  /// N_i what its averages at the nodes make of it. Inside the body, where the solution is smooth,
  /// S* is nearer to the truth than S, so that eta^2 = int (S* - S) : C^-1 : (S* - S) over a cell
  /// stands for its squared error; C is the elasticity of the material at rest. In cut cells and
  /// others on the boundary, whose averages are one-sided, S* need not be nearer. Averages are
  /// taken for each material alone, between which stress may jump. All integrals are those of the
  /// patches: what is filled of a cell counts, so that slivers, whose stress means little, count
  /// little.
  /// Source: Zienkiewicz and Zhu, Int. J. Numer. Meth. Eng. 24 (1987) 337-357. Departure: they
  /// project by the consistent mass matrix, which bad cuts make ill-conditioned; sums of a row of
  /// it are positive however a cell is cut.
  ///
  /// Collective.
  /// @param materials one per label.
  /// @param has_projection of the change of volume (VolumetricProjection); without it the pressure
  ///                  of a nearly incompressible material would be that of no point.
  /// @param u         with ghost values.
  /// @return (n_patches) eta^2, twice the energy of the error if small. Units: J
  std::vector<double> squared_errors(const Discretization &discretization,
                                     const std::vector<Material> &materials,
                                     bool has_projection,
                                     const Vector &u);

  /// The fewest patches of all ranks that hold a part of the sum of the squared errors; of those
  /// that err alike to round-off, all or none. Collective.
  /// Source: Doerfler, SIAM J. Numer. Anal. 33 (1996) 1106-1124.
  /// @param fraction in (0, 1]; 1 is all patches, and less is none if there is no error at all.
  /// @return those of this rank.
  std::vector<unsigned int>
  largest_errors(const std::vector<double> &squared_errors, double fraction, MPI_Comm communicator);
} // namespace softcell
