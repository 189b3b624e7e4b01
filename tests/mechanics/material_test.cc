// SPDX-License-Identifier: LGPL-2.1-or-later
// The law chosen by its name, and what a user may not enter.

#include <softcell/mechanics/material.h>

#include <softcell/base/exceptions.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using softcell::BadInput;
  using softcell::Material;

  // P_11 of a stretch by 2 along x, which tells the laws apart.
  double stress(const Material &material)
  {
    const softcell::Matrix3<double> F{{2, 0, 0, 0, 1, 0, 0, 0, 1}};
    return material.visit([&](const auto &law) { return law.first_piola_stress(F)(0, 0); });
  }

  std::string complaint(const std::string &model,
                        const double young_modulus,
                        const double poisson_ratio,
                        const double density,
                        const std::string &section = "Material")
  {
    try
    {
      Material(model, young_modulus, poisson_ratio, density, section);
    }
    catch (const BadInput &error)
    {
      return error.what();
    }
    return "";
  }

  TEST(Material, HoldsTheLawOfItsName)
  {
    // nu = 0.25 makes lambda = mu = 0.4 E.
    EXPECT_NEAR(stress(Material("Neo-Hookean", 10, 0.25)), 4 * (2 - 0.5 + std::log(2) / 2), 1e-13);
    EXPECT_NEAR(stress(Material("Saint-Venant-Kirchhoff", 10, 0.25)), 2 * 12 * 1.5, 1e-13);
    EXPECT_NEAR(stress(Material("linear", 10, 0.25)), 12, 1e-13);
    EXPECT_EQ(Material("linear", 10, 0.25, 1060).density(), 1060);
    EXPECT_DOUBLE_EQ(Material("linear", 10, 0.25).longitudinal_modulus(), 12); // lambda = mu = 4
  }

  TEST(Material, NamesTheEntryThatCannotBe)
  {
    EXPECT_EQ(complaint("Neo-Hookean", 5000, -0.5, 0), "");
    EXPECT_NE(complaint("linear", 0, 0.3, 0).find("Material/Young modulus is 0;"),
              std::string::npos);
    EXPECT_NE(complaint("linear", -2, 0.3, 0).find("is -2;"), std::string::npos);
    EXPECT_NE(complaint("linear", std::nan(""), 0.3, 0).find("Young modulus"), std::string::npos);
    for (const double ratio : {0.5, 0.7, -1., std::nan("")})
      EXPECT_NE(complaint("linear", 1, ratio, 0).find("Material/Poisson ratio"), std::string::npos)
        << ratio;
    EXPECT_NE(complaint("linear", 1, 0.3, -1).find("Material/Density"), std::string::npos);
    EXPECT_NE(complaint("Hooke", 1, 0.3, 1).find("'Hooke'"), std::string::npos);
    EXPECT_NE(complaint("linear", 0, 0.3, 0, "Material 255").find("Material 255/Young modulus"),
              std::string::npos);
  }
} // namespace
