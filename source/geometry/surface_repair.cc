// SPDX-License-Identifier: LGPL-2.1-or-later
// Checks that polygons form a closed surface that bounds a volume, and repairs what is safe to
// repair.

#include <softcell/geometry/surface_soup.h>

#include <softcell/base/exceptions.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <sstream>

namespace softcell
{
  namespace
  {
    namespace PMP = CGAL::Polygon_mesh_processing;
    using Kernel  = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Mesh    = CGAL::Surface_mesh<Kernel::Point_3>;

    /// Where a triangle of the mesh came from: its patch and its first two corners as the file
    /// orders them.
    struct Origin
    {
      unsigned int patch = 0;
      Mesh::Vertex_index from, to;
    };
    using Origins = Mesh::Property_map<Mesh::Face_index, Origin>;

    std::string plural(const std::size_t n, const std::string &singular, const std::string &plural)
    {
      return std::to_string(n) + " " + (n == 1 ? singular : plural);
    }

    /// "(x, y, z), (x, y, z)": the first few of some places.
    std::string first_places(const std::vector<Point> &places)
    {
      std::ostringstream text;
      for (unsigned int i = 0; i < std::min<std::size_t>(places.size(), 3); ++i)
        text << (i > 0 ? ", (" : "(") << places[i][0] << ", " << places[i][1] << ", "
             << places[i][2] << ")";
      return text.str();
    }

    /// Triangles of distinct points, with their patches.
    struct TriangleSoup
    {
      std::vector<Point> points;
      std::vector<std::vector<std::size_t>> triangles; // three each
      std::vector<unsigned int> patches;
    };

    void check_points(const SurfaceSoup &soup, const std::string &name)
    {
      if (soup.polygons.empty())
        throw BadInput(name + ": the file holds no triangles but " +
                       plural(soup.points.size(), "point", "points") + "; save it as a surface.");
      std::size_t n_bad = 0, first_bad = 0;
      for (std::size_t i = soup.points.size(); i-- > 0;)
        if (const Point &X = soup.points[i];
            !std::isfinite(X[0]) || !std::isfinite(X[1]) || !std::isfinite(X[2]))
        {
          ++n_bad;
          first_bad = i;
        }
      if (n_bad > 0)
        throw BadInput(name + ": " + plural(n_bad, "point has", "points have") +
                       " a coordinate that is NaN or infinite, the first is point " +
                       std::to_string(first_bad) + " (from 0); export the file again.");
      for (std::size_t i = 0; i < soup.polygons.size(); ++i)
      {
        if (soup.polygons[i].size() < 3)
          throw BadInput(name + ": polygon " + std::to_string(i) + " (from 0) has only " +
                         plural(soup.polygons[i].size(), "corner", "corners") +
                         "; export the file again.");
        for (const unsigned int v : soup.polygons[i])
          if (v >= soup.points.size())
            throw BadInput(name + ": polygon " + std::to_string(i) + " (from 0) uses point " +
                           std::to_string(v) + " but the file has only " +
                           std::to_string(soup.points.size()) +
                           " points; it is damaged, export it again.");
      }
    }

