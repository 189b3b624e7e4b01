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

  /// Unrefined cells of the grid around a body along each axis, and their edges h (m). The numbers
  /// are whole, and may be more than there is memory for.
  /// @throws BadInput
  std::array<double, 3> grid_cells(const GridParameters &parameters, const Box &body, Direction &h);

  /// The finest cells of an octree grid, counted along the axes from a corner of its box.
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
    Direction spacing; // edges of a finest cell. Units: m

    Box box(const Cell &cell) const;

    /// The finest cell that holds X; beyond the grid it is counted on.
    Index index(const Point &X) const;

    /// The cell of edge length `size` that holds a finest cell.
    static Cell ancestor(const Index &index, int size);

    /// Calls f(Index) for every finest cell that holds some of the box.
    template <class F>
    void for_each_index(const Box &box, const F &f) const
    {
      const Index first = index(box.get_boundary_points().first);
      const Index last  = index(box.get_boundary_points().second);
      for (int k = first[2]; k <= last[2]; ++k)
        for (int j = first[1]; j <= last[1]; ++j)
          for (int i = first[0]; i <= last[0]; ++i)
            f(Index{{i, j, k}});
    }

    /// A number for each cell.
    static std::uint64_t key(const Cell &cell);
  };

  /// A p4est octree of hexahedra around a body, and which of its cells the body touches.
  ///
  /// The box around the body gets cubic cells, `cells` of them across its shortest side; along the
  /// others it is enlarged on both sides to a whole number of cells. The octree may reach beyond
  /// the box, so that it has few roots. Towards the surface cells are halved `surface_refinement`
  /// times, and so are all that lie half a cell from it, so that cut cells have no hanging nodes.
  /// Each rank owns about the same work.
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
                   MPI_Comm communicator);
    ~BackgroundGrid();

    const Triangulation &triangulation() const
    {
      return *triangulation_;
    }
    const Lattice &lattice() const
    {
      return lattice_;
    }
    /// Edge length of the largest cells in finest cells.
    int coarsest_size() const
    {
      return coarsest_size_;
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
    void refine_towards_surface(const Body &body);
    void balance(const GridParameters &parameters, const Body &body, double cut_work);
    Side side(const Lattice::Cell &cell, const GridParameters &parameters, const Body &body) const;

    std::unique_ptr<Triangulation> triangulation_;
    Lattice lattice_;
    int coarsest_size_;
    int coarsest_level_; // of the triangulation
    std::vector<Cell> cells_;
  };
} // namespace softcell
