// SPDX-License-Identifier: LGPL-2.1-or-later
// A scalar or vector of x, y, z and t that the user gives as expressions.
#pragma once

#include <softcell/base/types.h>

#include <functional>
#include <memory>
#include <string>

namespace softcell
{
  /// One expression of x, y, z (Units: m) and t in muParser's syntax, or three separated by commas.
  /// The word `free` in place of a component of a vector leaves that component out.
  class Expression
  {
  public:
    /// @param place  where the text stands (`Loads/top = 'traction 0, 0, 1'`), for messages.
    /// @throws BadInput
    Expression(const std::string &text, unsigned int n_components, const std::string &place);
    /// A vector by a function of X and t, in place of text.
    Expression(std::function<Direction(const Point &, double)> function, const std::string &place);
    ~Expression();
    Expression(Expression &&) noexcept;

    /// The components that there are, the rest 0; free components are 0.
    Direction value(const Point &X, double t) const;

    /// The value of a load at load factor t: value(X, t) if the expressions contain t, and t times
    /// the value if none does, so that a load that does not speak of t grows from 0.
    Direction at_load_factor(const Point &X, double t) const;

    bool uses_time() const;
    bool is_free(unsigned int component) const;

    const std::string &place() const
    {
      return place_;
    }

  private:
    struct Formulas;
    std::string place_;
    std::unique_ptr<Formulas> formulas_;
  };
} // namespace softcell
