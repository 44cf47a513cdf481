#include "route_messages.hpp"

#include <cmath>

namespace talus_ros2 {
namespace {

using talus::planner::RouteVertex;

// Calls `add` for each pose, with the vertex at which its motion begins.
template <typename Add>
void walk(const talus::planner::Route& route, double spacing_m, const Add& add) {
  geometry_msgs::msg::Pose pose;
  pose.position.z = 0.0;
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const RouteVertex& from = route.vertices[i];
    const RouteVertex& to = i + 1 < route.vertices.size() ? route.vertices[i + 1] : from;
    if (std::isfinite(from.elevation_m)) pose.position.z = from.elevation_m;
    pose.orientation.z = std::sin(0.5 * from.heading_rad);
    pose.orientation.w = std::cos(0.5 * from.heading_rad);
    const double length_m = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / spacing_m)));
    for (int k = 0; k < pieces; ++k) {
      pose.position.x = from.x_m + k * (to.x_m - from.x_m) / pieces;
      pose.position.y = from.y_m + k * (to.y_m - from.y_m) / pieces;
      add(pose, from);
    }
  }
}

std_msgs::msg::ColorRGBA colourOf(talus::terramech::Category category) {
  using talus::terramech::Category;
  const auto of = [](float r, float g, float b) {
    std_msgs::msg::ColorRGBA colour;
    colour.r = r;
    colour.g = g;
    colour.b = b;
    colour.a = 1.0F;
    return colour;
  };
  if (category == Category::Safe) return of(0.1F, 0.6F, 0.2F);
  if (category == Category::Marginal) return of(1.0F, 0.7F, 0.0F);
  if (category == Category::Dangerous) return of(0.8F, 0.1F, 0.1F);
  return of(0.5F, 0.5F, 0.5F);
}

}  // namespace

nav_msgs::msg::Path pathOf(const talus::planner::Route& route, const std_msgs::msg::Header& header,
                           double spacing_m) {
  nav_msgs::msg::Path path;
  path.header = header;
  walk(route, spacing_m, [&](const geometry_msgs::msg::Pose& pose, const RouteVertex&) {
    geometry_msgs::msg::PoseStamped stamped;
    stamped.header = header;
    stamped.pose = pose;
    path.poses.push_back(stamped);
  });
  return path;
}

visualization_msgs::msg::Marker categoriesOf(const talus::planner::Route& route,
                                             const std_msgs::msg::Header& header, double spacing_m) {
  visualization_msgs::msg::Marker line;
  line.header = header;
  line.ns = "talus_category";
  line.type = visualization_msgs::msg::Marker::LINE_STRIP;
  line.action = visualization_msgs::msg::Marker::ADD;
  line.pose.orientation.w = 1.0;
  line.scale.x = 0.1;
  walk(route, spacing_m, [&](const geometry_msgs::msg::Pose& pose, const RouteVertex& vertex) {
    line.points.push_back(pose.position);
    line.colors.push_back(colourOf(vertex.category));
  });
  return line;
}

}  // namespace talus_ros2
