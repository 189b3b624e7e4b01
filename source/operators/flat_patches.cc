// SPDX-License-Identifier: LGPL-2.1-or-later
// The patches of any discretization as flat arrays.

#include <softcell/operators/flat_patches.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <experimental/simd>

namespace softcell
{
  template <class Real>
  const unsigned int FlatPatches<Real>::pack_width = std::experimental::native_simd<Real>::size();

  template <class Real>
  FlatPatches<Real>::FlatPatches(const Discretization &discretization,
                                 const unsigned int width,
                                 const unsigned int spare)
      : n_nodes_(discretization.node_positions().size()),
        points_(width, spare),
        nodes_(width, spare)
  {
    if (const unsigned int n =
          dealii::Utilities::MPI::n_mpi_processes(discretization.communicator());
        n > 1)
      throw BadInput("The matrix-free operator runs on one rank, and there are " +
                     std::to_string(n) + "; start the program without mpirun.");
    add_points(discretization);
    make_node_rows();
    points_.forget_changes();
    nodes_.forget_changes();
  }

  template <class Real>
  void FlatPatches<Real>::add_points(const Discretization &discretization)
  {
    const unsigned int W = points_.width();
    PatchStorage storage;
    unsigned int lane = W; // of the next point in the last batch
    for (unsigned int i = 0; i < discretization.n_patches(); ++i)
    {
      const Patch patch    = discretization.patch(i, storage);
      const unsigned int n = patch.n_nodes();
      for (unsigned int q = 0; q < patch.n_points(); ++q)
      {
        if (patch.weights[q] == 0)
          continue;
        if (lane == W || labels_.back() != patch.label(q))
        {
          lane = 0;
          labels_.push_back(patch.label(q));
          points_.add_batch(n);
          weights_.resize(weights_.size() + W, Real(0));
        }
        points_.make_room(n);
        const std::size_t row = (labels_.size() - 1) * W + lane++;
        weights_[row]         = patch.weights[q];
        for (unsigned int k = 0; k < n; ++k)
        {
          Real gradient[3];
          for (unsigned int d = 0; d < dim; ++d)
            gradient[d] = patch.shapes->gradient(q)[d * n + k];
          points_.append(row, patch.nodes[k], gradient);
        }
      }
    }
  }

  template <class Real>
  void FlatPatches<Real>::make_node_rows()
  {
    const unsigned int W      = points_.width();
    const auto for_each_entry = [&](const auto &f) {
      const RowArrays<Real> rows = points_.arrays();
      for (std::size_t b = 0; b < rows.n_batches; ++b)
        for (std::size_t pack = rows.starts[b]; pack < rows.starts[b + 1]; ++pack)
          for (unsigned int lane = 0; lane < W; ++lane)
          {
            const Real *const g = &rows.gradients[pack * 3 * W + lane];
            if (g[0] != 0 || g[W] != 0 || g[2 * W] != 0)
              f(rows.numbers[pack * W + lane], 9 * W * b + lane, g);
          }
    };
    std::vector<unsigned int> lengths((n_nodes_ + W - 1) / W * W, 0);
    for_each_entry([&](const unsigned int node, std::size_t, const Real *) { ++lengths[node]; });
    for (auto batch = lengths.begin(); batch != lengths.end(); batch += W)
      nodes_.add_batch(*std::max_element(batch, batch + W));
    for_each_entry([&](const unsigned int node, const std::size_t point, const Real *const g) {
      nodes_.append(node, point, g, W);
    });
  }

  template <class Real>
  bool FlatPatches<Real>::change(const std::size_t row,
                                 const Real weight,
                                 const std::vector<unsigned int> &nodes,
                                 const std::vector<Real> &gradients)
  {
    const unsigned int W     = points_.width();
    const std::size_t number = row / W * 9 * W + row % W;
    if (nodes.size() > points_.room(row))
      return false;
    for (const unsigned int node : nodes)
      if (!nodes_.has(node, number) && nodes_.length(node) == nodes_.room(node))
        return false;
    points_.clear(row, [&](const unsigned int node) { nodes_.remove(node, number); });
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      points_.append(row, nodes[k], &gradients[3 * k]);
      nodes_.append(nodes[k], number, &gradients[3 * k]);
    }
    weights_[row] = weight;
    return true;
  }

  template <class Real>
  RowChanges<Real> FlatPatches<Real>::take_changes()
  {
    RowChanges<Real> changes;
    points_.take_changes(changes, weights_.data());
    nodes_.take_changes(changes, nullptr);
    return changes;
  }

  template <class Real>
  FlatArrays<Real> FlatPatches<Real>::arrays() const
  {
    return {points_.width(), n_nodes_,        points_.arrays(),
            nodes_.arrays(), weights_.data(), labels_.data()};
  }

  template <class Real>
  typename FlatPatches<Real>::PointBatch FlatPatches<Real>::point_batch(const std::size_t b) const
  {
    const unsigned int W       = points_.width();
    const RowArrays<Real> rows = points_.arrays();
    const std::size_t first    = rows.starts[b];
    return {labels_[b], rows.lengths[b], rows.numbers + first * W, rows.gradients + first * 3 * W,
            weights_.data() + b * W};
  }

  template <class Real>
  typename FlatPatches<Real>::NodeBatch FlatPatches<Real>::node_batch(const std::size_t b) const
  {
    const unsigned int W       = nodes_.width();
    const RowArrays<Real> rows = nodes_.arrays();
    const std::size_t first    = rows.starts[b];
    return {rows.lengths[b], rows.numbers + first * W, rows.gradients + first * 3 * W};
  }

  template <class Real>
  std::size_t FlatPatches<Real>::memory() const
  {
    return points_.memory() + nodes_.memory() + weights_.size() * sizeof(Real);
  }

  template class FlatPatches<double>;
  template class FlatPatches<float>;
} // namespace softcell
