// SPDX-License-Identifier: LGPL-2.1-or-later
// What is asked of loads at the points where they act.

#include "load_checks.h"

#include <softcell/base/collective.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace softcell
{
  std::vector<Point> points_of(const std::vector<SurfacePatch> &patches)
  {
    std::vector<Point> points;
    for (const SurfacePatch &patch : patches)
      points.insert(points.end(), patch.points.begin(), patch.points.end());
    return points;
  }

  LoadChecks::LoadChecks(const Discretization &discretization, const Box &body)
      : discretization_(discretization),
        round_off_(1e-12 *
                   body.get_boundary_points().first.distance(body.get_boundary_points().second)),
        held_(discretization, body)
  {
  }

  void LoadChecks::check_numbers(const Expression &value,
                                 const std::vector<Point> &points,
                                 const bool is_stiffness) const
  {
    std::ostringstream message;
    for (unsigned int tenth = value.uses_time() ? 1 : 10; tenth <= 10; ++tenth)
      for (const Point &X : points)
      {
        const Direction found = value.value(X, tenth / 10.);
        const bool is_number  = std::all_of(found.begin_raw(), found.end_raw(),
                                            [](double c) { return std::isfinite(c); });
        if ((is_number && !(is_stiffness && found[0] < 0)) || !message.str().empty())
          continue;
        message << value.place() << " is " << (is_number ? "negative" : "not a finite number")
                << " at (" << X << "), t = " << tenth / 10.
                << "; mend the expression or the region.";
      }
    throw_on_all(discretization_.communicator(), message.str());
  }

  void LoadChecks::check_agreement(const std::string &place,
                                   const std::vector<SurfacePatch> &patches,
                                   const Expression &displacement)
  {
    std::ostringstream message;
    for (const Point &X : points_of(patches))
    {
      const Direction g = displacement.value(X, 1);
      HeldPoint here{&place, {}};
      for (unsigned int c = 0; c < 3; ++c)
        if (!displacement.is_free(c))
          here.place[c] = g[c];
      const HeldPoint &there = held_points_.emplace(coordinates(X), here).first->second;
      for (unsigned int c = 0; c < 3 && message.str().empty(); ++c)
        if (there.place[c] && here.place[c] &&
            std::abs(*there.place[c] - *here.place[c]) > round_off_)
          message << *there.load << " and " << place << " impose " << *there.place[c] << " m and "
                  << *here.place[c] << " m along "
                  << "xyz"[c] << " at (" << X
                  << "); leave that component `free` in one of them or let the regions not "
                     "meet.";
    }
    throw_on_all(discretization_.communicator(), message.str());
  }

  void LoadChecks::hold(const std::vector<SurfacePatch> &patches,
                        const Expression &displacement,
                        const Expression &stiffness)
  {
    for (const SurfacePatch &patch : patches)
      for (const Point &X : patch.points)
        for (unsigned int c = 0; c < 3; ++c)
          if (!displacement.is_free(c) && stiffness.value(X, 1)[0] > 0)
            held_.hold(patch.nodes[0], X, c);
  }

  void LoadChecks::note_supported(const std::vector<SurfacePatch> &patches,
                                  const Expression &displacement)
  {
    if (displacement.is_free(0) || displacement.is_free(1) || displacement.is_free(2))
      return;
    for (const Point &X : points_of(patches))
      supported_points_.insert(coordinates(X));
  }

  void LoadChecks::note_loaded(const std::string &place, std::vector<Point> points)
  {
    loaded_points_.emplace_back(place, std::move(points));
  }

  std::string LoadChecks::free_motions(const ImposedDisplacement &imposed)
  {
    for (const unsigned int i : imposed.unknowns())
      if (i < discretization_.partitioner()->locally_owned_size())
        held_.hold(i / 3, discretization_.node_positions()[i / 3], i % 3);
    return held_.free_motions();
  }

  std::vector<std::string> LoadChecks::idle_loads() const
  {
    std::vector<std::string> sentences;
    for (const auto &[place, points] : loaded_points_)
    {
      const auto n_moving = std::count_if(points.begin(), points.end(), [&](const Point &X) {
        return supported_points_.count(coordinates(X)) == 0;
      });
      if (dealii::Utilities::MPI::sum(n_moving, discretization_.communicator()) == 0)
        sentences.push_back(place + " deforms nothing: all of its region is held by a "
                                    "clamp or a displacement; mend the region.");
    }
    return sentences;
  }
} // namespace softcell
