// SPDX-License-Identifier: LGPL-2.1-or-later
// Classification and filled volumes of boxes in bodies bounded by triangles.

#include <softcell/base/exceptions.h>
#include <softcell/geometry/surface_body.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <tuple>

#include "shapes.h"

using namespace softcell;
using namespace softcell::testing;

namespace
{
  /// Sum of the filled volumes of n^3 boxes, and whether classification agrees with each of them.
  double sum_of_filled_volumes(const Body &body, const Box &box, const unsigned int n)
  {
    double sum = 0;
    for_each_cell(box, n, [&](const Box &cell) {
      const double fraction = body.filled_volume(cell) / cell.volume();
      sum += fraction * cell.volume();
      switch (body.classify(cell))
      {
        case Side::inside:
          EXPECT_NEAR(fraction, 1, 1e-8);
          break;
        case Side::outside:
          EXPECT_NEAR(fraction, 0, 1e-8);
          break;
        case Side::cut:
          EXPECT_LE(fraction, 1);
          EXPECT_GE(fraction, 0);
      }
    });
    return sum;
  }

  /// Cubes around the origin, each with half its edge and the one patch of its triangles.
  Surface cubes(const std::vector<std::pair<double, unsigned int>> &list)
  {
    std::vector<Point> vertices;
    std::vector<Surface::Triangle> triangles;
    std::vector<unsigned int> patches;
    for (const auto &[half, patch] : list)
    {
      const Surface cube       = brick(Point(-half, -half, -half), Point(half, half, half));
      const unsigned int first = vertices.size();
      vertices.insert(vertices.end(), cube.vertices().begin(), cube.vertices().end());
      for (const auto &[a, b, c] : cube.triangles())
        triangles.push_back({a + first, b + first, c + first});
      patches.insert(patches.end(), 12, patch);
    }
    return Surface(vertices, triangles, patches);
  }

  /// A cube of side 2 with a round hole in its middle.
  Surface hollow_cube(const Surface &hole)
  {
    const Surface cube = brick(Point(-1, -1, -1), Point(1, 1, 1));
    auto vertices      = cube.vertices();
    auto triangles     = cube.triangles();
    for (const auto &[a, b, c] : hole.triangles())
      triangles.push_back({a + 8, c + 8, b + 8});
    vertices.insert(vertices.end(), hole.vertices().begin(), hole.vertices().end());
    return Surface(vertices, triangles);
  }
} // namespace

TEST(SurfaceBody, FilledVolumeOfATetrahedronIsTheFormula)
{
  // |[0,s]^3 below x + y + z = 1| by inclusion and exclusion
  const SurfaceBody body(tetrahedron());
  for (const double s : {0.1, 1. / 3, 0.4, 0.5, 0.7, 1., 1.3})
  {
    const auto cubed      = [](const double x) { return std::pow(std::max(x, 0.), 3); };
    const double expected = (1 - 3 * cubed(1 - s) + 3 * cubed(1 - 2 * s) - cubed(1 - 3 * s)) / 6;
    EXPECT_NEAR(body.filled_volume(Box({Point(0, 0, 0), Point(s, s, s)})), expected, 1e-15);
    EXPECT_NEAR(body.filled_volume(Box({Point(-1, -1, -1), Point(s, s, s)})), expected, 1e-15);
  }
}

TEST(SurfaceBody, FilledVolumesOfAGridAddUpToTheVolume)
{
  const Point far(100, -50, 30);
  for (const unsigned int n : {1, 5, 8, 13})
  {
    const SurfaceBody ball(sphere(4, 1, far));
    EXPECT_NEAR(sum_of_filled_volumes(ball, ball.bounding_box(), n) / ball.volume(), 1, 1e-11);
    const SurfaceBody simplex(tetrahedron());
    EXPECT_NEAR(sum_of_filled_volumes(simplex, simplex.bounding_box(), n) / simplex.volume(), 1,
                1e-12);
    const SurfaceBody hollow(hollow_cube(sphere(3, 0.8)));
    EXPECT_NEAR(sum_of_filled_volumes(hollow, hollow.bounding_box(), n) / hollow.volume(), 1,
                1e-12);
  }
}

TEST(SurfaceBody, BoxesFlushWithACubeAreInsideOrOutside)
{
  const SurfaceBody cube(brick());
  for_each_cell(Box({Point(-1, -1, -1), Point(2, 2, 2)}), 12, [&](const Box &cell) {
    const bool inside = brick().bounding_box().point_inside(cell.center());
    EXPECT_EQ(cube.classify(cell), inside ? Side::inside : Side::outside);
    EXPECT_NEAR(cube.filled_volume(cell), inside ? cell.volume() : 0, 1e-16);
  });
  EXPECT_EQ(cube.classify(Box({Point(-1, -1, -1), Point(2, 2, 2)})), Side::cut);
  EXPECT_EQ(cube.classify(Box({Point(0.5, 0.5, 0.5), Point(1.001, 0.6, 0.6)})), Side::cut);
}

