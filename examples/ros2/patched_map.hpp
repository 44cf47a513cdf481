// Shows   a Talus map from a file that elevation messages of grid_map patch at run time, for planner and layer.
// Needs   talus::planner, grid_map_core, grid_map_msgs, rclcpp.  Used by nav2_planner.cpp and nav2_layer.cpp.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <grid_map_core/GridMap.hpp>
#include <grid_map_msgs/msg/grid_map.hpp>
#include <rclcpp/rclcpp.hpp>

#include <talus/planner/planner.hpp>

#include "node_tools.hpp"

namespace talus_ros2 {

/// Returns one layer of a message as a grid map. Throws std::invalid_argument for a message that is empty,
/// lacks the layer, is rotated against its frame, or has inconsistent sizes: grid_map's own conversion
/// asserts or reads beyond the data.
grid_map::GridMap gridMapFrom(const grid_map_msgs::msg::GridMap& message, const std::string& layer);

/// Map from a file with patches from messages. One thread calls see(); published() may be called from any
/// thread.
class PatchedMap {
 public:
  /// Conditions on messages.
  struct Intake {
    std::string frame;                ///< frame of the map file
    std::string layer = "elevation";  ///< heights [m]
    double max_age_s = 2.0;           ///< larger age of a stamp, in either direction, is an error; 0: any age
  };

  /// Throws talus::InputError if the file is not a map.
  PatchedMap(const std::string& file, Intake intake);

  /// Patches the map with the heights of a message. Throws std::invalid_argument with one line; the map is
  /// then unchanged.
  void see(const grid_map_msgs::msg::GridMap& message, const rclcpp::Time& now);

  std::shared_ptr<const talus::costmap::CostGrid> published() const { return map_.published(); }

 private:
  Intake intake_;
  std::mutex changing_;
  talus::costmap::TraversabilityMap map_;
};

/// Returns the map given by the parameters `NAME.map_file`, `.elevation_layer` and `.max_age_s`. Throws
/// std::invalid_argument with one line that names the parameter.
template <typename Node>
std::unique_ptr<PatchedMap> patchedMap(Node& node, const std::string& name, const std::string& frame) {
  const auto file = parameter<std::string>(node, name + ".map_file", "");
  const auto layer = parameter<std::string>(node, name + ".elevation_layer", "elevation");
  const auto max_age_s = parameter(node, name + ".max_age_s", 2.0);
  if (!(max_age_s >= 0.0)) throw std::invalid_argument(name + ".max_age_s must be >= 0");
  if (file.empty()) throw std::invalid_argument(name + ".map_file: give a map that `talus costmap` wrote");
  try {
    return std::make_unique<PatchedMap>(file, PatchedMap::Intake{frame, layer, max_age_s});
  } catch (const std::exception& error) {
    throw std::invalid_argument(name + ".map_file: " + error.what());
  }
}

/// Subscribes to the topic `NAME.elevation_topic`, if given, to patch the map. Unusable messages are logged,
/// at most every five seconds. The map must outlive the returned subscription.
template <typename Node>
std::shared_ptr<void> patchedByTopic(const std::shared_ptr<Node>& node, const std::string& name,
                                     PatchedMap& map,
                                     const rclcpp::CallbackGroup::SharedPtr& group = nullptr) {
  const auto topic = parameter<std::string>(*node, name + ".elevation_topic", "");
  if (topic.empty()) return nullptr;
  const auto see = [&map, parent = std::weak_ptr<Node>(node),
                    name](const grid_map_msgs::msg::GridMap& message) {
    const auto alive = parent.lock();
    if (!alive) return;
    try {
      map.see(message, alive->now());
    } catch (const std::exception& error) {
      RCLCPP_WARN_THROTTLE(alive->get_logger(), *alive->get_clock(), 5000, "%s: %s", name.c_str(),
                           error.what());
    }
  };
  return newestOf<grid_map_msgs::msg::GridMap>(node, topic, see, group);
}

}  // namespace talus_ros2
