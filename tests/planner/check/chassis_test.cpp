#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stop_token>

#include <Eigen/Dense>
#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/problem.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace chassis_test {

terramech::Rover rover(int wheels) {
  terramech::Rover made{.name = "cart",
                        .mass_kg = 100.0,
                        .wheel_count = wheels,
                        .wheelbase_m = 1.2,
                        .track_m = 1.0,
                        .clearance_m = 0.3,
                        .max_pitch_rad = 0.5,
                        .max_roll_rad = 0.5,
                        .max_torque_Nm = 10.0};
  return made;
}

maps::Raster<float> terrain(unsigned seed, double roughness_m, double resolution_m) {
  const int side = static_cast<int>(std::lround(8.0 / resolution_m));
  maps::Raster<float> made({.width = side, .height = side, .resolution_m = resolution_m, .south_west = {}});
  std::mt19937 random(seed);
  std::normal_distribution<double> rough(0.0, roughness_m);
  const double east = 0.3 * rough(random) / roughness_m, north = 0.3 * rough(random) / roughness_m;
  for (int r = 0; r < side; ++r)
    for (int c = 0; c < side; ++c)
      made[{c, r}] = static_cast<float>(resolution_m * (0.5 * east * c + 0.5 * north * r) + rough(random));
  return made;
}

// Attitude of the body: rises of its axes; the heading is given.
struct Body {
  double along_rise, across_rise;  // sin of pitch and of roll
  double z_m;                      // height of the contact plane at the centre

  struct Spot {
    double x, y, z;
  };

  Spot at(const Pose& pose, double x, double y, double up) const {
    const double c = std::sqrt(1.0 - along_rise * along_rise);
    // y is perpendicular to x = (c, 0, a): y = (-a b / c, sqrt(1 - b^2 - (a b / c)^2), b); z = x cross y.
    const double ahead = -along_rise * across_rise / c;
    const double side = std::sqrt(1.0 - across_rise * across_rise - ahead * ahead);
    const double dx = x * c + y * ahead - up * along_rise * side;
    const double dy = y * side + up * (along_rise * ahead - c * across_rise);
    const double dz = x * along_rise + y * across_rise + up * c * side;
    const double h = pose.heading_rad;
    return {pose.place.x_m + std::cos(h) * dx - std::sin(h) * dy,
            pose.place.y_m + std::sin(h) * dx + std::cos(h) * dy, z_m + dz};
  }
};

std::vector<std::pair<double, double>> wheelsOf(int count) {
  std::vector<std::pair<double, double>> wheels;
  const int axles = count / 2;
  for (int k = 0; k < axles; ++k)
    for (const double y : {0.5, -0.5})
      wheels.push_back({1.2 * (0.5 - static_cast<double>(k) / (axles - 1)), y});
  return wheels;
}

double groundAt(const maps::Raster<float>& terrain, const Body::Spot& spot) {
  return maps::elevationAt(terrain, {spot.x, spot.y}).value_or(NAN);
}

// Body resting on three given wheels: the plane through the ground at the wheels, by iteration.
Body onThree(const maps::Raster<float>& ground, const Pose& pose,
             const std::array<std::pair<double, double>, 3>& feet) {
  Body body{0.0, 0.0, 0.0};
  for (int n = 0; n < 80; ++n) {
    Eigen::Matrix3d places;
    Eigen::Vector3d heights;
    for (int k = 0; k < 3; ++k) {
      const auto [x, y] = feet[static_cast<std::size_t>(k)];
      places.row(k) << x, y, 1.0;
      heights[k] = groundAt(ground, body.at(pose, x, y, 0.0));
    }
    const Eigen::Vector3d plane = places.colPivHouseholderQr().solve(heights);
    if (!(std::hypot(plane[0], plane[1]) < 0.9)) return {NAN, NAN, NAN};
    body = {plane[0], plane[1], plane[2]};
  }
  return body;
}

