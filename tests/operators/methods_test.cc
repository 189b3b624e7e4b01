// SPDX-License-Identifier: LGPL-2.1-or-later
// What must hold for the patches of every method.

#include <softcell/discretization/methods.h>
#include <softcell/operators/elasticity.h>

#include <gtest/gtest.h>

namespace softcell
{
  TEST(ElasticityOfMethods, ARotatedBodyIsFreeOfForce)
  {
    GeometryParameters geometry;
    geometry.type   = "cylinder";
    geometry.radius = 0.5;
    geometry.length = 1;
    std::vector<std::string> remarks;
    const auto body = make_body(geometry, remarks);

    std::vector<std::string> names = cut_rule_names();
    names.insert(names.end(), {"tetrahedra", "hexahedra"});
    for (const std::string &name : names)
      for (unsigned int degree = 1; degree <= 2; ++degree)
      {
        DiscretizationParameters parameters;
        parameters.method     = name;
        parameters.degree     = degree;
        parameters.grid.cells = {4};
        parameters.cut.levels = 2;
        const auto discretization =
          make_discretization(parameters, geometry, *body, MPI_COMM_WORLD, remarks);
        Vector u = discretization->make_vector();
        for (unsigned int node = 0; node < discretization->node_positions().size(); ++node)
        {
          const Point &X = discretization->node_positions()[node];
          const Point x(0.6 * X[0] - 0.8 * X[1], X[2] + 3, -0.8 * X[0] - 0.6 * X[1]);
          for (unsigned int c = 0; c < 3; ++c)
            u.local_element(3 * node + c) = x[c] - X[c];
        }
        for (const std::string model : {"Neo-Hookean", "Saint-Venant-Kirchhoff"})
        {
          SCOPED_TRACE(name + ' ' + std::to_string(degree) + ' ' + model);
          const double E = 10;
          const Elasticity elasticity(*discretization, {Material(model, E, 0.25)});
          Vector r = discretization->make_vector();
          elasticity.add_residual(u, r);
          r.compress(dealii::VectorOperation::add);
          EXPECT_LT(r.linfty_norm(), 1e-12 * E);
          EXPECT_NEAR(elasticity.energy(u), 0, 1e-12 * E);
          EXPECT_NEAR(elasticity.min_jacobian(u), 1, 1e-12);
        }
      }
  }
} // namespace softcell
