// What examples/ros2 takes as given of ROS 2: each name with its declaration and the version that it was read from. The stand-ins
// of these tests must compile with it, and so did the real headers of Jazzy and main (docs/embedding.md). Nothing
// runs here: what differs does not compile.
//
//   Nav2       Jazzy 1.3.13 (Kilted 1.4.2 reads the same) without TALUS_NAV2_MAIN, main 1.5.0 of 2026-08-21 with it
//   rclcpp     Jazzy 28.1.6, rolling 29.3.0          messages   common_interfaces of Jazzy 5.3.5 and of 2024-11-27
//   grid_map   Jazzy 2.2.1                           pluginlib  5.4.2
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include <grid_map_core/GridMap.hpp>
#include <grid_map_msgs/msg/grid_map.hpp>
#include <nav2_core/global_planner.hpp>
#include <nav2_core/planner_exceptions.hpp>
#include <nav2_costmap_2d/cost_values.hpp>
#include <nav2_costmap_2d/layer.hpp>
#include <nav2_costmap_2d/layered_costmap.hpp>
#include <nav_msgs/msg/path.hpp>
#include <rclcpp/rclcpp.hpp>
#include <visualization_msgs/msg/marker.hpp>

namespace {

using geometry_msgs::msg::PoseStamped;
using nav2_core::GlobalPlanner;
using nav2_costmap_2d::Costmap2D;
using nav2_costmap_2d::LayeredCostmap;

template <typename A, typename B>
constexpr bool same = std::is_same_v<A, B>;

// nav2_core/include/nav2_core/global_planner.hpp
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
static_assert(same<decltype(&GlobalPlanner::configure),
                   void (GlobalPlanner::*)(const std::weak_ptr<PlannerNode>&, std::string,
                                           std::shared_ptr<tf2_ros::Buffer>,
                                           std::shared_ptr<nav2_costmap_2d::Costmap2DROS>)>);
static_assert(same<decltype(&GlobalPlanner::cleanup), void (GlobalPlanner::*)()>);
static_assert(same<decltype(&GlobalPlanner::activate), void (GlobalPlanner::*)()>);
static_assert(same<decltype(&GlobalPlanner::deactivate), void (GlobalPlanner::*)()>);

// nav2_costmap_2d/include/nav2_costmap_2d/costmap_2d_ros.hpp
static_assert(same<decltype(std::declval<nav2_costmap_2d::Costmap2DROS&>().getGlobalFrameID()), std::string>);

// nav2_core/include/nav2_core/planner_exceptions.hpp
template <typename Exception>
constexpr bool planner_exception = std::is_base_of_v<nav2_core::PlannerException, Exception>&&
    std::is_constructible_v<Exception, const std::string&>;
static_assert(std::is_base_of_v<std::runtime_error, nav2_core::PlannerException>);
static_assert(planner_exception<nav2_core::StartOccupied> && planner_exception<nav2_core::GoalOccupied>);
static_assert(planner_exception<nav2_core::StartOutsideMapBounds> &&
              planner_exception<nav2_core::GoalOutsideMapBounds>);
static_assert(planner_exception<nav2_core::NoValidPathCouldBeFound> &&
              planner_exception<nav2_core::PlannerTimedOut>);
static_assert(planner_exception<nav2_core::PlannerTFError> && planner_exception<nav2_core::PlannerCancelled>);

// nav2_costmap_2d/include/nav2_costmap_2d/layer.hpp: its members are protected
class Layer : public nav2_costmap_2d::Layer {
  static_assert(
      same<decltype(&Layer::updateBounds),
           void (nav2_costmap_2d::Layer::*)(double, double, double, double*, double*, double*, double*)>);
  static_assert(
      same<decltype(&Layer::updateCosts), void (nav2_costmap_2d::Layer::*)(Costmap2D&, int, int, int, int)>);
  // Of Jazzy's nav2_util::LifecycleNode, which has rclcpp_lifecycle's WeakPtr.
  static_assert(same<decltype(&Layer::initialize),
                     void (nav2_costmap_2d::Layer::*)(LayeredCostmap*, std::string, tf2_ros::Buffer*,
                                                      const std::weak_ptr<PlannerNode>&,
                                                      rclcpp::CallbackGroup::SharedPtr)>);
  static_assert(same<decltype(&Layer::reset), void (nav2_costmap_2d::Layer::*)()>);
  static_assert(same<decltype(&Layer::isClearable), bool (nav2_costmap_2d::Layer::*)()>);
  static_assert(same<decltype(&Layer::matchSize), void (nav2_costmap_2d::Layer::*)()>);
  static_assert(same<decltype(&Layer::onInitialize), void (nav2_costmap_2d::Layer::*)()>);
  static_assert(same<decltype(Layer::layered_costmap_), LayeredCostmap*>);
  static_assert(same<decltype(Layer::name_), std::string>);
  static_assert(same<decltype(Layer::node_), std::weak_ptr<PlannerNode>>);
  static_assert(same<decltype(Layer::callback_group_), rclcpp::CallbackGroup::SharedPtr>);
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

// rclcpp_lifecycle/include/rclcpp_lifecycle/lifecycle_node.hpp, inherited by nav2_util's and nav2's
template <typename Node>
constexpr bool node_of_ros = requires(Node& node, const Node& kept, std::string text, double number) {
  { kept.has_parameter(text) } -> std::same_as<bool>;
  { node.template declare_parameter<double>(text, number) } -> std::convertible_to<double>;
  { node.template declare_parameter<std::string>(text, text) } -> std::convertible_to<std::string>;
  { kept.get_parameter(text, number) } -> std::same_as<bool>;
  { kept.get_logger() } -> std::same_as<rclcpp::Logger>;
  { node.get_clock() } -> std::same_as<rclcpp::Clock::SharedPtr>;
  { kept.now() } -> std::same_as<rclcpp::Time>;
};
static_assert(node_of_ros<PlannerNode> && node_of_ros<LayerNode>);

// rclcpp/include/rclcpp/{create_subscription,create_publisher,subscription_options,qos,time}.hpp
using grid_map_msgs::msg::GridMap;
using visualization_msgs::msg::Marker;
using Hear = std::function<void(const GridMap&)>;
static_assert(same<decltype(rclcpp::create_subscription<GridMap>(std::declval<PlannerNode&>(), std::string(),
                                                                 rclcpp::QoS(1), std::declval<Hear>(),
                                                                 rclcpp::SubscriptionOptions())),
                   std::shared_ptr<rclcpp::Subscription<GridMap>>>);
static_assert(same<decltype(rclcpp::create_publisher<Marker>(std::declval<PlannerNode&>(), std::string(),
                                                             rclcpp::QoS(1))),
                   std::shared_ptr<rclcpp::Publisher<Marker>>>);
static_assert(same<decltype(rclcpp::SubscriptionOptions::callback_group), rclcpp::CallbackGroup::SharedPtr>);
static_assert(same<decltype(rclcpp::QoS(1).best_effort()), rclcpp::QoS&>);
static_assert(same<decltype(rclcpp::QoS(1).transient_local()), rclcpp::QoS&>);
static_assert(std::is_constructible_v<rclcpp::Time, const builtin_interfaces::msg::Time&, rcl_clock_type_t>);
static_assert(same<decltype(std::declval<const rclcpp::Time&>().get_clock_type()), rcl_clock_type_t>);
static_assert(same<decltype((rclcpp::Time() - rclcpp::Time()).seconds()), double>);
static_assert(std::is_convertible_v<rclcpp::Time, builtin_interfaces::msg::Time>);
#ifdef TALUS_NAV2_MAIN
// nav2_ros_common/include/nav2_ros_common/lifecycle_node.hpp: hides rclcpp's order
template <typename Node>
constexpr bool callback_before_qos = requires(Node& node, Hear hear) {
  node.template create_subscription<GridMap>(std::string(), hear, rclcpp::QoS(1),
                                             rclcpp::CallbackGroup::SharedPtr());
};
template <typename Node>
constexpr bool qos_before_callback = requires(Node& node, Hear hear) {
  node.template create_subscription<GridMap>(std::string(), rclcpp::QoS(1), hear);
};
static_assert(callback_before_qos<nav2::LifecycleNode> && !qos_before_callback<nav2::LifecycleNode>);
#endif

// common_interfaces/*/msg, grid_map_msgs/msg, as rosidl_generator_cpp makes them
static_assert(same<decltype(builtin_interfaces::msg::Time::sec), std::int32_t>);
static_assert(same<decltype(builtin_interfaces::msg::Time::nanosec), std::uint32_t>);
static_assert(same<decltype(std_msgs::msg::Header::stamp), builtin_interfaces::msg::Time>);
static_assert(same<decltype(std_msgs::msg::Header::frame_id), std::string>);
static_assert(same<decltype(geometry_msgs::msg::Point::x), double> &&
              same<decltype(geometry_msgs::msg::Quaternion::w), double>);
static_assert(same<decltype(PoseStamped::header), std_msgs::msg::Header>);
static_assert(same<decltype(PoseStamped::pose), geometry_msgs::msg::Pose>);
static_assert(same<decltype(nav_msgs::msg::Path::poses), std::vector<PoseStamped>>);
static_assert(same<decltype(Marker::points), std::vector<geometry_msgs::msg::Point>>);
static_assert(same<decltype(Marker::colors), std::vector<std_msgs::msg::ColorRGBA>>);
static_assert(same<decltype(Marker::scale), geometry_msgs::msg::Vector3> &&
              same<decltype(Marker::ns), std::string>);
static_assert(Marker::LINE_STRIP == 4 && Marker::ADD == 0 &&
              same<decltype(std_msgs::msg::ColorRGBA::r), float>);
static_assert(same<decltype(GridMap::layers), std::vector<std::string>>);
static_assert(same<decltype(GridMap::data), std::vector<std_msgs::msg::Float32MultiArray>>);
static_assert(same<decltype(GridMap::outer_start_index), std::uint16_t> &&
              same<decltype(GridMap::inner_start_index), std::uint16_t>);
static_assert(same<decltype(grid_map_msgs::msg::GridMapInfo::resolution), double>);
static_assert(same<decltype(grid_map_msgs::msg::GridMapInfo::length_x), double>);
static_assert(same<decltype(grid_map_msgs::msg::GridMapInfo::pose), geometry_msgs::msg::Pose>);
static_assert(same<decltype(std_msgs::msg::Float32MultiArray::data), std::vector<float>>);
static_assert(
    same<decltype(std_msgs::msg::MultiArrayLayout::dim), std::vector<std_msgs::msg::MultiArrayDimension>>);
static_assert(same<decltype(std_msgs::msg::MultiArrayLayout::data_offset), std::uint32_t>);
static_assert(same<decltype(std_msgs::msg::MultiArrayDimension::label), std::string>);
static_assert(same<decltype(std_msgs::msg::MultiArrayDimension::size), std::uint32_t>);

// grid_map_core/include/grid_map_core/{GridMap,TypeDefs}.hpp
using Ring = grid_map::GridMap;
static_assert(same<grid_map::Matrix, Eigen::MatrixXf> && same<grid_map::Index, Eigen::Array2i>);
static_assert(same<grid_map::Size, Eigen::Array2i> && same<grid_map::Length, Eigen::Array2d>);
static_assert(same<grid_map::Position, Eigen::Vector2d>);
static_assert(std::is_constructible_v<Ring, const std::vector<std::string>&>);
static_assert(same<decltype(static_cast<void (Ring::*)(const grid_map::Length&, double,
                                                       const grid_map::Position&)>(&Ring::setGeometry)),
                   void (Ring::*)(const grid_map::Length&, double, const grid_map::Position&)>);
static_assert(same<decltype(&Ring::setFrameId), void (Ring::*)(const std::string&)>);
static_assert(same<decltype(&Ring::getFrameId), const std::string& (Ring::*)() const>);
static_assert(same<decltype(&Ring::setStartIndex), void (Ring::*)(const grid_map::Index&)>);
static_assert(same<decltype(&Ring::getStartIndex), const grid_map::Index& (Ring::*)() const>);
static_assert(same<decltype(&Ring::getSize), const grid_map::Size& (Ring::*)() const>);
static_assert(same<decltype(&Ring::getResolution), double (Ring::*)() const>);
static_assert(same<decltype(std::declval<const Ring&>().getPosition()), const grid_map::Position&>);
static_assert(same<decltype(&Ring::exists), bool (Ring::*)(const std::string&) const>);
static_assert(same<decltype(std::declval<Ring&>().get(std::string())), grid_map::Matrix&>);
static_assert(same<decltype(std::declval<const Ring&>().get(std::string())), const grid_map::Matrix&>);

}  // namespace
