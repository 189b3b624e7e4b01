// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent without a matrix.

#include <softcell/operators/matrix_free_elasticity.h>

#include "trilinear.h"

#include <softcell/base/exceptions.h>

#include <algorithm>
#include <experimental/simd>
#include <limits>
#include <numeric>

namespace softcell
{
  namespace
  {
    namespace stdx = std::experimental;

    template <class Real>
    using Simd = stdx::native_simd<Real>;

    template <class Real>
    Simd<Real> load_aligned(const Real *const packed)
    {
      return Simd<Real>(packed, stdx::vector_aligned);
    }

    /// What all cells of a grid have in common.
    template <class Real>
    struct Grid
    {
      explicit Grid(const UniformCells<Real> &cells)
          : weight(cells.spacing()[0] * cells.spacing()[1] * cells.spacing()[2] / 8)
      {
        for (unsigned int v = 0; v < 8; ++v)
          corners[v] = cells.nodes().entry(v % 2, v / 2 % 2, v / 4);
        for (unsigned int d = 0; d < dim; ++d)
          scale[d] = 1 / (4 * cells.spacing()[d]);
      }

      std::size_t corners[8]; // entries from that of the lowest node
      Real weight;            // of a full cell's points. Units: m^3
      Real scale[3];          // of GaussGradients. Units: 1/m
    };

    /// Neighbours along x with Gauss points, some of which may have weights of their own.
    template <class Real, bool is_full>
    class RowCells
    {
    public:
      using Number    = Simd<Real>;
      using Gradients = GaussGradients<Number, Real>;

      RowCells(const Grid<Real> &grid, const typename UniformCells<Real>::RowPack &pack)
          : grid_(grid), pack_(pack)
      {
      }

      void gather(const Real *const component, Corners<Number> &v) const
      {
#pragma GCC unroll 8
        for (int i = 0; i < 8; ++i)
          v[i].copy_from(component + pack_.entry + grid_.corners[i], stdx::element_aligned);
      }

      void add(const Corners<Number> &v, Real *const component) const
      {
#pragma GCC unroll 8
        for (int i = 0; i < 8; ++i)
        {
          Real *const entry = component + pack_.entry + grid_.corners[i];
          (Number(entry, stdx::element_aligned) + v[i]).copy_to(entry, stdx::element_aligned);
        }
      }

      /// Calls f(point, its number among all packs of points, weight).
      template <class F>
      void for_each_point(const F &f) const
      {
#pragma GCC unroll 8
        for (int q = 0; q < 8; ++q)
          if constexpr (is_full)
            f(GaussPoint<Real>{q}, pack_.point + q, grid_.weight);
          else
            f(GaussPoint<Real>{q}, pack_.point + q,
              load_aligned(pack_.weights + q * Number::size()));
      }

    private:
      const Grid<Real> &grid_;
      const typename UniformCells<Real>::RowPack &pack_;
    };

    /// Cells from anywhere with points of their own.
    template <class Real>
    class ScatteredCells
    {
    public:
      using Number    = Simd<Real>;
      using Gradients = PointGradients<Number, Real>;

      ScatteredCells(const Grid<Real> &grid, const typename UniformCells<Real>::PointPack &pack)
          : grid_(grid), pack_(pack)
      {
      }

      void gather(const Real *const component, Corners<Number> &v) const
      {
        for (int i = 0; i < 8; ++i)
          v[i] = Number(
            [&](const auto lane) { return component[pack_.entries[lane] + grid_.corners[i]]; });
      }

      void add(const Corners<Number> &v, Real *const component) const
      {
        for (int i = 0; i < 8; ++i)
          for (unsigned int lane = 0; lane < Number::size(); ++lane)
            component[pack_.entries[lane] + grid_.corners[i]] += v[i][lane];
      }

      template <class F>
      void for_each_point(const F &f) const
      {
        constexpr unsigned int W = Number::size();
        const Real *data         = pack_.points;
        for (unsigned int q = 0; q < pack_.n_points; ++q, data += 4 * W)
          f(CubePoint<Number>{{load_aligned(data), load_aligned(data + W),
                               load_aligned(data + 2 * W)}},
            pack_.point + q, load_aligned(data + 3 * W));
      }

