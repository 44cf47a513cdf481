// What examples/ros2 takes as given of ROS 2 and would compile without: each name with its declaration and the version that it
// was read from. The stand-ins of these tests must compile with it, and so must the real headers (docs/embedding.md). Nothing
// runs here: what differs does not compile.
//
//   Nav2       Jazzy 1.3.13 (Kilted 1.4.2 reads the same) without TALUS_NAV2_MAIN, main 1.5.0 of 2026-08-21 with it
//   rclcpp     Jazzy 28.1.6, rolling 29.3.0          messages   common_interfaces of Jazzy 5.3.5 and of 2024-11-27
//   grid_map   Jazzy 2.2.1                           pluginlib  5.4.2
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <grid_map_msgs/msg/grid_map.hpp>
#include <nav2_core/global_planner.hpp>
#include <nav2_costmap_2d/cost_values.hpp>
#include <nav2_costmap_2d/layer.hpp>
#include <nav2_costmap_2d/layered_costmap.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>

namespace {

using geometry_msgs::msg::PoseStamped;
using nav2_core::GlobalPlanner;
using nav2_costmap_2d::Costmap2D;
using nav2_costmap_2d::LayeredCostmap;

template <typename A, typename B>
constexpr bool same = std::is_same_v<A, B>;

// nav2_core/include/nav2_core/global_planner.hpp; `override` and the exceptions that are thrown hold the rest
#ifdef TALUS_NAV2_MAIN
using PlannerNode = nav2::LifecycleNode;
using LayerNode = nav2::LifecycleNode;
static_assert(
    same<decltype(&GlobalPlanner::createPlan),
         nav_msgs::msg::Path (GlobalPlanner::*)(const PoseStamped&, const PoseStamped&,
                                                const std::vector<PoseStamped>&, std::function<bool()>)>);
#else
using PlannerNode = rclcpp_lifecycle::LifecycleNode;
using LayerNode = nav2_util::LifecycleNode;
static_assert(same<decltype(&GlobalPlanner::createPlan),
                   nav_msgs::msg::Path (GlobalPlanner::*)(const PoseStamped&, const PoseStamped&,
                                                          std::function<bool()>)>);
#endif

// nav2_costmap_2d/include/nav2_costmap_2d/layer.hpp: its members are protected
class Layer : public nav2_costmap_2d::Layer {
  // Of Jazzy's nav2_util::LifecycleNode, which has rclcpp_lifecycle's WeakPtr.
  static_assert(same<decltype(&Layer::initialize),
                     void (nav2_costmap_2d::Layer::*)(LayeredCostmap*, std::string, tf2_ros::Buffer*,
                                                      const std::weak_ptr<PlannerNode>&,
                                                      rclcpp::CallbackGroup::SharedPtr)>);
  static_assert(std::is_assignable_v<decltype((Layer::current_)), bool> &&
                same<decltype(Layer::enabled_), bool>);
};

// nav2_costmap_2d/include/nav2_costmap_2d/{layered_costmap,costmap_2d,cost_values}.hpp
static_assert(same<decltype(&LayeredCostmap::isRolling), bool (LayeredCostmap::*)()>);
static_assert(same<decltype(&LayeredCostmap::getGlobalFrameID), std::string (LayeredCostmap::*)() const>);
static_assert(std::is_constructible_v<LayeredCostmap, std::string, bool, bool>);
static_assert(same<decltype(&Costmap2D::mapToWorld),
                   void (Costmap2D::*)(unsigned int, unsigned int, double&, double&) const>);
static_assert(same<decltype(&Costmap2D::getCharMap), unsigned char* (Costmap2D::*)() const>);
static_assert(same<decltype(&Costmap2D::getResolution), double (Costmap2D::*)() const>);
static_assert(same<decltype(std::declval<const Costmap2D&>().getIndex(1U, 1U)), unsigned int>);
static_assert(
    std::is_constructible_v<Costmap2D, unsigned int, unsigned int, double, double, double, unsigned char>);
static_assert(nav2_costmap_2d::NO_INFORMATION == 255 && nav2_costmap_2d::LETHAL_OBSTACLE == 254);
static_assert(nav2_costmap_2d::MAX_NON_OBSTACLE == 252);

// rclcpp/include/rclcpp/{time,duration}.hpp
static_assert(std::is_constructible_v<rclcpp::Time, const builtin_interfaces::msg::Time&, rcl_clock_type_t>);
static_assert(same<decltype((rclcpp::Time() - rclcpp::Time()).seconds()), double>);
static_assert(std::is_convertible_v<rclcpp::Time, builtin_interfaces::msg::Time>);
static_assert(std::is_constructible_v<rclcpp::Duration, std::chrono::nanoseconds>);

// common_interfaces/*/msg and grid_map_msgs/msg, as rosidl_generator_cpp makes them
static_assert(same<decltype(builtin_interfaces::msg::Time::sec), std::int32_t> &&
              same<decltype(builtin_interfaces::msg::Time::nanosec), std::uint32_t>);
static_assert(sensor_msgs::msg::PointField::FLOAT32 == 7 && sensor_msgs::msg::PointField::FLOAT64 == 8);
static_assert(same<decltype(std_msgs::msg::Float32MultiArray::data), std::vector<float>>);

}  // namespace
