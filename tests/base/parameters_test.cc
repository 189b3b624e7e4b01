// SPDX-License-Identifier: LGPL-2.1-or-later
// Parameter files as users write them, right and wrong.

#include <softcell/base/exceptions.h>
#include <softcell/base/parameters.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace softcell;

namespace
{
  /// A parameter file that lives as long as this; each rank has its own.
  class TemporaryFile
  {
  public:
    explicit TemporaryFile(const std::string &text)
        : name_("parameters_test_" +
                std::to_string(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)) + ".prm")
    {
      std::ofstream(name_, std::ios::binary) << text;
    }
    ~TemporaryFile()
    {
      std::remove(name_.c_str());
    }
    const std::string &name() const
    {
      return name_;
    }

  private:
    std::string name_;
  };

  struct Handler
  {
    dealii::ParameterHandler prm;
    double young        = 5000;
    unsigned int levels = 3;
    std::string model = "linear", mode = "static";
    dealii::Point<3> gravity;

    Handler()
    {
      using namespace dealii::Patterns;
      prm.enter_subsection("Material");
      prm.add_parameter("Young modulus", young, "Units: Pa.", Double(0.));
      prm.add_parameter("Model", model, "Law.", Selection("linear|Neo-Hookean"));
      prm.leave_subsection();
      prm.enter_subsection("Discretization");
      prm.add_parameter("Cut levels", levels, "Halvings.", Integer(0, 10));
      prm.enter_subsection("Finite cell");
      prm.declare_entry("alpha", "0", Double(0., 1.), "Units: 1.");
      prm.leave_subsection();
      prm.leave_subsection();
      prm.enter_subsection("Loads");
      prm.add_parameter("Gravity", gravity, "Units: m/s^2.");
      prm.leave_subsection();
      prm.enter_subsection("Solver");
      prm.add_parameter("Mode", mode, "Of solving.", Selection("static"));
      prm.leave_subsection();
    }
  };

  /// What the user is told of this text, without the file's name.
  std::string complaint(const std::string &text, const std::vector<std::string> &overrides = {})
  {
    const TemporaryFile file(text);
    try
    {
      Handler handler;
      ParameterFile parameters(file.name(), overrides, MPI_COMM_SELF);
      parameters.declare_free_entries("Loads", handler.prm);
      parameters.parse(handler.prm);
    }
    catch (const BadInput &error)
    {
      const std::string message = error.what();
      return message.compare(0, file.name().size(), file.name()) == 0
               ? message.substr(file.name().size())
               : message;
    }
    return "";
  }
} // namespace

TEST(Parameters, Values)
{
  const TemporaryFile file(
    "# a comment\r\nsubsection Material # here too\n"
    "  set Young modulus = 4e3\n  set Model = \\\n  Neo-Hookean\nend\n"
    "subsection Discretization\nsubsection Finite cell\nset alpha = 0.5\nend\nend\n");
  Handler handler;
  ParameterFile parameters(file.name(), {"Discretization/Cut levels=2"}, MPI_COMM_SELF);
  parameters.parse(handler.prm);
  EXPECT_EQ(handler.young, 4000);
  EXPECT_EQ(handler.model, "Neo-Hookean");
  EXPECT_EQ(handler.levels, 2u);
  EXPECT_EQ(handler.prm.get(std::vector<std::string>{"Discretization", "Finite cell"}, "alpha"),
            "0.5");
}

TEST(Parameters, FreeNamesInOrder)
{
  const TemporaryFile file(
    "subsection Loads\nset top = traction 0, 0, 1\nset Gravity = 0, 0, -9.81\n"
    "set base = clamp\nset top = pressure 5\nend\nsubsection Material 85\nend\n"
    "subsection Material\nend\n");
  Handler handler;
  ParameterFile parameters(file.name(), {"Loads/base = displacement 0, 0, x <= 1"}, MPI_COMM_SELF);
  const std::vector<ParameterFile::Entry> expected = {
    {"top", "traction 0, 0, 1"}, {"base", "displacement 0, 0, x <= 1"}, {"top", "pressure 5"}};
  EXPECT_EQ(parameters.declare_free_entries("Loads", handler.prm), expected);
  EXPECT_EQ(parameters.sections("Material "), std::vector<std::string>{"Material 85"});
  handler.prm.enter_subsection("Material 85");
  handler.prm.leave_subsection();
  parameters.parse(handler.prm);
  EXPECT_EQ(handler.gravity[2], -9.81);
  EXPECT_EQ(handler.prm.get(std::vector<std::string>{"Loads"}, "top"),
            "traction 0, 0, 1; pressure 5");
}

