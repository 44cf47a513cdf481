#include <cmath>
#include <random>
#include <stdexcept>

#include <terramech/mobility.hpp>
#include <terramech/wong_reece.hpp>

namespace talus::terramech {
namespace {

Soil loam() {
  return {.name = "loam",
          .cohesion_Pa = 3000.0,
          .friction_angle_rad = 0.44,
          .sinkage_exponent = 0.8,
          .frictional_modulus = 1.7e6,
          .shear_modulus_m = 0.02};
}

Rover rover() {
  return {.name = "six wheels",
          .mass_kg = 60.0,
          .gravity_m_s2 = 3.71,
          .wheel_count = 6,
          .wheel = {.radius_m = 0.1, .width_m = 0.1},
          .wheelbase_m = 0.8,
          .track_m = 0.7,
          .clearance_m = 0.2,
          .centre_of_mass_height_m = 0.3,
          .max_torque_Nm = 12.0,
          .max_speed_mps = 0.06,
          .hotel_power_W = 8.0};
}

TEST(Mobility, SlipBalancesThePullOfTheSlopeUpAndDown) {
  const MobilityCurve curve{loam(), rover()};
  for (double slope = -0.4; slope < curve.maxSlope_rad() - 0.01; slope += 0.0317) {
    if (slope < curve.minSlope_rad()) continue;
    // Closed form: root of DP(i) = N tan(slope), found without the table.
    EXPECT_NEAR(curve.at(slope).slip, slipOnSlope(loam(), rover(), slope), 1e-3) << slope;
  }
}

TEST(Mobility, IsExactOnRandomSoilsAndRovers) {
  std::mt19937_64 random{11};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  for (int k = 0; k < 12; ++k) {
    Soil soil = loam();
    soil.cohesion_Pa = between(0.0, 6e3);
    soil.friction_angle_rad = between(0.2, 0.7);
    soil.sinkage_exponent = between(0.5, 1.2);
    Rover any = rover();
    any.mass_kg = between(10.0, 200.0);
    any.wheel.radius_m = between(0.08, 0.25);
    const MobilityCurve curve{soil, any};
    for (int q = 0; q < 4 && curve.minSlope_rad() < curve.maxSlope_rad(); ++q) {
      const double slope = between(curve.minSlope_rad() + 1e-3, curve.maxSlope_rad() - 1e-3);
      // Closed form: root of DP(i) = N tan(slope), found without the table; 1e-3 is the table's stated
      // accuracy.
      EXPECT_NEAR(curve.at(slope).slip, slipOnSlope(soil, any, slope), 1e-3) << k << " " << slope;
    }
  }
}

TEST(Mobility, StateSatisfiesTheForceBalance) {
  const MobilityCurve curve{loam(), rover()};
  for (const double slope : {-0.3, -0.1, 0.0, 0.1, 0.15}) {
    const MobilityState state = curve.at(slope);
    const double load_N = wheelLoad_N(rover()) * std::cos(slope);
    const WheelForces wheel = equilibrium(loam(), rover().wheel, {.load_N = load_N, .slip = state.slip});
    EXPECT_NEAR(wheel.drawbar_pull_N / load_N, std::tan(slope),
                1e-3);  // Property: equilibrium along the slope.
    EXPECT_NEAR(wheel.sinkage_m, state.sinkage_m, 1e-5);
    EXPECT_NEAR(wheel.torque_Nm, state.torque_Nm, 5e-3);
  }
}

TEST(Mobility, NothingEasesAsTheSlopeSteepens) {
  const MobilityCurve curve{loam(), rover()};
  MobilityState last = curve.at(curve.minSlope_rad());
  for (double slope = curve.minSlope_rad(); slope < curve.maxSlope_rad(); slope += 1e-3) {
    const MobilityState state = curve.at(slope);  // Property: monotone.
    EXPECT_GE(state.slip, last.slip);
    EXPECT_GE(state.energy_J_per_m, last.energy_J_per_m - 1e-9);
    EXPECT_LE(state.speed_mps, last.speed_mps);
    last = state;
  }
}

TEST(Mobility, EnergyOnTheFlatIsTorqueTimesTurnsAndHotelTime) {
  const MobilityState flat = MobilityCurve{loam(), rover()}.at(0.0);
  const double rolled_per_m = 1.0 / (1.0 - flat.slip);
  EXPECT_NEAR(flat.energy_J_per_m,
              6.0 * flat.torque_Nm / 0.1 * rolled_per_m + 8.0 / (0.06 * (1.0 - flat.slip)), 1e-9);
  EXPECT_TRUE(flat.feasible);
  EXPECT_GT(flat.slip, 0.0);  // Property: rolling resistance must be pulled.
}

TEST(Mobility, BrakingGivesNoEnergyBack) {
  const MobilityCurve curve{loam(), rover()};
  const MobilityState down = curve.at(-0.25);
  EXPECT_LT(down.torque_Nm, 0.0);
  EXPECT_DOUBLE_EQ(down.energy_J_per_m, 8.0 / 0.06);
}

TEST(Mobility, LessGravityLeavesTheSlopeButSinksLess) {
  Rover heavy = rover();
  heavy.gravity_m_s2 = 9.80665;
  EXPECT_LT((MobilityCurve{loam(), rover()}.reference().sinkage_over_radius),
            (MobilityCurve{loam(), heavy}.reference().sinkage_over_radius));
}

TEST(Mobility, LimitsOfSlipTorqueAndSlopeHold) {
  const MobilityCurve curve{loam(), rover()};
  EXPECT_FALSE(curve.at(curve.maxSlope_rad() + 1e-6).feasible);
  EXPECT_FALSE(curve.at(curve.minSlope_rad() - 1e-6).feasible);
  Rover weak = rover();
  weak.max_torque_Nm = 0.5 * curve.at(0.1).torque_Nm;
  EXPECT_TRUE(curve.at(0.1).feasible);
  EXPECT_FALSE((MobilityCurve{loam(), weak}.at(0.1).feasible));
  const MobilityCurve careful{loam(), rover(), {.max_slip = curve.at(0.1).slip - 0.01}};
  EXPECT_FALSE(careful.at(0.1).feasible);
}

TEST(Mobility, ReferenceIsTheWheelAtHalfSlipUnderItsOwnLoad) {
  const MobilityCurve curve{loam(), rover()};
  const double load_N = wheelLoad_N(rover());
  const WheelForces wheel = equilibrium(loam(), rover().wheel, {.load_N = load_N, .slip = 0.5});
  EXPECT_NEAR(curve.reference().drawbar_pull_over_load, wheel.drawbar_pull_N / load_N, 1e-12);
  EXPECT_NEAR(curve.reference().sinkage_over_radius, wheel.sinkage_m / 0.1, 1e-12);
  EXPECT_GE(curve.strongest().drawbar_pull_over_load, curve.reference().drawbar_pull_over_load);
}

TEST(Mobility, OnABottomlessSoilNothingIsFeasible) {
  Soil bog = loam();
  bog.frictional_modulus = 100.0;
  bog.cohesion_Pa = 0.0;
  const MobilityCurve curve{bog, rover()};
  EXPECT_FALSE(curve.at(0.0).feasible);
  EXPECT_DOUBLE_EQ(curve.reference().sinkage_over_radius, 1.0);
}

TEST(Mobility, RefusesABadRover) {
  Rover bad = rover();
  bad.mass_kg = -1.0;
  EXPECT_THROW((MobilityCurve{loam(), bad}), std::invalid_argument);
  EXPECT_THROW((MobilityCurve{loam(), rover(), {.max_slip = 0.0}}), std::invalid_argument);
}

}  // namespace
}  // namespace talus::terramech
