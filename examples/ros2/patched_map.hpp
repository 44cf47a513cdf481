// Shows   a Talus map from a file whose heights are changed by elevation messages of grid_map.
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
/// lacks the layer, is rotated in its frame, or has inconsistent sizes. The conversion of grid_map itself
/// would abort or read beyond the data of such messages.
grid_map::GridMap gridMapFrom(const grid_map_msgs::msg::GridMap& message, const std::string& layer);

/// Talus map from a file whose heights are changed by elevation messages of grid_map. One thread calls see();
/// published() may be called from any thread.
class PatchedMap {
 public:
  /// Conditions that a message must meet.
  struct Intake {
    std::string frame;                ///< required frame of a message: the frame of the map file
    std::string layer = "elevation";  ///< name of the layer with heights [m]
    /// Largest difference between message stamp and present time, of either sign; 0: any difference.
    double max_age_s = 2.0;
  };

  /// Throws talus::InputError if the file is not a map.
  PatchedMap(const std::string& file, Intake intake);

  /// Replaces heights of the map by the heights of a message; `now` is the present time. Throws
  /// std::invalid_argument with a text of one line if the message is not usable; the map is then unchanged.
  void see(const grid_map_msgs::msg::GridMap& message, const rclcpp::Time& now);

  /// Returns the current version of the cost map.
  std::shared_ptr<const talus::costmap::CostGrid> published() const { return map_.published(); }

 private:
  Intake intake_;
  std::mutex changing_;
  talus::costmap::TraversabilityMap map_;
};

/// Returns the map that is given by the parameters `NAME.map_file`, `NAME.elevation_layer` and
/// `NAME.max_age_s` of a node, where NAME is `name`. `frame` is the frame of the map file. Throws
/// std::invalid_argument with a text of one line that contains the name of the invalid parameter.
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

/// Subscribes to the topic in the parameter `NAME.elevation_topic` of a node, and updates `map` with its
/// messages. Returns null if the parameter is empty. A message that is not usable is logged, at most every
/// five seconds. The map must outlive the returned subscription.
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
