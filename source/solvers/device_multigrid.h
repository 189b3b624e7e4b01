// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaMultigrid for any device; what instantiates it includes this.
#pragma once

#include "../operators/device_elasticity.h"
#include "entry_kernels.h"
#include "multigrid_kernels.h"

#include <softcell/base/exceptions.h>
#include <softcell/solvers/cuda_multigrid.h>
#include <softcell/solvers/lanczos.h>

namespace softcell
{
  template <class Real, class Device>
  struct CudaMultigrid<Real, Device>::Level
  {
    Level(const CardLevel<Real> &grid, const Material &material, const unsigned int smoother_degree)
        : degree(smoother_degree),
          tangent(grid.bricks, material),
          held(grid.held),
          rough_field(grid.rough_field),
          inverse_diagonal(6 * held.size()),
          x(3 * held.size()),
          r(x.size()),
          d(x.size()),
          cg(x.size()),
          nodes{{grid.n_nodes[0], grid.n_nodes[1], grid.n_nodes[2]},
                int(grid.bricks.row),
                int(grid.bricks.plane),
                held.size(),
                held.data(),
                inverse_diagonal.data(),
                x.data(),
                d.data(),
                r.data()}
    {
      tangent.hold(grid.held);
    }

    unsigned int degree; // of the smoother
    CudaElasticity<Real, Device> tangent;
    DeviceArray<unsigned char, Device> held;
    Field<Real> rough_field, inverse_diagonal, x, r, d;
    CudaCG<Real, Device> cg;
    SmootherNodes<Real> nodes;
    Real largest_eigenvalue = 1; // of the inverse diagonal times the tangent

    /// The factors of d and of D^-1 r in a step of the smoother.
    Real share(const unsigned int step) const
    {
      return Real(2 * step - 1.) / (2 * step + 3);
    }
    Real factor(const unsigned int step) const
    {
      return 1 / largest_eigenvalue * (8 * step + 4) / (2 * step + 3);
    }

    template <class Action>
    void for_each_entry(const Action &action) const
    {
      softcell::for_each_entry<Device>(action, nodes.n_entries);
    }
  };

  template <class Real, class Device>
  CudaMultigrid<Real, Device>::CudaMultigrid(const CellLattice &cells,
                                             const Material &material,
                                             const std::vector<std::size_t> &held,
                                             unsigned int degree)
      : grids_(cells, held),
        coarsest_entries_(grids_.coarsest_entries()),
        coarsest_inverse_(coarsest_entries_.size() * coarsest_entries_.size())
  {
    for (unsigned int l = 0; l < grids_.size(); ++l, degree *= 2)
    {
      const CardLevel<Real> grid = grids_.level(l);
      levels_.push_back(std::make_unique<Level>(grid, material.definite(), degree));
      if (l == 0)
        held_ = grid.held;
    }
  }

  template <class Real, class Device>
  CudaMultigrid<Real, Device>::~CudaMultigrid() = default;

  template <class Real, class Device>
  template <class Number>
  void CudaMultigrid<Real, Device>::set_state(const Field<Number> &u, const Tangent smoother)
  {
    smoother_ = levels_.size() > 1 ? smoother : Tangent::definite;
    recorded_cycle_.clear();
    std::vector<Number> numbers(u.size());
    u.copy_to(numbers.data());
    std::vector<Real> state(numbers.begin(), numbers.end());
    levels_[0]->tangent.set_state(Field<Real>(state), smoother_);
    for (unsigned int l = 1; l < levels_.size(); ++l)
    {
      state = grids_.coarse(l - 1, state);
      try
      {
        levels_[l]->tangent.set_state(Field<Real>(state), Tangent::definite);
      }
      catch (const InvertedPoint &)
      {
        levels_[l]->tangent.set_state(Field<Real>(state.size()), Tangent::definite);
      }
    }
    for (unsigned int l = 0; l + 1 < levels_.size(); ++l)
      estimate_eigenvalue(*levels_[l], l == 0 ? smoother_ : Tangent::definite);
    invert_coarsest();
  }

