// SPDX-License-Identifier: LGPL-2.1-or-later
// Which rigid-body motions are free.

#include <softcell/loads/rigid_modes.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    /// Holds all components of the points, each of which is known to one rank.
    std::string free_if_held(const std::vector<Point> &points)
    {
      const unsigned int n    = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
      const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
      RigidModes modes(Box({Point(1, 1, 1), Point(2, 2, 4)}));
      for (unsigned int k = rank; k < points.size(); k += n)
        for (unsigned int c = 0; c < 3; ++c)
          modes.hold(points[k], c);
      return modes.free_motions(MPI_COMM_WORLD, "the body");
    }

    bool says(const std::string &text, const std::string &part)
    {
      return text.find(part) != std::string::npos;
    }
  } // namespace

  TEST(RigidModes, CountsWhatPointsHold)
  {
    EXPECT_TRUE(
      says(free_if_held({}), "free to move along x, y and z and to turn about x, y and z;"));
    const std::string one = free_if_held({Point(1, 2, 1)});
    EXPECT_TRUE(says(one, "free to turn about x, y and z;")) << one;
    const std::string line = free_if_held({Point(1, 2, 1), Point(1, 2, 4), Point(1, 2, 3)});
    EXPECT_TRUE(says(line, "free to turn about z;")) << line;
    EXPECT_EQ(free_if_held({Point(1, 1, 1), Point(2, 1, 1), Point(1, 2, 1)}), "");
  }

  TEST(RigidModes, KnowsWhatSlides)
  {
    const std::vector<Point> face{Point(1, 1, 1), Point(2, 1, 1), Point(1, 2, 1), Point(2, 2, 1)};
    RigidModes table(Box({Point(1, 1, 1), Point(2, 2, 4)}));
    for (const Point &X : face)
      table.hold(X, 2);
    EXPECT_TRUE(says(table.free_motions(MPI_COMM_SELF, "the body"),
                     "free to move along x and y and to turn about z;"));
    table.hold(face[0], 0);
    table.hold(face[0], 1);
    EXPECT_TRUE(says(table.free_motions(MPI_COMM_SELF, "the body"), "free to turn about z;"));
    table.hold(face[1], 1);
    EXPECT_EQ(table.free_motions(MPI_COMM_SELF, "the body"), "");
  }

  TEST(RigidModes, NamesObliqueAxes)
  {
    const std::string text = free_if_held({Point(1, 1, 1), Point(2, 2, 1)});
    EXPECT_TRUE(says(text, "free to turn about (0.707, 0.707, 0);")) << text;
  }
} // namespace softcell
