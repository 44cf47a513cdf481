#include "nav2_planner.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <thread>
#include <utility>

#include <nav2_core/planner_exceptions.hpp>
#include <pluginlib/class_list_macros.hpp>

namespace talus_ros2 {
namespace {

using geometry_msgs::msg::PoseStamped;
using talus::planner::RouteStatus;

double headingOf(const PoseStamped& pose) {
  const auto& q = pose.pose.orientation;
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

// Returns a thread that asks the caller's cancel function every 20 ms until its destruction.
std::jthread cancelling(const std::function<bool()>& wanted, std::stop_source stop) {
  if (!wanted) return {};
  return std::jthread([wanted, stop](const std::stop_token& over) mutable {
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any bell;
    do bell.wait_for(lock, over, std::chrono::milliseconds(20), [] { return false; });
    while (!over.stop_requested() && !wanted());
    if (!over.stop_requested()) stop.request_stop();
  });
}

// Throws the exception of nav2_core for a failed plan. The text is Talus' reason: place, cause and remedy.
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
                            std::shared_ptr<nav2_costmap_2d::Costmap2DROS>) {
  parent_ = parent;
  const auto node = parent.lock();
  if (!node) throw nav2_core::PlannerException(name + ": its node is gone");
  const auto planner = parameter<std::string>(*node, name + ".planner", "field");
  const auto limit_s = parameter(*node, name + ".time_limit_s", 5.0);
  tolerance_m_ = parameter(*node, name + ".tolerance_m", 0.5);
  spacing_m_ = parameter(*node, name + ".path_spacing_m", 0.5);
  headings_ = parameter(*node, name + ".use_headings", false);
  if (!(spacing_m_ > 0.0)) throw nav2_core::PlannerException(name + ".path_spacing_m must be > 0");
  try {
    map_ = MapNode::shared();
    planner_.emplace(talus::PlannerSettings{.planner = planner, .time_limit_s = limit_s});
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(error.what());
  }
}

void Nav2Planner::activate() {
  const std::lock_guard lock(stopping_);
  active_ = true;
}

void Nav2Planner::deactivate() {
  const std::lock_guard lock(stopping_);
  active_ = false;
  stop_.request_stop();
}

void Nav2Planner::cleanup() {
  deactivate();
  const std::lock_guard lock(planning_);
  planner_.reset();
  map_.reset();
}

// Returns a new stop source for the plan that begins.
std::stop_source Nav2Planner::begin() {
  const std::lock_guard lock(stopping_);
  if (!active_) throw nav2_core::PlannerException("Talus: not active");
  return stop_ = std::stop_source();
}

PoseStamped Nav2Planner::inMap(const PoseStamped& pose, const char* which) const {
  try {
    return map_->inMap(pose);
  } catch (const std::exception& error) {
    throw nav2_core::PlannerTFError(std::string(which) + ": frame '" + pose.header.frame_id + "', map '" +
                                    map_->frame() + "': " + error.what());
  }
}

talus::PlanRequest Nav2Planner::requestOf(const PoseStamped& start, const PoseStamped& goal,
                                          const Poses& viapoints) const {
  const auto placeOf = [](const PoseStamped& pose) {
    return talus::maps::Point{pose.pose.position.x, pose.pose.position.y};
  };
  const PoseStamped from = inMap(start, "start"), to = inMap(goal, "goal");
  talus::PlanRequest request{.start = placeOf(from), .goal = placeOf(to), .tolerance_m = tolerance_m_};
  for (const PoseStamped& pose : viapoints) request.via.push_back(placeOf(inMap(pose, "via point")));
  if (headings_) {
    request.start_heading_rad = headingOf(from);
    request.goal_heading_rad = headingOf(to);
  }
  return request;
}

nav_msgs::msg::Path Nav2Planner::createPlan(const PoseStamped& start, const PoseStamped& goal,
                                            std::function<bool()> cancel_checker) {
  return createPlan(start, goal, {}, std::move(cancel_checker));
}

nav_msgs::msg::Path Nav2Planner::createPlan(const PoseStamped& start, const PoseStamped& goal,
                                            const Poses& viapoints, std::function<bool()> cancel_checker) {
  const std::lock_guard lock(planning_);
  std::stop_source stop = begin();
  talus::PlanRequest request = requestOf(start, goal, viapoints);
  request.watch.stop = stop.get_token();
  talus::planner::Route route;
  const auto published = map_->published();
  if (cancel_checker && cancel_checker()) stop.request_stop();
  try {
    const std::jthread watch = cancelling(cancel_checker, stop);
    route = planner_->plan(published, request);
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(error.what());
  }
  if (stop.stop_requested()) route.status = RouteStatus::Cancelled;
  if (route.status != RouteStatus::Found)
    refuse(route, published->grid().cellAt(request.start).has_value(),
           published->grid().cellAt(request.goal).has_value());
  std_msgs::msg::Header header;
  header.frame_id = map_->frame();
  if (const auto node = parent_.lock()) header.stamp = node->now();
  return pathOf(route, header, spacing_m_);
}

}  // namespace talus_ros2

PLUGINLIB_EXPORT_CLASS(talus_ros2::Nav2Planner, nav2_core::GlobalPlanner)
