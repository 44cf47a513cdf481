#include <algorithm>
#include <cmath>
#include <random>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace value_noise_test {

TEST(ValueNoise, MixedMatchesSplitMix64) {
  // Printed in: output of Vigna's splitmix64.c for the states 0 and 1234567; mixed() includes the increment.
  EXPECT_EQ(mixed(0), 0xE220A8397B1DCDAFULL);
  EXPECT_EQ(mixed(1234567), 6457827717110365317ULL);
  EXPECT_EQ(mixed(1234567 + 0x9E3779B97F4A7C15ULL), 3203168211198807973ULL);
}

// Property: mean 1/2 and variance 1/12 of the uniform distribution; tolerance: five standard errors.
TEST(ValueNoise, RandomRowIsUniform) {
  constexpr int kCount = 100000;
  RandomSequence random(7);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random();
    ASSERT_TRUE(value >= 0.0 && value < 1.0);
    sum += value;
    squares += (value - 0.5) * (value - 0.5);
  }
  EXPECT_NEAR(sum / kCount, 0.5, 5 * std::sqrt(1.0 / 12 / kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / kCount));
}

TEST(ValueNoise, GradientNoiseIsZeroOnTheLatticeAndBounded) {
  const GradientNoise noise(3);
  double greatest = 0.0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1e4, 1e4);
  for (int i = 0; i < 500000; ++i)
    greatest = std::max(greatest, std::abs(noise(place(random), place(random))));
  // Closed form: gradients within [-1, 1]^2, weighted at the centre of a square, give at most sqrt(2).
  EXPECT_LE(greatest, std::sqrt(2.0));
  EXPECT_GT(greatest, 0.7);
  for (int x = -3; x < 4; ++x)
    for (int y = -3; y < 4; ++y) EXPECT_EQ(noise(x, y), 0.0);
}

// Property: value and slope are continuous at the border of two squares (fifth-order curves).
TEST(ValueNoise, GradientNoiseIsSmoothAcrossCells) {
  const GradientNoise noise(11);
  constexpr double h = 1e-5;
  for (int i = -20; i < 20; ++i) {
    const double y = 0.37 * i;
    const double west = (noise(i, y) - noise(i - h, y)) / h;
    const double east = (noise(i + h, y) - noise(i, y)) / h;
    EXPECT_NEAR(east, west, 100 * h) << i;  // tolerance: second derivative times h
    const double south = (noise(y, i) - noise(y, i - h)) / h;
    const double north = (noise(y, i + h) - noise(y, i)) / h;
    EXPECT_NEAR(north, south, 100 * h) << i;
  }
}

TEST(ValueNoise, OctaveHalvesWavelengthAndScalesByHurstExponent) {
  const GradientNoise noise(5);
  const FractalGround one({.seed = 5, .longest_m = 30.0, .shortest_m = 30.0, .amplitude_m = 2.0});
  const FractalGround two(
      {.seed = 5, .longest_m = 30.0, .shortest_m = 15.0, .amplitude_m = 2.0, .hurst = 0.5});
  double greatest = 0.0;
  for (double x = 0.0; x < 3000.0; x += 7.3) {
    // Closed form: one octave is the noise itself.
    EXPECT_DOUBLE_EQ(one(x, 2 * x), 2.0 * noise(x / 30.0, 2 * x / 30.0));
    greatest = std::max(greatest, std::abs(two(x, 2 * x) - one(x, 2 * x)));
  }
  EXPECT_LE(greatest, 2.0);  // amplitude 2 / 2^hurst = sqrt(2), noise at most sqrt(2)
  EXPECT_GT(greatest, 0.5);
}

}  // namespace value_noise_test
}  // namespace talus::maps
