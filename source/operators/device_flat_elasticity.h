// SPDX-License-Identifier: LGPL-2.1-or-later
// CudaFlatElasticity for any device; what instantiates it includes this.
#pragma once

#include "flat_kernels.h"
#include "inverted_points.h"

#include <softcell/base/device_launch.h>
#include <softcell/operators/cuda_flat_elasticity.h>

#include <cstring>

namespace softcell
{
  template <class T, class Device>
  DeviceArray<T, Device> on_device(const T *const values, const std::size_t size)
  {
    DeviceArray<T, Device> result(size);
    result.copy_from(values);
    return result;
  }

  template <class Real, class Device>
  CudaFlatElasticity<Real, Device>::Rows::Rows(const RowArrays<Real> &rows,
                                               const unsigned int width)
      : starts(on_device<unsigned int, Device>(rows.starts, rows.n_batches + 1)),
        lengths(on_device<unsigned int, Device>(rows.lengths, rows.n_batches)),
        numbers(on_device<unsigned int, Device>(rows.numbers,
                                                std::size_t(rows.starts[rows.n_batches]) * width)),
        gradients(on_device<Real, Device>(rows.gradients, 3 * numbers.size()))
  {
  }

  template <class Real, class Device>
  RowArrays<Real> CudaFlatElasticity<Real, Device>::Rows::arrays() const
  {
    return {lengths.size(), starts.data(), lengths.data(), numbers.data(), gradients.data()};
  }

  template <class Real, class Device>
  CudaFlatElasticity<Real, Device>::CudaFlatElasticity(const FlatArrays<Real> &patches,
                                                       const std::vector<Material> &materials)
      : materials_(materials),
        n_nodes_(patches.n_nodes),
        points_(patches.points, patches.width),
        nodes_(patches.nodes, patches.width),
        weights_(on_device<Real, Device>(patches.weights, patches.points.n_batches * card_width)),
        pressures_(weights_.size()),
        F_(9 * weights_.size()),
        stresses_(F_.size()),
        n_inverted_(weights_.size())
  {
    std::vector<std::vector<unsigned int>> batches(materials.size());
    for (unsigned int b = 0; b < patches.points.n_batches; ++b)
      batches[patches.labels[b]].push_back(b);
    for (const auto &own : batches)
      batches_.emplace_back(own);
  }

  template <class Real, class Device>
  void CudaFlatElasticity<Real, Device>::change(const RowChanges<Real> &changes)
  {
    using Kernel = ChangeKernel<Real>;
    using Row    = typename Kernel::Row;
    if (changes.rows.empty())
      return;
    std::vector<char> parcel;
    const auto pack = [&](const auto &values) { // returns where they are
      const std::size_t at = parcel.size(), n = values.size() * sizeof(values[0]);
      parcel.resize(at + n);
      std::memcpy(parcel.data() + at, values.data(), n);
      return at;
    };
    const std::size_t rows = pack(changes.rows), gradients = pack(changes.gradients),
                      numbers = pack(changes.numbers);
    if (parcel_.size() < parcel.size())
      parcel_ = DeviceArray<char, Device>(2 * parcel.size());
    Device::copy(parcel_.data(), parcel.data(), parcel.size());
    const auto target = [](const Rows &to) {
      return typename Kernel::Target{to.lengths.data(), to.numbers.data(), to.gradients.data()};
    };
    Device::launch(Kernel{reinterpret_cast<const Row *>(parcel_.data() + rows),
                          reinterpret_cast<const unsigned int *>(parcel_.data() + numbers),
                          reinterpret_cast<const Real *>(parcel_.data() + gradients),
                          target(points_), target(nodes_), weights_.data()},
                   changes.rows.size());
  }

  template <class Real, class Device>
  template <template <class, class> class Action>
  void CudaFlatElasticity<Real, Device>::run_points(const Real *const x)
  {
    const PointData<Real> data{weights_.data(), F_.data(), stresses_.data(), pressures_.data(),
                               n_inverted_.data()};
    for (std::size_t label = 0; label < materials_.size(); ++label)
      if (batches_[label].size() > 0)
        materials_[label].visit([&](const auto &double_law) {
          const auto law = rounded<Real>(double_law);
          Device::launch(
            PointKernel<Real, std::decay_t<decltype(law)>, Action>{
              law,
              data,
              points_.arrays(),
              batches_[label].data(),
              {{x, x + n_nodes_, x + 2 * n_nodes_}}},
            batches_[label].size());
        });
  }

  template <class Real, class Device>
  void CudaFlatElasticity<Real, Device>::sum_up(Field &y) const
  {
    Device::launch(
      StressSumKernel<Real>{nodes_.arrays(),
                            stresses_.data(),
                            n_nodes_,
                            {{y.data(), y.data() + n_nodes_, y.data() + 2 * n_nodes_}}},
      nodes_.lengths.size());
  }

  template <class Real, class Device>
  void CudaFlatElasticity<Real, Device>::set_state(const Field &u)
  {
    run_points<StateAction>(u.data());
    throw_if_inverted(n_inverted_);
  }

  template <class Real, class Device>
  void CudaFlatElasticity<Real, Device>::residual(Field &r)
  {
    run_points<FlatResidualAction>(r.data());
    sum_up(r);
  }

  template <class Real, class Device>
  void CudaFlatElasticity<Real, Device>::vmult(Field &y, const Field &x)
  {
    run_points<FlatTangentAction>(x.data());
    sum_up(y);
  }
} // namespace softcell
