#include "patched_map.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <unistd.h>

#include "elevation_message.hpp"
#include "small_site.hpp"

namespace talus_ros2 {
namespace {

class PatchedMapTest : public testing::Test {
 protected:
  PatchedMapTest() {
    talus::costmap::writeMap(smallSite(), file_);
    site_ = std::make_unique<PatchedMap>(file_, PatchedMap::Intake{.frame = "map"});
    std::filesystem::remove(file_);
  }
  float heightAt(double x_m, double y_m) const {
    return static_cast<float>(site_->published()->elevation_m({x_m, y_m}).value());
  }
  // Refused in one line, and nothing changes.
  void refused(const grid_map_msgs::msg::GridMap& message, const std::string& word) {
    const auto before = site_->published();
    try {
      site_->see(message, now_);
      ADD_FAILURE() << "taken, without: " << word;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(word));
      EXPECT_THAT(error.what(), testing::Not(testing::HasSubstr("\n")));
    }
    EXPECT_EQ(site_->published(), before);
  }

  const std::string file_ =
      (std::filesystem::temp_directory_path() / ("talus-site-" + std::to_string(::getpid()))).string();
  const rclcpp::Time now_{7000000000, RCL_ROS_TIME};
  std::unique_ptr<PatchedMap> site_;
};

TEST_F(PatchedMapTest, MessageHeightsAreAssignedForAnyStartIndex) {
  grid_map::GridMap ring({"elevation"});
  ring.setGeometry({6.0, 4.0}, 0.5, {20.0, 10.0});
  ring.setStartIndex({5, 3});
  // By the definition of grid_map: the middle of index (i, j), unwrapped, lies at position + (length - resolution) / 2 -
  // (i, j) resolution.
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
      ring.get("elevation")((i + 5) % 12, (j + 3) % 8) =
          static_cast<float>(0.01 * (22.75 - 0.5 * i) + 0.001 * (11.75 - 0.5 * j));
  site_->see(messageOf(ring), now_);
  for (const double x : {17.25, 20.25, 22.75})
    for (const double y : {8.25, 11.75}) EXPECT_NEAR(heightAt(x, y), 0.01 * x + 0.001 * y, 1e-6);
}

TEST_F(PatchedMapTest, InvalidMessagesAreRejectedWithOneLine) {
  const auto good = plateau({2.0, 2.0}, {20.0, 10.0}, 0.1F);
  const auto with = [&](auto change) {
    auto message = good;
    change(message);
    return message;
  };
  using Message = grid_map_msgs::msg::GridMap;
  refused(Message(with([](Message& m) { m.info.length_x = 0.0; })), "empty: 0.000000 m x 2");
  refused(Message(with([](Message& m) { m.info = {}; })), "empty");
  refused(with([](Message& m) { m.info.resolution = NAN; }), "empty");
  refused(with([](Message& m) { m.info.length_x = 1e9; }), "more than 16777216 cells");
  refused(with([](Message& m) { m.info.pose.position.x = NAN; }), "position is not finite");
  refused(with([](Message& m) { m.info.pose.orientation.z = 0.7; }), "turned against its frame");
  refused(with([](Message& m) { m.header.frame_id = "odom"; }), "frame 'odom', must be 'map'");
  refused(with([](Message& m) { m.header.stamp.sec = 4; }), "stamp is 3.000000 s old, must be <= 2");
  refused(with([](Message& m) { m.header.stamp.sec = 60; }), "stamp is -53.000000 s old");
  refused(with([](Message& m) { m.layers = {"height"}; }), "no layer 'elevation'");
  refused(with([](Message& m) { m.layers = {}; }), "no layer 'elevation'");
  refused(with([](Message& m) { m.data.clear(); }), "has no data");
  refused(with([](Message& m) { m.data[0].data.pop_back(); }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.data[0].layout.data_offset = 4000000000U; }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.data[0].layout.dim.clear(); }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.data[0].layout.dim[0].label = "row_index"; }), "is not 4 x 4 values");
  refused(with([](Message& m) { m.inner_start_index = 4; }), "start index 0, 4 lies outside");
  refused(with([](Message& m) {
            m.info.resolution = 1.0;
            m.info.length_x = m.info.length_y = 4.0;
          }),
          "resolution 1");
  site_->see(good, now_);
  EXPECT_FLOAT_EQ(heightAt(20.0, 10.0), 0.1F);
}

TEST_F(PatchedMapTest, NanAndOutsideHeightsLeaveTheMapUnchanged) {
  const auto before = site_->published();
  site_->see(plateau({6.0, 4.0}, {20.0, 10.0}, NAN), now_);
  site_->see(plateau({6.0, 4.0}, {500.0, 10.0}, 1.0F), now_);
  EXPECT_EQ(site_->published(), before);
}

TEST_F(PatchedMapTest, WithoutAgeLimitAnyTimestampIsAccepted) {
  talus::costmap::writeMap(smallSite(), file_);
  PatchedMap patient(file_, {.frame = "map", .max_age_s = 0.0});
  std::filesystem::remove(file_);
  auto old = plateau({2.0, 2.0}, {20.0, 10.0}, 0.1F);
  old.header.stamp.sec = -400;
  const auto before = patient.published();
  patient.see(old, now_);
  EXPECT_NE(patient.published(), before);
}

}  // namespace
}  // namespace talus_ros2
