// SPDX-License-Identifier: LGPL-2.1-or-later
// The finite cell rule: Gauss points on the leaves of an octree.
#pragma once

#include <softcell/quadrature/cut_rule.h>
#include <softcell/quadrature/label_list.h>
#include <softcell/quadrature/octree.h>

#include <deal.II/base/quadrature.h>

#include <cmath>
#include <cstdint>

namespace softcell
{
  /// Quadrature by recursive halving of a cut cell.
  ///
  /// The cell K is halved `levels` >= 1 times towards the boundary of the body B. A leaf inside B
  /// gets the (degree + 1)^3 Gauss rule; of a leaf that is still cut at the last level, the Gauss
  /// points inside B count. Weights are positive.
  /// The volume error of a cell is at most the volume of the cut leaves, O(2^-levels) |K|, and
  /// their number is O(4^levels). Kept are the leaves, four bytes each, and the inside points of a
  /// cut leaf, one bit each. Source: Brunet sec. 4.4, eq. 4.6-4.8.
  class FiniteCell : public CutRule
  {
  public:
    FiniteCell(const CutParameters &parameters, unsigned int degree, const Body &body);

    double add(const Box &cell) override;
    bool has_cell_points() const override
    {
      return false;
    }
    double work() const override
    {
      return std::pow(4., parameters_.levels);
    }
    void points(unsigned int index, CutPoints &result) const override;

  private:
    /// A cell, and where its leaves begin.
    struct Cell
    {
      Point lower;
      Direction size;
      std::size_t full, cut;
    };

    void add_cut_leaf(const Box &leaf, LeafCode code, double &volume);
    bool is_inside(const std::size_t cut_leaf, const unsigned int point) const
    {
      return masks_[cut_leaf * mask_bytes_ + point / 8] >> point % 8 & 1;
    }
    /// Fills points and weights.
    void place_points(const Cell &cell, const Cell &next, CutPoints &result) const;

    const Body &body_;
    const CutParameters parameters_;
    const dealii::Quadrature<3> gauss_;
    const std::size_t mask_bytes_;
    std::vector<Cell> cells_; // and one past the end
    std::vector<LeafCode> full_, cut_;
    std::vector<unsigned char> masks_; // (n_cut, mask_bytes_)
    LabelList labels_;
  };
} // namespace softcell
