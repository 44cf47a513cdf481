// Sensors and ground of drives whose truth is known.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <rover_drive.hpp>

#include <talus/costmap/telemetry/drive_posterior.hpp>

namespace talus::costmap {
namespace drive_posterior_test {

// Slip of the rover on a gradient of ground with the soil `truth`, by bisection of the mean pull of its wheels.
double slipOn(const GroundModel& truth, double gradient) {
  double low = -0.5, high = 0.9;
  while (high - low > 1e-4) {
    const double slip = 0.5 * (low + high);
    const double pull = 0.5 * (truth.steady(0, {.slip = slip}).gradient +
                               truth.steady(0, {.slip = slip, .in_rut = true}).gradient);
    (pull < gradient ? low : high) = slip;
  }
  return low;
}

terramech::Soil changed(double strength, double modulus) {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa *= strength;
  soil.friction_angle_rad = std::atan(strength * std::tan(soil.friction_angle_rad));
  soil.shear_modulus_m *= modulus;
  return soil;
}

using Read = std::function<double(double, double, int)>;  // of slip, gradient and number of the moment
struct Reading {
  Read slip = [](double of_wheels, double, int) { return of_wheels; };
  std::function<double(double, int)> gradient = [](double g, int) { return g; };
  bool twice = false;
};

constexpr int kMoments = 320;

// Estimate from a drive of 320 moments over waves on uniform ground.
DriveEstimate driven(const GroundModel& of_class, const GroundModel& truth, const Reading& read,
                     unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise;
  DrivePosterior posterior(of_class);
  for (int i = 0; i < kMoments; ++i) {
    const double x_m = 0.4 * i;
    const double gradient = 0.13 * std::sin(0.35 * x_m) + 0.09 * std::sin(0.11 * x_m + 1.0);
    const double slip = slipOn(truth, gradient);
    if (slip > 0.7) continue;
    posterior.take({.class_index = 0,
                    .rutted = 2,
                    .wheels = 4,
                    .place = {x_m, 0.0},
                    .gradient = read.gradient(gradient, i) + 0.005 * noise(random),
                    .map_gradient = gradient,
                    .slip = read.slip(slip, gradient, i) + 0.01 * noise(random),
                    .second_slip = read.twice ? slip + 0.02 * noise(random) : std::nan("")});
  }
  return posterior.fitted();
}

double departureOf(const GroundModel& truth, const GroundModel& of_class) {
  return truth.reference(0, false).gradient - of_class.reference(0, false).gradient;
}

struct Fault {
  const char* kind;
  Read read;
};
class DrivePosteriorFault : public ::testing::TestWithParam<Fault> {};

// Property: with two slips each fault is named, and the strength of weak, equal and strong ground is that of the
// truth within 0.02.
TEST_P(DrivePosteriorFault, IsNamedAndStrengthIsFoundWithTwoSlips) {
  const auto of_class = groundOf(testSand(), 4);
  for (const double strength : {0.9, 1.0, 1.1}) {
    const auto truth = groundOf(changed(strength, 1.0), 4);
    const DriveEstimate found = driven(*of_class, *truth, {.slip = GetParam().read, .twice = true}, 3);
    const bool fits =
        strength < 1.05 || std::string(GetParam().kind) != "compressed";  // few slips reach the knee
    if (fits) {
      EXPECT_EQ(found.hypothesis, GetParam().kind) << strength;
    }
    EXPECT_NEAR(found.classes[0].departure.value, departureOf(*truth, *of_class), 0.02) << strength;
    EXPECT_TRUE(found.twice);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Each, DrivePosteriorFault,
    ::testing::Values(Fault{"sound", [](double slip, double, int) { return slip; }},
                      Fault{"offset", [](double slip, double, int) { return slip - 0.08; }},
                      Fault{"scale", [](double slip, double, int) { return 0.5 * slip; }},
                      Fault{"compressed", [](double slip, double, int) { return std::min(slip, 0.2); }},
                      Fault{"uphill", [](double slip, double gradient,
                                         int) { return gradient > 0.0 ? 0.4 * slip : slip; }},
                      Fault{"step", [](double slip, double, int i) { return slip + (i < 160 ? 0.0 : 0.1); }}),
    [](const auto& each) { return each.param.kind; });

// Property: a constant slip tells nothing about the ground.
TEST(DrivePosterior, ConstantSlipDoesNotInform) {
  const auto of_class = groundOf(testSand(), 4);
  const DriveEstimate found =
      driven(*of_class, *of_class, {.slip = [](double, double, int) { return 0.12; }}, 4);
  EXPECT_EQ(found.hypothesis, "unrelated");
  EXPECT_LT(found.informing, 0.02);
}

// Property: over sound drives with one slip, on ground of drawn strength and shear modulus, the estimate is
// unbiased and its deviation is true.
TEST(DrivePosterior, IsCalibratedForSoundDrives) {
  const auto of_class = groundOf(testSand(), 4);
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  constexpr int kDrives = 60;
  double bias = 0.0;
  int one = 0, two = 0;
  for (int drive = 0; drive < kDrives; ++drive) {
    const auto truth = groundOf(changed(1.0 + 0.1 * std::clamp(normal(random), -2.0, 2.0),
                                        std::exp(0.2 * std::clamp(normal(random), -2.0, 2.0))),
                                4);
    const DriveEstimate found = driven(*of_class, *truth, {}, static_cast<unsigned>(drive));
    const double off = found.classes[0].departure.value - departureOf(*truth, *of_class);
    bias += off / kDrives;
    one += std::abs(off) < found.classes[0].departure.std ? 1 : 0;
    two += std::abs(off) < 2.0 * found.classes[0].departure.std ? 1 : 0;
  }
  std::printf("bias %.4f, within one and two deviations %.2f, %.2f\n", bias, one / double{kDrives},
              two / double{kDrives});
  EXPECT_NEAR(bias, 0.0, 0.01);
  EXPECT_GT(one, kDrives / 2);
  EXPECT_GT(two, 9 * kDrives / 10);
}

TEST(DrivePosterior, SlopeSensorIsCalibratedByTheMap) {
  const auto of_class = groundOf(testSand(), 4);
  const DriveEstimate found =
      driven(*of_class, *of_class, {.gradient = [](double g, int) { return 0.03 + 1.15 * g; }}, 5);
  EXPECT_NEAR(found.slope_offset, 0.03, 0.005);
  EXPECT_NEAR(found.slope_scale, 1.15, 0.03);
  EXPECT_NEAR(found.gradient(0.03 + 1.15 * 0.1), 0.1, 0.01);
  EXPECT_NEAR(found.classes[0].departure.value, 0.0, 0.02);
  EXPECT_EQ(found.displaced_from, DriveEstimate::kParts);
}

// Property: where the measured slopes become those of another place, the pose is displaced from there on.
TEST(DrivePosterior, DisplacedPoseIsFound) {
  const auto of_class = groundOf(testSand(), 4);
  const auto elsewhere = [](double g, int i) {
    return i < 200 ? g : 0.13 * std::sin(0.35 * 0.4 * i + 2.0) + 0.09 * std::sin(0.044 * i + 3.0);
  };
  const DriveEstimate found = driven(*of_class, *of_class, {.gradient = elsewhere}, 6);
  EXPECT_GE(found.displaced_from, 4);
  EXPECT_LE(found.displaced_from, 6);
  EXPECT_FALSE(found.displaced(140));
  EXPECT_TRUE(found.displaced(found.moments - 1));
}

}  // namespace drive_posterior_test
}  // namespace talus::costmap
