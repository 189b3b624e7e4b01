// SPDX-License-Identifier: LGPL-2.1-or-later
// The main loop: a body, a discretization, loads, Newton's method, a deformed body.
#pragma once

#include <softcell/base/console.h>
#include <softcell/geometry/body.h>
#include <softcell/output/results.h>
#include <softcell/output/solution.h>
#include <softcell/procedures/model.h>
#include <softcell/procedures/parameters.h>
#include <softcell/solvers/load_steps.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace softcell
{
  /// One body deformed by its loads with one method. All members are collective.
  class Simulation
  {
  public:
    /// Builds the discretization, the loads and the equations, and says how large they are.
    /// @param body    must outlive the simulation, as the console must.
    /// @param reference whose displacement loads `displacement reference` impose, as it is now and
    ///                after each refinement of the grid; may be null if there are none.
    /// @throws BadInput
    Simulation(const std::string &name,
               const Parameters &parameters,
               const Body &body,
               Console &console,
               const DisplacementField *reference = nullptr);
    ~Simulation();

    /// Follows the load to its end, from where `Start from` or the coarse grids say, which are
    /// solved first, and does so again on each grid that section Discretization has refined. False
    /// if the end was not reached: then the displacement is that of the last load step that
    /// converged, and reason() says what stopped it.
    /// @param folder for the states that `Every` asks for.
    /// In a dynamic run, moves the body until the end time and writes frames.csv on the way. False
    /// if a step failed, or its linear system missed the tolerance without a frame budget.
    bool solve(const std::filesystem::path &folder);

    /// One clause, with advice.
    std::string reason() const;
    const Parameters &parameters() const
    {
      return parameters_;
    }
    const Body &body() const
    {
      return body_;
    }
    /// One per label.
    const std::vector<Material> &materials() const
    {
      return materials_;
    }
    const Discretization &discretization() const
    {
      return *discretization_;
    }
    const Vector &displacement() const
    {
      return displacement_;
    }

    /// The displacement that the loads were made for; null if there is none.
    const ManufacturedSolution *exact() const
    {
      return loads_->exact.get();
    }

    /// What a user should know of the discretization and the material.
    const std::vector<std::string> &remarks() const
    {
      return remarks_;
    }

    /// What took how long; what is done with the solution may be added.
    Timers &timers()
    {
      return timers_;
    }

    /// How far outside all cells a point of the body may lie. Units: m
    double reach() const;

    DisplacementField field() const
    {
      return {*discretization_, displacement_, reach()};
    }

    /// What results.csv says of this case.
    ResultsRow row() const;

    /// Relative residuals of the last linear system, after each iteration.
    const std::vector<double> &linear_residuals() const
    {
      return model_->linear_residuals();
    }

    /// Writes the last state, as section Output asks for, and says what took how long.
    void write(const std::filesystem::path &folder);

  private:
    bool is_dynamic() const
    {
      return parameters_.procedure.mode == "dynamic";
    }

    /// What a motion came to.
    struct MotionHistory
    {
      unsigned int n_steps = 0, n_late = 0;    // late: over the frame budget
      unsigned int n_shortened = 0;            // steps that went only a part of their way
      unsigned int n_unsolved  = 0;            // whose linear system missed the tolerance
      double largest_residual  = 0;            // of a step's linear system, relative
      double slowest_ms        = 0;            // of a step
      double kinetic_energy    = 0;            // at the end. Units: J
      std::map<std::string, Direction> forces; // at the end, by region. Units: N
    };

    /// Makes the discretization and all that stands on it, with no displacement.
    /// @throws BadInput
    void build();

    /// Halves the cells that err most, where the displacement is taken along.
    void refine();

    /// Of each cell the estimate of the displacement's squared error. Units: J
    std::vector<double> cell_errors() const;

    /// What these make of the error in the energy norm, relative; 0 if there is no energy.
    double estimated_error(const std::vector<double> &cell_errors) const;

    /// @throws BadInput if a probe is farther from the body than a hundredth of its diagonal.
    void check_probes() const;
    /// Says and keeps what has not been said yet.
    void warn(const std::vector<std::string> &remarks);

    /// Takes the grid's refinement from a checkpoint, before the grid is built. @throws BadInput
    void take_refinement(const std::string &checkpoint);

    /// Takes displacement and load factor from a checkpoint. @throws BadInput
    void start_from(const std::string &checkpoint);

    /// Solves the coarser grid, takes displacement and load factor from it and drops it.
    void start_from_coarser();

    /// Goes on from displacement_ at load factor start_.
    void follow(const std::filesystem::path &folder);

    /// @throws BadInput where the parameters ask for what there is not in a motion.
    void check_motion() const;

    /// Moves the body from displacement_ at rest to the end time or the last step before one that
    /// fails, and writes frames.csv step by step. Real is the precision.
    template <class Real>
    void move(const std::filesystem::path &folder);
    /// How many steps missed the tolerance, and by how much.
    std::string unsolved_steps() const;
    /// Tells how a motion went.
    void say_motion();

    /// Add to a row what only a motion has, and what only an equilibrium has.
    void add_motion(ResultsRow &row) const;
    void add_equilibrium(ResultsRow &row) const;

    /// Adds the state at a load factor to solution.pvd and makes it the checkpoint, once.
    void write_state(const std::filesystem::path &folder, double load_factor);

    /// Edge of a cell, by which rates are observed: of the largest in a background grid; in a mesh
    /// that which was asked for. Units: m
    double cell_size() const;

    std::string name_;
    Parameters parameters_;
    const Body &body_;
    Console &console_;
    std::optional<DisplacementField> reference_;
    Timers timers_;
    std::vector<std::string> remarks_;
    std::vector<Material> materials_;
    std::vector<Region> regions_;
    std::vector<Point> probes_;
    Refinement refinement_;
    std::unique_ptr<Discretization> discretization_;
    Size size_;
    std::unique_ptr<Loads> loads_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<Simulation> coarser_; // until it is solved
    Vector displacement_;
    double start_ = 0; // load factor
    LoadHistory history_;
    MotionHistory motion_;
    unsigned int most_linear_iterations_ = 0; // of one system
    std::unique_ptr<SolutionWriter> states_;
    double written_ = -1; // load factor of the last state
  };
} // namespace softcell