// All stable attitudes by brute force: three wheels on the ground, the others on or above it.
std::vector<Body> settled(const maps::Raster<float>& ground, const Pose& pose, int count) {
  const auto wheels = wheelsOf(count);
  std::vector<Body> bodies;
  for (std::size_t i = 0; i < wheels.size(); ++i)
    for (std::size_t j = i + 1; j < wheels.size(); ++j)
      for (std::size_t k = j + 1; k < wheels.size(); ++k) {
        if (wheels[i].second == wheels[j].second && wheels[j].second == wheels[k].second)
          continue;  // the centre of mass lies outside the three wheels
        const Body body = onThree(ground, pose, {wheels[i], wheels[j], wheels[k]});
        bool stands = true;
        for (const auto& [x, y] : wheels) {
          const auto spot = body.at(pose, x, y, 0.0);
          stands = stands && spot.z - groundAt(ground, spot) > -1e-7;  // false for NaN
        }
        if (stands) bodies.push_back(body);
      }
  return bodies;
}

// Kinematics of the rocker-bogie, derived independently: wheels on the ground, by iteration.
Body articulated(const maps::Raster<float>& ground, const Pose& pose) {
  Body body{0.0, 0.0, 0.0};
  for (int n = 0; n < 60; ++n) {
    double z[6];
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [x, y] = wheelsOf(6)[k];
      z[k] = groundAt(ground, body.at(pose, x, y, 0.0));
    }
    double pitch = 0.0, pivot[2];
    for (const std::size_t side : {0U, 1U}) {
      const double bogie = (z[side] + z[side + 2]) / 2, rear = z[side + 4];
      pitch += std::asin((bogie - rear) / 0.9) / 2;     // pivots of bogie and rear wheel 0.9 m apart
      pivot[side] = rear + (bogie - rear) * 2.0 / 3.0;  // the body's pivot 0.6 m from the rear wheel
    }
    body = {std::sin(pitch), pivot[0] - pivot[1], (pivot[0] + pivot[1]) / 2};  // a track of 1 m
  }
  return body;
}

double clearanceOf(const maps::Raster<float>& ground, const Pose& pose, const Body& body) {
  double least = INFINITY;
  for (double x = -0.6; x <= 0.6001; x += 0.04)
    for (double y = -0.5; y <= 0.5001; y += 0.04) {
      const auto spot = body.at(pose, x, y, 0.3);
      least = std::min(least, spot.z - groundAt(ground, spot));
    }
  return least;
}

void expectInside(const Stance& stance, const Body& body, double clearance_m, const std::string& what) {
  EXPECT_LE(stance.pitch_rad.low, std::asin(body.along_rise) + 1e-6) << what;
  EXPECT_GE(stance.pitch_rad.high, std::asin(body.along_rise) - 1e-6) << what;
  EXPECT_LE(stance.roll_rad.low, std::asin(body.across_rise) + 1e-6) << what;
  EXPECT_GE(stance.roll_rad.high, std::asin(body.across_rise) - 1e-6) << what;
  EXPECT_LE(stance.clearance_m, clearance_m + 1e-6) << what;
}

bool withinLimits(const Body& body) {
  return std::abs(std::asin(body.along_rise)) < 0.5 && std::abs(std::asin(body.across_rise)) < 0.5;
}

TEST(Chassis, BoundsContainRigidBodyPoses) {
  // Property: for every attitude found by brute force, pitch, roll and clearance lie within the bounds; on
  // fine and coarse rasters, with four and six wheels.
  int tried = 0;
  for (unsigned seed = 1; seed <= 60; ++seed)
    for (const int wheels : {4, 6})
      for (const double resolution_m : {0.1, 0.5}) {
        const auto ground = terrain(seed, seed % 2 ? 0.02 : 0.06, resolution_m);
        const Pose pose{{4.0 + 0.01 * seed, 3.9}, 0.7 * seed};
        const Chassis chassis(ground, rover(wheels), Suspension::Rigid);
        const auto stance = chassis.stance(pose);
        ASSERT_TRUE(stance.has_value());
        for (const Body& body : settled(ground, pose, wheels)) {
          if (!withinLimits(body)) continue;
          ++tried;
          expectInside(*stance, body, clearanceOf(ground, pose, body), "seed " + std::to_string(seed));
        }
      }
  EXPECT_GT(tried, 300);
}

