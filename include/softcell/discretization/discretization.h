// SPDX-License-Identifier: LGPL-2.1-or-later
// A set of unknowns and a set of integration points.
#pragma once

#include <softcell/base/types.h>
#include <softcell/discretization/patch.h>
#include <softcell/discretization/region.h>

#include <deal.II/base/mpi.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace softcell
{
  /// Memory for a patch that is generated on demand; keep one per thread and use it again and
  /// again.
  struct PatchStorage
  {
    std::vector<unsigned int> nodes;
    std::vector<double> weights;
    std::vector<Point> points;
    std::vector<unsigned char> labels;
    ShapeTable shapes;
  };

  /// With what right a cell answers for a point. A point on a face lies in several cells, whose
  /// gradients differ; which of them counts must not depend on what cells a rank has.
  struct Claim
  {
    double distance   = std::numeric_limits<double>::infinity(); // of the point; 0 inside. Units: m
    double precedence = 0;                                       // among cells equally near

    bool counts_before(const Claim &other, const double round_off) const
    {
      return distance < other.distance - round_off ||
             (distance <= other.distance + round_off && precedence > other.precedence);
    }
  };

  /// How far a cell's centre lies along a direction in which no two neighbours of a uniform grid
  /// are level.
  inline double precedence_of(const Point &centre)
  {
    return centre[0] + 0.7548776662 * centre[1] + 0.569840291 * centre[2];
  }

  /// Shape functions at one point: u(X) = sum_i values[i] u_{nodes[i]}.
  struct PointShapes
  {
    std::vector<unsigned int> nodes; // local node numbers
    std::vector<double> values;      // (n_nodes)
    std::vector<double> gradients;   // (3, n_nodes). Units: 1/m
    Claim claim;                     // of the cell that was found
  };

  /// A cell to draw. The corners are in VTK's order; `nodes` are the same corners (and, at degree 2
  /// and above, VTK's further points of a Lagrange cell) as combinations of nodes through
  /// `constraints`.
  struct DrawnCells
  {
    std::vector<unsigned char> types;       // VTK's cell types (n_cells)
    std::vector<unsigned int> offsets;      // (n_cells + 1) into connectivity
    std::vector<unsigned int> connectivity; // point numbers
    std::vector<Point> points;              // (n_points)
    std::vector<PointShapes> shapes;   // (n_points) the displacement there; only values are filled
    std::vector<unsigned int> patches; // (n_cells) number of the cell's patch
    std::vector<double> cut_fraction;  // (n_cells) filled part of the cell, 1 if not cut
  };

  /// Cells of one size on a lattice.
  struct UniformGrid
  {
    Direction spacing;                      // edges of a cell. Units: m
    std::vector<std::array<int, 3>> places; // (n_patches) of the cells, in cells along the axes
  };

  /// How much work a discretization is.
  struct Size
  {
    std::size_t cells = 0, cut_cells = 0, unknowns = 0, integration_points = 0,
                unfitted_cells = 0; // see CutRule::n_failures(); all summed over all ranks
    double smallest_cut        = 1; // filled fraction of the cell that is filled least
    double cell_size = 0; // edge of a background grid's largest cells, 0 of a mesh. Units: m
  };

  /// Unknowns, and the patches on which they are integrated.
  ///
  /// Every rank owns a contiguous range of nodes and some patches. A local node number is below
  /// n_owned_nodes() for a node of this rank and at least that for a ghost node, whose unknown
  /// belongs to another rank. Unknown 3 * node + c is component c of the displacement, so a Vector
  /// made from partitioner() is indexed by 3 * local node + c.
  class Discretization
  {
  public:
    virtual ~Discretization() = default;

    MPI_Comm communicator() const
    {
      return partitioner_->get_mpi_communicator();
    }
    /// Of the unknowns, three to a node.
    const std::shared_ptr<const Partitioner> &partitioner() const
    {
      return partitioner_;
    }
    unsigned int n_owned_nodes() const
    {
      return partitioner_->locally_owned_size() / 3;
    }
    /// Reference positions of this rank's nodes and of its ghosts, by local number.
    const std::vector<Point> &node_positions() const
    {
      return node_positions_;
    }
    /// A zero vector with ghost entries.
    Vector make_vector() const
    {
      return Vector(partitioner_);
    }

    virtual Size size() const              = 0;
    virtual unsigned int degree() const    = 0;
    virtual unsigned int n_patches() const = 0;

    /// Patch i of this rank. What it looks at stays valid until `storage` is used again.
    virtual Patch patch(unsigned int i, PatchStorage &storage) const = 0;

    /// What the cell of patch i holds beside the body, as a patch with the cell's nodes: filled
    /// with a soft material, which its weights are scaled for, it steadies cells of which the body
    /// fills little. No points where there is nothing of that.
    virtual Patch fictitious_patch(unsigned int /*i*/, PatchStorage & /*storage*/) const
    {
      return {};
    }

    /// Faces of cells that the body cuts, over which jumps of the displacement's gradient are
    /// penalised. Over all ranks each face appears once; only here, a node may be in no patch of
    /// this rank.
    virtual View<const GhostFace> ghost_faces() const
    {
      return {};
    }

    /// The nodes of patch i, for those who need no more of it.
    virtual std::vector<unsigned int> patch_nodes(const unsigned int i) const
    {
      PatchStorage storage;
      const auto nodes = patch(i, storage).nodes;
      return {nodes.begin(), nodes.end()};
    }

    /// Reference positions of a patch's points, in the order of its weights.
    virtual void patch_points(unsigned int i, std::vector<Point> &points) const = 0;

    /// The pieces of the region's boundary that lie in this rank's cells. Over all ranks each piece
    /// appears once.
    virtual std::vector<SurfacePatch> surface_patches(const Region &region) const = 0;

    /// The nodes (this rank's and ghosts) whose values alone determine the displacement on the
    /// region, or nothing if the region does not coincide with faces of cells, so that
    /// displacements cannot be imposed strongly. Collective: all ranks get nothing or all get their
    /// nodes.
    virtual std::optional<std::vector<unsigned int>> nodes_on(const Region &region) const = 0;

    /// The shapes at X from this rank's cells; beyond them, those of the nearest cell not farther
    /// than `reach`, extended. Of several equally near the claim decides. Nothing if there is none.
    virtual std::optional<PointShapes> shapes_at(const Point &X, double reach) const = 0;

    /// Box around this rank's cells.
    virtual Box owned_box() const = 0;

    virtual DrawnCells drawn_cells() const = 0;

    /// The grid, if all patches are trilinear cells of one size without hanging nodes, whose nodes
    /// are their corners along x first, and there is no other rank.
    virtual std::optional<UniformGrid> uniform_grid() const
    {
      return {};
    }

  protected:
    std::shared_ptr<const Partitioner> partitioner_;
    std::vector<Point> node_positions_;
  };
} // namespace softcell
