#include "nav2_planner.hpp"

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <thread>
#include <utility>

#include <nav2_core/planner_exceptions.hpp>

#include "route_messages.hpp"

namespace talus_ros2 {
namespace {

using geometry_msgs::msg::PoseStamped;
using talus::planner::RouteStatus;

double headingOf(const PoseStamped& pose) {
  const auto& q = pose.pose.orientation;
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

// Polls the caller's cancel function: once at construction, then every 20 ms until destruction.
class CancelWatch {
 public:
  CancelWatch(const std::function<bool()>& wanted, std::stop_source stop) : stop_(std::move(stop)) {
    if (!wanted || ends(wanted)) return;
    watching_ = std::jthread([this, wanted](const std::stop_token& over) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any bell;
      do bell.wait_for(lock, over, std::chrono::milliseconds(20), [] { return false; });
      while (!over.stop_requested() && !ends(wanted));
    });
  }

 private:
  bool ends(const std::function<bool()>& wanted) {
    bool end = true;
    try {
      end = wanted();
    } catch (const std::exception&) {  // `end` stays true: the planning is cancelled
    }
    if (end) stop_.request_stop();
    return end;
  }

  std::stop_source stop_;
  std::jthread watching_;
};

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
                            std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap) {
  parent_ = parent;
  const auto node = parent.lock();
  if (!node) throw nav2_core::PlannerException(name + ": its node is gone");
  frame_ = costmap->getGlobalFrameID();
  const auto planner = parameter<std::string>(*node, name + ".planner", "field");
  const auto limit_s = parameter(*node, name + ".time_limit_s", 5.0);
  tolerance_m_ = parameter(*node, name + ".tolerance_m", 0.5);
  spacing_m_ = parameter(*node, name + ".path_spacing_m", 0.5);
  headings_ = parameter(*node, name + ".use_headings", false);
  if (!(spacing_m_ > 0.0)) throw nav2_core::PlannerException(name + ".path_spacing_m must be > 0");
  try {
    map_ = patchedMap(*node, name, frame_);
    planner_.emplace(talus::PlannerSettings{.planner = planner, .time_limit_s = limit_s});
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(error.what());
  }
  categories_ = rclcpp::create_publisher<visualization_msgs::msg::Marker>(*node, name + "/categories",
                                                                          rclcpp::QoS(1).transient_local());
  subscription_ = patchedByTopic(node, name, *map_);
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
  subscription_.reset();
  categories_.reset();
  planner_.reset();
  map_.reset();
}

// Returns a new stop source for the plan that begins.
std::stop_source Nav2Planner::begin() {
  const std::lock_guard lock(stopping_);
  if (!active_) throw nav2_core::PlannerException("Talus: not active");
  return stop_ = std::stop_source();
}

talus::maps::Point Nav2Planner::placeOf(const PoseStamped& pose, const char* which) const {
  if (pose.header.frame_id != frame_)
    throw nav2_core::PlannerTFError(std::string(which) + ": frame '" + pose.header.frame_id + "', must be '" +
                                    frame_ + "'; transform it first");
  return {pose.pose.position.x, pose.pose.position.y};
}

talus::PlanRequest Nav2Planner::requestOf(const PoseStamped& start, const PoseStamped& goal,
                                          const Poses& viapoints) const {
  talus::PlanRequest request{
      .start = placeOf(start, "start"), .goal = placeOf(goal, "goal"), .tolerance_m = tolerance_m_};
  for (const PoseStamped& pose : viapoints) request.via.push_back(placeOf(pose, "via point"));
  if (headings_) {
    request.start_heading_rad = headingOf(start);
    request.goal_heading_rad = headingOf(goal);
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
  const std::stop_source stop = begin();
  talus::PlanRequest request = requestOf(start, goal, viapoints);
  const CancelWatch cancel(cancel_checker, stop);
  request.watch.stop = stop.get_token();
  talus::planner::Route route;
  const auto published = map_->published();
  try {
    route = planner_->plan(published, request);
  } catch (const std::exception& error) {
    throw nav2_core::PlannerException(error.what());
  }
  if (stop.stop_requested()) route.status = RouteStatus::Cancelled;
  if (route.status != RouteStatus::Found)
    refuse(route, published->grid().cellAt(request.start).has_value(),
           published->grid().cellAt(request.goal).has_value());
  return answer(route);
}

nav_msgs::msg::Path Nav2Planner::answer(const talus::planner::Route& route) const {
  std_msgs::msg::Header header;
  header.frame_id = frame_;
  if (const auto node = parent_.lock()) header.stamp = node->now();
  categories_->publish(categoriesOf(route, header, spacing_m_));
  return pathOf(route, header, spacing_m_);
}

}  // namespace talus_ros2
