// SPDX-License-Identifier: LGPL-2.1-or-later
// What a ParameterHandler declares, as a tree of sections and entries.
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <boost/property_tree/ptree.hpp>

#include <functional>
#include <string>
#include <vector>

namespace softcell
{
  using Tree = boost::property_tree::ptree;

  /// Sections, then the entry's name.
  using Path = std::vector<std::string>;

  std::string join(const std::vector<std::string> &words, const std::string &separator);

  /// All that prm knows, with names as people write them.
  Tree declared(dealii::ParameterHandler &prm);

  bool is_entry(const Tree &node);

  /// The node of a section or entry, null if there is none.
  const Tree *find(const Tree &tree, const Path &path);

  /// Calls action(path, node) for every entry.
  void for_each_entry(const Tree &tree,
                      const std::function<void(const Path &, const Tree &)> &action,
                      const Path &path = {});

  /// What a pattern allows, in words.
  /// @param pattern  its description.
  std::string allowed(const std::string &pattern);
} // namespace softcell
