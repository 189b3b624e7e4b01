// SPDX-License-Identifier: LGPL-2.1-or-later
// Hexahedra of a background grid on a body that cuts them.
#pragma once

#include <softcell/discretization/background_grid.h>
#include <softcell/discretization/discretization.h>
#include <softcell/discretization/tensor_shapes.h>
#include <softcell/quadrature/cut_rule.h>
#include <softcell/quadrature/label_list.h>

#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace softcell
{
  /// Finite cell, weighted cell, moment fitting, sparse grid: hexahedra of a background grid whose
  /// cut cells are integrated by a cut-cell rule.
  ///
  /// Active are the cells of which the body, or the rule, fills something; only their nodes carry
  /// unknowns. Full cells of a size share one table of shapes and one set of weights; a rule with
  /// the cell's own points gives each cut cell weights of its own, some of which may be 0; all
  /// other points are placed and their shapes evaluated when a patch is asked for. In a cell with
  /// hanging nodes the shapes are condensed to those of the nodes that they hang on. Source: Brunet
  /// sec. 4.3-4.6.
  class Immersed : public Discretization
  {
  public:
    /// @param rule  one of cut_rule_names().
    /// @param body  must outlive the object.
    /// @throws BadInput if the grid is too coarse to see the body, or too fine for the memory.
    /// Collective.
    Immersed(const std::string &rule,
             unsigned int degree,
             const GridParameters &grid,
             const CutParameters &cut,
             const Body &body,
             MPI_Comm communicator,
             const Refinement &refinement = {});
    ~Immersed() override;

    Size size() const override;
    unsigned int degree() const override
    {
      return shapes_.degree();
    }
    unsigned int n_patches() const override
    {
      return cells_.size();
    }
    Patch patch(unsigned int i, PatchStorage &storage) const override;
    /// Of a cut cell its own Gauss points, whose weights are alpha times that of the whole cell
    /// times the part that is not filled: so every motion of the cell that strains it meets some
    /// resistance.
    Patch fictitious_patch(unsigned int i, PatchStorage &storage) const override;
    /// Their energy is M/2 * gamma / h^2 int |u_1 - u_2|^2 dV over both cells, u_k their
    /// polynomials, each with its own h across the face; a cell shares itself out to four of half
    /// its size. At degree 1 that is M/2 * gamma * 2/3 h int |jump of du/dn|^2 dA, h the mean, of
    /// Burman (C. R. Math. 348, 2010); for any degree Lehrenfeld and Olshanskii (ESAIM: M2AN 53,
    /// 2019). The label of M is the body's midway between the centres of the cells.
    View<const GhostFace> ghost_faces() const override
    {
      return {ghost_faces_.data(), ghost_faces_.size()};
    }
    std::vector<unsigned int> patch_nodes(unsigned int i) const override
    {
      return {nodes(i).begin(), nodes(i).end()};
    }
    void patch_points(unsigned int i, std::vector<Point> &points) const override;

    /// A piece outside the active cells goes to the nearest one, extended.
    /// @throws BadInput if no triangle is in the region, or more than a thousandth of its area is
    /// farther than a cell from all active ones. On all ranks or none.
    std::vector<SurfacePatch> surface_patches(const Region &region) const override;
    std::optional<std::vector<unsigned int>> nodes_on(const Region &region) const override;
    std::optional<PointShapes> shapes_at(const Point &X, double reach) const override;
    Box owned_box() const override;
    DrawnCells drawn_cells() const override;
    std::optional<UniformGrid> uniform_grid() const override;

  private:
    static constexpr unsigned int none = -1;

    struct Cell
    {
      Lattice::Cell place;
      unsigned int cut        = none; // number in the rule, none for a full cell
      double cut_fraction     = 1;    // that the rule sees filled
      unsigned int first_node = 0;    // in nodes_, where those of the next cell follow
      std::size_t hanging     = -1;   // in condensations_, if the cell has hanging nodes
      bool has_hanging() const
      {
        return hanging != std::size_t(-1);
      }
    };

    /// A part of a boundary triangle that a cell of this rank takes.
    struct Piece
    {
      unsigned int cell, triangle;
      std::vector<Point> corners; // of a convex polygon
    };

    /// Two cells with a face in common, the first of them not larger than the second.
    struct Neighbours
    {
      unsigned int first, second, axis;
    };

    /// The grid's cells of which the rule sees something.
    std::vector<BackgroundGrid::Cell> take_cells(const BackgroundGrid &grid, MPI_Comm communicator);
    void number_nodes(const BackgroundGrid &grid, const std::vector<BackgroundGrid::Cell> &taken);
    /// Numbers and shares out the nodes of active cells: fills partitioner_.
    /// @param used  the grid's degrees of freedom in this rank's active cells, sorted.
    /// @param seen  these and those of other ranks' cells that it knows of, sorted.
    /// @return the local node numbers of the latter.
    std::vector<unsigned int>
    share_nodes(const std::vector<dealii::types::global_dof_index> &used,
                const std::vector<dealii::types::global_dof_index> &seen,
                const std::shared_ptr<const Partitioner> &dof_partitioner);

    /// The active cells that share a face of which one at least is partly filled. Those of other
    /// ranks are put behind this rank's in cells_, with their degrees of freedom in cell_dofs.
    std::vector<Neighbours>
    find_neighbours(const BackgroundGrid &grid,
                    const std::vector<BackgroundGrid::Cell> &taken,
                    std::vector<dealii::types::global_dof_index> &cell_dofs);
    GhostFace make_ghost_face(const Neighbours &neighbours) const;
    void make_tables();
    View<const unsigned int> nodes(unsigned int cell) const;

    /// Shapes of a cell's nodes at points of its unit cube.
    void evaluate(unsigned int cell, const std::vector<Point> &points, ShapeTable &table) const;

    /// This rank's active cell at a place, none if there is none.
    unsigned int owned_cell(const Lattice::Cell &place) const;
    /// Distance of a point from a cell, 0 inside. Units: m
    double distance(const Point &X, const Lattice::Cell &cell) const;

    std::vector<unsigned int> triangles_of(const Region &region) const;
    /// The pieces of these triangles in this rank's cells.
    /// @param lost  area beyond reach of all active cells, the same on all ranks. Units: m^2
    std::vector<Piece> pieces(const std::vector<unsigned int> &triangles, double &lost) const;
    /// Is this cell without parts an active one of any rank?
    bool is_active(const Lattice::Cell &place) const;
    /// The active cell nearest to X of those no farther from a place than its own size.
    std::optional<Lattice::Cell> nearest_active(const Lattice::Cell &place, const Point &X) const;
    /// The nodes of a cell's face on the plane of a triangle, nothing if that is no face of the
    /// cell.
    std::optional<std::vector<unsigned int>> face_nodes(const Piece &piece) const;

    const Body &body_;
    const double alpha_, ghost_penalty_;
    TensorShapes shapes_;
    std::unique_ptr<CutRule> rule_;
    Lattice lattice_;

    std::vector<Cell> cells_;
    std::vector<GhostFace> ghost_faces_;
    std::vector<unsigned int> nodes_;   // local numbers, cell after cell
    std::vector<double> condensations_; // (own nodes of the cell, n_nodes of the patch)
    std::vector<Point> gauss_points_;   // of the unit cube
    std::vector<double> gauss_weights_;
    std::vector<ShapeTable> tables_;           // by binary logarithm of the cell's size
    std::vector<std::vector<double>> weights_; // of full cells, likewise
    LabelList labels_;                         // at the cells' own points

    std::unordered_map<std::uint64_t, unsigned int> cell_of_; // by Lattice::key()
    std::unordered_set<std::uint64_t> everyones_cut_cells_;
  };
} // namespace softcell
