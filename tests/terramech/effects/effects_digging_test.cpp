#include <cmath>
#include <numbers>

#include "effects_fixture.hpp"

namespace talus::terramech {
namespace effects_digging_test {

TEST(EffectsDigging, BrakedWheelSinkageIsQuadraticInSkid) {
  // Closed form: 0.3 r (1 - r omega/v)^2 with r omega/v = 1 + slip; 0 for a driven wheel.
  RefinedModel model = base();
  model.effects = {typical(*findEffect("skid_sinkage"))};
  for (const double slip : {-1.0, -0.6, -0.2, 0.3}) {
    WheelState s = state(slip);
    s.slip_angle_rad = 0.0;
    const double extra = slip < 0.0 ? 0.3 * 0.12 * slip * slip : 0.0;
    EXPECT_NEAR(predict(model, s).sinkage_m, predict(base(), s).sinkage_m + extra, 1e-9) << slip;
  }
}

TEST(EffectsDigging, PloughingIsOddInSlipAngleAndZeroStraightAhead) {
  RefinedModel model = base();
  model.effects = {typical(*findEffect("side_ploughing"))};
  WheelState s = state(0.2);
  s.slip_angle_rad = 0.0;
  EXPECT_NEAR(change(predict(model, s), predict(base(), s)), 0.0, 1e-12);
  double last = 0.0;
  for (const double angle : {0.3, 0.8, 1.3}) {
    s.slip_angle_rad = angle;
    const Reading right = predict(model, s);
    s.slip_angle_rad = -angle;
    const Reading left = predict(model, s);
    // Property: the side force is odd in the slip angle, the other quantities are even. The sinkage grows
    // with the angle (at small angles the rear contact carries slightly more).
    EXPECT_LT(right.side_force_N, 0.0);
    EXPECT_NEAR(right.side_force_N, -left.side_force_N, 1e-9);
    EXPECT_NEAR(right.drawbar_pull_N, left.drawbar_pull_N, 1e-9);
    EXPECT_GT(right.sinkage_m, last);
    last = right.sinkage_m;
  }
}

TEST(EffectsDigging, SlipSinkageMatchesLinearAndReeceLaws) {
  for (const double slip : {-0.6, 0.0, 0.4, 0.8}) {
    const double z0 = predict(base(), straightOn(slip)).sinkage_m, i = std::max(0.0, slip);
    RefinedModel model = base();
    model.effects = {with("slip_sinkage_linear", {0.5})};
    // Closed form: z0 (1 + a i), and z0 + a h i / (1 - i) with h = 10 mm; a braked wheel does not dig by
    // these effects.
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i), 1e-9) << slip;
    model.effects = {with("slip_sinkage_reece", {0.4})};
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 + 0.4 * 0.01 * i / (1.0 - i), 1e-9) << slip;
    model.effects.push_back(with("slip_sinkage_linear", {0.5}));
    EXPECT_NEAR(predict(model, straightOn(slip)).sinkage_m, z0 * (1.0 + 0.5 * i) + 0.4 * 0.01 * i / (1.0 - i),
                1e-9);
  }
}

TEST(EffectsDigging, RearFillIncreasesPullAndDugDepthIsExcludedFromBulldozing) {
  RefinedModel model = base();
  model.effects = {with("slip_sinkage_linear", {1.0})};
  const Reading digs = predict(model, straightOn(0.6));
  model.effects.push_back(with("rear_fill", {1.0}));
  const Reading filled = predict(model, straightOn(0.6));
  // Property: contact behind the axle supports the wheel and adds thrust at the same sinkage.
  EXPECT_GT(filled.drawbar_pull_N, digs.drawbar_pull_N);
  EXPECT_EQ(filled.sinkage_m, digs.sinkage_m);
  EXPECT_NEAR(filled.dug_m, 0.6 / 1.6 * filled.sinkage_m, 1e-12);  // Closed form: z0 (1 + a i).
  model.effects.push_back(with("bulldozing_ahead", {2.0}));
  const double pushed = filled.sinkage_m - filled.dug_m,
               kp = std::pow(std::tan(0.25 * std::numbers::pi + 0.275), 2);
  // Closed form: a b gamma z_p^2 Kp / 2, gamma = 1600 kg/m^3 x 9.80665 m/s^2.
  EXPECT_NEAR(filled.drawbar_pull_N - predict(model, straightOn(0.6)).drawbar_pull_N,
              2.0 * state().wheel.width_m * 0.5 * 1600.0 * 9.80665 * pushed * pushed * kp, 1e-6);
}

TEST(EffectsDigging, PloughingGrowsWithTheLateralPathShare) {
  // Closed form: J = sin b / (sin b + m cos b) at 45 deg is 1/2 for m = 1 and 1/4 for m = 3; a r J^2 with
  // a r = 0.1 m, and contact behind 1 - (1 - J). The locked wheel has no other digging effect.
  const WheelContact one = acted("side_ploughing", {0.5, 1.0}, std::numbers::pi / 4),
                     three = acted("side_ploughing", {0.5, 3.0}, -std::numbers::pi / 4);
  EXPECT_NEAR(one.ploughed_m, 0.1 / 4, 1e-12);
  EXPECT_NEAR(one.rebound, 0.5, 1e-12);
  EXPECT_NEAR(three.ploughed_m, 0.1 / 16, 1e-12);
  EXPECT_NEAR(three.rebound, 0.25, 1e-12);
  WheelContact locked = plainContact();
  locked.rolling = 0.0;
  const double parameters[] = {0.5, 1.0};
  findEffect("side_ploughing")->act({parameters, {}, std::numbers::pi / 4}, locked);
  EXPECT_EQ(locked.ploughed_m, 0.0);
}

}  // namespace effects_digging_test
}  // namespace talus::terramech
