// SPDX-License-Identifier: LGPL-2.1-or-later
// Triangle surfaces to and from VTK's files.

#include <softcell/geometry/surface_soup.h>

#include <softcell/base/exceptions.h>

#include <filesystem>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedIntArray.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

namespace softcell
{
  namespace
  {
    /// While it lives, VTK's errors and warnings are noted here instead of being printed.
    class VtkMessages
    {
    public:
      VtkMessages()
          : previous_window_(vtkOutputWindow::GetInstance()),
            previous_log_(vtkLogger::GetCurrentVerbosityCutoff())
      {
        vtkOutputWindow::SetInstance(window_);
        vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
      }
      ~VtkMessages()
      {
        vtkOutputWindow::SetInstance(previous_window_);
        vtkLogger::SetStderrVerbosity(previous_log_);
      }
      bool any() const
      {
        return window_->any;
      }

    private:
      class Window : public vtkOutputWindow
      {
      public:
        static Window *New();
        void DisplayText(const char *) override
        {
          any = true;
        }
        bool any = false;
      };

      vtkSmartPointer<vtkOutputWindow> previous_window_;
      vtkLogger::Verbosity previous_log_;
      vtkNew<Window> window_;
    };
    vtkStandardNewMacro(VtkMessages::Window);

    template <class Reader>
    vtkSmartPointer<vtkPolyData> read_poly_data(const std::string &file)
    {
      VtkMessages messages;
      vtkNew<Reader> reader;
      reader->SetFileName(file.c_str());
      reader->Update();
      vtkSmartPointer<vtkPolyData> data = reader->GetOutput();
      if (messages.any() || !data || !data->GetPoints())
        throw BadInput(
          file +
          ": VTK cannot read it as polygons, so it is truncated, damaged or of another kind; " +
          "copy it again, or save it as PolyData (.vtp).");
      return data;
    }
  } // namespace

  SurfaceSoup read_vtk_soup(const std::string &file)
  {
    const bool is_xml = std::filesystem::path(file).extension() != ".vtk";
    const auto data =
      is_xml ? read_poly_data<vtkXMLPolyDataReader>(file) : read_poly_data<vtkPolyDataReader>(file);

    SurfaceSoup soup;
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
    {
      double x[3];
      data->GetPoint(i, x);
      soup.points.emplace_back(x[0], x[1], x[2]);
    }
    if (data->GetNumberOfStrips() > 0)
      throw BadInput(
        file + ": it holds " + std::to_string(data->GetNumberOfStrips()) +
        " triangle strips; split them into triangles (the filter Triangulate of ParaView).");

    vtkDataArray *patches = data->GetCellData()->GetArray("patch");
    const vtkIdType first = data->GetNumberOfVerts() + data->GetNumberOfLines();
    for (vtkIdType i = 0; i < data->GetNumberOfPolys(); ++i)
    {
      vtkIdType n_corners;
      const vtkIdType *corners;
      data->GetPolys()->GetCellAtId(i, n_corners, corners);
      soup.polygons.emplace_back(corners, corners + n_corners);
      if (patches != nullptr)
      {
        const double patch = patches->GetTuple1(first + i);
        if (!(patch >= 0 && patch < 4e9))
          throw BadInput(file + ": the cell data 'patch' of polygon " + std::to_string(i) + " is " +
                         std::to_string(patch) + "; patches are numbers from 0.");
        soup.patches.push_back(static_cast<unsigned int>(patch));
      }
    }
    return soup;
  }

  void write_vtp(const std::string &file,
                 const Surface &surface,
                 const std::vector<std::pair<std::string, std::vector<Direction>>> &vectors)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    for (const Point &X : surface.vertices())
      points->InsertNextPoint(X[0], X[1], X[2]);
    vtkNew<vtkCellArray> triangles;
    for (const auto &[a, b, c] : surface.triangles())
    {
      const vtkIdType corners[3] = {a, b, c};
      triangles->InsertNextCell(3, corners);
    }
    vtkNew<vtkUnsignedIntArray> patches;
    patches->SetName("patch");
    for (const unsigned int patch : surface.patches())
      patches->InsertNextValue(patch);

    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(triangles);
    data->GetCellData()->AddArray(patches);
    for (const auto &[name, values] : vectors)
    {
      AssertDimension(values.size(), surface.vertices().size());
      vtkNew<vtkDoubleArray> array;
      array->SetName(name.c_str());
      array->SetNumberOfComponents(3);
      for (const Direction &value : values)
        array->InsertNextTuple3(value[0], value[1], value[2]);
      data->GetPointData()->AddArray(array);
    }

    VtkMessages messages;
    vtkNew<vtkXMLPolyDataWriter> writer;
    writer->SetFileName(file.c_str());
    writer->SetInputData(data);
    writer->SetDataModeToAppended();
    writer->EncodeAppendedDataOff();
    if (writer->Write() != 1 || messages.any())
      throw BadInput(
        file +
        ": the file cannot be written; check the folder, its permissions and its free space.");
  }
} // namespace softcell