    private:
      const Grid<Real> &grid_;
      const typename UniformCells<Real>::PointPack &pack_;
    };

    /// Three components of something at the points of a pack of cells.
    template <class Cells>
    class FieldGradients
    {
    public:
      using Number    = typename Cells::Number;
      using Gradients = typename Cells::Gradients;

      template <class Real>
      explicit FieldGradients(const Grid<Real> &grid)
          : components_{Gradients(grid.scale), Gradients(grid.scale), Gradients(grid.scale)}
      {
      }

      template <class Real>
      void gather(const Cells &cells, const LatticeVector<Real> &u)
      {
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
        {
          Corners<Number> v;
          cells.gather(u.component(c), v);
          components_[c].evaluate(v);
        }
      }

      template <class AnyPoint>
      Matrix3<Number> at(const AnyPoint &point) const
      {
        Matrix3<Number> gradient;
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
#pragma GCC unroll 3
          for (int axis = 0; axis < 3; ++axis)
            gradient(c, axis) = components_[c].derivative(point, axis);
        return gradient;
      }

      template <class AnyPoint>
      void add(const AnyPoint &point, const Matrix3<Number> &P)
      {
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
#pragma GCC unroll 3
          for (int axis = 0; axis < 3; ++axis)
            components_[c].add(point, axis, P(c, axis));
      }

      template <class Real>
      void scatter(const Cells &cells, LatticeVector<Real> &r)
      {
#pragma GCC unroll 3
        for (int c = 0; c < 3; ++c)
        {
          Corners<Number> v;
          components_[c].integrate(v);
          cells.add(v, r.component(c));
        }
      }

    private:
      Gradients components_[3];
    };

    /// F = I + H, and I where there is no weight, so that nothing undefined comes of it.
    template <class Number, class Weight>
    Matrix3<Number> deformation_gradient(const Matrix3<Number> &H, const Weight &weight)
    {
      Matrix3<Number> F = H + identity<Number>();
      if constexpr (std::is_same_v<Weight, Number>)
#pragma GCC unroll 9
        for (int k = 0; k < 9; ++k)
          stdx::where(weight == 0, F.entries[k]) = Number(k % 4 == 0 ? 1 : 0);
      return F;
    }

    /// The law with moduli in Real.
    template <class Real, template <class> class Law>
    Law<Real> rounded(const Law<double> &law)
    {
      return {Real(law.lambda), Real(law.mu)};
    }

    /// The law with moduli times the weight, which multiplies all that it gives.
    template <template <class> class Law, class Real, class Weight>
    Law<Weight> weighted(const Law<Real> &law, const Weight &weight)
    {
      return {law.lambda * weight, law.mu * weight};
    }

    /// Is lambda v worth keeping? It costs a logarithm.
    template <class Law>
    constexpr bool has_costly_pressure = false;
    template <class Real>
    constexpr bool has_costly_pressure<NeoHookean<Real>> = true;

    template <class Law, class Number, class Real, class Weight>
    auto linearisation(const Law &law,
                       const Matrix3<Number> &F,
                       const Real *const pressures,
                       const std::size_t point,
                       const Weight &weight)
    {
      if constexpr (has_costly_pressure<Law>)
      {
        const Number pressure = weight * load_aligned(pressures + point * Number::size());
        auto tangent          = law.linearisation(F, pressure);
        tangent.lambda        = law.lambda;
        return tangent;
      }
      else
        return law.linearisation(F);
    }

    /// Calls f(cells, layer) for all packs of cells.
    template <class Real, class BeginPlane, class F>
    void for_each_pack(const UniformCells<Real> &cells,
                       const Grid<Real> &grid,
                       const BeginPlane &begin_plane,
                       const F &f)
    {
      cells.for_each_pack(begin_plane, [&](const auto &pack, const int layer) {
        if constexpr (std::is_same_v<std::decay_t<decltype(pack)>,
                                     typename UniformCells<Real>::PointPack>)
          f(ScatteredCells<Real>(grid, pack), layer);
        else if (pack.weights == nullptr)
          f(RowCells<Real, true>(grid, pack), layer);
        else
          f(RowCells<Real, false>(grid, pack), layer);
      });
    }

