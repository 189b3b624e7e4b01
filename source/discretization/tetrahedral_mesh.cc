// SPDX-License-Identifier: LGPL-2.1-or-later
// Tetrahedral meshes: of any body by CGAL, from a Gmsh file, and the structured one of a box.

#include <softcell/discretization/tetrahedral_mesh.h>

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>
#include <softcell/discretization/sliver_removal.h>
#include <softcell/geometry/surface.h>

#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_domain_with_polyline_features_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polyhedral_mesh_domain_with_features_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/make_mesh_3.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>
#include <unordered_map>

namespace softcell
{
  namespace
  {
    using Kernel        = CGAL::Exact_predicates_inexact_constructions_kernel;
    using SurfaceMesh   = CGAL::Surface_mesh<Kernel::Point_3>;
    using SurfaceDomain = CGAL::Polyhedral_mesh_domain_with_features_3<Kernel, SurfaceMesh>;
    using LabelDomain =
      CGAL::Mesh_domain_with_polyline_features_3<CGAL::Labeled_mesh_domain_3<Kernel>>;

    double volume_of(const Mesh &mesh,
                     const unsigned int a,
                     const unsigned int b,
                     const unsigned int c,
                     const unsigned int d)
    {
      const Point &A = mesh.vertices[a];
      return (mesh.vertices[d] - A) *
             dealii::cross_product_3d(mesh.vertices[b] - A, mesh.vertices[c] - A) / 6;
    }

    /// Numbers vertices along a Hilbert curve and cells by their vertices, so that what is near in
    /// space is near in memory and the order in which tetrahedra were found does not matter; turns
    /// them to positive volume. Returns the new numbers of the vertices.
    std::vector<unsigned int> put_in_order(Mesh &mesh)
    {
      std::vector<Kernel::Point_3> points;
      for (const Point &X : mesh.vertices)
        points.emplace_back(X[0], X[1], X[2]);
      std::vector<std::ptrdiff_t> order(points.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(order.begin(), order.end(),
                [&](const auto a, const auto b) { return points[a] < points[b]; });
      CGAL::hilbert_sort(
        order.begin(), order.end(),
        CGAL::Spatial_sort_traits_adapter_3<Kernel, Kernel::Point_3 *>(points.data()));
      std::vector<unsigned int> number(points.size());
      const std::vector<Point> vertices = mesh.vertices;
      for (unsigned int i = 0; i < order.size(); ++i)
      {
        number[order[i]] = i;
        mesh.vertices[i] = vertices[order[i]];
      }
      for (unsigned int &v : mesh.face_corners)
        v = number[v];

      std::vector<std::array<unsigned int, 4>> cells(mesh.n_cells());
      for (std::size_t i = 0; i < mesh.corners.size(); ++i)
        cells[i / 4][i % 4] = number[mesh.corners[i]];
      for (auto &cell : cells)
        std::sort(cell.begin(), cell.end());
      std::sort(cells.begin(), cells.end());
      for (std::size_t cell = 0; cell < cells.size(); ++cell)
      {
        std::copy(cells[cell].begin(), cells[cell].end(), &mesh.corners[4 * cell]);
        if (volume_of(mesh, cells[cell][0], cells[cell][1], cells[cell][2], cells[cell][3]) < 0)
          std::swap(mesh.corners[4 * cell + 2], mesh.corners[4 * cell + 3]);
      }
      return number;
    }

    /// Rank 0 makes the mesh; all get it, or all throw what went wrong there.
    Mesh made_on_rank_0(MPI_Comm communicator, const std::function<Mesh()> &make)
    {
      Mesh mesh;
      on_root(communicator, [&] { mesh = make(); });
      return dealii::Utilities::MPI::broadcast(communicator, mesh);
    }

    template <class Domain>
    Mesh refine(const Domain &domain, const double size)
    {
      using Triangulation = typename CGAL::Mesh_triangulation_3<Domain>::type;
      using Complex =
        CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, typename Domain::Corner_index,
                                                typename Domain::Curve_index>;
      namespace parameters = CGAL::parameters;

      // Bounds on circumradii, which are 0.58 of the edge of a regular triangle and 0.61 of that of
      // a tetrahedron.
      const CGAL::Mesh_criteria_3<Triangulation> criteria(
        parameters::edge_size = size, parameters::facet_angle = 25,
        parameters::facet_size = 0.7 * size, parameters::facet_distance = 0.1 * size,
        parameters::cell_radius_edge_ratio = 2, parameters::cell_size = 0.8 * size);
      CGAL::get_default_random() = CGAL::Random(0);
      const auto complex = CGAL::make_mesh_3<Complex>(domain, criteria, parameters::no_perturb(),
                                                      parameters::no_exude());

      Mesh mesh;
      std::vector<bool> is_inside;
      std::unordered_map<typename Triangulation::Vertex_handle, unsigned int> numbers;
      for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end();
           ++cell)
        for (unsigned int v = 0; v < 4; ++v)
        {
          const auto vertex              = cell->vertex(v);
          const auto [entry, new_vertex] = numbers.emplace(vertex, mesh.vertices.size());
          if (new_vertex)
          {
            mesh.vertices.emplace_back(vertex->point().x(), vertex->point().y(),
                                       vertex->point().z());
            is_inside.push_back(vertex->in_dimension() == 3);
          }
          mesh.corners.push_back(entry->second);
        }
      const std::vector<unsigned int> number = put_in_order(mesh);
      std::vector<bool> movable(number.size());
      for (unsigned int i = 0; i < number.size(); ++i)
        movable[number[i]] = is_inside[i];
      remove_slivers(mesh, movable);
      return mesh;
    }

