// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the supports hold a body against all six rigid-body motions.

#include <softcell/loads/rigid_modes.h>

#include <softcell/discretization/connected_parts.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace softcell
{
  namespace
  {
    using Matrix = dealii::Tensor<2, 3>;

    /// "y" for a multiple of (0, 1, 0), else its components, the first of them positive.
    std::string direction_name(const Direction &d)
    {
      std::ostringstream components;
      components.precision(3);
      double sign = 0;
      for (unsigned int c = 0; c < 3; ++c)
      {
        if (std::abs(d[c]) > 1 - 1e-9)
          return std::string(1, "xyz"[c]);
        const bool is_zero = std::abs(d[c]) < 1e-9;
        if (sign == 0 && !is_zero)
          sign = d[c] > 0 ? 1 : -1;
        components << (c == 0 ? "(" : ", ") << (is_zero ? 0. : sign * d[c]);
      }
      return components.str() + ")";
    }

    /// The null space of a positive semi-definite matrix in words, empty if there is none.
    std::string null_space(const Matrix &matrix, const double tolerance)
    {
      const auto modes  = dealii::eigenvectors(dealii::symmetrize(matrix)); // descending
      const auto n_free = std::count_if(modes.begin(), modes.end(),
                                        [&](const auto &m) { return m.first <= tolerance; });
      if (n_free == 0)
        return "";
      if (n_free == 1)
        return direction_name(modes[2].second);
      if (n_free == 3)
        return "x, y and z";
      const std::string held = direction_name(modes[0].second);
      return held == "x"   ? "y and z"
             : held == "y" ? "x and z"
             : held == "z" ? "x and y"
                           : "every direction across " + held;
    }

    /// The inverse on the range.
    Matrix pseudo_inverse(const Matrix &matrix, const double tolerance)
    {
      Matrix inverse;
      for (const auto &[value, direction] : dealii::eigenvectors(dealii::symmetrize(matrix)))
        if (value > tolerance)
          inverse += dealii::outer_product(direction, direction) / value;
      return inverse;
    }
  } // namespace

  RigidModes::RigidModes(const Box &body)
      : centre_(body.center()),
        length_(body.get_boundary_points().first.distance(body.get_boundary_points().second) / 2)
  {
  }

  void RigidModes::hold(const Point &X, const unsigned int component)
  {
    const Direction r = (X - centre_) / length_;
    std::array<double, 6> h{};
    h[component] = 1;
    for (unsigned int k = 0; k < 3; ++k)
    {
      Direction axis;
      axis[k]  = 1;
      h[3 + k] = dealii::cross_product_3d(axis, r)[component];
    }
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        gram_[6 * i + j] += h[i] * h[j];
  }

  std::string RigidModes::free_motions(const MPI_Comm communicator, const std::string &what) const
  {
    std::array<double, 36> all;
    dealii::Utilities::MPI::sum(View<const double>(gram_), communicator, View<double>(all));
    Matrix translation, coupling, rotation; // the blocks of the Gram matrix
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
      {
        translation[i][j] = all[6 * i + j];
        coupling[i][j]    = all[6 * i + 3 + j];
        rotation[i][j]    = all[6 * (3 + i) + 3 + j];
      }
    // A free rotation may come with a translation: eliminate the translations that are held.
    const double tolerance = 1e-10 * (dealii::trace(translation) + dealii::trace(rotation));
    rotation -= transpose(coupling) * pseudo_inverse(translation, tolerance) * coupling;
    const std::string along = null_space(translation, tolerance);
    const std::string about = null_space(rotation, tolerance);
    if (along.empty() && about.empty())
      return "";
    return "the supports leave " + what + " free to " +
           (along.empty() ? "" : "move along " + along) +
           (along.empty() || about.empty() ? "" : " and to ") +
           (about.empty() ? "" : "turn about " + about) +
           "; add a clamp, displacement or springs in Loads.";
  }

  HeldParts::HeldParts(const Discretization &discretization, const Box &body)
      : discretization_(discretization), body_(body), parts_(connected_parts(discretization))
  {
  }

  void HeldParts::hold(const unsigned int node, const Point &X, const unsigned int component)
  {
    held_.try_emplace(parts_[node], body_).first->second.hold(X, component);
  }

  std::string HeldParts::free_motions() const
  {
    const MPI_Comm communicator = discretization_.communicator();
    const std::set<unsigned int> own(parts_.begin(),
                                     parts_.begin() + discretization_.n_owned_nodes());
    std::set<unsigned int> all;
    for (const auto &parts : dealii::Utilities::MPI::all_gather(
           communicator, std::vector<unsigned int>(own.begin(), own.end())))
      all.insert(parts.begin(), parts.end());
    for (const unsigned int part : all)
    {
      const auto held        = held_.find(part);
      const RigidModes modes = held == held_.end() ? RigidModes(body_) : held->second;
      std::string motion     = modes.free_motions(communicator, name_of(part, all.size()));
      if (!motion.empty())
        return motion;
    }
    return "";
  }

  std::string HeldParts::name_of(const unsigned int part, const std::size_t n_parts) const
  {
    if (n_parts == 1)
      return "the body";
    Point sum;
    double n = 0;
    for (unsigned int node = 0; node < discretization_.n_owned_nodes(); ++node)
      if (parts_[node] == part)
      {
        sum += discretization_.node_positions()[node];
        ++n;
      }
    const MPI_Comm communicator = discretization_.communicator();
    const Direction total       = dealii::Utilities::MPI::sum(Direction(sum), communicator);
    std::ostringstream name;
    name.precision(3);
    name << "one of the body's " << n_parts << " separate parts, around ("
         << total / dealii::Utilities::MPI::sum(n, communicator) << "),";
    return name.str();
  }
} // namespace softcell
