// SPDX-License-Identifier: LGPL-2.1-or-later
// Lagrange shapes reproduce polynomials.

#include <softcell/discretization/tensor_shapes.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  TEST(TensorShapes, InterpolatePolynomialsOfTheirDegreeExactly)
  {
    const Direction size({0.5, 2, 0.1});
    const std::vector<Point> points = {Point(0.2, 0.7, 0.4), Point(-0.3, 1.1, 0.9)};
    for (unsigned int degree = 1; degree <= 4; ++degree)
    {
      const TensorShapes shapes(degree);
      ASSERT_EQ(shapes.n_nodes(), std::pow(degree + 1, 3));
      // x^degree y z^degree in the unit cube
      const auto f = [&](const Point &X) {
        return std::pow(X[0], degree) * X[1] * std::pow(X[2], degree);
      };
      ShapeTable table;
      shapes.evaluate(points, size, table);
      for (unsigned int q = 0; q < points.size(); ++q)
      {
        double value = 0;
        Direction gradient;
        for (unsigned int i = 0; i < shapes.n_nodes(); ++i)
        {
          value += table.value(q)[i] * f(shapes.node(i));
          for (unsigned int d = 0; d < 3; ++d)
            gradient[d] += table.gradient(q)[d * shapes.n_nodes() + i] * f(shapes.node(i));
        }
        const Point &X = points[q];
        EXPECT_NEAR(value, f(X), 1e-13);
        EXPECT_NEAR(gradient[0], degree * f(X) / X[0] / size[0], 1e-12);
        EXPECT_NEAR(gradient[1], f(X) / X[1] / size[1], 1e-12);
        EXPECT_NEAR(gradient[2], degree * f(X) / X[2] / size[2], 1e-11);
      }
    }
  }

  TEST(TensorShapes, AreOneAtTheirOwnNode)
  {
    const TensorShapes shapes(3);
    std::vector<Point> nodes;
    for (unsigned int i = 0; i < shapes.n_nodes(); ++i)
      nodes.push_back(shapes.node(i));
    ShapeTable table;
    shapes.evaluate(nodes, Direction({1, 1, 1}), table);
    for (unsigned int q = 0; q < nodes.size(); ++q)
      for (unsigned int i = 0; i < nodes.size(); ++i)
        EXPECT_NEAR(table.value(q)[i], q == i, 1e-14);
  }
} // namespace softcell
