// SPDX-License-Identifier: LGPL-2.1-or-later
// Finite cell, weighted cell, moment fitting and sparse grid: their cells and patches.

#include <softcell/discretization/immersed.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace softcell
{
  namespace
  {
    unsigned int binary_logarithm(int size)
    {
      unsigned int result = 0;
      for (; size > 1; size /= 2)
        ++result;
      return result;
    }
  } // namespace

  Immersed::Immersed(const std::string &rule,
                     const unsigned int degree,
                     const GridParameters &grid_parameters,
                     const CutParameters &cut,
                     const Body &body,
                     MPI_Comm communicator,
                     const Refinement &refinement)
      : body_(body),
        alpha_(cut.alpha),
        ghost_penalty_(cut.ghost_penalty),
        shapes_(degree),
        rule_(make_cut_rule(rule, cut, degree, body))
  {
    const dealii::QGauss<3> gauss(degree + 1);
    gauss_points_  = gauss.get_points();
    gauss_weights_ = gauss.get_weights();

    const BackgroundGrid grid(grid_parameters, body, rule_->work(), communicator, refinement);
    lattice_                                      = grid.lattice();
    const std::vector<BackgroundGrid::Cell> taken = take_cells(grid, communicator);

    double volume = 0;
    for (const Cell &cell : cells_)
      volume += cell.cut_fraction * lattice_.box(cell.place).volume();
    volume = dealii::Utilities::MPI::sum(volume, communicator);
    if (volume < 0.5 * body.volume())
    {
      std::ostringstream text;
      text << grid_entry(grid_parameters) << " makes a grid too coarse to see the body: it sees "
           << volume << " of " << body.volume()
           << " m^3; give smaller cells, more 'Cut levels' or a lower 'Smallest "
           << "volume fraction'.";
      throw BadInput(text.str());
    }

    number_nodes(grid, taken);
    make_tables();
  }

  Immersed::~Immersed() = default;

  std::vector<BackgroundGrid::Cell> Immersed::take_cells(const BackgroundGrid &grid,
                                                         MPI_Comm communicator)
  {
    unsigned int n_cut = 0;
    std::vector<std::uint64_t> cut_cells;
    std::vector<BackgroundGrid::Cell> taken;
    for (const BackgroundGrid::Cell &grid_cell : grid.cells())
    {
      Cell cell;
      cell.place = grid_cell.place;
      if (grid_cell.side == Side::cut)
      {
        const Box box     = lattice_.box(cell.place);
        cell.cut          = n_cut++;
        cell.cut_fraction = rule_->add(box) / box.volume();
        if (cell.cut_fraction <= 0) // a node without stiffness could come of it
          continue;
        cut_cells.push_back(Lattice::key(cell.place));
      }
      cell_of_[Lattice::key(cell.place)] = cells_.size();
      cells_.push_back(cell);
      taken.push_back(grid_cell);
    }
    for (const auto &keys : dealii::Utilities::MPI::all_gather(communicator, cut_cells))
      everyones_cut_cells_.insert(keys.begin(), keys.end());
    return taken;
  }

  void Immersed::make_tables()
  {
    for (int size = 1; size <= lattice_.coarsest_size; size *= 2)
    {
      const Direction edges = size * lattice_.spacing;
      tables_.emplace_back();
      shapes_.evaluate(gauss_points_, edges, tables_.back());
      weights_.push_back(gauss_weights_);
      for (double &w : weights_.back())
        w *= edges[0] * edges[1] * edges[2];
    }

    std::vector<unsigned char> labels = {0};
    for (const Cell &cell : cells_)
    {
      if (body_.n_labels() > 1 && (cell.cut == none || alpha_ > 0)) // a rule has its own
      {
        const Box box = lattice_.box(cell.place);
        labels.clear();
        for (const Point &q : gauss_points_)
          labels.push_back(body_.label(box.unit_to_real(q)));
      }
      labels_.add(labels);
    }
  }

  Size Immersed::size() const
  {
    Size mine;
    CutPoints points;
    mine.cells          = cells_.size();
    mine.unfitted_cells = rule_->n_failures();
    for (const Cell &cell : cells_)
    {
      if (cell.cut != none)
      {
        ++mine.cut_cells;
        mine.smallest_cut = std::min(mine.smallest_cut, cell.cut_fraction);
        rule_->points(cell.cut, points);
      }
      mine.integration_points += cell.cut == none ? gauss_weights_.size() : points.weights.size();
    }

    Size all;
    all.cells              = dealii::Utilities::MPI::sum(mine.cells, communicator());
    all.cut_cells          = dealii::Utilities::MPI::sum(mine.cut_cells, communicator());
    all.integration_points = dealii::Utilities::MPI::sum(mine.integration_points, communicator());
    all.unfitted_cells     = dealii::Utilities::MPI::sum(mine.unfitted_cells, communicator());
    all.smallest_cut       = dealii::Utilities::MPI::min(mine.smallest_cut, communicator());
    all.unknowns           = partitioner_->size();
    all.cell_size = std::cbrt(lattice_.box({{{0, 0, 0}}, lattice_.coarsest_size}).volume());
    return all;
  }

  View<const unsigned int> Immersed::nodes(const unsigned int cell) const
  {
    const unsigned int first = cells_[cell].first_node;
    const unsigned int end = cell + 1 < cells_.size() ? cells_[cell + 1].first_node : nodes_.size();
    return {nodes_.data() + first, end - first};
  }

  Patch Immersed::patch(const unsigned int i, PatchStorage &storage) const
  {
    const Cell &cell         = cells_[i];
    const unsigned int table = binary_logarithm(cell.place.size);
    Patch patch;
    patch.nodes = nodes(i);
    if (cell.cut == none)
    {
      patch.weights = {weights_[table].data(), weights_[table].size()};
      patch.labels  = labels_[i];
    }
    else
    {
      CutPoints points{std::move(storage.points), std::move(storage.weights),
                       std::move(storage.labels)};
      rule_->points(cell.cut, points);
      storage.points  = std::move(points.points);
      storage.weights = std::move(points.weights);
      storage.labels  = std::move(points.labels);
      patch.weights   = {storage.weights.data(), storage.weights.size()};
      patch.labels    = {storage.labels.data(), storage.labels.size()};
    }

    const bool own_points = cell.cut == none || rule_->has_cell_points();
    if (own_points && !cell.has_hanging())
      patch.shapes = &tables_[table];
    else
    {
      evaluate(i, own_points ? gauss_points_ : storage.points, storage.shapes);
      patch.shapes = &storage.shapes;
    }
    return patch;
  }

  Patch Immersed::fictitious_patch(const unsigned int i, PatchStorage &storage) const
  {
    const Cell &cell   = cells_[i];
    const double empty = 1 - cell.cut_fraction;
    Patch patch;
    if (alpha_ == 0 || empty < 1e-9)
      return patch;
    const unsigned int table = binary_logarithm(cell.place.size);
    storage.weights          = weights_[table];
    for (double &w : storage.weights)
      w *= alpha_ * empty;
    patch.nodes   = nodes(i);
    patch.weights = {storage.weights.data(), storage.weights.size()};
    patch.labels  = labels_[i];
    patch.shapes  = &tables_[table];
    if (cell.has_hanging())
    {
      evaluate(i, gauss_points_, storage.shapes);
      patch.shapes = &storage.shapes;
    }
    return patch;
  }

  void Immersed::patch_points(const unsigned int i, std::vector<Point> &points) const
  {
    const Cell &cell = cells_[i];
    points           = gauss_points_;
    if (cell.cut != none && !rule_->has_cell_points())
    {
      CutPoints cut;
      rule_->points(cell.cut, cut);
      points = std::move(cut.points);
    }
    const Box box = lattice_.box(cell.place);
    for (Point &X : points)
      X = box.unit_to_real(X);
  }

  void Immersed::evaluate(const unsigned int i,
                          const std::vector<Point> &points,
                          ShapeTable &table) const
  {
    const Cell &cell = cells_[i];
    shapes_.evaluate(points, cell.place.size * lattice_.spacing, table);
    if (!cell.has_hanging())
      return;

    const ShapeTable own     = table;
    const unsigned int n     = nodes(i).size();
    const double *condensing = condensations_.data() + cell.hanging;
    table.resize(own.n_points, n);
    const auto condense = [&](const std::vector<double> &from, std::vector<double> &to) {
      std::fill(to.begin(), to.end(), 0.);
      for (unsigned int row = 0; row < from.size() / own.n_nodes; ++row)
        for (unsigned int k = 0; k < own.n_nodes; ++k)
          for (unsigned int m = 0; m < n; ++m)
            to[row * n + m] += from[row * own.n_nodes + k] * condensing[k * n + m];
    };
    condense(own.values, table.values);
    condense(own.gradients, table.gradients);
  }

  unsigned int Immersed::owned_cell(const Lattice::Cell &place) const
  {
    const auto cell = cell_of_.find(Lattice::key(place));
    return cell == cell_of_.end() ? none : cell->second;
  }

  double Immersed::distance(const Point &X, const Lattice::Cell &cell) const
  {
    const Box box = lattice_.box(cell);
    Direction outside;
    for (unsigned int d = 0; d < dim; ++d)
      outside[d] = std::max({box.lower_bound(d) - X[d], X[d] - box.upper_bound(d), 0.});
    return outside.norm();
  }

  std::optional<PointShapes> Immersed::shapes_at(const Point &X, const double reach) const
  {
    const double round_off =
      1e-9 * std::min({lattice_.spacing[0], lattice_.spacing[1], lattice_.spacing[2]});
    unsigned int nearest = none;
    Claim claim{std::max(reach, round_off), std::numeric_limits<double>::lowest()};
    const auto try_cell = [&](const unsigned int cell) {
      const double d = distance(X, cells_[cell].place);
      const Claim other{d > round_off ? d : 0.,
                        precedence_of(lattice_.box(cells_[cell].place).center())};
      if (other.counts_before(claim, round_off))
      {
        nearest = cell;
        claim   = other;
      }
    };
    const auto box_around = [&X](const double r) {
      return Box({X - Direction({r, r, r}), X + Direction({r, r, r})});
    };
    const auto try_cells_around = [&](const double r) {
      lattice_.for_each_leaf(box_around(r), [&](const Lattice::Cell &place) {
        if (const unsigned int cell = owned_cell(place); cell != none)
          try_cell(cell);
      });
    };
    try_cells_around(round_off);
    if (nearest == none && reach > round_off)
    {
      // the cells within reach, or all of this rank, whichever are fewer
      const Box around = box_around(reach);
      double n_around  = 1;
      for (unsigned int d = 0; d < dim; ++d)
        n_around *= around.side_length(d) / (lattice_.coarsest_size * lattice_.spacing[d]) + 1;
      if (n_around < cells_.size())
        try_cells_around(reach);
      else
        for (unsigned int cell = 0; cell < cells_.size(); ++cell)
          try_cell(cell);
    }
    if (nearest == none)
      return {};

    ShapeTable table;
    evaluate(nearest, {lattice_.box(cells_[nearest].place).real_to_unit(X)}, table);
    PointShapes result;
    const auto n = nodes(nearest);
    result.nodes.assign(n.begin(), n.end());
    result.values    = std::move(table.values);
    result.gradients = std::move(table.gradients);
    result.claim     = claim;
    return result;
  }

  std::optional<UniformGrid> Immersed::uniform_grid() const
  {
    const int size = cells_.empty() ? 0 : cells_[0].place.size;
    if (size == 0 || degree() != 1 || dealii::Utilities::MPI::n_mpi_processes(communicator()) > 1)
      return {};
    UniformGrid grid{size * lattice_.spacing, {}};
    for (const Cell &cell : cells_)
    {
      if (cell.place.size != size)
        return {};
      const auto &[i, j, k] = cell.place.lower;
      grid.places.push_back({{i / size, j / size, k / size}});
    }
    return grid;
  }

  Box Immersed::owned_box() const
  {
    if (cells_.empty())
      return Box({lattice_.origin, lattice_.origin});
    Box box = lattice_.box(cells_[0].place);
    for (const Cell &cell : cells_)
      box.merge_with(lattice_.box(cell.place));
    return box;
  }
} // namespace softcell
