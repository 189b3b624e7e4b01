// SPDX-License-Identifier: LGPL-2.1-or-later
// The body enclosed by a closed triangle surface.
#pragma once

#include <softcell/geometry/body.h>
#include <softcell/geometry/surface.h>

#include <string>
#include <vector>

namespace softcell
{
  /// The body that a closed triangle surface with outward normals encloses.
  ///
  /// A closed part of the surface inside another one is a hole, unless its patch is named as a
  /// label: a part whose triangles all are of such a patch is filled by a material of that label,
  /// wherever it lies. Between two materials there is no boundary: surface() leaves such parts out.
  /// A box that one of them meets counts as cut though it is full, so that cut-cell rules refine
  /// towards it.
  class SurfaceBody : public Body
  {
  public:
    /// Of one material.
    explicit SurfaceBody(Surface surface);

    /// @param labels patches: label i + 1 is labels[i], label 0 what is in none of them.
    /// @param name   of the surface, for messages.
    /// @throws BadInput if a label is the patch of no closed part.
    SurfaceBody(const Surface &surface,
                const std::vector<unsigned int> &labels,
                const std::string &name);
    ~SurfaceBody() override;

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

    unsigned int n_labels() const override;
    unsigned int label(const Point &X) const override;
    std::string label_name(unsigned int label) const override;

  private:
    struct Part;

    /// From small to large.
    static std::vector<Part> closed_parts(const Surface &surface);
    /// Labels the parts, and makes the boundary of those that are filled.
    Surface boundary(const std::vector<unsigned int> &labels);

    std::vector<std::string> names_;            // of the labels; empty: one material
    std::vector<unsigned int> triangle_labels_; // of the material at each triangle of the boundary
    std::vector<Part> parts_;
    Surface surface_;
    Box bounding_box_;
    double volume_;
  };
} // namespace softcell
