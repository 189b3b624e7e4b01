// SPDX-License-Identifier: LGPL-2.1-or-later
// The internal forces of an elastic body and their tangent without a matrix.

#include <softcell/operators/matrix_free_elasticity.h>

#include "cell_diagonal.h"
#include "inverted_points.h"
#include "simd_numbers.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace softcell
{
  namespace
  {
    namespace stdx = std::experimental;

    /// What packs of all kinds have in common.
    template <class Real>
    struct SimdCells : SimdNumbers<Real>
    {
      const CellGeometry<Real> &geometry;
    };

    /// Neighbours along x with Gauss points, in one row or half of them in another one. One kernel
    /// serves all: three would be larger than the processor's cache of instructions.
    template <class Real>
    struct RowCells : SimdCells<Real>
    {
      using Number    = typename SimdCells<Real>::Number;
      using Half      = stdx::resize_simd_t<SimdCells<Real>::W / 2, Number>;
      using Gradients = GaussGradients<Number, Real>;

      const typename UniformCells<Real>::RowPack &pack;

      void gather(const Real *const field, Corners<Number> &v) const
      {
#pragma GCC unroll 8
        for (int i = 0; i < 8; ++i)
        {
          const Real *const nodes = field + this->geometry.corners[i];
          v[i] = pack.is_one_row ? Number(nodes + pack.lower, stdx::element_aligned)
                                 : this->joined(Half(nodes + pack.lower, stdx::element_aligned),
                                                Half(nodes + pack.upper, stdx::element_aligned));
        }
      }

      void add(const Corners<Number> &v, Real *const field) const
      {
        if (pack.is_one_row)
          add_row(v, field + pack.lower);
        else
        {
          Corners<Half> lower, upper;
#pragma GCC unroll 8
          for (int i = 0; i < 8; ++i)
          {
            const auto halves = stdx::split<Half>(v[i]);
            lower[i]          = halves[0];
            upper[i]          = halves[1];
          }
          add_row(lower, field + pack.lower);
          add_row(upper, field + pack.upper);
        }
      }

      /// The forces of both ends of the cells' edges along x in one pack of nodes, and the last
      /// cell's far end by itself: a pack that is loaded at another place than it was just stored
      /// to would have to wait.
      template <class Pack>
      void add_row(const Corners<Pack> &v, Real *const nodes) const
      {
#pragma GCC unroll 4
        for (int i = 0; i < 8; i += 2)
        {
          Real *const first = nodes + this->geometry.corners[i];
          (Pack(first, stdx::element_aligned) + (v[i] + this->moved_up(v[i + 1])))
            .copy_to(first, stdx::element_aligned);
          first[Pack::size()] += v[i + 1][Pack::size() - 1];
        }
      }

      template <class F>
      void for_each_point(const F &f) const
      {
#pragma GCC unroll 8
        for (int q = 0; q < 8; ++q)
          f(GaussPoint<Real>{q}, pack.point + q, this->load(pack.weights, q));
      }

      /// Asks for a field in all four rows of nodes of a pack ahead: rows of a cut body begin
      /// anywhere, which the processor's own prefetching does not foresee. Always inlined, as GCC
      /// takes calls of a function that does no more than this for dead.
      [[gnu::always_inline]] void prefetch(const LatticeVector<Real> &field) const
      {
        for (unsigned int c = 0; c < 3; ++c)
          for (const int corner : {0, 2, 4, 6})
          {
            const Real *const nodes = field.component(c) + this->geometry.corners[corner];
            __builtin_prefetch(nodes + pack.ahead->lower);
            __builtin_prefetch(nodes + pack.ahead->upper + this->W / 2);
          }
      }

      /// Asks for the weights of a pack ahead and for its moduli, which are read once: caches need
      /// not keep them.
      [[gnu::always_inline]] void prefetch_points(const PointModuli<const Real> &moduli) const
      {
        for (const Real *const numbers : {moduli.pressure, moduli.added})
          if (numbers != nullptr)
            for (unsigned int q = 0; q < 8; ++q)
              __builtin_prefetch(numbers + (pack.ahead->point + q) * this->W, 0, 0);
        for (unsigned int q = 0; q < 8; ++q)
          __builtin_prefetch(pack.ahead->weights + q * this->W);
      }
    };

    /// Cells from anywhere with points of their own.
    template <class Real>
    struct ScatteredCells : SimdCells<Real>
    {
      using Number    = typename SimdCells<Real>::Number;
      using Gradients = PointGradients<Number, Real>;

      const typename UniformCells<Real>::PointPack &pack;

      void gather(const Real *const field, Corners<Number> &v) const
      {
        for (int i = 0; i < 8; ++i)
          v[i] = Number(
            [&](const auto lane) { return field[pack.entries[lane] + this->geometry.corners[i]]; });
      }

      void add(const Corners<Number> &v, Real *const field) const
      {
        for (int i = 0; i < 8; ++i)
          for (unsigned int lane = 0; lane < this->W; ++lane)
            field[pack.entries[lane] + this->geometry.corners[i]] += v[i][lane];
      }

      template <class F>
      void for_each_point(const F &f) const
      {
        const auto at = [&](const unsigned int q, const unsigned int k) {
          return this->load(pack.points, 4 * q + k);
        };
        for (unsigned int q = 0; q < pack.n_points; ++q)
          f(CubePoint<Number>{{at(q, 0), at(q, 1), at(q, 2)}}, pack.point + q, at(q, 3));
      }

      void prefetch(const LatticeVector<Real> &) const {}
      void prefetch_points(const PointModuli<const Real> &) const {}
    };

    template <class Real>
    CellGeometry<Real> geometry_of(const UniformCells<Real> &cells)
    {
      CellGeometry<Real> geometry;
      for (unsigned int v = 0; v < 8; ++v)
        geometry.corners[v] = cells.nodes().entry(v % 2, v / 2 % 2, v / 4);
      geometry.weight = cells.spacing()[0] * cells.spacing()[1] * cells.spacing()[2] / 8;
      for (unsigned int d = 0; d < dim; ++d)
        geometry.scale[d] = 1 / (4 * cells.spacing()[d]);
      return geometry;
    }

    template <class Real>
    Components<const Real> components(const LatticeVector<Real> &u)
    {
      return {{u.component(0), u.component(1), u.component(2)}};
    }
    template <class Real>
    Components<Real> components(LatticeVector<Real> &u)
    {
      return {{u.component(0), u.component(1), u.component(2)}};
    }

    /// Calls f(cells, law, geometry, layer) for all packs of cells.
    template <class Real, class BeginPlane, class F>
    void for_each_pack(const UniformCells<Real> &cells,
                       const Material &material,
                       const BeginPlane &begin_plane,
                       const F &f)
    {
      const CellGeometry<Real> geometry = geometry_of(cells);
      material.visit([&](const auto &double_law) {
        const auto law = rounded<Real>(double_law);
        cells.for_each_pack(begin_plane, [&](const auto &pack, const int layer) {
          if constexpr (std::is_same_v<std::decay_t<decltype(pack)>,
                                       typename UniformCells<Real>::PointPack>)
            f(ScatteredCells<Real>{{{}, geometry}, pack}, law, geometry, layer);
          else
            f(RowCells<Real>{{{}, geometry}, pack}, law, geometry, layer);
        });
      });
    }

    constexpr auto nothing_to_begin = [](const int) {};

    /// Calls f(law, weight, F, layer) for all packs of points.
    template <class Real, class F>
    void for_each_point(const UniformCells<Real> &cells,
                        const Material &material,
                        const LatticeVector<Real> &u,
                        const F &f)
    {
      for_each_pack(cells, material, nothing_to_begin,
                    [&](const auto &pack, const auto &law, const auto &geometry, const int layer) {
                      CellGradients<std::decay_t<decltype(pack)>> H(geometry);
                      H.gather(pack, components(u));
                      pack.for_each_point([&](const auto &point, std::size_t, const auto &weight) {
                        f(law, weight, H.deformation_gradient(point, weight), layer);
                      });
                    });
    }

    /// Sets the nodes of cells in a plane to 0, which all others are.
    template <class Real, class Field>
    auto clear(const UniformCells<Real> &cells, Field &field)
    {
      return [&](const int k) {
        cells.for_each_run(k, [&](const std::size_t entry, const std::size_t n) {
          for (unsigned int c = 0; c < field.n_components(); ++c)
            std::fill_n(field.component(c) + entry, n, 0);
        });
      };
    }

    void throw_if_inverted(const std::vector<unsigned int> &by_layer)
    {
      softcell::throw_if_inverted(
        std::accumulate(by_layer.begin(), by_layer.end(), std::size_t(0)));
    }
  } // namespace

  template <class Real>
  MatrixFreeElasticity<Real>::MatrixFreeElasticity(const UniformCells<Real> &cells,
                                                   const Material &material)
      : cells_(cells), material_(material), u_(cells.nodes())
  {
    material_.visit([&](const auto &law) {
      if (has_costly_pressure<std::decay_t<decltype(law)>>)
        pressures_.resize(cells.n_point_packs() * SimdCells<Real>::W, Real(0));
    });
  }

  template <class Real>
  double MatrixFreeElasticity<Real>::energy(const LatticeVector<Real> &u) const
  {
    const unsigned int n_layers = cells_.nodes().n_cells()[2];
    std::vector<double> energies(n_layers, 0.);
    std::vector<unsigned int> n_inverted(n_layers, 0);
    for_each_point(cells_, material_, u,
                   [&](const auto &law, const auto &weight, const auto &F, const int layer) {
                     n_inverted[layer] += stdx::popcount(!law.is_admissible(determinant(F)));
                     if constexpr (has_costly_pressure<std::decay_t<decltype(law)>>)
                     {
                       const auto v = law.volumetric_strain(F, SimdCells<Real>::log1p);
                       energies[layer] += stdx::reduce(weight * law.energy(F, v));
                     }
                     else
                       energies[layer] += stdx::reduce(weight * law.energy(F));
                   });
    throw_if_inverted(n_inverted);
    return std::accumulate(energies.begin(), energies.end(), 0.);
  }

  template <class Real>
  double MatrixFreeElasticity<Real>::min_jacobian(const LatticeVector<Real> &u) const
  {
    using Number      = typename SimdCells<Real>::Number;
    const double none = std::numeric_limits<double>::max();
    std::vector<double> smallest(cells_.nodes().n_cells()[2], none);
    for_each_point(cells_, material_, u,
                   [&](const auto &, const auto &weight, const auto &F, const int layer) {
                     Number J                    = determinant(F);
                     stdx::where(weight == 0, J) = std::numeric_limits<Real>::max();
                     smallest[layer]             = std::min<double>(smallest[layer], stdx::hmin(J));
                   });
    return *std::min_element(smallest.begin(), smallest.end());
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::residual(const LatticeVector<Real> &u,
                                            LatticeVector<Real> &r) const
  {
    std::vector<unsigned int> n_inverted(cells_.nodes().n_cells()[2], 0);
    for_each_pack(cells_, material_, clear(cells_, r),
                  [&](const auto &cells, const auto &law, const auto &geometry, const int layer) {
                    cells.prefetch(u);
                    cells.prefetch(r);
                    n_inverted[layer] +=
                      add_residual(cells, law, geometry, components(u), components(r));
                  });
    throw_if_inverted(n_inverted);
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::set_state(const LatticeVector<Real> &u, const Tangent tangent)
  {
    u_ = u;
    set_tangent(tangent);
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::set_tangent(const Tangent tangent)
  {
    if (tangent == Tangent::exact)
      added_moduli_.clear();
    else
      added_moduli_.resize(pressures_.size());
    const PointModuli<Real> moduli{pressures_.data(), added_moduli_.data()};
    std::vector<unsigned int> n_inverted(cells_.nodes().n_cells()[2], 0);
    for_each_pack(cells_, material_, nothing_to_begin,
                  [&](const auto &cells, const auto &law, const auto &geometry, const int layer) {
                    cells.prefetch(u_);
                    n_inverted[layer] +=
                      keep_moduli(cells, law, geometry, components(std::as_const(u_)), moduli);
                  });
    throw_if_inverted(n_inverted);
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::vmult(LatticeVector<Real> &y, const LatticeVector<Real> &x) const
  {
    const PointModuli<const Real> moduli{pressures_.data(), added_moduli_.data()};
    for_each_pack(cells_, material_, clear(cells_, y),
                  [&](const auto &cells, const auto &law, const auto &geometry, int) {
                    cells.prefetch(u_);
                    cells.prefetch(x);
                    cells.prefetch(y);
                    cells.prefetch_points(moduli);
                    add_tangent_action(cells, law, geometry, components(u_), moduli, components(x),
                                       components(y));
                  });
  }

  template <class Real>
  void MatrixFreeElasticity<Real>::diagonal(LatticeBlocks<Real> &blocks) const
  {
    const PointModuli<const Real> moduli{pressures_.data(), added_moduli_.data()};
    for_each_pack(cells_, material_, clear(cells_, blocks),
                  [&](const auto &cells, const auto &law, const auto &geometry, int) {
                    Real *const all[6] = {blocks.component(0), blocks.component(1),
                                          blocks.component(2), blocks.component(3),
                                          blocks.component(4), blocks.component(5)};
                    add_diagonal(cells, law, geometry, components(u_), moduli, all);
                  });
  }

  template <class Real>
  std::size_t MatrixFreeElasticity<Real>::memory() const
  {
    return u_.entries().size() * sizeof(Real) + pressures_.memory_consumption() +
           added_moduli_.memory_consumption();
  }

  template class MatrixFreeElasticity<double>;
  template class MatrixFreeElasticity<float>;
} // namespace softcell
