// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed strongly: on the unknowns of nodes.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/loads/expression.h>

#include <string>
#include <vector>

namespace softcell
{
  /// The unknowns whose values are given, and their values.
  class ImposedDisplacement
  {
  public:
    explicit ImposedDisplacement(const Discretization &discretization);

    /// Imposes a displacement g on the nodes of a region, but for components that are `free`.
    /// An unknown that an earlier region imposes too must get the same value from both; it counts
    /// to the earlier one. Collective.
    /// @param nodes        local numbers, owned or ghost.
    /// @param displacement g, at load factor t. Units: m
    /// @throws BadInput on all ranks where two regions contradict each other.
    void add(std::string region, const std::vector<unsigned int> &nodes, Expression displacement);

    /// Imposed local unknowns (3 * node + component), owned and ghost, ascending.
    const std::vector<unsigned int> &unknowns() const
    {
      return unknowns_;
    }

    /// missing = g(t) - u in imposed unknowns, 0 elsewhere, with ghost values. Collective.
    void missing(const Vector &u, double t, Vector &missing) const;

    /// Names of the regions in the order in which they came.
    const std::vector<std::string> &regions() const
    {
      return regions_;
    }

    /// The force with which each region's support acts on the body. Collective. Units: N
    /// @param residual internal minus external forces with nothing imposed, compressed.
    std::vector<Direction> reactions(const Vector &residual) const;

  private:
    /// g of local unknown i, which belongs to region number `owner`.
    double value(unsigned int owner, unsigned int i, double t) const;

    const Discretization &discretization_;
    std::vector<std::string> regions_;
    std::vector<Expression> displacements_;
    std::vector<unsigned int> unknowns_;
    std::vector<unsigned int> owner_; // of each local unknown: number of its region
  };
} // namespace softcell
