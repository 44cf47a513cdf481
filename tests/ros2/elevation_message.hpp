#pragma once

#include <grid_map_core/GridMap.hpp>
#include <grid_map_msgs/msg/grid_map.hpp>

namespace talus_ros2 {

/// A grid map as its publishers send it: each layer column by column, frame "map", stamped as the tests' clock stands.
inline grid_map_msgs::msg::GridMap messageOf(const grid_map::GridMap& map,
                                             const std::string& layer = "elevation") {
  grid_map_msgs::msg::GridMap message;
  message.header.frame_id = "map";
  message.header.stamp.sec = 7;
  message.info.resolution = map.getResolution();
  message.info.length_x = map.getSize()(0) * map.getResolution();
  message.info.length_y = map.getSize()(1) * map.getResolution();
  message.info.pose.position.x = map.getPosition().x();
  message.info.pose.position.y = map.getPosition().y();
  message.outer_start_index = static_cast<std::uint16_t>(map.getStartIndex()(0));
  message.inner_start_index = static_cast<std::uint16_t>(map.getStartIndex()(1));
  message.layers = {layer};
  std_msgs::msg::Float32MultiArray data;
  const grid_map::Matrix& heights = map.get(layer);
  data.layout.dim.resize(2);
  data.layout.dim[0].label = "column_index";
  data.layout.dim[0].size = static_cast<std::uint32_t>(heights.cols());
  data.layout.dim[1].label = "row_index";
  data.layout.dim[1].size = static_cast<std::uint32_t>(heights.rows());
  data.data.assign(heights.data(), heights.data() + heights.size());
  message.data = {data};
  return message;
}

/// The same of one height all over a rectangle around a place, in cells of half a metre.
inline grid_map_msgs::msg::GridMap plateau(const grid_map::Length& length_m, const grid_map::Position& middle,
                                           float height_m) {
  grid_map::GridMap map({"elevation"});
  map.setGeometry(length_m, 0.5, middle);
  map.get("elevation").setConstant(height_m);
  return messageOf(map);
}

}  // namespace talus_ros2
