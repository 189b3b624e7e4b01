// SPDX-License-Identifier: LGPL-2.1-or-later
// The displacement at points whose cells may belong to any rank.

#include <softcell/discretization/evaluation.h>

#include <deal.II/base/mpi.h>

#include <boost/serialization/utility.hpp> // a Box is a pair of points

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace softcell
{
  namespace
  {
    constexpr unsigned int answer_size = 2 + 3 + 9; // claim, displacement, gradient

    double distance(const Point &X, const Box &box)
    {
      const auto &[lower, upper] = box.get_boundary_points();
      Direction gap;
      for (unsigned int c = 0; c < 3; ++c)
        gap[c] = std::max({lower[c] - X[c], X[c] - upper[c], 0.});
      return gap.norm();
    }

    /// Appends this rank's answer for one point.
    void answer(const Discretization &discretization,
                const Vector &u,
                const Point &X,
                const double reach,
                std::vector<double> &answers)
    {
      const auto shapes = discretization.shapes_at(X, reach);
      if (!shapes)
      {
        answers.push_back(Claim().distance);
        answers.resize(answers.size() + answer_size - 1);
        return;
      }
      answers.push_back(shapes->claim.distance);
      answers.push_back(shapes->claim.precedence);
      const Direction value   = interpolate(shapes->nodes, shapes->values.data(), u);
      const Gradient gradient = interpolate_gradient(shapes->nodes, shapes->gradients.data(), u);
      answers.insert(answers.end(), value.begin_raw(), value.end_raw());
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          answers.push_back(gradient[c][d]);
    }

    /// Fills in what the ranks know of those points that are not found yet. Collective.
    void ask_all(const Discretization &discretization,
                 const Vector &u,
                 const std::vector<Point> &points,
                 const double reach,
                 PointValues &result)
    {
      const MPI_Comm communicator = discretization.communicator();
      const auto boxes =
        dealii::Utilities::MPI::all_gather(communicator, discretization.owned_box());

      std::map<unsigned int, std::vector<double>> questions;      // coordinates, by rank
      std::map<unsigned int, std::vector<unsigned int>> asked_of; // numbers of the points, by rank
      for (unsigned int k = 0; k < points.size(); ++k)
      {
        if (!std::isinf(result.distances[k]))
          continue;
        for (unsigned int rank = 0; rank < boxes.size(); ++rank)
        {
          const double round_off =
            1e-12 * boxes[rank].get_boundary_points().first.distance(points[k]);
          if (distance(points[k], boxes[rank]) > reach + round_off)
            continue;
          asked_of[rank].push_back(k);
          questions[rank].insert(questions[rank].end(), points[k].begin_raw(), points[k].end_raw());
        }
      }

      std::map<unsigned int, std::vector<double>> answers;
      for (const auto &[rank, coordinates] :
           dealii::Utilities::MPI::some_to_some(communicator, questions))
      {
        answers[rank].reserve(coordinates.size() / 3 * answer_size);
        for (std::size_t k = 0; k < coordinates.size(); k += 3)
          answer(discretization, u, Point(coordinates[k], coordinates[k + 1], coordinates[k + 2]),
                 reach, answers[rank]);
      }

      std::vector<Claim> claims(points.size());
      for (const auto &[rank, values] : dealii::Utilities::MPI::some_to_some(communicator, answers))
        for (std::size_t i = 0; i < asked_of[rank].size(); ++i)
        {
          const double *const value = values.data() + i * answer_size;
          const unsigned int k      = asked_of[rank][i];
          const Claim claim{value[0], value[1]};
          if (!claim.counts_before(claims[k], 1e-10 * reach))
            continue;
          claims[k]           = claim;
          result.distances[k] = claim.distance;
          for (unsigned int c = 0; c < 3; ++c)
          {
            result.displacements[k][c] = value[2 + c];
            for (unsigned int d = 0; d < 3; ++d)
              result.gradients[k][c][d] = value[5 + 3 * c + d];
          }
        }
    }
  } // namespace

  PointValues evaluate(const Discretization &discretization,
                       const Vector &u,
                       const std::vector<Point> &points,
                       const double reach)
  {
    PointValues result;
    result.displacements.resize(points.size());
    result.gradients.resize(points.size());
    result.distances.resize(points.size(), std::numeric_limits<double>::infinity());
    // A rank looks through all its cells within reach for a point that another one's cell holds,
    // so the points in cells are found first.
    ask_all(discretization, u, points, 0, result);
    if (reach > 0)
      ask_all(discretization, u, points, reach, result);
    return result;
  }

  Vector transferred(const Discretization &from,
                     const Vector &u,
                     const Discretization &to,
                     const double reach)
  {
    const PointValues values = evaluate(from, u, to.node_positions(), reach);
    Vector result            = to.make_vector();
    for (unsigned int node = 0; node < to.n_owned_nodes(); ++node)
      for (unsigned int c = 0; c < 3; ++c)
        result.local_element(3 * node + c) = values.displacements[node][c];
    result.update_ghost_values();
    return result;
  }
} // namespace softcell
