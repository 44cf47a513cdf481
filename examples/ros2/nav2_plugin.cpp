// Offers the planner to Nav2's planner server as talus_ros2::Nav2Planner.
#include <pluginlib/class_list_macros.hpp>

#include "nav2_planner.hpp"

PLUGINLIB_EXPORT_CLASS(talus_ros2::Nav2Planner, nav2_core::GlobalPlanner)