    /// Merges points of the same coordinates, splits polygons by a fan from a corner, and drops
    /// triangles that have fewer than three distinct points or occur twice.
    TriangleSoup as_triangles(const SurfaceSoup &soup, std::vector<std::string> &repairs)
    {
      TriangleSoup result;
      std::map<std::array<double, 3>, std::size_t> places;
      std::vector<std::size_t> merged;
      for (const Point &X : soup.points)
      {
        const auto [entry, is_new] =
          places.emplace(std::array<double, 3>{X[0] + 0., X[1] + 0., X[2] + 0.}, // no -0
                         result.points.size());
        if (is_new)
          result.points.push_back(X);
        merged.push_back(entry->second);
      }
      if (const std::size_t n = soup.points.size() - result.points.size();
          n > 0 && !soup.is_unconnected)
        repairs.push_back(plural(n, "point was", "points were") +
                          " merged with another one at the same place");

      std::size_t n_split = 0, n_degenerate = 0, n_double = 0;
      std::set<std::array<std::size_t, 3>> known;
      for (std::size_t i = 0; i < soup.polygons.size(); ++i)
      {
        const auto &polygon = soup.polygons[i];
        n_split += polygon.size() > 3;
        for (std::size_t k = 2; k < polygon.size(); ++k)
        {
          const std::array<std::size_t, 3> corners = {merged[polygon[0]], merged[polygon[k - 1]],
                                                      merged[polygon[k]]};
          auto sorted                              = corners;
          std::sort(sorted.begin(), sorted.end());
          if (sorted[0] == sorted[1] || sorted[1] == sorted[2])
            ++n_degenerate;
          else if (!known.insert(sorted).second)
            ++n_double;
          else
          {
            result.triangles.emplace_back(corners.begin(), corners.end());
            result.patches.push_back(soup.patches.empty() ? 0 : soup.patches[i]);
          }
        }
      }
      if (n_split > 0)
        repairs.push_back(plural(n_split, "polygon was", "polygons were") +
                          " split into triangles");
      if (n_degenerate > 0)
        repairs.push_back(plural(n_degenerate, "triangle", "triangles") +
                          " with fewer than three distinct corners dropped");
      if (n_double > 0)
        repairs.push_back(plural(n_double, "triangle", "triangles") +
                          " given twice, of which one was kept");
      return result;
    }

    /// Every edge must belong to two triangles.
    void check_edges(const TriangleSoup &soup, const std::string &name)
    {
      std::map<std::pair<std::size_t, std::size_t>, unsigned int> n_triangles;
      for (const auto &t : soup.triangles)
        for (unsigned int i = 0; i < 3; ++i)
          ++n_triangles[std::minmax(t[i], t[(i + 1) % 3])];

      std::vector<Point> open, crowded; // middles of the edges
      for (const auto &[edge, n] : n_triangles)
        if (n != 2)
          (n == 1 ? open : crowded)
            .push_back(soup.points[edge.first] +
                       0.5 * (soup.points[edge.second] - soup.points[edge.first]));
      if (!crowded.empty())
        throw BadInput(
          name + ": the surface is not a manifold: " +
          plural(crowded.size(), "edge belongs", "edges belong") +
          " to more than two triangles, the first at " + first_places(crowded) +
          "; remove inner walls and overlapping parts (Repair Non Manifold Edges of MeshLab).");
      if (!open.empty())
        throw BadInput(
          name + ": the surface is open: " + plural(open.size(), "edge belongs", "edges belong") +
          " to one triangle only, the first at " + first_places(open) +
          "; close it (Close Holes of MeshLab), or copy the file again if it may be truncated.");
    }

    /// Gives the triangles one orientation and makes a mesh of them.
    Mesh as_mesh(TriangleSoup soup, const std::string &name)
    {
      const std::size_t n_points = soup.points.size();
      const auto triangles       = soup.triangles;
      std::vector<Kernel::Point_3> points;
      for (const Point &X : soup.points)
        points.emplace_back(X[0], X[1], X[2]);
      if (!PMP::orient_polygon_soup(points, soup.triangles))
      {
        // it has given each sheet its own copy of the points where sheets meet
        std::vector<Point> places;
        for (std::size_t i = n_points; i < points.size(); ++i)
          places.emplace_back(points[i].x(), points[i].y(), points[i].z());
        throw BadInput(
          name + ": the surface is not a manifold: parts of it touch or cannot be oriented at " +
          plural(places.size(), "point", "points") + ", the first at " + first_places(places) +
          "; move them apart or join them (Repair Non Manifold Vertices of MeshLab).");
      }

      Mesh mesh;
      PMP::polygon_soup_to_polygon_mesh(points, soup.triangles, mesh);
      Origins origins = mesh.add_property_map<Mesh::Face_index, Origin>("origin").first;
      for (std::size_t i = 0; i < triangles.size(); ++i)
        origins[Mesh::Face_index(i)] = {soup.patches[i], Mesh::Vertex_index(triangles[i][0]),
                                        Mesh::Vertex_index(triangles[i][1])};
      return mesh;
    }

