// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole simulations of small bodies, solved nearly to round-off.
#pragma once

#include <softcell/procedures/simulation.h>

#include <gtest/gtest.h>

#include <sstream>

namespace softcell
{
  struct Method
  {
    const char *name;
    unsigned int degree;
  };

  inline Parameters body_of(const std::string &type, const Method &method, const unsigned int cells)
  {
    Parameters p;
    p.geometry.type             = type;
    p.geometry.size             = Point(1, 1, 1);
    p.geometry.radius           = 0.5;
    p.geometry.length           = 1;
    p.material.young_modulus    = 1000;
    p.material.poisson_ratio    = 0.3;
    p.discretization.method     = method.name;
    p.discretization.degree     = method.degree;
    p.discretization.grid.cells = {cells};
    p.linear_solver.solver      = "direct";
    p.newton.residual_tolerance = 1e-12;
    p.newton.update_tolerance   = 1e-12;
    return p;
  }

  struct Solved
  {
    std::unique_ptr<Body> body;
    std::unique_ptr<Simulation> simulation;
    ResultsRow row;
  };

  inline Solved solve(const Parameters &parameters, std::unique_ptr<Body> body)
  {
    std::ostringstream log;
    Console console(log, false, 1e9);
    Solved solved;
    solved.body       = std::move(body);
    solved.simulation = std::make_unique<Simulation>("test", parameters, *solved.body, console);
    EXPECT_TRUE(solved.simulation->solve("")) << solved.simulation->reason();
    solved.row = solved.simulation->row();
    return solved;
  }

  inline Solved solve(const Parameters &parameters)
  {
    std::vector<std::string> remarks;
    return solve(parameters, make_body(parameters.geometry, remarks));
  }

  inline Direction vector_in(const ResultsRow &row, const std::string &name)
  {
    return Direction({row.number(name + "x"), row.number(name + "y"), row.number(name + "z")});
  }

  /// Only rank 0 fills the columns of probes.
  inline bool is_root()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }
} // namespace softcell
