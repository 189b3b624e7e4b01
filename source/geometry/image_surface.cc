// SPDX-License-Identifier: LGPL-2.1-or-later
// A smooth closed surface around the voxels of a segmentation.

#include <softcell/base/exceptions.h>
#include <softcell/geometry/image_body.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

namespace softcell
{
  namespace
  {
    /// Values at the points of a grid of equal spacing.
    struct Lattice
    {
      std::array<unsigned int, 3> size;
      Point first;
      double spacing;
      std::vector<float> values; // x fastest
    };

    struct Triangles
    {
      std::vector<Point> vertices;
      std::vector<Surface::Triangle> corners;
    };

    /// Six times the volume of the tetrahedron between a triangle and the origin.
    double six_volumes(const std::vector<Point> &vertices, const Surface::Triangle &t)
    {
      return vertices[t[0]] * cross_product_3d(vertices[t[1]], vertices[t[2]]);
    }

    /// Convolution with a Gaussian cut off at four sigma, along one axis after the other.
    void blur(Lattice &lattice, const double sigma)
    {
      const int reach = std::ceil(4 * sigma / lattice.spacing);
      std::vector<float> kernel;
      for (int i = -reach; i <= reach; ++i)
        kernel.push_back(std::exp(-0.5 * std::pow(i * lattice.spacing / sigma, 2)));
      const float sum = std::accumulate(kernel.begin(), kernel.end(), 0.f);

      std::size_t stride = 1;
      for (unsigned int d = 0; d < dim; ++d)
      {
        const int n = lattice.size[d];
        std::vector<float> line(n + 2 * reach, 0.f);
        for (std::size_t start = 0; start < lattice.values.size(); ++start)
          if (start / stride % n == 0)
          {
            float *values = &lattice.values[start];
            for (int i = 0; i < n; ++i)
              line[reach + i] = values[i * stride];
            for (int i = 0; i < n; ++i)
              values[i * stride] =
                std::inner_product(kernel.begin(), kernel.end(), &line[i], 0.f) / sum;
          }
        stride *= n;
      }
    }

    /// Closed triangles where the lattice's values cross the level, normals towards the lower ones.
    Triangles contour(Lattice lattice, const double level)
    {
      // A value at the level would make triangles of no area.
      constexpr float gap = 0.01f;
      for (float &value : lattice.values)
        if (std::abs(value - level) < gap)
          value = level + (value < level ? -gap : gap);

      vtkNew<vtkFloatArray> scalars;
      scalars->SetArray(lattice.values.data(), lattice.values.size(), /* keep it ours */ 1);
      vtkNew<vtkImageData> image;
      image->SetDimensions(lattice.size[0], lattice.size[1], lattice.size[2]);
      image->SetSpacing(lattice.spacing, lattice.spacing, lattice.spacing);
      image->GetPointData()->SetScalars(scalars);
      vtkNew<vtkFlyingEdges3D> edges;
      edges->SetInputData(image);
      edges->SetValue(0, level);
      edges->ComputeNormalsOff();
      edges->ComputeScalarsOff();
      edges->Update();

      Triangles result;
      vtkPolyData *output = edges->GetOutput();
      for (vtkIdType v = 0; v < output->GetNumberOfPoints(); ++v)
      {
        const double *x = output->GetPoint(v);
        result.vertices.push_back(lattice.first + Direction({x[0], x[1], x[2]}));
      }
      vtkIdType n_corners;
      const vtkIdType *corners;
      output->GetPolys()->InitTraversal();
      while (output->GetPolys()->GetNextCell(n_corners, corners))
        result.corners.push_back(
          {{static_cast<unsigned int>(corners[0]), static_cast<unsigned int>(corners[1]),
            static_cast<unsigned int>(corners[2])}});
      double volume = 0;
      for (const auto &triangle : result.corners)
        volume += six_volumes(result.vertices, triangle);
      if (volume < 0)
        for (auto &triangle : result.corners)
          std::swap(triangle[1], triangle[2]);
      return result;
    }

    double enclosed_volume(const Triangles &surface)
    {
      double volume = 0;
      for (const auto &triangle : surface.corners)
        volume += six_volumes(surface.vertices, triangle) / 6;
      return volume;
    }