    Point centre(const Mesh &mesh, const Mesh::Face_index face)
    {
      Point sum;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(face)))
        for (unsigned int d = 0; d < 3; ++d)
          sum[d] += mesh.point(v)[d] / 3;
      return sum;
    }

    Surface as_surface(const Mesh &mesh)
    {
      std::vector<Point> vertices;
      std::vector<Surface::Triangle> triangles;
      std::vector<unsigned int> patches;
      std::vector<unsigned int> number(mesh.num_vertices()); // without the removed ones
      for (const auto v : mesh.vertices())
      {
        number[v] = vertices.size();
        vertices.emplace_back(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
      }
      const Origins origins = mesh.property_map<Mesh::Face_index, Origin>("origin").first;
      for (const auto face : mesh.faces())
      {
        Surface::Triangle &corners = triangles.emplace_back();
        unsigned int n             = 0;
        for (const auto v : mesh.vertices_around_face(mesh.halfedge(face)))
          corners[n++] = number[v];
        patches.push_back(origins[face].patch);
      }
      return Surface(std::move(vertices), std::move(triangles), std::move(patches));
    }

    /// Triangles whose three distinct corners lie on a line.
    void remove_slivers(Mesh &mesh, const std::string &name, std::vector<std::string> &repairs)
    {
      std::vector<Mesh::Face_index> flat;
      PMP::degenerate_faces(mesh, std::back_inserter(flat));
      if (flat.empty())
        return;
      std::vector<Point> places;
      for (const auto face : flat)
        places.push_back(centre(mesh, face));
      if (!PMP::remove_degenerate_faces(mesh))
        throw BadInput(name + ": " + plural(flat.size(), "triangle has", "triangles have") +
                       " no area, the first at " + first_places(places) +
                       ", and cannot be removed; remesh the surface.");
      repairs.push_back(plural(flat.size(), "triangle", "triangles") +
                        " without area removed, the first at " + first_places(places));
    }

    /// Drops connected parts that enclose next to nothing.
    void remove_specks(Mesh &mesh, std::vector<std::string> &repairs)
    {
      const double smallest = 1e-4; // relative to the largest part
      const auto parts      = mesh.add_property_map<Mesh::Face_index, std::size_t>("part").first;
      const auto n_parts    = PMP::connected_components(mesh, parts);

      std::vector<double> volumes(n_parts, 0.);
      std::vector<Kernel::Point_3> anchors(
        n_parts); // a point of each part, lest distant parts lose digits
      for (const auto face : mesh.faces())
        anchors[parts[face]] = mesh.point(mesh.target(mesh.halfedge(face)));
      for (const auto face : mesh.faces())
      {
        const auto h = mesh.halfedge(face);
        volumes[parts[face]] +=
          CGAL::volume(anchors[parts[face]], mesh.point(mesh.source(h)), mesh.point(mesh.target(h)),
                       mesh.point(mesh.target(mesh.next(h))));
      }
      double largest = 0;
      for (double &volume : volumes)
        largest = std::max(largest, volume = std::abs(volume));

      std::vector<std::size_t> kept;
      for (std::size_t i = 0; i < n_parts; ++i)
        if (volumes[i] >= smallest * largest)
          kept.push_back(i);
      const std::size_t n_faces = mesh.number_of_faces();
      if (kept.size() < n_parts)
      {
        PMP::keep_connected_components(mesh, kept, parts);
        std::ostringstream text;
        text << plural(n_parts - kept.size(), "stray speck", "stray specks") << " ("
             << plural(n_faces - mesh.number_of_faces(), "triangle", "triangles")
             << ") with less than " << smallest << " of the largest part's volume dropped";
        repairs.push_back(text.str());
      }
      mesh.remove_property_map(const_cast<std::remove_const_t<decltype(parts)> &>(parts));
    }

    bool has_face(const Mesh &mesh, const Mesh::Face_index face)
    {
      return face < Mesh::Face_index(mesh.num_faces()) && !mesh.is_removed(face);
    }

    /// In ascending order.
    std::array<Mesh::Vertex_index, 3> corners(const Mesh &mesh, const Mesh::Face_index face)
    {
      std::array<Mesh::Vertex_index, 3> result;
      auto next = result.begin();
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(face)))
        *next++ = v;
      std::sort(result.begin(), result.end());
      return result;
    }

    void remove_self_intersections(Mesh &mesh,
                                   const std::string &name,
                                   std::vector<std::string> &repairs)
    {
      const double changed_at_most = 1e-3; // of the volume
      std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
      PMP::self_intersections(mesh, std::back_inserter(pairs));
      if (pairs.empty())
        return;
      std::vector<Point> places;
      for (const auto &[a, b] : pairs)
        places.push_back(centre(mesh, a));
      const std::string found = plural(pairs.size(), "pair", "pairs") + " of triangles";

      const double volume = PMP::volume(mesh);
      Mesh trial          = mesh;
      const bool success  = PMP::experimental::remove_self_intersections(trial) &&
                           CGAL::is_closed(trial) && !PMP::does_self_intersect(trial);
      if (!success || std::abs(PMP::volume(trial) - volume) > changed_at_most * std::abs(volume))
        throw BadInput(name + ": the surface intersects itself: " + found + " do, the first at " +
                       first_places(places) +
                       "; separate or remesh these places (Remeshing of MeshLab).");

      // new triangles, to which CGAL gives numbers of old ones, belong to the patch that is nearest
      const Surface before  = as_surface(mesh);
      const Origins origins = trial.property_map<Mesh::Face_index, Origin>("origin").first;
      for (const auto face : trial.faces())
        if (!has_face(mesh, face) || corners(mesh, face) != corners(trial, face))
          origins[face] = {before.patches()[before.nearest(centre(trial, face)).second], {}, {}};
      mesh = std::move(trial);
      repairs.push_back("self-intersections of " + found + " removed, the first at " +
                        first_places(places));
    }

    /// Outward normals; a part within another one is a hole in it.
    void orient(Mesh &mesh, std::vector<std::string> &repairs)
    {
      PMP::orient_to_bound_a_volume(mesh);
      const Origins origins = mesh.property_map<Mesh::Face_index, Origin>("origin").first;
      std::size_t n_turned  = 0;
      for (const auto face : mesh.faces())
      {
        const Origin &origin = origins[face];
        for (const auto h : mesh.halfedges_around_face(mesh.halfedge(face)))
          n_turned += mesh.source(h) == origin.to && mesh.target(h) == origin.from;
      }
      if (n_turned == mesh.number_of_faces())
        repairs.push_back("the surface was inside out: its " + std::to_string(n_turned) +
                          " triangles were turned outward");
      else if (n_turned > 0)
        repairs.push_back(plural(n_turned, "triangle was", "triangles were") +
                          " inside out and turned outward");
    }
  } // namespace

  Surface
  close_surface(const SurfaceSoup &soup, const std::string &name, std::vector<std::string> &repairs)
  {
    check_points(soup, name);
    std::vector<std::string> found;
    TriangleSoup triangle_soup = as_triangles(soup, found);
    check_edges(triangle_soup, name);
    Mesh mesh = as_mesh(std::move(triangle_soup), name);
    remove_slivers(mesh, name, found);
    remove_specks(mesh, found);
    remove_self_intersections(mesh, name, found);
    orient(mesh, found);
    Surface surface = as_surface(mesh);
    if (!(surface.volume() > 0))
      throw BadInput(name +
                     ": the surface encloses no volume; give a closed surface of a solid body.");
    for (const std::string &repair : found)
      repairs.push_back(name + ": " + repair + ".");
    return surface;
  }
} // namespace softcell
