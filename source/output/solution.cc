// SPDX-License-Identifier: LGPL-2.1-or-later
// Displacements and stresses as files for ParaView.

#include <softcell/output/solution.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/geometry/surface.h>
#include <softcell/operators/elasticity.h>

#include <deal.II/base/mpi.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <cstdio>
#include <filesystem>
#include <sstream>

namespace softcell
{
  namespace
  {
    void set_cells(vtkUnstructuredGrid &grid, const DrawnCells &cells)
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      for (const Point &X : cells.points)
        points->InsertNextPoint(X[0], X[1], X[2]);
      vtkNew<vtkUnsignedCharArray> types;
      vtkNew<vtkCellArray> connectivity;
      for (std::size_t cell = 0; cell < cells.types.size(); ++cell)
      {
        types->InsertNextValue(cells.types[cell]);
        connectivity->InsertNextCell(cells.offsets[cell + 1] - cells.offsets[cell]);
        for (unsigned int i = cells.offsets[cell]; i < cells.offsets[cell + 1]; ++i)
          connectivity->InsertCellPoint(cells.connectivity[i]);
      }
      grid.SetPoints(points);
      grid.SetCells(types, connectivity);
    }

    void add_displacement(vtkUnstructuredGrid &grid, const DrawnCells &cells, const Vector &u)
    {
      vtkNew<vtkDoubleArray> values;
      values->SetName("displacement");
      values->SetNumberOfComponents(3);
      for (const PointShapes &shapes : cells.shapes)
      {
        double value[3] = {0, 0, 0};
        for (std::size_t i = 0; i < shapes.nodes.size(); ++i)
          for (unsigned int c = 0; c < 3; ++c)
            value[c] += shapes.values[i] * u.local_element(3 * shapes.nodes[i] + c);
        values->InsertNextTuple(value);
      }
      grid.GetPointData()->SetVectors(values);
    }

    template <class Value>
    void add_cell_data(vtkUnstructuredGrid &grid,
                       const char *name,
                       const unsigned int n_cells,
                       const Value &value)
    {
      vtkNew<vtkFloatArray> values;
      values->SetName(name);
      for (unsigned int cell = 0; cell < n_cells; ++cell)
        values->InsertNextValue(static_cast<float>(value(cell)));
      grid.GetCellData()->AddArray(values);
    }

    /// The file that joins the pieces of all ranks.
    std::string parallel_header(const std::vector<std::string> &pieces)
    {
      std::ostringstream text;
      text
        << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
           "  <PUnstructuredGrid GhostLevel=\"0\">\n"
           "    <PPointData Vectors=\"displacement\">\n"
           "      <PDataArray type=\"Float64\" Name=\"displacement\" NumberOfComponents=\"3\"/>\n"
           "    </PPointData>\n"
           "    <PCellData>\n";
      for (const char *name : {"von_mises", "J", "cut_fraction"})
        text << "      <PDataArray type=\"Float32\" Name=\"" << name << "\"/>\n";
      text << "    </PCellData>\n"
              "    <PPoints>\n"
              "      <PDataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\"/>\n"
              "    </PPoints>\n";
      for (const std::string &piece : pieces)
        text << "    <Piece Source=\"" << piece << "\"/>\n";
      text << "  </PUnstructuredGrid>\n</VTKFile>\n";
      return text.str();
    }

    std::string collection(const std::vector<std::pair<double, std::string>> &states)
    {
      std::ostringstream text;
      text.precision(12);
      text << "<?xml version=\"1.0\"?>\n"
              "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
              "  <Collection>\n";
      for (const auto &[time, file] : states)
        text << "    <DataSet timestep=\"" << time << "\" file=\"" << file << "\"/>\n";
      text << "  </Collection>\n</VTKFile>\n";
      return text.str();
    }
  } // namespace

  SolutionWriter::SolutionWriter(const Discretization &discretization, std::string stem)
      : communicator_(discretization.communicator()),
        stem_(std::move(stem)),
        cells_(discretization.drawn_cells())
  {
  }

  void SolutionWriter::write(const double time, const Vector &u, const PatchAverages &fields)
  {
    vtkNew<vtkUnstructuredGrid> grid;
    set_cells(*grid, cells_);
    add_displacement(*grid, cells_, u);
    const auto of_patch = [&](const std::vector<double> &values) {
      return [&](const unsigned int cell) { return values[cells_.patches[cell]]; };
    };
    const unsigned int n_cells = cells_.types.size();
    add_cell_data(*grid, "von_mises", n_cells, of_patch(fields.von_mises));
    add_cell_data(*grid, "J", n_cells, of_patch(fields.jacobian));
    add_cell_data(*grid, "cut_fraction", n_cells,
                  [&](const unsigned int cell) { return cells_.cut_fraction[cell]; });

    const unsigned int rank    = dealii::Utilities::MPI::this_mpi_process(communicator_);
    const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator_);
    char number[16];
    std::snprintf(number, sizeof(number), "_%04zu", states_.size());
    const std::string state = stem_ + number;
    const auto piece        = [&](const unsigned int r) {
      return state + (n_ranks == 1 ? "" : "_" + std::to_string(r)) + ".vtu";
    };

    vtkObject::GlobalWarningDisplayOff(); // what goes wrong is said below
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(piece(rank).c_str());
    writer->SetInputData(grid);
    bool is_written = writer->Write() == 1 && writer->GetErrorCode() == 0;

    const auto name = [](const std::string &file) {
      return std::filesystem::path(file).filename().string();
    };
    const std::string file = n_ranks == 1 ? piece(0) : state + ".pvtu";
    states_.emplace_back(time, name(file));
    if (rank == 0 && is_written)
      try
      {
        if (n_ranks > 1)
        {
          std::vector<std::string> pieces;
          for (unsigned int r = 0; r < n_ranks; ++r)
            pieces.push_back(name(piece(r)));
          write_file(file, parallel_header(pieces));
        }
        write_file(stem_ + ".pvd", collection(states_));
      }
      catch (const BadInput &)
      {
        is_written = false;
      }
    if (dealii::Utilities::MPI::min(is_written ? 1 : 0, communicator_) == 0)
      throw BadInput(
        "'" + file +
        "' cannot be written; give a folder with room and permission by --output DIR.");
  }

  void write_deformed_surface(const std::string &file,
                              const Surface &surface,
                              const std::vector<Direction> &displacement)
  {
    std::vector<Point> vertices = surface.vertices();
    for (std::size_t i = 0; i < vertices.size(); ++i)
      vertices[i] += displacement[i];
    write_vtp(file, Surface(std::move(vertices), surface.triangles(), surface.patches()),
              {{"displacement", displacement}});
  }
} // namespace softcell
