#include "nav2_planner.hpp"

#include <atomic>
#include <cmath>
#include <numbers>
#include <string>
#include <thread>

#include <nav2_core/planner_exceptions.hpp>

#include "small_site.hpp"

#ifdef TALUS_NAV2_MAIN
#define Nav2 Nav2WithViaPoints  // the same tests, by another name
#endif

namespace talus_ros2 {
namespace {

using geometry_msgs::msg::PoseStamped;
using Node = nav2_core::GlobalPlanner::Node;

PoseStamped pose(double x_m, double y_m, const std::string& frame = "map") {
  PoseStamped at;
  at.header.frame_id = frame;
  at.pose.position.x = x_m;
  at.pose.position.y = y_m;
  return at;
}

/// The planner as Nav2's server has it: behind its interface.
class Nav2 : public RosTest {
 protected:
  void start(bool closed = false) {
    talus::costmap::writeMap(smallSite(closed), file_);
    planner_->configure(node_, "talus", nullptr, std::make_shared<nav2_costmap_2d::Costmap2DROS>());
    planner_->activate();
  }
  nav_msgs::msg::Path plan(
      const PoseStamped& from, const PoseStamped& to, std::function<bool()> cancel = [] { return false; }) {
#ifdef TALUS_NAV2_MAIN
    return planner_->createPlan(from, to, via_, std::move(cancel));
#else
    return planner_->createPlan(from, to, std::move(cancel));
#endif
  }

  std::shared_ptr<Node> node_ = std::make_shared<Node>();
  std::unique_ptr<nav2_core::GlobalPlanner> planner_ = std::make_unique<Nav2Planner>();
  std::vector<PoseStamped> via_;
};

TEST_F(Nav2, PathAvoidsAWallAndHasHeadings) {
  start();
  const auto path = plan(pose(0.0, 8.0), pose(25.0, 8.0));
  ASSERT_GT(path.poses.size(), 50U);
  EXPECT_EQ(path.header.frame_id, "map");
  EXPECT_EQ(path.header.stamp.sec, 7);
  EXPECT_EQ(path.poses.front().pose.position.x, 0.0);
  EXPECT_NEAR(path.poses.back().pose.position.x, 25.0, 0.5);
  double north_m = 0.0;
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const auto &a = path.poses[i - 1].pose, &b = path.poses[i].pose;
    const double dx = b.position.x - a.position.x, dy = b.position.y - a.position.y;
    EXPECT_LE(std::hypot(dx, dy), 0.5 + 1e-9);
    const double heading = 2.0 * std::atan2(a.orientation.z, a.orientation.w);
    EXPECT_NEAR(std::remainder(heading - std::atan2(dy, dx), 2.0 * std::numbers::pi), 0.0, 1e-6);
    north_m = std::fmax(north_m, b.position.y);
  }
  EXPECT_GT(north_m, 18.0);  // where the wall is open
}

#ifdef TALUS_NAV2_MAIN
TEST_F(Nav2, ViaPointsArePassedInOrder) {
  start();
  via_ = {pose(3.0, 20.0), pose(20.0, 20.0)};
  const auto path = plan(pose(0.0, 8.0), pose(25.0, 8.0));
  std::size_t next = 0;
  for (const auto& each : path.poses)
    if (next < via_.size() && std::hypot(each.pose.position.x - via_[next].pose.position.x,
                                         each.pose.position.y - via_[next].pose.position.y) < 1e-6)
      ++next;
  EXPECT_EQ(next, via_.size());
}
#endif

template <typename Exception>
void expect(const std::function<void()>& work, const std::string& word) {
  try {
    work();
    ADD_FAILURE() << word;
  } catch (const Exception& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(word));
    EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
  } catch (const std::exception& other) {
    ADD_FAILURE() << "another exception: " << other.what();
  }
}

TEST_F(Nav2, EachFailureHasItsTypedException) {
  start(true);
  expect<nav2_core::StartOutsideMapBounds>([&] { plan(pose(-50.0, 8.0), pose(25.0, 8.0)); }, "");
  expect<nav2_core::GoalOutsideMapBounds>([&] { plan(pose(0.0, 8.0), pose(900.0, 8.0)); }, "");
  expect<nav2_core::StartOccupied>([&] { plan(pose(10.7, 8.0), pose(25.0, 8.0)); }, "");
  expect<nav2_core::GoalOccupied>([&] { plan(pose(0.0, 8.0), pose(10.7, 8.0)); }, "");
  expect<nav2_core::NoValidPathCouldBeFound>([&] { plan(pose(0.0, 8.0), pose(25.0, 8.0)); }, "");
  expect<nav2_core::PlannerTFError>([&] { plan(pose(0.0, 8.0, "odom"), pose(25.0, 8.0)); },
                                    "start: frame 'odom', map 'map': frame 'odom' does not exist");
  expect<nav2_core::PlannerCancelled>([&] { plan(pose(0.0, 8.0), pose(5.0, 8.0), [] { return true; }); },
                                      "cancelled");
  expect<nav2_core::PlannerException>([&] { plan(pose(NAN, 8.0), pose(5.0, 8.0)); }, "");
  planner_->cleanup();
  expect<nav2_core::PlannerException>([&] { plan(pose(0.0, 8.0), pose(5.0, 8.0)); }, "not active");
}

