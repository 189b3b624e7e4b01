// SPDX-License-Identifier: LGPL-2.1-or-later
// The few types that every folder shares. Lengths are in metres throughout.
#pragma once

#include <deal.II/base/array_view.h>
#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <deal.II/lac/la_parallel_vector.h>

namespace softcell
{
  constexpr int dim = 3;

  using Point       = dealii::Point<3>;
  using Direction   = dealii::Tensor<1, 3>;
  using Box         = dealii::BoundingBox<3>;
  using Partitioner = dealii::Utilities::MPI::Partitioner;

  /// Values of the unknowns: 3 * node + component, this rank's nodes first and its ghost nodes
  /// after them.
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  template <class T>
  using View = dealii::ArrayView<T>;
} // namespace softcell
