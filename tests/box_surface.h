// SPDX-License-Identifier: LGPL-2.1-or-later
// The surface of a box with a corner at the origin, twelve triangles for n = 1.
#pragma once

#include <softcell/geometry/surface.h>

#include <cmath>
#include <map>

namespace softcell
{
  /// Each side is divided into n x n squares of two triangles; all in patch 0.
  inline Surface box_surface(const Point &size, const unsigned int n)
  {
    std::map<std::array<unsigned int, 3>, unsigned int> numbers;
    std::vector<Point> vertices;
    const auto vertex = [&](const std::array<unsigned int, 3> &at) {
      const auto [entry, is_new] = numbers.emplace(at, vertices.size());
      if (is_new)
        vertices.emplace_back(size[0] * at[0] / n, size[1] * at[1] / n, size[2] * at[2] / n);
      return entry->second;
    };
    std::vector<Surface::Triangle> triangles;
    for (unsigned int axis = 0; axis < 3; ++axis)
      for (const unsigned int side : {0u, n})
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
          {
            std::array<unsigned int, 4> corners; // counter-clockwise seen from +axis
            for (unsigned int k = 0; k < 4; ++k)
            {
              std::array<unsigned int, 3> at;
              at[axis]           = side;
              at[(axis + 1) % 3] = i + (k == 1 || k == 2);
              at[(axis + 2) % 3] = j + (k >= 2);
              corners[k]         = vertex(at);
            }
            if (side == 0)
              std::swap(corners[1], corners[3]);
            triangles.push_back({{corners[0], corners[1], corners[2]}});
            triangles.push_back({{corners[0], corners[2], corners[3]}});
          }
    return Surface(std::move(vertices), std::move(triangles));
  }

  /// A box whose sides lie across all axes, each of them a patch.
  inline Surface turned_box_surface(const Point &size)
  {
    const Surface box = box_surface(size, 1);
    std::vector<Point> vertices;
    for (const Point &X : box.vertices())
      vertices.push_back(
        Point(2 * X[0] - 2 * X[1] + X[2], 2 * X[0] + X[1] - 2 * X[2], X[0] + 2 * X[1] + 2 * X[2]) /
        3);
    std::vector<unsigned int> patches;
    for (unsigned int t = 0; t < box.triangles().size(); ++t)
      patches.push_back(t / 2);
    return Surface(vertices, box.triangles(), patches);
  }
} // namespace softcell
