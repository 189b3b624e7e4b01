// SPDX-License-Identifier: LGPL-2.1-or-later
// Congruent trilinear cells of a background grid in their compact form.

#include <softcell/operators/uniform_cells.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/quadrature_lib.h>

#include <cmath>
#include <experimental/simd>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

namespace softcell
{
  namespace
  {
    const char *const multigrid =
      "What runs without a matrix (Mode = dynamic, Preconditioner = geometric multigrid) ";

    const UniformGrid &check(const std::optional<UniformGrid> &grid,
                             const Discretization &discretization)
    {
      if (!grid)
        throw BadInput(std::string(multigrid) +
                       "needs a background grid without refinement, of degree 1, on one "
                       "rank; give 'Degree = 1', 'Surface refinement = 0', and start the "
                       "program without mpirun.");
      PatchStorage storage;
      for (unsigned int i = 0; i < discretization.n_patches(); ++i)
        if (discretization.fictitious_patch(i, storage).n_points() > 0)
          throw BadInput(std::string(multigrid) +
                         "knows no fictitious material; give 'Discretization/Alpha = 0'.");
      if (discretization.ghost_faces().size() > 0)
        throw BadInput(std::string(multigrid) +
                       "knows no ghost penalty; give 'Discretization/Ghost penalty = 0'.");
      return *grid;
    }

    const std::vector<Point> &gauss_points()
    {
      static const std::vector<Point> points = dealii::QGauss<3>(2).get_points();
      return points;
    }

    /// Those are the cell's Gauss points.
    bool are_gauss_points(const std::vector<Point> &points)
    {
      const std::vector<Point> &gauss = gauss_points();
      return std::equal(points.begin(), points.end(), gauss.begin(), gauss.end(),
                        [](const Point &a, const Point &b) { return a.distance(b) < 1e-9; });
    }

    /// Lower corners of cells in a common order: along x first.
    bool is_before(const std::array<int, 3> &a, const std::array<int, 3> &b)
    {
      return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
    }

    template <class Real>
    constexpr unsigned int pack_width = std::experimental::native_simd<Real>::size();

    /// Cells of one row, in half as many places as a pack has.
    using Half = std::vector<const GaussCell *>;

    std::vector<Half> halves_of_packs(const std::vector<GaussCell> &cells, const int width)
    {
      std::vector<const GaussCell *> sorted;
      for (const GaussCell &cell : cells)
        sorted.push_back(&cell);
      std::sort(sorted.begin(), sorted.end(), [](const GaussCell *a, const GaussCell *b) {
        return is_before(a->place, b->place);
      });
      std::vector<Half> halves;
      for (const GaussCell *cell : sorted)
      {
        const auto &[i, j, k] = cell->place;
        const bool is_apart   = halves.empty() || i >= halves.back()[0]->place[0] + width ||
                              j != halves.back()[0]->place[1] || k != halves.back()[0]->place[2];
        if (is_apart)
          halves.emplace_back();
        halves.back().push_back(cell);
      }
      return halves;
    }

    /// Halves that follow each other share a pack, and so does what is left of a layer, mostly not
    /// of adjacent rows: one would have to wait for what the other has just stored.
    std::vector<std::pair<Half, Half>> paired(const std::vector<Half> &halves, const int width)
    {
      std::vector<std::pair<Half, Half>> pairs;
      std::vector<Half> waiting;
      for (std::size_t h = 0; h < halves.size(); ++h)
      {
        const std::array<int, 3> first = halves[h][0]->place,
                                 next{{first[0] + width, first[1], first[2]}};
        if (h + 1 < halves.size() && halves[h + 1][0]->place == next)
        {
          pairs.emplace_back(halves[h], halves[h + 1]);
          ++h;
        }
        else
          waiting.push_back(halves[h]);
        if (waiting.size() == 3)
        {
          pairs.emplace_back(waiting[0], waiting[2]);
          waiting = {waiting[1]};
        }
        const bool ends_layer = h + 1 == halves.size() || halves[h + 1][0]->place[2] != first[2];
        if (ends_layer && !waiting.empty())
        {
          pairs.emplace_back(waiting[0], waiting.size() > 1 ? waiting[1] : Half());
          waiting.clear();
        }
      }
      return pairs;
    }

