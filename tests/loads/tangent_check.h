// SPDX-License-Identifier: LGPL-2.1-or-later
// A load's tangent against central differences of its residual.
#pragma once

#include "../box_of_cells.h"

#include <softcell/loads/load.h>

namespace softcell
{
  /// The tangent of one load alone, coupled over its own patches.
  inline BlockMatrix
  tangent_of(const Discretization &body, const Load &load, const Vector &u, const double t)
  {
    std::vector<std::vector<unsigned int>> couplings;
    load.add_couplings(couplings);
    for (unsigned int i = 0; i < body.node_positions().size(); ++i)
      couplings.push_back({i}); // no empty rows
    BlockMatrix K(body.partitioner(), couplings);
    K.set_zero();
    load.add_tangent(u, t, K);
    K.compress();
    return K;
  }

  inline Vector
  residual_of(const Discretization &body, const Load &load, const Vector &u, const double t)
  {
    Vector r = body.make_vector();
    load.add_residual(u, t, r);
    r.compress(dealii::VectorOperation::add);
    return r;
  }

  /// u + e v and u - e v.
  inline std::pair<Vector, Vector> on_both_sides(const Vector &u, const double e, const Vector &v)
  {
    std::pair<Vector, Vector> both(u, u);
    both.first.add(e, v);
    both.second.add(-e, v);
    both.first.update_ghost_values();
    both.second.update_ghost_values();
    return both;
  }

  /// |K v - (r(u + e v) - r(u - e v)) / 2e| / |K v|
  inline double tangent_error(const Discretization &body,
                              const Load &load,
                              const Vector &u,
                              const Vector &v,
                              const double t)
  {
    const double e           = 1e-5;
    const auto [plus, minus] = on_both_sides(u, e, v);
    Vector difference        = residual_of(body, load, plus, t);
    difference -= residual_of(body, load, minus, t);
    difference /= 2 * e;
    Vector Kv = body.make_vector();
    tangent_of(body, load, u, t).vmult(Kv, v);
    difference -= Kv;
    return difference.l2_norm() / Kv.l2_norm();
  }

  /// |r . v - (E(u + e v) - E(u - e v)) / 2e| / |r . v|
  inline double energy_error(const Discretization &body,
                             const Load &load,
                             const Vector &u,
                             const Vector &v,
                             const double t)
  {
    const double e           = 1e-5;
    const auto [plus, minus] = on_both_sides(u, e, v);
    const double slope       = (load.energy(plus, t) - load.energy(minus, t)) / (2 * e);
    const double work        = residual_of(body, load, u, t) * v;
    return std::abs(slope - work) / std::abs(work);
  }

  /// Some smooth displacement and a direction in which to differentiate.
  inline Vector some_displacement(const Discretization &body)
  {
    return nodal_values(body, [](const Point &X) {
      return Direction({0.1 * X[1] * X[2], 0.05 * X[0] - 0.1 * X[1], 0.1 * std::sin(X[0] + X[2])});
    });
  }
  inline Vector some_direction(const Discretization &body)
  {
    return nodal_values(body, [](const Point &X) {
      return Direction({std::cos(3 * X[0] + X[1]), X[1] * X[2], std::sin(X[0]) + 0.5});
    });
  }
} // namespace softcell
