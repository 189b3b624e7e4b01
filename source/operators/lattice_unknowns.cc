// SPDX-License-Identifier: LGPL-2.1-or-later
// Coarse cells, coarse unknowns and trilinear transfer.

#include <softcell/operators/lattice_unknowns.h>

#include <softcell/mechanics/kinematics.h>
#include <softcell/quadrature/weighted_cell.h>

#include <algorithm>

namespace softcell
{
  namespace
  {
    /// Calls f(node, i, j, k) for all nodes of a lattice, along x first.
    template <class F>
    void for_each_node(const NodeLattice &nodes, const F &f)
    {
      const auto &n = nodes.n_cells();
      for (int k = 0; k <= n[2]; ++k)
        for (int j = 0; j <= n[1]; ++j)
          for (int i = 0; i <= n[0]; ++i)
            f(nodes.entry(i, j, k), i, j, k);
    }

    bool is_inside(const NodeLattice &nodes, const int i, const int j, const int k)
    {
      const auto &n = nodes.n_cells();
      return i >= 0 && j >= 0 && k >= 0 && i <= n[0] && j <= n[1] && k <= n[2];
    }

    /// Calls f(dx, dy, dz) for the steps from a node to itself and its neighbours.
    template <class F>
    void for_each_neighbour(const F &f)
    {
      for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx)
            f(dx, dy, dz);
    }

