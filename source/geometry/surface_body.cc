// SPDX-License-Identifier: LGPL-2.1-or-later
// The body enclosed by a closed triangle surface: exact classification and exact volumes of boxes.

#include <softcell/geometry/surface_body.h>

#include <softcell/base/exceptions.h>
#include <softcell/geometry/shape.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

namespace softcell
{
  namespace
  {
    /// Integral of height(z) over the projection of a polygon to z = 0, positive where its normal
    /// points up; `height` is linear.
    template <class Height>
    double integrate_projection(const std::vector<Point> &polygon, const Height &height)
    {
      double integral = 0;
      for (unsigned int i = 2; i < polygon.size(); ++i)
      {
        const Direction a = polygon[i - 1] - polygon[0], b = polygon[i] - polygon[0];
        const double area = (a[0] * b[1] - a[1] * b[0]) / 2;
        integral += area * height((polygon[0][2] + polygon[i - 1][2] + polygon[i][2]) / 3);
      }
      return integral;
    }

    /// Some triangles of a surface, with their sides swapped if asked for.
    Surface selection(const Surface &surface,
                      const std::vector<unsigned int> &numbers,
                      const bool is_reversed)
    {
      TriangleList triangles;
      for (const unsigned int t : numbers)
      {
        auto [a, b, c] = surface.corners(t);
        if (is_reversed)
          std::swap(b, c);
        triangles.add(a, b, c, surface.patches()[t]);
      }
      return triangles.finish();
    }
  } // namespace

  /// What a closed part of the surface encloses.
  struct SurfaceBody::Part
  {
    Surface surface;                   // normals away from what is enclosed
    std::optional<unsigned int> patch; // of all triangles
    std::optional<unsigned int> label; // of the material just inside; none: a hole
    bool is_interface = false;         // between two materials
  };

  SurfaceBody::SurfaceBody(Surface surface)
      : surface_(std::move(surface)),
        bounding_box_(surface_.bounding_box()),
        volume_(surface_.volume())
  {
    Assert(volume_ > 0, dealii::ExcMessage("The surface's normals point inward."));
  }

  SurfaceBody::SurfaceBody(const Surface &surface,
                           const std::vector<unsigned int> &labels,
                           const std::string &name)
      : parts_(closed_parts(surface)),
        surface_(boundary(labels)),
        bounding_box_(surface_.bounding_box()),
        volume_(surface_.volume())
  {
    std::string patches;
    for (const Part &part : parts_)
      patches +=
        (patches.empty() ? "" : ", ") + (part.patch ? std::to_string(*part.patch) : "a mixture");
    names_.emplace_back("the rest");
    for (const unsigned int label : labels)
    {
      names_.push_back(std::to_string(label));
      if (std::none_of(parts_.begin(), parts_.end(),
                       [&](const Part &part) { return part.patch == label; }))
        throw BadInput(
          name + ": no closed part of the surface is of patch " + names_.back() +
          " alone, as 'Material " + names_.back() +
          "' or Geometry/Labels asks; the patches of its closed parts are: " + patches + ".");
    }
  }

  SurfaceBody::~SurfaceBody() = default;

