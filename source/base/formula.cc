// SPDX-License-Identifier: LGPL-2.1-or-later
// Expressions that a user writes, in muParser's syntax.

#include <softcell/base/formula.h>

#include <softcell/base/exceptions.h>

#include <deal.II/base/numbers.h>

#include <regex>

namespace softcell
{
  mu::Parser make_formula(const std::string &text,
                          const std::vector<std::pair<std::string, double *>> &variables,
                          const std::string &complaint,
                          const std::string &remedy)
  {
    const auto refuse = [&](const std::string &reason) {
      throw BadInput(complaint + ": " + reason + "; " + remedy + ".");
    };
    static const std::regex assignment("[^=!<>]=[^=]");
    if (std::regex_search(text, assignment))
      refuse("'=' does not compare, '==' does");
    mu::Parser parser;
    try
    {
      for (const auto &[name, value] : variables)
        parser.DefineVar(name, value);
      parser.DefineConst("pi", dealii::numbers::PI);
      parser.SetExpr(text);
      int n_values = 0;
      parser.Eval(n_values);
      if (n_values != 1)
        refuse("it has " + std::to_string(n_values) + " values");
    }
    catch (const mu::Parser::exception_type &error)
    {
      std::string reason = error.GetMsg();
      while (!reason.empty() && (reason.back() == '.' || reason.back() == ' '))
        reason.pop_back();
      refuse(reason);
    }
    return parser;
  }
} // namespace softcell