  template <class Real, class Device>
  void CudaMultigrid<Real, Device>::set_smoother(const Tangent tangent)
  {
    if (levels_.size() == 1 || tangent == smoother_)
      return;
    recorded_cycle_.clear();
    smoother_ = tangent;
    levels_[0]->tangent.set_tangent(tangent);
    estimate_eigenvalue(*levels_[0], tangent);
  }

  template <class Real, class Device>
  void CudaMultigrid<Real, Device>::estimate_eigenvalue(Level &level, const Tangent tangent)
  {
    level.tangent.diagonal(level.inverse_diagonal);
    level.for_each_entry(
      InvertAction<Real>{level.nodes.n_entries, level.held.data(), level.inverse_diagonal.data()});
    const auto K = [&](auto &y, const auto &x) { level.tangent.vmult(y, x); };
    const auto D = [&](auto &z, const auto &r) {
      SmootherNodes<Real> nodes = level.nodes;
      nodes.r                   = r.data();
      nodes.d                   = z.data();
      level.for_each_entry(PreconditionAction<Real>{nodes});
    };
    level.cg.iterate(K, D, level.d, level.rough_field, 0, n_eigenvalue_steps,
                     tangent == Tangent::exact);
    const double largest = level.cg.largest_eigenvalue();
    if (!(largest > 0))
      throw NotConverged("geometric multigrid met a grid whose tangent is not positive definite");
    level.largest_eigenvalue = eigenvalue_margin * largest;
  }

  template <class Real, class Device>
  void CudaMultigrid<Real, Device>::invert_coarsest()
  {
    Level &level = *levels_.back();
    std::vector<int> entries(coarsest_entries_.size());
    coarsest_entries_.copy_to(entries.data());
    std::vector<Real> unit(level.d.size()), column(unit.size());
    std::vector<double> matrix;
    for (const int j : entries)
    {
      unit[j] = 1;
      level.d.copy_from(unit.data());
      unit[j] = 0;
      level.tangent.vmult(level.r, level.d);
      level.r.copy_to(column.data());
      for (const int i : entries)
        matrix.push_back(column[i]);
    }
    coarsest_inverse_.copy_from(symmetric_inverse(matrix).data());
  }

  /// Adds to x what lessens r = b - K x, but for the last d. The first d is there.
  template <class Real, class Device>
  void CudaMultigrid<Real, Device>::smooth(Level &level)
  {
    for (unsigned int k = 1; k < level.degree; ++k)
      level.tangent.vmult(level.d,
                          SmoothAction<Real>{level.nodes, level.share(k), level.factor(k)});
  }

  /// Adds to x of a level what lessens its r. The smoother's first d is there.
  template <class Real, class Device>
  void CudaMultigrid<Real, Device>::cycle(const unsigned int l)
  {
    Level &level = *levels_[l];
    if (l + 1 == levels_.size())
    {
      const int n = coarsest_entries_.size();
      Device::launch(CoarsestKernel<Real>{n, coarsest_entries_.data(), coarsest_inverse_.data(),
                                          level.r.data(), level.x.data()},
                     n);
      return;
    }
    const Level &coarse = *levels_[l + 1];
    smooth(level);
    level.tangent.vmult(level.d, SmoothAction<Real>{level.nodes, 0, 0});
    coarse.for_each_entry(RestrictAction<Real>{coarse.nodes, level.nodes, coarse.factor(0)});
    cycle(l + 1);
    level.for_each_entry(InterpolateAction<Real>{level.nodes, coarse.nodes});
    level.tangent.vmult(level.d, SmoothAction<Real>{level.nodes, 0, level.factor(0)});
    smooth(level);
    softcell::for_each_entry<Device>(AddAction<Real>{level.d.data(), level.x.data()},
                                     level.x.size()); // r is no longer needed
  }

  template <class Real, class Device>
  template <class Number>
  void CudaMultigrid<Real, Device>::vmult(Field<Number> &y, const Field<Number> &x)
  {
    Level &level = *levels_[0];
    level.for_each_entry(StartAction<Real, Number>{level.nodes, x.data(), level.factor(0)});
    recorded_cycle_.run([&] { cycle(0); });
    for_each_entry<Device>(ConvertAction<Number, Real>{level.x.data(), y.data()}, y.size());
  }
} // namespace softcell
