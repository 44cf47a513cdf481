#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/pneumatic_tyre.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>

namespace talus::terramech {

namespace pneumatic_tyre_test {

Soil loam() {
  return {.name = "loam",
          .cohesion_Pa = 3000.0,
          .friction_angle_rad = 0.5,
          .sinkage_exponent = 0.8,
          .frictional_modulus = 2e6,
          .shear_modulus_m = 0.02};
}

Tyre tyre(double inflation_Pa) {
  return {.wheel = {.radius_m = 0.4, .width_m = 0.25}, .inflation_Pa = inflation_Pa, .carcass_Pa = 1e4};
}

TEST(PneumaticTyre, OnRigidGroundFlatAreaTimesPressureEqualsLoad) {
  const TyreForces forces = tyreOnRigidGround(tyre(5e4), {.load_N = 3000.0, .slip = 0.1});
  EXPECT_DOUBLE_EQ(forces.flat_length_m, 3000.0 / (6e4 * 0.25));  // Closed form.
  const double half = 0.5 * forces.flat_length_m;
  EXPECT_NEAR(std::pow(0.4 - forces.deflection_m, 2) + half * half, 0.16,
              1e-14);  // Closed form: chord of a circle.
}

TEST(PneumaticTyre, OnRigidGroundPullRisesWithSlipToTheFrictionLimit) {
  double last = -1.0;
  for (const double slip : {0.0, 0.001, 0.01, 0.1, 1.0}) {
    const double pull = tyreOnRigidGround(tyre(5e4), {.load_N = 3000.0, .slip = slip}).drawbar_pull_N;
    EXPECT_GE(pull, last);
    EXPECT_LE(pull, 0.7 * 3000.0);
    last = pull;
  }
  EXPECT_NEAR(last, 0.7 * 3000.0, 0.01 * 2100.0);
}

TEST(PneumaticTyre, HighInflationIsRigidModeAndLowInflationIsFlattenedMode) {
  const TyreOperation operation{.load_N = 1500.0, .slip = 0.2};
  const double critical = criticalPressure_Pa(loam(), tyre(0.0).wheel, 1500.0);
  const TyreForces hard = tyreOnSoftGround(tyre(critical), loam(), operation);
  EXPECT_EQ(hard.mode, TyreMode::Rigid);
  EXPECT_DOUBLE_EQ(hard.sinkage_m,
                   equilibrium(loam(), tyre(0.0).wheel, {.load_N = 1500.0, .slip = 0.2}).sinkage_m);
  const TyreForces soft = tyreOnSoftGround(tyre(0.4 * critical - 1e4), loam(), operation);
  EXPECT_EQ(soft.mode, TyreMode::Flattened);
  EXPECT_LT(soft.sinkage_m, hard.sinkage_m);
  EXPECT_GT(soft.flat_length_m, 0.0);
  EXPECT_GT(soft.drawbar_pull_N,
            hard.drawbar_pull_N);  // Measured by others: on sand, a lower tyre pressure increases the pull
                                   // (wong_2001).
}

TEST(PneumaticTyre, ForcesEqualTheIntegratedStresses) {
  // Property: load, torque and pull equal midpoint-rule integrals over the round part and the flat, by the
  // laws in the header.
  const double r = 0.4, b = 0.25;
  const Soil soil = loam();
  for (const double slip : {0.0, 0.3}) {
    const Tyre soft = tyre(1e4);
    const TyreForces f = tyreOnSoftGround(soft, soil, {.load_N = 1500.0, .slip = slip});
    ASSERT_EQ(f.mode, TyreMode::Flattened);
    const double entry = std::acos(1.0 - (f.deflection_m + f.sinkage_m) / r);
    const double flat = std::acos(1.0 - f.deflection_m / r);
    const auto j = [&](double a) {  // thesis C.6
      return r * (entry - a - (1.0 - slip) * (std::sin(entry) - std::sin(a)));
    };
    const auto tau = [&](double sigma, double at) {
      return (3000.0 + sigma * std::tan(0.5)) * (1.0 - std::exp(-at / 0.02));
    };
    double load = 2e4 * f.flat_length_m, torque = 0.0, pull = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double a = flat + (entry - flat) * (k + 0.5) / kSteps, ds = r * (entry - flat) / kSteps;
      const double sigma = 2e6 * std::pow(r * (std::cos(a) - std::cos(entry)), 0.8);
      const double t = tau(sigma, j(a));
      load += (sigma * std::cos(a) + t * std::sin(a)) * ds;
      pull += (t * std::cos(a) - sigma * std::sin(a)) * ds;
      torque += r * t * ds;
      const double dx = f.flat_length_m / kSteps;
      const double along = tau(2e4, j(flat) + slip * (k + 0.5) * dx) * dx;
      pull += along;
      torque += (r - f.deflection_m) * along;
    }
    EXPECT_NEAR(b * load, 1500.0, 0.01);
    EXPECT_NEAR(f.torque_Nm / (b * torque), 1.0, 1e-5);
    EXPECT_NEAR(f.drawbar_pull_N, b * pull, 0.01);
  }
}

TEST(PneumaticTyre, SinkageRisesAndDeflectionFallsWithInflationPressure) {
  TyreForces last = tyreOnSoftGround(tyre(2.2e4), loam(), {.load_N = 1500.0, .slip = 0.2});
  for (const double p : {1.8e4, 1.4e4, 1e4, 5e3}) {  // Property: the result is monotone in the pressure.
    const TyreForces forces = tyreOnSoftGround(tyre(p), loam(), {.load_N = 1500.0, .slip = 0.2});
    EXPECT_LT(forces.sinkage_m, last.sinkage_m);
    EXPECT_GT(forces.deflection_m, last.deflection_m);
    last = forces;
  }
}

TEST(PneumaticTyre, CriticalPressureIsThatUnderARigidWheelByBekker) {
  // Closed form: for n = 1 and small angles W = b k sqrt(D z) (3 - n) z / 3 and p = k z.
  Soil soil = loam();
  soil.sinkage_exponent = 1.0;
  const Wheel wheel{.radius_m = 0.4, .width_m = 0.25};
  const double z = 0.01, load = 0.25 * 2e6 * std::sqrt(0.8 * z) * 2.0 / 3.0 * z;
  EXPECT_NEAR(criticalPressure_Pa(soil, wheel, load) / (2e6 * z), 1.0, 1e-12);
}

TEST(PneumaticTyre, InputsOutsideTheModelRangeAreRejected) {
  EXPECT_REFUSED(tyreOnRigidGround(tyre(1e3), {.load_N = 1e5, .slip = 0.1}), std::domain_error,
                 "the tyre flattens over its whole diameter");
  EXPECT_REFUSED(tyreOnSoftGround(tyre(-1.0), loam(), {.load_N = 100.0}), std::invalid_argument,
                 "inflation_Pa = -1, must be >= 0");
  EXPECT_REFUSED(tyreOnSoftGround(tyre(1e3), loam(), {.load_N = 1e6, .slip = 0.2}), std::domain_error,
                 "the tyre sinks and flattens to its axle");
  Soil soil = loam();
  soil.sinkage_exponent = 3.0;
  EXPECT_REFUSED(criticalPressure_Pa(soil, {}, 100.0), std::domain_error,
                 "the critical pressure is known for n < 3 only");
}

Soil drySand() {
  return {.name = "dry sand",
          .cohesion_Pa = 1040.0,
          .friction_angle_rad = 0.4887,
          .sinkage_exponent = 1.1,
          .cohesive_modulus = 990.0,
          .frictional_modulus = 1528430.0};
}

TEST(PressureSinkage, BekkerPressureIsAPowerOfDepth) {
  const double k = 990.0 / 0.05 + 1528430.0;
  EXPECT_DOUBLE_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.02), k * std::pow(0.02, 1.1));  // Closed form: A.1.
  EXPECT_EQ(bekkerPressure_Pa(drySand(), 0.05, 0.0), 0.0);
}

