// SPDX-License-Identifier: LGPL-2.1-or-later
// Bodies of two materials.

#include "small_problems.h"

#include <softcell/geometry/image_body.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    /// A unit cube of 16^3 voxels whose lowest layers have the label 40 and the rest 255.
    std::unique_ptr<Body> layered_cube(const unsigned int n_lower = 4)
    {
      LabelImage image;
      image.size    = {{16, 16, 16}};
      image.spacing = Direction({1. / 16, 1. / 16, 1. / 16});
      image.origin  = Point(1. / 32, 1. / 32, 1. / 32);
      image.values  = {40, 255};
      image.voxels.assign(16 * 16 * n_lower, 0);
      image.voxels.resize(16 * 16 * 16, 1);
      std::vector<std::string> remarks;
      return std::make_unique<ImageBody>(std::move(image), std::vector<unsigned int>{40, 255},
                                         "layers", remarks);
    }

    /// What holds the upper side when the cube is stretched by a tenth.
    double tension(const Method &method)
    {
      Parameters p                           = body_of("box", method, 4);
      p.material.model                       = "linear";
      p.material.poisson_ratio               = 0;
      p.label_materials["255"]               = p.material;
      p.label_materials["255"].young_modulus = 3000;
      p.loads.imposition                     = "strong";
      p.regions      = {{"base", "z < 1e-9 && nz < -0.5"}, {"top", "z > 1 - 1e-9 && nz > 0.5"}};
      p.load_entries = {{"base", "clamp"}, {"top", "displacement 0, 0, 0.1"}};
      return solve(p, layered_cube()).row.number("top_fz");
    }
  } // namespace

  /// Without a Poisson effect the layers are springs in series: 1 m^2 0.1 m / (1/4 m / E_40 + 3/4 m
  /// / E_255).
  TEST(Labels, layers_are_springs_in_series)
  {
    for (const Method &method : {Method{"finite cell", 1},
                                 {"finite cell", 2},
                                 {"weighted cell", 1},
                                 {"moment fitting", 1},
                                 {"sparse grid", 1},
                                 {"tetrahedra", 1},
                                 {"tetrahedra", 2},
                                 {"hexahedra", 1}})
      EXPECT_NEAR(tension(method), 200, 1e-8) << method.name;
  }

  /// The middle one of three cells holds the border at 7/16. Two Gauss points across a leaf see it
  /// at most half of the leaf's edge, 2^-levels / 3, off; from four levels on leaves end at voxels.
  TEST(Labels, finite_cell_refines_towards_their_border)
  {
    for (const unsigned int levels : {1u, 2u, 3u, 4u, 5u})
    {
      SCOPED_TRACE(levels);
      Parameters p                     = body_of("image", {"finite cell", 1}, 3);
      p.material.density               = 1;
      p.label_materials["255"]         = p.material;
      p.label_materials["255"].density = 3;
      p.discretization.cut.levels      = levels;
      p.loads.gravity                  = Direction({0, 0, -1});
      p.regions                        = {{"base", "z < 1e-9"}};
      p.load_entries                   = {{"base", "clamp"}};
      const double weight              = -solve(p, layered_cube(7)).row.number("gravity_fz");
      const double step                = std::pow(0.5, levels) / 3;
      EXPECT_NEAR((3 - weight) / 2, 7. / 16, levels < 4 ? step / 2 : 1e-12);
    }
  }

  /// The lower layer's volume, told by the weight of a mesh of the image itself. The facets between
  /// the layers may be off by a tenth of the mesh's edges, 0.01 m^3; of what is lost at the body's
  /// edges, which the image's surface rounds, the lower layer has 5 parts in 12.
  TEST(Labels, mesh_of_an_image_has_its_layers)
  {
    Parameters p                     = body_of("image", {"tetrahedra", 1}, 10);
    p.material.model                 = "linear";
    p.material.density               = 1;
    p.label_materials["255"]         = p.material;
    p.label_materials["255"].density = 3;
    p.loads.gravity                  = Direction({0, 0, -1});
    p.regions                        = {{"base", "z < 1e-9 && nz < -0.5"}};
    p.load_entries                   = {{"base", "clamp"}};
    const ResultsRow row             = solve(p, layered_cube()).row;
    const double volume = row.number("volume"), weight = -row.number("gravity_fz");
    EXPECT_NEAR(volume, 1, 0.03);
    EXPECT_NEAR((3 * volume - weight) / 2, 0.25 - 5. / 12 * (1 - volume), 0.01);
  }
} // namespace softcell
