#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

/// Tests of wheel_on_soil.hpp for a wheel that travels at an angle to its plane.
namespace talus::terramech {
namespace side_slip_test {

constexpr double kRight = 0.5 * std::numbers::pi;

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 300.0,
          .friction_angle_rad = 0.5,
          .sinkage_exponent = 1.1,
          .frictional_modulus = 1.2e6,
          .shear_modulus_m = 0.015};
}

Soil shearOnly(Soil soil) {
  soil.digging_exponent = soil.side_bulldozing = 0.0;
  return soil;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

TEST(SideSlip, ConvergesToTheStraightWheelAtZeroAngle) {
  for (const double slip : {-1.0, -0.6, -0.1, 0.0, 0.05, 0.4, 1.0}) {
    const WheelForces straight = equilibrium(sand(), {}, {.load_N = 60.0, .slip = slip});
    const WheelForces askew = equilibrium(sand(), {}, {.load_N = 60.0, .slip = slip, .slip_angle_rad = 1e-9});
    // Property: the forces are continuous in the slip angle, here 1e-9 rad.
    EXPECT_NEAR(askew.drawbar_pull_N, straight.drawbar_pull_N, 1e-6) << slip;
    EXPECT_NEAR(askew.torque_Nm, straight.torque_Nm, 1e-7) << slip;
    EXPECT_NEAR(askew.sinkage_m / straight.sinkage_m, 1.0, 1e-7) << slip;
    EXPECT_NEAR(askew.side_force_N, 0.0, 1e-5) << slip;
    EXPECT_EQ(straight.side_force_N, 0.0);
  }
}

TEST(SideSlip, SideForceIsOddAndOtherForcesEvenInSlipAngle) {
  Random random{5};
  for (int k = 0; k < 60; ++k) {
    const double slip = random.between(-1.0, 1.0), angle = random.between(1e-3, kRight);
    const WheelForces left = equilibrium(sand(), {}, {.load_N = 50.0, .slip = slip, .slip_angle_rad = angle});
    const WheelForces right =
        equilibrium(sand(), {}, {.load_N = 50.0, .slip = slip, .slip_angle_rad = -angle});
    // Property: mirror symmetry, exact in floating point.
    EXPECT_EQ(left.side_force_N, -right.side_force_N);
    EXPECT_EQ(left.drawbar_pull_N, right.drawbar_pull_N);
    EXPECT_EQ(left.torque_Nm, right.torque_Nm);
    EXPECT_EQ(left.sinkage_m, right.sinkage_m);
    EXPECT_LE(left.side_force_N, 0.0);
  }
}

TEST(SideSlip, LockedWheelOnHardGroundIsCoulombFriction) {
  Soil hard = shearOnly(sand());
  hard.cohesion_Pa = 0.0;
  hard.frictional_modulus = 1e22;
  hard.shear_modulus_m = 1e-9;
  const double mu = std::tan(hard.friction_angle_rad);
  for (const double angle : {0.2, 0.8, 1.3, kRight}) {
    const WheelForces f = equilibrium(hard, {}, {.load_N = 80.0, .slip = -1.0, .slip_angle_rad = angle});
    // Closed form: F = -mu W along the sliding direction. Tolerance: theta_1 is below 1e-5, and 90 deg is
    // clamped to 89.94 deg, whose cosine is 1e-3.
    EXPECT_NEAR(f.side_force_N / 80.0, -mu * std::sin(angle), 2e-5) << angle;
    EXPECT_NEAR(f.drawbar_pull_N / 80.0, -mu * std::cos(angle), angle < 1.5 ? 2e-5 : 1.1e-3) << angle;
  }
}

TEST(SideSlip, WheelAtFullSlipHasNoLateralShearForce) {
  const WheelForces f =
      equilibrium(shearOnly(sand()), {}, {.load_N = 60.0, .slip = 1.0, .slip_angle_rad = 0.5});
  // Closed form: v = 0, the soil is sheared along the wheel plane only.
  EXPECT_EQ(f.side_force_N, 0.0);
}

TEST(SideSlip, ShearForceNeverExceedsSoilStrength) {
  Random random{11};
  int answered = 0;
  for (int k = 0; k < 200; ++k) {
    Soil soil = sand();
    soil.cohesion_Pa = random.between(0.0, 5e3);
    soil.friction_angle_rad = random.between(0.1, 0.75);
    soil.shear_modulus_m = random.between(0.001, 0.04);
    const Wheel wheel{.radius_m = random.between(0.05, 0.3), .width_m = random.between(0.04, 0.2)};
    const WheelOperation how{.load_N = random.between(10.0, 200.0),
                             .slip = random.between(-1.0, 1.0),
                             .slip_angle_rad = random.between(-kRight, kRight)};
    WheelForces f;
    try {
      f = equilibrium(soil, wheel, how);
    } catch (const std::domain_error&) {
      continue;  // the wheel sinks to its axle
    }
    ++answered;
    double strength_N = 0.0;
    const auto stresses = stressDistribution(soil, wheel, how, 4001);
    for (std::size_t p = 0; p + 1 < stresses.size(); ++p)
      strength_N += (soil.cohesion_Pa + 0.5 * (stresses[p].normal_Pa + stresses[p + 1].normal_Pa) *
                                            std::tan(soil.friction_angle_rad)) *
                    (stresses[p + 1].angle_rad - stresses[p].angle_rad) * wheel.radius_m * wheel.width_m;
    const Hegedus push = hegedus({.cohesion_Pa = soil.cohesion_Pa,
                                  .tan_friction = std::tan(soil.friction_angle_rad),
                                  .weight_N_m3 = soil.density_kg_m3 * how.gravity_m_s2});
    const double face_N =
        faceResistance_N(push, {wheel.radius_m, f.entry_angle_rad}) * std::abs(std::sin(how.slip_angle_rad));
    const double rim_side_N = std::abs(f.side_force_N) - face_N;
    // Property: |int tau| <= int (c + sigma tan phi). Tolerance: 1e-4 for the trapezoid sum of the strength.
    EXPECT_LE(std::hypot(f.torque_Nm / wheel.radius_m, rim_side_N), strength_N * (1.0 + 1e-4)) << k;
    EXPECT_GE(rim_side_N, -1e-6 * how.load_N);
  }
  EXPECT_GT(answered, 150);
}

TEST(SideSlip, ResultantSlipMatchesLimitCases) {
  // Closed form: |i| at slip angle 0, 1 for a locked wheel at any angle, sqrt 2 at 90 deg with r omega = v.
  EXPECT_EQ(resultantSlip(0.3, 0.0), 0.3);
  EXPECT_EQ(resultantSlip(-0.3, 0.0), 0.3);
  EXPECT_NEAR(resultantSlip(-1.0, 0.7), 1.0, 1e-12);
  EXPECT_NEAR(resultantSlip(1.0, 0.7), 1.0, 1e-12);
  EXPECT_NEAR(resultantSlip(0.0, 0.6), std::sin(0.6), 1e-12);
  const double beta = 1.5;
  EXPECT_NEAR(resultantSlip(1.0 - std::cos(beta), beta), std::hypot(1.0 - std::cos(beta), std::sin(beta)),
              1e-12);
}

TEST(SideSlip, DiggingIncreasesSinkageAndReducesPull) {
  Soil soil = sand();
  soil.digging_exponent = 0.0;
  const WheelOperation how{.load_N = 60.0, .slip = 0.2, .slip_angle_rad = 0.6};
  const WheelForces shallow = equilibrium(soil, {}, how);
  soil.digging_exponent = 0.4;
  const WheelForces deep = equilibrium(soil, {}, how);
  // Property: ground that is softer at every depth below 1 m increases the sinkage and reduces the pull.
  EXPECT_GT(deep.sinkage_m, 1.2 * shallow.sinkage_m);
  EXPECT_LT(deep.drawbar_pull_N, shallow.drawbar_pull_N);
}

TEST(SideSlip, ForcesAtEntryAreThoseOfTheEquilibrium) {
  const WheelOperation how{.load_N = 60.0, .slip = 0.2, .slip_angle_rad = 0.6};
  const WheelForces f = equilibrium(sand(), {}, how);
  const ImposedContact at = forcesAtEntry(sand(), {}, how, f.entry_angle_rad);
  EXPECT_NEAR(at.load_N, 60.0, 1e-9);  // Property: the same integrals at the same angle
  EXPECT_NEAR(at.forces.side_force_N, f.side_force_N, 1e-9);
}

TEST(SideSlip, SlipAnglesBeyondNinetyDegreesAreRejected) {
  try {
    static_cast<void>(equilibrium(sand(), {}, {.load_N = 60.0, .slip = 0.1, .slip_angle_rad = 1.6}));
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("slip_angle_rad = 1.6"), std::string::npos) << e.what();
  }
}

}  // namespace side_slip_test
}  // namespace talus::terramech
