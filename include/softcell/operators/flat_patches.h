// SPDX-License-Identifier: LGPL-2.1-or-later
// The patches of any discretization as flat arrays.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/operators/padded_rows.h>

#include <deal.II/base/aligned_vector.h>

#include <vector>

namespace softcell
{
  /// All integration points of a discretization, each with its weight, its row of nodes and their
  /// gradients; and all nodes, each with its row of points.
  ///
  /// Points, and nodes, are kept in batches of W whose rows are equally long (PaddedRows); entries
  /// that only fill up have the gradient 0, and points that do so the weight 0. A batch has points
  /// of one label. Batches of nodes let a node sum up what its points have for it, so that no two
  /// threads write to the same place.
  template <class Real>
  class FlatPatches
  {
  public:
    static const unsigned int pack_width; // of the host

    /// @param width  W; card_width for a graphics card.
    /// @param spare  entries that rows have room for beyond the longest one in their batch.
    /// @throws BadInput if there are several ranks.
    explicit FlatPatches(const Discretization &discretization,
                         unsigned int width = pack_width,
                         unsigned int spare = 0);

    /// Gives a point another weight and other nodes, and these the point.
    /// @param row  W b + lane of its batch b.
    /// @param gradients  (nodes, 3) Units: 1/m
    /// @return false if a row has no room; then nothing has changed.
    bool change(std::size_t row,
                Real weight,
                const std::vector<unsigned int> &nodes,
                const std::vector<Real> &gradients);

    /// The rows that have changed since the last call.
    RowChanges<Real> take_changes();

    FlatArrays<Real> arrays() const;

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
      return nodes_.n_batches();
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
    PaddedRows<Real> points_, nodes_; // their rows of nodes and of points
    std::vector<unsigned int> labels_;
    dealii::AlignedVector<Real> weights_;
  };
} // namespace softcell
