#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <talus/terramech/mobility/rover_stance.hpp>

namespace talus::terramech {
namespace rover_stance_test {

Rover rover(int wheels = 4) {
  return {.name = "box",
          .mass_kg = 40.0,
          .wheel_count = wheels,
          .wheel = {},
          .wheelbase_m = 0.8,
          .track_m = 0.6,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 20.0};
}

TEST(RoverStance, PitchAndRollTransferLoad) {
  const RoverStance stance{rover()};
  const auto n = stance.shares({0.2, 0.1});
  // Closed form: load transfer h/L tan(pitch) and h/T tan(roll), half at each wheel.
  const double back = 0.3 / 0.8 * 0.2 / 2.0, right = 0.3 / 0.6 * 0.1 / 2.0;
  EXPECT_NEAR(n[0], 0.25 - back - right, 1e-12);  // front left, uphill in both directions
  EXPECT_NEAR(n[1], 0.25 - back + right, 1e-12);
  EXPECT_NEAR(n[2], 0.25 + back - right, 1e-12);
  EXPECT_NEAR(n[3], 0.25 + back + right, 1e-12);
}

TEST(RoverStance, ForcesAndMomentsBalance) {
  for (const int wheels : {4, 6, 8}) {
    Rover r = rover(wheels);
    r.centre_of_mass_ahead_m = 0.1;
    r.centre_of_mass_left_m = -0.05;
    const RoverStance stance{r};
    for (const Planar demand : {Planar{0.0, 0.0}, Planar{0.3, -0.2}, Planar{-0.5, 0.4}, Planar{0.7, 0.5}}) {
      const auto n = stance.shares(demand);
      double sum = 0.0, x = 0.0, y = 0.0;
      for (int k = 0; k < wheels; ++k) {
        const double share = n[static_cast<std::size_t>(k)];
        EXPECT_GE(share, 0.0);
        sum += share;
        x += share * stance.position_m(k).x;
        y += share * stance.position_m(k).y;
      }
      // Closed form: the resultant of the normal forces meets the line of the weight in the plane, with or
      // without lifted wheels.
      EXPECT_NEAR(sum, 1.0, 1e-12);
      EXPECT_NEAR(x, 0.1 - 0.3 * demand.x, 1e-9) << wheels << ' ' << demand.x;
      EXPECT_NEAR(y, -0.05 - 0.3 * demand.y, 1e-9) << wheels << ' ' << demand.y;
    }
  }
}

TEST(RoverStance, StabilityMarginIsZeroAtTheTippingSlope) {
  const RoverStance stance{rover()};
  // Closed form: half the base over the height, half the track over the height.
  EXPECT_NEAR(stance.stabilityMargin_rad({0.4 / 0.3, 0.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, 1.0}), 0.0, 1e-12);
  EXPECT_NEAR(stance.stabilityMargin_rad({0.0, -0.5}), std::atan(1.0) - std::atan(0.5), 1e-12);
  EXPECT_LT(stance.stabilityMargin_rad({0.0, 1.1}), 0.0);
}

TEST(RoverStance, WithoutCentreOfMassHeightLoadsAreEqualAndMarginIsNan) {
  Rover r = rover();
  r.centre_of_mass_height_m = 0.0;
  const RoverStance stance{r};
  EXPECT_EQ(stance.shares({0.4, 0.3})[0], 0.25);  // Closed form
  EXPECT_TRUE(std::isnan(stance.stabilityMargin_rad({0.1, 0.0})));
}

std::string refusal(const Rover& r) {
  try {
    const RoverStance stance{r};
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return {};
}

TEST(RoverStance, InvalidGeometryIsRejected) {
  Rover r = rover();
  r.centre_of_mass_ahead_m = 0.5;
  EXPECT_NE(refusal(r).find("rover 'box': centre_of_mass_ahead_m = 0.5"), std::string::npos) << refusal(r);
  r = rover();
  r.track_m = 0.0;
  EXPECT_NE(refusal(r).find("track_m = 0, must be > 0"), std::string::npos) << refusal(r);
  EXPECT_NE(refusal(rover(1)).find("wheels.count = 1"), std::string::npos);
  EXPECT_NE(refusal(rover(3)).find("must be even, 4 to 12"), std::string::npos) << refusal(rover(3));
}

}  // namespace rover_stance_test
}  // namespace talus::terramech
