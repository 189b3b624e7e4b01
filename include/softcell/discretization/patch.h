// SPDX-License-Identifier: LGPL-2.1-or-later
// The waist of softcell: everything that an operator or a load knows of a discretization.
#pragma once

#include <softcell/base/types.h>

#include <vector>

namespace softcell
{
  /// Shape functions at the points of one or many congruent cells.
  struct ShapeTable
  {
    unsigned int n_points = 0;
    unsigned int n_nodes  = 0;
    std::vector<double> values;    // (n_points, n_nodes). Units: 1
    std::vector<double> gradients; // (n_points, 3, n_nodes), with respect to X. Units: 1/m

    void resize(const unsigned int points, const unsigned int nodes)
    {
      n_points = points;
      n_nodes  = nodes;
      values.resize(points * nodes);
      gradients.resize(points * 3 * nodes);
    }
    /// Frees three quarters of the memory, where none are needed.
    void drop_gradients()
    {
      gradients = {};
      gradients.shrink_to_fit();
    }
    const double *value(const unsigned int point) const
    {
      return values.data() + point * n_nodes;
    }
    /// Derivatives along x of all nodes, then along y, then along z.
    const double *gradient(const unsigned int point) const
    {
      return gradients.data() + point * 3 * n_nodes;
    }
  };

  /// Integration data of one cell (or of one meshless integration element) in the reference
  /// configuration.
  ///
  /// A patch looks into storage that belongs to the discretization or to a PatchStorage; it is
  /// cheap to copy. Hanging nodes do not appear: their shapes are added to those of the nodes that
  /// they hang on.
  struct Patch
  {
    View<const unsigned int> nodes; // (n_nodes) local node numbers
    View<const double>
      weights; // (n_points) quadrature weight times det J times what is filled. Units: m^3
    const ShapeTable *shapes = nullptr;
    View<const unsigned char> labels; // (n_points) material labels, or a single one for all points

    unsigned int n_points() const
    {
      return weights.size();
    }
    unsigned int n_nodes() const
    {
      return nodes.size();
    }
    unsigned int label(const unsigned int point) const
    {
      return labels.size() == 1 ? labels[0] : labels[point];
    }
  };

  /// How far the displacements of two cells with a face in common are apart where both are
  /// extended: with the modulus M of the material, the energy M/2 sum_ij products_ij u_i . u_j.
  struct GhostFace
  {
    std::vector<unsigned int> nodes; // (n_nodes) local node numbers, of both cells
    std::vector<double> products;    // (n_nodes, n_nodes) symmetric. Units: m
    unsigned char label = 0;         // of the material
  };

  /// Shapes of a boundary piece that lies in one cell, and its points.
  struct SurfacePatch
  {
    unsigned int cell = 0;           // number of the patch of the cell
    std::vector<unsigned int> nodes; // (n_nodes) local node numbers, those of that patch
    std::vector<Point> points;       // (n_points) in the reference configuration
    std::vector<Direction> normals;  // (n_points) unit outward normals there
    std::vector<double> weights;     // (n_points) Units: m^2
    ShapeTable shapes;
    std::vector<unsigned char> labels; // (n_points) material labels
    double cell_size = 0;              // the scale of penalties is 1 / h. Units: m
  };
} // namespace softcell
