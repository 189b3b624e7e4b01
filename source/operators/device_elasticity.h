// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaElasticity for any device; what instantiates it includes this.
#pragma once

#include "brick_kernels.h"
#include "inverted_points.h"
#include "node_kernels.h"

#include <softcell/base/device_launch.h>
#include <softcell/operators/cuda_elasticity.h>

namespace softcell
{
  template <class Real, class Device>
  CudaElasticity<Real, Device>::CudaElasticity(const CellBricks<Real> &bricks,
                                               const Material &material)
      : material_(material),
        n_entries_(bricks.n_entries),
        row_(bricks.row),
        plane_(bricks.plane),
        spacing_{bricks.spacing[0], bricks.spacing[1], bricks.spacing[2]},
        entries_(bricks.entries),
        weight_packs_(bricks.weight_packs),
        weights_(bricks.weights),
        node_bricks_(bricks.node_bricks),
        u_(3 * n_entries_),
        sums_(6 * entries_.size() * bricks.n_corners),
        n_inverted_(entries_.size())
  {
    material_.visit([&](const auto &law) {
      if (has_costly_pressure<std::decay_t<decltype(law)>>)
        pressures_ = Field(8 * bricks.n_cells * entries_.size());
    });
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::hold(const std::vector<unsigned char> &held)
  {
    held_ = DeviceArray<unsigned char, Device>(held);
  }

  template <class Real>
  Components<const Real> components(const Real *const field, const std::size_t n_entries)
  {
    return {{field, field + n_entries, field + 2 * n_entries}};
  }

  template <class Real, class Device>
  template <class Action>
  void CudaElasticity<Real, Device>::run_cells(const Action &action)
  {
    CellGeometry<Real> geometry;
    for (int v = 0; v < 8; ++v)
      geometry.corners[v] = v % 2 + row_ * (v / 2 % 2) + plane_ * (v / 4);
    geometry.weight = spacing_[0] * spacing_[1] * spacing_[2] / 8;
    for (int d = 0; d < 3; ++d)
      geometry.scale[d] = 1 / (4 * spacing_[d]);
    Device::launch(BrickKernel<Real, Action>{geometry, action, int(row_), int(plane_),
                                             int(entries_.size()), entries_.data(),
                                             weight_packs_.data(), weights_.data(), sums_.data(),
                                             n_inverted_.data()},
                   entries_.size());
  }

  template <class Real, class Device>
  template <class Action>
  void CudaElasticity<Real, Device>::run_nodes(const Action &action)
  {
    Device::launch(NodeKernel<Real, Action>{int(row_), int(plane_), int(entries_.size()),
                                            node_bricks_.data(), sums_.data(), action},
                   node_bricks_.size());
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::residual(const Field &u, Field &r)
  {
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      run_cells(ResidualAction<Real, std::decay_t<decltype(law)>>{
        law, components<Real>(u.data(), n_entries_)});
    });
    run_nodes(StoreAction<Real, 3>{n_entries_, held_.data(), r.data()});
    throw_if_inverted(n_inverted_);
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::set_state(const Field &u, const Tangent tangent)
  {
    u_.copy_from(u);
    set_tangent(tangent);
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::set_tangent(const Tangent tangent)
  {
    if (tangent == Tangent::exact)
      added_moduli_ = Field();
    else if (added_moduli_.size() != pressures_.size())
      added_moduli_ = Field(pressures_.size());
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      run_cells(ModuliAction<Real, std::decay_t<decltype(law)>>{
        law, components<Real>(u_.data(), n_entries_), {pressures_.data(), added_moduli_.data()}});
    });
    throw_if_inverted(n_inverted_);
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::run_tangents(const Field &x)
  {
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      run_cells(TangentAction<Real, std::decay_t<decltype(law)>>{
        law,
        components<Real>(u_.data(), n_entries_),
        components<Real>(x.data(), n_entries_),
        {pressures_.data(), added_moduli_.data()}});
    });
  }

  template <class Real, class Device>
  template <class Action>
  void CudaElasticity<Real, Device>::vmult(const Field &x, const Action &at_nodes)
  {
    run_tangents(x);
    run_nodes(at_nodes);
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::vmult(Field &y, const Field &x)
  {
    vmult(x, StoreAction<Real, 3>{n_entries_, held_.data(), y.data()});
  }

  template <class Real, class Device>
  void CudaElasticity<Real, Device>::diagonal(Field &blocks)
  {
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      run_cells(DiagonalAction<Real, std::decay_t<decltype(law)>>{
        law, components<Real>(u_.data(), n_entries_), {pressures_.data(), added_moduli_.data()}});
    });
    run_nodes(StoreAction<Real, 6>{n_entries_, held_.data(), blocks.data()});
  }
} // namespace softcell
