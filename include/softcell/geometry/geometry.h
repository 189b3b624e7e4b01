// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Geometry, and the body that it describes.
#pragma once

#include <softcell/geometry/body.h>

#include <deal.II/base/parameter_handler.h>

#include <memory>
#include <string>
#include <vector>

namespace softcell
{
  /// What the section Geometry of a parameter file says.
  struct GeometryParameters
  {
    std::string type                 = "surface"; // one of the names registered in geometry.cc
    std::string file                 = "";        // surface or image
    double scale                     = 1;         // metres per unit of the file
    std::vector<unsigned int> labels = {}; // image: those that form the body; empty: all but 0
                                           // surface: patches of parts with their own material
    double radius = 0.05; // cylinder, spheres, torus (of the tube), hexagonal prism (circumradius)
    double inner_radius = 0.025;          // hollow sphere
    double ring_radius  = 0.1;            // torus: from the axis to the middle of the tube
    double length       = 0.6;            // cylinder, hexagonal prism: along z
    Point size          = Point(1, 1, 1); // box

    /// Declares the entries of the section, which the caller has entered.
    void add_parameters(dealii::ParameterHandler &prm);
  };

  /// Builds the body. Analytic bodies stand on z = 0 with their axis along z, the box with a corner
  /// at the origin.
  /// @param remarks gets a sentence for everything that was repaired or assumed.
  /// @throws BadInput
  std::unique_ptr<Body> make_body(const GeometryParameters &parameters,
                                  std::vector<std::string> &remarks);
} // namespace softcell
