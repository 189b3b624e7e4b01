// SPDX-License-Identifier: LGPL-2.1-or-later
// A law chosen at run time.

#include <softcell/mechanics/material.h>

#include <softcell/base/exceptions.h>

#include <sstream>

namespace softcell
{
  namespace
  {
    /// @param is_good false for NaN too.
    void check(const bool is_good,
               const std::string &entry,
               const double found,
               const std::string &allowed)
    {
      if (is_good)
        return;
      std::ostringstream message;
      message << entry << " is " << found << "; give a value " << allowed << ".";
      throw BadInput(message.str());
    }
  } // namespace

  Material::Material(const std::string &model,
                     const double young_modulus,
                     const double poisson_ratio,
                     const double density,
                     const std::string &section)
      : density_(density)
  {
    check(young_modulus > 0 && std::isfinite(young_modulus), section + "/Young modulus",
          young_modulus, "above 0 (in Pa)");
    check(poisson_ratio > -1 && poisson_ratio < 0.5, section + "/Poisson ratio", poisson_ratio,
          "above -1 and below 0.5 (a nearly incompressible tissue has 0.45 to 0.49)");
    check(density >= 0 && std::isfinite(density), section + "/Density", density,
          "of at least 0 (in kg/m^3)");

    if (model == "Neo-Hookean")
      law_ = make_law<NeoHookean>(young_modulus, poisson_ratio);
    else if (model == "Saint-Venant-Kirchhoff")
      law_ = make_law<SaintVenantKirchhoff>(young_modulus, poisson_ratio);
    else if (model == "linear")
      law_ = make_law<LinearElastic>(young_modulus, poisson_ratio);
    else
      throw BadInput(section + "/Model is '" + model +
                     "'; choose Neo-Hookean, Saint-Venant-Kirchhoff or linear.");
  }

  Material Material::invertible() const
  {
    Material material = *this;
    if (const auto *const law = std::get_if<NeoHookean<>>(&law_))
      material.law_ = InvertibleNeoHookean<>{law->lambda, law->mu};
    return material;
  }

  Material Material::definite() const
  {
    if (std::holds_alternative<InvertibleNeoHookean<>>(law_))
      return *this;
    return visit([&](const auto &law) {
      const bool is_linear = std::is_same_v<std::decay_t<decltype(law)>, LinearElastic<>>;
      const double young   = law.mu * (3 * law.lambda + 2 * law.mu) / (law.lambda + law.mu);
      return Material(is_linear ? "linear" : "Neo-Hookean", young, poisson_ratio(), density_);
    });
  }
} // namespace softcell
