// SPDX-License-Identifier: LGPL-2.1-or-later
// Volume, boundary and faults of conforming meshes, on any number of ranks.

#include "elements_on_a_box.h"

#include <softcell/base/exceptions.h>

#include <cmath>

namespace softcell
{
  using namespace elements_on_a_box;

  namespace
  {
    /// Volume, and by the boundary: the integrals of n and of X.n, and the area.
    struct Integrals
    {
      double volume = 0, flux = 0, area = 0;
      Direction normal;
    };

    Integrals integrals(const Fitted &fitted, const Region &region)
    {
      Integrals result;
      PatchStorage storage;
      for (unsigned int i = 0; i < fitted.n_patches(); ++i)
        for (const double weight : fitted.patch(i, storage).weights)
          result.volume += weight;
      for (const SurfacePatch &patch : fitted.surface_patches(region))
        for (unsigned int q = 0; q < patch.weights.size(); ++q)
        {
          EXPECT_NEAR(patch.normals[q].norm(), 1, 1e-12);
          result.normal += patch.weights[q] * patch.normals[q];
          result.flux += patch.weights[q] * (patch.points[q] * patch.normals[q]);
          result.area += patch.weights[q];
        }
      result.normal = dealii::Utilities::MPI::sum(result.normal, MPI_COMM_WORLD);
      return {sum(result.volume), sum(result.flux), sum(result.area), result.normal};
    }
  } // namespace

  class CellsOfElements : public testing::TestWithParam<Element>
  {
  };

  TEST_P(CellsOfElements, FillTheBoxAndCloseItsBoundary)
  {
    const Fitted fitted = on_box(GetParam());
    const Integrals all = integrals(fitted, everywhere);
    EXPECT_NEAR(all.volume, 3, 1e-12);
    EXPECT_NEAR(all.flux, 9, 1e-12);
    EXPECT_NEAR(all.area, 13, 1e-12);
    EXPECT_NEAR(all.normal.norm(), 0, 1e-12);
    EXPECT_NEAR(integrals(fitted, Region("base", "nz < -0.5")).area, 2, 1e-12);
    EXPECT_NEAR(integrals(fitted, Region("right", "patch 1")).area, 1.5, 1e-12);

    const unsigned int p = GetParam().degree;
    EXPECT_EQ(fitted.size().cells, 24u * (GetParam().tetrahedra ? 6 : 1));
    EXPECT_EQ(fitted.size().unknowns, 3u * (4 * p + 1) * (2 * p + 1) * (3 * p + 1));
    EXPECT_EQ(fitted.size().cut_cells, 0u);
    EXPECT_EQ(sum(fitted.n_owned_nodes()) * 3, fitted.size().unknowns);
  }

  INSTANTIATE_TEST_SUITE_P(Box, CellsOfElements, all_elements, element_name);

  TEST(FittedCells, FollowsTheMantleOfACylinder)
  {
    const double radius = 0.5, length = 2, pi = dealii::numbers::PI;
    const auto body = make_cylinder(radius, length);
    double error[2];
    for (const unsigned int i : {0, 1})
    {
      const Fitted fitted(MPI_COMM_WORLD, hexahedral_cylinder(radius, length, 4 << i, 3), 2, *body);
      const Integrals all = integrals(fitted, everywhere);
      EXPECT_NEAR(all.flux, 3 * all.volume, 1e-12);
      EXPECT_NEAR(all.normal.norm(), 0, 1e-12);
      error[i] = std::abs(all.volume / (pi / 2) - 1);
      EXPECT_NEAR(integrals(fitted, Region("side", "abs(nz) < 0.5")).area, 2 * pi, 0.01);
      EXPECT_NEAR(integrals(fitted, Region("base", "patch 1")).area, pi / 4, 2e-3);
      for (const SurfacePatch &patch : fitted.surface_patches(Region("side", "patch 0")))
        for (unsigned int q = 0; q < patch.weights.size(); ++q)
          EXPECT_GT(patch.normals[q] * Direction({patch.points[q][0], patch.points[q][1], 0}),
                    0.99 * radius);
    }
    EXPECT_LT(error[0], 2e-3);
    EXPECT_GT(error[0] / error[1], 12); // a quadratic arc is off by O(h^4)
  }

  TEST(FittedCells, SaysWhichRegionIsEmpty)
  {
    const Fitted fitted = on_box({true, 1});
    try
    {
      fitted.nodes_on(Region("void", "z > 7"));
      FAIL();
    }
    catch (const BadInput &error)
    {
      // Two triangles for each of 2 (4 2 + 2 3 + 3 4) rectangles.
      const std::string text = error.what();
      EXPECT_NE(text.find("Regions/void selects none of the 104 "), std::string::npos) << text;
      EXPECT_NE(text.find("0 <= x <= 2, 0 <= y <= 1, 0 <= z <= 1.5"), std::string::npos) << text;
    }
    EXPECT_THROW(fitted.surface_patches(Region("void", "z > 7")), BadInput);
    EXPECT_THROW(on_box({true, 3}), BadInput);
  }

  TEST(FittedCells, RefusesCellsThatAreInsideOut)
  {
    Mesh mesh = hexahedral_box(size, n_cells);
    std::swap(mesh.vertices[0], mesh.vertices[1]);
    EXPECT_THROW(Fitted(MPI_COMM_WORLD, mesh, 1, *make_box(size)), BadInput);
  }
} // namespace softcell
