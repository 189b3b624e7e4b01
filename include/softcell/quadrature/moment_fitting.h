// SPDX-License-Identifier: LGPL-2.1-or-later
// Moment fitting: few points that integrate a cut cell as the finite cell's many do.
#pragma once

#include <softcell/quadrature/compression.h>
#include <softcell/quadrature/cut_rule.h>
#include <softcell/quadrature/label_list.h>

namespace softcell
{
  /// (degree + 1)^3 points for each material of a cut cell, which integrate what FiniteCell
  /// integrates with its many at the same `levels` >= 1.
  ///
  /// Compression finds their places and weights. All weights are positive, all points lie in the
  /// box around those of FiniteCell, though not always in the body. At degree 1 nearly all cells
  /// get FiniteCell's volume, centroid and element matrices of small strain to rounding, and so its
  /// divergence theorem and patch test; large strain differs by what is beyond triquadratic.
  ///
  /// A cell in which FiniteCell has (degree + 1)^3 points or fewer keeps these. Like there, so few
  /// points can leave a motion without strain to a node that has no other cell. A cell for which
  /// the search finds no rule keeps all of FiniteCell's points.
  ///
  /// Costs: the octree of FiniteCell and the search once for each cell; then those of WeightedCell
  /// and the shapes at its points. Degrees 1 to 3.
  ///
  /// Source: moment fitting after Mueller, Kummer and Oberlack (2013), non-negative after Garhuom
  /// and Duester (2022), with points that move as in the node elimination of Xiao and Gimbutas
  /// (2010). Departure: the points are few from the start, and what they must integrate is no more
  /// than products of gradients.
  class MomentFitting : public CutRule
  {
  public:
    /// @throws BadInput for degrees beyond 3.
    MomentFitting(const CutParameters &parameters, unsigned int degree, const Body &body);

    double add(const Box &cell) override;
    bool has_cell_points() const override
    {
      return false;
    }
    /// The cells that keep all of FiniteCell's points, of one material at least.
    unsigned int n_failures() const override
    {
      return n_failures_;
    }
    void points(unsigned int index, CutPoints &result) const override;

  private:
    const Body &body_;
    const CutParameters parameters_;
    const unsigned int degree_;
    const Compression compression_;
    std::vector<Point> points_; // cell after cell
    std::vector<double> weights_;
    std::vector<std::size_t> starts_ = {0};
    LabelList labels_;
    unsigned int n_failures_ = 0;
  };
} // namespace softcell
