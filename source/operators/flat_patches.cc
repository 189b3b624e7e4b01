// SPDX-License-Identifier: LGPL-2.1-or-later
// The patches of any discretization as flat arrays.

#include <softcell/operators/flat_patches.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <experimental/simd>

namespace softcell
{
  namespace
  {
    template <class Real>
    constexpr unsigned int batch_width = std::experimental::native_simd<Real>::size();
  }

  template <class Real>
  FlatPatches<Real>::FlatPatches(const Discretization &discretization)
      : n_nodes_(discretization.node_positions().size())
  {
    if (const unsigned int n =
          dealii::Utilities::MPI::n_mpi_processes(discretization.communicator());
        n > 1)
      throw BadInput("The matrix-free operator runs on one rank, and there are " +
                     std::to_string(n) + "; start the program without mpirun.");
    add_points(discretization);
    make_node_rows();
  }

  template <class Real>
  void FlatPatches<Real>::add_points(const Discretization &discretization)
  {
    constexpr unsigned int W = batch_width<Real>;
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
          point_starts_.push_back(point_starts_.back());
          weights_.resize(weights_.size() + W, Real(0));
        }
        const std::size_t first = point_starts_.end()[-2];
        if (first + n > point_starts_.back())
        {
          point_starts_.back() = first + n;
          nodes_.resize((first + n) * W, patch.nodes[0]);
          point_gradients_.resize((first + n) * 3 * W, Real(0));
        }
        for (unsigned int k = 0; k < n; ++k)
        {
          nodes_[(first + k) * W + lane] = patch.nodes[k];
          for (unsigned int d = 0; d < dim; ++d)
            point_gradients_[((first + k) * 3 + d) * W + lane] =
              patch.shapes->gradient(q)[d * n + k];
        }
        weights_[(labels_.size() - 1) * W + lane] = patch.weights[q];
        ++lane;
      }
    }
  }

  template <class Real>
  void FlatPatches<Real>::make_node_rows()
  {
    constexpr unsigned int W  = batch_width<Real>;
    const auto for_each_entry = [&](const auto &f) {
      for (std::size_t b = 0; b < labels_.size(); ++b)
        for (std::size_t pack = point_starts_[b]; pack < point_starts_[b + 1]; ++pack)
          for (unsigned int lane = 0; lane < W; ++lane)
          {
            const Real *const g = &point_gradients_[pack * 3 * W + lane];
            if (weights_[b * W + lane] != 0 && (g[0] != 0 || g[W] != 0 || g[2 * W] != 0))
              f(nodes_[pack * W + lane], 9 * W * b + lane, g);
          }
    };

    std::vector<unsigned int> lengths((n_nodes_ + W - 1) / W * W, 0);
    for_each_entry([&](const unsigned int node, std::size_t, const Real *) { ++lengths[node]; });
    for (auto batch = lengths.begin(); batch != lengths.end(); batch += W)
      node_starts_.push_back(node_starts_.back() + *std::max_element(batch, batch + W));
    points_.resize(node_starts_.back() * W, 0);
    node_gradients_.resize(node_starts_.back() * 3 * W, Real(0));

    std::fill(lengths.begin(), lengths.end(), 0);
    for_each_entry([&](const unsigned int node, const std::size_t point, const Real *const g) {
      const std::size_t pack       = node_starts_[node / W] + lengths[node]++;
      points_[pack * W + node % W] = point;
      for (unsigned int d = 0; d < dim; ++d)
        node_gradients_[(pack * 3 + d) * W + node % W] = g[d * W];
    });
  }

  template <class Real>
  typename FlatPatches<Real>::PointBatch FlatPatches<Real>::point_batch(const std::size_t b) const
  {
    constexpr unsigned int W = batch_width<Real>;
    const std::size_t first  = point_starts_[b];
    return {labels_[b], static_cast<unsigned int>(point_starts_[b + 1] - first),
            nodes_.data() + first * W, point_gradients_.data() + first * 3 * W,
            weights_.data() + b * W};
  }

  template <class Real>
  typename FlatPatches<Real>::NodeBatch FlatPatches<Real>::node_batch(const std::size_t b) const
  {
    constexpr unsigned int W = batch_width<Real>;
    const std::size_t first  = node_starts_[b];
    return {static_cast<unsigned int>(node_starts_[b + 1] - first), points_.data() + first * W,
            node_gradients_.data() + first * 3 * W};
  }

  template <class Real>
  std::size_t FlatPatches<Real>::memory() const
  {
    return (nodes_.size() + points_.size()) * sizeof(unsigned int) +
           (point_gradients_.size() + node_gradients_.size() + weights_.size()) * sizeof(Real);
  }

  template class FlatPatches<double>;
  template class FlatPatches<float>;
} // namespace softcell
