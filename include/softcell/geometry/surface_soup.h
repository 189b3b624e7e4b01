// SPDX-License-Identifier: LGPL-2.1-or-later
// What a surface file holds before anything is known of it, and how it becomes a closed surface.
#pragma once

#include <softcell/geometry/surface.h>

namespace softcell
{
  /// Points and polygons that may or may not hang together.
  struct SurfaceSoup
  {
    std::vector<Point> points;
    std::vector<std::vector<unsigned int>> polygons; // at least three corners each
    std::vector<unsigned int> patches;               // one per polygon, or empty
    bool is_unconnected = false; // the format repeats the points of each polygon (STL)
  };

  /// Reads the polygons of a VTP or of a legacy VTK file; integers named "patch" in its cell data
  /// are the patches.
  /// @throws BadInput
  SurfaceSoup read_vtk_soup(const std::string &file);

  /// Makes a closed, two-manifold surface with outward normals and without self-intersections of a
  /// soup.
  ///
  /// Repairs what can be repaired without guessing, with a sentence for each in `repairs`.
  /// Orientation is that which bounds a volume: a part within another one is a hole in it.
  ///
  /// @param name what messages start with: the file.
  /// @throws BadInput with the number of defects and the first places, in the soup's coordinates
  Surface close_surface(const SurfaceSoup &soup,
                        const std::string &name,
                        std::vector<std::string> &repairs);
} // namespace softcell