  std::vector<SurfaceBody::Part> SurfaceBody::closed_parts(const Surface &surface)
  {
    // triangles that share vertices are of one part, which is named by one of its vertices
    std::vector<unsigned int> parent(surface.vertices().size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto part_of = [&](unsigned int v) {
      while (parent[v] != v)
        v = parent[v] = parent[parent[v]];
      return v;
    };
    for (const auto &[a, b, c] : surface.triangles())
    {
      parent[part_of(a)] = part_of(b);
      parent[part_of(b)] = part_of(c);
    }
    std::map<unsigned int, std::vector<unsigned int>> triangles_of;
    for (unsigned int t = 0; t < surface.triangles().size(); ++t)
      triangles_of[part_of(surface.triangles()[t][0])].push_back(t);

    std::vector<Part> parts;
    for (const auto &[part, numbers] : triangles_of)
    {
      Surface closed = selection(surface, numbers, false);
      if (closed.volume() < 0)
        closed = selection(surface, numbers, true);
      std::optional<unsigned int> patch = closed.patches()[0];
      if (std::count(closed.patches().begin(), closed.patches().end(), *patch) !=
          std::ptrdiff_t(closed.patches().size()))
        patch.reset();
      parts.push_back({std::move(closed), patch, {}, false});
    }
    std::sort(parts.begin(), parts.end(),
              [](const Part &a, const Part &b) { return a.surface.volume() < b.surface.volume(); });
    return parts;
  }

  Surface SurfaceBody::boundary(const std::vector<unsigned int> &labels)
  {
    TriangleList triangles;
    for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) // after what is around it
    {
      const Point &at   = part->surface.vertices()[0];
      const auto around = std::find_if(
        part.base(), parts_.end(), [&](const Part &larger) { return larger.surface.contains(at); });
      const auto outside = around == parts_.end() ? std::nullopt : around->label;
      const auto own =
        part->patch ? std::find(labels.begin(), labels.end(), *part->patch) : labels.end();
      if (own != labels.end())
        part->label = 1 + (own - labels.begin());
      else if (!outside)
        part->label = 0;

      part->is_interface = part->label && outside;
      for (unsigned int t = 0; !part->is_interface && t < part->surface.triangles().size(); ++t)
      {
        auto [a, b, c] = part->surface.corners(t);
        if (!part->label)
          std::swap(b, c);
        triangles.add(a, b, c, part->surface.patches()[t]);
        triangle_labels_.push_back(part->label ? *part->label : *outside);
      }
    }
    return triangles.finish();
  }

  unsigned int SurfaceBody::n_labels() const
  {
    return std::max<unsigned int>(1, names_.size());
  }

  unsigned int SurfaceBody::label(const Point &X) const
  {
    if (names_.empty())
      return 0;
    for (const Part &part : parts_)
      if (part.label && part.surface.contains(X))
        return *part.label;
    return triangle_labels_[surface_.nearest(X).second];
  }

  std::string SurfaceBody::label_name(const unsigned int label) const
  {
    return names_.empty() ? Body::label_name(label) : names_[label];
  }

  Box SurfaceBody::bounding_box() const
  {
    return bounding_box_;
  }

  bool SurfaceBody::contains(const Point &X) const
  {
    return surface_.contains(X);
  }

  Side SurfaceBody::classify(const Box &box) const
  {
    auto [lower, upper]       = box.get_boundary_points();
    const Direction clearance = 1e-9 * (upper - lower);
    const Box inner({lower + clearance, upper - clearance});
    if (surface_.meets(inner) || std::any_of(parts_.begin(), parts_.end(), [&](const Part &part) {
          return part.is_interface && part.surface.meets(inner);
        }))
      return Side::cut;
    return surface_.contains(box.center()) ? Side::inside : Side::outside;
  }

  double SurfaceBody::filled_volume(const Box &box) const
  {
    if (!surface_.meets(box))
      return surface_.contains(box.center()) ? box.volume() : 0;

    const auto [lower, upper] = box.get_boundary_points();
    const double ceiling      = upper[2];
    const double height       = upper[2] - lower[2];
    const Box column(
      {lower, Point(upper[0], upper[1], std::max(ceiling, bounding_box_.upper_bound(2)))});

    double volume = 0;
    for (const unsigned int triangle : surface_.triangles_in(column))
    {
      const auto corners = surface_.corners(triangle);
      volume +=
        integrate_projection(clip(corners, column), [&](double) { return height; }) -
        integrate_projection(clip(corners, box), [&](const double z) { return ceiling - z; });
    }
    return std::clamp(volume, 0., box.volume());
  }

  double SurfaceBody::volume() const
  {
    return volume_;
  }

  const Surface &SurfaceBody::surface() const
  {
    return surface_;
  }
} // namespace softcell
