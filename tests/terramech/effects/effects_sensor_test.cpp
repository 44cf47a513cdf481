#include <cmath>
#include <numbers>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_sensor_test {

const Reading kRead{
    .load_N = 100.0, .radius_m = 0.2, .sinkage_m = 0.01, .torque_Nm = 6.0, .drawbar_pull_N = 20.0};

Reading read(const char* name, std::vector<double> parameters, double x = 1.0, double slip = 0.2) {
  return readWith(name, std::move(parameters), x, {.slip = slip}, plainContact(), kRead);
}

TEST(EffectsSensor, TorqueEffectsAddOffsetViscousFrictionAndEfficiency) {
  EXPECT_DOUBLE_EQ(read("torque_offset", {0.5}).torque_Nm, 6.5);
  EXPECT_DOUBLE_EQ(read("torque_offset", {0.5}, 1.0, -1.0).torque_Nm, 6.0);  // a locked wheel does not turn
  EXPECT_DOUBLE_EQ(read("torque_offset_viscous", {0.5, 10.0}, 0.1).torque_Nm, 7.5);
  EXPECT_DOUBLE_EQ(read("torque_efficiency", {0.75}).torque_Nm, 8.0);
}

TEST(EffectsSensor, DrawbarZeroSinkageDatumAndCellTiltMatchClosedForm) {
  EXPECT_DOUBLE_EQ(read("drawbar_zero", {-3.0}).drawbar_pull_N, 17.0);
  EXPECT_DOUBLE_EQ(read("sinkage_datum", {0.002}).sinkage_m, 0.012);
  // Closed form: DP cos e + W sin e at 30 deg.
  EXPECT_NEAR(read("load_cell_tilt", {std::numbers::pi / 6}).drawbar_pull_N, 10.0 * std::sqrt(3.0) + 50.0,
              1e-12);
}

// Closed form: 1 - i = (1 - i_m)/(1 + e); a radius taken 25 % too small turns a slip of 0.2 into 0.36.
TEST(EffectsSensor, SlipBiasEqualsARadiusError) {
  const auto slip = [](double measured, double e) {
    WheelContact c = plainContact();
    c.slip = measured;
    findEffect("slip_bias")->act({&e, {}, measured}, c);
    return c.slip;
  };
  EXPECT_NEAR(slip(0.2, 0.25), 0.36, 1e-12);
  EXPECT_NEAR(slip(0.2, -0.2), 0.0, 1e-12);
  EXPECT_EQ(slip(1.0, 0.25), 1.0);
  EXPECT_EQ(slip(-0.3, 0.25), -0.3);  // no correction for a braked wheel
}

TEST(EffectsSensor, OnlySensorEffectsAreMarkedAsSensorFaults) {
  for (const EffectForm& form : detail::sensorEffects()) EXPECT_TRUE(form.of_sensor) << form.name;
  for (const EffectForm& form : detail::forceEffects()) EXPECT_FALSE(form.of_sensor) << form.name;
  for (const EffectForm& form : detail::contactEffects()) EXPECT_FALSE(form.of_sensor) << form.name;
}

}  // namespace effects_sensor_test
}  // namespace talus::terramech