TEST(Parameters, UnknownNames)
{
  EXPECT_EQ(
    complaint("subsection Material\nset Yung modulus = 1\nend"),
    ":2: there is no entry 'Yung modulus' in section Material; did you mean 'Young modulus'?");
  EXPECT_EQ(complaint("subsection Material\nset Cut levels = 1\nend"),
            ":2: there is no entry 'Cut levels' in section Material; did you mean "
            "'Discretization/Cut levels'?");
  EXPECT_EQ(complaint("subsection Material\nset colour = red\nend"),
            ":2: there is no entry 'colour' in section Material; there are: Young modulus, Model.");
  EXPECT_EQ(complaint("subsection Materials\nset Model = linear\nend"),
            ":1: there is no section 'Materials'; did you mean 'Material'?");
  EXPECT_EQ(complaint("set Model = linear"),
            ":1: there is no entry 'Model' outside the sections; did you mean 'Material/Model'?");
  EXPECT_EQ(
    complaint("subsection Discretization\nset Finite cell = 1\nend"),
    ":2: there is no entry 'Finite cell' in section Discretization; there are: Cut levels.");
  EXPECT_EQ(
    complaint("# nothing", {"Material/Modell = linear"}),
    "--set 'Material/Modell = linear': there is no entry 'Modell' in section Material; did you "
    "mean 'Model'?");
}

TEST(Parameters, ValuesOutOfPattern)
{
  EXPECT_EQ(complaint("subsection Material\nset Young modulus = -5\nend"),
            ":2: Material/Young modulus = '-5' is not allowed; give a number of at least 0.");
  EXPECT_EQ(complaint("subsection Material\nset Model = rubber\nend"),
            ":2: Material/Model = 'rubber' is not allowed; give one of linear, Neo-Hookean.");
  EXPECT_EQ(
    complaint("# nothing", {"Discretization/Cut levels = 1.5"}),
    "--set 'Discretization/Cut levels = 1.5': Discretization/Cut levels = '1.5' is not allowed; "
    "give a whole number from 0 to 10.");
  EXPECT_EQ(complaint("subsection Solver\nset Mode = dynamic\nend"),
            ":2: Solver/Mode = 'dynamic' is not allowed; give static, the only choice of this "
            "version.");
  EXPECT_EQ(
    complaint("subsection Loads\nset Gravity = 0, 1\nend"),
    ":2: Loads/Gravity = '0, 1' is not allowed; give 3 values separated by commas, each a number.");
}

TEST(Parameters, BrokenText)
{
  EXPECT_EQ(complaint("subsection Material\n"),
            ":1: section 'Material' is never closed; add its 'end'.");
  EXPECT_EQ(complaint("end\n"),
            ":1: this 'end' closes nothing; remove it or add the 'subsection' before it.");
  EXPECT_NE(complaint("\ninclude other.prm\n").find(":2: 'include' is not supported"),
            std::string::npos);
  EXPECT_EQ(complaint("subsection Loads\nsubsection Solver\nend\nend"),
            ":2: there is no section 'Loads/Solver'; is an 'end' missing before it?");
  EXPECT_EQ(complaint("subsection Material\n set Colour = " + std::string(100000, 'x') + "\nend")
              .find(":2: there is no entry 'Colour'"),
            0u);
  EXPECT_NE(complaint("set   = 3\n").find(":1: 'set   = 3' is not understood"), std::string::npos);
  EXPECT_NE(complaint("Young = 3\n").find(":1: 'Young = 3' is not understood"), std::string::npos);
  EXPECT_NE(complaint(std::string("set\0x", 5)).find("bytes that are no text"), std::string::npos);
  EXPECT_NE(complaint("").find("is empty"), std::string::npos);
  EXPECT_EQ(complaint("subsection Material\nset Model = linear\nset Model = linear\nend")
              .find(":3: Material/Model is set already in "),
            0u);
  EXPECT_NE(complaint("# nothing", {"Model"}).find("there is no '='"), std::string::npos);
  EXPECT_THROW(ParameterFile("no/such.prm", {}, MPI_COMM_SELF), BadInput);
  EXPECT_THROW(ParameterFile(std::filesystem::temp_directory_path(), {}, MPI_COMM_SELF), BadInput);
}

TEST(Parameters, PrintedFormReadsBack)
{
  Handler original;
  original.prm.enter_subsection("Material");
  original.prm.set("Model", "Neo-Hookean");
  original.prm.leave_subsection();
  std::ostringstream printed;
  print_parameters(original.prm, printed);
  EXPECT_NE(printed.str().find("  # Units: Pa.\n  # Value: a number of at least 0.\n"
                               "  set Young modulus = 5000\n"),
            std::string::npos);

  const TemporaryFile file(printed.str());
  Handler copy;
  ParameterFile(file.name(), {}, MPI_COMM_SELF).parse(copy.prm);
  EXPECT_EQ(copy.model, "Neo-Hookean");
  EXPECT_EQ(all_parameters(copy.prm), all_parameters(original.prm));
  EXPECT_EQ(all_parameters(copy.prm)[0], (ParameterFile::Entry{"Material/Young modulus", "5000"}));
}
