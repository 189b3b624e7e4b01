// SPDX-License-Identifier: LGPL-2.1-or-later
// How the nodes of active cells get their numbers and owners.

#include <softcell/discretization/immersed.h>

#include <deal.II/base/partitioner.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_tools.h>

#include <deal.II/hp/fe_collection.h>

#include <deal.II/lac/affine_constraints.h>

#include <algorithm>

namespace softcell
{
  namespace
  {
    using Dof = dealii::types::global_dof_index;

    dealii::AffineConstraints<double> hanging_nodes(const dealii::DoFHandler<3> &dofs)
    {
      dealii::IndexSet relevant;
      dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      dealii::AffineConstraints<double> hanging(relevant);
      dealii::DoFTools::make_hanging_node_constraints(dofs, hanging);
      hanging.close();
      return hanging;
    }

    constexpr unsigned int nothing = 1; // number of the element of cells without nodes

    std::vector<Dof> sorted(std::vector<Dof> dofs)
    {
      std::sort(dofs.begin(), dofs.end());
      dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
      return dofs;
    }

    /// The nodes that a cell's own nodes depend on, sorted, and (own, those) how.
    std::pair<std::vector<Dof>, std::vector<double>>
    condense(const std::vector<Dof> &own, const dealii::AffineConstraints<double> &hanging)
    {
      std::vector<Dof> masters;
      for (const Dof dof : own)
        if (!hanging.is_constrained(dof))
          masters.push_back(dof);
        else
          for (const auto &[master, factor] : *hanging.get_constraint_entries(dof))
            masters.push_back(master);
      masters = sorted(std::move(masters));

      std::vector<double> factors(own.size() * masters.size(), 0.);
      const auto factor_of = [&](const unsigned int i, const Dof master) -> double & {
        const auto m = std::lower_bound(masters.begin(), masters.end(), master);
        return factors[i * masters.size() + (m - masters.begin())];
      };
      for (unsigned int i = 0; i < own.size(); ++i)
        if (!hanging.is_constrained(own[i]))
          factor_of(i, own[i]) = 1;
        else
          for (const auto &[master, factor] : *hanging.get_constraint_entries(own[i]))
            factor_of(i, master) += factor;
      return {masters, factors};
    }

