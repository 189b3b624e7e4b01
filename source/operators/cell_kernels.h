// SPDX-License-Identifier: LGPL-2.1-or-later
// What the matrix-free operator does on one cell, or on a pack of cells; for host and device.
#pragma once

#include "definite_tangent.h"
#include "trilinear.h"

#include <softcell/mechanics/laws.h>

#include <algorithm>
#include <cstddef>

// One inlined body keeps a pack's values in registers. With sanitizers it would take minutes to
// compile.
#ifdef __SANITIZE_ADDRESS__
#  define SOFTCELL_FLATTEN
#else
#  define SOFTCELL_FLATTEN [[gnu::flatten]]
#endif

/// Before a loop that leaves arrays in registers of the device.
#ifdef __CUDACC__
#  define SOFTCELL_DEVICE_UNROLL _Pragma("unroll")
#else
#  define SOFTCELL_DEVICE_UNROLL
#endif

namespace softcell
{
  // `Cells` stands for the cell or cells that a kernel handles at once:
  //   Number                  a value in each cell
  //   Gradients               GaussGradients or PointGradients
  //   gather(field, v)        takes the values of a component at the corners
  //   add(v, field)           adds to them
  //   for_each_point(f)       calls f(point, its number, its weight (m^3)) for each point
  //   load(numbers, number), store(value, numbers, number)
  //                           one of an array of Number
  //   log1p(x)                ln(1 + x)
  //   count(mask)             in how many cells the mask is true
  //   reset_where_empty(weight, F)
  //                           sets F = I where there is no weight, so that nothing undefined comes
  //                           of it

  /// What all cells of a grid have in common.
  template <class Real>
  struct CellGeometry
  {
    std::size_t corners[8]; // entries of a LatticeField from that of the lowest corner
    Real weight;            // of a full cell's Gauss points. Units: m^3
    Real scale[3];          // of GaussGradients. Units: 1/m
  };

  /// The three components of a displacement, a force, ...
  template <class Real>
  struct Components
  {
    Real *component[3];
  };

  /// The law with moduli in Real.
  template <class Real, template <class> class Law>
  Law<Real> rounded(const Law<double> &law)
  {
    return {Real(law.lambda), Real(law.mu)};
  }

  /// The gradients of three components at the points of cells.
  template <class Cells, class Gradients = typename Cells::Gradients>
  class CellGradients
  {
  public:
    using Number = typename Cells::Number;

    template <class Real>
    SOFTCELL_HOST_DEVICE explicit CellGradients(const CellGeometry<Real> &geometry)
        : components_{Gradients(geometry.scale), Gradients(geometry.scale),
                      Gradients(geometry.scale)}
    {
    }
    SOFTCELL_HOST_DEVICE
    CellGradients(const Gradients &x, const Gradients &y, const Gradients &z) : components_{x, y, z}
    {
    }

    template <class Real>
    SOFTCELL_HOST_DEVICE void gather(const Cells &cells, const Components<const Real> &u)
    {
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c)
      {
        Corners<Number> v;
        cells.gather(u.component[c], v);
        components_[c].evaluate(v);
      }
    }

