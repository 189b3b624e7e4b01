// SPDX-License-Identifier: LGPL-2.1-or-later
// Closed surfaces of known shape for the tests of geometry.
#pragma once

#include <softcell/geometry/surface.h>

#include <map>

namespace softcell::testing
{
  /// The corners (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1).
  inline Surface tetrahedron()
  {
    return Surface({Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1)},
                   {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  }

  /// A box of twelve triangles; patch d is the lower and patch 3 + d the upper side along d.
  inline Surface brick(const Point &lower = Point(), const Point &upper = Point(1, 1, 1))
  {
    std::vector<Point> vertices;
    for (unsigned int v = 0; v < 8; ++v)
      vertices.emplace_back((v & 1 ? upper : lower)[0], (v & 2 ? upper : lower)[1],
                            (v & 4 ? upper : lower)[2]);
    return Surface(std::move(vertices),
                   {{0, 4, 6},
                    {0, 6, 2},
                    {0, 1, 5},
                    {0, 5, 4},
                    {0, 2, 3},
                    {0, 3, 1},
                    {1, 3, 7},
                    {1, 7, 5},
                    {2, 6, 7},
                    {2, 7, 3},
                    {4, 5, 7},
                    {4, 7, 6}},
                   {0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5});
  }

  /// An octahedron refined n times with its vertices on the sphere: 8 * 4^n triangles.
  inline Surface
  sphere(const unsigned int n, const double radius = 1, const Point &centre = Point())
  {
    std::vector<Point> vertices              = {{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
    std::vector<Surface::Triangle> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (unsigned int i = 0; i < n; ++i)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> middles;
      const auto middle = [&](const unsigned int a, const unsigned int b) {
        const auto [entry, is_new] = middles.emplace(std::minmax(a, b), vertices.size());
        if (is_new)
        {
          const Direction sum = vertices[a] + (vertices[b] - Point());
          vertices.emplace_back(sum / sum.norm());
        }
        return entry->second;
      };
      std::vector<Surface::Triangle> finer;
      for (const auto &[a, b, c] : triangles)
      {
        const unsigned int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
      }
      triangles = std::move(finer);
    }
    for (Point &vertex : vertices)
      vertex = centre + radius * (vertex - Point());
    return Surface(std::move(vertices), std::move(triangles));
  }

  /// Calls f for n^3 equal boxes that tile the given one.
  template <class F>
  void for_each_cell(const Box &box, const unsigned int n, const F &f)
  {
    const auto [lower, upper] = box.get_boundary_points();
    const auto corner         = [&, lower = lower, upper = upper](
                          const unsigned int i, const unsigned int j, const unsigned int k) {
      Point X;
      unsigned int index[3] = {i, j, k};
      for (unsigned int d = 0; d < 3; ++d)
        X[d] = index[d] == n ? upper[d] : lower[d] + (upper[d] - lower[d]) * index[d] / n;
      return X;
    };
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int k = 0; k < n; ++k)
          f(Box({corner(i, j, k), corner(i + 1, j + 1, k + 1)}));
  }

  inline double polygon_area(const std::vector<Point> &polygon)
  {
    Direction sum;
    for (unsigned int i = 2; i < polygon.size(); ++i)
      sum += 0.5 * cross_product_3d(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return sum.norm();
  }
} // namespace softcell::testing
