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
    using Eigen::Matrix3d, Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

    constexpr double exact                = 1e-11; // a misfit that is rounding
    constexpr double smallest_weight      = 0.1;   // relative to the mean
    constexpr unsigned int highest_degree = 16;    // of the polynomials

    /// Legendre polynomials of mean square 1 at a point of [-1, 1], and their derivatives.
    struct Legendre
    {
      Legendre(const double x, const unsigned int degree)
      {
        values[0] = 1;
        slopes[0] = 0;
        values[1] = x;
        slopes[1] = 1;
        for (unsigned int k = 1; k < degree; ++k)
        {
          values[k + 1] = ((2 * k + 1) * x * values[k] - k * values[k - 1]) / (k + 1);
          slopes[k + 1] = slopes[k - 1] + (2 * k + 1) * values[k];
        }
        for (unsigned int k = 1; k <= degree; ++k)
        {
          values[k] *= std::sqrt(2. * k + 1);
          slopes[k] *= std::sqrt(2. * k + 1);
        }
      }

      std::array<double, highest_degree + 1> values, slopes;
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
    Assert(n <= highest_degree, dealii::ExcInternalError());
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
  /// Unknown are, point after point, its coordinates and its weight relative to the mean.
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
      lower_ = upper_ = points[0];
      for (const Point &p : points)
        for (unsigned int d = 0; d < 3; ++d)
        {
          lower_[d] = std::min(lower_[d], p[d]);
          upper_[d] = std::max(upper_[d], p[d]);
        }

      std::vector<Vector3d> y;
      for (const Point &p : points)
        y.push_back(to_box(p));
      target_ = VectorXd::Zero(rule.moments_.size());
      for (unsigned int q = 0; q < y.size(); ++q)
      {
        add_moments(y[q], weights[q] / volume_, target_);
        mean_ += weights[q] / volume_ * y[q];
      }
      Matrix3d covariance = Matrix3d::Zero();
      for (unsigned int q = 0; q < y.size(); ++q)
        covariance += weights[q] / volume_ * (y[q] - mean_) * (y[q] - mean_).transpose();
      const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
      root_ = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
              eigen.eigenvectors().transpose();
    }

    /// One of the starts.
    VectorXd start(const std::vector<Point> &points) const
    {
      VectorXd v(4 * n_points_);
      for (unsigned int q = 0; q < n_points_; ++q)
      {
        v.segment<3>(4 * q) = mean_ + root_ * Vector3d(points[q][0], points[q][1], points[q][2]);
        v[4 * q + 3]        = n_points_ * rule_.start_weights_[q];
      }
      return bounded(v);
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
        const MatrixXd J  = factors.asDiagonal() * free_jacobian(v, factors.cwiseProduct(residual));
        const MatrixXd JJ = J * J.transpose();
        const double old  = residual.squaredNorm();
        constexpr double too_short = 1e12;
        bool is_lower              = false;
        for (; !is_lower && damping < too_short; damping *= is_lower ? 0.02 : 6)
        {
          MatrixXd damped = JJ;
          damped.diagonal().array() += damping;
          const VectorXd next = bounded(v - J.transpose() * damped.llt().solve(residual));
          const VectorXd r    = factors.cwiseProduct(misfits(next));
          is_lower            = r.squaredNorm() < old;
          if (is_lower)
          {
            v        = next;
            residual = r;
          }
        }
        damping = std::max(damping, 1e-14);
        if (residual.squaredNorm() > (1 - 1e-4) * old)
          break;
      }
      return v;
    }

    VectorXd misfits(const VectorXd &v) const
    {
      VectorXd result = -target_;
      for (unsigned int q = 0; q < n_points_; ++q)
        add_moments(v.segment<3>(4 * q), v[4 * q + 3] / n_points_, result);
      return result;
    }

    void get(const VectorXd &v, std::vector<Point> &points, std::vector<double> &weights) const
    {
      points.resize(n_points_);
      weights.resize(n_points_);
      for (unsigned int q = 0; q < n_points_; ++q)
      {
        for (unsigned int d = 0; d < 3; ++d)
          points[q][d] =
            std::clamp((lower_[d] + upper_[d] + v[4 * q + d] * edge(d)) / 2, lower_[d], upper_[d]);
        weights[q] = v[4 * q + 3] * volume_ / n_points_;
      }
    }

  private:
    double edge(const unsigned int d) const
    {
      return std::max(upper_[d] - lower_[d], 1e-9); // all points may lie in a plane
    }

    Vector3d to_box(const Point &p) const
    {
      Vector3d y;
      for (unsigned int d = 0; d < 3; ++d)
        y[d] = (2 * p[d] - lower_[d] - upper_[d]) / edge(d);
      return y;
    }

    void add_moments(const Vector3d &y, const double weight, VectorXd &moments) const
    {
      const unsigned int n = 2 * rule_.degree_;
      const Legendre a(y[0], n), b(y[1], n), c(y[2], n);
      for (unsigned int m = 0; m < moments.size(); ++m)
      {
        const Moment &d = rule_.moments_[m];
        moments[m] += weight * a.values[d.x] * b.values[d.y] * c.values[d.z];
      }
    }

    /// Derivatives of the moments; 0 for an unknown at a bound that it would leave.
    /// @param force on the moments, down the gradient.
    MatrixXd free_jacobian(const VectorXd &v, const VectorXd &residual) const
    {
      const unsigned int n = 2 * rule_.degree_;
      MatrixXd J(target_.size(), v.size());
      for (unsigned int q = 0; q < n_points_; ++q)
      {
        const Legendre a(v[4 * q], n), b(v[4 * q + 1], n), c(v[4 * q + 2], n);
        const double w = v[4 * q + 3] / n_points_;
        for (unsigned int m = 0; m < target_.size(); ++m)
        {
          const Moment &d = rule_.moments_[m];
          const double x = a.values[d.x], y = b.values[d.y], z = c.values[d.z];
          J.row(m).segment<4>(4 * q) << w * a.slopes[d.x] * y * z, w * x * b.slopes[d.y] * z,
            w * x * y * c.slopes[d.z], x * y * z / n_points_;
        }
      }
      const VectorXd gradient = J.transpose() * residual, pushed = bounded(v - 1e-6 * gradient);
      for (unsigned int i = 0; i < v.size(); ++i)
        if (pushed[i] == v[i])
          J.col(i).setZero();
      return J;
    }

    VectorXd bounded(VectorXd v) const
    {
      for (unsigned int i = 0; i < v.size(); ++i)
        v[i] = i % 4 == 3 ? std::max(v[i], smallest_weight) : std::clamp(v[i], -1., 1.);
      return v;
    }

    const Compression &rule_;
    const unsigned int n_points_;
    const double volume_;
    Point lower_, upper_;
    Vector3d mean_ = Vector3d::Zero();
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
      all[m]             = std::pow(0.5, moments_[m].x + moments_[m].y + moments_[m].z);
      of_one_gradient[m] = moments_[m].is_of_one_gradient ? all[m] : 0;
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
    search.get(best, points, weights);
    return all.cwiseProduct(search.misfits(best)).norm();
  }
} // namespace softcell
