// SPDX-License-Identifier: LGPL-2.1-or-later
// The entries of the section Loads, one for each region.

#include <softcell/loads/load_description.h>

#include <softcell/base/exceptions.h>
#include <softcell/base/parameters.h>
#include <softcell/loads/expression.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <sstream>

namespace softcell
{
  namespace
  {
    using Kind = LoadDescription::Kind;

    struct KindName
    {
      std::string name;
      Kind kind;
      unsigned int n_components;
      std::string usage;
    };

    const std::vector<KindName> kinds = {
      {"clamp", Kind::displacement, 3, "clamp"},
      {"displacement", Kind::displacement, 3, "displacement 0, free, 0.01 (m)"},
      {"traction", Kind::traction, 3, "traction 0, -30, 0 (Pa)"},
      {"pressure", Kind::pressure, 1, "pressure 1733 (Pa, inward)"},
      {"springs", Kind::springs, 1, "springs 1e6 (Pa/m)"}};

    /// "; did you mean 'x'?" if there is a near word.
    std::string suggestion(const std::string &word, const std::vector<std::string> &known)
    {
      const std::string nearest = nearest_word(word, known);
      return nearest.empty() ? "." : "; did you mean '" + nearest + "'?";
    }

    std::string joined(const std::vector<std::string> &words)
    {
      std::string text;
      for (const std::string &word : words)
        text += (text.empty() ? "" : ", ") + word;
      return text;
    }

    /// One load, `kind value`.
    LoadDescription parse_load(const std::string &region, const std::string &text)
    {
      const std::string place = "Loads/" + region + " = '" + text + "'";
      const auto end_of_word  = std::min(text.find_first_of(" \t"), text.size());
      const std::string word  = text.substr(0, end_of_word),
                        value = dealii::Utilities::trim(text.substr(end_of_word));

      std::vector<std::string> names, usages;
      for (const KindName &kind : kinds)
      {
        names.push_back(kind.name);
        usages.push_back("'" + kind.usage + "'");
      }
      const auto kind = std::find(names.begin(), names.end(), word) - names.begin();
      if (kind == std::ptrdiff_t(kinds.size()))
        throw BadInput(place + " names no kind of load; give for example " + joined(usages) +
                       suggestion(word, names));

      const bool is_clamp = word == "clamp";
      if (is_clamp && !value.empty())
        throw BadInput(place + " has a value, but a clamp takes none; for a given displacement "
                               "write 'displacement ux, uy, uz'.");
      const KindName &found = kinds[kind];
      LoadDescription load{region, found.kind, is_clamp ? "0, 0, 0" : value, place};
      if ((load.is_exact() && found.n_components == 3) ||
          ((load.is_of_reference() || load.is_path()) && word == "displacement"))
        return load;
      const Expression expression(load.value, found.n_components, place);
      unsigned int n_free = 0;
      for (unsigned int c = 0; c < found.n_components; ++c)
        n_free += expression.is_free(c);
      if (n_free > 0 && load.kind != Kind::displacement)
        throw BadInput(place + " has a component 'free', which only a displacement may have; "
                               "write 0.");
      if (n_free == found.n_components)
        throw BadInput(place + " leaves every component free; give at least one a value.");
      return load;
    }
  } // namespace

  std::vector<LoadDescription>
  parse_loads(const std::vector<std::pair<std::string, std::string>> &entries,
              const std::vector<Region> &regions)
  {
    std::vector<LoadDescription> loads;
    for (const auto &[name, text] : entries)
    {
      find_region(name, regions);
      std::istringstream parts(text);
      for (std::string part; std::getline(parts, part, ';');)
        if (!dealii::Utilities::trim(part).empty())
          loads.push_back(parse_load(name, dealii::Utilities::trim(part)));
      if (dealii::Utilities::trim(text).empty())
        throw BadInput("Loads/" + name +
                       " is empty; give a kind of load and its value, such as "
                       "'traction 0, -30, 0', or remove the entry.");
    }
    return loads;
  }

  const Region &find_region(const std::string &name, const std::vector<Region> &regions)
  {
    for (const Region &region : regions)
      if (region.name() == name)
        return region;
    std::vector<std::string> names;
    for (const Region &region : regions)
      names.push_back(region.name());
    throw BadInput("Loads/" + name + " names a region that the section Regions does not have (" +
                   (names.empty() ? "it is empty" : "it has " + joined(names)) +
                   "); define it there or mend the name" + suggestion(name, names));
  }
} // namespace softcell
