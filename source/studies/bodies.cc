// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes the bodies of a study.

#include <softcell/studies/bodies.h>

#include <softcell/base/collective.h>

#include <sstream>

namespace softcell
{
  const Body &
  Bodies::get(const Parameters &parameters, Console &console, std::vector<std::string> &remarks)
  {
    std::string key;
    for (const auto &[name, value] : parameters.entries)
      if (name.rfind("Geometry/", 0) == 0)
        key += name + '=' + value + '\n';
    for (const unsigned int label : parameters.geometry.labels) // some come with materials
      key += std::to_string(label) + ' ';
    std::unique_ptr<Body> &body = bodies_[key];
    if (body)
      return *body;
    std::vector<std::string> news;
    // A file may be missing on some ranks' machines only.
    on_all(MPI_COMM_WORLD, [&] { body = make_body(parameters.geometry, news); });
    const auto [lower, upper] = body->bounding_box().get_boundary_points();
    std::ostringstream text;
    text.precision(4);
    text << "Body: " << parameters.geometry.type << ", " << body->volume() << " m^3 between ("
         << lower << ") and (" << upper << ") m";
    console.say(text.str());
    for (const std::string &remark : news)
      console.say("  " + remark);
    remarks.insert(remarks.end(), news.begin(), news.end());
    return *body;
  }
} // namespace softcell
