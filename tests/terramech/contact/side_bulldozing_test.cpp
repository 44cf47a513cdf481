#include <cmath>
#include <numbers>

#include <talus/terramech/contact/side_bulldozing.hpp>

namespace talus::terramech {
namespace side_bulldozing_test {

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

}  // namespace side_bulldozing_test
}  // namespace talus::terramech
