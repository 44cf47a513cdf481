#include "nav2_planner.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <stop_token>
#include <thread>
#include <utility>

#include <grid_map_ros/GridMapRosConverter.hpp>
#include <nav2_core/planner_exceptions.hpp>
#include <rclcpp/rclcpp.hpp>

#include <talus/maps/maps.hpp>

#include "grid_map_patch.hpp"

namespace talus_ros2 {
namespace {

using geometry_msgs::msg::PoseStamped;
using talus::planner::RouteStatus;

template <typename Node, typename T>
T parameter(Node& node, const std::string& name, const T& usual) {
  if (!node.has_parameter(name)) node.template declare_parameter<T>(name, usual);
  T value = usual;
  node.get_parameter(name, value);
  return value;
}
template <typename Node>
std::string parameter(Node& node, const std::string& name, const char* usual) {
  return parameter(node, name, std::string(usual));
}

double headingOf(const PoseStamped& pose) {
  const auto& q = pose.pose.orientation;
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

// Looks whether the caller wants the plan to end: at once, and 50 times a second as long as it lives.
class CancelWatch {
 public:
  explicit CancelWatch(const std::function<bool()>& wanted) {
    if (!wanted || ends(wanted)) return;
    watching_ = std::jthread([this, wanted](const std::stop_token& over) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any bell;
      do bell.wait_for(lock, over, std::chrono::milliseconds(20), [] { return false; });
      while (!over.stop_requested() && !ends(wanted));
    });
  }
  std::stop_token token() const { return stop_.get_token(); }

 private:
  bool ends(const std::function<bool()>& wanted) {
    bool end = true;
    try {
      end = wanted();
    } catch (const std::exception&) {  // who cannot be asked is no longer there
    }
    if (end) stop_.request_stop();
    return end;
  }

  std::stop_source stop_;
  std::jthread watching_;
};

// What did not lead to a route, as Nav2's behaviours know it. Talus' reason holds where, why and the remedy.
[[noreturn]] void refuse(const talus::planner::Route& route, bool start_inside, bool goal_inside) {
  switch (route.status) {
    case RouteStatus::StartInvalid:
      if (!start_inside) throw nav2_core::StartOutsideMapBounds(route.reason);
      throw nav2_core::StartOccupied(route.reason);
    case RouteStatus::GoalInvalid:
      if (!goal_inside) throw nav2_core::GoalOutsideMapBounds(route.reason);
      throw nav2_core::GoalOccupied(route.reason);
    case RouteStatus::TimedOut:
      throw nav2_core::PlannerTimedOut(route.reason);
    case RouteStatus::Cancelled:
      throw nav2_core::PlannerCancelled("cancelled");
    default:
      throw nav2_core::NoValidPathCouldBeFound(route.reason);
  }
}

}  // namespace

void Nav2Planner::configure(const Parent& parent, std::string name, std::shared_ptr<tf2_ros::Buffer>,
                            std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap) {
  parent_ = parent;
  const auto node = parent.lock();
  if (!node) throw nav2_core::PlannerException(name + ": its node is gone");
  frame_ = costmap->getGlobalFrameID();
  const auto file = parameter(*node, name + ".map_file", "");
  const auto topic = parameter(*node, name + ".elevation_topic", "");
  layer_ = parameter(*node, name + ".elevation_layer", "elevation");
  const auto planner = parameter(*node, name + ".planner", "field");
  const auto limit_s = parameter(*node, name + ".time_limit_s", 5.0);
  tolerance_m_ = parameter(*node, name + ".tolerance_m", 0.5);
  spacing_m_ = parameter(*node, name + ".path_spacing_m", 0.5);
  headings_ = parameter(*node, name + ".use_headings", false);
  if (!(spacing_m_ > 0.0)) throw nav2_core::PlannerException(name + ".path_spacing_m must be > 0");
  try {
    if (file.empty()) throw std::invalid_argument("give a map that `talus costmap` wrote");
    map_.emplace(talus::costmap::readMap(file));
    planner_ = talus::planner::makePlanner(planner);
    planner_->configure({.planner = planner, .time_limit_s = limit_s});
    planner_->set_map(map_->published());
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(name + ".map_file: " + error.what());
  }
  if (!topic.empty())
    subscription_ = node->template create_subscription<grid_map_msgs::msg::GridMap>(
        topic, 1, [this](const grid_map_msgs::msg::GridMap& message) { see(message); });
}

void Nav2Planner::cleanup() {
  subscription_.reset();
  planner_.reset();
  map_.reset();
}

// What cannot be used is one line in the log and changes nothing.
void Nav2Planner::see(const grid_map_msgs::msg::GridMap& message) {
  try {
    grid_map::GridMap seen;
    grid_map::GridMapRosConverter::fromMessage(message, seen);
    if (seen.getFrameId() != frame_)
      throw std::invalid_argument("grid map: frame '" + seen.getFrameId() + "', must be '" + frame_ + "'");
    const std::lock_guard lock(changing_);
    if (const auto patch = patchOf(seen, layer_, map_->grid())) map_->patch(*patch);
  } catch (const std::exception& error) {
    if (const auto node = parent_.lock()) RCLCPP_WARN(node->get_logger(), "%s", error.what());
  }
}

talus::maps::Point Nav2Planner::placeOf(const PoseStamped& pose, const char* which) const {
  if (pose.header.frame_id != frame_)
    throw nav2_core::PlannerTFError(std::string(which) + ": frame '" + pose.header.frame_id + "', must be '" +
                                    frame_ + "'; transform it first");
  return {pose.pose.position.x, pose.pose.position.y};
}

nav_msgs::msg::Path Nav2Planner::createPlan(const PoseStamped& start, const PoseStamped& goal,
                                            std::function<bool()> cancel_checker) {
  return createPlan(start, goal, {}, std::move(cancel_checker));
}

nav_msgs::msg::Path Nav2Planner::createPlan(const PoseStamped& start, const PoseStamped& goal,
                                            const Poses& viapoints, std::function<bool()> cancel_checker) {
  if (!planner_) throw nav2_core::PlannerException("Talus: not configured");
  talus::PlanRequest request{
      .start = placeOf(start, "start"), .goal = placeOf(goal, "goal"), .tolerance_m = tolerance_m_};
  for (const PoseStamped& pose : viapoints) request.via.push_back(placeOf(pose, "via point"));
  if (headings_) {
    request.start_heading_rad = headingOf(start);
    request.goal_heading_rad = headingOf(goal);
  }
  const CancelWatch cancel(cancel_checker);
  request.watch.stop = cancel.token();
  talus::planner::Route route;
  const auto published = map_->published();
  try {
    planner_->update(published);
    route = planner_->plan(request);
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(error.what());
  }
  if (cancel.token().stop_requested()) route.status = RouteStatus::Cancelled;
  if (route.status != RouteStatus::Found)
    refuse(route, published->grid().cellAt(request.start).has_value(),
           published->grid().cellAt(request.goal).has_value());
  return pathOf(route);
}

nav_msgs::msg::Path Nav2Planner::pathOf(const talus::planner::Route& route) const {
  nav_msgs::msg::Path path;
  path.header.frame_id = frame_;
  if (const auto node = parent_.lock()) path.header.stamp = node->now();
  double z_m = 0.0;  // where the ground was not observed: as before
  const auto add = [&](double x_m, double y_m, double heading_rad) {
    PoseStamped pose;
    pose.header = path.header;
    pose.pose.position.x = x_m;
    pose.pose.position.y = y_m;
    pose.pose.position.z = z_m;
    pose.pose.orientation.z = std::sin(0.5 * heading_rad);
    pose.pose.orientation.w = std::cos(0.5 * heading_rad);
    path.poses.push_back(pose);
  };
  for (std::size_t i = 0; i < route.vertices.size(); ++i) {
    const auto& v = route.vertices[i];
    if (std::isfinite(v.elevation_m)) z_m = v.elevation_m;
    add(v.x_m, v.y_m, v.heading_rad);
    if (i + 1 == route.vertices.size()) break;
    const auto& to = route.vertices[i + 1];
    const int pieces = static_cast<int>(std::ceil(std::hypot(to.x_m - v.x_m, to.y_m - v.y_m) / spacing_m_));
    for (int k = 1; k < pieces; ++k)
      add(v.x_m + k * (to.x_m - v.x_m) / pieces, v.y_m + k * (to.y_m - v.y_m) / pieces, v.heading_rad);
  }
  return path;
}

}  // namespace talus_ros2
