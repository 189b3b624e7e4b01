// SPDX-License-Identifier: LGPL-2.1-or-later
// Where the body is: the only thing that grids, meshes and cut-cell rules ask of a geometry.
#pragma once

#include <softcell/base/types.h>

namespace softcell
{
  class Surface;

  /// How a box lies to the body.
  enum class Side
  {
    inside, ///< every point of the box is in the body and has the same label
    cut,    ///< the box may hold points of both sides or of two labels
    outside ///< no point of the box is in the body
  };

  /// A point of the true boundary and what it stands for.
  struct BoundaryPoint
  {
    Point X;
    Direction normal;   // unit outward
    double stretch = 1; // area of the boundary per area of the triangle
  };

  /// A closed, bounded set of points of space in its reference configuration. Lengths in m.
  ///
  /// A body gives exact answers for what it is made of: triangles, voxels or a formula. All members
  /// are const and may be called from several threads.
  class Body
  {
  public:
    virtual ~Body() = default;

    /// The smallest axis-parallel box around the body.
    virtual Box bounding_box() const = 0;

    virtual bool contains(const Point &X) const = 0;

    /// `inside` and `outside` are certain; `cut` may be said of a box that the boundary or an
    /// interface of labels only touches.
    virtual Side classify(const Box &box) const = 0;

    /// Volume of what the body fills of the box. Units: m^3
    virtual double filled_volume(const Box &box) const = 0;

    /// Units: m^3
    virtual double volume() const = 0;

    /// The body's boundary as closed triangles, normals outward, in numbered patches.
    virtual const Surface &surface() const = 0;

    /// The point of the true boundary for which a point of a triangle of surface() stands: itself,
    /// but for the curved sides of shapes. Integrals over all triangles become those over the true
    /// boundary.
    /// @param normal,patch of the triangle.
    virtual BoundaryPoint
    on_boundary(const Point &X, const Direction &normal, unsigned int /*patch*/) const
    {
      return {X, normal};
    }

    /// Number of different materials in the body. Labels run from 0 to n_labels() - 1.
    virtual unsigned int n_labels() const
    {
      return 1;
    }

    /// Material label at a point of the body; of a point outside, the label of some near part of
    /// the body.
    virtual unsigned int label(const Point & /*X*/) const
    {
      return 0;
    }

    /// What the user calls a label, for messages and the parameter section `Material NAME`.
    virtual std::string label_name(const unsigned int label) const
    {
      return std::to_string(label);
    }
  };
} // namespace softcell
