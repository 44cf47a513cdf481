// Shows   Talus as a global planner of Nav2.
// Needs   talus::planner, nav2_core (Jazzy or later), grid_map_ros.  Parameters: README.md.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <geometry_msgs/msg/pose_stamped.hpp>
#include <grid_map_msgs/msg/grid_map.hpp>
#include <nav2_core/global_planner.hpp>
#include <nav_msgs/msg/path.hpp>

#include <talus/planner/planner.hpp>

namespace talus_ros2 {

/// The first parameter of configure(), whose type differs between releases of Nav2.
template <typename Method>
struct FirstParameter;
template <typename Class, typename First, typename... Others>
struct FirstParameter<void (Class::*)(const First&, Others...)> {
  using type = First;
};

/// Plans on a Talus map that was read from a file and that patches of a grid map may change while it runs. createPlan() and
/// the subscription may run in two threads. Throws the typed exceptions of nav2_core, each with one line.
class Nav2Planner : public nav2_core::GlobalPlanner {
 public:
  using Poses = std::vector<geometry_msgs::msg::PoseStamped>;
  using Parent = FirstParameter<decltype(&nav2_core::GlobalPlanner::configure)>::type;

  void configure(const Parent& parent, std::string name, std::shared_ptr<tf2_ros::Buffer> tf,
                 std::shared_ptr<nav2_costmap_2d::Costmap2DROS> costmap) override;
  void cleanup() override;
  void activate() override {}
  void deactivate() override {}

  // One of the two overrides what Nav2 declares, depending on its release; neither can be marked.
  nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                 const geometry_msgs::msg::PoseStamped& goal,
                                 std::function<bool()> cancel_checker);
  nav_msgs::msg::Path createPlan(const geometry_msgs::msg::PoseStamped& start,
                                 const geometry_msgs::msg::PoseStamped& goal, const Poses& viapoints,
                                 std::function<bool()> cancel_checker);

 private:
  void see(const grid_map_msgs::msg::GridMap& message);
  talus::maps::Point placeOf(const geometry_msgs::msg::PoseStamped& pose, const char* which) const;
  nav_msgs::msg::Path pathOf(const talus::planner::Route& route) const;

  Parent parent_;
  std::string frame_, layer_;
  double tolerance_m_ = 0.5;
  double spacing_m_ = 0.5;
  bool headings_ = false;
  std::mutex changing_;  // of the map
  std::optional<talus::costmap::TraversabilityMap> map_;
  std::unique_ptr<talus::GlobalPlanner> planner_;
  std::shared_ptr<void> subscription_;
};

}  // namespace talus_ros2
