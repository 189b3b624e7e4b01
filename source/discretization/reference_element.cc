// SPDX-License-Identifier: LGPL-2.1-or-later
// The reference cell of a conforming mesh: its shapes, and its rules of integration.

#include "reference_element.h"

#include <softcell/base/exceptions.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>

#include <cmath>

namespace softcell
{
  using namespace dealii;

  ReferenceElement::ReferenceElement(const unsigned int n_corners, const unsigned int degree)
  {
    if (degree < 1 || (n_corners == 4 && degree > 2))
      throw BadInput("Discretization/Degree = " + std::to_string(degree) +
                     ": tetrahedra are available with degree 1 and 2, hexahedra from degree 1.");
    if (n_corners == 4)
    {
      element   = std::make_unique<FE_SimplexP<3>>(degree);
      rule      = degree == 1 ? Quadrature<3>(QGaussSimplex<3>(1))
                              : QWitherdenVincentSimplex<3>(1, /*odd order*/ false);
      face_rule = QWitherdenVincentSimplex<2>(degree + 1);
    }
    else
    {
      element   = std::make_unique<FE_Q<3>>(QIterated<1>(QTrapezoid<1>(), degree));
      rule      = QGauss<3>(degree + 1);
      face_rule = QGauss<2>(degree + 1);
    }
    shapes = shapes_at(rule.get_points());
    for (const unsigned int number : element->reference_cell().face_indices())
      faces.push_back(make_face(number));
  }

  ShapeTable ReferenceElement::shapes_at(const std::vector<Point> &points) const
  {
    ShapeTable table;
    const unsigned int n = element->n_dofs_per_cell();
    table.resize(points.size(), n);
    for (unsigned int q = 0; q < points.size(); ++q)
      for (unsigned int i = 0; i < n; ++i)
      {
        table.values[q * n + i] = element->shape_value(i, points[q]);
        const Direction dN      = element->shape_grad(i, points[q]);
        for (unsigned int d = 0; d < 3; ++d)
          table.gradients[(q * 3 + d) * n + i] = dN[d];
      }
    return table;
  }

  ReferenceFace ReferenceElement::make_face(const unsigned int number) const
  {
    const ReferenceCell cell = element->reference_cell();
    Point corners[3];
    for (unsigned int v = 0; v < 3; ++v)
      corners[v] = cell.vertex<3>(cell.face_to_cell_vertices(number, v, 1));

    ReferenceFace result;
    result.tangents[0] = corners[1] - corners[0];
    result.tangents[1] = corners[2] - corners[0];
    if (cross_product_3d(result.tangents[0], result.tangents[1]) *
          (corners[0] - cell.barycenter<3>()) <
        0)
      std::swap(result.tangents[0], result.tangents[1]);

    const auto place = [&](const dealii::Point<2> &p) {
      return corners[0] + p[0] * result.tangents[0] + p[1] * result.tangents[1];
    };
    for (const auto &p : face_rule.get_points())
      result.points.push_back(place(p));
    result.shapes       = shapes_at(result.points);
    result.centre       = place(cell.face_reference_cell(number).barycenter<2>());
    result.centre_shape = shapes_at({result.centre});

    const Direction normal = cross_product_3d(result.tangents[0], result.tangents[1]);
    const auto &nodes      = element->get_unit_support_points();
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (std::abs((nodes[i] - corners[0]) * normal) < 1e-10)
        result.nodes.push_back(i);
    return result;
  }
} // namespace softcell
