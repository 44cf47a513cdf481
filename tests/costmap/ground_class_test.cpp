#include <cmath>

#include <site_fixture.hpp>

#include <costmap/ground_class.hpp>

namespace talus::costmap {
namespace {

double pull(const terramech::Soil& soil) {
  return terramech::MobilityCurve(soil, testRover()).reference().drawbar_pull_over_load;
}

TEST(GroundClass, StatedDeviationsBecomeDoubtAboutThePull) {
  const terramech::SoilPrior prior{.mean = testSand(), .deviation = {.friction_angle_rad = 0.05}};
  terramech::Soil weaker = testSand(), stronger = testSand();
  weaker.friction_angle_rad -= 0.025;
  stronger.friction_angle_rad += 0.025;
  // Closed form: central difference of the one uncertain parameter.
  EXPECT_NEAR(groundClass(1, prior, testRover()).mean_std, pull(stronger) - pull(weaker), 1e-12);
}

TEST(GroundClass, WithoutStatedDeviationsKeepsTheDefault) {
  EXPECT_EQ(groundClass(1, {.mean = testSand(), .deviation = {}}, testRover()).mean_std,
            GroundClass{}.mean_std);
}

}  // namespace
}  // namespace talus::costmap
