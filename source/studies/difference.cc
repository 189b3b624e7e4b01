// SPDX-License-Identifier: LGPL-2.1-or-later
// How far a discretization's displacement is from another's, or from a known one.

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
      std::vector<unsigned char> labels; // of the material
    };

    /// Takes in patches from `patch_number` on until there are enough points.
    /// @param field field(patch, q, X) is the reference's displacement and gradient at point q of
    ///              the patch, which lies at X.
    template <class Field>
    Samples
    next_samples(const Discretization &reference, const Field &field, unsigned int &patch_number)
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
          const auto [value, gradient] = field(patch, q, points[q]);
          samples.points.push_back(points[q]);
          samples.weights.push_back(patch.weights[q]);
          samples.values.push_back(value);
          samples.gradients.push_back(gradient);
          samples.labels.push_back(patch.label(q));
        }
      }
      return samples;
    }

    /// 0 where the law has no value. Units: Pa
    Matrix3<double> cauchy_stress(const Material &material, const Gradient &gradient)
    {
      const Matrix3<double> F = deformation_gradient(gradient);
      return material.visit([&](const auto &law) {
        return law.is_admissible(determinant(F)) ? law.cauchy_stress(F) : Matrix3<double>();
      });
    }

    double ratio(const double error, const double norm)
    {
      if (norm == 0)
        return error == 0 ? 0 : std::numeric_limits<double>::infinity();
      return std::sqrt(error / norm);
    }

    template <class Field>
    Difference integrate_difference(const Discretization &discretization,
                                    const Vector &u,
                                    const Discretization &reference,
                                    const Field &field,
                                    const std::vector<Material> &materials,
                                    const double reach)
    {
      const MPI_Comm communicator = reference.communicator();

      enum : unsigned int
      {
        l2_error,
        l2_norm,
        h1_error,
        h1_norm,
        stress_error,
        stress_norm,
        volume,
        missed,
        n_sums
      };
      std::array<double, n_sums> sums{};
      unsigned int patch_number = 0;
      bool somebody_has_more    = true;
      while (somebody_has_more)
      {
        const Samples samples   = next_samples(reference, field, patch_number);
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
          const Material &material = materials[samples.labels[k]];
          const auto stress        = cauchy_stress(material, samples.gradients[k]);
          const auto error         = cauchy_stress(material, other.gradients[k]) - stress;
          sums[stress_error] += weight * double_contraction(error, error);
          sums[stress_norm] += weight * double_contraction(stress, stress);
        }
        somebody_has_more =
          dealii::Utilities::MPI::logical_or(patch_number < reference.n_patches(), communicator);
      }

      dealii::Utilities::MPI::sum(View<const double>(sums), communicator, View<double>(sums));
      return {ratio(sums[l2_error], sums[l2_norm]), ratio(sums[h1_error], sums[h1_norm]),
              ratio(sums[stress_error], sums[stress_norm]), sums[missed] / sums[volume]};
    }
  } // namespace

  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &reference,
                        const Vector &reference_u,
                        const std::vector<Material> &materials,
                        const double reach)
  {
    const auto field = [&](const Patch &patch, const unsigned int q, const Point &) {
      return std::pair(interpolate(patch.nodes, patch.shapes->value(q), reference_u),
                       interpolate_gradient(patch.nodes, patch.shapes->gradient(q), reference_u));
    };
    return integrate_difference(discretization, u, reference, field, materials, reach);
  }

  Difference difference(const Discretization &discretization,
                        const Vector &u,
                        const Discretization &points,
                        const ManufacturedSolution &exact,
                        const std::vector<Material> &materials,
                        const double reach)
  {
    const auto field = [&](const Patch &, unsigned int, const Point &X) {
      return std::pair(exact.displacement(X), exact.gradient(X));
    };
    return integrate_difference(discretization, u, points, field, materials, reach);
  }

  SurfaceDifference surface_difference(const DisplacementField &field,
                                       const DisplacementField &reference,
                                       const std::vector<Point> &vertices)
  {
    // every rank asks for its share
    const MPI_Comm communicator = field.discretization.communicator();
    const unsigned int n_ranks  = dealii::Utilities::MPI::n_mpi_processes(communicator);
    std::vector<Point> points;
    for (std::size_t i = dealii::Utilities::MPI::this_mpi_process(communicator);
         i < vertices.size(); i += n_ranks)
      points.push_back(vertices[i]);
    const PointValues one = evaluate(field.discretization, field.u, points, field.reach);
    const PointValues other =
      evaluate(reference.discretization, reference.u, points, reference.reach);

    double sum = 0, max = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double error = (one.displacements[i] - other.displacements[i]).norm();
      sum += error;
      max = std::max(max, error);
    }
    return {dealii::Utilities::MPI::sum(sum, communicator) / vertices.size(),
            dealii::Utilities::MPI::max(max, communicator)};
  }

  std::unique_ptr<Discretization> finer_points(const DiscretizationParameters &parameters,
                                               const GeometryParameters &geometry,
                                               const Body &body,
                                               MPI_Comm communicator)
  {
    DiscretizationParameters finer = parameters;
    finer.method                   = "finite cell";
    finer.cut                      = CutParameters();
    finer.cut.levels               = 1; // where the boundary is matters little to a mean
    for (unsigned int &n : finer.grid.cells)
      n *= 2;
    finer.grid.cell_size /= 2;
    if (parameters.method == "tetrahedra" && parameters.mesh.size > 0)
      finer.grid.cell_size = parameters.mesh.size / 2;
    finer.grid.smallest_volume_fraction = 0;
    std::vector<std::string> remarks;
    return make_discretization(finer, geometry, body, communicator, remarks);
  }
} // namespace softcell
