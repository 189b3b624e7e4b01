// SPDX-License-Identifier: LGPL-2.1-or-later
// The octree of hexahedra around a body.

#include <softcell/discretization/background_grid.h>

#include <softcell/base/exceptions.h>
#include <softcell/quadrature/octree.h>

#include <deal.II/distributed/tria.h>

#include <deal.II/grid/grid_generator.h>

#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    /// 20 bits an axis number the finest cells.
    void check_countable(const std::array<double, 3> &cells,
                         const GridParameters &parameters,
                         const int coarsest_size)
    {
      const double n = cells[0] * cells[1] * cells[2];
      if (n < std::pow(2., 31) &&
          std::max({cells[0], cells[1], cells[2]}) * coarsest_size < std::pow(2., 20))
        return;
      std::ostringstream text;
      text << grid_entry(parameters) << " makes a grid of " << cells[0] << " x " << cells[1]
           << " x " << cells[2] << " cells, which are too many to count; give fewer cells.";
      throw BadInput(text.str());
    }
  } // namespace

  void GridParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.add_parameter("Cells", cells,
                      "Cells of the background grid across the body's bounding box: one number for "
                      "the shortest side, with cubic cells, or three along x, y and z.",
                      List(Integer(1), 1, 3));
    prm.add_parameter("Cell size", cell_size,
                      "Edge length of the background grid's cells, then cubic; if positive, it "
                      "takes the place of Cells. Units: m",
                      Double(0));
    prm.add_parameter(
      "Grid scale", scale,
      "Size of the grid's box relative to the body's bounding box, about its centre; "
      "a little above 1 moves the cells to cut the body elsewhere. Units: 1",
      Double(1));
    prm.add_parameter("Padding", padding, "Added to the grid's box on all sides. Units: m",
                      Double(0));
    prm.add_parameter("Surface refinement", surface_refinement,
                      "How often the cells near the body's surface are halved.", Integer(0, 4));
    prm.add_parameter("Smallest volume fraction", smallest_volume_fraction,
                      "Cells of which the body fills less than this are dropped; 0 keeps all. "
                      "Units: 1",
                      Double(0, 1));
  }

  Box Lattice::box(const Cell &cell) const
  {
    Point lower, upper;
    for (unsigned int d = 0; d < dim; ++d)
    {
      lower[d] = origin[d] + cell.lower[d] * spacing[d];
      upper[d] = origin[d] + (cell.lower[d] + cell.size) * spacing[d];
    }
    return Box({lower, upper});
  }

  Lattice::Index Lattice::index(const Point &X) const
  {
    Index index;
    for (unsigned int d = 0; d < dim; ++d)
      index[d] = static_cast<int>(std::floor((X[d] - origin[d]) / spacing[d]));
    return index;
  }

  Lattice::Cell Lattice::ancestor(const Index &index, const int size)
  {
    Cell cell{index, size};
    for (int &i : cell.lower)
      i &= ~(size - 1); // rounds down, also below zero
    return cell;
  }

  Lattice::Cell Lattice::leaf(const Index &index) const
  {
    Cell cell = ancestor(index, coarsest_size);
    while (halved.count(key(cell)) > 0)
      cell = ancestor(index, cell.size / 2);
    return cell;
  }

  std::uint64_t Lattice::key(const Cell &cell)
  {
    std::uint64_t key = 0;
    for (int size = cell.size; size > 1; size /= 2)
      ++key;
    for (const int i : cell.lower)
      key = key << 20 | (static_cast<std::uint64_t>(i) & 0xfffff);
    return key;
  }

  std::string grid_entry(const GridParameters &parameters)
  {
    std::ostringstream text;
    if (parameters.cell_size > 0)
      text << "Discretization/Cell size = " << parameters.cell_size << " m";
    else
      for (unsigned int d = 0; d < parameters.cells.size(); ++d)
        text << (d == 0 ? "Discretization/Cells = " : ", ") << parameters.cells[d];
    if (parameters.scale != 1)
      text << " with Grid scale = " << parameters.scale;
    return text.str();
  }

  BackgroundGrid::BackgroundGrid(const GridParameters &parameters,
                                 const Body &body,
                                 const double cut_work,
                                 MPI_Comm communicator,
                                 const Refinement &refinement)
      : triangulation_(std::make_unique<Triangulation>(communicator))
  {
    lattice_.coarsest_size = 1 << (parameters.surface_refinement + refinement.size());
    make_octree(lay_lattice(parameters, body.bounding_box()));
    refine_towards_surface(body, parameters.surface_refinement);
    for (const std::vector<Point> &points : refinement)
      refine_at(points);
    note_halved();
    if (dealii::Utilities::MPI::n_mpi_processes(communicator) > 1)
      balance(parameters, body, cut_work);

    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const Lattice::Cell where = place(cell->vertex(0), cell->level());
        const Side how            = side(where, parameters, body);
        if (how != Side::outside)
          cells_.push_back({where, how, cell->level(), cell->index()});
      }
    if (dealii::Utilities::MPI::sum(cells_.size(), communicator) == 0)
      throw BadInput(grid_entry(parameters) +
                     " makes a grid too coarse to see the body; give "
                     "smaller cells or a lower 'Smallest volume fraction'.");
  }

  BackgroundGrid::~BackgroundGrid() = default;

  std::array<double, 3> grid_cells(const GridParameters &parameters, const Box &body, Direction &h)
  {
    const auto &[lower, upper] = body.get_boundary_points();
    Direction size             = parameters.scale * (upper - lower);
    for (unsigned int d = 0; d < dim; ++d)
      size[d] += 2 * parameters.padding;

    std::array<double, 3> n;
    if (parameters.cells.size() == 3 && parameters.cell_size <= 0)
      for (unsigned int d = 0; d < dim; ++d)
      {
        n[d] = parameters.cells[d];
        h[d] = size[d] / n[d];
      }
    else if (parameters.cells.size() == 1 || parameters.cell_size > 0)
      for (unsigned int d = 0; d < dim; ++d)
      {
        h[d] = parameters.cell_size > 0
                 ? parameters.cell_size
                 : std::min({size[0], size[1], size[2]}) / parameters.cells[0];
        n[d] = std::max(1., std::ceil(size[d] / h[d] - 1e-6));
      }
    else
      throw BadInput(grid_entry(parameters) + " has two numbers; give one for the shortest side or "
                                              "three along x, y and z.");
    return n;
  }

  std::array<unsigned int, 3> BackgroundGrid::lay_lattice(const GridParameters &parameters,
                                                          const Box &body)
  {
    const std::array<double, 3> n = grid_cells(parameters, body, lattice_.spacing);
    check_countable(n, parameters, lattice_.coarsest_size);

    const Point centre = body.center();
    for (unsigned int d = 0; d < dim; ++d)
      lattice_.origin[d] = centre[d] - n[d] / 2 * lattice_.spacing[d];
    lattice_.spacing /= lattice_.coarsest_size;
    return {{static_cast<unsigned int>(n[0]), static_cast<unsigned int>(n[1]),
             static_cast<unsigned int>(n[2])}};
  }

  void BackgroundGrid::make_octree(const std::array<unsigned int, 3> &cells)
  {
    // as few roots as can be had for a quarter more cells, all of them outside the body
    std::vector<unsigned int> roots(cells.begin(), cells.end());
    const double enough = 1.25 * cells[0] * cells[1] * cells[2];
    coarsest_level_     = 0;
    for (int level = 1; level < 16; ++level)
    {
      std::vector<unsigned int> coarser;
      double n = 1;
      for (const unsigned int c : cells)
      {
        coarser.push_back((c + (1u << level) - 1) >> level);
        n *= double(coarser.back()) * (1u << level);
      }
      if (n > enough)
        break;
      roots           = coarser;
      coarsest_level_ = level;
    }

    Point upper = lattice_.origin;
    for (unsigned int d = 0; d < dim; ++d)
      upper[d] +=
        (double(roots[d]) * (1u << coarsest_level_)) * lattice_.coarsest_size * lattice_.spacing[d];
    dealii::GridGenerator::subdivided_hyper_rectangle(*triangulation_, roots, lattice_.origin,
                                                      upper);
    triangulation_->refine_global(coarsest_level_);
  }

  Lattice::Cell BackgroundGrid::place(const Point &lower_corner, const int level) const
  {
    Lattice::Cell cell;
    cell.size = lattice_.coarsest_size >> (level - coarsest_level_);
    for (unsigned int d = 0; d < dim; ++d)
      cell.lower[d] =
        static_cast<int>(std::lround((lower_corner[d] - lattice_.origin[d]) / lattice_.spacing[d]));
    return cell;
  }

  void BackgroundGrid::refine_towards_surface(const Body &body, const unsigned int n_times)
  {
    for (unsigned int time = 0; time < n_times; ++time)
    {
      const int size = lattice_.coarsest_size >> time;
      for (const auto &cell : triangulation_->active_cell_iterators())
        if (cell->is_locally_owned())
        {
          const Lattice::Cell where = place(cell->vertex(0), cell->level());
          if (where.size != size)
            continue;
          // half a cell around: then no cut cell of the next level touches this one
          Box box = lattice_.box(where);
          box.extend(0.5 * size *
                     std::max({lattice_.spacing[0], lattice_.spacing[1], lattice_.spacing[2]}));
          if (side_of(body, box) == Side::cut)
            cell->set_refine_flag();
        }
      triangulation_->execute_coarsening_and_refinement();
    }
  }

  void BackgroundGrid::refine_at(const std::vector<Point> &points)
  {
    std::unordered_set<std::uint64_t> around; // cells of all sizes that hold one of the points
    for (const Point &X : points)
      for (int size = lattice_.coarsest_size; size > 1; size /= 2)
        around.insert(Lattice::key(Lattice::ancestor(lattice_.index(X), size)));
    for (const auto &cell : triangulation_->active_cell_iterators())
      if (cell->is_locally_owned() &&
          around.count(Lattice::key(place(cell->vertex(0), cell->level()))) > 0)
        cell->set_refine_flag();
    triangulation_->execute_coarsening_and_refinement();
  }

  void BackgroundGrid::note_halved()
  {
    std::unordered_set<std::uint64_t> here;
    for (const auto &leaf : triangulation_->active_cell_iterators())
      if (leaf->is_locally_owned())
        for (Triangulation::cell_iterator cell = leaf; cell->level() > coarsest_level_;)
        {
          cell = cell->parent();
          if (!here.insert(Lattice::key(place(cell->vertex(0), cell->level()))).second)
            break; // as are those above
        }
    const std::vector<std::uint64_t> keys(here.begin(), here.end());
    for (const auto &some :
         dealii::Utilities::MPI::all_gather(triangulation_->get_communicator(), keys))
      lattice_.halved.insert(some.begin(), some.end());
  }

  Side BackgroundGrid::side(const Lattice::Cell &cell,
                            const GridParameters &parameters,
                            const Body &body) const
  {
    const Box box   = lattice_.box(cell);
    const Side side = side_of(body, box);
    if (side == Side::cut && parameters.smallest_volume_fraction > 0 &&
        body.filled_volume(box) < parameters.smallest_volume_fraction * box.volume())
      return Side::outside;
    return side;
  }

  void
  BackgroundGrid::balance(const GridParameters &parameters, const Body &body, const double cut_work)
  {
    const auto weight = [&](const Triangulation::cell_iterator &cell,
                            const Triangulation::CellStatus) -> unsigned int {
      switch (side(place(cell->vertex(0), cell->level()), parameters, body))
      {
        case Side::inside:
          return 100;
        case Side::cut:
          return static_cast<unsigned int>(100 * cut_work);
        default:
          return 1;
      }
    };
    const auto connection = triangulation_->signals.weight.connect(weight);
    triangulation_->repartition();
    connection.disconnect();
  }
} // namespace softcell
