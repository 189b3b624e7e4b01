// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a solution errs most: an estimate of the stress's error in each cell.

#include <softcell/operators/error_estimate.h>

#include <softcell/discretization/evaluation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>

namespace softcell
{
  namespace
  {
    /// A symmetric stress: its entries xx, yy, zz and yz, xz, xy.
    using Stress = std::array<Direction, 2>;

    /// What the law takes for the change of volume; 0 where it takes none.
    double volumetric_strain(const Material &material, const Matrix3<double> &F)
    {
      return material.visit([&](const auto &law) {
        return law.is_admissible(determinant(F)) ? law.volumetric_strain(F) : 0;
      });
    }

    Stress
    stress(const Material &material, const Matrix3<double> &F, const double volumetric_strain)
    {
      return material.visit([&](const auto &law) -> Stress {
        if (!law.is_admissible(determinant(F)))
          return {};
        const Matrix3<double> s = law.cauchy_stress(F, law.lambda * volumetric_strain);
        return {Direction({s(0, 0), s(1, 1), s(2, 2)}), Direction({s(1, 2), s(0, 2), s(0, 1)})};
      });
    }

    /// S : C^-1 : S with the isotropic elasticity C = lambda I (x) I + 2 mu.
    double squared(const Material &material, const Stress &S)
    {
      return material.visit([&](const auto &law) {
        const double trace   = S[0][0] + S[0][1] + S[0][2];
        const double product = S[0].norm_square() + 2 * S[1].norm_square();
        return (product - law.lambda / (3 * law.lambda + 2 * law.mu) * trace * trace) /
               (2 * law.mu);
      });
    }

    /// Calls f(i, patch, point, stress) for every point of one material that has a weight.
    template <class Function>
    void for_each_stress(const Discretization &discretization,
                         const std::vector<Material> &materials,
                         const bool has_projection,
                         const unsigned int label,
                         const Vector &u,
                         const Function &f)
    {
      PatchStorage storage;
      std::vector<unsigned int> points;
      std::vector<Matrix3<double>> F;
      std::vector<double> strains;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
      {
        const Patch patch = discretization.patch(i, storage);
        double volume = 0, change = 0;
        points.clear();
        F.clear();
        strains.clear();
        for (unsigned int q = 0; q < patch.n_points(); ++q)
          if (patch.label(q) == label && patch.weights[q] != 0)
          {
            points.push_back(q);
            F.push_back(deformation_gradient(
              interpolate_gradient(patch.nodes, patch.shapes->gradient(q), u)));
            strains.push_back(volumetric_strain(materials[label], F.back()));
            volume += patch.weights[q];
            change += patch.weights[q] * strains.back();
          }
        for (unsigned int k = 0; k < points.size(); ++k)
          f(i, patch, points[k],
            stress(materials[label], F[k], has_projection ? change / volume : strains[k]));
      }
    }
  } // namespace

  std::vector<double> squared_errors(const Discretization &discretization,
                                     const std::vector<Material> &materials,
                                     const bool has_projection,
                                     const Vector &u)
  {
    std::vector<double> result(discretization.n_patches(), 0.);
    for (unsigned int label = 0; label < materials.size(); ++label)
    {
      // by node: sums of the stress and, three times, of the volume
      std::array<Vector, 2> averages = {discretization.make_vector(), discretization.make_vector()};
      Vector volumes                 = discretization.make_vector();
      for_each_stress(discretization, materials, has_projection, label, u,
                      [&](unsigned int, const Patch &patch, const unsigned int q, const Stress &S) {
                        for (unsigned int i = 0; i < patch.n_nodes(); ++i)
                          for (unsigned int c = 0; c < 3; ++c)
                          {
                            const unsigned int entry = 3 * patch.nodes[i] + c;
                            const double weight      = patch.weights[q] * patch.shapes->value(q)[i];
                            averages[0].local_element(entry) += weight * S[0][c];
                            averages[1].local_element(entry) += weight * S[1][c];
                            volumes.local_element(entry) += weight;
                          }
                      });
      for (Vector *const sum : {&averages[0], &averages[1], &volumes})
        sum->compress(dealii::VectorOperation::add);
      for (Vector &average : averages)
      {
        for (unsigned int entry = 0; entry < average.locally_owned_size(); ++entry)
          if (volumes.local_element(entry) > 0) // another material may have the node for itself
            average.local_element(entry) /= volumes.local_element(entry);
        average.update_ghost_values();
      }

      for_each_stress(
        discretization, materials, has_projection, label, u,
        [&](const unsigned int i, const Patch &patch, const unsigned int q, const Stress &S) {
          const double *const N = patch.shapes->value(q);
          result[i] += patch.weights[q] *
                       squared(materials[label], {interpolate(patch.nodes, N, averages[0]) - S[0],
                                                  interpolate(patch.nodes, N, averages[1]) - S[1]});
        });
    }
    return result;
  }

  std::vector<unsigned int> largest_errors(const std::vector<double> &squared_errors,
                                           const double fraction,
                                           MPI_Comm communicator)
  {
    std::vector<double> all;
    for (const auto &some : dealii::Utilities::MPI::all_gather(communicator, squared_errors))
      all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(), std::greater<>());
    double sum = 0, part = 0;
    double threshold = fraction < 1 ? std::numeric_limits<double>::infinity() : 0;
    for (const double error : all)
      sum += error;
    if (fraction < 1)
      for (unsigned int i = 0; i < all.size() && part < fraction * sum; ++i)
      {
        threshold = (1 - 1e-6) * all[i];
        part += all[i];
      }

    std::vector<unsigned int> result;
    for (unsigned int i = 0; i < squared_errors.size(); ++i)
      if (squared_errors[i] >= threshold)
        result.push_back(i);
    return result;
  }
} // namespace softcell
