// SPDX-License-Identifier: LGPL-2.1-or-later
// A discretization without anything, from which tests and benchmarks derive those with little.
#pragma once

#include <softcell/discretization/discretization.h>

namespace softcell
{
  class BareDiscretization : public Discretization
  {
  public:
    Size size() const override
    {
      return {};
    }
    unsigned int degree() const override
    {
      return 1;
    }
    unsigned int n_patches() const override
    {
      return 1;
    }
    Patch patch(unsigned int, PatchStorage &) const override
    {
      return {};
    }
    void patch_points(unsigned int, std::vector<Point> &) const override {}
    std::vector<SurfacePatch> surface_patches(const Region &) const override
    {
      return {};
    }
    std::optional<std::vector<unsigned int>> nodes_on(const Region &) const override
    {
      return {};
    }
    std::optional<PointShapes> shapes_at(const Point &, double) const override
    {
      return {};
    }
    Box owned_box() const override
    {
      return {};
    }
    DrawnCells drawn_cells() const override
    {
      return {};
    }
  };
} // namespace softcell
