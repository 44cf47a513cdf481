// Exports talus_ros2::Nav2Planner to Nav2's planner server and talus_ros2::Nav2Layer to its costmaps.
#include <pluginlib/class_list_macros.hpp>

#include "nav2_layer.hpp"
#include "nav2_planner.hpp"

PLUGINLIB_EXPORT_CLASS(talus_ros2::Nav2Planner, nav2_core::GlobalPlanner)
PLUGINLIB_EXPORT_CLASS(talus_ros2::Nav2Layer, nav2_costmap_2d::Layer)
