#pragma once

#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <grid_map_msgs/msg/grid_map.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>

namespace talus_ros2 {

/// Place and size of a grid map in its frame.
struct Window {
  double x_m, y_m, length_x_m, length_y_m, resolution_m = 0.5;
  std::uint16_t start_i = 0, start_j = 0;
};

/// A grid map as its publishers send it, frame "map", stamped as the tests' clock stands. By the definition of grid_map, the
/// middle of index (i, j), unwrapped, lies at position + (length - resolution) / 2 - (i, j) resolution, and layers are
/// stored column by column.
inline grid_map_msgs::msg::GridMap heightsOn(const Window& w,
                                             const std::function<double(double, double)>& height) {
  grid_map_msgs::msg::GridMap message;
  message.header.frame_id = "map";
  message.header.stamp.sec = static_cast<std::int32_t>(rclcpp::AnyNode::clock_s);
  message.info = {
      .resolution = w.resolution_m, .length_x = w.length_x_m, .length_y = w.length_y_m, .pose = {}};
  message.info.pose.position = {w.x_m, w.y_m, 0.0};
  message.outer_start_index = w.start_i;
  message.inner_start_index = w.start_j;
  message.layers = {"elevation"};
  message.data.resize(1);
  const auto rows = static_cast<std::uint32_t>(w.length_x_m / w.resolution_m + 0.5),
             columns = static_cast<std::uint32_t>(w.length_y_m / w.resolution_m + 0.5);
  auto& [layout, data] = message.data[0];
  layout.dim = {{"column_index", columns, rows * columns}, {"row_index", rows, rows}};
  data.resize(std::size_t{rows} * columns);
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j)
      data[(j + w.start_j) % columns * rows + (i + w.start_i) % rows] =
          static_cast<float>(height(w.x_m + 0.5 * (w.length_x_m - w.resolution_m) - i * w.resolution_m,
                                    w.y_m + 0.5 * (w.length_y_m - w.resolution_m) - j * w.resolution_m));
  return message;
}

/// The same of one height.
inline grid_map_msgs::msg::GridMap plateau(const Window& window, float height_m) {
  return heightsOn(window, [&](double, double) { return static_cast<double>(height_m); });
}

/// Wheel readings as sensor_msgs_py.point_cloud2.create_cloud() makes them: a field of eight bytes for each column.
inline sensor_msgs::msg::PointCloud2 wheelsMessage(const std::vector<std::string>& columns,
                                                   const std::vector<std::vector<double>>& rows) {
  sensor_msgs::msg::PointCloud2 message;
  message.header.frame_id = "map";
  message.header.stamp.sec = static_cast<std::int32_t>(rclcpp::AnyNode::clock_s);
  for (const std::string& name : columns)
    message.fields.push_back({name, static_cast<std::uint32_t>(8 * message.fields.size()), 8, 1});
  message.height = 1;
  message.width = static_cast<std::uint32_t>(rows.size());
  message.point_step = static_cast<std::uint32_t>(8 * columns.size());
  message.row_step = message.width * message.point_step;
  for (const auto& row : rows) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(row.data());
    message.data.insert(message.data.end(), bytes, bytes + message.point_step);
  }
  return message;
}

}  // namespace talus_ros2