    /// Sets a plane of nodes to 0.
    template <class Field>
    auto clear(Field &field)
    {
      return [&field](const int k) {
        for (unsigned int c = 0; c < field.n_components(); ++c)
          std::fill_n(field.component(c) + k * field.lattice().plane(), field.lattice().plane(), 0);
      };
    }

    constexpr auto nothing_to_begin = [](const int) {};

    /// Calls f(law, weight, F, number of the pack of points, layer) for all packs of points.
    template <class Real, class F>
    void for_each_point(const UniformCells<Real> &cells,
                        const Material &material,
                        const LatticeVector<Real> &u,
                        const F &f)
    {
      const Grid<Real> grid(cells);
      material.visit([&](const auto &double_law) {
        const auto law = rounded<Real>(double_law);
        for_each_pack(cells, grid, nothing_to_begin, [&](const auto &pack, const int layer) {
          FieldGradients<std::decay_t<decltype(pack)>> H(grid);
          H.gather(pack, u);
          pack.for_each_point([&](const auto &point, const std::size_t number, const auto &weight) {
            f(law, weight, deformation_gradient(H.at(point), weight), number, layer);
          });
        });
      });
    }

    /// Derivatives of the shape of a corner at a point.
    template <class Number, class Real, class AnyPoint>
    void corner_gradient(const AnyPoint &point,
                         const int corner,
                         const Real *const scale,
                         Number *const gradient)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        gradient[axis] = Number((corner >> axis) & 1 ? scale[axis] : -scale[axis]);
        for (const int other : {(axis + 1) % 3, (axis + 2) % 3})
        {
          const Real sign = (corner >> other) & 1 ? 1 : -1;
          gradient[axis] *= Real(1) + sign * Number(point.place(other));
        }
      }
    }

    void throw_if_inverted(const std::vector<unsigned int> &by_layer)
    {
      if (const auto n = std::accumulate(by_layer.begin(), by_layer.end(), 0U); n > 0)
        throw InvertedPoint(std::to_string(n) +
                            (n == 1 ? " integration point is" : " integration points are") +
                            " turned inside out (J <= 0).");
    }
  } // namespace

  template <class Real>
  MatrixFreeElasticity<Real>::MatrixFreeElasticity(const UniformCells<Real> &cells,
                                                   const Material &material)
      : cells_(cells), material_(material), u_(cells.nodes())
  {
    material_.visit([&](const auto &law) {
      if (has_costly_pressure<std::decay_t<decltype(rounded<Real>(law))>>)
        pressures_.resize(cells.n_point_packs() * Simd<Real>::size(), Real(0));
    });
  }

  template <class Real>
  double MatrixFreeElasticity<Real>::energy(const LatticeVector<Real> &u) const
  {
    const unsigned int n_layers = cells_.nodes().n_cells()[2];
    std::vector<double> energies(n_layers, 0.);
    std::vector<unsigned int> n_inverted(n_layers, 0);
    for_each_point(
      cells_, material_, u,
      [&](const auto &law, const auto &weight, const auto &F, std::size_t, const int layer) {
        n_inverted[layer] += stdx::popcount(!law.is_admissible(determinant(F)));
        energies[layer] += stdx::reduce(weight * law.energy(F));
      });
    throw_if_inverted(n_inverted);
    return std::accumulate(energies.begin(), energies.end(), 0.);
  }

  template <class Real>
  double MatrixFreeElasticity<Real>::min_jacobian(const LatticeVector<Real> &u) const
  {
    const double none = std::numeric_limits<double>::max();
    std::vector<double> smallest(cells_.nodes().n_cells()[2], none);
    for_each_point(
      cells_, material_, u,
      [&](const auto &, const auto &weight, const auto &F, std::size_t, const int layer) {
        Simd<Real> J                            = determinant(F);
        stdx::where(Simd<Real>(weight) == 0, J) = std::numeric_limits<Real>::max();
        smallest[layer]                         = std::min<double>(smallest[layer], stdx::hmin(J));
      });
    return *std::min_element(smallest.begin(), smallest.end());
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::residual(const LatticeVector<Real> &u,
                                            LatticeVector<Real> &r) const
  {
    const Grid<Real> grid(cells_);
    std::vector<unsigned int> n_inverted(cells_.nodes().n_cells()[2], 0);
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      for_each_pack(cells_, grid, clear(r), [&](const auto &cells, const int layer) {
        FieldGradients<std::decay_t<decltype(cells)>> H(grid), stress(grid);
        H.gather(cells, u);
        cells.for_each_point([&](const auto &point, std::size_t, const auto &weight) {
          const auto F = deformation_gradient(H.at(point), weight);
          n_inverted[layer] += stdx::popcount(!law.is_admissible(determinant(F)));
          stress.add(point, weighted(law, weight).first_piola_stress(F));
        });
        stress.scatter(cells, r);
      });
    });
    throw_if_inverted(n_inverted);
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::set_state(const LatticeVector<Real> &u)
  {
    u_ = u;
    std::vector<unsigned int> n_inverted(cells_.nodes().n_cells()[2], 0);
    for_each_point(
      cells_, material_, u,
      [&](const auto &law, const auto &, const auto &F, const std::size_t point, const int layer) {
        n_inverted[layer] += stdx::popcount(!law.is_admissible(determinant(F)));
        if constexpr (has_costly_pressure<std::decay_t<decltype(law)>>)
          (law.lambda * law.volumetric_strain(F))
            .copy_to(&pressures_[point * Simd<Real>::size()], stdx::vector_aligned);
      });
    throw_if_inverted(n_inverted);
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
    const Grid<Real> grid(cells_);
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      for_each_pack(cells_, grid, clear(y), [&](const auto &cells, int) {
        FieldGradients<std::decay_t<decltype(cells)>> H(grid), dH(grid), stress(grid);
        H.gather(cells, u_);
        dH.gather(cells, x);
        cells.for_each_point([&](const auto &point, const std::size_t number, const auto &weight) {
          const auto F = deformation_gradient(H.at(point), weight);
          const auto tangent =
            linearisation(weighted(law, weight), F, pressures_.data(), number, weight);
          stress.add(point, tangent(dH.at(point)));
        });
        stress.scatter(cells, y);
      });
    });
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::diagonal(LatticeBlocks<Real> &blocks) const
  {
    const Grid<Real> grid(cells_);
    material_.visit([&](const auto &double_law) {
      const auto law = rounded<Real>(double_law);
      for_each_pack(cells_, grid, clear(blocks), [&](const auto &cells, int) {
        using Number = typename std::decay_t<decltype(cells)>::Number;
        FieldGradients<std::decay_t<decltype(cells)>> H(grid);
        H.gather(cells, u_);
        Corners<Number> K[6] = {};
        cells.for_each_point([&](const auto &point, const std::size_t number, const auto &weight) {
          const auto F = deformation_gradient(H.at(point), weight);
          const auto tangent =
            linearisation(weighted(law, weight), F, pressures_.data(), number, weight);
          for (int corner = 0; corner < 8; ++corner)
          {
            NodalGradient<Number> dF;
            corner_gradient(point, corner, grid.scale, dF.gradient);
            for (dF.component = 0; dF.component < 3; ++dF.component)
            {
              const Matrix3<Number> dP = tangent(dF);
              for (int a = 0; a <= dF.component; ++a)
                K[a == dF.component ? a : 6 - a - dF.component][corner] += dot(dP, a, dF.gradient);
            }
          }
        });
        for (int k = 0; k < 6; ++k)
          cells.add(K[k], blocks.component(k));
      });
    });
  }

  template <class Real>
  std::size_t MatrixFreeElasticity<Real>::memory() const
  {
    return u_.entries().size() * sizeof(Real) + pressures_.memory_consumption();
  }

  template class MatrixFreeElasticity<double>;
  template class MatrixFreeElasticity<float>;
} // namespace softcell
