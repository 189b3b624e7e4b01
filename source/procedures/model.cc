// SPDX-License-Identifier: LGPL-2.1-or-later
// Puts elasticity, loads and supports together.

#include <softcell/procedures/model.h>

#include <softcell/base/exceptions.h>

#include <algorithm>

namespace softcell
{
  namespace
  {
    bool is_symmetric(const Loads &loads)
    {
      return std::all_of(loads.forces.begin(), loads.forces.end(),
                         [](const auto &force) { return force->has_symmetric_tangent(); });
    }

    std::unique_ptr<LinearSolver> make_solver(const Discretization &discretization,
                                              const std::vector<Material> &materials,
                                              const bool has_projection,
                                              const Loads &loads,
                                              const LinearSolverParameters &parameters)
    {
      if (!parameters.is_matrix_free())
        return make_linear_solver(parameters, is_symmetric(loads));
      const std::string place =
        "What runs without a matrix (Mode = dynamic, Preconditioner = geometric multigrid) ";
      if (has_projection)
        throw BadInput(place + "knows no volumetric projection; give 'Discretization/Volumetric "
                               "projection = false' or another preconditioner.");
      if (!is_symmetric(loads))
        throw BadInput(place + "needs symmetric tangents, which a pressure has not; give another "
                               "preconditioner.");
      return std::make_unique<MatrixFreeSolver>(discretization, materials[0],
                                                loads.imposed.unknowns(), parameters);
    }

    /// @param with_body whether the matrix has the body's own stiffness.
    std::vector<std::vector<unsigned int>> couplings(const Elasticity &elasticity,
                                                     const Stabilization &stabilization,
                                                     const Loads &loads,
                                                     const bool with_body)
    {
      std::vector<std::vector<unsigned int>> lists;
      if (with_body)
      {
        lists = elasticity.couplings();
        stabilization.add_couplings(lists);
      }
      for (const auto &force : loads.forces)
        force->add_couplings(lists);
      return lists;
    }
  } // namespace

  Model::Model(const Discretization &discretization,
               const std::vector<Material> &materials,
               const bool has_projection,
               const Loads &loads,
               const LinearSolverParameters &linear_solver,
               Timers &timers)
      : discretization_(discretization),
        elasticity_(discretization, materials, has_projection),
        stabilization_(discretization, materials),
        loads_(loads),
        linear_solver_(
          make_solver(discretization, materials, has_projection, loads, linear_solver)),
        matrix_free_(dynamic_cast<MatrixFreeSolver *>(linear_solver_.get())),
        tangent_(discretization.partitioner(),
                 couplings(elasticity_, stabilization_, loads, matrix_free_ == nullptr)),
        timers_(timers),
        has_projection_(has_projection),
        internal_(discretization.make_vector()),
        external_(discretization.make_vector()),
        base_(discretization.make_vector()),
        lift_(discretization.make_vector())
  {
  }

  void Model::set_load(const double t)
  {
    load_factor_ = t;
    has_base_    = false;
  }

  NonlinearProblem Model::equations()
  {
    NonlinearProblem problem;
    problem.residual = [this](const Vector &u, Vector &r) { residual(u, r); };
    if (has_projection_)
      problem.search_residual = [this](const Vector &u, Vector &r) { residual(u, r, &base_); };
    problem.linearise = [this](const Vector &u) { linearise(u); };
    problem.solve     = [this](const Vector &r, const Vector &imposed, Vector &du) {
      return solve(r, imposed, du);
    };
    if (!loads_.imposed.regions().empty())
      problem.missing_imposed = [this](const Vector &u, Vector &missing) {
        loads_.imposed.missing(u, load_factor_, missing);
      };
    problem.force_scale = [this](const Vector & /*u*/) { return force_scale_; };
    return problem;
  }

  std::vector<std::pair<std::string, Direction>> Model::region_forces(const Vector &u) const
  {
    std::vector<std::pair<std::string, Direction>> forces;
    for (const auto &force : loads_.forces)
      forces.emplace_back(force->region(), force->total_force(u, load_factor_));

    Vector internal = discretization_.make_vector(), external = discretization_.make_vector();
    unconstrained_residual(u, internal, external);
    internal += external;
    const std::vector<Direction> reactions = loads_.imposed.reactions(internal);
    for (unsigned int i = 0; i < reactions.size(); ++i)
      forces.emplace_back(loads_.imposed.regions()[i], reactions[i]);
    return forces;
  }

  double Model::load_energy(const Vector &u) const
  {
    double energy = 0;
    for (const auto &force : loads_.forces)
      energy += force->energy(u, load_factor_);
    return energy;
  }

  void Model::unconstrained_residual(const Vector &u,
                                     Vector &internal,
                                     Vector &external,
                                     const Vector *const base) const
  {
    internal = 0;
    external = 0;
    if (matrix_free_ != nullptr)
      matrix_free_->add_internal_force(u, internal);
    else
    {
      elasticity_.add_residual(u, internal, base);
      stabilization_.add_residual(u, internal);
    }
    for (const auto &force : loads_.forces)
      force->add_residual(u, load_factor_, external);
    internal.compress(dealii::VectorOperation::add);
    external.compress(dealii::VectorOperation::add);
  }

  void Model::residual(const Vector &u, Vector &r, const Vector *const base)
  {
    const Timers::Scope scope(timers_, "residual");
    unconstrained_residual(u, internal_, external_, base);
    force_scale_ = internal_.l2_norm() + external_.l2_norm();
    r            = internal_;
    r += external_;
    for (const unsigned int unknown : loads_.imposed.unknowns())
      if (unknown < r.locally_owned_size())
        r.local_element(unknown) = 0;
  }

  void Model::linearise(const Vector &u)
  {
    {
      const Timers::Scope scope(timers_, "assembly");
      tangent_.set_zero();
      if (matrix_free_ != nullptr)
        matrix_free_->set_state(u);
      else
      {
        elasticity_.add_tangent(u, tangent_, has_base_ ? &base_ : nullptr);
        stabilization_.add_tangent(tangent_);
      }
      if (has_projection_)
      {
        base_     = u;
        has_base_ = true;
      }
      for (const auto &force : loads_.forces)
        force->add_tangent(u, load_factor_, tangent_);
      tangent_.compress();
    }
    const Timers::Scope scope(timers_, "preconditioner");
    if (!loads_.imposed.regions().empty())
    {
      Vector missing = discretization_.make_vector();
      loads_.imposed.missing(u, load_factor_, missing);
      tangent_.vmult(lift_, missing);
      if (matrix_free_ != nullptr)
        matrix_free_->add_product(lift_, missing);
      else
      {
        diagonal_ = tangent_.diagonal().l1_norm() / lift_.size(); // the mean
        tangent_.constrain(loads_.imposed.unknowns(), diagonal_);
      }
    }
    linear_solver_->set_matrix(tangent_, discretization_.node_positions(),
                               loads_.imposed.unknowns());
  }

  unsigned int Model::solve(const Vector &r, const Vector &imposed, Vector &du)
  {
    const Timers::Scope scope(timers_, "linear solver");
    Vector b = discretization_.make_vector();
    b.add(-1., r, -1., lift_);
    for (const unsigned int unknown : loads_.imposed.unknowns())
      if (unknown < b.locally_owned_size())
        b.local_element(unknown) = diagonal_ * imposed.local_element(unknown);
    const unsigned int iterations = linear_solver_->solve(du, b);
    for (const unsigned int unknown : loads_.imposed.unknowns())
      if (unknown < du.locally_owned_size())
        du.local_element(unknown) = imposed.local_element(unknown);
    return iterations;
  }
} // namespace softcell
