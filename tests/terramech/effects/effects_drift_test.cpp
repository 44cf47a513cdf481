#include <cmath>
#include <string>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_drift_test {

// A drift that begins at 100 s and has a span of 50 s.
constexpr double kStart = 100.0, kSpan = 50.0;

TEST(EffectsDrift, LinearDriftReachesItsSizeOverItsSpan) {
  // Closed form: 1 + a u with u = 1/2; k e^{a u}.
  const double middle = kStart + 0.5 * kSpan;
  EXPECT_NEAR(acted("drift_cohesion", {0.4, kStart, kSpan}, middle).cohesion_Pa, 1200.0, 1e-9);
  EXPECT_NEAR(acted("drift_friction", {0.4, kStart, kSpan}, middle).tan_friction, 0.6, 1e-12);
  EXPECT_NEAR(acted("drift_stiffness", {std::log(4.0), kStart, kSpan}, middle).sinkage_modulus, 2e6, 1e-6);
  EXPECT_EQ(acted("drift_cohesion", {0.4, kStart, kSpan}, kStart), plainContact());
}

TEST(EffectsDrift, RelaxingDriftReachesHalfItsSizeAfterLnTwoTimeConstants) {
  const double x = kStart + kSpan * 0.4 * std::log(2.0);
  EXPECT_NEAR(acted("drift_cohesion_relaxing", {0.4, kStart, kSpan, 0.4}, x).cohesion_Pa, 1200.0, 1e-9);
}

TEST(EffectsDrift, DiurnalDriftIsPeriodic) {
  const std::vector<double> wave{0.2, kStart, kSpan, 0.5, 0.0};  // period of half a span
  const auto cohesion = [&](double periods) {
    return acted("drift_cohesion_diurnal", wave, kStart + 0.5 * kSpan * periods).cohesion_Pa;
  };
  // Closed form: the sine's values at quarters of its period.
  EXPECT_NEAR(cohesion(0.25), 1200.0, 1e-9);
  EXPECT_NEAR(cohesion(0.75), 800.0, 1e-9);
  EXPECT_NEAR(cohesion(1.0), 1000.0, 1e-9);
}

TEST(EffectsDrift, SensorZeroDriftChangesItsChannelOnly) {
  const Reading before{
      .load_N = 100.0, .radius_m = 0.2, .sinkage_m = 0.01, .torque_Nm = 5.0, .drawbar_pull_N = 20.0};
  const auto moved = [&](const char* name) {
    return readWith(name, {3.0, kStart, kSpan}, kStart + kSpan, {}, plainContact(), before);
  };
  const Reading pull = moved("drift_drawbar_zero"), torque = moved("drift_torque_zero"),
                sinkage = moved("drift_sinkage_zero");
  EXPECT_EQ(pull.drawbar_pull_N, 23.0);
  EXPECT_EQ(torque.torque_Nm, 8.0);
  EXPECT_EQ(sinkage.sinkage_m, 3.01);
  EXPECT_EQ(pull.torque_Nm, 5.0);
  EXPECT_EQ(torque.drawbar_pull_N, 20.0);
  EXPECT_EQ(sinkage.drawbar_pull_N, 20.0);
}

// Property: an extrapolated drift leaves every soil parameter in its physical range.
TEST(EffectsDrift, ExtrapolatedDriftKeepsSoilPhysical) {
  const double far = kStart + 1000 * kSpan;
  EXPECT_EQ(acted("drift_cohesion", {-0.5, kStart, kSpan}, far).cohesion_Pa, 0.0);
  EXPECT_GT(acted("drift_friction", {-0.5, kStart, kSpan}, far).tan_friction, 0.0);
  EXPECT_LT(acted("drift_stiffness", {3.0, kStart, kSpan}, far).sinkage_modulus, 2e8);
}

TEST(EffectsDrift, OnlyZeroDriftsAreSensorFaults) {
  int forms = 0;
  for (const EffectForm& form : effectLibrary()) {
    if (std::string(form.family) != "drift") continue;
    ++forms;
    EXPECT_EQ(form.of_sensor, std::string(form.name).find("_zero") != std::string::npos) << form.name;
    EXPECT_FALSE(form.parameters[1].fitted) << form.name;  // start and span follow from the data
    EXPECT_FALSE(form.parameters[2].fitted) << form.name;
  }
  EXPECT_EQ(forms, 18);  // three soil targets and three sensor targets, in three shapes
}

}  // namespace effects_drift_test
}  // namespace talus::terramech
