// SPDX-License-Identifier: LGPL-2.1-or-later
// What a cut-cell rule has to offer: points and weights in a partly filled box.
#pragma once

#include <softcell/base/types.h>
#include <softcell/geometry/body.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// Points of one cell in the unit cube, their weights (m^3) and material labels.
  struct CutPoints
  {
    std::vector<Point> points;
    std::vector<double> weights;
    std::vector<unsigned char> labels; // one per point, or a single one for all
  };

  /// How cut cells are integrated, and steadied where they hold little of the body. Declared in the
  /// section Discretization.
  struct CutParameters
  {
    unsigned int levels  = 3;   // halvings of a cut cell; 0 counts a cut cell as full (sparse grid)
    double alpha         = 0;   // stiffness of what is outside relative to the body's
    double spread        = 0.1; // part of a WeightedCell's volume that steadies it
    double ghost_penalty = 0;   // on jumps between cut cells and their neighbours

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Quadrature in cells that the body's boundary cuts, or an interface of labels.
  ///
  /// A rule is given the cut cells one after the other and keeps of each what it needs, in as
  /// little memory as it can, to give the points again whenever a tangent is assembled.
  class CutRule
  {
  public:
    virtual ~CutRule() = default;

    /// Takes in a cut cell and returns the volume that the rule sees filled (m^3).
    /// Cells are numbered in the order in which they are added.
    virtual double add(const Box &cell) = 0;

    /// True if the points are the cell's own Gauss points, in deal.II's order, whatever the cut:
    /// then all cells share one table of shapes and differ only in their weights.
    virtual bool has_cell_points() const = 0;

    /// What a cut cell costs relative to a full one whenever a tangent is assembled.
    virtual double work() const
    {
      return 1;
    }

    /// The cells for which the search for few points failed.
    virtual unsigned int n_failures() const
    {
      return 0;
    }

    /// The points of cell number `index`. Reuses the memory of `result`. If has_cell_points(), only
    /// weights and labels are filled.
    virtual void points(unsigned int index, CutPoints &result) const = 0;
  };

  /// The rules by the names that a parameter file gives them ("finite cell", "weighted cell",
  /// "moment fitting", "sparse grid").
  std::vector<std::string> cut_rule_names();

  /// @param degree of the cell's shape functions: its own Gauss points are (degree + 1)^3.
  std::unique_ptr<CutRule> make_cut_rule(const std::string &name,
                                         const CutParameters &parameters,
                                         unsigned int degree,
                                         const Body &body);
} // namespace softcell