    Mesh mesh_surface(const Surface &surface, const double size)
    {
      SurfaceMesh triangles;
      for (const Point &X : surface.vertices())
        triangles.add_vertex({X[0], X[1], X[2]});
      for (const auto &t : surface.triangles())
        triangles.add_face(SurfaceMesh::Vertex_index(t[0]), SurfaceMesh::Vertex_index(t[1]),
                           SurfaceMesh::Vertex_index(t[2]));
      CGAL::Random random(0);
      SurfaceDomain domain(triangles, &random);
      domain.detect_features(60);
      return refine(domain, size);
    }

    Mesh mesh_labels(const Body &body, const double size)
    {
      const Box box       = body.bounding_box();
      const double margin = 0.1 * size;
      const auto label    = [&body](const Kernel::Point_3 &p) -> int {
        const Point X(p.x(), p.y(), p.z());
        return body.contains(X) ? 1 + body.label(X) : 0;
      };
      CGAL::Random random(0);
      const double diagonal = (box.upper_bound(0) - box.lower_bound(0)) +
                              (box.upper_bound(1) - box.lower_bound(1)) +
                              (box.upper_bound(2) - box.lower_bound(2));
      const LabelDomain domain(
        label,
        CGAL::Bbox_3(box.lower_bound(0) - margin, box.lower_bound(1) - margin,
                     box.lower_bound(2) - margin, box.upper_bound(0) + margin,
                     box.upper_bound(1) + margin, box.upper_bound(2) + margin),
        0.01 * size / diagonal, CGAL::Null_subdomain_index(), &random);
      return refine(domain, size);
    }

    /// Two cells with a face in common must lie on its two sides.
    /// @throws BadInput
    void check_sides(const dealii::Triangulation<3> &triangulation, const std::string &complaint)
    {
      unsigned int n_overlaps = 0;
      Point first;
      for (const auto &cell : triangulation.active_cell_iterators())
        for (const unsigned int f : cell->face_indices())
        {
          const auto face = cell->face(f);
          if (face->at_boundary() || !(cell < cell->neighbor(f)))
            continue;
          const Direction normal = face->n_vertices() == 3
                                     ? dealii::cross_product_3d(face->vertex(1) - face->vertex(0),
                                                                face->vertex(2) - face->vertex(0))
                                     : dealii::cross_product_3d(face->vertex(3) - face->vertex(0),
                                                                face->vertex(2) - face->vertex(1));
          const double here      = normal * (cell->center() - face->center()),
                       there     = normal * (cell->neighbor(f)->center() - face->center());
          if (here * there > 0 && n_overlaps++ == 0)
            first = face->center();
        }
      if (n_overlaps == 0)
        return;
      std::ostringstream text;
      text << complaint << "is tangled: " << n_overlaps << " pair(s) of its "
           << triangulation.n_active_cells()
           << " cells lie on the same side of the face that they share, the first at (" << first
           << "), in the file's unit; move the nodes there or mesh the body anew.";
      throw BadInput(text.str());
    }

    /// The file must begin as a Gmsh file does, have numbers for nodes, and elements up to their
    /// end.
    /// @throws BadInput
    void check_text(std::istream &input, const std::string &complaint)
    {
      const std::string text((std::istreambuf_iterator<char>(input)),
                             std::istreambuf_iterator<char>());
      input.clear();
      input.seekg(0);
      const auto begin = text.find_first_not_of(" \t\r\n");
      if (begin == std::string::npos)
        throw BadInput(complaint + "is empty; export it again.");
      if (text[begin] != '$')
        throw BadInput(complaint + "is no Gmsh file: it does not begin with '$'.");
      if (text.find("$EndElements") == std::string::npos &&
          text.find("$ENDELM") == std::string::npos)
        throw BadInput(complaint + "is cut short: its elements have no end; export it again.");
      const auto nodes = std::min(text.find("$Nodes"), text.find("$NOD"));
      for (const char *const word : {"nan", "NaN", "inf"})
        if (nodes != std::string::npos && text.find(word, nodes) < text.find('$', nodes + 1))
          throw BadInput(complaint + "has a node at " + word +
                         ", which is no number; export it again.");
    }

    std::string first_line(const std::exception &error)
    {
      std::ostringstream text;
      if (const auto *own = dynamic_cast<const dealii::ExceptionBase *>(&error))
        own->print_info(text);
      else
        text << error.what();
      std::string line;
      std::istringstream lines(text.str());
      while (line.find_first_not_of(' ') == std::string::npos && std::getline(lines, line))
        ;
      line.erase(0, line.find_first_not_of(' '));
      return line;
    }
  } // namespace

