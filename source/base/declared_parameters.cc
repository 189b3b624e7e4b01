// SPDX-License-Identifier: LGPL-2.1-or-later
// What a ParameterHandler declares, as a tree of sections and entries.

#include "declared_parameters.h"

#include <softcell/base/parameters.h>

#include <deal.II/base/utilities.h>

#include <boost/property_tree/json_parser.hpp>

#include <algorithm>
#include <regex>
#include <sstream>

namespace softcell
{
  std::string join(const std::vector<std::string> &words, const std::string &separator)
  {
    std::string text;
    for (const std::string &word : words)
      text += (text.empty() ? "" : separator) + word;
    return text;
  }

  Tree declared(dealii::ParameterHandler &prm)
  {
    std::stringstream json;
    prm.print_parameters(json, dealii::ParameterHandler::JSON |
                                 dealii::ParameterHandler::KeepDeclarationOrder);
    Tree tree;
    boost::property_tree::read_json(json, tree);
    return tree;
  }

  bool is_entry(const Tree &node)
  {
    return node.find("pattern_description") != node.not_found();
  }

  const Tree *find(const Tree &tree, const Path &path)
  {
    const Tree *node = &tree;
    for (const std::string &name : path)
    {
      const auto child = node->find(name);
      if (is_entry(*node) || child == node->not_found())
        return nullptr;
      node = &child->second;
    }
    return node;
  }

  void for_each_entry(const Tree &tree,
                      const std::function<void(const Path &, const Tree &)> &action,
                      const Path &path)
  {
    for (const auto &[name, node] : tree)
    {
      Path child = path;
      child.push_back(name);
      if (is_entry(node))
        action(child, node);
      else
        for_each_entry(node, action, child);
    }
  }

  std::string allowed(const std::string &pattern)
  {
    std::smatch match;
    const auto number = [](const std::string &from, const std::string &to) {
      const bool below = from.find("MAX") == std::string::npos,
                 above = to.find("MAX") == std::string::npos && to != "2147483647";
      return below && above ? " from " + from + " to " + to
             : below        ? " of at least " + from
             : above        ? " of at most " + to
                            : std::string();
    };
    if (std::regex_match(pattern, match, std::regex(R"(\[Double (.*)\.\.\.(.*) \(inclusive\)\])")))
      return "a number" + number(match[1], match[2]);
    if (std::regex_match(pattern, match,
                         std::regex(R"(\[Integer range (.*)\.\.\.(.*) \(inclusive\)\])")))
      return "a whole number" +
             number(match[1] == "-2147483648" ? std::string("-MAX") : match[1].str(), match[2]);
    if (pattern == "[Integer]")
      return "a whole number";
    if (std::regex_match(pattern, match, std::regex(R"(\[Selection (.*) \])")))
    {
      const std::string choices = match[1];
      return choices.find('|') == std::string::npos
               ? choices + ", the only choice of this version"
               : "one of " + std::regex_replace(choices, std::regex(R"(\|)"), ", ");
    }
    if (pattern == "[Bool]")
      return "true or false";
    if (std::regex_match(
          pattern, match,
          std::regex(R"(\[List of <(.*)> of length (\d+)\.\.\.(\d+) \(inclusive\).*\])")))
    {
      const std::string most = match[3] == "4294967295" ? "" : " to " + match[3].str();
      const std::string length =
        match[2] == match[3] ? match[2].str() + " values"
        : match[2] == "0" && most.empty()
          ? "any number of values"
          : match[2].str() + (most.empty() ? " or more" : most) + " values";
      return length + " separated by commas, each " + allowed(match[1]);
    }
    return pattern;
  }

  void print_parameters(dealii::ParameterHandler &prm, std::ostream &out)
  {
    Path open;
    for_each_entry(declared(prm), [&](const Path &path, const Tree &entry) {
      const Path section(path.begin(), path.end() - 1);
      std::size_t common = 0;
      while (common < std::min(open.size(), section.size()) && open[common] == section[common])
        ++common;
      const auto indent = [&] { return std::string(2 * open.size(), ' '); };
      while (open.size() > common)
      {
        open.pop_back();
        out << indent() << "end\n\n";
      }
      while (open.size() < section.size())
      {
        out << indent() << "subsection " << section[open.size()] << '\n';
        open.push_back(section[open.size()]);
      }
      const std::string pattern = entry.get<std::string>("pattern_description");
      const std::string values  = pattern == "[Anything]" || pattern.compare(0, 9, "[FileName") == 0
                                    ? ""
                                    : "\nValue: " + allowed(pattern) + ".";
      std::istringstream lines(entry.get<std::string>("documentation") + values);
      for (std::string line; std::getline(lines, line);)
        for (const std::string &part : dealii::Utilities::break_text_into_lines(line, 94))
          if (!part.empty())
            out << indent() << "# " << part << '\n';
      out << indent() << "set " << path.back() << " = " << entry.get<std::string>("value") << '\n';
    });
    for (; !open.empty(); open.pop_back())
      out << std::string(2 * (open.size() - 1), ' ') << "end\n";
  }

  std::vector<ParameterFile::Entry> all_parameters(dealii::ParameterHandler &prm)
  {
    std::vector<ParameterFile::Entry> entries;
    for_each_entry(declared(prm), [&](const Path &path, const Tree &entry) {
      entries.emplace_back(join(path, "/"), entry.get<std::string>("value"));
    });
    return entries;
  }
} // namespace softcell