    /// Where nodes lie, by direction, told by their owners in the grid. Units: m
    std::array<Vector, dim> positions_of_nodes(
      const dealii::DoFHandler<3> &dofs,
      const BackgroundGrid &grid,
      const Lattice &lattice,
      const TensorShapes &shapes,
      const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner)
    {
      std::array<Vector, dim> positions;
      for (Vector &component : positions)
        component.reinit(partitioner);
      const auto order = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(shapes.degree());
      std::vector<Dof> cell_dofs(shapes.n_nodes());
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned() && cell->active_fe_index() != nothing)
        {
          const Box box = lattice.box(grid.place(cell->vertex(0), cell->level()));
          cell->get_dof_indices(cell_dofs);
          for (unsigned int k = 0; k < cell_dofs.size(); ++k)
            if (const Dof dof = cell_dofs[order[k]]; partitioner->in_local_range(dof))
            {
              const Point X = box.unit_to_real(shapes.node(k));
              for (unsigned int d = 0; d < dim; ++d)
                positions[d](dof) = X[d];
            }
        }
      for (Vector &component : positions)
        component.update_ghost_values();
      return positions;
    }
  } // namespace

  void Immersed::number_nodes(const BackgroundGrid &grid,
                              const std::vector<BackgroundGrid::Cell> &taken)
  {
    // cells beside the body have no nodes, so that none hangs on them
    dealii::DoFHandler<3> dofs(grid.triangulation());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        cell->set_active_fe_index(nothing);
    const auto cell_of = [&](const BackgroundGrid::Cell &cell) {
      return dealii::DoFHandler<3>::active_cell_iterator(&grid.triangulation(), cell.level,
                                                         cell.index, &dofs);
    };
    for (const BackgroundGrid::Cell &cell : taken)
      cell_of(cell)->set_active_fe_index(0);
    dofs.distribute_dofs(
      dealii::hp::FECollection<3>(dealii::FE_Q<3>(degree()), dealii::FE_Nothing<3>()));
    dealii::AffineConstraints<double> hanging;
    if (lattice_.coarsest_size > 1)
      hanging = hanging_nodes(dofs);

    // the degrees of freedom of each cell, along x first, and what hanging ones depend on
    const auto order = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(degree());
    std::vector<Dof> cell_dofs, own(shapes_.n_nodes()), unordered(own.size());
    for (unsigned int i = 0; i < cells_.size(); ++i)
    {
      cell_of(taken[i])->get_dof_indices(unordered);
      for (unsigned int k = 0; k < own.size(); ++k)
        own[k] = unordered[order[k]];

      cells_[i].first_node = cell_dofs.size();
      if (std::any_of(own.begin(), own.end(),
                      [&](const Dof dof) { return hanging.is_constrained(dof); }))
      {
        const auto [masters, factors] = condense(own, hanging);
        cell_dofs.insert(cell_dofs.end(), masters.begin(), masters.end());
        cells_[i].hanging = condensations_.size();
        condensations_.insert(condensations_.end(), factors.begin(), factors.end());
      }
      else
        cell_dofs.insert(cell_dofs.end(), own.begin(), own.end());
    }

    const std::vector<Dof> used = sorted(cell_dofs);
    const std::size_t n_cells = cells_.size(), n_condensations = condensations_.size(),
                      n_cell_dofs = cell_dofs.size();
    std::vector<Neighbours> neighbours;
    if (ghost_penalty_ > 0)
      neighbours = find_neighbours(grid, taken, cell_dofs);

    const std::vector<Dof> seen = sorted(cell_dofs);
    dealii::IndexSet seen_set(dofs.n_dofs());
    seen_set.add_indices(seen.begin(), seen.end());
    const auto dof_partitioner = std::make_shared<const Partitioner>(
      dofs.locally_owned_dofs(), seen_set, grid.triangulation().get_communicator());
    const std::array<Vector, dim> positions =
      positions_of_nodes(dofs, grid, lattice_, shapes_, dof_partitioner);

    const std::vector<unsigned int> local = share_nodes(used, seen, dof_partitioner);
    node_positions_.resize(seen.size());
    for (unsigned int i = 0; i < seen.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        node_positions_[local[i]][d] = positions[d](seen[i]);
    for (const Dof dof : cell_dofs)
      nodes_.push_back(local[std::lower_bound(seen.begin(), seen.end(), dof) - seen.begin()]);

    for (const Neighbours &pair : neighbours)
      ghost_faces_.push_back(make_ghost_face(pair));
    cells_.resize(n_cells); // without those of other ranks
    nodes_.resize(n_cell_dofs);
    condensations_.resize(n_condensations);
  }

  std::vector<unsigned int>
  Immersed::share_nodes(const std::vector<Dof> &used,
                        const std::vector<Dof> &seen,
                        const std::shared_ptr<const Partitioner> &dof_partitioner)
  {
    MPI_Comm communicator   = dof_partitioner->get_mpi_communicator();
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);

    // a node belongs to the lowest rank with an active cell on it
    Vector owner(dof_partitioner);
    const unsigned int nobody = dealii::Utilities::MPI::n_mpi_processes(communicator);
    owner                     = nobody;
    for (const Dof dof : seen) // ghost values too
      owner(dof) = nobody;
    for (const Dof dof : used)
      owner(dof) = rank;
    owner.compress(dealii::VectorOperation::min);
    owner.update_ghost_values();

    unsigned int n_owned = 0, offset = 0;
    for (const Dof dof : used)
      n_owned += owner(dof) == rank;
    MPI_Exscan(&n_owned, &offset, 1, MPI_UNSIGNED, MPI_SUM, communicator);
    const unsigned int n_all = dealii::Utilities::MPI::sum(n_owned, communicator);

    Vector number(dof_partitioner);
    unsigned int next = offset;
    for (const Dof dof : used)
      if (owner(dof) == rank)
        number(dof) = next++;
    number.compress(dealii::VectorOperation::add);
    number.update_ghost_values();

    std::vector<unsigned int> ghosts;
    for (const Dof dof : seen)
      if (owner(dof) != rank)
        ghosts.push_back(static_cast<unsigned int>(number(dof)));
    std::sort(ghosts.begin(), ghosts.end());

    dealii::IndexSet owned_unknowns(3 * n_all), ghost_unknowns(3 * n_all);
    owned_unknowns.add_range(3 * offset, 3 * (offset + n_owned));
    for (const unsigned int ghost : ghosts)
      ghost_unknowns.add_range(3 * ghost, 3 * ghost + 3);
    partitioner_ =
      std::make_shared<const Partitioner>(owned_unknowns, ghost_unknowns, communicator);

    std::vector<unsigned int> local;
    for (const Dof dof : seen)
      local.push_back(partitioner_->global_to_local(3 * static_cast<Dof>(number(dof))) / 3);
    return local;
  }
} // namespace softcell
