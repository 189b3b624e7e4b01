// SPDX-License-Identifier: LGPL-2.1-or-later
// Nitsche's method on a box of cells, and the body's own force beside it.
#pragma once

#include "../box_of_cells.h"

#include <softcell/loads/nitsche.h>

namespace softcell
{
  inline std::unique_ptr<Nitsche> nitsche(const Discretization &body,
                                          const std::vector<Material> &materials,
                                          const Region &region,
                                          const std::string &displacement,
                                          const double factor = 10)
  {
    return std::make_unique<Nitsche>(body, body.surface_patches(region),
                                     Expression(displacement, 3, ""), materials, factor,
                                     region.name());
  }

  /// Adds int P : grad N, the internal force.
  inline void
  add_internal_force(const BoxOfCells &body, const Material &material, const Vector &u, Vector &r)
  {
    PatchStorage storage;
    for (unsigned int p = 0; p < body.n_patches(); ++p)
    {
      const Patch patch = body.patch(p, storage);
      for (unsigned int q = 0; q < 8; ++q)
      {
        const double *const G = patch.shapes->gradient(q);
        const Gradient H      = interpolate_gradient(patch.nodes, G, u);
        Matrix3<double> F     = identity<double>();
        for (unsigned int a = 0; a < 9; ++a)
          F.entries[a] += H[a / 3][a % 3];
        const Matrix3<double> P =
          material.visit([&](const auto &law) { return law.first_piola_stress(F); });
        for (unsigned int i = 0; i < 8; ++i)
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int d = 0; d < 3; ++d)
              r.local_element(3 * patch.nodes[i] + a) += patch.weights[q] * P(a, d) * G[d * 8 + i];
      }
    }
    r.compress(dealii::VectorOperation::add);
  }

} // namespace softcell
