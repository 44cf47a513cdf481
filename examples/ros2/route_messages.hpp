// Shows   a route of Talus as messages: a path with headings, and a line coloured by category.
// Needs   talus::planner, nav_msgs, visualization_msgs.  Used by nav2_planner.cpp; usable in any node.
#pragma once

#include <nav_msgs/msg/path.hpp>
#include <visualization_msgs/msg/marker.hpp>

#include <talus/planner/planner.hpp>

namespace talus_ros2 {

/// Returns a path with a pose at each vertex and at most `spacing_m` > 0 apart. z is the ground elevation; at
/// unobserved ground it is that of the previous pose.
nav_msgs::msg::Path pathOf(const talus::planner::Route& route, const std_msgs::msg::Header& header,
                           double spacing_m);

/// Returns the poses of pathOf() as a line: green where the motion is safe, amber marginal, red dangerous,
/// grey unknown.
visualization_msgs::msg::Marker categoriesOf(const talus::planner::Route& route,
                                             const std_msgs::msg::Header& header, double spacing_m);

}  // namespace talus_ros2
