#pragma once

#include <any>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <rclcpp/rclcpp.hpp>
#include <unistd.h>

#include <talus/planner/planner.hpp>

#include "example_messages.hpp"
#include "map_node.hpp"

namespace talus_ros2 {

/// Level regolith, 40 m x 20 m, cells of 0.5 m from (-5, 3) on, with a wall at x 10 to 11.5 that is open north of y = 18;
/// `closed`: all the way.
inline talus::costmap::TraversabilityMap smallSite(bool closed = false) {
  const talus::maps::Grid grid{.width = 80, .height = 40, .resolution_m = 0.5, .south_west = {-5.0, 3.0}};
  talus::costmap::MapLayers layers;
  layers.elevation.elevation_m = talus::maps::Raster<float>(grid, 0.0F);
  layers.keep_out = talus::maps::Raster<std::uint8_t>(grid, 0);
  for (int row = 0; row < (closed ? 40 : 30); ++row)
    for (int column = 30; column < 33; ++column) layers.keep_out[{column, row}] = 1;
  talus::terramech::Rover rover;
  rover.name = "micro-rover";
  rover.mass_kg = 90.0;
  rover.gravity_m_s2 = 1.62;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = 0.9;
  rover.track_m = 0.8;
  rover.clearance_m = 0.2;
  rover.max_torque_Nm = 40.0;
  talus::terramech::Soil soil;
  soil.name = "regolith";
  soil.cohesion_Pa = 170.0;
  soil.friction_angle_rad = 0.61;
  soil.cohesive_modulus = 1400.0;
  soil.frictional_modulus = 820000.0;
  return {std::move(layers),
          std::make_shared<const talus::costmap::GroundModel>(
              talus::costmap::GroundModel::Parts{.rover = rover, .classes = {{.soil = soil}}, .policy = {}}),
          {}};
}

/// What the tests of the map and of its views have: a map of the small site in a file, and topics.
class RosTest : public testing::Test {
 protected:
  void SetUp() override {
    tf2_ros::Buffer::known.clear();
    rclcpp::Node::overrides = {{"elevation_topic", std::string("elevation_map")},
                               {"wheel_topic", std::string("wheels")},
                               {"map_file", file_}};
    talus::costmap::writeMap(smallSite(), file_);
  }
  void TearDown() override { std::filesystem::remove(file_); }

  template <typename Message>
  static void hear(const Message& message, const std::string& topic = "elevation_map") {
    const auto known = rclcpp::Node::newest->subscribers.at(topic).lock();
    std::dynamic_pointer_cast<rclcpp::Subscription<Message>>(known)->hear(message);
  }
  static std::vector<std::string>& log() { return rclcpp::Node::newest->log; }

  const std::string file_ =
      (std::filesystem::temp_directory_path() / ("talus-ros-" + std::to_string(::getpid()))).string();
};

}  // namespace talus_ros2
