// SPDX-License-Identifier: LGPL-2.1-or-later
// The body enclosed by a closed triangle surface.
#pragma once

#include <softcell/geometry/body.h>
#include <softcell/geometry/surface.h>

namespace softcell
{
  /// The body that a closed triangle surface with outward normals encloses.
  class SurfaceBody : public Body
  {
  public:
    explicit SurfaceBody(Surface surface);

    Box bounding_box() const override;
    bool contains(const Point &X) const override;

    /// Of a cut box the surface comes nearer to its centre than the box's sides by 1e-9 of their
    /// length, so that a box whose side lies in a flat part of the surface is inside or outside.
    Side classify(const Box &box) const override;

    /// Exact but for round-off, for every position of the box.
    ///
    /// The body's length along z within the box, integrated over the box's floor. On each vertical
    /// line it is the sum over the triangles above the floor of sign(n_z) min(z - z_floor, height),
    /// which depends continuously on the box; no inside test and no special position is involved.
    double filled_volume(const Box &box) const override;

    double volume() const override;
    const Surface &surface() const override;

  private:
    Surface surface_;
    Box bounding_box_;
    double volume_;
  };
} // namespace softcell
