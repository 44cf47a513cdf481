#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <talus/planner/route/arc.hpp>

namespace talus::planner {
namespace arc_test {

TEST(Arc, QuarterCircleEndMatchesClosedForm) {
  const Pose left = after({{0.0, 0.0}, 0.0}, Arc{std::numbers::pi, 0.5});
  // Closed form: radius 2 about (0, 2).
  EXPECT_NEAR(left.place.x_m, 2.0, 1e-12);
  EXPECT_NEAR(left.place.y_m, 2.0, 1e-12);
  EXPECT_NEAR(left.heading_rad, std::numbers::pi / 2, 1e-12);
}

// Property: the end of an arc equals the integral of its heading by the midpoint rule (error of n steps
// below (length curvature)^2 length / (24 n^2)); the reversed arc returns to the start.
TEST(Arc, EndIsTheIntegralOfTheHeading) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int k = 0; k < 100; ++k) {
    const Pose from{{5 * unit(random), 5 * unit(random)}, 3 * unit(random)};
    // The sample includes nearly straight arcs and zero curvature.
    const Arc arc{4 * unit(random), k % 5 == 0 ? 0.0 : unit(random) * std::pow(10.0, -(k % 12))};
    constexpr int kSteps = 4'000;
    Pose walked = from;
    for (int n = 0; n < kSteps; ++n) {
      const double middle = from.heading_rad + arc.length_m * arc.curvature_1_m * (n + 0.5) / kSteps;
      walked.place.x_m += arc.length_m / kSteps * std::cos(middle);
      walked.place.y_m += arc.length_m / kSteps * std::sin(middle);
    }
    const Pose end = after(from, arc);
    EXPECT_NEAR(end.place.x_m, walked.place.x_m, 1e-6) << arc.curvature_1_m;
    EXPECT_NEAR(end.place.y_m, walked.place.y_m, 1e-6) << arc.curvature_1_m;
    const Pose back = after(end, Arc{-arc.length_m, arc.curvature_1_m});
    EXPECT_NEAR(back.place.x_m, from.place.x_m, 1e-9);
    EXPECT_NEAR(back.place.y_m, from.place.y_m, 1e-9);
    EXPECT_NEAR(back.heading_rad, from.heading_rad, 1e-12);
  }
}

}  // namespace arc_test
}  // namespace talus::planner
