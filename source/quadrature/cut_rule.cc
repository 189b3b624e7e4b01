// SPDX-License-Identifier: LGPL-2.1-or-later
// The list of cut-cell rules.

#include <softcell/quadrature/cut_rule.h>

#include <softcell/base/exceptions.h>
#include <softcell/quadrature/finite_cell.h>
#include <softcell/quadrature/moment_fitting.h>
#include <softcell/quadrature/octree.h>
#include <softcell/quadrature/weighted_cell.h>

namespace softcell
{
  void CutParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Cut levels", levels,
                      "How often a cell that the body's boundary or an interface of materials cuts "
                      "is halved to find what is filled; 0 counts it as full (sparse grid).",
                      dealii::Patterns::Integer(0, max_levels));
    prm.add_parameter(
      "Alpha", alpha,
      "Stiffness of what a cut cell holds beside the body, relative to the body's; a small value "
      "such as 1e-6 bounds the condition of linear systems, Newton's method gains little. It "
      "follows the linear law with the body's mu and the lesser of its lambda and 2 mu, has "
      "neither mass nor volume, and may turn inside out. Units: 1",
      dealii::Patterns::Double(0, 0.01));
    prm.add_parameter(
      "Ghost penalty", ghost_penalty,
      "Holds the displacement of cut cells to that of their neighbours, extended. Where large "
      "strains end Newton's method early, 0.01 takes it further in fewer iterations; "
      "four cells across a body, that makes it stiffer by up to 1.5 %. "
      "Units: 1",
      dealii::Patterns::Double(0));
    prm.add_parameter("Weighted cell spread", spread,
                      "Part of its filled volume that a weighted cell spreads evenly over all of "
                      "its points if few of them hold it all; 0 is Brunet's rule, whose slightly "
                      "filled cells can be mechanisms. Units: 1",
                      dealii::Patterns::Double(0, 1));
  }

  namespace
  {
    struct CutRuleEntry
    {
      std::string name;
      std::unique_ptr<CutRule> (*make)(CutParameters, unsigned int degree, const Body &);
    };

    // A new rule is its own file and one line here.
    const std::vector<CutRuleEntry> &cut_rules()
    {
      static const std::vector<CutRuleEntry> rules = {
        {"finite cell",
         [](CutParameters p, unsigned int degree, const Body &body) -> std::unique_ptr<CutRule> {
           if (p.levels == 0) // the sparse grid by definition
             return std::make_unique<WeightedCell>(p, degree, body);
           return std::make_unique<FiniteCell>(p, degree, body);
         }},
        {"weighted cell",
         [](CutParameters p, unsigned int degree, const Body &body) -> std::unique_ptr<CutRule> {
           return std::make_unique<WeightedCell>(p, degree, body);
         }},
        {"moment fitting",
         [](CutParameters p, unsigned int degree, const Body &body) -> std::unique_ptr<CutRule> {
           if (p.levels == 0)
             return std::make_unique<WeightedCell>(p, degree, body);
           return std::make_unique<MomentFitting>(p, degree, body);
         }},
        {"sparse grid",
         [](CutParameters p, unsigned int degree, const Body &body) -> std::unique_ptr<CutRule> {
           p.levels = 0;
           return std::make_unique<WeightedCell>(p, degree, body);
         }},
      };
      return rules;
    }
  } // namespace

  std::vector<std::string> cut_rule_names()
  {
    std::vector<std::string> names;
    for (const CutRuleEntry &rule : cut_rules())
      names.push_back(rule.name);
    return names;
  }

  std::unique_ptr<CutRule> make_cut_rule(const std::string &name,
                                         const CutParameters &parameters,
                                         const unsigned int degree,
                                         const Body &body)
  {
    std::string known;
    for (const CutRuleEntry &rule : cut_rules())
    {
      if (rule.name == name)
        return rule.make(parameters, degree, body);
      known += (known.empty() ? "" : ", ") + rule.name;
    }
    throw BadInput("Discretization/Method = " + name +
                   " is not a cut-cell rule; give one of: " + known + ".");
  }
} // namespace softcell
