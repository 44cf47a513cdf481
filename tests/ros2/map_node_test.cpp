#include "map_node.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <nav2_core/planner_exceptions.hpp>

#include "nav2_planner.hpp"
#include "small_site.hpp"

namespace talus_ros2 {
namespace {

using Message = grid_map_msgs::msg::GridMap;

geometry_msgs::msg::TransformStamped placed(double x_m, double y_m, double yaw_rad, double pitch_rad = 0.0) {
  geometry_msgs::msg::TransformStamped at;
  at.transform.translation = {x_m, y_m, 0.0};
  const Eigen::Quaterniond q(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  at.transform.rotation = {q.x(), q.y(), q.z(), q.w()};
  return at;
}

class MapNodeTest : public RosTest {
 protected:
  float heightAt(double x_m, double y_m) const {
    return static_cast<float>(map_->published()->elevation_m({x_m, y_m}).value_or(NAN));
  }
  template <typename Sent>
  void refused(const Sent& message, const std::string& word, const std::string& topic = "elevation_map") {
    const auto before = map_->published();
    hear(message, topic);
    ASSERT_EQ(log().size(), 1U) << word;
    EXPECT_THAT(log().front(), testing::HasSubstr(topic + ": "));
    EXPECT_THAT(log().front(), testing::HasSubstr(word));
    EXPECT_EQ(map_->published(), before);
    log().clear();
  }
  void begin() { map_ = MapNode::shared(); }
  void beginUnknown(double resolution_m = 0.5) {
    rclcpp::Node::overrides["map_file"] = std::string();
    rclcpp::Node::overrides["resolution_m"] = resolution_m;
    begin();
  }

  std::shared_ptr<MapNode> map_;
};

TEST_F(MapNodeTest, AlignedHeightsAreTakenExactlyForAnyStartIndex) {
  begin();
  EXPECT_EQ(MapNode::shared(), map_);  // one map for all plugins of a process
  hear(heightsOn({20.0, 10.0, 6.0, 4.0, 0.5, 5, 3}, [](double x, double y) { return 0.01 * x + 0.001 * y; }));
  EXPECT_TRUE(log().empty());
  for (const double x : {17.25, 20.25, 22.75})
    for (const double y : {8.25, 11.75}) EXPECT_EQ(heightAt(x, y), static_cast<float>(0.01 * x + 0.001 * y));
  EXPECT_EQ(heightAt(16.75, 10.25), 0.0F);
}

// Property: a plane is the same plane in cells of any size, at any place and in any frame that TF knows.
TEST_F(MapNodeTest, APlaneIsTheSameInAnyResolutionAlignmentAndFrame) {
  begin();
  tf2_ros::Buffer::known["odom"] = placed(20.0, 12.0, 0.4);
  for (const double resolution_m : {0.1, 0.4, 0.5, 0.8}) {
    auto message = heightsOn({0.13, -0.07, 8.0, 8.0, resolution_m},
                             [](double x, double y) { return 0.1 * x - 0.05 * y; });
    message.header.frame_id = "odom";
    hear(message);
    ASSERT_TRUE(log().empty()) << log().front();
    // A cell has the highest of the points in it: at most half a cell of the slope above its centre.
    for (const double x : {19.25, 20.25, 21.25}) {
      const double dx = x - 20.0, dy = 11.75 - 12.0, u = dx * std::cos(0.4) + dy * std::sin(0.4),
                   v = dy * std::cos(0.4) - dx * std::sin(0.4);
      EXPECT_NEAR(heightAt(x, 11.75), 0.1 * u - 0.05 * v, resolution_m < 0.5 ? 0.04 : 1e-6) << resolution_m;
    }
  }
}

// Closed form: level ground, seen in a frame that is pitched by 0.1, is the plane z = tan(0.1) x of that frame.
TEST_F(MapNodeTest, ATiltedFrameIsLevelled) {
  begin();
  tf2_ros::Buffer::known["lidar"] = placed(20.0, 12.0, 0.0, 0.1);
  auto message = heightsOn({0.0, 0.0, 8.0, 6.0}, [](double x, double) { return std::tan(0.1) * x + 1.0; });
  message.header.frame_id = "lidar";
  hear(message);
  for (const double x : {18.25, 20.25, 22.25}) EXPECT_NEAR(heightAt(x, 12.25), std::cos(0.1), 1e-5);
  tf2_ros::Buffer::known["lidar"] = placed(20.0, 12.0, 0.0, 0.5);
  refused(message, "tilted by more than 20 degrees");
}

TEST_F(MapNodeTest, AWallBetweenCellsStaysAStep) {
  begin();
  hear(heightsOn({20.25, 10.0, 6.0, 6.0}, [](double x, double) { return x > 20.0 ? 0.6 : 0.0; }));
  int steps = 0;
  for (double x = 18.25; x < 22.0; x += 0.5)
    steps += std::abs(heightAt(x + 0.5, 10.25) - heightAt(x, 10.25)) > 0.5F;
  EXPECT_EQ(steps, 1);
}

TEST_F(MapNodeTest, InvalidMessagesAreRejectedWithOneLine) {
  begin();
  const Message good = plateau({20.0, 10.0, 2.0, 2.0}, 0.1F);
  const auto with = [&](auto change) {
    Message message = good;
    change(message);
    return message;
  };
  refused(with([](Message& m) { m.info.length_x = 0.0; }), "empty: 0.000000 m x 2");
  refused(with([](Message& m) { m.info.length_x = 1e9; }), "more than 16777216 cells");
  refused(with([](Message& m) { m.info.pose.position.x = NAN; }), "pose is not finite");
  refused(with([](Message& m) { m.header.frame_id = "odom"; }), "frame 'odom' does not exist");
  refused(with([](Message& m) { m.header.stamp.sec = 4; }), "stamp is 3.000000 s old, must be <= 2");
  refused(with([](Message& m) { m.header.stamp.sec = 60; }), "stamp is -53.000000 s old");
  refused(with([](Message& m) { m.layers = {"height"}; }), "no layer 'elevation'");
  refused(with([](Message& m) { m.data.clear(); }), "has no data");
  refused(with([](Message& m) { m.data[0].data.pop_back(); }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.data[0].layout.data_offset = 4000000000U; }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.data[0].layout.dim.clear(); }), "is not 4 x 4 values");
  const auto before = map_->published();
  hear(plateau({20.0, 10.0, 6.0, 4.0}, NAN));
  hear(plateau({500.0, 10.0, 6.0, 4.0}, 1.0F));
  EXPECT_EQ(map_->published(), before);
  hear(good);
  EXPECT_FLOAT_EQ(heightAt(20.25, 10.25), 0.1F);
}

TEST_F(MapNodeTest, InvalidWheelReadingsAreRejectedWithOneLine) {
  begin();
  const auto good = wheelsMessage({"x_m", "y_m", "load_N", "slip"}, {{20.0, 8.0, 36.0, 0.1}});
  auto bad = good;
  bad.data.pop_back();
  refused(bad, "not rows of 32 bytes", "wheels");
  bad = good;
  bad.fields[3].datatype = 2;
  refused(bad, "field 'slip' must be one FLOAT32 or FLOAT64", "wheels");
  bad = good;
  bad.fields[3].offset = 30;
  refused(bad, "field 'slip'", "wheels");
  refused(wheelsMessage({"x_m", "y_m", "slip"}, {{20.0, 8.0, 0.1}}), "load_N", "wheels");
}

TEST_F(MapNodeTest, WheelReadingsArePlacedByTf) {
  auto message = wheelsMessage({"wheel", "x_m", "y_m", "heading_rad", "load_N", "slip"},
                               {{3.0, 0.5, 0.25, 0.0, 36.0, 0.1}});
  const auto table =
      wheelsOf(message, isometryOf(geometry_msgs::msg::Point{10.0, 5.0, 0.0},
                                   placed(0.0, 0.0, 0.5 * std::numbers::pi).transform.rotation));
  EXPECT_NEAR(table.at("x_m")[0], 9.75, 1e-12);
  EXPECT_NEAR(table.at("y_m")[0], 5.5, 1e-12);
  EXPECT_NEAR(table.at("heading_rad")[0], 0.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(table.at("time_s")[0], 7.0);
  EXPECT_EQ((*table.findWords("wheel"))[0], "3");
}

TEST_F(MapNodeTest, AnUnknownMapMovesWithTheWindow) {
  beginUnknown();
  EXPECT_TRUE(std::isnan(heightAt(0.0, 0.0)));
  for (double x = 0.0; x < 100.0; x += 10.0) hear(plateau({x, -3.0, 16.0, 16.0}, 0.5F));
  EXPECT_TRUE(log().empty());
  EXPECT_EQ(heightAt(90.25, -3.25), 0.5F);
  EXPECT_EQ(heightAt(60.25, -3.25), 0.5F);
  EXPECT_FALSE(map_->published()->grid().cellAt({-20.0, 0.0}));
  hear(plateau({-5000.0, 0.0, 16.0, 16.0}, 0.25F));
  EXPECT_EQ(heightAt(-5000.25, 0.25), 0.25F);
}

TEST_F(MapNodeTest, CostAndCategoryArePublished) {
  begin();
  hear(plateau({33.0, 10.0, 2.0, 2.0}, 0.02F));
  rclcpp::Node& node = *rclcpp::Node::newest;
  node.timer->ring();
  node.timer->ring();
  const auto& sent =
      std::any_cast<std::shared_ptr<rclcpp::Publisher<Message>>>(node.publishers.at("~/ground"))->sent;
  ASSERT_EQ(sent.size(), 1U);  // once a version
  const auto layer = [&](const std::string& name, double x_m, double y_m) {
    const Heights heights = heightsOf(sent[0], name);
    return heights.z_m[{static_cast<int>((x_m + 5.0) / 0.5), static_cast<int>((y_m - 3.0) / 0.5)}];
  };
  EXPECT_EQ(sent[0].header.frame_id, "map");
  EXPECT_EQ(layer("category", 10.7, 8.0), 2.0F);  // the wall
  EXPECT_EQ(layer("category", 20.0, 8.0), 0.0F);
  EXPECT_EQ(layer("elevation", 33.2, 10.2), 0.02F);
  EXPECT_TRUE(std::isinf(layer("cost", 10.7, 8.0)));
  EXPECT_GT(layer("cost", 20.0, 8.0), 0.0F);
  EXPECT_GT(layer("drawbar_pull", 20.0, 8.0), 0.0F);
}

/// A rover that knows neither heights nor soil at first. It sees gentle hills in a window of its odometry's frame, plans,
/// drives a step of each path, and backs out by a step where there is no path, as Nav2's recovery does. Its wheels slip in a
/// pond of dust of 5 m radius on the straight way.
class Drive : public MapNodeTest, public testing::WithParamInterface<double> {
 protected:
  static bool soft(double x_m, double y_m) { return std::hypot(x_m - 20.0, y_m - 1.0) < 5.0; }

  void SetUp() override {
    RosTest::SetUp();
    tf2_ros::Buffer::known["odom"] = placed(3.0, -2.0, 0.3);
    beginUnknown(GetParam());
    planner_.configure(node_, "Talus", nullptr, nullptr);
    planner_.activate();
  }
  void look() {
    const auto& frame = tf2_ros::Buffer::known["odom"].transform;
    const Eigen::Isometry3d T_map_odom = isometryOf(frame.translation, frame.rotation);
    const Eigen::Vector3d here = T_map_odom.inverse() * Eigen::Vector3d(x_m_, y_m_, 0.0);
    auto seen =
        heightsOn({std::round(here.x()), std::round(here.y()), 16.0, 16.0, 0.2}, [&](double x, double y) {
          const Eigen::Vector3d p = T_map_odom * Eigen::Vector3d(x, y, 0.0);
          return 0.3 * std::sin(0.2 * p.x()) * std::cos(0.15 * p.y());
        });
    seen.header.frame_id = "odom";
    hear(seen);
  }
  void feel() {
    tf2_ros::Buffer::known["base_link"] = placed(x_m_, y_m_, heading_rad_);
    std::vector<std::vector<double>> rows;
    for (const double x : {-0.6, 0.6})
      for (const double y : {-0.5, 0.5}) {
        const double px = x_m_ + x * std::cos(heading_rad_) - y * std::sin(heading_rad_),
                     py = y_m_ + x * std::sin(heading_rad_) + y * std::cos(heading_rad_);
        const bool weak = soft(px, py);
        met_ += weak;
        rows.push_back({double(rows.size()), x, y, 0.0, 110.0, weak ? 0.55 : 0.03, weak ? 0.06 : 0.01, 0.1});
      }
    auto message = wheelsMessage(
        {"wheel", "x_m", "y_m", "heading_rad", "load_N", "slip", "sinkage_m", "pose_std_m"}, rows);
    message.header.frame_id = "base_link";
    hear(message, "wheels");
  }
  nav_msgs::msg::Path plan(const geometry_msgs::msg::PoseStamped& start,
                           const geometry_msgs::msg::PoseStamped& goal) {
    nav2_core::GlobalPlanner& planner = planner_;
#ifdef TALUS_NAV2_MAIN
    return planner.createPlan(start, goal, {}, [] { return false; });
#else
    return planner.createPlan(start, goal, [] { return false; });
#endif
  }
  // Drives to (40, 0) and returns the metres that the rover's middle was driven in the dust, with wheels that tell from the first of
  // them there on.
  double drive(bool learns) {
    geometry_msgs::msg::PoseStamped start, goal;
    start.header.frame_id = goal.header.frame_id = "map";
    goal.pose.position = {40.0, 0.0, 0.0};
    double dust_m = 0.0;
    std::vector<std::pair<double, double>> track{{x_m_, y_m_}};
    for (int step = 0; step < 300 && std::hypot(x_m_ - 40.0, y_m_) > 1.0; ++step) {
      rclcpp::AnyNode::clock_s += 10;
      look();
      if (learns) feel();
      start.pose.position = {x_m_, y_m_, 0.0};
      std::pair<double, double> next = track.back();
      try {
        const auto path = plan(start, goal);
        std::size_t k = 1;
        do next = {path.poses[k].pose.position.x, path.poses[k].pose.position.y};
        while (std::hypot(next.first - x_m_, next.second - y_m_) < 0.75 && ++k < path.poses.size());
        track.emplace_back(x_m_, y_m_);
        heading_rad_ = std::atan2(next.second - y_m_, next.first - x_m_);
      } catch (const nav2_core::PlannerException&) {
        track.pop_back();
      }
      if (soft(next.first, next.second) && (met_ > 0 || !learns))
        dust_m += std::hypot(next.first - x_m_, next.second - y_m_);
      std::tie(x_m_, y_m_) = next;
    }
    EXPECT_TRUE(log().empty()) << log().front();
    EXPECT_LE(std::hypot(x_m_ - 40.0, y_m_), 1.0);
    return dust_m;
  }
  void TearDown() override {
    rclcpp::AnyNode::clock_s = 7;
    RosTest::TearDown();
  }

  std::shared_ptr<nav2_core::GlobalPlanner::Node> node_ = std::make_shared<nav2_core::GlobalPlanner::Node>();
  Nav2Planner planner_;
  double x_m_ = 0.0, y_m_ = 0.0, heading_rad_ = 0.0;
  int met_ = 0;  // readings of wheels in the dust
};

INSTANTIATE_TEST_SUITE_P(SidesOfCells, Drive, testing::Values(0.5, 0.3, 0.2));

// Property: on slopes alone the way leads through the dust.
TEST_P(Drive, SlopesAloneLeadThroughSoftGround) {
  EXPECT_GT(drive(false), 9.0);
}
// Property: the wheels meet the dust at its edge, and the next plans lead around it, also where the window moves often.
TEST_P(Drive, SoftGroundIsMetLearnedAndAvoided) {
  EXPECT_LT(drive(true), 0.5);
  EXPECT_GT(met_, 0);
}

}  // namespace
}  // namespace talus_ros2
