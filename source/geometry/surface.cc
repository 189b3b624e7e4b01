// SPDX-License-Identifier: LGPL-2.1-or-later
// Closed triangle surfaces: measures, clipping, and questions answered by a tree of boxes.

#include <softcell/geometry/surface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace softcell
{
  namespace
  {
    using Corners = std::array<Point, 3>;

    Direction area_vector(const Corners &t)
    {
      return 0.5 * cross_product_3d(t[1] - t[0], t[2] - t[0]);
    }

    /// a d - b c with a relative error of two roundings, hence of exact sign (Kahan; Jeannerod et
    /// al. 2013).
    double determinant(const double a, const double b, const double c, const double d)
    {
      const double bc    = b * c;
      const double error = std::fma(-b, c, bc);
      return std::fma(a, d, -bc) + error;
    }

    /// Is the triangle met by the half-line from the origin in the direction of z? The line is
    /// thought displaced by (e, e^2, 0) with an infinitesimal e > 0, so that it never meets an
    /// edge.
    bool is_above_origin(const Corners &t)
    {
      std::array<double, 3>
        weight; // twice the area between the origin and the edge against corner i
      unsigned int n_left = 0;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Point &a = t[(i + 1) % 3], &b = t[(i + 2) % 3];
        weight[i]       = determinant(a[0], a[1], b[0], b[1]);
        const bool left = weight[i] != 0 ? weight[i] > 0 : a[1] != b[1] ? a[1] > b[1] : b[0] > a[0];
        n_left += left;
      }
      if (n_left != 0 && n_left != 3)
        return false;
      const double moment = weight[0] * t[0][2] + weight[1] * t[1][2] + weight[2] * t[2][2];
      return n_left == 3 ? moment > 0 : moment < 0;
    }

    /// Separating axis test of a triangle and the box [-half, half].
    bool overlap(const Corners &t, const Direction &half)
    {
      const auto separated = [&](const Direction &axis) {
        const auto [low, high] = std::minmax({axis * t[0], axis * t[1], axis * t[2]});
        const double reach =
          half[0] * std::abs(axis[0]) + half[1] * std::abs(axis[1]) + half[2] * std::abs(axis[2]);
        return low > reach || high < -reach;
      };

      for (unsigned int d = 0; d < 3; ++d)
        if (std::min({t[0][d], t[1][d], t[2][d]}) > half[d] ||
            std::max({t[0][d], t[1][d], t[2][d]}) < -half[d])
          return false;
      if (separated(area_vector(t)))
        return false;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Direction e = t[(i + 1) % 3] - t[i];
        if (separated(Direction({0, -e[2], e[1]})) || separated(Direction({e[2], 0, -e[0]})) ||
            separated(Direction({-e[1], e[0], 0})))
          return false;
      }
      return true;
    }

    /// Nearest point of a triangle: the foot on its plane, or else the nearest of the feet on its
    /// edges.
    Point nearest_point(const Corners &t, const Point &X)
    {
      const Direction n = area_vector(t);
      Point nearest;
      double distance = std::numeric_limits<double>::infinity();
      bool over       = true;
      for (unsigned int i = 0; i < 3; ++i)
      {
        const Point &a       = t[i];
        const Direction edge = t[(i + 1) % 3] - a;
        const double length  = edge.norm_square();
        const double s       = length > 0 ? std::clamp((X - a) * edge / length, 0., 1.) : 0.;
        const Point foot     = a + s * edge;
        over                 = over && cross_product_3d(edge, X - a) * n > 0;
        if (const double d = X.distance_square(foot); d < distance)
        {
          distance = d;
          nearest  = foot;
        }
      }
      return over ? X - ((X - t[0]) * n / n.norm_square()) * n : nearest;
    }

    /// Convex polygon.
    struct Polygon
    {
      std::array<Point, 16> corners; // round-off can add to the nine
      unsigned int n = 0;
    };

    /// The part of a polygon where sign * (X[d] - bound) >= 0.
    Polygon
    clip(const Polygon &polygon, const unsigned int d, const double bound, const double sign)
    {
      Polygon result;
      for (unsigned int i = 0; i < polygon.n; ++i)
      {
        const Point &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.n];
        const double height_a = sign * (a[d] - bound), height_b = sign * (b[d] - bound);
        if (height_a >= 0)
          result.corners[result.n++] = a;
        if ((height_a > 0 && height_b < 0) || (height_a < 0 && height_b > 0))
        {
          Point crossing             = a + height_a / (height_a - height_b) * (b - a);
          crossing[d]                = bound;
          result.corners[result.n++] = crossing;
        }
      }
      return result;
    }
  } // namespace

  /// Binary tree of boxes over the triangles, halved at the median of their centres. The left child
  /// follows its parent; triangles are copied in the tree's order, for the memory's sake.
  class Surface::Tree
  {
  public:
    Tree(const std::vector<Point> &vertices, const std::vector<Triangle> &triangles)
        : numbers_(triangles.size())
    {
      std::iota(numbers_.begin(), numbers_.end(), 0);
      corners_.resize(triangles.size());
      std::vector<Point> centres(triangles.size());
      for (unsigned int t = 0; t < triangles.size(); ++t)
        for (const unsigned int v : triangles[t])
          centres[t] += vertices[v] / 3.;
      if (!triangles.empty())
        build(0, triangles.size(), vertices, triangles, centres);
    }

    struct Node
    {
      Point lower, upper;
      unsigned int n_triangles; // 0: an inner node
      unsigned int first;       // triangle in the tree's order, or number of the right child
    };

    const std::vector<Node> &nodes() const
    {
      return nodes_;
    }
    /// Number of a triangle in the surface and its corners, by its place in the tree's order.
    unsigned int number(const unsigned int place) const
    {
      return numbers_[place];
    }
    const Corners &corners(const unsigned int place) const
    {
      return corners_[place];
    }

    /// Calls visit(place) for the triangles of all leaves reached through nodes that pass
    /// enter(node), until `visit` returns true; returns whether it did.
    template <class Enter, class Visit>
    bool any_of(const Enter &enter, const Visit &visit) const
    {
      std::array<unsigned int, 64> stack; // twice the depth of a tree of 2^32 triangles
      unsigned int n = 0;
      if (!nodes_.empty())
        stack[n++] = 0;
      while (n > 0)
      {
        const unsigned int i = stack[--n];
        const Node &node     = nodes_[i];
        if (!enter(node))
          continue;
        for (unsigned int t = node.first; t < node.first + node.n_triangles; ++t)
          if (visit(t))
            return true;
        if (node.n_triangles == 0)
        {
          stack[n++] = node.first;
          stack[n++] = i + 1;
        }
      }
      return false;
    }

    /// As any_of, for the triangles that meet the closed box.
    template <class Visit>
    bool any_in(const Box &box, const Visit &visit) const
    {
      const auto [lower, upper] = box.get_boundary_points();
      const Point centre        = box.center();
      const Direction half      = 0.5 * (upper - lower);
      return any_of(
        [lower = lower, upper = upper](const Node &node) {
          for (unsigned int d = 0; d < 3; ++d)
            if (node.lower[d] > upper[d] || node.upper[d] < lower[d])
              return false;
          return true;
        },
        [&](const unsigned int t) {
          const Corners &c = corners_[t];
          return overlap({Point(c[0] - centre), Point(c[1] - centre), Point(c[2] - centre)},
                         half) &&
                 visit(numbers_[t]);
        });
    }

  private:
    void build(const unsigned int begin,
               const unsigned int end,
               const std::vector<Point> &vertices,
               const std::vector<Triangle> &triangles,
               const std::vector<Point> &centres)
    {
      const unsigned int leaf_size = 4;
      const unsigned int self      = nodes_.size();
      nodes_.push_back({vertices[triangles[numbers_[begin]][0]], {}, 0, begin});
      Node node  = nodes_.back();
      node.upper = node.lower;
      for (unsigned int t = begin; t < end; ++t)
        for (unsigned int i = 0; i < 3; ++i)
        {
          const Point &X = corners_[t][i] = vertices[triangles[numbers_[t]][i]];
          for (unsigned int d = 0; d < 3; ++d)
          {
            node.lower[d] = std::min(node.lower[d], X[d]);
            node.upper[d] = std::max(node.upper[d], X[d]);
          }
        }
      if (end - begin <= leaf_size)
        node.n_triangles = end - begin;
      else
      {
        const Direction size = node.upper - node.lower;
        const unsigned int d = size[0] > std::max(size[1], size[2]) ? 0 : size[1] > size[2] ? 1 : 2;
        const unsigned int split = (begin + end) / 2;
        std::nth_element(numbers_.begin() + begin, numbers_.begin() + split, numbers_.begin() + end,
                         [&](const unsigned int s, const unsigned int t) {
                           return centres[s][d] < centres[t][d];
                         });
        build(begin, split, vertices, triangles, centres);
        node.first = nodes_.size();
        build(split, end, vertices, triangles, centres);
      }
      nodes_[self] = node;
    }

    std::vector<Node> nodes_;
    std::vector<unsigned int> numbers_;
    std::vector<Corners> corners_;
  };

  Surface::Surface(std::vector<Point> vertices,
                   std::vector<Triangle> triangles,
                   std::vector<unsigned int> patches)
      : vertices_(std::move(vertices)),
        triangles_(std::move(triangles)),
        patches_(std::move(patches)),
        tree_(std::make_unique<Tree>(vertices_, triangles_))
  {
    if (patches_.empty())
      patches_.assign(triangles_.size(), 0);
    AssertDimension(patches_.size(), triangles_.size());
  }

  Surface::~Surface()                              = default;
  Surface::Surface(Surface &&) noexcept            = default;
  Surface &Surface::operator=(Surface &&) noexcept = default;

  std::array<Point, 3> Surface::corners(const unsigned int triangle) const
  {
    const Triangle &t = triangles_[triangle];
    return {vertices_[t[0]], vertices_[t[1]], vertices_[t[2]]};
  }

  Direction Surface::normal(const unsigned int triangle) const
  {
    const Direction n = area_vector(corners(triangle));
    return n / n.norm();
  }

  double Surface::area(const unsigned int triangle) const
  {
    return area_vector(corners(triangle)).norm();
  }

  double Surface::area() const
  {
    double area = 0;
    for (unsigned int t = 0; t < triangles_.size(); ++t)
      area += this->area(t);
    return area;
  }

  double Surface::volume() const
  {
    double volume = 0;
    for (unsigned int t = 0; t < triangles_.size(); ++t)
    {
      // from one of the vertices, lest a surface far from the origin lose digits
      const Corners c = corners(t);
      volume += area_vector(c) * (c[0] - vertices_[0]) / 3;
    }
    return volume;
  }

  Box Surface::bounding_box() const
  {
    if (tree_->nodes().empty())
      return Box();
    return Box({tree_->nodes()[0].lower, tree_->nodes()[0].upper});
  }

  bool Surface::contains(const Point &X) const
  {
    bool inside = false;
    tree_->any_of(
      [&](const Tree::Node &node) {
        return node.lower[0] <= X[0] && X[0] <= node.upper[0] && node.lower[1] <= X[1] &&
               X[1] <= node.upper[1] && X[2] <= node.upper[2];
      },
      [&](const unsigned int t) {
        const Corners &c = tree_->corners(t);
        inside ^= is_above_origin({Point(c[0] - X), Point(c[1] - X), Point(c[2] - X)});
        return false;
      });
    return inside;
  }

  std::vector<unsigned int> Surface::triangles_in(const Box &box) const
  {
    std::vector<unsigned int> result;
    tree_->any_in(box, [&](const unsigned int triangle) {
      result.push_back(triangle);
      return false;
    });
    return result;
  }

  bool Surface::meets(const Box &box) const
  {
    return tree_->any_in(box, [](const unsigned int) { return true; });
  }

  std::pair<Point, unsigned int> Surface::nearest(const Point &X) const
  {
    // A descent to the leaf that looks nearest gives a first bound, which prunes the search proper.
    const auto distance_to = [&](const Tree::Node &node) {
      double result = 0;
      for (unsigned int d = 0; d < 3; ++d)
        result += std::pow(std::max({node.lower[d] - X[d], 0., X[d] - node.upper[d]}), 2);
      return result;
    };

    std::pair<Point, unsigned int> result;
    double distance         = std::numeric_limits<double>::infinity();
    const auto try_triangle = [&](const unsigned int t) {
      const Point candidate = nearest_point(tree_->corners(t), X);
      const double d        = X.distance_square(candidate);
      if (d < distance)
      {
        distance = d;
        result   = {candidate, tree_->number(t)};
      }
      return false;
    };

    unsigned int leaf = 0;
    while (tree_->nodes()[leaf].n_triangles == 0)
    {
      const unsigned int left = leaf + 1, right = tree_->nodes()[leaf].first;
      leaf = distance_to(tree_->nodes()[left]) <= distance_to(tree_->nodes()[right]) ? left : right;
    }
    const Tree::Node &start = tree_->nodes()[leaf];
    for (unsigned int t = start.first; t < start.first + start.n_triangles; ++t)
      try_triangle(t);
    tree_->any_of([&](const Tree::Node &node) { return distance_to(node) < distance; },
                  try_triangle);
    return result;
  }

  std::vector<Point> clip(const std::array<Point, 3> &triangle, const Box &box)
  {
    const auto [lower, upper] = box.get_boundary_points();
    Polygon polygon;
    std::copy(triangle.begin(), triangle.end(), polygon.corners.begin());
    polygon.n = 3;
    for (unsigned int d = 0; d < 3; ++d)
    {
      const auto [low, high] = std::minmax({triangle[0][d], triangle[1][d], triangle[2][d]});
      if (low < lower[d])
        polygon = clip(polygon, d, lower[d], 1);
      if (high > upper[d])
        polygon = clip(polygon, d, upper[d], -1);
    }
    return {polygon.corners.begin(), polygon.corners.begin() + polygon.n};
  }
} // namespace softcell
