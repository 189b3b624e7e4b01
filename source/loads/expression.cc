// SPDX-License-Identifier: LGPL-2.1-or-later
// A scalar or vector of x, y, z and t that the user gives as expressions.

#include <softcell/loads/expression.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/formula.h>

#include <deal.II/base/utilities.h>

#include <array>
#include <vector>

namespace softcell
{
  struct Expression::Formulas
  {
    std::array<double, 4> variables{}; // x, y, z, t
    std::vector<mu::Parser> parsers;   // one per component
    std::vector<bool> is_free;
    bool uses_time = false;
    std::function<Direction(const Point &, double)> function; // in place of the parsers
  };

  namespace
  {
    /// The parts between those commas that are not inside parentheses.
    std::vector<std::string> split(const std::string &text)
    {
      std::vector<std::string> parts(1);
      int depth = 0;
      for (const char c : text)
      {
        depth += (c == '(') - (c == ')');
        if (c == ',' && depth == 0)
          parts.emplace_back();
        else
          parts.back() += c;
      }
      for (std::string &part : parts)
        part = dealii::Utilities::trim(part);
      return parts;
    }
  } // namespace

  Expression::Expression(const std::string &text,
                         const unsigned int n_components,
                         const std::string &place)
      : place_(place), formulas_(std::make_unique<Formulas>())
  {
    const std::vector<std::string> parts = split(text);
    if (parts.size() != n_components)
      throw BadInput(place + " has " + std::to_string(parts.size()) + " components; give " +
                     std::to_string(n_components) +
                     (n_components == 1 ? " expression" : " expressions separated by commas") +
                     " of x, y, z and t.");
    auto &[x, y, z, t] = formulas_->variables;
    for (const std::string &part : parts)
    {
      formulas_->is_free.push_back(part == "free");
      formulas_->parsers.push_back(
        make_formula(part == "free" ? "0" : part, {{"x", &x}, {"y", &y}, {"z", &z}, {"t", &t}},
                     place + " has '" + part + "', which cannot be read",
                     "give an expression of x, y, z and t such as '30 * sin(pi * t)'"));
      formulas_->uses_time |= formulas_->parsers.back().GetUsedVar().count("t") > 0;
    }
  }

  Expression::Expression(std::function<Direction(const Point &, double)> function,
                         const std::string &place)
      : place_(place), formulas_(std::make_unique<Formulas>())
  {
    formulas_->is_free.assign(dim, false);
    formulas_->uses_time = true;
    formulas_->function  = std::move(function);
  }

  Expression::~Expression()                      = default;
  Expression::Expression(Expression &&) noexcept = default;

  Direction Expression::value(const Point &X, const double t) const
  {
    if (formulas_->function)
      return formulas_->function(X, t);
    formulas_->variables = {{X[0], X[1], X[2], t}};
    Direction result;
    for (unsigned int c = 0; c < formulas_->parsers.size(); ++c)
      result[c] = formulas_->parsers[c].Eval();
    return result;
  }

  Direction Expression::at_load_factor(const Point &X, const double t) const
  {
    return formulas_->uses_time ? value(X, t) : t * value(X, t);
  }

  bool Expression::uses_time() const
  {
    return formulas_->uses_time;
  }

  bool Expression::is_free(const unsigned int component) const
  {
    return formulas_->is_free[component];
  }
} // namespace softcell
