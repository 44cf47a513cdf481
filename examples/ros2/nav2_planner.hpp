// Shows   Talus as a global planner of Nav2.
// Needs   map_node.hpp, nav2_core (Jazzy or later).  Parameters: README.md.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <nav2_core/global_planner.hpp>
#include <nav_msgs/msg/path.hpp>

#include "map_node.hpp"

namespace talus_ros2 {

/// Type of the first parameter of the member function `Method`, here configure(), which differs between
/// releases of Nav2.
template <typename Method>
struct FirstParameter;
template <typename Class, typename First, typename... Others>
struct FirstParameter<void (Class::*)(const First&, Others...)> {
  using type = First;
};

/// Global planner of Nav2: a view of the map of MapNode. createPlan() and deactivate() may run in two threads; a
/// second createPlan() waits for the first. Failures are thrown as the exception types of nav2_core, each with a
/// text of one line.
class Nav2Planner : public nav2_core::GlobalPlanner {
 public:
  using Poses = std::vector<geometry_msgs::msg::PoseStamped>;
  using Parent = FirstParameter<decltype(&nav2_core::GlobalPlanner::configure)>::type;

  void configure(const Parent& parent, std::string name, std::shared_ptr<tf2_ros::Buffer> tf,
                 std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap) override;
  void cleanup() override;
  void activate() override;
  /// Cancels the plan that is running, if any.
  void deactivate() override;

  // One of the two functions is an override, depending on the release of Nav2; therefore neither can be
  // marked as override.
  nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                 const geometry_msgs::msg::PoseStamped& goal,
                                 std::function<bool()> cancel_checker);
  nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                 const geometry_msgs::msg::PoseStamped& goal, const Poses& viapoints,
                                 std::function<bool()> cancel_checker);

 private:
  std::stop_source begin();
  geometry_msgs::msg::PoseStamped inMap(const geometry_msgs::msg::PoseStamped& pose, const char* which) const;
  talus::PlanRequest requestOf(const geometry_msgs::msg::PoseStamped& start,
                               const geometry_msgs::msg::PoseStamped& goal, const Poses& viapoints) const;

  Parent parent_;
  double tolerance_m_ = 0.5;
  double spacing_m_ = 0.5;
  bool headings_ = false;
  std::shared_ptr<MapNode> map_;
  std::mutex planning_;  // serialises plans
  std::optional<talus::Planner> planner_;
  std::mutex stopping_;  // guards the members below
  std::stop_source stop_;
  bool active_ = false;
};

}  // namespace talus_ros2
