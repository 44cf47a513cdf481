#include <cmath>
#include <random>
#include <stdexcept>

#include <refused.hpp>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/mobility/mobility.hpp>

namespace talus::terramech {
namespace mobility_test {

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

// Slip on one slope by bisection.
double slipOnSlope(const Soil& soil, const Rover& rover, double slope_rad) {
  const double load_N = wheelLoad_N(rover) * std::cos(slope_rad);
  const auto excess = [&](double slip) {
    return equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip}).drawbar_pull_N / load_N -
           std::tan(slope_rad);
  };
  double low = excess(0.0) > 0.0 ? -1.0 : 0.0, high = low < 0.0 ? 0.0 : 0.01;
  while (excess(high) < 0.0) {
    low = high;
    high = std::min(1.0, high + 0.01);
  }
  for (int step = 0; step < 50; ++step) {
    const double middle = 0.5 * (low + high);
    (excess(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(Mobility, SlipBalancesThePullRequiredByTheSlope) {
  const MobilityCurve curve{loam(), rover()};
  for (double slope = -0.4; slope < curve.maxSlope_rad() - 0.01; slope += 0.0317) {
    if (slope < curve.minSlope_rad()) continue;
    // Closed form: root of DP(i) = N tan(slope) by a separate search.
    EXPECT_NEAR(curve.at(slope).slip, slipOnSlope(loam(), rover(), slope), 1e-3) << slope;
  }
}

TEST(Mobility, MatchesTheExactSolutionForRandomSoilsAndRovers) {
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
      // Closed form: root of DP(i) = N tan(slope) by a separate search. Tolerance: 1e-3, the stated accuracy
      // of the table.
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

TEST(Mobility, SlipAndEnergyIncreaseWithSlope) {
  const MobilityCurve curve{loam(), rover()};
  MobilityState last = curve.at(curve.minSlope_rad());
  for (double slope = curve.minSlope_rad(); slope < curve.maxSlope_rad(); slope += 1e-3) {
    const MobilityState state = curve.at(slope);  // Property: monotone in the slope.
    EXPECT_GE(state.slip, last.slip);
    EXPECT_GE(state.energy_J_per_m, last.energy_J_per_m - 1e-9);
    EXPECT_LE(state.speed_mps, last.speed_mps);
    last = state;
  }
}

TEST(Mobility, EnergyOnFlatGroundIsTorqueWorkPlusHotelEnergy) {
  const MobilityState flat = MobilityCurve{loam(), rover()}.at(0.0);
  const double rolled_per_m = 1.0 / (1.0 - flat.slip);
  EXPECT_NEAR(flat.energy_J_per_m,
              6.0 * flat.torque_Nm / 0.1 * rolled_per_m + 8.0 / (0.06 * (1.0 - flat.slip)), 1e-9);
  EXPECT_TRUE(flat.feasible);
  EXPECT_GT(flat.slip, 0.0);  // Property: rolling resistance requires pull.
}

TEST(Mobility, BrakingRecoversNoEnergy) {
  const MobilityCurve curve{loam(), rover()};
  const MobilityState down = curve.at(-0.25);
  EXPECT_LT(down.torque_Nm, 0.0);
  EXPECT_DOUBLE_EQ(down.energy_J_per_m, 8.0 / 0.06);
}

TEST(Mobility, SinkageIncreasesWithGravity) {
  Rover heavy = rover();
  heavy.gravity_m_s2 = 9.80665;
  EXPECT_LT((MobilityCurve{loam(), rover()}.reference().sinkage_over_radius),
            (MobilityCurve{loam(), heavy}.reference().sinkage_over_radius));
}

TEST(Mobility, SlipTorqueAndSlopeLimitsMakeStatesInfeasible) {
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

TEST(Mobility, ReferenceIsTheWheelAtReferenceSlipUnderItsLoad) {
  const MobilityCurve curve{loam(), rover()};
  const double load_N = wheelLoad_N(rover());
  const WheelForces wheel = equilibrium(loam(), rover().wheel, {.load_N = load_N, .slip = 0.5});
  EXPECT_NEAR(curve.reference().drawbar_pull_over_load, wheel.drawbar_pull_N / load_N, 1e-12);
  EXPECT_NEAR(curve.reference().sinkage_over_radius, wheel.sinkage_m / 0.1, 1e-12);
  EXPECT_GE(curve.strongest().drawbar_pull_over_load, curve.reference().drawbar_pull_over_load);
}

// Property: mobilityReference() is bit-identical to reference() of the curve, on soils that carry the wheel
// and on a soil that does not, with and without effects.
TEST(Mobility, ReferenceFunctionEqualsThatOfTheCurve) {
  Soil bottomless = loam();
  bottomless.frictional_modulus = 1e3;
  const auto same = [](const MobilityReference& a, const MobilityReference& b) {
    return a.slip == b.slip && a.drawbar_pull_over_load == b.drawbar_pull_over_load &&
           a.sinkage_over_radius == b.sinkage_over_radius &&
           a.torque_over_load_radius == b.torque_over_load_radius;
  };
  for (const Soil& soil : {loam(), bottomless})
    for (const double slip : {0.3, 0.5}) {
      const MobilityOptions options{.reference_slip = slip};
      RefinedModel model;
      model.soil = soil;
      EXPECT_TRUE(
          same(mobilityReference(soil, rover(), options), MobilityCurve(soil, rover(), options).reference()));
      EXPECT_TRUE(same(mobilityReference(model, rover(), options),
                       MobilityCurve(model, rover(), options).reference()));
    }
  Rover bad = rover();
  bad.mass_kg = -1.0;
  EXPECT_THROW(mobilityReference(loam(), bad), std::invalid_argument);
}

TEST(Mobility, SoilWithoutBearingCapacityIsInfeasible) {
  Soil bog = loam();
  bog.frictional_modulus = 100.0;
  bog.cohesion_Pa = 0.0;
  const MobilityCurve curve{bog, rover()};
  EXPECT_FALSE(curve.at(0.0).feasible);
  EXPECT_DOUBLE_EQ(curve.reference().sinkage_over_radius, 1.0);
}

TEST(Mobility, InvalidRoverAndOptionsAreRejected) {
  Rover bad = rover();
  bad.mass_kg = -1.0;
  EXPECT_REFUSED((MobilityCurve{loam(), bad}), std::invalid_argument, "mass_kg = -1, must be > 0");
  EXPECT_REFUSED((MobilityCurve{loam(), rover(), {.max_slip = 0.0}}), std::invalid_argument,
                 "max_slip = 0, must be in [1e-06, 1]");
}

RefinedModel withEffect(const char* name, std::vector<double> parameters) {
  RefinedModel model;
  model.soil = loam();
  const EffectForm& form = *findEffect(name);
  model.effects = {{.name = name,
                    .covariate = form.covariate,
                    .channel = form.channel,
                    .parameters = std::move(parameters)}};
  return model;
}

TEST(Mobility, ModelWithoutEffectsEqualsItsSoil) {
  const MobilityCurve of_soil{loam(), rover()};
  RefinedModel model;
  model.soil = loam();
  const MobilityCurve of_model{model, rover()};
  for (const double slope : {-0.15, -0.05, 0.0, 0.1}) {
    // Property: the curves of soil and model agree. Tolerance: two quadrature rules that differ by 1e-6 of
    // the load.
    EXPECT_NEAR(of_model.at(slope).slip, of_soil.at(slope).slip, 1e-5) << slope;
    EXPECT_NEAR(of_model.at(slope).energy_J_per_m, of_soil.at(slope).energy_J_per_m, 1e-3) << slope;
  }
  EXPECT_NEAR(of_model.maxSlope_rad(), of_soil.maxSlope_rad(), 1e-6);
}

TEST(Mobility, EffectsApplyOnEverySlope) {
  const RefinedModel model = withEffect("slip_sinkage_ding", {0.4});
  const MobilityCurve curve{model, rover()};
  for (const double slope : {0.05, 0.12}) {
    const MobilityState s = curve.at(slope);
    WheelState wheel;
    wheel.wheel = rover().wheel;
    wheel.load_N = wheelLoad_N(rover()) * std::cos(slope);
    wheel.slip = s.slip;
    // Closed form: DP/N = tan(slope) by the model at the slip of the table.
    EXPECT_NEAR(predict(model, wheel).drawbar_pull_N / wheel.load_N, std::tan(slope), 1e-3) << slope;
    EXPECT_NEAR(predict(model, wheel).sinkage_m, s.sinkage_m, 1e-5) << slope;
    // Property: at that slip the sinkage is larger than on the soil without the effect.
    EXPECT_GT(s.sinkage_m,
              equilibrium(loam(), rover().wheel, {.load_N = wheel.load_N, .slip = s.slip}).sinkage_m);
  }
}

TEST(Mobility, BulldozingIncreasesSlipAndEnergyAndReducesMaximumSlope) {
  const MobilityCurve curve{withEffect("bulldozing", {0.3}), rover()}, plain{loam(), rover()};
  for (const double slope : {-0.05, 0.05, 0.1}) {
    EXPECT_GT(curve.at(slope).slip, plain.at(slope).slip) << slope;
    EXPECT_GT(curve.at(slope).energy_J_per_m, plain.at(slope).energy_J_per_m) << slope;
  }
  EXPECT_LT(curve.maxSlope_rad(), plain.maxSlope_rad());
  EXPECT_LT(curve.reference().drawbar_pull_over_load, plain.reference().drawbar_pull_over_load);
}

TEST(Mobility, AxlesInOneRutShareThePull) {
  const RefinedModel model = withEffect("multipass_reload", {3.0, 1.0});
  const MobilityCurve curve{model, rover(), {.axles = 3}}, first{model, rover()},
      rut{model, rover(), {.first_pass = 2}};
  for (const double slope : {0.02, 0.1}) {
    const MobilityState s = curve.at(slope);
    WheelState wheel;
    wheel.wheel = rover().wheel;
    wheel.load_N = wheelLoad_N(rover()) * std::cos(slope);
    wheel.slip = s.slip;
    double pull_N = 0.0, torque_Nm = 0.0;
    for (const double pass : {1.0, 2.0, 3.0}) {
      wheel.pass_index = pass;
      pull_N += predict(model, wheel).drawbar_pull_N;
      torque_Nm += predict(model, wheel).torque_Nm;
    }
    // Closed form: sum over one wheel of each axle at the pass of the axle, by the model. Tolerance: the
    // stated accuracy of the table.
    EXPECT_NEAR(pull_N / (3.0 * wheel.load_N), std::tan(slope), 1e-3) << slope;
    EXPECT_NEAR(torque_Nm / 3.0, s.torque_Nm, 1e-3) << slope;
    // Property: the sinkage is that of the first wheel; the slip of the rover is lower than on fresh ground
    // and higher than in a rut.
    EXPECT_GT(s.sinkage_m, rut.at(slope).sinkage_m) << slope;
    EXPECT_LT(s.slip, first.at(slope).slip) << slope;
    EXPECT_GT(s.slip, rut.at(slope).slip) << slope;
  }
  EXPECT_THROW((MobilityCurve{model, rover(), {.axles = 0}}), std::invalid_argument);
}

TEST(Mobility, SensorEffectsDoNotChangeMobility) {
  for (const char* name : {"load_cell_tilt", "torque_offset", "sinkage_datum", "slip_bias"}) {
    const MobilityCurve curve{withEffect(name, {0.05}), rover()};
    RefinedModel plain;
    plain.soil = loam();
    EXPECT_EQ(curve.at(0.1).energy_J_per_m, MobilityCurve(plain, rover()).at(0.1).energy_J_per_m) << name;
  }
}

TEST(Mobility, LinearFormulaIsRejected) {
  RefinedModel model;
  model.soil = loam();
  model.base = BaseModel::LinearFormula;
  EXPECT_REFUSED(MobilityCurve(model, rover()), std::invalid_argument,
                 "cannot predict slip on a slope; trace the data with model: wong-reece");
}

}  // namespace mobility_test
}  // namespace talus::terramech
