// SPDX-License-Identifier: LGPL-2.1-or-later
// run.json: what was run, with what, where and for how long.

#include <softcell/output/run_record.h>

#include <softcell/base/files.h>
#include <softcell/base/version.h>
#include <softcell/output/commit.h>

#include <deal.II/base/mpi.h>

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>

#include <CGAL/version.h>
#include <mpi.h>
#include <petscversion.h>
#include <unistd.h>
#include <vtkVersionMacros.h>

#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>

namespace softcell
{
  namespace
  {
    std::string json_string(const std::string &text)
    {
      std::string result = "\"";
      for (const char c : text)
        if (c == '"' || c == '\\')
          result += std::string("\\") + c;
        else if (static_cast<unsigned char>(c) < 32)
        {
          char code[8];
          std::snprintf(code, sizeof(code), "\\u%04x", static_cast<unsigned int>(c));
          result += code;
        }
        else
          result += c;
      return result + '"';
    }

    std::string number(const double value)
    {
      if (!std::isfinite(value))
        return "null";
      char text[32];
      std::snprintf(text, sizeof(text), "%.6g", value);
      return text;
    }

    using Members = std::vector<std::pair<std::string, std::string>>; // name and JSON value

    std::string object(const Members &members, const std::string &indent)
    {
      std::string text = "{";
      for (std::size_t i = 0; i < members.size(); ++i)
        text += (i == 0 ? "\n" : ",\n") + indent + "  " + json_string(members[i].first) + ": " +
                members[i].second;
      return text + '\n' + indent + '}';
    }

    std::string triple(const int major, const int minor, const int patch)
    {
      return json_string(std::to_string(major) + '.' + std::to_string(minor) + '.' +
                         std::to_string(patch));
    }

    Members libraries()
    {
      char mpi[MPI_MAX_LIBRARY_VERSION_STRING];
      int length = 0;
      MPI_Get_library_version(mpi, &length);
      return {{"deal.II", json_string(DEAL_II_PACKAGE_VERSION)},
              {"CGAL", json_string(CGAL_VERSION_STR)},
              {"VTK", triple(VTK_MAJOR_VERSION, VTK_MINOR_VERSION, VTK_BUILD_VERSION)},
              {"Trilinos", triple(DEAL_II_TRILINOS_VERSION_MAJOR, DEAL_II_TRILINOS_VERSION_MINOR,
                                  DEAL_II_TRILINOS_VERSION_SUBMINOR)},
              {"PETSc", triple(PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR)},
              {"MPI", json_string(mpi)},
              {"compiler", json_string(__VERSION__)}};
    }
  } // namespace

  std::string json(const RunRecord &record)
  {
    char host[256] = "";
    gethostname(host, sizeof(host) - 1);
    char date[32];
    const std::time_t now = std::time(nullptr);
    std::strftime(date, sizeof(date), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));

    Members parameters;
    for (const auto &[name, value] : record.parameters)
      parameters.emplace_back(name, json_string(value));
    std::string remarks;
    for (const std::string &remark : record.remarks)
      remarks += (remarks.empty() ? "" : ", ") + json_string(remark);

    Members residuals;
    for (const auto &[name, values] : record.linear_residuals)
    {
      std::string list;
      for (const double value : values)
        list += (list.empty() ? "" : ", ") + number(value);
      residuals.emplace_back(name, "[" + list + "]");
    }

    return object({{"program", json_string("softcell")},
                   {"version", json_string(version)},
                   {"commit", json_string(commit)},
                   {"command_line", json_string(record.command_line)},
                   {"status", json_string(record.status)},
                   {"message", json_string(record.message)},
                   {"written", json_string(date)},
                   {"host", json_string(host)},
                   {"ranks", std::to_string(record.ranks)},
                   {"wall_s", number(record.wall_s)},
                   {"remarks", "[" + remarks + "]"},
                   {"linear_residuals", object(residuals, "  ")},
                   {"libraries", object(libraries(), "  ")},
                   {"parameters", object(parameters, "  ")}},
                  "") +
           '\n';
  }

  void write_run_record(const std::string &file, const RunRecord &record)
  {
    write_file(file, json(record));
  }

  namespace
  {
    bool has_status(const std::string &file, const std::string &status)
    {
      boost::property_tree::ptree tree;
      try
      {
        boost::property_tree::read_json(file, tree);
      }
      catch (const boost::property_tree::json_parser_error &) // none, or damaged
      {
      }
      return tree.get("status", "") == status;
    }
  } // namespace

  void write_failure(const std::string &file, const RunRecord &record)
  {
    try
    {
      if (has_status(file, record.status))
        return;
      // other ranks may write at this moment
      const std::string mine =
        file + '.' + std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
      write_run_record(mine, record);
      std::filesystem::rename(mine, file);
    }
    catch (const std::exception &) // the error that is to be recorded matters more
    {
    }
  }

  std::vector<double> read_linear_residuals(const std::string &file)
  {
    std::vector<double> residuals;
    try
    {
      boost::property_tree::ptree tree;
      boost::property_tree::read_json(file, tree);
      const auto &cases = tree.get_child("linear_residuals");
      if (!cases.empty())
        for (const auto &entry : cases.front().second)
          residuals.push_back(entry.second.get_value<double>());
    }
    catch (const boost::property_tree::ptree_error &)
    {
      residuals.clear();
    }
    return residuals;
  }
} // namespace softcell
