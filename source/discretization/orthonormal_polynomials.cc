// SPDX-License-Identifier: LGPL-2.1-or-later
// Polynomials that are orthonormal under the quadrature of a cell.

#include <softcell/discretization/orthonormal_polynomials.h>

#include <cmath>

namespace softcell
{
  namespace
  {
    double power(const double x, const unsigned int exponent)
    {
      double result = 1;
      for (unsigned int i = 0; i < exponent; ++i)
        result *= x;
      return result;
    }

    double product(const View<const double> weights, const double *const a, const double *const b)
    {
      double sum = 0;
      for (unsigned int q = 0; q < weights.size(); ++q)
        sum += weights[q] * a[q] * b[q];
      return sum;
    }
  } // namespace

  void orthonormal_polynomials(const std::vector<Point> &points,
                               const View<const double> weights,
                               const unsigned int degree,
                               std::vector<double> &values)
  {
    const std::size_t begin = values.size(), n = points.size();
    for (unsigned int total = 0; total <= degree; ++total)
      for (unsigned int i = 0; i <= total; ++i)
        for (unsigned int j = 0; i + j <= total; ++j)
        {
          const std::size_t place = values.size();
          for (const Point &X : points)
          {
            const Direction x = X - points[0];
            values.push_back(power(x[0], i) * power(x[1], j) * power(x[2], total - i - j));
          }
          double *const next = values.data() + place;
          const double all   = product(weights, next, next);
          for (unsigned int repeat = 0; repeat < 2; ++repeat) // against rounding
            for (std::size_t other = begin; other < place; other += n)
            {
              const double part = product(weights, next, values.data() + other);
              for (std::size_t q = 0; q < n; ++q)
                next[q] -= part * values[other + q];
            }
          const double rest = product(weights, next, next);
          if (rest <= 1e-6 * all)
            values.resize(place);
          else
            for (std::size_t q = 0; q < n; ++q)
              next[q] /= std::sqrt(rest);
        }
  }
} // namespace softcell
