// SPDX-License-Identifier: LGPL-2.1-or-later
// A displacement that is known everywhere, and the loads that hold a body there.

#include <softcell/loads/manufactured_solution.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/numbers.h>

#include <Sacado.hpp>

namespace softcell
{
  namespace
  {
    using dealii::numbers::PI;
    using Jet = ManufacturedSolution::Jet;

    /// sin(pi x) sin(pi y) sin(pi z) (1, 1/2, -3/4), zero on the boundary of the unit cube (Brunet,
    /// figure 2.8).
    struct Sine
    {
      template <class Number>
      static std::array<Number, 3> value(const std::array<Number, 3> &X)
      {
        const Number s = sin(PI * X[0]) * sin(PI * X[1]) * sin(PI * X[2]);
        return {{s, 0.5 * s, -0.75 * s}};
      }
    };

    /// Waves across all axes, zero on no plane.
    struct Waves
    {
      template <class Number>
      static std::array<Number, 3> value(const std::array<Number, 3> &X)
      {
        const auto &[x, y, z] = X;
        return {{sin(2 * x + y - z + 0.3), 0.8 * cos(x - 1.5 * y + 0.5 * z),
                 0.6 * sin(0.5 * x + y + 2 * z - 0.7)}};
      }
    };

    /// A formula with its derivatives, by numbers that know their derivatives twice over.
    template <class Formula>
    Jet jet(const Point &X)
    {
      using First  = Sacado::Fad::SFad<double, dim>;
      using Second = Sacado::Fad::SFad<First, dim>;
      std::array<Second, 3> coordinates;
      for (int d = 0; d < dim; ++d)
        coordinates[d] = Second(dim, d, First(dim, d, X[d]));
      const std::array<Second, 3> u = Formula::value(coordinates);
      Jet result;
      for (int c = 0; c < dim; ++c)
      {
        result.value[c] = u[c].val().val();
        for (int d = 0; d < dim; ++d)
        {
          result.gradient[c][d] = u[c].dx(d).val();
          for (int e = 0; e < dim; ++e)
            result.changes[e][c][d] = u[c].dx(d).dx(e);
        }
      }
      return result;
    }

    struct Field
    {
      std::string name;
      Jet (*evaluate)(const Point &);
    };

    /// All fields by the names that a parameter file gives them.
    const std::vector<Field> fields = {{"sine", jet<Sine>}, {"waves", jet<Waves>}};

    Matrix3<double> matrix(const double factor, const Gradient &A)
    {
      Matrix3<double> result;
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j)
          result(i, j) = factor * A[i][j];
      return result;
    }
  } // namespace

  std::vector<std::string> manufactured_solution_names()
  {
    std::vector<std::string> names;
    for (const Field &field : fields)
      names.push_back(field.name);
    return names;
  }

  ManufacturedSolution::ManufacturedSolution(const std::string &name, const double amplitude)
      : field_(nullptr), amplitude_(amplitude)
  {
    for (const Field &field : fields)
      if (field.name == name)
        field_ = field.evaluate;
    Assert(field_ != nullptr, dealii::ExcMessage("There is no manufactured solution " + name));
  }

  Direction ManufacturedSolution::displacement(const Point &X) const
  {
    return amplitude_ * field_(X).value;
  }

  Gradient ManufacturedSolution::gradient(const Point &X) const
  {
    return amplitude_ * field_(X).gradient;
  }

  Direction
  ManufacturedSolution::body_force(const Material &material, const Point &X, const double t) const
  {
    const Jet u             = field_(X);
    const double factor     = t * amplitude_;
    const Matrix3<double> F = identity<double>() + matrix(factor, u.gradient);
    Direction force;
    material.visit([&](const auto &law) {
      const auto tangent = law.linearisation(F);
      for (int d = 0; d < dim; ++d)
      {
        const Matrix3<double> dP = tangent(matrix(factor, u.changes[d]));
        for (int c = 0; c < dim; ++c)
          force[c] -= dP(c, d);
      }
    });
    return force;
  }

  Direction ManufacturedSolution::traction(const Material &material,
                                           const Point &X,
                                           const Direction &N,
                                           const double t) const
  {
    const Matrix3<double> F = identity<double>() + matrix(t * amplitude_, field_(X).gradient);
    const Matrix3<double> P =
      material.visit([&](const auto &law) { return law.first_piola_stress(F); });
    Direction result;
    for (int c = 0; c < dim; ++c)
      for (int d = 0; d < dim; ++d)
        result[c] += P(c, d) * N[d];
    return result;
  }

  ManufacturedBodyForce::ManufacturedBodyForce(const Discretization &discretization,
                                               const ManufacturedSolution &solution,
                                               const Material &material)
      : DeadLoad(discretization, "body_force", false), solution_(solution), material_(material)
  {
  }

  void ManufacturedBodyForce::integrate(const double t, Vector &f) const
  {
    PatchStorage storage;
    std::vector<Point> points;
    for (unsigned int p = 0; p < discretization_.n_patches(); ++p)
    {
      const Patch patch = discretization_.patch(p, storage);
      discretization_.patch_points(p, points);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        if (patch.weights[q] != 0)
          add_force(patch.weights[q] * solution_.body_force(material_, points[q], t), patch.nodes,
                    patch.shapes->value(q), f);
    }
  }

  ManufacturedTraction::ManufacturedTraction(const Discretization &discretization,
                                             std::vector<SurfacePatch> patches,
                                             const ManufacturedSolution &solution,
                                             const Material &material,
                                             std::string region)
      : DeadLoad(discretization, std::move(region), false),
        patches_(std::move(patches)),
        solution_(solution),
        material_(material)
  {
  }

  void ManufacturedTraction::integrate(const double t, Vector &f) const
  {
    for (const SurfacePatch &patch : patches_)
      for (unsigned int q = 0; q < patch.points.size(); ++q)
        add_force(patch.weights[q] *
                    solution_.traction(material_, patch.points[q], patch.normals[q], t),
                  patch.nodes, patch.shapes.value(q), f);
  }
} // namespace softcell
