// SPDX-License-Identifier: LGPL-2.1-or-later
// Cells against those that the body's shape allows.

#include <softcell/base/exceptions.h>
#include <softcell/discretization/background_grid.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

namespace softcell
{
  namespace
  {
    BackgroundGrid make_grid(const Body &body, const GridParameters &parameters)
    {
      return BackgroundGrid(parameters, body, 10, MPI_COMM_WORLD);
    }

    GridParameters across(const std::vector<unsigned int> &cells)
    {
      GridParameters parameters;
      parameters.cells = cells;
      return parameters;
    }

    std::size_t count(const BackgroundGrid &grid)
    {
      return dealii::Utilities::MPI::sum(grid.cells().size(), MPI_COMM_WORLD);
    }
  } // namespace

  TEST(BackgroundGrid, HasTheCellsAskedFor)
  {
    const auto body = make_box(Point(0.1, 0.1, 0.6));
    EXPECT_EQ(count(make_grid(*body, across({4}))), 4u * 4 * 24);
    EXPECT_EQ(count(make_grid(*body, across({3, 5, 7}))), 3u * 5 * 7);
    GridParameters parameters = across({4});
    parameters.cell_size      = 0.05;
    EXPECT_EQ(count(make_grid(*body, parameters)), 2u * 2 * 12);
    parameters.padding = 0.025; // the body starts and ends in the middle of a cell
    EXPECT_EQ(count(make_grid(*body, parameters)), 3u * 3 * 13);
  }

  TEST(BackgroundGrid, EnlargesLongSidesOnBothEnds)
  {
    const auto body = make_box(Point(1, 1.1, 2));
    const auto grid = make_grid(*body, across({3}));
    EXPECT_NEAR(grid.lattice().origin.distance(Point(0, 0.55 - 2. / 3, 0)), 0, 1e-14);
    EXPECT_EQ(count(grid), 3u * 4 * 6);
    for (const BackgroundGrid::Cell &cell : grid.cells())
    {
      const bool is_end = cell.place.lower[1] == 0 || cell.place.lower[1] == 3;
      EXPECT_EQ(cell.side, is_end ? Side::cut : Side::inside);
    }
  }

  TEST(BackgroundGrid, KeepsTheCellsThatABallMeets)
  {
    const double r          = 0.07;
    const auto body         = make_sphere(r);
    GridParameters given    = across({9});
    given.scale             = 1.1;
    const auto grid         = make_grid(*body, given);
    const double h          = 2.2 * r / 9;
    unsigned int n_expected = 0, n_cut = 0, n_cut_expected = 0;
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j)
        for (int k = 0; k < 9; ++k)
        {
          double near = 0, far = 0;
          for (const int l : {i, j, k})
          {
            const double a = -1.1 * r + l * h, b = a + h;
            near += std::pow(std::max({a, -b, 0.}), 2);
            far += std::pow(std::max(std::abs(a), std::abs(b)), 2);
          }
          n_expected += near < r * r;
          n_cut_expected += near < r * r && far > r * r;
        }
    for (const BackgroundGrid::Cell &cell : grid.cells())
      n_cut += cell.side == Side::cut;
    EXPECT_EQ(count(grid), n_expected);
    EXPECT_EQ(dealii::Utilities::MPI::sum(n_cut, MPI_COMM_WORLD), n_cut_expected);

    given.smallest_volume_fraction = 0.5;
    EXPECT_LT(count(make_grid(*body, given)), n_expected);
  }

  TEST(BackgroundGrid, RefinesAllCutCells)
  {
    const auto body          = make_sphere(1);
    GridParameters given     = across({8});
    given.surface_refinement = 2;
    const auto grid          = make_grid(*body, given);
    std::array<unsigned int, 5> of_size{};
    double volume = 0;
    for (const BackgroundGrid::Cell &cell : grid.cells())
    {
      ++of_size[cell.place.size];
      volume += grid.lattice().box(cell.place).volume();
      EXPECT_TRUE(cell.place.size == 1 || cell.side == Side::inside);
    }
    for (unsigned int &n : of_size)
      n = dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD);
    EXPECT_GT(of_size[1], 0u);
    EXPECT_GT(of_size[2], 0u);
    EXPECT_GT(of_size[4], 0u);
    // the ball and a layer that its surface cuts
    const double ball = 4. / 3 * M_PI;
    volume            = dealii::Utilities::MPI::sum(volume, MPI_COMM_WORLD);
    EXPECT_GT(volume, ball);
    EXPECT_LT(volume, ball * std::pow(1 + std::sqrt(3.) / 16, 3));
  }

  TEST(BackgroundGrid, SaysWhatIsWrong)
  {
    const auto body = make_box(Point(1, 1, 1));
    EXPECT_THROW(make_grid(*body, across({2, 3})), BadInput);
    EXPECT_THROW(make_grid(*body, across({3000})), BadInput);
    GridParameters tiny = across({4});
    tiny.cell_size      = 1e-9;
    EXPECT_THROW(make_grid(*body, tiny), BadInput);
    GridParameters picky           = across({1});
    picky.scale                    = 2;
    picky.smallest_volume_fraction = 0.5;
    EXPECT_THROW(make_grid(*body, picky), BadInput);
  }

  TEST(Lattice, CountsBelowZeroToo)
  {
    Lattice lattice;
    lattice.origin  = Point(1, 1, 1);
    lattice.spacing = Point(0.5, 0.5, 0.5);
    EXPECT_EQ(lattice.index(Point(0.9, 1.1, 2.6)), (Lattice::Index{{-1, 0, 3}}));
    EXPECT_EQ(Lattice::ancestor({{-1, 0, 3}}, 2).lower, (Lattice::Index{{-2, 0, 2}}));
    EXPECT_NE(Lattice::key({{{0, 0, 2}}, 2}), Lattice::key({{{0, 0, 2}}, 1}));
  }
} // namespace softcell
