// SPDX-License-Identifier: LGPL-2.1-or-later
#include "one_tetrahedron.h"

#include <softcell/base/exceptions.h>
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
  MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0)
    for (const auto &entry : std::filesystem::directory_iterator("."))
      if (entry.path().filename().string().rfind("solution_test", 0) == 0)
        std::filesystem::remove(entry.path());
}

TEST(Solution, NamesAFolderThatIsNotThere)
{
  const test::OneTetrahedronPerRank cells;
  EXPECT_THROW(
    SolutionWriter(cells, "no/such/folder/solution").write(1, cells.make_vector(), {{0.}, {1.}}),
    BadInput);
}