TEST(Chassis, BoundsContainRockerBogiePoses) {
  int tried = 0;
  for (unsigned seed = 1; seed <= 120; ++seed)
    for (const double resolution_m : {0.1, 0.5}) {
      const auto ground = terrain(seed, seed % 2 ? 0.02 : 0.06, resolution_m);
      const Pose pose{{4.0 + 0.01 * seed, 3.9}, 0.7 * seed};
      const Body body = articulated(ground, pose);
      if (!withinLimits(body)) continue;
      ++tried;
      const Chassis chassis(ground, rover(6), Suspension::RockerBogie);
      const auto stance = chassis.stance(pose);
      ASSERT_TRUE(stance.has_value());
      expectInside(*stance, body, clearanceOf(ground, pose, body), "seed " + std::to_string(seed));
    }
  EXPECT_GT(tried, 150);
}

TEST(Chassis, BoundsWithSlackContainNearbyPoses) {
  // Property: the bounds at a pose with slack contain the attitudes of every pose that moves no wheel
  // further than the slack.
  const auto ground = terrain(7, 0.04, 0.2);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int tried = 0;
  for (int k = 0; k < 300; ++k) {
    const Pose pose{{4.0 + unit(random), 4.0 + unit(random)}, 3.0 * unit(random)};
    const Pose near{{pose.place.x_m + 0.05 * unit(random), pose.place.y_m + 0.05 * unit(random)},
                    pose.heading_rad + 0.03 * unit(random)};
    const Chassis::Slack slack{0.0708, 0.0235};  // 0.05 each way; 0.03 rad at 0.78 m
    const Stance bogie = *Chassis(ground, rover(6), Suspension::RockerBogie).stance(pose, slack);
    if (const Body body = articulated(ground, near); withinLimits(body))
      ++tried, expectInside(bogie, body, clearanceOf(ground, near, body), "rocker-bogie");
    const Stance stiff = *Chassis(ground, rover(4), Suspension::Rigid).stance(pose, slack);
    for (const Body& body : settled(ground, near, 4))
      if (withinLimits(body)) ++tried, expectInside(stiff, body, clearanceOf(ground, near, body), "rigid");
  }
  EXPECT_GT(tried, 300);
}

TEST(Chassis, BoundsEqualTheSlopeOnAPlane) {
  maps::Raster<float> slope({.width = 40, .height = 40, .resolution_m = 0.2, .south_west = {}});
  for (int r = 0; r < 40; ++r)
    for (int c = 0; c < 40; ++c) slope[{c, r}] = static_cast<float>(0.2 * 0.2 * c);
  auto cart = rover(4);
  cart.max_roll_rad = 0.01;  // almost no tilt: the boxes are nearly points
  cart.max_pitch_rad = 0.21;
  const auto stance = Chassis(slope, cart, Suspension::Rigid).stance({{4.0, 4.0}, 0.0});
  ASSERT_TRUE(stance.has_value());
  // Closed form: 0.24 m over the 1.2 m of the chassis, along the map axis; the boxes add tan 0.2 times 2.5 %
  // of 0.78 m.
  EXPECT_NEAR(stance->pitch_rad.low, std::asin(0.2), 0.02);
  EXPECT_NEAR(stance->pitch_rad.high, std::asin(0.2), 0.02);
}

TEST(Chassis, RockBetweenTheWheelsViolatesGroundClearance) {
  maps::Raster<float> flat({.width = 80, .height = 80, .resolution_m = 0.1, .south_west = {}});
  flat[{40, 40}] = 0.4F;
  const auto cart = rover(4);
  const Chassis chassis(flat, cart, Suspension::Rigid);
  const Pose over{{4.05, 4.05}, 0.0}, beside{{4.05, 6.0}, 0.0};
  EXPECT_EQ(chassis.refusal(over), "ground clearance of the chassis too small");
  EXPECT_EQ(chassis.refusal(beside), "");
  const auto violations = chassis.violations(std::vector<maps::Point>{{1.5, 4.05}, {6.5, 4.05}});
  ASSERT_FALSE(violations.empty());
  for (const Violation& v : violations) EXPECT_LT(std::abs(v.place.x_m - 4.05), 1.5);
  EXPECT_TRUE(chassis.violations(std::vector<maps::Point>{{1.5, 6.0}, {6.5, 6.0}}).empty());
  EXPECT_NE(chassis.refusal({{0.2, 0.2}, 0.0}), "");  // half the rover beyond the edge
}

