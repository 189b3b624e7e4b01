// SPDX-License-Identifier: LGPL-2.1-or-later
// The projected change of volume against integrals by hand, and its derivatives by differences.

#include "../box_of_cells.h"
#include "lattice.h"

#include <softcell/discretization/methods.h>
#include <softcell/geometry/geometry.h>
#include <softcell/operators/elasticity.h>

#include <gtest/gtest.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    const std::vector<std::string> laws{"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"};
    constexpr double young = 10, poisson = 0.25, lame = 4;

    std::vector<Material> two_materials(const std::string &law)
    {
      return {Material(law, young, poisson), Material(law, 3 * young, 0.4)};
    }

    /// A smooth deformation without symmetry.
    Direction bending(const Point &X)
    {
      return Direction({0.1 * std::sin(X[1]) - 0.05 * X[2] * X[0], 0.1 * X[1] + 0.08 * X[0] * X[0],
                        -0.05 * X[2] + 0.1 * std::cos(X[0]) * X[1]});
    }

    Vector internal_force(const Elasticity &elasticity, const Vector &u)
    {
      Vector r(u.get_partitioner());
      elasticity.add_residual(u, r);
      r.compress(dealii::VectorOperation::add);
      return r;
    }

    /// Cells, or tetrahedra of half of the body's size, of this rank alone.
    std::unique_ptr<Discretization> discretization_of(const GeometryParameters &geometry,
                                                      const std::string &method,
                                                      const unsigned int degree,
                                                      const unsigned int n_cells = 1)
    {
      DiscretizationParameters parameters;
      parameters.method     = method;
      parameters.degree     = degree;
      parameters.grid.cells = {n_cells};
      parameters.cut.levels = 2;
      parameters.mesh.size  = 0.5;
      std::vector<std::string> remarks;
      const auto body = make_body(geometry, remarks);
      return make_discretization(parameters, geometry, *body, MPI_COMM_SELF, remarks);
    }

    GeometryParameters cylinder()
    {
      GeometryParameters geometry;
      geometry.type   = "cylinder";
      geometry.radius = 0.5;
      geometry.length = 1;
      return geometry;
    }

    void expect_derivatives(const Discretization &discretization, const std::string &law)
    {
      const Elasticity elasticity(discretization, two_materials(law), true);
      const Vector u = nodal_values(discretization, bending);
      const Vector r = internal_force(elasticity, u);
      BlockMatrix K(discretization.partitioner(), elasticity.couplings());
      elasticity.add_tangent(u, K);
      K.compress();
      const double h = 1e-5;
      Vector along(u.get_partitioner()), change(u.get_partitioner());
      for (unsigned int j = 0; j < u.size(); ++j)
      {
        Vector up = u, down = u;
        up(j) += h;
        down(j) -= h;
        EXPECT_NEAR(r(j), (elasticity.energy(up) - elasticity.energy(down)) / (2 * h), 2e-7) << law;
        along    = 0;
        along(j) = 1;
        K.vmult(change, along);
        const Vector r_up = internal_force(elasticity, up);
        Vector difference = internal_force(elasticity, down);
        difference.sadd(-1 / (2 * h), 1 / (2 * h), r_up);
        difference -= change;
        EXPECT_LT(difference.linfty_norm(), 2e-7) << law;
      }
    }
  } // namespace

  TEST(VolumetricProjection, ForceAndTangentAreDerivatives)
  {
    for (const std::string &law : laws)
    {
      UnitCells cells({{2, 1, 1}}, 2);
      cells.cells[1].labels = {1, 1, 0, 1, 0, 0, 1, 0};
      expect_derivatives(cells, law);
    }
    expect_derivatives(*discretization_of(cylinder(), "weighted cell", 2), "Neo-Hookean");
  }

  // u = (x y, 0, 0) changes the volume by y: the mean is 1/2, the mean square 1/3.
  TEST(VolumetricProjection, TrilinearCellsKeepTheMean)
  {
    const UnitCells cell({{1, 1, 1}}, 2);
    const Vector u = nodal_values(cell, [](const Point &X) {
      return Direction({X[0] * X[1], 0, 0});
    });
    const std::vector<Material> materials{Material("linear", young, poisson)};
    EXPECT_NEAR(Elasticity(cell, materials).energy(u) - Elasticity(cell, materials, true).energy(u),
                lame / 2 * (1. / 3 - 1. / 4), 1e-14);
  }

  // u = (x y^2, 0, 0) changes the volume by y^2: its linear part y - 1/6 has the mean square 7/36.
  TEST(VolumetricProjection, QuadraticCellsKeepTheLinearPart)
  {
    GeometryParameters box;
    box.type        = "box";
    box.size        = Point(1, 1, 1);
    const auto cell = discretization_of(box, "hexahedra", 2);
    const Vector u  = nodal_values(*cell, [](const Point &X) {
      return Direction({X[0] * X[1] * X[1], 0, 0});
    });
    const std::vector<Material> materials{Material("linear", young, poisson)};
    EXPECT_NEAR(Elasticity(*cell, materials).energy(u) -
                  Elasticity(*cell, materials, true).energy(u),
                lame / 2 * (1. / 5 - 7. / 36), 1e-14);
  }

  TEST(VolumetricProjection, MaterialsOfAPatchAreProjectedByThemselves)
  {
    UnitCells cell({{1, 1, 1}}, 2);
    cell.cells[0].labels = {0, 0, 1, 1, 0, 0, 1, 1}; // by y
    const Vector u       = nodal_values(cell, [](const Point &X) {
      return Direction({X[0] * X[1], 0, 0});
    });
    // At the Gauss points y is constant in each of them.
    EXPECT_NEAR(Elasticity(cell, two_materials("linear")).energy(u),
                Elasticity(cell, two_materials("linear"), true).energy(u), 1e-14);
  }

  TEST(VolumetricProjection, HomogeneousDeformationsLoseNothing)
  {
    std::vector<std::string> names = cut_rule_names();
    names.insert(names.end(), {"tetrahedra", "hexahedra"});
    for (const std::string &name : names)
      for (unsigned int degree = 1; degree <= 2; ++degree)
      {
        const auto discretization = discretization_of(cylinder(), name, degree, 3);
        const Vector u            = nodal_values(*discretization, [](const Point &X) {
          return Direction(
                       {0.2 * X[0] - 0.8 * X[1], 0.3 * X[2] + 3, -0.8 * X[0] - 0.6 * X[1] + 0.1 * X[2]});
        });
        for (const std::string &law : laws)
        {
          SCOPED_TRACE(name + ' ' + std::to_string(degree) + ' ' + law);
          const std::vector<Material> materials{Material(law, young, poisson)};
          const Elasticity pointwise(*discretization, materials);
          const Elasticity projected(*discretization, materials, true);
          EXPECT_NEAR(projected.energy(u), pointwise.energy(u), 1e-12);
          Vector difference = internal_force(projected, u);
          difference -= internal_force(pointwise, u);
          EXPECT_LT(difference.linfty_norm(), 1e-12);
        }
      }
  }

  // Their rules have as many points as there are polynomials.
  TEST(VolumetricProjection, TetrahedraLoseNothing)
  {
    for (unsigned int degree = 1; degree <= 2; ++degree)
    {
      const auto tetrahedra = discretization_of(cylinder(), "tetrahedra", degree);
      const Vector u        = nodal_values(*tetrahedra, bending);
      const std::vector<Material> materials{Material("Neo-Hookean", young, poisson)};
      EXPECT_NEAR(Elasticity(*tetrahedra, materials, true).energy(u),
                  Elasticity(*tetrahedra, materials).energy(u), 1e-12);
    }
  }

  TEST(VolumetricProjection, StrainsLinearisedElsewhereErrToSecondOrder)
  {
    const UnitCells cells({{2, 1, 1}}, 2);
    const Vector base = nodal_values(cells, bending);
    const auto error  = [&](const std::string &law, const double distance) {
      const Elasticity elasticity(cells, two_materials(law), true);
      Vector u = base;
      u.add(distance, nodal_values(cells, [](const Point &X) {
              return Direction({X[1] * X[2], -X[0] * X[2], X[0] - X[1] * X[1]});
            }));
      Vector r = internal_force(elasticity, u);
      r *= -1;
      elasticity.add_residual(u, r, &base);
      return r.l2_norm();
    };
    EXPECT_LT(error("linear", 0.1), 1e-13);
    for (const std::string law : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
    {
      EXPECT_LT(error(law, 0), 1e-13);
      EXPECT_GT(error(law, 1e-3), 1e-8);
      EXPECT_NEAR(error(law, 2e-3) / error(law, 1e-3), 4, 0.05);
    }
  }

  TEST(VolumetricProjection, RotationsAddNoEnergy)
  {
    const UnitCells cells({{2, 1, 1}}, 2);
    const Vector bent   = nodal_values(cells, bending);
    const Vector turned = nodal_values(cells, [](const Point &X) {
      const Point x = X + bending(X);
      return Point(0.6 * x[0] - 0.8 * x[1], x[2], -0.8 * x[0] - 0.6 * x[1]) - X;
    });
    for (const std::string law : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
    {
      const Elasticity elasticity(cells, two_materials(law), true);
      EXPECT_NEAR(elasticity.energy(turned), elasticity.energy(bent), 1e-13);
    }
  }
} // namespace softcell
