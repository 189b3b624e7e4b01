// SPDX-License-Identifier: LGPL-2.1-or-later
// A law chosen at run time.
#pragma once

#include <softcell/mechanics/laws.h>

#include <string>
#include <utility>
#include <variant>

namespace softcell
{
  /// One of the laws with its parameters, and the density.
  class Material
  {
  public:
    /// @param model Neo-Hookean, Saint-Venant-Kirchhoff or linear.
    /// @param young_modulus above 0. Units: Pa
    /// @param poisson_ratio above -1 and below 0.5.
    /// @param density not negative. Units: kg/m^3
    /// @param section of the parameter file that these values come from, for messages.
    /// @throws BadInput
    Material(const std::string &model,
             double young_modulus,
             double poisson_ratio,
             double density             = 0,
             const std::string &section = "Material");

    /// Calls f with the law itself (a NeoHookean<>, ...), so that a loop inside f knows its law at
    /// compile time.
    template <class Function>
    decltype(auto) visit(Function &&f) const
    {
      return std::visit(std::forward<Function>(f), law_);
    }

    /// The same for motions that may turn the body inside out: InvertibleNeoHookean in place of
    /// Neo-Hookean.
    Material invertible() const;

    /// Neo-Hookean in place of Saint-Venant-Kirchhoff, with the same tangent at rest: a law whose
    /// tangents can be made positive, see Tangent. That of motions can be as it is.
    Material definite() const;

    /// lambda + 2 mu, the stiffness against strain along one axis alone. Units: Pa
    double longitudinal_modulus() const
    {
      return visit([](const auto &law) { return law.lambda + 2 * law.mu; });
    }

    double poisson_ratio() const
    {
      return visit([](const auto &law) { return law.lambda / (2 * (law.lambda + law.mu)); });
    }

    /// Units: kg/m^3
    double density() const
    {
      return density_;
    }

  private:
    std::variant<NeoHookean<>, SaintVenantKirchhoff<>, LinearElastic<>, InvertibleNeoHookean<>>
      law_;
    double density_;
  };
} // namespace softcell
