// Shows   a route of Talus as messages: a path with headings, and a line coloured by category.
// Needs   talus::planner, nav_msgs, visualization_msgs.  Used by nav2_planner.cpp; usable in any node.
#pragma once

#include <nav_msgs/msg/path.hpp>
#include <visualization_msgs/msg/marker.hpp>

#include <talus/planner/planner.hpp>

namespace talus_ros2 {

/// Returns the route as a path with a pose at each vertex, and further poses, so that poses are at most
/// `spacing_m` > 0 apart. z is the elevation of the ground; on unobserved ground z is that of the previous
/// pose.
nav_msgs::msg::Path pathOf(const talus::planner::Route& route, const std_msgs::msg::Header& header,
                           double spacing_m);

/// Returns the poses of pathOf() as a line marker, coloured by the category of the motion: green safe, amber
/// marginal, red dangerous, grey unknown.
visualization_msgs::msg::Marker categoriesOf(const talus::planner::Route& route,
                                             const std_msgs::msg::Header& header, double spacing_m);

}  // namespace talus_ros2
