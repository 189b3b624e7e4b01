// SPDX-License-Identifier: LGPL-2.1-or-later
// The points of a patch, each with its law; perhaps with a projected change of volume.
#pragma once

#include "patch_kernels.h"

#include <softcell/discretization/orthonormal_polynomials.h>
#include <softcell/mechanics/material.h>

#include <algorithm>
#include <vector>

namespace softcell
{
  /// Calls visit(law, point, F) for every point of a patch that has a weight and whose
  /// F = deformation_gradient(point) the law accepts. Returns the number of the others that have a
  /// weight.
  template <class DeformationGradient, class Visit>
  unsigned int for_each_point(const Patch &patch,
                              const std::vector<Material> &materials,
                              const DeformationGradient &deformation_gradient,
                              const Visit &visit)
  {
    unsigned int n_inverted = 0;
    for (unsigned int begin = 0, end; begin < patch.n_points(); begin = end)
    {
      const unsigned int label = patch.label(begin);
      AssertIndexRange(label, materials.size());
      end = patch.labels.size() == 1 ? patch.n_points() : begin + 1;
      while (end < patch.n_points() && patch.label(end) == label)
        ++end;
      materials[label].visit([&](const auto &law) {
        for (unsigned int point = begin; point < end; ++point)
          if (patch.weights[point] != 0)
          {
            const Matrix3<double> F = deformation_gradient(point);
            if (law.is_admissible(determinant(F)))
              visit(law, point, F);
            else
              ++n_inverted;
          }
      });
    }
    return n_inverted;
  }

  /// A law whose volumetric part comes from elsewhere, as the pressure lambda v* with v* the
  /// projection of v.
  template <class Law>
  struct UnderPressure
  {
    const Law &law;
    double pressure;

    /// Its sum over a patch is the energy of the patch, as sum w v* v = sum w v*^2.
    double energy(const Matrix3<double> &F) const
    {
      return Law{0, law.mu}.energy(F) + pressure / 2 * law.volumetric_strain(F);
    }
    Matrix3<double> first_piola_stress(const Matrix3<double> &F) const
    {
      return law.first_piola_stress(F, pressure);
    }
    Matrix3<double> cauchy_stress(const Matrix3<double> &F) const
    {
      return law.cauchy_stress(F, pressure);
    }
    /// At fixed pressure.
    auto linearisation(const Matrix3<double> &F) const
    {
      return law.linearisation(F, pressure);
    }
  };

  /// A multiple of v in the place of an energy.
  template <class Law>
  struct VolumetricStrain
  {
    const Law &law;
    double factor;

    Matrix3<double> first_piola_stress(const Matrix3<double> &F) const
    {
      return factor * law.volumetric_gradient(F);
    }
  };

  /// Of the energy lambda/2 v^2 in a patch only what v has of the polynomials phi_k of degree
  /// p - 1, orthonormal under the patch's own quadrature: sum_k lambda/2 a_k^2 with
  /// a_k = sum_q w_q phi_k v_q. At p = 1 it is the mean, and the patch has one constraint of volume
  /// instead of one at each point. Each material in a patch is projected by itself.
  ///
  /// Residual and tangent are its exact derivatives: forces are those of the pressure
  /// lambda sum_k a_k phi_k, and sum_k lambda (da_k/du) (da_k/du)^T joins the tangent at fixed
  /// pressure.
  ///
  /// Source: Simo, Taylor, Pister (1985), mean dilatation; Hughes (1980), B-bar. Departure: the
  /// measure of volume change v is the law's own and only its quadratic energy is projected, so
  /// that J > 0 is guarded at every point.
  class VolumetricProjection
  {
  public:
    VolumetricProjection(const Discretization &discretization,
                         const std::vector<Material> &materials)
        : discretization_(discretization), materials_(materials)
    {
    }

