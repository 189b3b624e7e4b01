// SPDX-License-Identifier: LGPL-2.1-or-later
// The weighted cell rule: the cell's own Gauss points, weighted by what is filled around them.
#pragma once

#include <softcell/quadrature/cut_rule.h>
#include <softcell/quadrature/label_list.h>

#include <deal.II/base/quadrature.h>

namespace softcell
{
  /// The (degree + 1)^3 Gauss points of the cell, each weight times the filled fraction v of the
  /// point's part.
  ///
  /// The one-dimensional Gauss weights, laid end to end, part the unit interval; their products
  /// part the cell into one box per point, with the point in it and the point's weight as its
  /// volume: at degree 1, the cell's octants. The fraction is what the octree of `levels` halvings
  /// counts, so that the volume of a cell is at degree 1 that of FiniteCell. A weight may be 0. A
  /// point takes the label of most of what fills its part. With 0 levels all that holds some of the
  /// body counts as full: the sparse grid.
  ///
  /// A cell in which less than half of the points have a weight worth the name, a tenth of the
  /// largest, is a mechanism: the nodes that it shares with no other cell have motions without
  /// strain at its points, which its own weight sets going. There the part `spread` of the filled
  /// volume goes evenly to all points, which leaves the cell's volume as it is. Departure: Brunet's
  /// rule has no such spreading; `spread` = 0 is his. A tenth moves the tip of the bent cylinder of
  /// fig. 4.6 by at most 0.06 % at 4 to 8 cells across; without it, prm/liver.prm at 14 cells
  /// across finds no equilibrium under the organ's weight.
  ///
  /// Accuracy: the points stay where they are however the cell is cut, so that products of
  /// gradients are not integrated exactly, at any number of levels. In a linear cube that lies
  /// across all axes, under the tractions of a linear displacement, strains are off by 13 % (L2) at
  /// 4 cells across and 8 % at 8; FiniteCell has less than 1 % there at 4 levels.
  ///
  /// Source: Brunet sec. 4.5, eq. 4.12-4.13 with v as a fraction, and p. 110 on the sparse
  /// grid.
  class WeightedCell : public CutRule
  {
  public:
    WeightedCell(const CutParameters &parameters, unsigned int degree, const Body &body);

    double add(const Box &cell) override;
    bool has_cell_points() const override
    {
      return true;
    }
    void points(unsigned int index, CutPoints &result) const override;

    /// Spreads the part `spread` of what fills a cell over its points, if it is a mechanism.
    /// @param fractions  of the points, or weights where they share the cell equally.
    /// @param mean       of the fractions over the cell.
    static void steady(View<double> fractions, double mean, double spread);

  private:
    /// The filled fraction of a point's part, and the label of most of that.
    struct Filled
    {
      double fraction;
      unsigned char label;
    };
    Filled filled(const Box &part, const Point &gauss_point) const;
    const Body &body_;
    const CutParameters parameters_;
    const dealii::Quadrature<3> gauss_;
    std::vector<Box> parts_;      // of the unit cube, one per Gauss point
    std::vector<double> weights_; // (n_cells, n_points)
    LabelList labels_;
  };
} // namespace softcell
