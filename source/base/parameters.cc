// SPDX-License-Identifier: LGPL-2.1-or-later
// Reading parameter files strictly, and printing every entry with its documentation.

#include <softcell/base/parameters.h>

#include "declared_parameters.h"

#include <softcell/base/collective.h>
#include <softcell/base/exceptions.h>
#include <softcell/base/files.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

namespace softcell
{
  namespace
  {
    void set_value(dealii::ParameterHandler &prm, const Path &path, const std::string &value)
    {
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        prm.enter_subsection(path[i]);
      try
      {
        prm.set(path.back(), value);
      }
      catch (...)
      {
        for (std::size_t i = 0; i + 1 < path.size(); ++i)
          prm.leave_subsection();
        throw;
      }
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        prm.leave_subsection();
    }

    std::size_t edit_distance(std::string a, std::string b)
    {
      for (std::string *text : {&a, &b})
        std::transform(text->begin(), text->end(), text->begin(),
                       [](const unsigned char c) { return std::tolower(c); });
      std::vector<std::size_t> row(b.size() + 1);
      std::iota(row.begin(), row.end(), 0);
      for (std::size_t i = 0; i < a.size(); ++i)
      {
        std::size_t diagonal = row[0];
        row[0]               = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j)
        {
          const std::size_t change = diagonal + (a[i] != b[j]);
          diagonal                 = row[j + 1];
          row[j + 1]               = std::min({row[j] + 1, row[j + 1] + 1, change});
        }
      }
      return row.back();
    }

    /// "; did you mean ...?" or what there is, for a path that prm does not know.
    std::string suggestion(const Tree &tree, const Path &path)
    {
      const Path section(path.begin(), path.end() - 1);
      const Tree *parent = find(tree, section);
      Path siblings;
      if (parent != nullptr)
        for (const auto &[name, node] : *parent)
          if (is_entry(node))
            siblings.push_back(name);
      if (const std::string near = nearest_word(path.back(), siblings); !near.empty())
        return "; did you mean '" + near + "'?";

      std::vector<std::string> names, paths;
      for_each_entry(tree, [&](const Path &known, const Tree &) {
        names.push_back(known.back());
        paths.push_back(join(known, "/"));
      });
      if (const std::string near = nearest_word(path.back(), names); !near.empty())
        return "; did you mean '" +
               paths[std::find(names.begin(), names.end(), near) - names.begin()] + "'?";
      return siblings.empty() ? "." : "; there are: " + join(siblings, ", ") + ".";
    }

    [[noreturn]] void
    refuse_unknown(const Tree &tree, const Path &path, const std::string &location)
    {
      for (std::size_t depth = 1; depth < path.size(); ++depth)
      {
        const Path section(path.begin(), path.begin() + depth);
        const Tree *node = find(tree, section);
        if (node == nullptr || is_entry(*node))
        {
          Path sections;
          for (const auto &child : *find(tree, Path(section.begin(), section.end() - 1)))
            if (!is_entry(child.second))
              sections.push_back(child.first);
          const std::string near = nearest_word(section.back(), sections);
          throw BadInput(location + ": there is no section '" + join(section, "/") + "'" +
                         (!near.empty()      ? "; did you mean '" + near + "'?"
                          : sections.empty() ? "; is an 'end' missing before it?"
                                             : "; there are: " + join(sections, ", ") + "."));
        }
      }
      const Path section(path.begin(), path.end() - 1);
      throw BadInput(
        location + ": there is no entry '" + path.back() + "' " +
        (section.empty() ? "outside the sections" : "in section " + join(section, "/")) +
        suggestion(tree, path));
    }

    /// Takes the line's first word away and returns it in lower case.
    std::string take_word(std::string &line)
    {
      const auto length = std::min(line.find_first_of(" \t"), line.size());
      std::string word  = line.substr(0, length);
      std::transform(word.begin(), word.end(), word.begin(),
                     [](const unsigned char c) { return std::tolower(c); });
      line = dealii::Utilities::trim(line.substr(length));
      return word;
    }

