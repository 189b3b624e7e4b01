// SPDX-License-Identifier: LGPL-2.1-or-later
// What is asked of loads at the points where they act.
#pragma once

#include <softcell/discretization/discretization.h>
#include <softcell/loads/expression.h>
#include <softcell/loads/imposed_displacement.h>
#include <softcell/loads/rigid_modes.h>

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  inline std::array<double, 3> coordinates(const Point &X)
  {
    return {{X[0], X[1], X[2]}};
  }

  std::vector<Point> points_of(const std::vector<SurfacePatch> &patches);

  /// Do values exist, do supports agree where they meet, is the body held, and does each load move
  /// something? All functions are collective and throw BadInput on all ranks.
  class LoadChecks
  {
  public:
    LoadChecks(const Discretization &discretization, const Box &body);

    /// The value must be a number at every point, that of a stiffness not negative: at full load
    /// and, if it speaks of t, at each tenth of it.
    void check_numbers(const Expression &value,
                       const std::vector<Point> &points,
                       bool is_stiffness = false) const;

    /// Points that an earlier displacement holds too must be held in the same place by both.
    /// Points of the same piece of surface are equal to the last bit.
    /// @param place of the load, for messages; it outlives this.
    void check_agreement(const std::string &place,
                         const std::vector<SurfacePatch> &patches,
                         const Expression &displacement);

    /// Notes that the points cannot move freely where the stiffness is not 0.
    void hold(const std::vector<SurfacePatch> &patches,
              const Expression &displacement,
              const Expression &stiffness);
    /// Notes where the displacement leaves nothing to other loads.
    void note_supported(const std::vector<SurfacePatch> &patches, const Expression &displacement);
    /// @param place of the load that acts there.
    void note_loaded(const std::string &place, std::vector<Point> points);

    /// RigidModes::free_motions() of all supports, empty if none is free.
    std::string free_motions(const ImposedDisplacement &imposed);
    /// A sentence on each load that deforms nothing.
    std::vector<std::string> idle_loads() const;

  private:
    /// Where a displacement imposed by forces puts a point of the surface.
    struct HeldPoint
    {
      const std::string *load; // that holds it, its place
      std::array<std::optional<double>, 3> place;
    };

    const Discretization &discretization_;
    const double round_off_; // of positions. Units: m
    HeldParts held_;
    std::map<std::array<double, 3>, HeldPoint> held_points_;
    std::set<std::array<double, 3>> supported_points_; // held in all components
    std::vector<std::pair<std::string, std::vector<Point>>> loaded_points_; // with the load's place
  };
} // namespace softcell