    /// Place along y and z of the row that an entry is in.
    std::array<int, 2> row_place(const NodeLattice &nodes, const std::size_t entry)
    {
      return {{int(entry % nodes.plane() / nodes.row()), int(entry / nodes.plane())}};
    }
  } // namespace

  CellLattice coarse_cells(const CellLattice &fine)
  {
    std::array<int, 3> n;
    for (unsigned int d = 0; d < dim; ++d)
      n[d] = (fine.nodes.n_cells()[d] + 1) / 2;
    CellLattice coarse{NodeLattice(n), 2. * fine.spacing, {}, {}, {}};

    const std::size_t n_cells = std::size_t(n[0]) * n[1] * n[2];
    std::vector<GaussCell> cells(n_cells);
    const auto add = [&](const auto &cell) {
      const auto [i, j, k] = cell.place;
      GaussCell &parent    = cells[i / 2 + n[0] * (j / 2 + std::size_t(n[1]) * (k / 2))];
      parent.place         = {{i / 2, j / 2, k / 2}};
      parent.weights[i % 2 + 2 * (j % 2) + 4 * (k % 2)] =
        std::accumulate(cell.weights.begin(), cell.weights.end(), 0.);
    };
    std::for_each(fine.gauss_cells.begin(), fine.gauss_cells.end(), add);
    std::for_each(fine.point_cells.begin(), fine.point_cells.end(), add);
    for (GaussCell &cell : cells)
    {
      const double volume = std::accumulate(cell.weights.begin(), cell.weights.end(), 0.);
      if (volume == 0)
        continue;
      WeightedCell::steady(cell.weights, volume / 8, CutParameters().spread);
      coarse.gauss_cells.push_back(cell);
    }
    return coarse;
  }

  LatticeUnknowns::LatticeUnknowns(const CellLattice &cells, const std::vector<std::size_t> &held)
      : nodes_(cells.nodes), flags_(nodes_.size(), 0)
  {
    mark_nodes(cells);
    for (const std::size_t entry : held)
      flags_[entry % nodes_.size()] &= ~(1U << entry / nodes_.size());
    find_runs();
  }

  LatticeUnknowns::LatticeUnknowns(const CellLattice &coarse, const LatticeUnknowns &fine)
      : nodes_(coarse.nodes), flags_(nodes_.size(), 0)
  {
    mark_nodes(coarse);
    for_each_node(nodes_, [&](const std::size_t node, const int i, const int j, const int k) {
      if (!has_cell(node))
        return;
      double all = 0, free[3] = {0, 0, 0};
      for_each_neighbour([&](const int dx, const int dy, const int dz) {
        if (!is_inside(fine.nodes_, 2 * i + dx, 2 * j + dy, 2 * k + dz))
          return;
        const std::size_t child = fine.nodes_.entry(2 * i + dx, 2 * j + dy, 2 * k + dz);
        if (!fine.has_cell(child))
          return;
        const double value = 1. / (1 << (dx * dx + dy * dy + dz * dz));
        all += value;
        for (unsigned int c = 0; c < dim; ++c)
          free[c] += fine.is_free(child, c) ? value : 0;
      });
      for (unsigned int c = 0; c < dim; ++c)
        if (2 * free[c] <= all)
          flags_[node] &= ~(1U << c);
    });
    find_runs();
  }

  void LatticeUnknowns::mark_nodes(const CellLattice &cells)
  {
    const auto mark = [&](const auto &found) {
      for (int v = 0; v < 8; ++v)
        flags_[nodes_.entry(found.place[0] + v % 2, found.place[1] + v / 2 % 2,
                            found.place[2] + v / 4)] = cell | all_free;
    };
    std::for_each(cells.gauss_cells.begin(), cells.gauss_cells.end(), mark);
    std::for_each(cells.point_cells.begin(), cells.point_cells.end(), mark);
  }

  void LatticeUnknowns::find_runs()
  {
    const auto &n = nodes_.n_cells();
    for (int k = 0; k <= n[2]; ++k)
      for (int j = 0; j <= n[1]; ++j)
      {
        std::size_t begin = nodes_.entry(0, j, k), end = begin + n[0] + 1;
        while (begin < end && !has_cell(begin))
          ++begin;
        while (begin < end && !has_cell(end - 1))
          --end;
        if (begin == end)
          continue;
        runs_.emplace_back(begin, end);
        for (std::size_t node = begin; node < end; ++node)
          for (unsigned int c = 0; c < dim; ++c)
            if (!is_free(node, c))
              held_.push_back(c * nodes_.size() + node);
      }
  }

  std::vector<std::size_t> LatticeUnknowns::free_entries() const
  {
    std::vector<std::size_t> entries;
    for (unsigned int c = 0; c < dim; ++c)
      for (const auto &[begin, end] : runs_)
        for (std::size_t node = begin; node < end; ++node)
          if (is_free(node, c))
            entries.push_back(c * nodes_.size() + node);
    return entries;
  }

  template <class F>
  double LatticeUnknowns::sum(const F &term) const
  {
    std::vector<double> sums(runs_.size());
#pragma omp parallel for schedule(static)
    for (std::size_t r = 0; r < runs_.size(); ++r)
    {
      double sum = 0;
      for (unsigned int c = 0; c < dim; ++c)
      {
#pragma omp simd reduction(+ : sum)
        for (std::size_t node = runs_[r].first; node < runs_[r].second; ++node)
          sum += term(c, node);
      }
      sums[r] = sum;
    }
    return std::accumulate(sums.begin(), sums.end(), 0.);
  }

  template <class Real>
  double LatticeUnknowns::dot(const LatticeVector<Real> &x, const LatticeVector<Real> &y) const
  {
    const Real *const a[3] = {x.component(0), x.component(1), x.component(2)}, *const b[3] = {
                                                                                 y.component(0),
                                                                                 y.component(1),
                                                                                 y.component(2)};
    return sum(
      [&](const unsigned int c, const std::size_t i) { return double(a[c][i]) * b[c][i]; });
  }

  template <class Real>
  double LatticeUnknowns::dot(const LatticeVector<Real> &x,
                              const LatticeVector<Real> &y,
                              const LatticeField<Real, 1> &weights) const
  {
    const Real *const a[3]        = {x.component(0), x.component(1), x.component(2)},
                      *const b[3] = {y.component(0), y.component(1), y.component(2)},
                      *const m    = weights.component(0);
    return sum(
      [&](const unsigned int c, const std::size_t i) { return double(m[i]) * a[c][i] * b[c][i]; });
  }

  template <class Real>
  void LatticeUnknowns::interpolate(const LatticeVector<Real> &coarse,
                                    LatticeVector<Real> &fine) const
  {
    const NodeLattice &parents = coarse.lattice();
    for_each_run([&](const std::size_t begin, const std::size_t end) {
      const auto [j, k]       = row_place(nodes_, begin);
      const std::size_t first = nodes_.entry(0, j, k); // of the row
      const int i_begin = begin - first, i_end = end - first;
      const int parent = i_begin / 2, n_parents = i_end / 2 + 1 - parent;
      std::vector<Real> means(n_parents + 1); // of the rows beside this one
      for (unsigned int c = 0; c < dim; ++c)
      {
        const Real *rows[4];
        for (int r = 0; r < 4; ++r)
          rows[r] = coarse.component(c) + parents.entry(parent, (j + r % 2) / 2, (k + r / 2) / 2);
        for (int p = 0; p < n_parents; ++p)
          means[p] = Real(0.25) * (rows[0][p] + rows[1][p] + rows[2][p] + rows[3][p]);
        Real *const row = fine.component(c) + first;
        for (int i = i_begin; i < i_end; ++i)
          row[i] = Real(0.5) * (means[i / 2 - parent] + means[(i + 1) / 2 - parent]);
      }
    });
    hold(fine);
  }

  template <class Real>
  void LatticeUnknowns::sum_up(const LatticeVector<Real> &fine, LatticeVector<Real> &coarse) const
  {
    const NodeLattice &children = fine.lattice();
    const auto &n               = children.n_cells();
    for_each_run([&](const std::size_t begin, const std::size_t end) {
      const auto [j, k]       = row_place(nodes_, begin);
      const std::size_t first = nodes_.entry(0, j, k);
      const int i_begin = begin - first, i_end = end - first;
      // the children from one before the first parent's to one after the last one's
      const int child = 2 * i_begin - 1, n_children = 2 * (i_end - i_begin) + 1;
      const int lower = std::max(-child, 0), upper = std::min(n_children, n[0] + 1 - child);
      std::vector<Real> sums(n_children);
      for (unsigned int c = 0; c < dim; ++c)
      {
        std::fill(sums.begin(), sums.end(), Real(0));
        for (int z = std::max(2 * k - 1, 0); z <= std::min(2 * k + 1, n[2]); ++z)
          for (int y = std::max(2 * j - 1, 0); y <= std::min(2 * j + 1, n[1]); ++y)
          {
            const Real value      = Real(1) / ((1 + (y & 1)) * (1 + (z & 1)));
            const Real *const row = fine.component(c) + children.entry(0, y, z) + child;
            for (int i = lower; i < upper; ++i)
              sums[i] += value * row[i];
          }
        Real *const row = coarse.component(c) + begin;
        for (int i = 0; i < i_end - i_begin; ++i)
          row[i] = sums[2 * i + 1] + Real(0.5) * (sums[2 * i] + sums[2 * i + 2]);
      }
    });
    hold(coarse);
  }

  template <class Real>
  void LatticeUnknowns::take(const LatticeUnknowns &fine,
                             const LatticeVector<Real> &u_fine,
                             LatticeVector<Real> &u) const
  {
    const auto child = [&](const int i, const int j, const int k) {
      const bool exists = is_inside(fine.nodes_, i, j, k);
      return exists && fine.has_cell(fine.nodes_.entry(i, j, k)) ? fine.nodes_.entry(i, j, k)
                                                                 : std::size_t(-1);
    };
    for_each_node(nodes_, [&](const std::size_t node, const int i, const int j, const int k) {
      if (!has_cell(node))
        return;
      if (const std::size_t same = child(2 * i, 2 * j, 2 * k); same != std::size_t(-1))
      {
        for (unsigned int c = 0; c < dim; ++c)
          u.component(c)[node] = u_fine.component(c)[same];
        return;
      }
      // a cell of the finer lattice beside the node has two nodes in line with it
      Real sum[3] = {0, 0, 0};
      int n       = 0;
      for_each_neighbour([&](const int dx, const int dy, const int dz) {
        const std::size_t a = child(2 * i + dx, 2 * j + dy, 2 * k + dz),
                          b = child(2 * (i + dx), 2 * (j + dy), 2 * (k + dz));
        if (a == std::size_t(-1) || b == std::size_t(-1))
          return;
        for (unsigned int c = 0; c < dim; ++c)
          sum[c] += 2 * u_fine.component(c)[a] - u_fine.component(c)[b];
        ++n;
      });
      for (unsigned int c = 0; c < dim; ++c)
        u.component(c)[node] = sum[c] / n;
    });
  }

  /// Is det F small at a Gauss point of the cell with these corners?
  template <class Real>
  bool LatticeUnknowns::is_tangled(const std::size_t (&corners)[8],
                                   const Direction &spacing,
                                   const double smallest,
                                   const LatticeVector<Real> &u) const
  {
    constexpr double near = 0.78867513459481288, far = 1 - near; // shapes at a Gauss point
    for (int q = 0; q < 8; ++q)
    {
      Matrix3<double> F = identity<double>();
      for (int axis = 0; axis < 3; ++axis)
        for (int v = 0; v < 8; ++v)
        {
          double gradient = (v >> axis & 1 ? 1 : -1) / spacing[axis];
          for (int other = 0; other < 3; ++other)
            if (other != axis)
              gradient *= (v >> other & 1) == (q >> other & 1) ? near : far;
          for (int c = 0; c < 3; ++c)
            F(c, axis) += gradient * u.component(c)[corners[v]];
        }
      if (!(determinant(F) > smallest))
        return true;
    }
    return false;
  }

  template <class Real>
  void LatticeUnknowns::untangle(const Direction &spacing,
                                 const double smallest,
                                 LatticeVector<Real> &u) const
  {
    constexpr unsigned int n_sweeps = 10;
    const auto &n                   = nodes_.n_cells();
    for (unsigned int sweep = 0; sweep < n_sweeps; ++sweep)
    {
      std::vector<std::uint8_t> is_marked(nodes_.size(), 0);
      bool is_good = true;
      for_each_node(nodes_, [&](const std::size_t node, const int i, const int j, const int k) {
        if (i == n[0] || j == n[1] || k == n[2])
          return;
        std::size_t corners[8];
        for (int v = 0; v < 8; ++v)
          corners[v] = node + nodes_.entry(v % 2, v / 2 % 2, v / 4);
        if (!std::all_of(corners, corners + 8, [&](const std::size_t c) { return has_cell(c); }) ||
            !is_tangled(corners, spacing, smallest, u))
          return;
        is_good = false;
        for (const std::size_t corner : corners)
          is_marked[corner] = 1;
      });
      if (is_good)
        return;
      const LatticeVector<Real> before = u;
      for_each_node(nodes_, [&](const std::size_t node, const int i, const int j, const int k) {
        if (!is_marked[node])
          return;
        double sum[3] = {0, 0, 0};
        int n_beside  = 0;
        for_each_neighbour([&](const int dx, const int dy, const int dz) {
          const bool exists = is_inside(nodes_, i + dx, j + dy, k + dz) &&
                              has_cell(nodes_.entry(i + dx, j + dy, k + dz));
          for (unsigned int c = 0; exists && c < dim; ++c)
            sum[c] += before.component(c)[nodes_.entry(i + dx, j + dy, k + dz)];
          n_beside += exists;
        });
        for (unsigned int c = 0; c < dim; ++c)
          u.component(c)[node] = sum[c] / n_beside;
      });
    }
  }

  template double LatticeUnknowns::dot(const LatticeVector<double> &,
                                       const LatticeVector<double> &) const;
  template double LatticeUnknowns::dot(const LatticeVector<float> &,
                                       const LatticeVector<float> &) const;
  template double LatticeUnknowns::dot(const LatticeVector<double> &,
                                       const LatticeVector<double> &,
                                       const LatticeField<double, 1> &) const;
  template double LatticeUnknowns::dot(const LatticeVector<float> &,
                                       const LatticeVector<float> &,
                                       const LatticeField<float, 1> &) const;
  template void LatticeUnknowns::interpolate(const LatticeVector<double> &,
                                             LatticeVector<double> &) const;
  template void LatticeUnknowns::interpolate(const LatticeVector<float> &,
                                             LatticeVector<float> &) const;
  template void LatticeUnknowns::sum_up(const LatticeVector<double> &,
                                        LatticeVector<double> &) const;
  template void LatticeUnknowns::sum_up(const LatticeVector<float> &, LatticeVector<float> &) const;
  template void LatticeUnknowns::take(const LatticeUnknowns &,
                                      const LatticeVector<double> &,
                                      LatticeVector<double> &) const;
  template void LatticeUnknowns::take(const LatticeUnknowns &,
                                      const LatticeVector<float> &,
                                      LatticeVector<float> &) const;
  template void LatticeUnknowns::untangle(const Direction &, double, LatticeVector<double> &) const;
  template void LatticeUnknowns::untangle(const Direction &, double, LatticeVector<float> &) const;
} // namespace softcell
