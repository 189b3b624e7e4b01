// SPDX-License-Identifier: LGPL-2.1-or-later
// How far one discretization's displacement is from another's.

#include <softcell/studies/difference.h>

#include <softcell/discretization/evaluation.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <cmath>
#include <limits>

namespace softcell
{
  namespace
  {
    constexpr std::size_t points_at_once = 100000; // bounds the memory for messages

    /// Some points of the reference, and its displacement there.
    struct Samples
    {
      std::vector<Point> points;
      std::vector<double> weights;
      std::vector<Direction> values;
      std::vector<Gradient> gradients;
    };

    /// Takes in patches from `patch_number` on until there are enough points.
    Samples
    next_samples(const Discretization &reference, const Vector &u, unsigned int &patch_number)
    {
      Samples samples;
      PatchStorage storage;
      std::vector<Point> points;
      for (; patch_number < reference.n_patches() && samples.points.size() < points_at_once;
           ++patch_number)
      {
        const Patch patch = reference.patch(patch_number, storage);
        reference.patch_points(patch_number, points);
        for (unsigned int q = 0; q < patch.n_points(); ++q)
        {
          samples.points.push_back(points[q]);
          samples.weights.push_back(patch.weights[q]);
          samples.values.push_back(interpolate(patch.nodes, patch.shapes->value(q), u));
          samples.gradients.push_back(
            interpolate_gradient(patch.nodes, patch.shapes->gradient(q), u));
        }
      }
      return samples;
    }

    double ratio(const double error, const double norm)
    {
      if (norm == 0)
        return error == 0 ? 0 : std::numeric_limits<double>::infinity();
      return std::sqrt(error / norm);
    }
  } // namespace

  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &reference,
                        const Vector &reference_u,
                        const double reach)
  {
    const MPI_Comm communicator = reference.communicator();

    enum : unsigned int
    {
      l2_error,
      l2_norm,
      h1_error,
      h1_norm,
      volume,
      missed,
      n_sums
    };
    std::array<double, n_sums> sums{};
    unsigned int patch_number = 0;
    bool somebody_has_more    = true;
    while (somebody_has_more)
    {
      const Samples samples   = next_samples(reference, reference_u, patch_number);
      const PointValues other = evaluate(discretization, u, samples.points, reach);
      for (std::size_t k = 0; k < samples.points.size(); ++k)
      {
        const double weight = samples.weights[k];
        sums[volume] += weight;
        if (std::isinf(other.distances[k]))
        {
          sums[missed] += weight;
          continue;
        }
        sums[l2_error] += weight * (other.displacements[k] - samples.values[k]).norm_square();
        sums[l2_norm] += weight * samples.values[k].norm_square();
        sums[h1_error] += weight * (other.gradients[k] - samples.gradients[k]).norm_square();
        sums[h1_norm] += weight * samples.gradients[k].norm_square();
      }
      somebody_has_more =
        dealii::Utilities::MPI::logical_or(patch_number < reference.n_patches(), communicator);
    }

    dealii::Utilities::MPI::sum(View<const double>(sums), communicator, View<double>(sums));
    return {ratio(sums[l2_error], sums[l2_norm]), ratio(sums[h1_error], sums[h1_norm]),
            sums[missed] / sums[volume]};
  }
} // namespace softcell
