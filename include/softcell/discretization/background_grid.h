// SPDX-License-Identifier: LGPL-2.1-or-later
// The octree of hexahedra around a body.
#pragma once

#include <softcell/base/types.h>
#include <softcell/geometry/body.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_set>
#include <vector>

namespace dealii::parallel::distributed
{
  template <int, int>
  class Triangulation;
}

namespace softcell
{
  /// What the section Discretization says of the grid.
  struct GridParameters
  {
    std::vector<unsigned int> cells = {8}; // across the shortest side, or along each axis
    double cell_size                = 0;   // if positive, in place of `cells`. Units: m
    double scale                    = 1;   // of the grid's box, relative to the body's bounding box
    double padding                  = 0;   // added to the box on all sides. Units: m
    unsigned int surface_refinement = 0;   // more octree levels towards the surface
    double smallest_volume_fraction = 0;   // cells that are less filled are dropped

    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// The entries that make the cells as large as they are, for messages.
  std::string grid_entry(const GridParameters &parameters);

  /// Unrefined cells of the grid around a body along each axis, and their edges h (m). The numbers
  /// are whole, and may be more than there is memory for.
  /// @throws BadInput
  std::array<double, 3> grid_cells(const GridParameters &parameters, const Box &body, Direction &h);

  /// Points whose cells are halved, round after round, beyond what the parameters ask for. The same
  /// on all ranks.
  using Refinement = std::vector<std::vector<Point>>;

  /// The cells of an octree on all ranks, counted along the axes in finest cells from a corner of
  /// the grid's box.
  struct Lattice
  {
    using Index = std::array<int, 3>;

    /// A cell of the octree: its lower corner and its edges' length, a power of two, in finest
    /// cells.
    struct Cell
    {
      Index lower;
      int size;
    };

    Point origin;
    Direction spacing;                        // edges of a finest cell. Units: m
    int coarsest_size = 1;                    // edge length of the largest cells in finest cells
    std::unordered_set<std::uint64_t> halved; // key() of the cells that have parts

    Box box(const Cell &cell) const;

    /// The finest cell that holds X; beyond the grid it is counted on.
    Index index(const Point &X) const;

    /// The cell of edge length `size` that holds a finest cell.
    static Cell ancestor(const Index &index, int size);

    /// The cell without parts that holds a finest cell.
    Cell leaf(const Index &index) const;

    /// Calls f(Cell) for every cell without parts that holds some of the box.
    template <class F>
    void for_each_leaf(const Box &box, const F &f) const
    {
      const Index first = index(box.get_boundary_points().first);
      const Index last  = index(box.get_boundary_points().second);
      const Index begin = ancestor(first, coarsest_size).lower;
      for (int k = begin[2]; k <= last[2]; k += coarsest_size)
        for (int j = begin[1]; j <= last[1]; j += coarsest_size)
          for (int i = begin[0]; i <= last[0]; i += coarsest_size)
            visit_leaves({{{i, j, k}}, coarsest_size}, first, last, f);
    }

    /// A number for each cell.
    static std::uint64_t key(const Cell &cell);

  private:
    template <class F>
    void visit_leaves(const Cell &cell, const Index &first, const Index &last, const F &f) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (cell.lower[d] > last[d] || cell.lower[d] + cell.size <= first[d])
          return;
      if (halved.count(key(cell)) == 0)
      {
        f(cell);
        return;
      }
      const int size        = cell.size / 2;
      const auto &[x, y, z] = cell.lower;
      for (const int k : {z, z + size})
        for (const int j : {y, y + size})
          for (const int i : {x, x + size})
            visit_leaves({{{i, j, k}}, size}, first, last, f);
    }
  };

  /// A p4est octree of hexahedra around a body, and which of its cells the body touches.
  ///
  /// The box around the body gets cubic cells, `cells` of them across its shortest side; along the
  /// others it is enlarged on both sides to a whole number of cells. The octree may reach beyond
  /// the box, so that it has few roots. Towards the surface cells are halved `surface_refinement`
  /// times, and so are all that lie half a cell from it, so that cut cells have no hanging nodes;
  /// then where a Refinement asks for it. A cell is at most twice as large as its neighbours. Each
  /// rank owns about the same work.
  class BackgroundGrid
  {
  public:
    using Triangulation = dealii::parallel::distributed::Triangulation<3, 3>;

    /// A cell of this rank that the body fills or cuts.
    struct Cell
    {
      Lattice::Cell place;
      Side side;
      int level, index; // in the triangulation
    };

    /// @param cut_work  work of a cut cell relative to that of a full one.
    /// @throws BadInput if no cell holds some of the body, or there are too many to count.
    BackgroundGrid(const GridParameters &parameters,
                   const Body &body,
                   double cut_work,
                   MPI_Comm communicator,
                   const Refinement &refinement = {});
    ~BackgroundGrid();

    const Triangulation &triangulation() const
    {
      return *triangulation_;
    }
    const Lattice &lattice() const
    {
      return lattice_;
    }
    const std::vector<Cell> &cells() const
    {
      return cells_;
    }
    /// Place of any cell of the triangulation by its lower corner and level.
    Lattice::Cell place(const Point &lower_corner, int level) const;

  private:
    /// Lays the lattice around the body and returns the number of unrefined cells along each axis.
    std::array<unsigned int, 3> lay_lattice(const GridParameters &parameters, const Box &body);
    void make_octree(const std::array<unsigned int, 3> &cells);
    void refine_towards_surface(const Body &body, unsigned int n_times);
    void refine_at(const std::vector<Point> &points);
    /// Tells all ranks which cells have parts.
    void note_halved();
    void balance(const GridParameters &parameters, const Body &body, double cut_work);
    Side side(const Lattice::Cell &cell, const GridParameters &parameters, const Body &body) const;

    std::unique_ptr<Triangulation> triangulation_;
    Lattice lattice_;
    int coarsest_level_; // of the triangulation
    std::vector<Cell> cells_;
  };
} // namespace softcell
