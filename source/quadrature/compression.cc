// SPDX-License-Identifier: LGPL-2.1-or-later
// The search for few points and weights by nonlinear least squares.

#include <softcell/quadrature/compression.h>

#include <deal.II/base/quadrature_lib.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace softcell
{
  namespace
  {
    using Eigen::ArrayXd, Eigen::ArrayXXd, Eigen::Matrix3d, Eigen::MatrixXd, Eigen::RowVector3d,
      Eigen::VectorXd;

    constexpr double exact           = 1e-11; // a misfit that is rounding
    constexpr double smallest_weight = 0.1;   // relative to the mean

    /// Legendre polynomials at points of [-1, 1], and their derivatives: (n_points, degree + 1).
    struct Legendre
    {
      Legendre(const ArrayXd &x, const unsigned int degree)
          : values(x.size(), degree + 1), slopes(x.size(), degree + 1)
      {
        values.col(0) = 1;
        slopes.col(0) = 0;
        values.col(1) = x;
        slopes.col(1) = 1;
        for (unsigned int k = 1; k < degree; ++k)
        {
          values.col(k + 1) =
            (2. * k + 1) / (k + 1) * x * values.col(k) - double(k) / (k + 1) * values.col(k - 1);
          slopes.col(k + 1) = slopes.col(k - 1) + (2. * k + 1) * values.col(k);
        }
      }

      ArrayXXd values, slopes;
    };

    /// Turns what is above the plane across an axis by an eighth of pi, and what is below it
    /// backwards. Keeps the covariance of points that have that of a cube.
    std::vector<Point> twisted(std::vector<Point> points, const unsigned int axis)
    {
      const unsigned int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (Point &p : points)
      {
        const double angle = p[axis] > 0.1 ? M_PI / 8 : p[axis] < -0.1 ? -M_PI / 8 : 0;
        const double pa = p[a], pb = p[b];
        p[a] = std::cos(angle) * pa - std::sin(angle) * pb;
        p[b] = std::sin(angle) * pa + std::cos(angle) * pb;
      }
      return points;
    }
  } // namespace

  Compression::Compression(const unsigned int degree) : degree_(degree)
  {
    const unsigned int n = 2 * degree;
    for (unsigned int x = 0; x <= n; ++x)
      for (unsigned int y = 0; y <= n; ++y)
        for (unsigned int z = 0; z <= n; ++z)
        {
          std::array<unsigned int, 3> d = {{x, y, z}};
          std::sort(d.begin(), d.end());
          if (d[1] < n || d[0] <= n - 2)
            moments_.push_back({x, y, z, d[2] <= degree && d[0] < degree});
        }

    const dealii::QGauss<3> gauss(degree + 1);
    start_weights_ = gauss.get_weights();
    std::vector<Point> points;
    for (const Point &q : gauss.get_points())
      points.emplace_back((q - Point(0.5, 0.5, 0.5)) * std::sqrt(12.));
    starts_ = {points, twisted(points, 0), twisted(points, 1), twisted(points, 2)};
  }

  /// Looks for one rule, in coordinates in which the box around the many points is [-1, 1]^3.
  /// Unknown are the coordinates x of all points, then all y, all z and all weights, the latter
  /// relative to their mean.
  class Compression::Search
  {
  public:
    Search(const Compression &rule,
           const std::vector<Point> &points,
           const std::vector<double> &weights)
        : rule_(rule),
          n_points_(rule.start_weights_.size()),
          volume_(std::accumulate(weights.begin(), weights.end(), 0.))
    {
      MatrixXd y(points.size(), 3);
      for (unsigned int q = 0; q < points.size(); ++q)
        y.row(q) << points[q][0], points[q][1], points[q][2];
      lower_ = y.colwise().minCoeff();
      upper_ = y.colwise().maxCoeff();
      edges_ = (upper_ - lower_).cwiseMax(1e-9); // all points may lie in a plane
      for (unsigned int d = 0; d < 3; ++d)
        y.col(d).array() = (2 * y.col(d).array() - lower_[d] - upper_[d]) / edges_[d];
      const VectorXd w = Eigen::Map<const VectorXd>(weights.data(), weights.size()) / volume_;

      target_ = moments(y, w);
      mean_   = w.transpose() * y;
      y.rowwise() -= mean_;
      const Matrix3d covariance = y.transpose() * w.asDiagonal() * y;
      const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
      root_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
              eigen.eigenvectors().transpose();
    }

    /// One of the starts.
    VectorXd start(const std::vector<Point> &points) const
    {
      MatrixXd v(n_points_, 4);
      for (unsigned int q = 0; q < n_points_; ++q)
        v.row(q) << mean_ + RowVector3d(points[q][0], points[q][1], points[q][2]) * root_,
          n_points_ * rule_.start_weights_[q];
      return bounded(v.reshaped());
    }

    /// Goes down to a minimum.
    /// @param factors on the misfits of the moments.
    VectorXd descend(VectorXd v, const VectorXd &factors) const
    {
      constexpr unsigned int max_iterations = 50;
      double damping                        = 1e-3;
      VectorXd residual                     = factors.cwiseProduct(misfits(v));
      for (unsigned int i = 0; i < max_iterations && residual.norm() > exact; ++i)
      {
        // transposed: (n_unknowns, n_moments)
        const MatrixXd J =
          free_derivatives(v, factors.cwiseProduct(residual)) * factors.asDiagonal();
        MatrixXd JJ = MatrixXd::Zero(J.cols(), J.cols());
        JJ.selfadjointView<Eigen::Lower>().rankUpdate(J.transpose());
        const double old           = residual.squaredNorm();
        constexpr double too_short = 1e3;
        bool is_lower              = false;
        for (; !is_lower && damping < too_short; damping *= is_lower ? 0.02 : 6)
        {
          MatrixXd damped = JJ;
          damped.diagonal().array() += damping;
          const VectorXd next = bounded(v - J * damped.llt().solve(residual));
          const VectorXd r    = factors.cwiseProduct(misfits(next));
          is_lower            = r.squaredNorm() < old;
          if (is_lower)
          {
            v        = next;
            residual = r;
          }
        }
        damping = std::max(damping, 1e-14);
        if (residual.squaredNorm() > 0.99 * old)
          break;
      }
      return v;
    }

    VectorXd misfits(const VectorXd &v) const
    {
      return moments(v.reshaped(n_points_, 4).leftCols(3), v.tail(n_points_) / n_points_) - target_;
    }

    void get(const VectorXd &v, std::vector<Point> &points, std::vector<double> &weights) const
    {
      points.resize(n_points_);
      weights.resize(n_points_);
      for (unsigned int q = 0; q < n_points_; ++q)
      {
        for (unsigned int d = 0; d < 3; ++d)
          points[q][d] = std::clamp((lower_[d] + upper_[d] + v[d * n_points_ + q] * edges_[d]) / 2,
                                    lower_[d], upper_[d]);
        weights[q] = v[3 * n_points_ + q] * volume_ / n_points_;
      }
    }

  private:
    /// @param y (n_points, 3)
    VectorXd moments(const MatrixXd &y, const ArrayXd &weights) const
    {
      const unsigned int n = 2 * rule_.degree_;
      const Legendre a(y.col(0), n), b(y.col(1), n), c(y.col(2), n);
      MatrixXd sums(n + 1, (n + 1) * (n + 1));
      for (unsigned int i = 0; i < sums.cols(); ++i)
        sums.col(i) = c.values.matrix().transpose() *
                      (weights * a.values.col(i / (n + 1)) * b.values.col(i % (n + 1))).matrix();

      VectorXd result(rule_.moments_.size());
      for (unsigned int m = 0; m < result.size(); ++m)
      {
        const Moment &d = rule_.moments_[m];
        result[m]       = sums(d.z, d.x * (n + 1) + d.y);
      }
      return result;
    }

    /// Derivatives (n_unknowns, n_moments) of the moments; 0 for an unknown at a bound that it
    /// would leave.
    /// @param force on the moments: the gradient is its product with the derivatives.
    MatrixXd free_derivatives(const VectorXd &v, const VectorXd &force) const
    {
      const unsigned int n = 2 * rule_.degree_, n_points = n_points_;
      const Legendre a(v.head(n_points), n), b(v.segment(n_points, n_points), n),
        c(v.segment(2 * n_points, n_points), n);
      const ArrayXd w = v.tail(n_points) / n_points;
      MatrixXd J(v.size(), target_.size());
      for (unsigned int m = 0; m < target_.size(); ++m)
      {
        const Moment &d = rule_.moments_[m];
        const auto x = a.values.col(d.x), y = b.values.col(d.y), z = c.values.col(d.z);
        J.col(m).array() << w * a.slopes.col(d.x) * y * z, w * x * b.slopes.col(d.y) * z,
          w * x * y * c.slopes.col(d.z), x * y * z / n_points;
      }
      const VectorXd pushed = bounded(v - 1e-6 * (J * force));
      for (unsigned int i = 0; i < v.size(); ++i)
        if (pushed[i] == v[i])
          J.row(i).setZero();
      return J;
    }

    VectorXd bounded(VectorXd v) const
    {
      auto places = v.head(3 * n_points_);
      places      = places.cwiseMax(-1).cwiseMin(1).eval();
      auto w      = v.tail(n_points_);
      w           = w.cwiseMax(smallest_weight).eval();
      return v;
    }

    const Compression &rule_;
    const unsigned int n_points_;
    const double volume_;
    RowVector3d lower_, upper_, edges_, mean_;
    Matrix3d root_; // of the covariance
    VectorXd target_;
  };

  double Compression::compress(std::vector<Point> &points, std::vector<double> &weights) const
  {
    if (points.size() <= start_weights_.size())
      return 0;

    VectorXd all(moments_.size()), of_one_gradient(moments_.size());
    for (unsigned int m = 0; m < moments_.size(); ++m)
    {
      const auto &[x, y, z, is_of_one_gradient] = moments_[m];
      all[m] = std::pow(0.5, x + y + z) * std::sqrt((2. * x + 1) * (2 * y + 1) * (2 * z + 1));
      of_one_gradient[m] = is_of_one_gradient ? all[m] : 0;
    }

    const Search search(*this, points, weights);
    VectorXd best;
    double misfit = std::numeric_limits<double>::max();
    for (const std::vector<Point> &start : starts_)
    {
      const VectorXd v = search.descend(search.start(start), all);
      const double m   = all.cwiseProduct(search.misfits(v)).norm();
      if (m < misfit)
      {
        misfit = m;
        best   = v;
      }
      if (misfit < 10 * exact || 4 * start.size() < moments_.size())
        break;
    }
    if (misfit >= 10 * exact)
      best = search.descend(best, of_one_gradient);
    // What changes where the body's boundary moves past one of the many points.
    const double unknown = *std::min_element(weights.begin(), weights.end()) /
                           std::accumulate(weights.begin(), weights.end(), 0.);
    if (of_one_gradient.cwiseProduct(search.misfits(best)).norm() > unknown)
      return 0;
    search.get(best, points, weights);
    return all.cwiseProduct(search.misfits(best)).norm();
  }
} // namespace softcell
