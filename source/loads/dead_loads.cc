// SPDX-License-Identifier: LGPL-2.1-or-later
// Forces that keep their direction and size however the body moves: weight and dead traction.

#include <softcell/loads/dead_loads.h>

#include <deal.II/base/mpi.h>

#include <limits>

namespace softcell
{
  DeadLoad::DeadLoad(const Discretization &discretization,
                     std::string region,
                     const bool is_proportional)
      : discretization_(discretization),
        region_(std::move(region)),
        is_proportional_(is_proportional),
        forces_(discretization.make_vector()),
        time_of_forces_(std::numeric_limits<double>::quiet_NaN())
  {
  }

  const Vector &DeadLoad::forces(const double t, double &factor) const
  {
    factor               = is_proportional_ ? t : 1;
    const double at_time = is_proportional_ ? 1 : t;
    if (time_of_forces_ != at_time)
    {
      forces_ = 0;
      integrate(at_time, forces_);
      time_of_forces_ = at_time;
    }
    return forces_;
  }

  void DeadLoad::add_residual(const Vector & /*u*/, const double t, Vector &r) const
  {
    double factor;
    const Vector &f = forces(t, factor);
    for (unsigned int i = 0; i < 3 * discretization_.node_positions().size(); ++i)
      r.local_element(i) -= factor * f.local_element(i);
  }

  double DeadLoad::energy(const Vector &u, const double t) const
  {
    double factor, work = 0;
    const Vector &f = forces(t, factor);
    for (unsigned int i = 0; i < 3 * discretization_.node_positions().size(); ++i)
      work += f.local_element(i) * u.local_element(i);
    return -factor * dealii::Utilities::MPI::sum(work, discretization_.communicator());
  }

  Direction DeadLoad::total_force(const Vector & /*u*/, const double t) const
  {
    double factor;
    const Vector &f = forces(t, factor);
    Direction total;
    for (unsigned int i = 0; i < 3 * discretization_.node_positions().size(); ++i)
      total[i % 3] += factor * f.local_element(i);
    return dealii::Utilities::MPI::sum(total, discretization_.communicator());
  }

  void DeadLoad::add_force(const Direction &force,
                           const View<const unsigned int> nodes,
                           const double *const shapes,
                           Vector &f)
  {
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        f.local_element(3 * nodes[i] + c) += force[c] * shapes[i];
  }

  Weight::Weight(const Discretization &discretization,
                 const Direction &gravity,
                 std::vector<double> densities)
      : DeadLoad(discretization, "gravity", true),
        gravity_(gravity),
        densities_(std::move(densities))
  {
  }

  void Weight::integrate(const double t, Vector &f) const
  {
    PatchStorage storage;
    for (unsigned int p = 0; p < discretization_.n_patches(); ++p)
    {
      const Patch patch = discretization_.patch(p, storage);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        add_force(t * densities_[patch.label(q)] * patch.weights[q] * gravity_, patch.nodes,
                  patch.shapes->value(q), f);
    }
  }

  Traction::Traction(const Discretization &discretization,
                     std::vector<SurfacePatch> patches,
                     Expression traction,
                     std::string region)
      : DeadLoad(discretization, std::move(region), !traction.uses_time()),
        patches_(std::move(patches)),
        traction_(std::move(traction))
  {
    for (SurfacePatch &patch : patches_)
      patch.shapes.drop_gradients();
  }

  void Traction::integrate(const double t, Vector &f) const
  {
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        add_force(patch.weights[q] * traction_.at_load_factor(patch.points[q], t), patch.nodes,
                  patch.shapes.value(q), f);
  }
} // namespace softcell
