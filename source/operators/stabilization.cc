// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cells of which the body fills little.

#include <softcell/operators/stabilization.h>

#include "patch_kernels.h"

#include <deal.II/base/mpi.h>

namespace softcell
{
  Stabilization::Stabilization(const Discretization &discretization,
                               const std::vector<Material> &materials)
      : discretization_(discretization)
  {
    for (const Material &material : materials)
      laws_.push_back(material.visit([](const auto &law) {
        return LinearElastic<>{law.lambda, law.mu};
      }));
  }

  /// Calls function(deformed patch) for every fictitious patch of this rank.
  template <class Function>
  void Stabilization::for_each_patch(const Vector &u, const Function &function) const
  {
    PatchStorage storage;
    DeformedPatch deformed;
    for (unsigned int i = 0; i < discretization_.n_patches(); ++i)
      if (const Patch patch = discretization_.fictitious_patch(i, storage); patch.n_points() > 0)
      {
        deformed.reinit(patch, u);
        function(deformed);
      }
  }

  double Stabilization::energy(const Vector &u) const
  {
    double energy = 0;
    for_each_patch(u, [&](const DeformedPatch &deformed) {
      const Patch &patch = deformed.patch();
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        energy += patch.weights[q] * laws_[patch.label(q)].energy(deformed.deformation_gradient(q));
    });
    return dealii::Utilities::MPI::sum(energy, discretization_.communicator());
  }

  void Stabilization::add_residual(const Vector &u, Vector &r) const
  {
    PatchResidual residual;
    for_each_patch(u, [&](const DeformedPatch &deformed) {
      const Patch &patch = deformed.patch();
      residual.reinit(deformed);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        residual.add(laws_[patch.label(q)], deformed, q, deformed.deformation_gradient(q));
      residual.scatter(patch.nodes, r);
    });
  }

  void Stabilization::add_tangent(BlockMatrix &K) const
  {
    PatchTangent tangent;
    const Vector at_rest = discretization_.make_vector();
    for_each_patch(at_rest, [&](const DeformedPatch &deformed) {
      const Patch &patch = deformed.patch();
      tangent.reinit(deformed);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        tangent.add(laws_[patch.label(q)], deformed, q, identity<double>());
      K.add(patch.nodes, tangent.values());
    });
  }
} // namespace softcell
