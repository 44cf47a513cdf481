#include "map_node.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include <talus/terramech/terramech_io.hpp>

namespace talus_ros2 {
namespace {

constexpr int kTile = talus::costmap::CostTile::kSide;

// The plugins of a process run in nodes of their own, and its arguments may rename all nodes; this one keeps its name.
rclcpp::NodeOptions named() {
  rclcpp::NodeOptions options;
  options.arguments({"--ros-args", "-r", "__node:=talus_map"});
  return options;
}

}  // namespace

std::shared_ptr<MapNode> MapNode::shared() {
  static std::mutex making;
  static std::weak_ptr<MapNode> made;
  const std::lock_guard lock(making);
  std::shared_ptr<MapNode> node = made.lock();
  if (!node) made = node = std::shared_ptr<MapNode>(new MapNode);
  return node;
}

MapNode::MapNode()
    : node_(std::make_shared<rclcpp::Node>("talus_map", named())), tf_(node_->get_clock()), listener_(tf_) {
  frame_ = parameter<std::string>(*node_, "frame", "map");
  layer_ = parameter<std::string>(*node_, "elevation_layer", "elevation");
  max_age_s_ = parameter(*node_, "max_age_s", 2.0);
  require(max_age_s_ >= 0.0, "talus_map.max_age_s must be >= 0");
  try {
    if (const auto file = parameter<std::string>(*node_, "map_file", ""); !file.empty()) {
      map_ = std::make_unique<talus::Map>(talus::Map::read(file));
    } else {
      ground_.rover = talus::terramech::loadRover(parameter<std::string>(*node_, "rover", "mer"));
      const auto soil =
          talus::terramech::loadSoilPrior(parameter<std::string>(*node_, "soil", "mars_blocky"));
      ground_.classes = {talus::costmap::groundClass(0, soil, ground_.rover)};
      ground_.policy.allow_unknown = parameter(*node_, "allow_unknown", true);
      const double resolution_m = parameter(*node_, "resolution_m", 0.2),
                   tiles = std::ceil(parameter(*node_, "size_m", 100.0) / (kTile * resolution_m));
      require(resolution_m > 0.0 && tiles >= 1.0 && tiles <= 64.0,
              "resolution_m and size_m must be > 0, and at most 4096 cells a side");
      grid_ = {.width = static_cast<int>(tiles) * kTile,
               .height = static_cast<int>(tiles) * kTile,
               .resolution_m = resolution_m,
               .south_west = {}};
      map_ = std::make_unique<talus::Map>(unseen({}));
    }
  } catch (const std::exception& error) {
    throw std::invalid_argument("talus_map: " + std::string(error.what()));
  }
  ground_map_ =
      node_->create_publisher<grid_map_msgs::msg::GridMap>("~/ground", rclcpp::QoS(1).transient_local());
  elevation_ = hear("elevation_topic", 1, &MapNode::see);
  wheels_ = hear("wheel_topic", 1000, &MapNode::learn);
  clock_ = node_->create_wall_timer(std::chrono::seconds(1), [this] { publish(); });
  spinning_ = std::jthread([this](const std::stop_token& over) {
    rclcpp::executors::SingleThreadedExecutor executor;
    executor.add_node(node_);
    while (!over.stop_requested() && rclcpp::ok()) executor.spin_once(std::chrono::milliseconds(50));
  });
}

MapNode::~MapNode() = default;

// Subscribes for publishers of any reliability.
template <typename Message>
std::shared_ptr<void> MapNode::hear(const std::string& parameter_name, std::size_t depth,
                                    void (MapNode::*take)(const Message&)) {
  const auto topic = parameter<std::string>(*node_, parameter_name, "");
  if (topic.empty()) return nullptr;
  return node_->create_subscription<Message>(
      topic, rclcpp::QoS(depth).best_effort(), [this, take, topic](const Message& message) {
        try {
          (this->*take)(message);
        } catch (const std::exception& error) {
          RCLCPP_WARN_THROTTLE(node_->get_logger(), *node_->get_clock(), 5000, "%s: %s", topic.c_str(),
                               error.what());
        }
      });
}

talus::Map MapNode::unseen(talus::maps::Point middle) const {
  talus::maps::Grid grid = grid_;
  const auto corner = [&](double at_m, int cells) {
    return (std::round(at_m / grid.resolution_m) - 0.5 * cells) * grid.resolution_m;
  };
  grid.south_west = {corner(middle.x_m, grid.width), corner(middle.y_m, grid.height)};
  talus::Site site{.ground = talus::costmap::GroundModel(ground_)};
  site.layers.elevation.elevation_m =
      talus::maps::Raster<float>(grid, std::numeric_limits<float>::quiet_NaN());
  return talus::Map(std::move(site));
}

std::shared_ptr<const talus::costmap::CostGrid> MapNode::published() const {
  const std::lock_guard lock(changing_);
  return map_->ground().published();
}

geometry_msgs::msg::PoseStamped MapNode::inMap(geometry_msgs::msg::PoseStamped pose) const {
  pose.header.stamp = rclcpp::Time();  // the newest transform
  const Eigen::Isometry3d in_map =
      placeOf(pose.header, 0.0) * isometryOf(pose.pose.position, pose.pose.orientation);
  const Eigen::Quaterniond turn(in_map.linear());
  pose.header.frame_id = frame_;
  pose.pose.position.x = in_map.translation().x();
  pose.pose.position.y = in_map.translation().y();
  pose.pose.position.z = in_map.translation().z();
  pose.pose.orientation.x = turn.x();
  pose.pose.orientation.y = turn.y();
  pose.pose.orientation.z = turn.z();
  pose.pose.orientation.w = turn.w();
  return pose;
}

// Returns the transform of a message's frame to the map's at the time of the message.
Eigen::Isometry3d MapNode::placeOf(const std_msgs::msg::Header& header, double max_age_s) const {
  const rclcpp::Time now = node_->now(), stamp(header.stamp, now.get_clock_type());
  const double age_s = (now - stamp).seconds();
  require(max_age_s == 0.0 || std::abs(age_s) <= max_age_s,
          "its stamp is " + std::to_string(age_s) + " s old, must be <= " + std::to_string(max_age_s) +
              " (max_age_s, use_sim_time)");
  if (header.frame_id == frame_) return Eigen::Isometry3d::Identity();
  const auto found =
      tf_.lookupTransform(frame_, header.frame_id, stamp, rclcpp::Duration(std::chrono::milliseconds(100)));
  return isometryOf(found.transform.translation, found.transform.rotation);
}

// Moves a map that began unknown by whole tiles, so that a place is less than a tile from its middle.
void MapNode::follow(talus::maps::Point middle) {
  if (grid_.size() == 0) return;
  const talus::maps::Grid& grid = map_->ground().grid();
  const auto tiles = [&](double at_m, double corner_m, int cells) {
    const double off = ((at_m - corner_m) / grid.resolution_m - 0.5 * cells) / kTile;
    return std::trunc(std::clamp(off, -1e6, 1e6));
  };
  const double east = tiles(middle.x_m, grid.south_west.x_m, grid.width),
               north = tiles(middle.y_m, grid.south_west.y_m, grid.height);
  if (east == 0.0 && north == 0.0) return;
  const bool overlaps = std::abs(east) * kTile < grid.width && std::abs(north) * kTile < grid.height;
  overlaps ? map_->move({static_cast<int>(east), static_cast<int>(north)}) : void(*map_ = unseen(middle));
}

void MapNode::see(const grid_map_msgs::msg::GridMap& message) {
  const Eigen::Isometry3d T_map_frame = placeOf(message.header, max_age_s_);
  const Heights seen = heightsOf(message, layer_);
  const talus::maps::Grid& cells = seen.z_m.grid();
  const Eigen::Vector3d middle = T_map_frame * seen.T_frame_cells *
                                 Eigen::Vector3d(0.5 * (cells.width - 1) * seen.resolution_m,
                                                 0.5 * (cells.height - 1) * seen.resolution_m, 0.0);
  const std::lock_guard lock(changing_);
  follow({middle.x(), middle.y()});
  if (const auto patch = patchOf(seen, T_map_frame, map_->ground())) map_->patch(*patch);
}

void MapNode::learn(const sensor_msgs::msg::PointCloud2& message) {
  const talus::Telemetry rows = wheelsOf(message, placeOf(message.header, max_age_s_));
  const std::lock_guard lock(changing_);
  map_->learnPart(rows);
}

void MapNode::publish() {
  const std::lock_guard lock(changing_);
  const auto newest = map_->ground().published();
  if (newest == cells_.version()) return;
  cells_.show(newest);
  std_msgs::msg::Header header;
  header.frame_id = frame_;
  header.stamp = node_->now();
  ground_map_->publish(gridMapOf(map_->ground(), cells_, header));
}

}  // namespace talus_ros2
