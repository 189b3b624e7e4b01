// SPDX-License-Identifier: LGPL-2.1-or-later
// Defects of surfaces: those that are repaired and told, and those that are errors.

#include <softcell/geometry/surface_soup.h>

#include <softcell/base/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "shapes.h"

using namespace softcell;
using namespace softcell::testing;

namespace
{
  using Names = std::vector<std::string>;

  SurfaceSoup soup_of(const Surface &surface)
  {
    SurfaceSoup soup;
    soup.points  = surface.vertices();
    soup.patches = surface.patches();
    for (const auto &triangle : surface.triangles())
      soup.polygons.emplace_back(triangle.begin(), triangle.end());
    return soup;
  }

  /// Appends a surface, moved and inside out if so wished.
  SurfaceSoup joined(SurfaceSoup soup,
                     const SurfaceSoup &other,
                     const Direction &shift = {},
                     const bool turn        = false)
  {
    for (auto polygon : other.polygons)
    {
      for (unsigned int &v : polygon)
        v += soup.points.size();
      if (turn)
        std::swap(polygon[0], polygon[1]);
      soup.polygons.push_back(polygon);
    }
    for (const Point &X : other.points)
      soup.points.push_back(X + shift);
    soup.patches.insert(soup.patches.end(), other.patches.begin(), other.patches.end());
    return soup;
  }

  double repaired_volume(const SurfaceSoup &soup, const Names &expected_repairs)
  {
    Names repairs;
    const Surface surface = close_surface(soup, "file", repairs);
    EXPECT_EQ(repairs, expected_repairs);
    return surface.volume();
  }

  void expect_error(const SurfaceSoup &soup, const std::string &part)
  {
    Names repairs;
    try
    {
      close_surface(soup, "file", repairs);
      FAIL() << "no error where one with '" << part << "' was expected";
    }
    catch (const BadInput &error)
    {
      EXPECT_EQ(std::string(error.what()).rfind("file: ", 0), 0u) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
} // namespace

TEST(SurfaceRepair, InsideOutPartsAreTurned)
{
  const SurfaceSoup cube = soup_of(brick()), ball = soup_of(sphere(1));
  EXPECT_NEAR(
    repaired_volume(joined({}, cube, {}, true),
                    {"file: the surface was inside out: its 12 triangles were turned outward."}),
    1, 1e-14);
  EXPECT_NEAR(repaired_volume(joined(cube, cube, Direction({3, 0, 0}), true),
                              {"file: 12 triangles were inside out and turned outward."}),
              2, 1e-14);
  SurfaceSoup one_turned = cube;
  std::swap(one_turned.polygons[4][0], one_turned.polygons[4][1]);
  EXPECT_NEAR(repaired_volume(one_turned, {"file: 1 triangle was inside out and turned outward."}),
              1, 1e-14);

  // A ball within a cube is a hole, whichever way it is given.
  const double hollow    = 64 - sphere(1).volume();
  const SurfaceSoup room = soup_of(brick(Point(-2, -2, -2), Point(2, 2, 2)));
  EXPECT_NEAR(repaired_volume(joined(room, ball, {}, true), {}), hollow, 1e-12);
  EXPECT_NEAR(
    repaired_volume(joined(room, ball), {"file: 32 triangles were inside out and turned outward."}),
    hollow, 1e-12);
}

TEST(SurfaceRepair, SuperfluousPartsAreDropped)
{
  SurfaceSoup soup = soup_of(brick());
  soup.polygons.push_back({0, 0, 1});
  soup.polygons.push_back({soup.polygons[0][1], soup.polygons[0][2], soup.polygons[0][0]});
  soup.patches.insert(soup.patches.end(), {7, 7});
  EXPECT_NEAR(
    repaired_volume(soup, {"file: 1 triangle with fewer than three distinct corners dropped.",
                           "file: 1 triangle given twice, of which one was kept."}),
    1, 1e-14);

  SurfaceSoup double_points = soup_of(brick());
  double_points.points.push_back(double_points.points[3]);
  for (unsigned int &v : double_points.polygons[4])
    v = v == 3 ? 8 : v;
  EXPECT_NEAR(repaired_volume(double_points,
                              {"file: 1 point was merged with another one at the same place."}),
              1, 1e-14);

  const SurfaceSoup speck = soup_of(brick(Point(), Point(0.04, 0.04, 0.04)));
  EXPECT_NEAR(
    repaired_volume(
      joined(joined(speck, soup_of(brick()), Direction({1, 1, 1})), speck, Direction({5, 5, 5})),
      {"file: 2 stray specks (24 triangles) with less than 0.0001 of the largest part's volume "
       "dropped."}),
    1, 1e-14);
}

TEST(SurfaceRepair, PolygonsAreSplitAndKeepTheirPatch)
{
  SurfaceSoup soup;
  soup.points   = brick().vertices();
  soup.polygons = {{0, 4, 6, 2}, {0, 1, 5, 4}, {0, 2, 3, 1},
                   {1, 3, 7, 5}, {2, 6, 7, 3}, {4, 5, 7, 6}};
  soup.patches  = {0, 1, 2, 3, 4, 5};
  Names repairs;
  const Surface surface = close_surface(soup, "file", repairs);
  EXPECT_EQ(repairs, Names{"file: 6 polygons were split into triangles."});
  EXPECT_NEAR(surface.volume(), 1, 1e-14);
  for (unsigned int t = 0; t < 12; ++t)
    EXPECT_EQ(surface.normal(t)[surface.patches()[t] % 3], surface.patches()[t] < 3 ? -1 : 1);
}

TEST(SurfaceRepair, TrianglesOnALineAreRemoved)
{
  // The edge (0, 0, 0), (1, 0, 0) of a tetrahedron has a point in its middle, on one side only.
  SurfaceSoup soup;
  soup.points = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1), Point(0.5, 0, 0)};
  soup.polygons = {{0, 2, 4}, {4, 2, 1}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  EXPECT_NEAR(
    repaired_volume(soup, {"file: 1 triangle without area removed, the first at (0.5, 0, 0)."}),
    1. / 6, 1e-15);
}

TEST(SurfaceRepair, OpenAndNonManifoldSurfacesAreErrors)
{
  SurfaceSoup open = soup_of(brick());
  open.polygons.pop_back();
  open.patches.pop_back();
  expect_error(open, "the surface is open: 3 edges belong to one triangle only, the first at (");

  const SurfaceSoup simplex = soup_of(tetrahedron());
  SurfaceSoup mirrored      = simplex; // has the edge on the x axis in common
  for (Point &X : mirrored.points)
    X = Point(X[0], -X[1], -X[2]);
  expect_error(joined(simplex, mirrored),
               "1 edge belongs to more than two triangles, the first at (0.5, 0, 0)");

  SurfaceSoup opposite = simplex; // has the origin in common
  for (Point &X : opposite.points)
    X = -1. * X;
  expect_error(joined(simplex, opposite), "at 1 point, the first at (0, 0, 0)");

  SurfaceSoup flat;
  flat.points   = {Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)};
  flat.polygons = {{0, 1, 2}};
  expect_error(flat, "the surface is open: 3 edges belong");
  flat.polygons.push_back({1, 0, 2});
  expect_error(flat, "open: 3 edges");
}

