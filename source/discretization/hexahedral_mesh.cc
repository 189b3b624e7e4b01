// SPDX-License-Identifier: LGPL-2.1-or-later
// Hexahedral meshes of the two shapes that have a natural one.

#include <softcell/discretization/hexahedral_mesh.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    /// Extrudes quadrilaterals (four corners in deal.II's order, counterclockwise seen from above).
    Mesh extrude(const std::vector<dealii::Point<2>> &points,
                 const std::vector<unsigned int> &quadrilaterals,
                 const double length,
                 const unsigned int layers)
    {
      Mesh mesh;
      mesh.corners_per_cell = 8;
      for (unsigned int k = 0; k <= layers; ++k)
        for (const auto &p : points)
          mesh.vertices.emplace_back(p[0], p[1], k * length / layers);
      for (unsigned int k = 0; k < layers; ++k)
        for (std::size_t q = 0; q < quadrilaterals.size(); q += 4)
          for (const unsigned int level : {k, k + 1})
            for (unsigned int v = 0; v < 4; ++v)
              mesh.corners.push_back(level * points.size() + quadrilaterals[q + v]);
      return mesh;
    }

    /// Adds a lattice of quadrilaterals over points numbered j * (n0 + 1) + i.
    void add_lattice(std::vector<unsigned int> &quadrilaterals,
                     const unsigned int n0,
                     const unsigned int n1)
    {
      for (unsigned int j = 0; j < n1; ++j)
        for (unsigned int i = 0; i < n0; ++i)
        {
          const unsigned int v = j * (n0 + 1) + i;
          quadrilaterals.insert(quadrilaterals.end(), {v, v + 1, v + n0 + 1, v + n0 + 2});
        }
    }
  } // namespace

  Mesh hexahedral_box(const Point &size, const std::array<unsigned int, 3> &n)
  {
    std::vector<dealii::Point<2>> points;
    std::vector<unsigned int> quadrilaterals;
    for (unsigned int j = 0; j <= n[1]; ++j)
      for (unsigned int i = 0; i <= n[0]; ++i)
        points.emplace_back(i * size[0] / n[0], j * size[1] / n[1]);
    add_lattice(quadrilaterals, n[0], n[1]);
    return extrude(points, quadrilaterals, size[2], n[2]);
  }

  Mesh hexahedral_cylinder(const double radius,
                           const double length,
                           const unsigned int across,
                           const unsigned int along)
  {
    Assert(across >= 3, dealii::ExcInternalError());
    const unsigned int rings = (across + 2) / 4, core = across - 2 * rings;
    const unsigned int around = 4 * core;
    // A core of half the diameter keeps the corners of its square well away from the circle.
    const double half = radius * std::min(std::max(double(core) / across, 0.4), 0.6);

    std::vector<dealii::Point<2>> points;
    std::vector<unsigned int> quadrilaterals;
    for (unsigned int j = 0; j <= core; ++j)
      for (unsigned int i = 0; i <= core; ++i)
        points.emplace_back(half * (2. * i / core - 1), half * (2. * j / core - 1));
    add_lattice(quadrilaterals, core, core);

    // Point m of ring 0 is on the edge of the core, counterclockwise from its lower left corner.
    const auto point_of_ring = [&](const unsigned int ring, unsigned int m) -> unsigned int {
      m %= around;
      if (ring > 0)
        return (core + 1) * (core + 1) + (ring - 1) * around + m;
      const unsigned int q = m % core, row = core + 1;
      switch (m / core)
      {
        case 0:
          return q;
        case 1:
          return q * row + core;
        case 2:
          return core * row + core - q;
        default:
          return (core - q) * row;
      }
    };
    for (unsigned int ring = 1; ring <= rings; ++ring)
      for (unsigned int m = 0; m < around; ++m)
      {
        const double t     = double(ring) / rings;
        const double angle = (2. * m / around - 0.75) * dealii::numbers::PI;
        const dealii::Point<2> rim(radius * std::cos(angle), radius * std::sin(angle));
        points.push_back(dealii::Point<2>((1 - t) * points[point_of_ring(0, m)] + t * rim));
      }
    for (unsigned int ring = 0; ring < rings; ++ring)
      for (unsigned int m = 0; m < around; ++m)
        for (const unsigned int n : {m, m + 1})
          for (const unsigned int r : {ring, ring + 1})
            quadrilaterals.push_back(point_of_ring(r, n));

    Mesh mesh          = extrude(points, quadrilaterals, length, along);
    mesh.mantle_radius = radius;
    return mesh;
  }
} // namespace softcell
