// Shows   a Talus map from a file that elevation messages of grid_map patch while it runs: what planner and layer share.
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

/// One layer of a message as a grid map. Throws std::invalid_argument for a message that is empty, without the layer, turned
/// against its frame, or whose sizes contradict each other: grid_map's own conversion asserts or reads beyond the data.
grid_map::GridMap gridMapFrom(const grid_map_msgs::msg::GridMap& message, const std::string& layer);

/// One thread calls see(), any thread the others.
class PatchedMap {
 public:
  /// Which messages count.
  struct Intake {
    std::string frame;                ///< of the map file
    std::string layer = "elevation";  ///< heights [m]
    double max_age_s = 2.0;           ///< stamps further from the node's time are refused; 0: none is
  };

  /// Throws talus::InputError for a file that is no map.
  PatchedMap(const std::string& file, Intake intake);

  /// Takes the heights of a message in. Throws std::invalid_argument, in one line; the map stays as it was.
  void see(const grid_map_msgs::msg::GridMap& message, const rclcpp::Time& now);

  std::shared_ptr<const talus::costmap::CostGrid> published() const { return map_.published(); }

 private:
  Intake intake_;
  std::mutex changing_;
  talus::costmap::TraversabilityMap map_;
};

/// A map by the parameters `NAME.map_file`, `.elevation_layer` and `.max_age_s`. Throws in one line that names the parameter.
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

/// Lets messages of the topic `NAME.elevation_topic`, where one is given, patch the map. What cannot be used is a line in the
/// log, every five seconds at most. The map must outlive what is returned.
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
