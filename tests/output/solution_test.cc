// SPDX-License-Identifier: LGPL-2.1-or-later
// Files for ParaView read back in VTK.

#include "one_tetrahedron.h"

#include <softcell/base/exceptions.h>
#include <softcell/discretization/fitted.h>
#include <softcell/discretization/hexahedral_mesh.h>
#include <softcell/discretization/immersed.h>
#include <softcell/geometry/shapes.h>
#include <softcell/operators/elasticity.h>
#include <softcell/output/solution.h>

#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace softcell;

namespace
{
  template <class Reader>
  vtkSmartPointer<vtkUnstructuredGrid> read_grid(const std::string &file)
  {
    vtkNew<Reader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
  }

  /// Those whose name begins like that, when all ranks are done with them.
  void remove_files(const std::string &beginning)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      for (const auto &entry : std::filesystem::directory_iterator("."))
        if (entry.path().filename().string().rfind(beginning, 0) == 0)
          std::filesystem::remove(entry.path());
    MPI_Barrier(MPI_COMM_WORLD);
  }
} // namespace

TEST(Solution, ReadsBackInVtk)
{
  const test::OneTetrahedronPerRank cells;
  const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  Vector u                   = cells.make_vector();
  for (unsigned int i = 0; i < 12; ++i)
    u.local_element(i) = 100 * rank + i;

  SolutionWriter writer(cells, "solution_test");
  writer.write(0.5, u, {{10.}, {1.}});
  writer.write(1, u, {{20. + rank}, {0.9}});
  MPI_Barrier(MPI_COMM_WORLD);

  if (rank == 0)
  {
    const auto grid = n_ranks == 1
                        ? read_grid<vtkXMLUnstructuredGridReader>("solution_test_0001.vtu")
                        : read_grid<vtkXMLPUnstructuredGridReader>("solution_test_0001.pvtu");
    ASSERT_EQ(grid->GetNumberOfCells(), n_ranks);
    ASSERT_EQ(grid->GetNumberOfPoints(), 4 * n_ranks);
    for (unsigned int r = 0; r < n_ranks; ++r)
    {
      EXPECT_EQ(grid->GetPoint(4 * r + 1)[0], r + 1);
      EXPECT_EQ(grid->GetPointData()->GetArray("displacement")->GetComponent(4 * r + 2, 1),
                100 * r + 7);
      EXPECT_EQ(grid->GetCellData()->GetArray("von_mises")->GetComponent(r, 0), 20 + r);
      EXPECT_FLOAT_EQ(grid->GetCellData()->GetArray("J")->GetComponent(r, 0), 0.9);
      EXPECT_EQ(grid->GetCellData()->GetArray("cut_fraction")->GetComponent(r, 0), 0.25);
    }
    std::stringstream pvd;
    pvd << std::ifstream("solution_test.pvd").rdbuf();
    EXPECT_NE(pvd.str().find("timestep=\"0.5\" file=\"solution_test_0000"), std::string::npos);
    EXPECT_NE(pvd.str().find("timestep=\"1\" file=\"solution_test_0001"), std::string::npos);
  }
  remove_files("solution_test");
}

// VTK knows nothing of our shapes: it must find the field anywhere in a cell from what was written.
TEST(Solution, VtkInterpolatesACubicField)
{
  const auto box = make_box(Point(1, 1, 1));
  const auto f   = [](const Point &X) {
    return Direction({X[0] * X[0] * X[0] - X[1], X[0] * X[1] * X[2], 3 * X[2] * X[2] * X[2]});
  };
  GridParameters grid;
  grid.cells              = {2};
  grid.scale              = 1.2;
  grid.surface_refinement = 1; // with hanging nodes
  const Immersed immersed("weighted cell", 3, grid, {1, 0}, *box, MPI_COMM_WORLD);
  const Fitted fitted(MPI_COMM_WORLD, hexahedral_box(Point(1, 1, 1), {{2, 2, 2}}), 3, *box);
  for (const Discretization *cells : {static_cast<const Discretization *>(&immersed),
                                      static_cast<const Discretization *>(&fitted)})
  {
    Vector u = cells->make_vector();
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      u.local_element(i) = f(cells->node_positions()[i / 3])[i % 3];
    u.update_ghost_values();
    const std::vector<double> zeros(cells->n_patches(), 0.);
    const std::size_t n_cells = cells->size().cells;
    SolutionWriter writer(*cells, "cubic_test");
    writer.write(1, u, {zeros, zeros});
    MPI_Barrier(MPI_COMM_WORLD);
    if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    {
      const auto drawn = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1
                           ? read_grid<vtkXMLUnstructuredGridReader>("cubic_test_0000.vtu")
                           : read_grid<vtkXMLPUnstructuredGridReader>("cubic_test_0000.pvtu");
      const auto array = drawn->GetPointData()->GetArray("displacement");
      EXPECT_EQ(drawn->GetNumberOfCells(), vtkIdType(n_cells));
      std::vector<double> weights(64);
      for (vtkIdType c = 0; c < drawn->GetNumberOfCells(); ++c)
      {
        int part               = 0;
        const double inside[3] = {0.3, 0.8, 0.15};
        Point X;
        vtkCell *const cell = drawn->GetCell(c);
        cell->EvaluateLocation(part, inside, X.begin_raw(), weights.data());
        Direction there;
        for (int i = 0; i < 64; ++i)
          for (unsigned int d = 0; d < 3; ++d)
            there[d] += weights[i] * array->GetComponent(cell->GetPointId(i), d);
        EXPECT_LT((there - f(X)).norm(), 1e-12);
      }
    }
    remove_files("cubic_test");
  }
}

TEST(Solution, NamesAFolderThatIsNotThere)
{
  const test::OneTetrahedronPerRank cells;
  EXPECT_THROW(
    SolutionWriter(cells, "no/such/folder/solution").write(1, cells.make_vector(), {{0.}, {1.}}),
    BadInput);
}