    template <class AnyPoint>
    SOFTCELL_HOST_DEVICE Matrix3<Number> at(const AnyPoint &point) const
    {
      Matrix3<Number> gradient;
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c)
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; ++axis)
          gradient(c, axis) = components_[c].derivative(point, axis);
      return gradient;
    }

    /// I + du/dX.
    template <class AnyPoint>
    SOFTCELL_HOST_DEVICE Matrix3<Number> deformation_gradient(const AnyPoint &point) const
    {
      Matrix3<Number> F = at(point);
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c)
        F(c, c) += Number(1);
      return F;
    }

    /// The same, and I where there is no weight.
    template <class AnyPoint, class Weight>
    SOFTCELL_HOST_DEVICE Matrix3<Number> deformation_gradient(const AnyPoint &point,
                                                              const Weight &weight) const
    {
      Matrix3<Number> F = deformation_gradient(point);
      Cells::reset_where_empty(weight, F);
      return F;
    }

    template <class AnyPoint>
    SOFTCELL_HOST_DEVICE void add(const AnyPoint &point, const Matrix3<Number> &P)
    {
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c)
#pragma GCC unroll 3
        for (int axis = 0; axis < 3; ++axis)
          components_[c].add(point, axis, P(c, axis));
    }

    /// Adds the sums over the points of what was added there times the shapes' derivatives.
    template <class Real>
    SOFTCELL_HOST_DEVICE void scatter(const Cells &cells, const Components<Real> &r)
    {
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c)
      {
        Corners<Number> v;
        components_[c].integrate(v);
        cells.add(v, r.component[c]);
      }
    }

  private:
    Gradients components_[3];
  };

  /// Where the gradients of a tangent's displacement are kept; cells may have a place of their own.
  template <class Cells, class Real>
  SOFTCELL_HOST_DEVICE CellGradients<Cells> state_gradients(const Cells &,
                                                            const CellGeometry<Real> &geometry)
  {
    return CellGradients<Cells>(geometry);
  }

  /// The law with moduli times the weight, which multiplies all that it gives.
  template <template <class> class Law, class Real, class Weight>
  SOFTCELL_HOST_DEVICE Law<Weight> weighted(const Law<Real> &law, const Weight &weight)
  {
    return {law.lambda * weight, law.mu * weight};
  }

  /// Is the pressure lambda v worth keeping? It costs a logarithm.
  template <class Law>
  constexpr bool has_costly_pressure = false;
  template <class Real>
  constexpr bool has_costly_pressure<NeoHookean<Real>> = true;
  template <class Real>
  constexpr bool has_costly_pressure<InvertibleNeoHookean<Real>> = true;

  /// lambda v, with the logarithm of `Cells` in place of the library's.
  template <class Cells, class Law, class Number>
  SOFTCELL_HOST_DEVICE Number pressure(const Law &law, const Matrix3<Number> &F)
  {
    if constexpr (has_costly_pressure<Law>)
      return law.lambda * law.volumetric_strain(F, [](const Number &x) { return Cells::log1p(x); });
    else
      return law.lambda * law.volumetric_strain(F);
  }

  /// Adds the internal force.
  /// @return how many points are turned inside out, as Cells counts them.
  template <class Cells, class Law, class Real>
  SOFTCELL_FLATTEN SOFTCELL_HOST_DEVICE unsigned int
  add_residual(const Cells &cells,
               const Law &law,
               const CellGeometry<Real> &geometry,
               const Components<const Real> &u,
               const Components<Real> &r)
  {
    unsigned int n_inverted = 0;
    CellGradients<Cells> H(geometry), stress(geometry);
    H.gather(cells, u);
    cells.for_each_point([&](const auto &point, std::size_t, const auto &weight) {
      const auto F = H.deformation_gradient(point, weight);
      n_inverted += Cells::count(!law.is_admissible(determinant(F)));
      const auto p = weight * pressure<Cells>(law, F);
      stress.add(point, weighted(law, weight).first_piola_stress(F, p));
    });
    stress.scatter(cells, r);
    return n_inverted;
  }

  /// What a tangent keeps, by number of the point.
  template <class Number>
  struct PointModuli
  {
    Number *pressure; // lambda v; unused unless has_costly_pressure
    Number *added;    // to lambda, of a definite tangent; null if it is exact
  };

  /// Takes the moduli at u.
  /// @return how many points are turned inside out.
  template <class Cells, class Law, class Real>
  SOFTCELL_FLATTEN SOFTCELL_HOST_DEVICE unsigned int keep_moduli(const Cells &cells,
                                                                 const Law &law,
                                                                 const CellGeometry<Real> &geometry,
                                                                 const Components<const Real> &u,
                                                                 const PointModuli<Real> &moduli)
  {
    unsigned int n_inverted = 0;
    CellGradients<Cells> H(geometry);
    H.gather(cells, u);
    cells.for_each_point([&](const auto &point, const std::size_t number, const auto &weight) {
      const auto F = H.deformation_gradient(point, weight);
      n_inverted += Cells::count(!law.is_admissible(determinant(F)));
      if constexpr (has_costly_pressure<Law>)
      {
        auto p = pressure<Cells>(law, F);
        if (moduli.added != nullptr)
        {
          const auto definite = definite_moduli(law, F, p);
          Cells::store(definite.added, moduli.added, number);
          p = definite.pressure;
        }
        Cells::store(p, moduli.pressure, number);
      }
    });
    return n_inverted;
  }

  /// Calls f(point, weighted tangent) for all points.
  template <class Cells, class Law, class Real, class F>
  SOFTCELL_HOST_DEVICE void for_each_tangent(const Cells &cells,
                                             const Law &law,
                                             const CellGeometry<Real> &geometry,
                                             const Components<const Real> &u,
                                             const PointModuli<const Real> &moduli,
                                             const F &f)
  {
    using Number = typename Cells::Number;
    auto H       = state_gradients(cells, geometry);
    H.gather(cells, u);
    cells.for_each_point([&](const auto &point, const std::size_t number, const auto &weight) {
      // without weight it is any finite matrix, of which the weighted law makes 0
      const Matrix3<Number> F_at = H.deformation_gradient(point);
      const auto own_law         = weighted(law, weight);
      if constexpr (has_costly_pressure<Law>)
      {
        const Number pressure = weight * Cells::load(moduli.pressure, number);
        auto tangent          = own_law.linearisation(F_at, pressure);
        tangent.lambda        = own_law.lambda;
        if (moduli.added != nullptr)
          tangent.lambda += weight * Cells::load(moduli.added, number);
        f(point, tangent);
      }
      else
        f(point, own_law.linearisation(F_at));
    });
  }

  /// Adds the tangent at u times x.
  template <class Cells, class Law, class Real>
  SOFTCELL_FLATTEN SOFTCELL_HOST_DEVICE void
  add_tangent_action(const Cells &cells,
                     const Law &law,
                     const CellGeometry<Real> &geometry,
                     const Components<const Real> &u,
                     const PointModuli<const Real> &moduli,
                     const Components<const Real> &x,
                     const Components<Real> &y)
  {
    CellGradients<Cells> dH(geometry), stress(geometry);
    dH.gather(cells, x);
    for_each_tangent(cells, law, geometry, u, moduli, [&](const auto &point, const auto &tangent) {
      stress.add(point, tangent(dH.at(point)));
    });
    stress.scatter(cells, y);
  }
} // namespace softcell