TEST_F(Nav2, CancelRequestEndsPlanning) {
  node_->parameters["talus.planner"] = std::string("RRTstar");
  node_->parameters["talus.time_limit_s"] = 86400.0;
  start();
  std::atomic<int> looks{0};
  expect<nav2_core::PlannerCancelled>(
      [&] { plan(pose(0.0, 8.0), pose(25.0, 8.0), [&] { return ++looks > 3; }); }, "cancelled");
  EXPECT_EQ(looks, 4);
}

TEST_F(Nav2, InvalidParametersYieldOneLine) {
  const auto refused = [&](auto& parameters, const std::string& name, std::any value,
                           const std::string& word) {
    const auto before = parameters;
    parameters[name] = std::move(value);
    expect<nav2_core::PlannerException>(
        [&] {
          planner_->configure(node_, "talus", nullptr, std::make_shared<nav2_costmap_2d::Costmap2DROS>());
        },
        word);
    parameters = before;
  };
  refused(rclcpp::Node::overrides, "map_file", std::string("/nowhere/site.ot"),
          "talus_map: /nowhere/site.ot");
  rclcpp::Node::overrides["map_file"] = std::string();
  refused(rclcpp::Node::overrides, "rover", std::string("mr"), "mer");
  refused(rclcpp::Node::overrides, "resolution_m", 0.0, "resolution_m and size_m");
  refused(node_->parameters, "talus.planner", std::string("feild"), "field");
  refused(node_->parameters, "talus.path_spacing_m", 0.0, "path_spacing_m must be > 0");
}

TEST_F(Nav2, PosesInAnotherFrameAreTransformed) {
  start();
  auto& odom = tf2_ros::Buffer::known["odom"];
  odom.transform.translation.x = 10.0;
  odom.transform.rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};  // x of odom points north
  const auto path = plan(pose(8.0, -5.0, "odom"), pose(15.0, 8.0));
  EXPECT_EQ(path.header.frame_id, "map");
  EXPECT_NEAR(path.poses.front().pose.position.x, 15.0, 1e-9);
  EXPECT_NEAR(path.poses.front().pose.position.y, 8.0, 1e-9);
}

TEST_F(Nav2, ReceivedHeightsChangeTheNextPlan) {
  start();
  const auto before = plan(pose(15.0, 8.0), pose(25.0, 8.0));
  EXPECT_LE(before.poses.size(), 22U);  // straight
  EXPECT_EQ(before.poses.back().pose.position.z, 0.0);
  hear(plateau({20.0, 9.0, 2.0, 12.0}, 1.0F));  // a wall from y = 3 to y = 15
  const auto after = plan(pose(15.0, 8.0), pose(25.0, 8.0));
  EXPECT_TRUE(log().empty());
  EXPECT_GT(after.poses.size(), before.poses.size() + 10);
  hear(plateau({24.0, 8.0, 6.0, 6.0}, 0.05F));
  EXPECT_FLOAT_EQ(static_cast<float>(plan(pose(15.0, 8.0), pose(25.0, 8.0)).poses.back().pose.position.z),
                  0.05F);
}

TEST_F(Nav2, ConcurrentGoalsAndMapUpdatesAllReturnAPlan) {
  start();
  std::atomic<bool> over{false};
  std::jthread messages([&] {
    for (int k = 0; !over; ++k) hear(plateau({24.0, 8.0, 6.0, 6.0}, k % 2 == 0 ? 0.0F : 0.05F));
  });
  for (int k = 0; k < 100; ++k)
    EXPECT_NEAR(plan(pose(15.0, 8.0), pose(25.0, 8.0)).poses.back().pose.position.x, 25.0, 0.5);
  over = true;
  messages.join();
  EXPECT_TRUE(log().empty());
}

TEST_F(Nav2, DeactivationEndsARunningPlan) {
  node_->parameters["talus.planner"] = std::string("RRTstar");
  node_->parameters["talus.time_limit_s"] = 86400.0;
  start();
  std::atomic<bool> planning{false};
  std::jthread server([&] {
    while (!planning) std::this_thread::yield();
    planner_->deactivate();
    planner_->cleanup();
  });
  expect<nav2_core::PlannerCancelled>(
      [&] {
        plan(pose(0.0, 8.0), pose(25.0, 8.0), [&] {
          planning = true;
          return false;
        });
      },
      "cancelled");
  server.join();
  expect<nav2_core::PlannerException>([&] { plan(pose(0.0, 8.0), pose(5.0, 8.0)); }, "not active");
}

}  // namespace
}  // namespace talus_ros2
