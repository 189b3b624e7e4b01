// SPDX-License-Identifier: LGPL-2.1-or-later
// The parameter section Geometry, and the list of all bodies.

#include <softcell/geometry/geometry.h>

#include <softcell/base/exceptions.h>
#include <softcell/geometry/image_body.h>
#include <softcell/geometry/shapes.h>
#include <softcell/geometry/surface_body.h>

#include <deal.II/base/patterns.h>

#include <cmath>
#include <sstream>

namespace softcell
{
  namespace
  {
    using Remarks = std::vector<std::string>;

    std::string as_text(const double value)
    {
      std::ostringstream text;
      text << value;
      return text.str();
    }

    double positive(const std::string &entry, const double value)
    {
      if (value > 0 && std::isfinite(value))
        return value;
      throw BadInput("Geometry/" + entry + " = " + as_text(value) +
                     " is no size: give a number above 0.");
    }

    const std::string &file_of(const GeometryParameters &p)
    {
      if (p.file.empty())
        throw BadInput("Geometry/File is empty, but Type = " + p.type +
                       " needs a file: name it, or choose a shape such as Type = box.");
      return p.file;
    }

    std::unique_ptr<Body> make_torus(const GeometryParameters &p)
    {
      if (!(p.ring_radius > p.radius))
        throw BadInput("Geometry/Ring radius = " + as_text(p.ring_radius) +
                       " is not above Radius = " + as_text(p.radius) +
                       " of the tube: the torus would meet itself; give a larger Ring radius.");
      return softcell::make_torus(positive("Ring radius", p.ring_radius),
                                  positive("Radius", p.radius));
    }

    std::unique_ptr<Body> make_hollow_sphere(const GeometryParameters &p)
    {
      if (!(p.inner_radius < p.radius))
        throw BadInput("Geometry/Inner radius = " + as_text(p.inner_radius) +
                       " is not below Radius = " + as_text(p.radius) +
                       " of the hollow sphere: nothing would be left of it; give a smaller one.");
      return softcell::make_hollow_sphere(positive("Radius", p.radius),
                                          positive("Inner radius", p.inner_radius));
    }

    struct BodyType
    {
      std::string name;
      std::unique_ptr<Body> (*make)(const GeometryParameters &, Remarks &);
    };

    /// All bodies by the names that a parameter file gives them.
    const std::vector<BodyType> body_types = {
      {"surface",
       [](const GeometryParameters &p, Remarks &remarks) -> std::unique_ptr<Body> {
         Surface surface = read_surface(file_of(p), positive("Scale", p.scale), remarks);
         if (p.labels.empty())
           return std::make_unique<SurfaceBody>(std::move(surface));
         return std::make_unique<SurfaceBody>(surface, p.labels, p.file);
       }},
      {"image",
       [](const GeometryParameters &p, Remarks &remarks) -> std::unique_ptr<Body> {
         return std::make_unique<ImageBody>(read_image(file_of(p), positive("Scale", p.scale)),
                                            p.labels, p.file, remarks);
       }},
      {"box",
       [](const GeometryParameters &p, Remarks &) {
         for (const unsigned int d : {0, 1, 2})
           positive("Size (" + std::string(1, "xyz"[d]) + ")", p.size[d]);
         return make_box(p.size);
       }},
      {"cylinder",
       [](const GeometryParameters &p, Remarks &) {
         return make_cylinder(positive("Radius", p.radius), positive("Length", p.length));
       }},
      {"sphere", [](const GeometryParameters &p,
                    Remarks &) { return make_sphere(positive("Radius", p.radius)); }},
      {"hollow sphere",
       [](const GeometryParameters &p, Remarks &) { return make_hollow_sphere(p); }},
      {"torus", [](const GeometryParameters &p, Remarks &) { return make_torus(p); }},
      {"hexagonal prism", [](const GeometryParameters &p, Remarks &) {
         return make_hexagonal_prism(positive("Radius", p.radius), positive("Length", p.length));
       }}};

    std::string names_of_types(const std::string &separator)
    {
      std::string names;
      for (const BodyType &type : body_types)
        names += (names.empty() ? "" : separator) + type.name;
      return names;
    }
  } // namespace

  void GeometryParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using namespace dealii::Patterns;
    prm.add_parameter(
      "Type", type,
      "What describes the body: a closed surface (OFF, OBJ, STL, PLY, VTP), a labelled "
      "image (INRIMAGE, MetaImage, NRRD, NIfTI) or a shape. Shapes stand on z = 0 with "
      "their axis along z, the box with a corner at the origin.",
      Selection(names_of_types("|")));
    prm.add_parameter("File", file, "Surface or image to read; the name's ending tells the format.",
                      Anything());
    prm.add_parameter("Scale", scale,
                      "Units: m per unit of the file: 0.001 for a file in millimetres.", Double(0));
    prm.add_parameter(
      "Labels", labels,
      "Image: the labels whose voxels form the body, e.g. 85, 255. Empty: all but 0. Surface: the "
      "patches whose closed parts are filled even where they lie inside another part, which are "
      "holes otherwise; those with a section `Material LABEL` need not be named. Each may have a "
      "section `Material LABEL` of its own.",
      List(Integer(0), 0, 255));
    prm.add_parameter(
      "Radius", radius,
      "Units: m. Cylinder and spheres; of a torus, that of its tube; of a hexagonal "
      "prism, from the axis to the corners.",
      Double(0));
    prm.add_parameter("Inner radius", inner_radius, "Units: m. Hollow sphere: of its cavity.",
                      Double(0));
    prm.add_parameter("Ring radius", ring_radius,
                      "Units: m. Torus: from the axis to the middle of the tube.", Double(0));
    prm.add_parameter("Length", length, "Units: m. Cylinder and hexagonal prism: along z.",
                      Double(0));
    prm.add_parameter("Size", size, "Units: m. Box: along x, y, z.", List(Double(0), 3, 3));
  }

  namespace
  {
    /// Says so if a file in another unit than metres seems to lack its scale.
    void check_unit(const GeometryParameters &parameters, const Body &body, Remarks &remarks)
    {
      const auto [lower, upper] = body.bounding_box().get_boundary_points();
      const double length       = lower.distance(upper);
      if (parameters.scale != 1 || (length > 1e-4 && length < 10))
        return;
      remarks.push_back(parameters.file + ": the body measures " + as_text(length) +
                        " m across; if the file has another unit than metres, say so by "
                        "Geometry/Scale, such as 0.001 for millimetres.");
    }
  } // namespace

  std::unique_ptr<Body> make_body(const GeometryParameters &parameters,
                                  std::vector<std::string> &remarks)
  {
    for (const BodyType &type : body_types)
      if (type.name == parameters.type)
      {
        auto body = type.make(parameters, remarks);
        if (type.name == "surface" || type.name == "image")
          check_unit(parameters, *body, remarks);
        return body;
      }
    throw BadInput("Geometry/Type = " + parameters.type + " is none of " + names_of_types(", ") +
                   ".");
  }
} // namespace softcell