  Mesh tetrahedral_mesh(MPI_Comm communicator, const Body &body, const double size)
  {
    return made_on_rank_0(communicator, [&]() {
      std::ostringstream complaint;
      complaint << "No tetrahedra could be made of the body with Discretization/Mesh size = "
                << size << " m: ";
      Mesh mesh;
      try
      {
        mesh = body.n_labels() == 1 ? mesh_surface(body.surface(), size) : mesh_labels(body, size);
      }
      catch (const std::exception &error)
      {
        throw BadInput(complaint.str() + error.what() + "; repair the surface or change the size.");
      }
      if (mesh.n_cells() == 0)
        throw BadInput(complaint.str() + "not one fits in; give a smaller size.");
      return mesh;
    });
  }

  Mesh read_gmsh(MPI_Comm communicator, const std::string &file, const double scale)
  {
    return made_on_rank_0(communicator, [&]() {
      const std::string complaint = "Discretization/Mesh file = " + file + " ";
      check_file("Discretization/Mesh file = " + file, file);
      std::ifstream input(file);
      check_text(input, complaint);
      dealii::Triangulation<3> triangulation;
      dealii::GridIn<3> reader(triangulation);
      try
      {
        reader.read_msh(input);
      }
      catch (const dealii::GridIn<3>::ExcInvalidVertexIndexGmsh &)
      {
        throw BadInput(complaint +
                       "has an element with a node that is not in the file; export it again.");
      }
      catch (const std::exception &error)
      {
        throw BadInput(
          complaint +
          "cannot be read as a Gmsh mesh (MSH 1, 2 or 4, ASCII, straight cells), damaged "
          "or of another kind: " +
          first_line(error));
      }

      Mesh mesh;
      mesh.corners_per_cell = triangulation.begin_active()->n_vertices();
      for (const Point &X : triangulation.get_vertices())
        mesh.vertices.push_back(scale * X);
      for (const auto &cell : triangulation.active_cell_iterators())
      {
        if (cell->n_vertices() != mesh.corners_per_cell || cell->n_vertices() % 4 != 0)
          throw BadInput(complaint + "mixes kinds of cells or has others than tetrahedra and "
                                     "hexahedra; save one kind alone.");
        for (const unsigned int v : cell->vertex_indices())
          mesh.corners.push_back(cell->vertex_index(v));
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() != 0)
          {
            for (const unsigned int v : face->vertex_indices())
              mesh.face_corners.push_back(face->vertex_index(v));
            mesh.face_patches.push_back(face->boundary_id());
          }
      }
      check_sides(triangulation, complaint);
      if (mesh.corners_per_cell == 4)
        put_in_order(mesh);
      return mesh;
    });
  }

  Mesh kuhn_box(const Point &size, const std::array<unsigned int, 3> &n)
  {
    Mesh mesh;
    const auto vertex = [&n](const std::array<unsigned int, 3> &i) {
      return (i[2] * (n[1] + 1) + i[1]) * (n[0] + 1) + i[0];
    };
    for (unsigned int k = 0; k <= n[2]; ++k)
      for (unsigned int j = 0; j <= n[1]; ++j)
        for (unsigned int i = 0; i <= n[0]; ++i)
          mesh.vertices.emplace_back(i * size[0] / n[0], j * size[1] / n[1], k * size[2] / n[2]);

    for (unsigned int k = 0; k < n[2]; ++k)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int i = 0; i < n[0]; ++i)
        {
          // A tetrahedron is a path along the cuboid's edges; an odd permutation of the axes turns
          // it round.
          std::array<unsigned int, 3> axes = {{0, 1, 2}};
          do
          {
            std::array<unsigned int, 3> at = {{i, j, k}};
            std::array<unsigned int, 4> corners;
            corners[0] = vertex(at);
            for (unsigned int step = 0; step < 3; ++step)
            {
              ++at[axes[step]];
              corners[step + 1] = vertex(at);
            }
            if ((axes[1] + 3 - axes[0]) % 3 != 1)
              std::swap(corners[1], corners[2]);
            mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
          } while (std::next_permutation(axes.begin(), axes.end()));
        }
    return mesh;
  }

  double volume(const Mesh &mesh)
  {
    // The corners of a hexahedron around its diagonal from corner 0 to 7.
    constexpr unsigned int ring[] = {1, 3, 2, 6, 4, 5, 1};
    double result                 = 0;
    for (std::size_t cell = 0; cell < mesh.n_cells(); ++cell)
    {
      const unsigned int *v = &mesh.corners[cell * mesh.corners_per_cell];
      if (mesh.corners_per_cell == 4)
        result += volume_of(mesh, v[0], v[1], v[2], v[3]);
      else
        for (unsigned int k = 0; k < 6; ++k)
          result += volume_of(mesh, v[0], v[ring[k]], v[ring[k + 1]], v[7]);
    }
    return result;
  }
} // namespace softcell
