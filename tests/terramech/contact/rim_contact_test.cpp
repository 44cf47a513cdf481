#include <cmath>
#include <numbers>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/rim_contact.hpp>

namespace talus::terramech {

namespace rim_contact_test {

TEST(SideBulldozing, FrictionlessResistanceIsCohesionAndWeightTerm) {
  // Closed form: phi = 0 gives X = 45 deg, D1 = 2, D2 = 1, R = 2 c h + gamma h^2.
  const Hegedus soil = hegedus({.cohesion_Pa = 500.0, .tan_friction = 0.0, .weight_N_m3 = 15000.0});
  EXPECT_NEAR(soil.resistance_N_m(0.03), 2.0 * 500.0 * 0.03 + 15000.0 * 0.03 * 0.03, 1e-9);
}

TEST(SideBulldozing, FrictionalResistanceMatchesHegedus) {
  // Closed form: phi = 30 deg, X = 30 deg, cot X = sqrt 3, D1 = 2 sqrt 3, D2 = sqrt 3 + 3 / sqrt 3 = 2 sqrt
  // 3.
  const Hegedus soil =
      hegedus({.cohesion_Pa = 100.0, .tan_friction = 1.0 / std::sqrt(3.0), .weight_N_m3 = 1000.0});
  EXPECT_NEAR(soil.per_depth_Pa, 2.0 * std::sqrt(3.0) * 100.0, 1e-9);
  EXPECT_NEAR(soil.per_depth_squared_N_m3, 0.5 * 12.0 * 1000.0, 1e-8);
}

TEST(SideBulldozing, FaceResistanceIsTheIntegralOverTheChord) {
  const Hegedus soil{.per_depth_Pa = 700.0, .per_depth_squared_N_m3 = 50000.0};
  const double r = 0.2;
  for (const double theta_1 : {0.003, 0.05, 0.0999, 0.1001, 0.3, 0.9, 0.5 * std::numbers::pi}) {
    double sum = 0.0;
    const int n = 20000;
    for (int k = 0; k < n; ++k) {
      const double theta = theta_1 * ((k + 0.5) / n);
      // r (cos theta - cos theta_1) without cancellation
      const double h = 2.0 * r * std::sin(0.5 * (theta_1 + theta)) * std::sin(0.5 * (theta_1 - theta));
      sum += 2.0 * soil.resistance_N_m(h) * r * std::cos(theta) * theta_1 / n;
    }
    // Property: the closed form equals the integral; the midpoint rule with 20000 intervals is accurate to
    // 1e-8.
    EXPECT_NEAR(faceResistance_N(soil, {r, theta_1}) / sum, 1.0, 1e-7) << theta_1;
  }
}

const Wheel kWheel{.radius_m = 0.1, .width_m = 0.1};

TEST(ContactGeometry, EntryAngleIsArccosOfOneMinusSinkageOverRadius) {
  // Closed form: thesis text before Eq. 3.12 (corrected: arccos, not arctan).
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.05), std::numbers::pi / 3.0, 1e-15);
  EXPECT_NEAR(entryAngle_rad(kWheel, 0.1), std::numbers::pi / 2.0, 1e-15);
  EXPECT_EQ(entryAngle_rad(kWheel, 0.0), 0.0);
}

TEST(ContactGeometry, EntryAngleIsAccurateAtSmallSinkage) {
  // Closed form: theta_1 = sqrt(2 z/r) (1 + z/(12 r) + ...); arccos(1 - z/r) is accurate to half of the
  // digits only.
  const double ratio = 1e-10;
  EXPECT_NEAR(entryAngle_rad(kWheel, ratio * 0.1) / std::sqrt(2.0 * ratio), 1.0 + ratio / 12.0, 1e-15);
}

TEST(ContactGeometry, SinkageInvertsEntryAngle) {
  // Property: sinkage and entry angle are inverse to each other.
  for (const double z : {1e-9, 1e-3, 0.03, 0.15}) {
    EXPECT_NEAR(sinkage_m(kWheel, entryAngle_rad(kWheel, z)), z, 1e-14 * (z + 1e-9));
  }
}

TEST(ContactGeometry, ChordIsTwiceRadiusTimesSineOfEntryAngle) {
  // Closed form: 2 r sin(theta_1).
  EXPECT_NEAR(contactChord_m(kWheel, 0.02), 0.2 * std::sin(entryAngle_rad(kWheel, 0.02)), 1e-16);
}

