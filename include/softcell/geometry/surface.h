// SPDX-License-Identifier: LGPL-2.1-or-later
// Closed triangle surfaces: reading, checking, repairing, and exact questions of inside, distance
// and clipping.
#pragma once

#include <softcell/base/types.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// A triangle surface with outward normals, whose triangles belong to numbered patches. It does
  /// not change after construction, and all of its questions may be asked from several threads.
  class Surface
  {
  public:
    using Triangle = std::array<unsigned int, 3>;

    /// @param patches patch number of each triangle; empty: all of them 0.
    Surface(std::vector<Point> vertices,
            std::vector<Triangle> triangles,
            std::vector<unsigned int> patches = {});
    ~Surface();
    Surface(Surface &&) noexcept;
    Surface &operator=(Surface &&) noexcept;

    const std::vector<Point> &vertices() const
    {
      return vertices_;
    }
    const std::vector<Triangle> &triangles() const
    {
      return triangles_;
    }
    const std::vector<unsigned int> &patches() const
    {
      return patches_;
    }

    /// The corners of one triangle.
    std::array<Point, 3> corners(unsigned int triangle) const;
    /// Unit outward normal of one triangle.
    Direction normal(unsigned int triangle) const;
    /// Units: m^2
    double area(unsigned int triangle) const;

    /// Units: m^2
    double area() const;
    /// Volume enclosed, by the divergence theorem; negative if the normals point inward. Units: m^3
    double volume() const;
    Box bounding_box() const;

    /// Is X inside a closed surface? Points on the surface belong to either side.
    ///
    /// Counts the triangles above X. The signs that decide are exact for vertices moved by one
    /// rounding of (vertex - X), and a ray through an edge or vertex counts as one infinitesimally
    /// beside it, so that no position of X can miscount.
    bool contains(const Point &X) const;
    /// Numbers of the triangles that meet the closed box.
    std::vector<unsigned int> triangles_in(const Box &box) const;
    bool meets(const Box &box) const;
    /// The point of the surface nearest to X and the triangle that holds it.
    std::pair<Point, unsigned int> nearest(const Point &X) const;

  private:
    class Tree; // of boxes around the triangles

    std::vector<Point> vertices_;
    std::vector<Triangle> triangles_;
    std::vector<unsigned int> patches_;
    std::unique_ptr<const Tree> tree_;
  };

  /// The part of a triangle that lies in a closed box: a convex polygon of at most nine corners in
  /// the triangle's order, empty if they do not meet (Sutherland-Hodgman clipping). A triangle in
  /// the face between two boxes is part of both.
  std::vector<Point> clip(const std::array<Point, 3> &triangle, const Box &box);

  /// Reads an OFF, OBJ, STL, PLY, VTP or legacy VTK file; the format is told by the name's ending.
  ///
  /// The surface comes back closed, two-manifold, free of self-intersections and with outward
  /// normals, or BadInput says what is wrong and where. Duplicate points are merged, degenerate
  /// triangles and stray specks dropped, inside-out parts turned; each repair adds a sentence to
  /// `repairs`. Patches are the solids of a text STL, the groups of an OBJ, the cell data "patch"
  /// of a VTP.
  ///
  /// @param scale factor from the file's unit to metres (0.001 for a file in millimetres).
  Surface read_surface(const std::string &file, double scale, std::vector<std::string> &repairs);

  /// Writes the surface with point data as VTP for ParaView. Each entry of `vectors` has one value
  /// per vertex.
  void write_vtp(const std::string &file,
                 const Surface &surface,
                 const std::vector<std::pair<std::string, std::vector<Direction>>> &vectors);
} // namespace softcell
