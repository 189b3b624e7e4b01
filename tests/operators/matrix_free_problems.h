// SPDX-License-Identifier: LGPL-2.1-or-later
// Discretizations and displacements on which matrix-free operators are compared with Elasticity.
#pragma once

#include <softcell/discretization/methods.h>
#include <softcell/operators/elasticity.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace softcell
{
  const std::vector<std::string> all_laws{"Neo-Hookean", "Saint-Venant-Kirchhoff", "linear"};

  struct Problem
  {
    std::unique_ptr<Body> body;
    std::unique_ptr<Discretization> discretization;
  };

  inline Problem problem(const GeometryParameters &geometry,
                         const DiscretizationParameters &parameters)
  {
    std::vector<std::string> remarks;
    Problem result{make_body(geometry, remarks), nullptr};
    result.discretization =
      make_discretization(parameters, geometry, *result.body, MPI_COMM_SELF, remarks);
    return result;
  }

  inline Problem problem(const std::string &type,
                         const std::string &method,
                         const unsigned int cells,
                         const unsigned int degree             = 1,
                         const unsigned int surface_refinement = 0)
  {
    GeometryParameters geometry;
    geometry.type   = type;
    geometry.radius = 0.5;
    geometry.length = 1.3;
    geometry.size   = Point(1.2, 1, 0.9);
    DiscretizationParameters parameters;
    parameters.method                  = method;
    parameters.degree                  = degree;
    parameters.grid.cells              = {cells};
    parameters.grid.surface_refinement = surface_refinement;
    parameters.cut.levels              = 2;
    return problem(geometry, parameters);
  }

  // A segmented liver, if scripts/fetch-liver has fetched its image: no discretization otherwise.
  inline Problem liver(const std::string &method, const unsigned int cells)
  {
    GeometryParameters geometry;
    geometry.type   = "image";
    geometry.file   = SOFTCELL_LIVER;
    geometry.scale  = 0.001;
    geometry.labels = {255};
    if (!std::filesystem::exists(geometry.file))
      return {};
    DiscretizationParameters parameters;
    parameters.method     = method;
    parameters.grid.cells = {cells};
    parameters.cut.levels = 2;
    return problem(geometry, parameters);
  }

  // Something without symmetry, different for each component and frequency.
  inline Vector
  wavy(const Discretization &discretization, const double amplitude, const double frequency)
  {
    Vector u = discretization.make_vector();
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
    {
      const Point &X       = discretization.node_positions()[i / 3];
      const unsigned int c = i % 3;
      u.local_element(i)   = amplitude * (std::sin(frequency * (X[0] + 0.3 * c * X[1] - X[2] + c)) +
                                        X[(c + 1) % 3] * X[c]);
    }
    return u;
  }

  inline double relative_difference(const Vector &a, const Vector &b)
  {
    Vector d = a;
    d -= b;
    return d.linfty_norm() / b.linfty_norm();
  }

  /// @param block  (node, a, b) gives entry (a, b) of a node's block.
  template <class Block>
  void expect_diagonal_blocks(const BlockMatrix &K, const double bound, const Block &block)
  {
    const double largest = K.diagonal().linfty_norm();
    for (unsigned int node = 0; node + 1 < K.row_start().size(); ++node)
    {
      const auto begin    = K.columns().begin() + K.row_start()[node],
                 end      = K.columns().begin() + K.row_start()[node + 1];
      const std::size_t n = end - begin, own = std::find(begin, end, node) - begin;
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          ASSERT_NEAR(block(node, a, b),
                      K.values()[9 * K.row_start()[node] + (a * n + own) * 3 + b], bound * largest);
    }
  }
} // namespace softcell
