// SPDX-License-Identifier: LGPL-2.1-or-later
// The patches of any discretization as flat arrays.
#pragma once

#include <softcell/discretization/discretization.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace softcell
{
  /// All integration points of a discretization, each with its weight, its row of nodes and their
  /// gradients; and all nodes, each with its row of points.
  ///
  /// Points, and nodes, are kept in batches of W (the width of a pack of Real) whose rows are
  /// equally long; entries that only fill up have the gradient 0, and points that do so the weight
  /// 0. A batch has points of one label. Batches of nodes let a node sum up what its points have
  /// for it, so that no two threads write to the same place. Source: Magnoux fig. 6.3.
  template <class Real>
  class FlatPatches
  {
  public:
    /// @throws BadInput if there are several ranks.
    explicit FlatPatches(const Discretization &discretization);

    /// Point number 9 W b + lane of batch b is that of the first of nine packs of an array
    /// (n_point_batches, 9, W), as which its F and stress are kept.
    struct PointBatch
    {
      unsigned int label;
      unsigned int length;       // of the rows
      const unsigned int *nodes; // (length, W)
      const Real *gradients;     // (length, 3, W) Units: 1/m
      const Real *weights;       // (W) Units: m^3
    };

    /// The nodes from number W b on in batch b.
    struct NodeBatch
    {
      unsigned int length;
      const unsigned int *points; // (length, W) their numbers
      const Real *gradients;      // (length, 3, W) of the node at the point. Units: 1/m
    };

    std::size_t n_point_batches() const
    {
      return labels_.size();
    }
    std::size_t n_node_batches() const
    {
      return node_starts_.size() - 1;
    }
    unsigned int n_nodes() const
    {
      return n_nodes_;
    }
    PointBatch point_batch(std::size_t b) const;
    NodeBatch node_batch(std::size_t b) const;
    /// Units: byte
    std::size_t memory() const;

  private:
    void add_points(const Discretization &discretization);
    void make_node_rows();

    unsigned int n_nodes_;
    std::vector<unsigned int> labels_;
    std::vector<std::size_t> point_starts_ = {0}; // (n_point_batches + 1) of rows, in packs
    std::vector<std::size_t> node_starts_  = {0}; // (n_node_batches + 1) likewise
    std::vector<unsigned int> nodes_, points_;
    dealii::AlignedVector<Real> point_gradients_, node_gradients_, weights_;
  };
} // namespace softcell