    /// Runs of one plane less than a pack apart become one: each costs a call.
    void join_runs(std::vector<std::pair<std::size_t, std::size_t>> &runs, const std::size_t n_rows)
    {
      for (std::size_t row = 1, first = 0; row < runs.size(); ++row)
      {
        const bool joins = row % n_rows != 0 && runs[first].first < runs[first].second &&
                           runs[row].first < runs[first].second + NodeLattice::max_width;
        if (joins)
        {
          runs[first].second = runs[row].second;
          runs[row]          = {0, 0};
        }
        else
          first = row;
      }
    }
  } // namespace

  CellLattice cell_lattice(const Discretization &discretization)
  {
    const std::optional<UniformGrid> uniform = discretization.uniform_grid();
    const UniformGrid &grid                  = check(uniform, discretization);

    std::array<int, 3> lower = grid.places.at(0), upper = lower;
    for (const auto &place : grid.places)
      for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = std::min(lower[d], place[d]);
        upper[d] = std::max(upper[d], place[d] + 1);
      }

    const std::array<int, 3> n_cells{
      {upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]}};
    CellLattice cells{NodeLattice(n_cells),
                      grid.spacing,
                      {},
                      {},
                      std::vector<std::size_t>(discretization.node_positions().size())};
    PatchStorage storage;
    std::vector<Point> points;
    std::optional<unsigned int> label;
    for (unsigned int i = 0; i < grid.places.size(); ++i)
    {
      std::array<int, 3> place = grid.places[i];
      for (unsigned int d = 0; d < dim; ++d)
        place[d] -= lower[d];
      const Patch patch = discretization.patch(i, storage);
      for (unsigned int v = 0; v < 8; ++v)
        cells.entries[patch.nodes[v]] =
          cells.nodes.entry(place[0] + v % 2, place[1] + v / 2 % 2, place[2] + v / 4);
      for (unsigned int q = 0; q < patch.n_points(); ++q)
        if (patch.weights[q] != 0 && patch.label(q) != label.value_or(patch.label(q)))
          throw BadInput(std::string(multigrid) +
                         "needs a body of one material; section Geometry gives it several "
                         "labels.");
        else
          label = patch.label(q);

      discretization.patch_points(i, points);
      const Point &origin = discretization.node_positions()[patch.nodes[0]];
      for (Point &X : points)
        for (unsigned int d = 0; d < dim; ++d)
          X[d] = (X[d] - origin[d]) / grid.spacing[d];
      if (are_gauss_points(points))
      {
        cells.gauss_cells.push_back({place, {}});
        std::copy(patch.weights.begin(), patch.weights.end(),
                  cells.gauss_cells.back().weights.begin());
      }
      else
        cells.point_cells.push_back({place, {patch.weights.begin(), patch.weights.end()}, points});
    }
    return cells;
  }

  template <class Real>
  LatticeField<Real, 1> lumped(const double density, const CellLattice &cells)
  {
    LatticeField<Real, 1> field(cells.nodes);
    const auto add = [&](const auto &cell, const std::vector<Point> &points) {
      for (int v = 0; v < 8; ++v)
      {
        double sum = 0;
        for (std::size_t q = 0; q < points.size(); ++q)
        {
          double share = cell.weights[q];
          for (unsigned int d = 0; d < dim; ++d)
            share *= (v >> d & 1) != 0 ? points[q][d] : 1 - points[q][d];
          sum += share;
        }
        field.component(0)[cells.nodes.entry(cell.place[0] + v % 2, cell.place[1] + v / 2 % 2,
                                             cell.place[2] + v / 4)] += Real(density * sum);
      }
    };
    for (const GaussCell &cell : cells.gauss_cells)
      add(cell, gauss_points());
    for (const PointCell &cell : cells.point_cells)
      add(cell, cell.points);
    return field;
  }

  template <class Real>
  void copy(const Vector &from, const std::vector<std::size_t> &entries, LatticeVector<Real> &to)
  {
    for (unsigned int c = 0; c < dim; ++c)
      for (std::size_t node = 0; node < entries.size(); ++node)
        to.component(c)[entries[node]] = from.local_element(3 * node + c);
  }

  template <class Real>
  void copy(const LatticeVector<Real> &from, const std::vector<std::size_t> &entries, Vector &to)
  {
    for (unsigned int c = 0; c < dim; ++c)
      for (std::size_t node = 0; node < entries.size(); ++node)
        to.local_element(3 * node + c) = from.component(c)[entries[node]];
  }

  template <class Real>
  UniformCells<Real>::UniformCells(const CellLattice &cells) : nodes_(cells.nodes)
  {
    for (unsigned int d = 0; d < dim; ++d)
      spacing_[d] = cells.spacing[d];
    runs_.assign((nodes_.n_cells()[1] + 1) * (nodes_.n_cells()[2] + 1), {nodes_.size(), 0});
    for (const GaussCell &cell : cells.gauss_cells)
      add_to_runs(cell.place);
    for (const PointCell &cell : cells.point_cells)
      add_to_runs(cell.place);
    join_runs(runs_, nodes_.n_cells()[1] + 1);
    add_row_packs(cells.gauss_cells, cells.spacing[0] * cells.spacing[1] * cells.spacing[2] / 8);
    add_point_packs(cells.point_cells);
  }

  template <class Real>
  void UniformCells<Real>::add_to_runs(const std::array<int, 3> &place)
  {
    const auto [i, j, k] = place;
    for (const int dk : {0, 1})
      for (const int dj : {0, 1})
      {
        auto &[begin, end]      = runs_[(k + dk) * (nodes_.n_cells()[1] + 1) + j + dj];
        const std::size_t entry = nodes_.entry(i, j + dj, k + dk);
        begin                   = std::min(begin, entry);
        end                     = std::max(end, entry + 2);
      }
  }

  template <class Real>
  void UniformCells<Real>::add_row_packs(const std::vector<GaussCell> &cells, const double full)
  {
    constexpr unsigned int W = pack_width<Real>;
    const auto entry         = [&](const GaussCell *cell) {
      return nodes_.entry(cell->place[0], cell->place[1], cell->place[2]);
    };
    const auto is_full = [&](const GaussCell *cell) {
      return std::all_of(cell->weights.begin(), cell->weights.end(),
                         [&](const double w) { return std::abs(w - full) < 1e-12 * full; });
    };
    std::vector<std::size_t> starts; // of the packs' weights
    weights_.resize(8 * W, full);    // which full packs share
    row_layers_.assign(nodes_.n_cells()[2] + 1, 0);
    for (const auto &[lower, upper] : paired(halves_of_packs(cells, W / 2), W / 2))
    {
      const std::size_t first = entry(lower[0]), next = first + W / 2,
                        other = upper.empty() ? next : entry(upper[0]);
      row_packs_.push_back({first, other, other == next, n_points_, nullptr, nullptr});
      n_points_ += 8;
      ++row_layers_[lower[0]->place[2] + 1];
      const bool all_full = other == next && lower.size() + upper.size() == W &&
                            std::all_of(lower.begin(), lower.end(), is_full) &&
                            std::all_of(upper.begin(), upper.end(), is_full);
      starts.push_back(all_full ? 0 : weights_.size());
      if (all_full)
        continue;
      weights_.resize(weights_.size() + 8 * W);
      for (const Half *half : {&lower, &upper})
        for (const GaussCell *cell : *half)
        {
          const std::size_t lane =
            entry(cell) - entry(half->front()) + (half == &lower ? 0 : W / 2);
          for (unsigned int q = 0; q < 8; ++q)
            weights_[starts.back() + q * W + lane] = cell->weights[q];
        }
    }
    for (std::size_t p = 0; p < starts.size(); ++p)
    {
      row_packs_[p].weights = &weights_[starts[p]];
      row_packs_[p].ahead   = &row_packs_[std::min(p + 2, starts.size() - 1)];
    }
    std::partial_sum(row_layers_.begin(), row_layers_.end(), row_layers_.begin());
  }

  template <class Real>
  void UniformCells<Real>::add_point_packs(const std::vector<PointCell> &cells)
  {
    constexpr unsigned int W = pack_width<Real>;
    std::vector<const PointCell *> sorted;
    for (const PointCell &cell : cells)
      sorted.push_back(&cell);
    // cells with equally many points share packs
    std::sort(sorted.begin(), sorted.end(), [](const PointCell *a, const PointCell *b) {
      return std::make_tuple(a->place[2], a->weights.size(), a->place[1], a->place[0]) <
             std::make_tuple(b->place[2], b->weights.size(), b->place[1], b->place[0]);
    });

    std::vector<std::size_t> starts; // of the packs' points
    point_layers_.assign(nodes_.n_cells()[2] + 1, 0);
    for (std::size_t c = 0, n; c < sorted.size(); c += n)
    {
      const int k = sorted[c]->place[2];
      for (n = 1; n < W && c + n < sorted.size() && sorted[c + n]->place[2] == k; ++n)
        ;
      const unsigned int n_points = sorted[c + n - 1]->weights.size();
      point_packs_.push_back({nullptr, n_points_, n_points, nullptr});
      n_points_ += n_points;
      ++point_layers_[k + 1];
      starts.push_back(points_.size());
      points_.resize(points_.size() + n_points * 4 * W);
      for (unsigned int lane = 0; lane < W; ++lane)
      {
        const PointCell &cell = *sorted[c + std::min<std::size_t>(lane, n - 1)];
        entries_.push_back(nodes_.entry(cell.place[0], cell.place[1], k));
        for (unsigned int q = 0; q < cell.weights.size() && lane < n; ++q)
        {
          Real *const point = &points_[starts.back() + q * 4 * W + lane];
          for (unsigned int d = 0; d < dim; ++d)
            point[d * W] = 2 * cell.points[q][d] - 1;
          point[3 * W] = cell.weights[q];
        }
      }
    }
    for (std::size_t p = 0; p < starts.size(); ++p)
    {
      point_packs_[p].entries = &entries_[p * W];
      point_packs_[p].points  = &points_[starts[p]];
    }
    std::partial_sum(point_layers_.begin(), point_layers_.end(), point_layers_.begin());
  }

  template <class Real>
  std::size_t UniformCells<Real>::memory() const
  {
    return (weights_.size() + points_.size()) * sizeof(Real) + runs_.size() * sizeof(runs_[0]) +
           row_packs_.size() * sizeof(RowPack) + point_packs_.size() * sizeof(PointPack) +
           entries_.size() * sizeof(std::size_t);
  }

  template class UniformCells<double>;
  template class UniformCells<float>;
  template LatticeField<double, 1> lumped(double, const CellLattice &);
  template LatticeField<float, 1> lumped(double, const CellLattice &);
  template void copy(const Vector &, const std::vector<std::size_t> &, LatticeVector<double> &);
  template void copy(const Vector &, const std::vector<std::size_t> &, LatticeVector<float> &);
  template void copy(const LatticeVector<double> &, const std::vector<std::size_t> &, Vector &);
  template void copy(const LatticeVector<float> &, const std::vector<std::size_t> &, Vector &);
} // namespace softcell
