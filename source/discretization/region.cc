// SPDX-License-Identifier: LGPL-2.1-or-later
// Named parts of a body's boundary.
#include <softcell/base/exceptions.h>
#include <softcell/discretization/region.h>

#include <array>
#include <muParser.h>
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
    static const std::regex patch("\\s*patch\\s+(\\d{1,9})\\s*"), assignment("[^=!<>]=[^=]");
    if (std::smatch match; std::regex_match(condition, match, patch))
    {
      condition_->patch = std::stoul(match[1]);
      return;
    }

    const std::string complaint =
      "Regions/" + name_ + " = '" + condition + "' cannot be read as a condition: ";
    const std::string remedy = "; give 'patch K' or an expression of x, y, z, nx, ny, nz such as "
                               "'z < 0.01 && nz < 0'.";
    if (std::regex_search(condition, assignment))
      throw BadInput(complaint + "'=' does not compare, '==' does" + remedy);
    try
    {
      static const std::array<const char *, 6> names = {{"x", "y", "z", "nx", "ny", "nz"}};
      for (unsigned int i = 0; i < 6; ++i)
        condition_->expression.DefineVar(names[i], &condition_->variables[i]);
      condition_->expression.DefineConst("pi", dealii::numbers::PI);
      condition_->expression.SetExpr(condition);
      condition_->expression.Eval();
    }
    catch (const mu::Parser::exception_type &error)
    {
      throw BadInput(complaint + error.GetMsg() + remedy);
    }
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
} // namespace softcell
