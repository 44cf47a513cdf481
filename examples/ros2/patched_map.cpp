#include "patched_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "grid_map_patch.hpp"

namespace talus_ros2 {
namespace {

constexpr double kMostCells = 1 << 24;  // 64 MB of heights

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("grid map: " + what);
}

std::string text(double number) {
  return std::to_string(number);
}

}  // namespace

grid_map::GridMap gridMapFrom(const grid_map_msgs::msg::GridMap& message, const std::string& layer) {
  const auto& info = message.info;
  const double columns = std::round(info.length_x / info.resolution),
               rows = std::round(info.length_y / info.resolution);
  require(info.resolution > 0.0 && columns >= 1.0 && rows >= 1.0,
          "empty: " + text(info.length_x) + " m x " + text(info.length_y) + " m in cells of " +
              text(info.resolution) + " m");
  require(columns * rows <= kMostCells, "more than 16777216 cells; send a window of it");
  require(std::isfinite(info.pose.position.x) && std::isfinite(info.pose.position.y),
          "its position is not finite");
  require(std::hypot(info.pose.orientation.x, info.pose.orientation.y, info.pose.orientation.z) < 1e-6,
          "turned against its frame; send it unturned");
  const auto found = std::find(message.layers.begin(), message.layers.end(), layer);
  require(found != message.layers.end(), "no layer '" + layer + "'");
  const auto at = static_cast<std::size_t>(found - message.layers.begin());
  require(at < message.data.size(), "layer '" + layer + "' has no data");
  const auto& data = message.data[at];
  const auto& sides = data.layout.dim;
  const auto width = static_cast<std::uint32_t>(columns), height = static_cast<std::uint32_t>(rows);
  require(sides.size() == 2 && sides[0].label == "column_index" && sides[0].size == height &&
              sides[1].size == width && data.data.size() >= data.layout.data_offset &&
              data.data.size() - data.layout.data_offset >= std::size_t{width} * height,
          "layer '" + layer + "' is not " + std::to_string(width) + " x " + std::to_string(height) +
              " values in columns");
  require(message.outer_start_index < width && message.inner_start_index < height,
          "start index " + std::to_string(message.outer_start_index) + ", " +
              std::to_string(message.inner_start_index) + " lies outside of it");
  grid_map::GridMap map({layer});
  map.setFrameId(message.header.frame_id);
  map.setGeometry({info.length_x, info.length_y}, info.resolution,
                  {info.pose.position.x, info.pose.position.y});
  map.get(layer) =
      Eigen::Map<const grid_map::Matrix>(data.data.data() + data.layout.data_offset, width, height);
  map.setStartIndex({message.outer_start_index, message.inner_start_index});
  return map;
}

PatchedMap::PatchedMap(const std::string& file, Intake intake)
    : intake_(std::move(intake)), map_(talus::costmap::readMap(file)) {}

void PatchedMap::see(const grid_map_msgs::msg::GridMap& message, const rclcpp::Time& now) {
  require(message.header.frame_id == intake_.frame,
          "frame '" + message.header.frame_id + "', must be '" + intake_.frame + "'");
  const rclcpp::Time stamp(message.header.stamp, now.get_clock_type());
  const double age_s = (now - stamp).seconds();
  require(intake_.max_age_s == 0.0 || std::abs(age_s) <= intake_.max_age_s,
          "its stamp is " + text(age_s) + " s old, must be <= " + text(intake_.max_age_s) +
              " (max_age_s, use_sim_time)");
  const grid_map::GridMap seen = gridMapFrom(message, intake_.layer);
  const auto patch = patchOf(seen, intake_.layer, map_.grid());
  const std::lock_guard lock(changing_);
  if (patch) map_.patch(*patch);
}

}  // namespace talus_ros2