TEST(PressureSinkage, DepthInvertsPressure) {
  for (const double z :
       {0.0, 1e-4, 0.01, 0.2}) {  // Property: pressure and sinkage are inverse to each other.
    EXPECT_NEAR(bekkerDepth_m(drySand(), 0.1, bekkerPressure_Pa(drySand(), 0.1, z)), z, 1e-15);
  }
}

TEST(PressureSinkage, SoilWithoutBearingCapacityIsRejected) {
  Soil soil = drySand();
  soil.cohesive_modulus = -1e6;
  EXPECT_REFUSED(bekkerDepth_m(soil, 0.1, 100.0), std::domain_error, "a soil with modulus -8471570");
  EXPECT_REFUSED(bekkerDepth_m(drySand(), 0.1, -1.0), std::invalid_argument,
                 "pressure_Pa = -1, must be >= 0");
}

TEST(RigidGround, PullIsTorqueOverRadiusUpToTheFrictionLimit) {
  const Wheel wheel{.radius_m = 0.2, .width_m = 0.1};
  const GroundFriction friction{.static_coefficient = 0.7, .kinetic_coefficient = 0.5};
  // Closed form: C.11.
  EXPECT_DOUBLE_EQ(rigidGroundForces(wheel, friction, 100.0, 10.0).drawbar_pull_N, 50.0);
  EXPECT_FALSE(rigidGroundForces(wheel, friction, 100.0, 0.2 * 0.7 * 100.0).slips);
  const RigidGroundForces slipping = rigidGroundForces(wheel, friction, 100.0, -14.1);
  EXPECT_TRUE(slipping.slips);
  EXPECT_DOUBLE_EQ(slipping.drawbar_pull_N, -50.0);
}

TEST(RigidGround, InvalidLoadAndFrictionAreRejected) {
  EXPECT_REFUSED(rigidGroundForces({}, {}, 0.0, 1.0), std::invalid_argument, "load_N = 0, must be > 0");
  EXPECT_REFUSED(rigidGroundForces({}, {.static_coefficient = 0.1, .kinetic_coefficient = 0.5}, 1.0, 1.0),
                 std::invalid_argument, "static_coefficient = 0.1, must be >= 0.5");
}

}  // namespace pneumatic_tyre_test

}  // namespace talus::terramech
