// SPDX-License-Identifier: LGPL-2.1-or-later
// What steadies cells of which the body fills little.

#include <softcell/operators/stabilization.h>

#include "patch_kernels.h"

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace softcell
{
  Stabilization::Stabilization(const Discretization &discretization,
                               const std::vector<Material> &materials)
      : discretization_(discretization)
  {
    for (const Material &material : materials)
      laws_.push_back(material.visit([](const auto &law) {
        return LinearElastic<>{std::min(law.lambda, 2 * law.mu), law.mu};
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
    for (const GhostFace &face : discretization_.ghost_faces())
    {
      const std::vector<Direction> f = forces(face, u);
      for (unsigned int i = 0; i < f.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          energy += 0.5 * f[i][c] * u.local_element(3 * face.nodes[i] + c);
    }
    return dealii::Utilities::MPI::sum(energy, discretization_.communicator());
  }

  double Stabilization::modulus(const GhostFace &face) const
  {
    const auto &law = laws_[face.label];
    return law.lambda + 2 * law.mu;
  }

  std::vector<Direction> Stabilization::forces(const GhostFace &face, const Vector &u) const
  {
    const unsigned int n = face.nodes.size();
    std::vector<Direction> forces(n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int c = 0; c < 3; ++c)
          forces[i][c] +=
            modulus(face) * face.products[i * n + j] * u.local_element(3 * face.nodes[j] + c);
    return forces;
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
    for (const GhostFace &face : discretization_.ghost_faces())
    {
      const std::vector<Direction> f = forces(face, u);
      for (unsigned int i = 0; i < f.size(); ++i)
        for (unsigned int c = 0; c < 3; ++c)
          r.local_element(3 * face.nodes[i] + c) += f[i][c];
    }
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
    std::vector<double> values; // (3, n, 3, n)
    for (const GhostFace &face : discretization_.ghost_faces())
    {
      const unsigned int n = face.nodes.size();
      values.assign(9 * n * n, 0.);
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            values[((c * n + i) * 3 + c) * n + j] = modulus(face) * face.products[i * n + j];
      K.add(dealii::make_array_view(face.nodes), values.data());
    }
  }

  void Stabilization::add_couplings(std::vector<std::vector<unsigned int>> &couplings) const
  {
    for (const GhostFace &face : discretization_.ghost_faces())
      couplings.push_back(face.nodes);
  }
} // namespace softcell
