// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent on a graphics card.
#pragma once

#include <softcell/base/device.h>
#include <softcell/mechanics/material.h>
#include <softcell/operators/cell_bricks.h>
#include <softcell/operators/tangent.h>

namespace softcell
{
  /// What MatrixFreeElasticity does, on a device: Cuda, or Serial, which runs the same kernels on
  /// the host.
  ///
  /// Fields are those of a LatticeField, component after component, in the memory of the device.
  /// Nothing is added to by two threads at once: a brick's cells leave their forces in what the
  /// brick's threads share, its nodes sum them up, and a second kernel sums up the bricks at each
  /// node, always in the same order.
  template <class Real, class Device>
  class CudaElasticity
  {
  public:
    using Field = DeviceArray<Real, Device>;

    CudaElasticity(const CellBricks<Real> &bricks, const Material &material);

    /// Entries of a component.
    std::size_t n_entries() const
    {
      return n_entries_;
    }

    /// Products and residuals are 0 in these unknowns from now on, whatever x or u is there.
    /// @param held  (n_entries()) bits: components that are not free.
    void hold(const std::vector<unsigned char> &held);

    /// r = the internal force. Units: N. @throws InvertedPoint
    void residual(const Field &u, Field &r);

    /// Takes the displacement at which the tangent is formed. Call it before the functions below.
    /// @throws InvertedPoint
    void set_state(const Field &u, Tangent tangent = Tangent::exact);

    /// Takes another tangent at the same displacement.
    void set_tangent(Tangent tangent);

    /// y = K x, with the tangent K = d residual / du. Units: N/m
    void vmult(Field &y, const Field &x);

    /// The same, but an action gets what y would be in held unknowns too, see NodeKernel; for
    /// sources that define kernels.
    template <class Action>
    void vmult(const Field &x, const Action &at_nodes);

    /// The diagonal blocks of the tangent, those of LatticeBlocks. Units: N/m
    void diagonal(Field &blocks);

  private:
    template <class Action>
    void run_cells(const Action &action);
    void run_tangents(const Field &x);
    template <class Action>
    void run_nodes(const Action &action);

    Material material_;
    std::size_t n_entries_, row_, plane_;
    Real spacing_[3];
    DeviceArray<int, Device> entries_, weight_packs_;
    Field weights_;
    DeviceArray<typename CellBricks<Real>::NodeBrick, Device> node_bricks_;
    DeviceArray<unsigned char, Device> held_;
    Field u_, pressures_,                 // (bricks, 8, n_cells) lambda v, where v is costly
      added_moduli_;                      // the same, to lambda, of a definite tangent
    Field sums_;                          // (6, bricks, n_corners)
    DeviceArray<int, Device> n_inverted_; // (bricks) points
  };

  extern template class CudaElasticity<double, Cuda>;
  extern template class CudaElasticity<float, Cuda>;
  extern template class CudaElasticity<double, Serial>;
  extern template class CudaElasticity<float, Serial>;
} // namespace softcell
