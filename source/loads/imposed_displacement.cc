// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements imposed strongly: on the unknowns of nodes.

#include <softcell/loads/imposed_displacement.h>

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    constexpr unsigned int nobody = -1;
  }

  ImposedDisplacement::ImposedDisplacement(const Discretization &discretization)
      : discretization_(discretization), owner_(3 * discretization.node_positions().size(), nobody)
  {
  }

  double
  ImposedDisplacement::value(const unsigned int owner, const unsigned int i, const double t) const
  {
    const Point &X = discretization_.node_positions()[i / 3];
    return displacements_[owner].at_load_factor(X, t)[i % 3];
  }

  void ImposedDisplacement::add(std::string region,
                                const std::vector<unsigned int> &nodes,
                                Expression displacement)
  {
    const unsigned int number = regions_.size();
    regions_.push_back(std::move(region));
    displacements_.push_back(std::move(displacement));

    // A rank may know a node of the region only as a ghost or only through a neighbour.
    Vector marks = discretization_.make_vector();
    for (const unsigned int node : nodes)
      for (unsigned int c = 0; c < 3; ++c)
        if (!displacements_.back().is_free(c))
          marks.local_element(3 * node + c) = 1;
    marks.compress(dealii::VectorOperation::add);
    marks.update_ghost_values();

    std::ostringstream conflict;
    unknowns_.clear();
    for (unsigned int i = 0; i < owner_.size(); ++i)
    {
      if (marks.local_element(i) > 0 && owner_[i] == nobody)
        owner_[i] = number;
      else if (marks.local_element(i) > 0 && conflict.str().empty())
        for (const double t : {1., 0.5})
        {
          const double here = value(number, i, t), there = value(owner_[i], i, t);
          if (std::abs(here - there) <= 1e-10 * (std::abs(here) + std::abs(there)))
            continue;
          conflict << displacements_[owner_[i]].place() << " and " << displacements_[number].place()
                   << " impose " << there << " m and " << here << " m along "
                   << "xyz"[i % 3] << " on one node at (" << discretization_.node_positions()[i / 3]
                   << "); leave that component `free` in one of them or let the regions not meet.";
          break;
        }
      if (owner_[i] != nobody)
        unknowns_.push_back(i);
    }
    throw_on_all(discretization_.communicator(), conflict.str());
  }

  void ImposedDisplacement::missing(const Vector &u, const double t, Vector &missing) const
  {
    missing = 0;
    for (const unsigned int i : unknowns_)
      if (i < u.locally_owned_size())
        missing.local_element(i) = value(owner_[i], i, t) - u.local_element(i);
    missing.update_ghost_values();
  }

  std::vector<Direction> ImposedDisplacement::reactions(const Vector &residual) const
  {
    std::vector<Direction> sums(regions_.size());
    for (const unsigned int i : unknowns_)
      if (i < residual.locally_owned_size())
        sums[owner_[i]][i % 3] += residual.local_element(i);
    for (Direction &sum : sums)
      sum = dealii::Utilities::MPI::sum(sum, discretization_.communicator());
    return sums;
  }
} // namespace softcell