    /// The whole file, or BadInput.
    std::string read_file(const std::string &file)
    {
      check_file("The parameter file '" + file + "'", file);
      std::ifstream in(file, std::ios::binary);
      std::stringstream text;
      std::error_code error;
      constexpr auto largest = 1 << 20;
      if (std::filesystem::file_size(file, error) <= largest || error)
        text << in.rdbuf();
      std::string content = text.str();
      const bool is_text  = std::none_of(content.begin(), content.end(), [](const unsigned char c) {
        return (c < 32 && c != '\n' && c != '\r' && c != '\t') || c == 127;
      });
      if (content.empty() || !is_text)
        throw BadInput(
          "'" + file + "' is no parameter file: it " +
          (!is_text ? "holds bytes that are no text." : "is empty or larger than 1 MiB."));
      return content;
    }
  } // namespace

  ParameterFile::ParameterFile(const std::string &file,
                               const std::vector<std::string> &overrides,
                               MPI_Comm communicator)
      : file_(file)
  {
    std::string text;
    on_root(communicator, [&] { text = read_file(file); });
    read_text(dealii::Utilities::MPI::broadcast(communicator, text));
    for (const std::string &override_text : overrides)
      read_override(override_text);
  }

  void ParameterFile::read_text(const std::string &text)
  {
    using dealii::Utilities::trim;
    std::istringstream in(text);
    Path section;
    std::vector<std::string> opened; // where each section of the path began
    std::string line, joined;
    for (unsigned int number = 1; std::getline(in, line); ++number)
    {
      if (number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
        line.erase(0, 3); // the mark with which some editors begin UTF-8
      line = trim(line.substr(0, line.find('#')));
      if (!line.empty() && line.back() == '\\')
      {
        joined += line.substr(0, line.size() - 1);
        continue;
      }
      line = joined + line;
      joined.clear();
      const std::string location = file_ + ":" + std::to_string(number);
      if (line.empty())
        continue;
      std::string rest       = line;
      const std::string word = take_word(rest);
      const auto equals      = rest.find('=');
      const bool is_end      = word == "end" && rest.empty();
      if (word == "set" && equals != std::string::npos && !trim(rest.substr(0, equals)).empty())
      {
        Path path = section;
        path.push_back(trim(rest.substr(0, equals)));
        items_.push_back({path, trim(rest.substr(equals + 1)), location, false});
      }
      else if (word == "subsection" && !rest.empty())
      {
        section.push_back(rest);
        opened.push_back(location);
        Path path = section;
        path.emplace_back();
        items_.push_back({path, "", location, false});
      }
      else if (is_end && !section.empty())
      {
        section.pop_back();
        opened.pop_back();
      }
      else
        throw BadInput(
          location + ": " +
          (is_end ? "this 'end' closes nothing; remove it or add the 'subsection' before it."
           : word == "include"
             ? "'include' is not supported; put the entries into this file."
             : "'" + line.substr(0, 60) +
                 "' is not understood; a line is 'subsection NAME', 'set NAME = VALUE' or 'end'."));
    }
    if (!section.empty())
      throw BadInput(opened.back() + ": section '" + section.back() +
                     "' is never closed; add its 'end'.");
  }

  void ParameterFile::read_override(const std::string &text)
  {
    using dealii::Utilities::trim;
    const std::string location = "--set '" + text + "'";
    const auto equals          = text.find('=');
    if (equals == std::string::npos)
      throw BadInput(location + ": there is no '='; write --set 'Section/Entry = value'.");
    Path path = dealii::Utilities::split_string_list(text.substr(0, equals), '/');
    if (path.empty() || path.back().empty())
      throw BadInput(location + ": there is no entry's name; write --set 'Section/Entry = value'.");

    const auto same = [&](const Item &item) { return item.path == path; };
    const auto first =
      std::find_if(items_.begin(), items_.end(), same) - items_.begin(); // keeps the file's order
    items_.erase(std::remove_if(items_.begin(), items_.end(), same), items_.end());
    items_.insert(items_.begin() + first, {path, trim(text.substr(equals + 1)), location, false});
  }

  std::vector<std::string> ParameterFile::sections(const std::string &prefix) const
  {
    std::vector<std::string> names;
    for (const Item &item : items_)
      if (item.path.size() > 1 && item.path[0].compare(0, prefix.size(), prefix) == 0 &&
          std::find(names.begin(), names.end(), item.path[0]) == names.end())
        names.push_back(item.path[0]);
    return names;
  }

  std::vector<ParameterFile::Entry>
  ParameterFile::declare_free_entries(const std::string &section, dealii::ParameterHandler &prm)
  {
    std::vector<Entry> entries;
    prm.enter_subsection(section);
    const Tree tree = declared(prm);
    for (Item &item : items_)
      if (item.path.size() == 2 && item.path[0] == section && !item.path[1].empty() &&
          find(tree, item.path) == nullptr)
      {
        item.is_free = true;
        entries.emplace_back(item.path[1], item.value);
        prm.declare_entry(item.path[1], "");
      }
    prm.leave_subsection();
    return entries;
  }

  void ParameterFile::parse(dealii::ParameterHandler &prm) const
  {
    const Tree tree = declared(prm);
    std::map<Path, const Item *> seen;
    std::map<Path, std::string> values;
    for (const Item &item : items_)
    {
      const bool opens_section = item.path.back().empty();
      const Tree *node =
        find(tree, opens_section ? Path(item.path.begin(), item.path.end() - 1) : item.path);
      if (node == nullptr || is_entry(*node) == opens_section)
        refuse_unknown(tree, item.path, item.location);
      if (opens_section)
        continue;
      const auto [other, is_first] = seen.emplace(item.path, &item);
      if (!is_first && !item.is_free)
        throw BadInput(item.location + ": " + join(item.path, "/") + " is set already in " +
                       other->second->location + "; remove one of the two.");
      std::string &value = values[item.path];
      value              = is_first ? item.value : value + "; " + item.value;
      try
      {
        set_value(prm, item.path, value);
      }
      catch (const dealii::ExceptionBase &)
      {
        throw BadInput(item.location + ": " + join(item.path, "/") + " = '" + item.value +
                       "' is not allowed; give " +
                       allowed(node->get<std::string>("pattern_description")) + ".");
      }
    }
  }

  std::string nearest_word(const std::string &word, const std::vector<std::string> &known)
  {
    std::string nearest;
    std::size_t smallest = 1 + std::max<std::size_t>(2, word.size() / 3);
    for (const std::string &candidate : known)
      if (const std::size_t distance = edit_distance(word, candidate);
          distance < smallest && distance < candidate.size())
      {
        nearest  = candidate;
        smallest = distance;
      }
    return nearest;
  }
} // namespace softcell
