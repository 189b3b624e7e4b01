// SPDX-License-Identifier: LGPL-2.1-or-later
// Reading parameter files strictly, and printing every entry with its documentation.
#pragma once

#include <deal.II/base/parameter_handler.h>

#include <mpi.h>

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace softcell
{
  /// The text of a parameter file in deal.II's format, and what the command line overrides in it.
  ///
  /// deal.II's ParameterHandler knows only declared entries. The text is therefore read before
  /// anything is declared: the sections whose entries the user names (Regions, Loads, Probes,
  /// `Material LABEL`) are asked for first and declared as found, then parse() hands all values
  /// over and says of everything else where it stands, what is wrong with it and what was probably
  /// meant.
  class ParameterFile
  {
  public:
    /// Name and value.
    using Entry = std::pair<std::string, std::string>;

    /// Rank 0 reads the file for all. Collective.
    /// @param overrides  each `Section/Entry = value`; takes the place of all entries of that name.
    /// @throws BadInput if the file cannot be read, is no text, or its sections do not close.
    explicit ParameterFile(const std::string &file,
                           const std::vector<std::string> &overrides = {},
                           MPI_Comm communicator                     = MPI_COMM_WORLD);

    /// Names of the sections on the top level that begin with `prefix`, each once, in order of
    /// appearance.
    std::vector<std::string> sections(const std::string &prefix) const;

    /// The entries of a section on the top level that prm does not know, in the file's order, and
    /// declares them there. A name may come several times; prm keeps such values joined by "; ".
    std::vector<Entry> declare_free_entries(const std::string &section,
                                            dealii::ParameterHandler &prm);

    /// Gives prm all values of the file. A fixed entry may be set once.
    /// @throws BadInput for an entry or section that prm does not know and for a value out of its
    /// pattern.
    void parse(dealii::ParameterHandler &prm) const;

  private:
    struct Item
    {
      std::vector<std::string>
        path; // sections, then the entry's name; empty name: the opening of a section
      std::string value;
      std::string location;
      bool is_free = false; // declared by declare_free_entries()
    };

    void read_text(const std::string &text);
    void read_override(const std::string &text);

    std::string file_;
    std::vector<Item> items_;
  };

  /// Writes every entry of prm with its default (here: current) value, unit and documentation as a
  /// parameter file.
  void print_parameters(dealii::ParameterHandler &prm, std::ostream &out);

  /// Every entry of prm as (Section/Entry, value), in the order of declaration.
  std::vector<ParameterFile::Entry> all_parameters(dealii::ParameterHandler &prm);

  /// The word of `known` that is nearest to `word` by edit distance, case aside; empty if none is
  /// near.
  std::string nearest_word(const std::string &word, const std::vector<std::string> &known);
} // namespace softcell