    /// Calls visit(law, point, F) as for_each_point() does, for patch i.
    /// @param base if not null, where v is linearised: v(F_0) + dv/dF(F_0) : (F - F_0).
    template <class Visit>
    unsigned int for_each_point(const unsigned int i,
                                const DeformedPatch &deformed,
                                const DeformedPatch *const base,
                                const Visit &visit)
    {
      const Patch &patch = deformed.patch();
      make_modes(i, patch);
      F_.resize(patch.n_points());
      strain_.assign(patch.n_points(), 0.);
      const unsigned int n_inverted = softcell::for_each_point(
        patch, materials_,
        [&](const unsigned int point) { return F_[point] = deformed.deformation_gradient(point); },
        [&](const auto &law, const unsigned int point, const auto &F) {
          if (base == nullptr)
            strain_[point] = law.volumetric_strain(F);
          else
          {
            const Matrix3<double> F_0 = base->deformation_gradient(point);
            strain_[point]            = law.volumetric_strain(F_0) +
                             double_contraction(law.volumetric_gradient(F_0), F - F_0);
          }
        });
      make_pressure(patch);
      for_each_known_point(patch, [&](const auto &law, const unsigned int point, const auto &F) {
        visit(UnderPressure<std::decay_t<decltype(law)>>{law, pressure_[point]}, point, F);
      });
      return n_inverted;
    }

    /// Adds the change of pressure of the patch that was visited last.
    void add_to_tangent(const DeformedPatch &deformed, PatchTangent &tangent)
    {
      for (unsigned int k = 0; k < lambda_.size(); ++k)
      {
        const double *const phi = &modes_[k * strain_.size()];
        gradient_.reinit(deformed);
        for_each_known_point(
          deformed.patch(), [&](const auto &law, const unsigned int point, const auto &F) {
            gradient_.add(VolumetricStrain<std::decay_t<decltype(law)>>{law, phi[point]}, deformed,
                          point, F);
          });
        tangent.add_product(lambda_[k], gradient_.values());
      }
    }

  private:
    template <class Visit>
    void for_each_known_point(const Patch &patch, const Visit &visit) const
    {
      softcell::for_each_point(
        patch, materials_, [&](const unsigned int point) { return F_[point]; }, visit);
    }

    /// Fills modes_ and lambda_.
    void make_modes(const unsigned int i, const Patch &patch)
    {
      const unsigned int n = patch.n_points(), degree = discretization_.degree() - 1;
      if (degree > 0)
        discretization_.patch_points(i, points_);
      points_.resize(n);
      modes_.clear();
      lambda_.clear();
      for (unsigned int label = 0; label < materials_.size(); ++label)
      {
        weights_.assign(n, 0.);
        for (unsigned int q = 0; q < n; ++q)
          if (patch.label(q) == label)
            weights_[q] = patch.weights[q];
        const std::size_t begin = modes_.size();
        orthonormal_polynomials(points_, {weights_.data(), n}, degree, modes_);
        for (std::size_t k = begin; k < modes_.size(); ++k)
          if (weights_[k % n] == 0)
            modes_[k] = 0;
        lambda_.resize(modes_.size() / std::max(n, 1U),
                       materials_[label].visit([](const auto &law) { return law.lambda; }));
      }
    }

    void make_pressure(const Patch &patch)
    {
      const unsigned int n = patch.n_points();
      pressure_.assign(n, 0.);
      for (unsigned int k = 0; k < lambda_.size(); ++k)
      {
        const double *const phi = &modes_[std::size_t(k) * n];
        double a                = 0;
        for (unsigned int q = 0; q < n; ++q)
          a += patch.weights[q] * phi[q] * strain_[q];
        for (unsigned int q = 0; q < n; ++q)
          pressure_[q] += lambda_[k] * a * phi[q];
      }
    }

    const Discretization &discretization_;
    const std::vector<Material> &materials_;
    std::vector<Point> points_;
    std::vector<double> weights_;    // (n_points) of one material
    std::vector<double> modes_;      // (n_modes, n_points) phi_k, 0 in other materials
    std::vector<double> lambda_;     // (n_modes) Units: Pa
    std::vector<Matrix3<double>> F_; // (n_points)
    std::vector<double> strain_;     // (n_points) v
    std::vector<double> pressure_;   // (n_points) Units: Pa
    PatchResidual gradient_;         // da_k/du
  };
} // namespace softcell
