// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Loads, and the loads that it describes.

#include <softcell/loads/load_list.h>

#include "load_checks.h"

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/loads/dead_loads.h>
#include <softcell/loads/nitsche.h>
#include <softcell/loads/nodal_mapping.h>
#include <softcell/loads/pressure.h>
#include <softcell/loads/recorded_path.h>
#include <softcell/loads/supports.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace softcell
{
  void LoadParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii;
    prm.add_parameter("Gravity", gravity,
                      "Units: m/s^2. Three numbers, e.g. 0, 0, -9.81; with the material's density "
                      "it gives the weight.");
    prm.add_parameter(
      "Imposed displacement", imposition,
      "How displacements are imposed: on the unknowns of nodes (strong, where the "
      "region coincides with faces of cells), by penalty or by Nitsche's method; "
      "automatic is strong where that is possible and penalty elsewhere. Nitsche errs less "
      "than penalty, whose misfit is the traction divided by its stiffness, and takes longer.",
      Patterns::Selection("automatic|strong|penalty|Nitsche"));
    prm.add_parameter("Penalty", penalty,
                      "Units: Pa/m (N/m if the surface integration is nodal). Stiffness by which "
                      "penalty holds the surface; an expression of x, y, z and t, e.g. 100 * "
                      "100000^t to stiffen with the load; automatic: 10 (lambda + 2 mu) / (cell "
                      "size), with which the misfit is about a tenth of strain times cell size.");
    prm.add_parameter("Nitsche factor", nitsche_factor,
                      "Units: 1. Nitsche's method adds the stiffness factor * (lambda + 2 mu) * "
                      "(surface in a cell) / (filled volume of the cell), at degree 1, but at most "
                      "1000 (lambda + 2 mu) / (cell size). Small strains need more than 1; where a "
                      "clamp's edge compresses the material to half, 2 is too little.",
                      Patterns::Double(1.));
    prm.add_parameter("Surface integration", surface_integration,
                      "exact: on the pieces of surface in each cell; nodal: at the nodes of the "
                      "body's surface mesh, as Brunet (eq. 4.14 to 4.21).",
                      Patterns::Selection("exact|nodal"));
    std::string fields = "none";
    for (const std::string &name : manufactured_solution_names())
      fields += '|' + name;
    prm.add_parameter(
      "Manufactured solution", manufactured,
      "Makes a known displacement u(x, y, z) the solution, by the body force -Div P(I + grad u) "
      "and by loads `displacement exact` and `traction exact` on regions; results.csv then has the "
      "errors against it. sine: A sin(pi x) sin(pi y) sin(pi z) (1, 1/2, -3/4), which is 0 on the "
      "boundary of the unit cube (Brunet, figure 2.8); waves: A (sin(2x + y - z + 0.3), "
      "0.8 cos(x - 1.5y + 0.5z), 0.6 sin(0.5x + y + 2z - 0.7)).",
      Patterns::Selection(fields));
    prm.add_parameter("Manufactured amplitude", amplitude,
                      "Units: m. A of the manufactured solution. Saint-Venant-Kirchhoff loses its "
                      "ellipticity, and fine grids diverge, from 0.09 on with sine and nu = 0.3.");
    prm.add_parameter("Path", path,
                      "File of lines `t, x, y, z`: time (s; the load factor of a static run) and "
                      "displacement (m) of regions with the load `displacement path`, as a tool's "
                      "way was recorded.");
  }

  namespace
  {
    /// Builds one load after the other.
    class Builder
    {
    public:
      Builder(const LoadParameters &parameters,
              const Discretization &discretization,
              const Surface &surface,
              const std::vector<Material> &materials,
              const DisplacementField *reference,
              const std::vector<LoadDescription> &descriptions)
          : parameters_(parameters),
            discretization_(discretization),
            surface_(surface),
            materials_(materials),
            reference_(reference),
            n_displacements_(std::count_if(
              descriptions.begin(),
              descriptions.end(),
              [](const LoadDescription &load) { return load.kind == Kind::displacement; })),
            checks_(discretization, surface.bounding_box()),
            loads_{{}, ImposedDisplacement(discretization), "", nullptr, {}}
      {
      }

      void add_weight()
      {
        std::vector<double> densities;
        for (const Material &material : materials_)
          densities.push_back(material.density());
        if (parameters_.gravity.norm() > 0)
          loads_.forces.push_back(
            std::make_unique<Weight>(discretization_, parameters_.gravity, std::move(densities)));
      }

      void add_manufactured_body_force()
      {
        if (parameters_.manufactured == "none")
          return;
        const std::string place = "Loads/Manufactured solution = " + parameters_.manufactured;
        if (materials_.size() > 1)
          throw BadInput(place + " has no jumps of strain between materials, but the body has " +
                         std::to_string(materials_.size()) + " of them; choose a body of one.");
        if (parameters_.gravity.norm() > 0)
          throw BadInput(place + " is no equilibrium under a weight; set Gravity to 0, 0, 0.");
        loads_.exact =
          std::make_unique<ManufacturedSolution>(parameters_.manufactured, parameters_.amplitude);
        add_force<ManufacturedBodyForce>(*loads_.exact, materials_[0]);
      }

      void add(const LoadDescription &load, const Region &region)
      {
        if (load.is_exact() && !loads_.exact)
          throw BadInput(load.place + " has no known solution to be taken from; choose one by "
                                      "Loads/Manufactured solution, such as sine.");
        if (load.is_of_reference() && !reference_)
          throw BadInput(load.place + " has no run to be taken from; describe one in "
                                      "Study/Reference, with another load on this region.");
        if (load.is_path() && parameters_.path.empty())
          throw BadInput(load.place + " has no recorded path; give its file as Loads/Path.");
        if (load.kind == Kind::displacement)
        {
          add_displacement(load, region);
          return;
        }
        if (load.is_exact())
        {
          add_force<ManufacturedTraction>(surface_patches(region), *loads_.exact, materials_[0],
                                          load.region);
          return;
        }
        if (loads_.exact)
          throw BadInput(load.place + " drives the body away from the manufactured solution; load "
                                      "the region with 'traction exact', or leave Loads/"
                                      "Manufactured solution at none.");
        const bool is_traction = load.kind == Kind::traction;
        Expression value(load.value, is_traction ? 3 : 1, load.place);
        auto patches                    = surface_patches(region);
        const std::vector<Point> points = points_of(patches);
        checks_.check_numbers(value, points);
        if (load.kind != Kind::springs)
          checks_.note_loaded(load.place, points);
        if (is_traction)
          add_force<Traction>(std::move(patches), std::move(value), load.region);
        else if (load.kind == Kind::pressure)
          add_force<Pressure>(std::move(patches), std::move(value), load.region);
        else
        {
          Expression nowhere("0, 0, 0", 3, load.place);
          add_penalty(std::move(patches), std::move(nowhere), std::move(value), load.region);
        }
      }

      Loads finish()
      {
        loads_.free_motions = checks_.free_motions(loads_.imposed);
        loads_.warnings     = checks_.idle_loads();
        return std::move(loads_);
      }

    private:
      bool is_nodal() const
      {
        return parameters_.surface_integration == "nodal";
      }

      template <class Force, class... Arguments>
      void add_force(Arguments &&...arguments)
      {
        loads_.forces.push_back(
          std::make_unique<Force>(discretization_, std::forward<Arguments>(arguments)...));
      }

      void add_displacement(const LoadDescription &load, const Region &region)
      {
        const std::string &how = parameters_.imposition;
        if (how == "automatic" || how == "strong")
        {
          if (const auto nodes = discretization_.nodes_on(region))
          {
            check_selects(region, nodes->size());
            std::vector<Point> points;
            for (const unsigned int node : *nodes)
              points.push_back(discretization_.node_positions()[node]);
            Expression displacement = imposed_displacement(load, points);
            checks_.check_numbers(displacement, points);
            const auto patches = discretization_.surface_patches(region);
            if (how == "automatic" && n_displacements_ > 1)
              checks_.check_agreement(load.place, patches,
                                      imposed_displacement(load, points_of(patches)));
            checks_.note_supported(patches, displacement);
            loads_.imposed.add(load.region, *nodes, std::move(displacement));
            return;
          }
          if (how == "strong")
            throw BadInput("Loads/Imposed displacement = strong cannot be had on region '" +
                           load.region +
                           "', which does not coincide with faces of cells; choose "
                           "automatic, penalty or Nitsche.");
        }
        auto patches                    = surface_patches(region);
        const std::vector<Point> points = points_of(patches);
        Expression displacement         = imposed_displacement(load, points);
        checks_.check_numbers(displacement, points);
        if (!is_nodal() && n_displacements_ > 1) // regions that meet share the nodes between them
          checks_.check_agreement(load.place, patches, displacement);
        checks_.note_supported(patches, displacement);
        if (how == "penalty" || how == "automatic")
        {
          Expression stiffness = penalty(patches);
          add_penalty(std::move(patches), std::move(displacement), std::move(stiffness),
                      load.region);
        }
        else if (is_nodal())
          throw BadInput("Loads/Surface integration = nodal has no Nitsche's method; choose "
                         "'Imposed displacement = penalty' or 'Surface integration = exact'.");
        else
        {
          checks_.hold(patches, displacement, Expression("1", 1, load.place));
          add_force<Nitsche>(std::move(patches), std::move(displacement), materials_,
                             parameters_.nitsche_factor, load.region);
        }
      }

      /// @param points at which it will be asked for, a rank's own. Collective.
      Expression imposed_displacement(const LoadDescription &load,
                                      const std::vector<Point> &points) const
      {
        if (load.is_of_reference())
          return reference_displacement(load, points);
        if (load.is_path())
          return Expression([path = RecordedPath(parameters_.path)](
                              const Point &, const double t) { return path.displacement(t); },
                            load.place);
        if (!load.is_exact())
          return Expression(load.value, 3, load.place);
        return Expression([exact = loads_.exact.get()](
                            const Point &X, const double t) { return t * exact->displacement(X); },
                          load.place);
      }

      Expression reference_displacement(const LoadDescription &load,
                                        const std::vector<Point> &points) const
      {
        const PointValues values =
          evaluate(reference_->discretization, reference_->u, points, reference_->reach);
        std::ostringstream message;
        std::map<std::array<double, 3>, Direction> table;
        for (unsigned int i = 0; i < points.size(); ++i)
        {
          table.emplace(coordinates(points[i]), values.displacements[i]);
          if (!std::isfinite(values.distances[i]) && message.str().empty())
            message << load.place << " has no displacement at (" << points[i]
                    << "), which is far outside all cells of the reference.";
        }
        throw_on_all(discretization_.communicator(), message.str());
        return Expression(
          [table](const Point &X, const double t) { return t * table.at(coordinates(X)); },
          load.place);
      }

      /// The stiffness of the entry Penalty. What each patch has of its own goes into its weights.
      Expression penalty(std::vector<SurfacePatch> &patches) const
      {
        const std::string place = "Loads/Penalty = '" + parameters_.penalty + "'";
        if (parameters_.penalty != "automatic")
        {
          if (is_nodal()) // of each node in N/m, whatever its area
            for (SurfacePatch &patch : patches)
              patch.weights.assign(patch.weights.size(), 1.);
          return Expression(parameters_.penalty, 1, place);
        }
        if (is_nodal())
          throw BadInput(place + " knows no stiffness of nodes; give one in N/m, or choose "
                                 "'Surface integration = exact'.");
        for (SurfacePatch &patch : patches)
          for (unsigned int q = 0; q < patch.weights.size(); ++q)
            patch.weights[q] *=
              materials_[patch.labels[q]].longitudinal_modulus() / patch.cell_size;
        return Expression("10", 1, place);
      }

      void add_penalty(std::vector<SurfacePatch> patches,
                       Expression displacement,
                       Expression stiffness,
                       const std::string &region)
      {
        checks_.check_numbers(stiffness, points_of(patches), true);
        checks_.hold(patches, displacement, stiffness);
        add_force<Penalty>(std::move(patches), std::move(displacement), std::move(stiffness),
                           region);
      }

      std::vector<SurfacePatch> surface_patches(const Region &region) const
      {
        const auto [lower, upper] = surface_.bounding_box().get_boundary_points();
        const double reach        = 0.05 * lower.distance(upper);
        auto patches = is_nodal() ? nodal_surface_patches(discretization_, surface_, region, reach)
                                  : discretization_.surface_patches(region);
        check_selects(region, patches.size());
        return patches;
      }

      void check_selects(const Region &region, const std::size_t n_here) const
      {
        if (dealii::Utilities::MPI::sum(n_here, discretization_.communicator()) == 0)
          throw BadInput("Regions/" + region.name() +
                         " selects nothing of the body's surface; mend its condition.");
      }

      const LoadParameters &parameters_;
      const Discretization &discretization_;
      const Surface &surface_;
      const std::vector<Material> &materials_;
      const DisplacementField *const reference_; // null if there is none
      const unsigned int n_displacements_;       // of the loads
      LoadChecks checks_;
      Loads loads_;
    };
  } // namespace

  Loads make_loads(const LoadParameters &parameters,
                   const std::vector<LoadDescription> &descriptions,
                   const std::vector<Region> &regions,
                   const Discretization &discretization,
                   const Surface &surface,
                   const std::vector<Material> &materials,
                   const DisplacementField *const reference)
  {
    Builder builder(parameters, discretization, surface, materials, reference, descriptions);
    builder.add_weight();
    builder.add_manufactured_body_force();
    for (const LoadDescription &load : descriptions)
      builder.add(load, find_region(load.region, regions));
    Loads loads = builder.finish();
    const bool is_at_rest =
      std::all_of(descriptions.begin(), descriptions.end(), [](const LoadDescription &load) {
        return load.kind == Kind::springs || load.value == "0, 0, 0";
      });
    if (is_at_rest && parameters.gravity.norm() == 0 && parameters.manufactured == "none")
      loads.warnings.emplace_back(
        "Nothing acts on the body, which stays at rest; give it Gravity, a "
        "traction, a pressure or a displacement in Loads.");
    return loads;
  }
} // namespace softcell
