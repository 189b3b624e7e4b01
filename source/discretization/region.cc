// SPDX-License-Identifier: LGPL-2.1-or-later
// Named parts of a body's boundary.

#include <softcell/discretization/region.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/formula.h>

#include <array>
#include <optional>
#include <regex>

namespace softcell
{
  struct Region::Condition
  {
    std::optional<unsigned int> patch; // if the condition is `patch K`
    std::array<double, 6> variables{};
    mu::Parser expression;
  };

  Region::Region(std::string name, const std::string &condition)
      : name_(std::move(name)), condition_(std::make_unique<Condition>())
  {
    static const std::regex patch("\\s*patch\\s+(\\d{1,9})\\s*");
    if (std::smatch match; std::regex_match(condition, match, patch))
    {
      condition_->patch = std::stoul(match[1]);
      return;
    }
    auto &[x, y, z, nx, ny, nz] = condition_->variables;
    condition_->expression      = make_formula(
           condition, {{"x", &x}, {"y", &y}, {"z", &z}, {"nx", &nx}, {"ny", &ny}, {"nz", &nz}},
           "Regions/" + name_ + " = '" + condition + "' cannot be read as a condition",
           "give 'patch K' or an expression of x, y, z, nx, ny, nz such as "
                "'z < 0.01 && nz < 0'");
    if (condition_->expression.GetUsedVar().empty() && condition_->expression.Eval() != 1)
      throw BadInput("Regions/" + name_ + " = '" + condition +
                     "' is the same everywhere; compare, as in 'z > 0.1', or write 1 for the whole "
                     "surface.");
  }

  Region::~Region()                  = default;
  Region::Region(Region &&) noexcept = default;

  bool Region::contains(const Point &X, const Direction &normal, const unsigned int patch) const
  {
    if (condition_->patch)
      return patch == *condition_->patch;
    condition_->variables = {{X[0], X[1], X[2], normal[0], normal[1], normal[2]}};
    return condition_->expression.Eval() != 0;
  }

  std::vector<Region> make_regions(const std::vector<std::pair<std::string, std::string>> &entries)
  {
    std::vector<Region> regions;
    for (const auto &[name, condition] : entries)
      regions.emplace_back(name, condition);
    return regions;
  }
} // namespace softcell