TEST(SurfaceBody, RandomBoxesAgreeWithSampling)
{
  const SurfaceBody body(hollow_cube(sphere(2, 0.9)));
  std::mt19937 generator;
  std::uniform_real_distribution<double> place(-1.2, 0.8), size(0.3, 1.), unit(0., 1.);
  for (unsigned int i = 0; i < 20; ++i)
  {
    const Point lower(place(generator), place(generator), place(generator));
    const Box box({lower, lower + Direction({size(generator), size(generator), size(generator)})});

    // One random point in each of n^3 cells: only the cut cells contribute to the deviation, each
    // at most 1/2.
    const unsigned int n  = 30;
    unsigned int n_inside = 0, n_cut = 0;
    for_each_cell(box, n, [&](const Box &cell) {
      n_inside +=
        body.contains(cell.unit_to_real(Point(unit(generator), unit(generator), unit(generator))));
      n_cut += body.classify(cell) == Side::cut;
    });
    const double deviation = std::sqrt(n_cut) / 2 / (n * n * n);
    EXPECT_NEAR(body.filled_volume(box) / box.volume(), n_inside / double(n * n * n),
                4 * deviation + 1e-12);
  }
}

TEST(SurfaceBody, HoleIsOutside)
{
  const Surface hole = sphere(3, 0.8);
  const SurfaceBody body(hollow_cube(hole));
  EXPECT_NEAR(body.volume(), 8 - hole.volume(), 1e-13);
  EXPECT_FALSE(body.contains(Point(0, 0, 0)));
  EXPECT_TRUE(body.contains(Point(0.9, 0.9, 0.9)));
  EXPECT_EQ(body.classify(Box({Point(-0.1, -0.1, -0.1), Point(0.1, 0.1, 0.1)})), Side::outside);
  EXPECT_EQ(body.surface().triangles().size(), 12 + hole.triangles().size());
}

TEST(SurfaceBody, FillsAPartInsideByItsOwnMaterial)
{
  const SurfaceBody body(cubes({{0.5, 7}, {1, 3}}), {7}, "");
  EXPECT_EQ(body.n_labels(), 2u);
  EXPECT_EQ(body.label_name(1), "7");
  EXPECT_NEAR(body.volume(), 8, 1e-14);
  EXPECT_NEAR(body.surface().area(), 24, 1e-13);
  EXPECT_EQ(body.surface().patches(), std::vector<unsigned int>(12, 3));
  EXPECT_TRUE(body.contains(Point(0.1, 0.2, 0.3)));
  EXPECT_EQ(body.classify(Box({Point(0, 0, 0), Point(0.5, 0.5, 0.5)})), Side::inside);
  EXPECT_EQ(body.classify(Box({Point(0.6, 0, 0), Point(0.9, 0.9, 0.9)})), Side::inside);
  const Box across({Point(0, 0, 0), Point(0.9, 0.9, 0.9)});
  EXPECT_EQ(body.classify(across), Side::cut);
  EXPECT_NEAR(body.filled_volume(across), across.volume(), 1e-15);
  EXPECT_EQ(body.label(Point(0.1, 0.2, 0.3)), 1u);
  EXPECT_EQ(body.label(Point(0.1, 0.2, 0.7)), 0u);
  EXPECT_EQ(body.label(Point(0.1, 0.2, 1.1)), 0u);
}

TEST(SurfaceBody, KnowsHolesAndMaterialsWithinEachOther)
{
  // from outside: base, a hole, material 5 in it, material 6 in that, a hole in this
  const std::vector<std::pair<double, unsigned int>> list = {
    {5, 0}, {4, 1}, {3, 5}, {2, 6}, {1, 2}};
  const SurfaceBody body(cubes(list), {6, 5}, "");
  EXPECT_NEAR(body.volume(), 1000 - 512 + 216 - 8, 1e-10);
  EXPECT_NEAR(body.surface().area(), 6 * (100 + 64 + 36 + 4), 1e-10);
  for (const auto &[x, is_filled, label] : {std::tuple{4.5, true, 0u},
                                            {3.6, false, 0u},
                                            {3.4, false, 2u},
                                            {2.5, true, 2u},
                                            {1.5, true, 1u},
                                            {0.5, false, 1u}})
  {
    const Point X(x, 0.1, 0.2);
    EXPECT_EQ(body.contains(X), is_filled) << x;
    if (is_filled || x < 3) // in the outer hole either label is near
    {
      EXPECT_EQ(body.label(X), label) << x;
    }
  }
}

TEST(SurfaceBody, NamesTheLabelThatIsNoClosedPart)
{
  try
  {
    SurfaceBody(cubes({{0.5, 7}, {1, 3}}), {7, 4}, "liver.stl");
    FAIL();
  }
  catch (const BadInput &error)
  {
    const std::string text = error.what();
    EXPECT_EQ(text.find("liver.stl: no closed part of the surface is of patch 4 alone"), 0u)
      << text;
    EXPECT_NE(text.find("closed parts are: 7, 3."), std::string::npos) << text;
  }
}
