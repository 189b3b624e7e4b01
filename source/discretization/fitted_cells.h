// SPDX-License-Identifier: LGPL-2.1-or-later
// Geometry of a conforming mesh's cells and boundary faces.
#pragma once

#include "reference_element.h"

#include <softcell/discretization/discretization.h>
#include <softcell/discretization/mesh.h>
#include <softcell/geometry/body.h>

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/numerics/rtree.h>

#include <utility>
#include <vector>

namespace softcell
{
  /// The cells of this rank as maps of one reference element, and those of their faces that lie on
  /// the boundary.
  struct FittedCells
  {
    struct Face
    {
      unsigned int cell, number, patch;
      Point centre;
      Direction normal;
    };

    /// How far outside a cell a point still counts as inside, in the cell's coordinates.
    static constexpr double round_off = 1e-10;

    const ReferenceElement reference;

    std::vector<unsigned int> nodes;                  // (n_cells, n_nodes)
    std::vector<unsigned char> labels;                // (n_cells)
    std::vector<Face> faces;                          // on the boundary
    dealii::RTree<std::pair<Box, unsigned int>> tree; // of cells
    Size size;
    Box owned_box, box;
    unsigned int n_faces = 0; // on the boundary, of all ranks
    const std::vector<Point> &positions;

    FittedCells(const Mesh &mesh,
                const unsigned int degree,
                const std::vector<Point> &node_positions)
        : reference(mesh.corners_per_cell, degree), positions(node_positions)
    {
    }

    unsigned int n_nodes() const
    {
      return reference.n_nodes();
    }
    View<const unsigned int> nodes_of(const unsigned int cell) const
    {
      return View<const unsigned int>(nodes.data() + std::size_t(cell) * n_nodes(), n_nodes());
    }
    Point position(const View<const unsigned int> &cell, const double *N) const;
    /// Mean of its nodes.
    Point centre(unsigned int cell) const;
    /// J_cd = dX_c / dxi_d
    dealii::Tensor<2, 3> jacobian(const View<const unsigned int> &cell, const double *dN) const;
    /// dN/dX from dN/dxi, both (3, n_nodes).
    void transform(const dealii::Tensor<2, 3> &J, const double *dN, double *gradients) const;

    /// Finds the faces of the triangulation's boundary, cell after cell.
    /// @param patches_known  does the triangulation tell the patches of faces, or the body?
    void add_faces(const dealii::parallel::shared::Triangulation<3> &triangulation,
                   const Body &body,
                   bool patches_known);
    /// Boxes and numbers of what was added. @throws BadInput for cells without volume. Collective.
    void measure(MPI_Comm communicator);
    /// @throws BadInput if the region holds no face of any rank. Collective.
    std::vector<const Face *> faces_in(const Region &region, MPI_Comm communicator) const;
    SurfacePatch surface_patch(const Face &face) const;
    /// Reference coordinates of X in a cell (Newton), and how far X is outside, measured from the
    /// point of the cell whose reference coordinates are nearest to those.
    std::pair<Point, double> locate(unsigned int cell, const Point &X) const;

  private:
    /// Normal times what the face's tangents span.
    Direction area_vector(const View<const unsigned int> &cell,
                          const ReferenceFace &face,
                          const double *dN) const;
    double volume(unsigned int cell) const;
  };
} // namespace softcell