    /// The contour that encloses the volume to 1e-5 of it: regula falsi, Illinois variant.
    Triangles contour_of_volume(const Lattice &lattice, const double volume)
    {
      double low = 0.1, high = 0.9;
      double above = enclosed_volume(contour(lattice, low)) - volume;
      double below = enclosed_volume(contour(lattice, high)) - volume;
      for (unsigned int step = 0;; ++step)
      {
        const double level =
          above * below < 0 ? (low * below - high * above) / (below - above) : 0.5;
        Triangles result    = contour(lattice, level);
        const double excess = enclosed_volume(result) - volume;
        if (std::abs(excess) < 1e-5 * volume || above * below >= 0 || step == 30)
          return result;
        if (excess > 0)
        {
          low   = level;
          above = excess;
          below *= 0.5;
        }
        else
        {
          high  = level;
          below = excess;
          above *= 0.5;
        }
      }
    }

    /// Leaves out the components, and with them the cavities, of less than a thousandth of the
    /// largest one's volume.
    void drop_small_components(Triangles &surface)
    {
      std::vector<unsigned int> parent(surface.vertices.size());
      std::iota(parent.begin(), parent.end(), 0u);
      const auto root = [&](unsigned int v) {
        while (parent[v] != v)
          v = parent[v] = parent[parent[v]];
        return v;
      };
      for (const auto &t : surface.corners)
        for (unsigned int i = 1; i < 3; ++i)
          parent[root(t[i])] = root(t[0]);

      std::vector<double> volume(parent.size(), 0.);
      double largest = 0;
      for (const auto &t : surface.corners)
        volume[root(t[0])] += six_volumes(surface.vertices, t);
      for (const double v : volume)
        largest = std::max(largest, std::abs(v));

      Triangles kept;
      std::vector<unsigned int> number(parent.size());
      for (unsigned int v = 0; v < parent.size(); ++v)
        if (std::abs(volume[root(v)]) >= 1e-3 * largest)
        {
          number[v] = kept.vertices.size();
          kept.vertices.push_back(surface.vertices[v]);
        }
      for (const auto &t : surface.corners)
        if (std::abs(volume[root(t[0])]) >= 1e-3 * largest)
          kept.corners.push_back({{number[t[0]], number[t[1]], number[t[2]]}});
      surface = std::move(kept);
    }
  } // namespace

  Surface ImageBody::make_surface() const
  {
    const Box bounds = bounding_box();
    const Direction sides =
      bounds.get_boundary_points().second - bounds.get_boundary_points().first;
    const double coarsest = std::max({spacing_[0], spacing_[1], spacing_[2]});

    Lattice lattice;
    lattice.spacing        = std::max(coarsest, sides.norm() / 150);
    const double sigma     = std::max(1.5 * coarsest, lattice.spacing);
    const unsigned int rim = std::ceil(4 * sigma / lattice.spacing) + 1;
    for (unsigned int d = 0; d < dim; ++d)
    {
      lattice.size[d]  = std::ceil(sides[d] / lattice.spacing) + 1 + 2 * rim;
      lattice.first[d] = bounds.center()[d] - 0.5 * (lattice.size[d] - 1) * lattice.spacing;
    }
    const Direction half({0.5 * lattice.spacing, 0.5 * lattice.spacing, 0.5 * lattice.spacing});
    for (unsigned int k = 0; k < lattice.size[2]; ++k)
      for (unsigned int j = 0; j < lattice.size[1]; ++j)
        for (unsigned int i = 0; i < lattice.size[0]; ++i)
        {
          const Point X =
            lattice.first + Direction({double(i), double(j), double(k)}) * lattice.spacing;
          lattice.values.push_back(filled_volume(Box({X - half, X + half})) /
                                   std::pow(lattice.spacing, 3));
        }
    blur(lattice, sigma);

    Triangles surface = contour_of_volume(lattice, volume());
    drop_small_components(surface);
    if (surface.corners.empty())
      throw BadInput(
        "The image's body is too thin for a smooth surface: it needs about three voxels across.");
    for (Point &X : surface.vertices)
      for (unsigned int d = 0; d < dim; ++d)
        X[d] = std::clamp(X[d], bounds.lower_bound(d), bounds.upper_bound(d));
    return Surface(std::move(surface.vertices), std::move(surface.corners));
  }
} // namespace softcell