TEST(SurfaceRepair, CrossingPartsAreErrors)
{
  const SurfaceSoup cube = soup_of(brick());
  expect_error(joined(cube, cube, Direction({0.5, 0.4, 0.3})), "the surface intersects itself: ");
  expect_error(joined(soup_of(sphere(2)), soup_of(sphere(2)), Direction({1, 0.1, 0.01})),
               "pairs of triangles do, the first at (");
}

// A vertex that is drawn along the sphere beyond its neighbours folds its triangles over theirs.
TEST(SurfaceRepair, FoldsAreRemoved)
{
  const Surface ball = sphere(4);
  const double edge  = M_PI / 2 / 16;
  SurfaceSoup soup   = soup_of(ball);
  const auto nearest = [&](const Point &X) {
    return std::min_element(
      soup.points.begin(), soup.points.end(),
      [&](const Point &a, const Point &b) { return X.distance(a) < X.distance(b); });
  };
  Point &moved          = *nearest(Point(0.6, 0.48, 0.64));
  const Point place     = moved;
  const Direction along = *nearest(moved + edge * Direction({1, -1, 0})) - moved;
  moved += 4 * along;
  moved /= (moved - Point()).norm();
  const Direction across = along / along.norm();
  const auto beyond      = [&](const Point &X) { return (X - place) * across / edge - 2; };
  for (unsigned int t = 0; t < soup.polygons.size(); ++t)
  {
    const auto [a, b, c] = ball.corners(t);
    soup.patches[t]      = beyond(a + ((b - a) + (c - a)) / 3) > 0;
  }

  Names repairs;
  const Surface surface = close_surface(soup, "file", repairs);
  ASSERT_EQ(repairs.size(), 1u) << repairs[1];
  EXPECT_EQ(repairs[0].find("file: self-intersections of "), 0u) << repairs[0];
  EXPECT_NE(repairs[0].find(" pairs of triangles removed, the first at (0."), std::string::npos);
  EXPECT_NEAR(surface.volume(), ball.volume(), 1e-3 * ball.volume());
  EXPECT_NEAR(surface.area(), ball.area(), 0.01 * ball.area());
  unsigned int n_wrong = 0; // triangles whose patch is more than an edge away
  for (unsigned int t = 0; t < surface.triangles().size(); ++t)
  {
    const auto [a, b, c] = surface.corners(t);
    const double x       = beyond(a + ((b - a) + (c - a)) / 3);
    n_wrong += std::abs(x) > 1 && surface.patches()[t] != (x > 0);
  }
  EXPECT_EQ(n_wrong, 0u);
  repairs.clear();
  close_surface(soup_of(surface), "file", repairs); // nothing is left to repair
  EXPECT_EQ(repairs, Names());
}

TEST(SurfaceRepair, RealLivers)
{
  const std::string organs = SOFTCELL_ORGANS;
  if (!std::filesystem::exists(organs))
    GTEST_SKIP() << "no livers in " << organs;
  Names repairs;
  const Surface liver = read_surface(organs + "/liver_cgal/liver_20k.ply", 0.001, repairs);
  EXPECT_EQ(repairs, Names());
  EXPECT_EQ(liver.triangles().size(), 19826u);
  EXPECT_NEAR(liver.volume(), 1603.7e-6, 0.05e-6);
  EXPECT_NEAR(liver.area(), 849.7e-4, 0.05e-4);

  const Surface raw = read_surface(organs + "/liver_sofa/liver_raw.vtk", 0.001, repairs);
  EXPECT_EQ(repairs.size(), 2u);
  EXPECT_EQ(raw.triangles().size(), 9988u);
  EXPECT_NEAR(raw.volume(), 1477.2e-6, 0.05e-6);
}
