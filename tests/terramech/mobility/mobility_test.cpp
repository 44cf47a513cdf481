#include <cmath>
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

TEST(Mobility, ReferenceIsTheWheelAtReferenceSlipUnderItsLoad) {
  const double load_N = wheelLoad_N(rover());
  const WheelForces wheel = equilibrium(loam(), rover().wheel, {.load_N = load_N, .slip = 0.5});
  RefinedModel model;
  model.soil = loam();
  for (const MobilityReference& of :
       {mobilityReference(loam(), rover()), mobilityReference(model, rover())}) {
    // Closed form. Tolerance: two quadrature rules of one integral, 1e-6 apart.
    EXPECT_NEAR(of.drawbar_pull_over_load, wheel.drawbar_pull_N / load_N, 1e-5);
    EXPECT_NEAR(of.sinkage_over_radius, wheel.sinkage_m / 0.1, 1e-5);
    EXPECT_NEAR(of.torque_over_load_radius, wheel.torque_Nm / (load_N * 0.1), 1e-5);
  }
}

TEST(Mobility, SinkageIncreasesWithGravityAndWithSlipSinkage) {
  Rover heavy = rover();
  heavy.gravity_m_s2 *= 2.0;
  const double plain = mobilityReference(loam(), rover()).sinkage_over_radius;
  EXPECT_LT(plain, mobilityReference(loam(), heavy).sinkage_over_radius);
  EXPECT_LT(plain, mobilityReference(withEffect("slip_sinkage_ding", {0.4}), rover()).sinkage_over_radius);
}

TEST(Mobility, SoilWithoutBearingCapacityCarriesTheWheelOnItsAxle) {
  Soil bog = loam();
  bog.frictional_modulus = 1e3;
  EXPECT_NEAR(mobilityReference(bog, rover()).sinkage_over_radius, 1.0, 1e-9);
}

TEST(Mobility, SensorEffectsDoNotChangeMobility) {
  for (const char* name : {"load_cell_tilt", "torque_offset", "sinkage_datum", "slip_bias"}) {
    RefinedModel plain;
    plain.soil = loam();
    EXPECT_EQ(mobilityReference(withEffect(name, {0.05}), rover()).drawbar_pull_over_load,
              mobilityReference(plain, rover()).drawbar_pull_over_load)
        << name;
  }
}

TEST(Mobility, InvalidArgumentsAreRejected) {
  Rover bad = rover();
  bad.mass_kg = -1.0;
  EXPECT_REFUSED(mobilityReference(loam(), bad), std::invalid_argument, "mass_kg = -1, must be > 0");
  EXPECT_THROW(mobilityReference(loam(), rover(), {.pass = 0}), std::invalid_argument);
  RefinedModel model;
  model.soil = loam();
  model.base = BaseModel::LinearFormula;
  EXPECT_REFUSED(mobilityReference(model, rover()), std::invalid_argument,
                 "cannot predict slip on a slope; trace the data with model: wong-reece");
}

}  // namespace mobility_test
}  // namespace talus::terramech
