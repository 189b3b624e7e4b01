// SPDX-License-Identifier: LGPL-2.1-or-later
// Elements of each kind and degree on a box of 2 x 1 x 1.5 m.
#pragma once

#include <softcell/discretization/fitted.h>
#include <softcell/discretization/hexahedral_mesh.h>
#include <softcell/discretization/tetrahedral_mesh.h>
#include <softcell/geometry/shapes.h>

#include <gtest/gtest.h>

namespace softcell::elements_on_a_box
{
  inline const Point size(2, 1, 1.5);
  inline const std::array<unsigned int, 3> n_cells = {{4, 2, 3}};
  inline const Region everywhere("everywhere", "1");

  struct Element
  {
    bool tetrahedra;
    unsigned int degree;
  };

  inline Fitted on_box(const Element &element, MPI_Comm communicator = MPI_COMM_WORLD)
  {
    const Mesh mesh = element.tetrahedra ? kuhn_box(size, n_cells) : hexahedral_box(size, n_cells);
    return Fitted(communicator, mesh, element.degree, *make_box(size));
  }

  inline double sum(const double value)
  {
    return dealii::Utilities::MPI::sum(value, MPI_COMM_WORLD);
  }

  inline const auto all_elements = testing::Values(Element{true, 1},
                                                   Element{true, 2},
                                                   Element{false, 1},
                                                   Element{false, 2},
                                                   Element{false, 3});

  inline std::string element_name(const testing::TestParamInfo<Element> &test)
  {
    return (test.param.tetrahedra ? "P" : "Q") + std::to_string(test.param.degree);
  }
} // namespace softcell::elements_on_a_box
