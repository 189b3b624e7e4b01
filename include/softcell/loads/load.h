// SPDX-License-Identifier: LGPL-2.1-or-later
// What acts on a body: forces, and imposed displacements where they are not entered strongly.
#pragma once

#include <softcell/base/block_matrix.h>
#include <softcell/discretization/discretization.h>
#include <softcell/mechanics/material.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// A force that may depend on the displacement. `t` is the load factor of a static run (1 at full
  /// load) or the time. Forces are prepared once for a discretization and then only evaluated.
  class Load
  {
  public:
    virtual ~Load() = default;

    /// Does it grow in proportion to t, as a load does that does not speak of t?
    virtual bool is_proportional() const
    {
      return false;
    }

    /// Subtracts the external force at (u, t) from r. Ghosted u; the caller compresses r.
    /// Collective.
    /// @throws InvertedPoint on all ranks, from a support that needs the stress.
    virtual void add_residual(const Vector &u, double t, Vector &r) const = 0;

    /// Adds d residual / du to K, nothing for a dead load.
    virtual void add_tangent(const Vector & /*u*/, double /*t*/, BlockMatrix & /*K*/) const {}

    /// Whether add_tangent() adds symmetric matrices, as every force with an energy does.
    virtual bool has_symmetric_tangent() const
    {
      return true;
    }

    /// Lists of nodes that the tangent couples beyond those of single patches.
    virtual void add_couplings(std::vector<std::vector<unsigned int>> & /*couplings*/) const {}

    /// Potential energy, -int f . u of a dead load and 1/2 k |u - g|^2 of a penalty; NaN where
    /// there is none. Collective. Units: J
    virtual double energy(const Vector & /*u*/, double /*t*/) const
    {
      return std::numeric_limits<double>::quiet_NaN();
    }

    /// The force with which this load acts on the body at (u, t): for a support, its reaction.
    /// Collective. Units: N
    virtual Direction total_force(const Vector &u, double t) const = 0;

    /// Name of the region that it acts on, "gravity" for weight.
    virtual const std::string &region() const = 0;
  };
} // namespace softcell
