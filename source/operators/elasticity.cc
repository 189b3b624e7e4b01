// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body, assembled patch by patch.

#include <softcell/operators/elasticity.h>

#include "inverted_points.h"
#include "volumetric_projection.h"

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>
#include <optional>

namespace softcell
{
  namespace
  {
    /// Calls visit(law, point, F) for the points of patches, with or without projection.
    class Points
    {
    public:
      Points(const Discretization &discretization,
             const std::vector<Material> &materials,
             const bool has_projection,
             const Vector *const base = nullptr)
          : materials_(materials), base_(base)
      {
        if (has_projection)
          projection_.emplace(discretization, materials);
      }

      /// Returns the number of inverted points of patch i.
      template <class Visit>
      unsigned int visit(const unsigned int i, const DeformedPatch &deformed, const Visit &visit)
      {
        if (projection_)
        {
          if (base_ != nullptr)
            deformed_base_.reinit(deformed.patch(), *base_);
          return projection_->for_each_point(i, deformed,
                                             base_ == nullptr ? nullptr : &deformed_base_, visit);
        }
        return for_each_point(
          deformed.patch(), materials_,
          [&](const unsigned int point) { return deformed.deformation_gradient(point); }, visit);
      }

      void add_to_tangent(const DeformedPatch &deformed, PatchTangent &tangent)
      {
        if (projection_)
          projection_->add_to_tangent(deformed, tangent);
      }

    private:
      const std::vector<Material> &materials_;
      std::optional<VolumetricProjection> projection_;
      const Vector *base_;
      DeformedPatch deformed_base_;
    };

    double von_mises(const Matrix3<double> &sigma)
    {
      const double p    = trace(sigma) / 3;
      Matrix3<double> s = sigma;
      for (int i = 0; i < 3; ++i)
        s(i, i) -= p;
      return std::sqrt(1.5 * double_contraction(s, s));
    }
  } // namespace

  Elasticity::Elasticity(const Discretization &discretization,
                         std::vector<Material> materials,
                         const bool has_projection)
      : discretization_(discretization),
        materials_(std::move(materials)),
        has_projection_(has_projection)
  {
  }

  /// Calls function(i, patch) for every patch of this rank.
  template <class Function>
  void Elasticity::for_each_patch(const Function &function) const
  {
    PatchStorage storage;
    for (unsigned int i = 0; i < discretization_.n_patches(); ++i)
      function(i, discretization_.patch(i, storage));
  }

  double Elasticity::energy(const Vector &u) const
  {
    double energy           = 0;
    unsigned int n_inverted = 0;
    DeformedPatch deformed;
    Points points(discretization_, materials_, has_projection_);
    for_each_patch([&](const unsigned int i, const Patch &patch) {
      deformed.reinit(patch, u);
      n_inverted += points.visit(i, deformed, [&](const auto &law, unsigned int point, auto &F) {
        energy += patch.weights[point] * law.energy(F);
      });
    });
    throw_if_inverted(dealii::Utilities::MPI::sum(n_inverted, discretization_.communicator()));
    return dealii::Utilities::MPI::sum(energy, discretization_.communicator());
  }

  void Elasticity::add_residual(const Vector &u, Vector &r, const Vector *const base) const
  {
    unsigned int n_inverted = 0;
    DeformedPatch deformed;
    PatchResidual residual;
    Points points(discretization_, materials_, has_projection_, base);
    for_each_patch([&](const unsigned int i, const Patch &patch) {
      deformed.reinit(patch, u);
      residual.reinit(deformed);
      n_inverted += points.visit(i, deformed, [&](const auto &law, unsigned int point, auto &F) {
        residual.add(law, deformed, point, F);
      });
      residual.scatter(patch.nodes, r);
    });
    throw_if_inverted(dealii::Utilities::MPI::sum(n_inverted, discretization_.communicator()));
  }

  void Elasticity::add_tangent(const Vector &u, BlockMatrix &K, const Vector *const base) const
  {
    unsigned int n_inverted = 0;
    DeformedPatch deformed;
    PatchTangent tangent;
    Points points(discretization_, materials_, has_projection_, base);
    for_each_patch([&](const unsigned int i, const Patch &patch) {
      deformed.reinit(patch, u);
      tangent.reinit(deformed);
      n_inverted += points.visit(i, deformed, [&](const auto &law, unsigned int point, auto &F) {
        tangent.add(law, deformed, point, F);
      });
      points.add_to_tangent(deformed, tangent);
      K.add(patch.nodes, tangent.values());
    });
    throw_if_inverted(dealii::Utilities::MPI::sum(n_inverted, discretization_.communicator()));
  }

  std::vector<std::vector<unsigned int>> Elasticity::couplings() const
  {
    std::vector<std::vector<unsigned int>> lists;
    lists.reserve(discretization_.n_patches());
    for (unsigned int i = 0; i < discretization_.n_patches(); ++i)
      lists.push_back(discretization_.patch_nodes(i));
    return lists;
  }

  PatchAverages Elasticity::averages(const Vector &u) const
  {
    const unsigned int n = discretization_.n_patches();
    PatchAverages averages{std::vector<double>(n, 0.), std::vector<double>(n, 1.)};
    DeformedPatch deformed;
    Points points(discretization_, materials_, has_projection_);
    for_each_patch([&](const unsigned int i, const Patch &patch) {
      double volume = 0, stress = 0, deformed_volume = 0;
      deformed.reinit(patch, u);
      for (unsigned int point = 0; point < patch.n_points(); ++point)
        if (const double weight = patch.weights[point]; weight != 0)
        {
          volume += weight;
          deformed_volume += weight * determinant(deformed.deformation_gradient(point));
        }
      points.visit(i, deformed, [&](const auto &law, unsigned int point, auto &F) {
        stress += patch.weights[point] * von_mises(law.cauchy_stress(F));
      });
      if (volume != 0)
      {
        averages.von_mises[i] = stress / volume;
        averages.jacobian[i]  = deformed_volume / volume;
      }
    });
    return averages;
  }

  double Elasticity::min_jacobian(const Vector &u) const
  {
    double smallest = std::numeric_limits<double>::max();
    DeformedPatch deformed;
    for_each_patch([&](unsigned int, const Patch &patch) {
      deformed.reinit(patch, u);
      for (unsigned int point = 0; point < patch.n_points(); ++point)
        if (patch.weights[point] != 0)
          smallest = std::min(smallest, determinant(deformed.deformation_gradient(point)));
    });
    return dealii::Utilities::MPI::min(smallest, discretization_.communicator());
  }

  double Elasticity::volume() const
  {
    double volume = 0;
    for_each_patch([&](unsigned int, const Patch &patch) {
      for (const double weight : patch.weights)
        volume += weight;
    });
    return dealii::Utilities::MPI::sum(volume, discretization_.communicator());
  }
} // namespace softcell
