// SPDX-License-Identifier: LGPL-2.1-or-later
// Bytes as measured on cylinders of up to 215 000 cells, degrees 1 to 6.

#include <softcell/procedures/expected_memory.h>

#include <softcell/base/memory.h>
#include <softcell/discretization/expected_size.h>

#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    /// The tangent included.
    double memory_of_solver(const LinearSolverParameters &solver, const ExpectedSize &size)
    {
      if (solver.is_matrix_free()) // fields on all of the grid, and the body's nodes and points
        return 350 * size.grid_cells + 300 * size.nodes;
      const double tangent = 90 * size.couplings;
      const double copy    = 108 * size.couplings; // of the tangent, for Trilinos or PETSc
      if (solver.solver == "direct") // the factors of nested dissection grow as n^(4/3)
        return tangent + copy + 72 * size.couplings + 1200 * std::pow(size.nodes, 4. / 3);
      if (solver.preconditioner == "AMG")
        return tangent + copy + (solver.backend == "PETSc" ? 17e3 : 9e3) * size.nodes;
      return tangent + (solver.preconditioner == "incomplete Cholesky" ? 2 * copy : 0);
    }

    /// The entries that say how many unknowns there are.
    std::string size_entries(const DiscretizationParameters &parameters, const double n_cells)
    {
      const bool is_grid = parameters.method != "tetrahedra" && parameters.method != "hexahedra";
      std::ostringstream text;
      text << "Discretization/";
      if (parameters.method == "tetrahedra" && parameters.mesh.size > 0)
        text << "Mesh size = " << parameters.mesh.size;
      else if (is_grid && parameters.grid.cell_size > 0)
        text << "Cell size = " << parameters.grid.cell_size;
      else
        for (std::size_t d = 0; d < parameters.grid.cells.size(); ++d)
          text << (d == 0 ? "Cells = " : ", ") << parameters.grid.cells[d];
      text << " at Degree = " << parameters.degree;
      if (is_grid && parameters.grid.surface_refinement > 0)
        text << " and Surface refinement = " << parameters.grid.surface_refinement;
      text.precision(2);
      text << " (about " << n_cells << " cells)";
      return text.str();
    }
  } // namespace

  ExpectedMemory expected_memory(const Parameters &parameters, const ExpectedSize &size)
  {
    const DiscretizationParameters &discretization = parameters.discretization;
    ExpectedMemory memory;
    memory.shared =
      500 * size.grid_cells + 500 * size.nodes + memory_of_solver(parameters.linear_solver, size);
    if (discretization.method == "finite cell") // its leaves, and which of their points are inside
      memory.shared += size.cut_cells * std::pow(4, discretization.cut.levels) *
                       (10 + std::pow(discretization.degree + 1, 3) / 5);
    const double n_nodes = std::pow(discretization.degree + 1, 2) * (2 * discretization.degree + 1);
    memory.shared += size.ghost_faces * (8 * n_nodes * n_nodes + 4 * n_nodes + 100); // GhostFace
    if (discretization.method == "tetrahedra" || discretization.method == "hexahedra")
      memory.by_each = 300 * size.cells; // every rank has the whole mesh
    if (discretization.method != "tetrahedra")
      memory.by_each += 1.15e9 * std::pow((discretization.degree + 1) / 7., 4.4); // deal.II's FE_Q
    return memory;
  }

  void check_memory(const Parameters &parameters, const Body &body, MPI_Comm communicator)
  {
    const DiscretizationParameters &discretization = parameters.discretization;
    const ExpectedSize size     = expected_size(discretization, parameters.geometry, body);
    const ExpectedMemory memory = expected_memory(parameters, size);
    check_memory(
      memory.shared, memory.by_each, size_entries(discretization, size.cells),
      std::string("give fewer or larger cells, ") +
        (discretization.degree > 1 ? "a lower degree, " : "") +
        (parameters.linear_solver.solver == "direct" ? "'Solver/Linear solver = CG', " : "") +
        "or more machines",
      communicator);
  }
} // namespace softcell