TEST(Chassis, TurnInPlaceChecksEveryWheelCircle) {
  // The front left wheel meets a rock 107 degrees along its circle, between the poses that are checked at
  // both ends and in the middle.
  maps::Raster<float> flat({.width = 80, .height = 80, .resolution_m = 0.1, .south_west = {}});
  const double around = 107.0 * kDegree;
  const auto cell = flat.grid().cellAt({4.0 + 0.781 * std::cos(around), 4.0 + 0.781 * std::sin(around)});
  flat[*cell] = 1.5F;
  auto cart = rover(4);
  cart.max_pitch_rad = cart.max_roll_rad = 0.2;  // almost no tilt: the wheels' boxes are small
  const Chassis chassis(flat, cart, Suspension::Rigid);
  for (const double heading : {0.0, std::numbers::pi / 4, std::numbers::pi / 2})
    EXPECT_EQ(chassis.refusal({{4.0, 4.0}, heading}), "") << heading;
  EXPECT_FALSE(
      chassis.violations(PosePath{.start = {{4.0, 4.0}, 0.0}, .legs = {{{}, std::numbers::pi / 2}}}).empty());
}

TEST(Chassis, RockerBogieRequiresSixWheels) {
  const maps::Raster<float> flat({.width = 8, .height = 8, .resolution_m = 1.0, .south_west = {}});
  EXPECT_REFUSED(Chassis(flat, rover(4), Suspension::RockerBogie), std::invalid_argument,
                 "wheels.count = 4, must be 6 for a rocker-bogie");
}

TEST(ChassisPlanner, RouteAvoidsInsufficientGroundClearance) {
  const auto map = testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
  maps::Raster<float> ground(map->grid());
  for (int r = 3; r < 20; ++r) ground[{10, r}] = 3.0F;  // a wall with a gap in the south
  const Chassis chassis(ground, rover(4), Suspension::Rigid);
  FieldPlanner field;
  const Problem problem{.map = map, .start = {3.5, 10.5}, .goal = {16.5, 10.5}};
  const auto plan = planOnChassis(problem, chassis, [&](const Problem& p) { return field.plan(p); });
  // The gap is two cells beside the edge of the raster: too narrow for wheels half a metre from the centre.
  EXPECT_EQ(plan.status, RouteStatus::NoneFound);
  EXPECT_NE(plan.reason.find("no detour found where"), std::string::npos) << plan.reason;
  for (int r = 3; r < 7; ++r) ground[{10, r}] = 0.0F;
  const auto open = planOnChassis(problem, chassis, [&](const Problem& p) { return field.plan(p); });
  ASSERT_EQ(open.status, RouteStatus::Found) << open.reason;
  EXPECT_TRUE(chassis.violations(open.points).empty());
  EXPECT_GT(open.cost_J, 140.0);
}

// Property: a search that is stopped does not report that no detour exists.
TEST(ChassisPlanner, StopYieldsCancelled) {
  const auto map = testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
  maps::Raster<float> ground(map->grid());
  for (int r = 3; r < 20; ++r) ground[{10, r}] = 3.0F;
  const Chassis chassis(ground, rover(4), Suspension::Rigid);
  FieldPlanner field;
  std::stop_source source;
  Problem problem{.map = map, .start = {3.5, 10.5}, .goal = {16.5, 10.5}};
  problem.watch.stop = source.get_token();
  int rounds = 0;
  const auto plan = planOnChassis(problem, chassis, [&](const Problem& p) {
    Plan found = field.plan(p);
    ++rounds;
    source.request_stop();
    return found;
  });
  EXPECT_EQ(plan.status, RouteStatus::Cancelled) << plan.reason;
  EXPECT_EQ(rounds, 1);
}

}  // namespace chassis_test
}  // namespace talus::planner
