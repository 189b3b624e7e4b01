// SPDX-License-Identifier: LGPL-2.1-or-later
// The reference cell of a conforming mesh: its shapes, and its rules of integration.
#pragma once

#include <softcell/discretization/patch.h>

#include <deal.II/base/quadrature.h>
#include <deal.II/fe/fe.h>

#include <memory>
#include <vector>

namespace softcell
{
  /// What all faces of one number have in common.
  struct ReferenceFace
  {
    std::vector<unsigned int> nodes; // of the cell, that lie on the face
    Direction tangents[2];           // span the face; their cross product points outward
    Point centre;
    std::vector<Point> points;       // of the quadrature rule
    ShapeTable shapes, centre_shape; // at the points and at the centre
  };

  /// A tetrahedron or hexahedron with Lagrange shapes, in its own coordinates. Which rules it has
  /// is told at Fitted.
  struct ReferenceElement
  {
    /// @param n_corners 4 or 8
    /// @throws BadInput if there is no such element.
    ReferenceElement(unsigned int n_corners, unsigned int degree);

    bool is_tetrahedron() const
    {
      return element->reference_cell() == dealii::ReferenceCells::Tetrahedron;
    }
    unsigned int n_nodes() const
    {
      return shapes.n_nodes;
    }
    /// Shapes and their derivatives by the cell's own coordinates.
    ShapeTable shapes_at(const std::vector<Point> &points) const;

    std::unique_ptr<dealii::FiniteElement<3>> element;
    dealii::Quadrature<3> rule;
    dealii::Quadrature<2> face_rule;
    ShapeTable shapes; // at the rule's points
    std::vector<ReferenceFace> faces;

  private:
    ReferenceFace make_face(unsigned int number) const;
  };
} // namespace softcell
