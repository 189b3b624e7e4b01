// SPDX-License-Identifier: LGPL-2.1-or-later
// Brunet's mapping of forces at surface nodes to the cells that hold them.

#include <softcell/loads/nodal_mapping.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

namespace softcell
{
  namespace
  {
    struct NodalArea
    {
      double area = 0;  // Units: m^2
      Direction normal; // sum of area times normal
    };

    /// The vertices of the region's triangles.
    std::map<unsigned int, NodalArea> vertices_of(const Surface &surface, const Region &region)
    {
      std::map<unsigned int, NodalArea> vertices;
      for (unsigned int k = 0; k < surface.triangles().size(); ++k)
      {
        const auto corners     = surface.corners(k);
        const Direction normal = surface.normal(k);
        const Point centre((corners[0] + corners[1] + corners[2]) / 3.);
        if (!region.contains(centre, normal, surface.patches()[k]))
          continue;
        const double share = surface.area(k) / 3;
        for (const unsigned int vertex : surface.triangles()[k])
        {
          vertices[vertex].area += share;
          vertices[vertex].normal += share * normal;
        }
      }
      return vertices;
    }

    SurfacePatch patch_of_vertex(const Point &X, const NodalArea &vertex, PointShapes &&shapes)
    {
      SurfacePatch patch;
      patch.shapes.n_points  = 1;
      patch.shapes.n_nodes   = shapes.nodes.size();
      patch.nodes            = std::move(shapes.nodes);
      patch.shapes.values    = std::move(shapes.values);
      patch.shapes.gradients = std::move(shapes.gradients);
      patch.points           = {X};
      patch.normals          = {vertex.normal / vertex.normal.norm()};
      patch.weights          = {vertex.area};
      patch.labels           = {0};
      return patch;
    }
  } // namespace

  std::vector<SurfacePatch> nodal_surface_patches(const Discretization &discretization,
                                                  const Surface &surface,
                                                  const Region &region,
                                                  const double reach)
  {
    const auto vertices = vertices_of(surface, region);

    std::vector<double> least; // of all ranks' distances
    std::vector<Claim> claims;
    std::vector<SurfacePatch> found;
    for (const auto &[number, vertex] : vertices)
    {
      const Point &X = surface.vertices()[number];
      auto shapes    = discretization.shapes_at(X, reach);
      claims.push_back(shapes ? shapes->claim : Claim());
      least.push_back(claims.back().distance);
      found.push_back(shapes ? patch_of_vertex(X, vertex, std::move(*shapes)) : SurfacePatch());
    }
    const MPI_Comm communicator = discretization.communicator();
    dealii::Utilities::MPI::min(View<const double>(least), communicator, View<double>(least));

    struct Bid // laid out as MPI_DOUBLE_INT
    {
      double precedence;
      int rank;
    };
    const int my_rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    std::vector<Bid> bids;
    for (unsigned int k = 0; k < claims.size(); ++k)
      bids.push_back({claims[k].distance <= least[k] + 1e-10 * reach
                        ? claims[k].precedence
                        : std::numeric_limits<double>::lowest(),
                      my_rank});
    MPI_Allreduce(MPI_IN_PLACE, bids.data(), bids.size(), MPI_DOUBLE_INT, MPI_MAXLOC, communicator);

    std::vector<SurfacePatch> patches;
    auto vertex = vertices.begin();
    for (unsigned int k = 0; k < bids.size(); ++k, ++vertex)
    {
      if (std::isinf(least[k]))
      {
        std::ostringstream message;
        message << "The surface point (" << surface.vertices()[vertex->first] << ") of region '"
                << region.name() << "' is farther than " << reach
                << " m from all cells; give a finer grid or choose 'Surface integration = exact' "
                   "in Loads.";
        throw BadInput(message.str());
      }
      if (bids[k].rank == my_rank)
        patches.push_back(std::move(found[k]));
    }
    return patches;
  }
} // namespace softcell
