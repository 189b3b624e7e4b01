// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body on flat patches and their tangent on a graphics card.
#pragma once

#include <softcell/base/device.h>
#include <softcell/mechanics/material.h>
#include <softcell/operators/flat_arrays.h>

#include <vector>

namespace softcell
{
  /// What FlatElasticity does, on a device: Cuda, or Serial, which runs the same kernels on the
  /// host. Rows of the patches may change.
  ///
  /// Fields are component after component, (3, n_nodes), in the memory of the device. A batch of
  /// points or of nodes is a block of threads that read and write side by side.
  template <class Real, class Device>
  class CudaFlatElasticity
  {
  public:
    using Field = DeviceArray<Real, Device>;

    /// @param patches    of FlatPatches with the width card_width; not needed any more afterwards.
    /// @param materials  one per label.
    CudaFlatElasticity(const FlatArrays<Real> &patches, const std::vector<Material> &materials);

    /// Sends the rows that FlatPatches has changed, at once. Then call set_state().
    void change(const RowChanges<Real> &changes);

    /// Takes the displacement at which everything else is formed. @throws InvertedPoint
    void set_state(const Field &u);

    /// r = the internal force. Units: N
    void residual(Field &r);

    /// y = K x, with the tangent K = d residual / du. Units: N/m
    void vmult(Field &y, const Field &x);

  private:
    struct Rows
    {
      explicit Rows(const RowArrays<Real> &rows, unsigned int width);
      RowArrays<Real> arrays() const;

      DeviceArray<unsigned int, Device> starts, lengths, numbers;
      Field gradients;
    };

    template <template <class, class> class Action>
    void run_points(const Real *x);
    void sum_up(Field &y) const;

    std::vector<Material> materials_;
    std::vector<DeviceArray<unsigned int, Device>> batches_; // of points, by label
    unsigned int n_nodes_;
    Rows points_, nodes_;
    Field weights_, pressures_;           // (batches of points, width)
    Field F_, stresses_;                  // (batches of points, 9, width)
    DeviceArray<int, Device> n_inverted_; // (batches of points, width)
    DeviceArray<char, Device> parcel_;    // of changed rows
  };
} // namespace softcell
