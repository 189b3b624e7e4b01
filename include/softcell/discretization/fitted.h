// SPDX-License-Identifier: LGPL-2.1-or-later
// Finite elements on conforming meshes: tetrahedra P1, P2 and hexahedra Q1, Q2, ...
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/discretization/mesh.h>
#include <softcell/geometry/body.h>

#include <memory>
#include <vector>

namespace softcell
{
  struct FittedCells;

  /// Isoparametric Lagrange elements, one patch per cell (Brunet, ch. 2).
  ///
  /// Nodes lie on the cell's lattice of equidistant points. Tetrahedra stay straight at degree 2;
  /// hexahedra follow the mantle of a cylinder. Cells are distributed by METIS; a node belongs to
  /// the lowest rank that touches it.
  ///
  /// Integration: one point for P1, whose strains are constant (so that N u is exact, N u u is
  /// not); four points for P2, exact for degree 2, which is all that products of strains need and
  /// the fewest that leave no mode without stiffness; (p + 1)^3 Gauss points for hexahedra of
  /// degree p. On the boundary the rule is exact for degree 2 p + 1.
  ///
  /// Shapes are stored on the reference cell alone. A patch's gradients are made when it is asked
  /// for: that is one 3 x 3 inverse a point, little next to a tangent, and saves up to 20 kB a
  /// cell.
  ///
  /// surface_patches() and nodes_on() are collective and throw BadInput if the region holds no
  /// boundary face.
  class Fitted : public Discretization
  {
  public:
    /// Takes the same mesh on all ranks. The body tells the labels of cells (at their centres) and,
    /// unless the mesh does, the patches of boundary faces. Collective.
    /// @throws BadInput if there is no such element.
    Fitted(MPI_Comm communicator, const Mesh &mesh, unsigned int degree, const Body &body);
    ~Fitted() override;

    Size size() const override;
    unsigned int degree() const override;
    unsigned int n_patches() const override;
    Patch patch(unsigned int i, PatchStorage &storage) const override;
    void patch_points(unsigned int i, std::vector<Point> &points) const override;
    std::vector<SurfacePatch> surface_patches(const Region &region) const override;
    std::optional<std::vector<unsigned int>> nodes_on(const Region &region) const override;
    std::optional<PointShapes> shapes_at(const Point &X, double reach) const override;
    Box owned_box() const override;
    DrawnCells drawn_cells() const override;

  private:
    std::unique_ptr<FittedCells> cells_;
  };
} // namespace softcell