TEST(ContactGeometry, InvalidSinkageIsRejected) {
  EXPECT_REFUSED(entryAngle_rad(kWheel, -1e-6), std::invalid_argument,
                 "sinkage_m = -1e-06, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, 0.2), std::invalid_argument, "sinkage_m = 0.2, must be in [0, 0.2]");
  EXPECT_REFUSED(entryAngle_rad(kWheel, std::nan("")), std::invalid_argument,
                 "sinkage_m = nan, must be finite");
}

ShearDisplacement at(double slip, double entry = 0.6) {
  return ShearDisplacement{{0.2, slip, entry}};
}

TEST(ShearDisplacement, IsEquationC6ForDrivenWheels) {
  const double entry = 0.6, theta = 0.1;
  // Closed form: C.6.
  EXPECT_DOUBLE_EQ(at(0.3).at_m(theta), 0.2 * ((entry - theta) - 0.7 * (std::sin(entry) - std::sin(theta))));
  EXPECT_DOUBLE_EQ(at(1.0).at_m(theta), 0.2 * (entry - theta));  // spinning in place: the arc rolled
}

TEST(ShearDisplacement, IntegratesTheSlidingVelocityOfARimPoint) {
  // Closed form: dj = (r omega - v cos theta) dt with d theta = -omega dt; v/(r omega) = 1/(1 + slip) for a
  // braked wheel.
  for (const double slip : {-0.6, -0.2, 0.0, 0.4}) {
    const double q = slip < 0.0 ? 1.0 / (1.0 + slip) : 1.0 - slip;
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double theta = 0.6 - 0.5 * (k + 0.5) / kSteps;
      sum += 0.2 * (1.0 - q * std::cos(theta)) * 0.5 / kSteps;
    }
    EXPECT_NEAR(at(slip).at_m(0.1), sum, 1e-10) << slip;
  }
}

TEST(ShearDisplacement, LockedWheelHasInfiniteShearDisplacement) {
  EXPECT_EQ(at(-1.0).at_m(0.3), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(at(-1.0).signChange_rad(0.0)));
}

TEST(ShearDisplacement, SignChangesOnlyForTowedWheelsAtSmallNegativeSlip) {
  EXPECT_TRUE(std::isnan(at(0.0).signChange_rad(0.0)));
  EXPECT_TRUE(std::isnan(at(-0.5).signChange_rad(0.0)));  // the rim is slower than the soil from the entry on
  const double zero = at(-0.1).signChange_rad(0.0);
  ASSERT_GT(zero, 0.0);
  EXPECT_NEAR(at(-0.1).at_m(zero), 0.0, 1e-15);
  EXPECT_GT(at(-0.1).at_m(zero + 0.05), 0.0);
  EXPECT_LT(at(-0.1).at_m(zero - 0.05), 0.0);
}

/// Uniform pressure, no shear, contact from theta_1 to theta_2 = -theta_1; all integrals have closed forms.
struct EvenPressure {
  double pressure_Pa(double) const { return 5e3; }
  double shear_Pa(double, double) const { return 0.0; }
  double peak_rad(double) const { return 0.0; }
  double exit_rad(double entry) const { return -entry; }
};

/// Uniform shear in addition.
struct EvenShear : EvenPressure {
  double shear_Pa(double, double) const { return 2e3; }
};

const Wheel kLargeWheel{.radius_m = 0.2, .width_m = 0.1};

TEST(RimContact, UniformStressesIntegrateToClosedForm) {
  const ShearDisplacement displacement{{0.2, 0.3, 0.7}};
  const RimForces pressed = rimForces(EvenPressure{}, kLargeWheel, displacement);
  const double rb = 0.02;
  EXPECT_NEAR(pressed.load_N, rb * 5e3 * 2.0 * std::sin(0.7), 1e-9);  // Closed form.
  EXPECT_NEAR(pressed.drawbar_pull_N, 0.0, 1e-9);
  const RimForces sheared = rimForces(EvenShear{}, kLargeWheel, displacement);
  EXPECT_NEAR(sheared.torque_Nm, 0.2 * rb * 2e3 * 1.4, 1e-9);
  EXPECT_NEAR(sheared.drawbar_pull_N, rb * 2e3 * 2.0 * std::sin(0.7), 1e-9);
}

TEST(RimContact, EntryAngleBalancesTheLoad) {
  const double load = 0.02 * 5e3 * 2.0 * std::sin(0.9);
  const RimEquilibrium rim =
      rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = load, .slip = 0.0, .first_guess = 0.01});
  EXPECT_NEAR(rim.entry_angle_rad, 0.9, 1e-12);  // Closed form.
}

TEST(RimContact, LoadBeyondTheAxleIsRejected) {
  const double most = 0.02 * 5e3 * 2.0;
  EXPECT_NO_THROW(rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = 0.999 * most}));
  EXPECT_THROW(rimEquilibrium(EvenPressure{}, kLargeWheel, {.load_N = 1.001 * most}), std::domain_error);
}

}  // namespace rim_contact_test

}  // namespace talus::terramech
