#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include <talus/costmap/telemetry/sensor_proof.hpp>

namespace talus::costmap {
namespace sensor_proof_test {

using Row = SensorProof::Row;

// A drive over waves of slope, 0.6 m between rows, with the noise of good sensors; `change` modifies a row.
SensorProof proofOf(const std::function<void(Row&, int)>& change = {}, int rows = 120) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise;
  SensorProof proof;
  for (int i = 0; i < rows; ++i) {
    const double gradient = 0.2 * std::sin(0.15 * i);
    Row row{.run = "a",
            .wheel = "w",
            .reading = {.time_s = 5.0 * i,
                        .place = {0.6 * i, 7.0},
                        .slip = 0.1 + 0.6 * gradient + 0.01 * noise(random)},
            .measured_gradient = gradient + 0.005 * noise(random),
            .map_gradient = gradient,
            .class_slip = 0.1 + 0.6 * gradient,
            .torque_pull = gradient + 0.02 * noise(random)};
    if (change) change(row, i);
    proof.take(row);
  }
  return proof;
}

TEST(SensorProof, SoundSensorsAreProven) {
  const SensorProof proof = proofOf();
  EXPECT_TRUE(proof.pullSound("a", "w"));
  EXPECT_TRUE(proof.torqueSound("a", "w"));
  EXPECT_FALSE(proof.isSuspect("a", "w"));
  EXPECT_FALSE(proof.displaced("a"));
  EXPECT_EQ(proof.wheels("a"), 1U);
  EXPECT_NEAR(proof.gradientExcess("a"), 0.0, 0.005);
  EXPECT_FALSE(proof.pullSound("b", "w"));
  EXPECT_FALSE(proof.pullSound("a", "v"));
}

// Property: failedTest() names the first failed test, in the order of the tests.
TEST(SensorProof, ReportsTheFirstFailedTest) {
  using FailedTest = SensorProof::FailedTest;
  const double kSilent = std::nan("");
  const auto lackOf = [](const std::function<void(Row&, int)>& change) {
    return proofOf(change).failedTest();
  };
  EXPECT_EQ(proofOf().failedTest(), FailedTest::Nothing);
  EXPECT_EQ(lackOf([](Row& r, int i) { r.reading.place.x_m += i < 60 ? 0.0 : 12.0; }), FailedTest::Pose);
  EXPECT_EQ(lackOf([&](Row& r, int) { r.measured_gradient = kSilent; }), FailedTest::SlopeRows);
  EXPECT_EQ(lackOf([](Row& r, int) { r.map_gradient = r.measured_gradient *= 0.1; }), FailedTest::Slopes);
  EXPECT_EQ(lackOf([](Row& r, int i) { r.measured_gradient = 0.2 * std::cos(0.4 * i); }), FailedTest::Slope);
  EXPECT_EQ(lackOf([](Row& r, int) { r.measured_gradient += 0.06; }), FailedTest::SlopeBias);
  EXPECT_EQ(lackOf([](Row& r, int) { r.measured_gradient *= 1.8; }), FailedTest::SlopeScale);
  EXPECT_EQ(lackOf([](Row& r, int) { r.measured_gradient *= 1.4; }), FailedTest::SlopeScale);
  EXPECT_EQ(lackOf([](Row& r, int) { r.reading.slip = 0.05; }), FailedTest::Slip);
  EXPECT_EQ(lackOf([](Row& r, int) { r.mean_slip = r.reading.slip / 0.6; }), FailedTest::WheelScale);
  EXPECT_EQ(lackOf([](Row& r, int) { r.mean_slip = r.reading.slip / 1.5; }), FailedTest::WheelScale);
  EXPECT_EQ(lackOf([](Row& r, int) { r.mean_slip = r.reading.slip / 1.1; }), FailedTest::Nothing);
  // The scale of the wheel changes every ten rows and is 1 on average.
  EXPECT_EQ(lackOf([](Row& r, int i) { r.mean_slip = r.reading.slip * (i / 10 % 2 == 0 ? 1.5 : 0.6); }),
            FailedTest::WheelScale);
  EXPECT_EQ(lackOf([&](Row& r, int) { r.class_slip = kSilent; }), FailedTest::LevelRows);
  const auto step = [](Row& r, int i) { r.reading.slip -= i < 200 ? 0.0 : 0.1; };
  EXPECT_EQ(proofOf({}, 400).failedTest(), FailedTest::Nothing);
  EXPECT_EQ(proofOf(step, 400).failedTest(), FailedTest::SlipStep);
  // A step between two runs is detected, because all runs have the same sensor.
  const auto in_runs = [&](Row& r, int i) {
    r.run = i < 200 ? "a" : "b";
    step(r, i);
  };
  EXPECT_EQ(proofOf(in_runs, 400).failedTest(), FailedTest::SlipStep);
}

// Property: of 500 sound drives with a slope noise of 0.02, over waves of gradient 0.06 to 0.3, at most 5
// are reported as reading slopes too steep. With slopes read 1.4 times too steep, and waves from 0.1 on,
// every drive is reported.
TEST(SensorProof, SlopesOfSoundDrivesAreNotHeldForTooSteep) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  int held = 0, missed = 0;
  for (int drive = 0; drive < 500; ++drive) {
    const double height = 0.06 + 0.24 * any(random), phase = 6.0 * any(random);
    const int rows = 30 + static_cast<int>(170.0 * any(random));
    const auto lackAt = [&](double scale) {
      SensorProof proof;
      for (int i = 0; i < rows; ++i) {
        const double gradient = height * std::sin(0.15 * i + phase);
        const double measured = scale * gradient + 0.02 * noise(random);
        for (const char* const wheel : {"a", "b", "c", "d"})
          proof.take({.run = "r",
                      .wheel = wheel,
                      .reading = {.time_s = 5.0 * i,
                                  .place = {0.6 * i, 7.0},
                                  .slip = 0.1 + 0.6 * gradient + 0.01 * noise(random)},
                      .measured_gradient = measured,
                      .map_gradient = gradient,
                      .class_slip = 0.1 + 0.6 * gradient,
                      .torque_pull = gradient});
      }
      return proof.failedTest();
    };
    held += lackAt(1.0) == SensorProof::FailedTest::SlopeScale ? 1 : 0;
    missed += height > 0.1 && lackAt(1.4) == SensorProof::FailedTest::Nothing ? 1 : 0;
  }
  std::cout << held << " held, " << missed << " missed\n";
  EXPECT_LE(held, 5);
  EXPECT_EQ(missed, 0);
}

// Property: of 500 sound drives of six wheels, whose slip sensors have scale errors of 3 % and noise of 0.01 to
// 0.04, at most 5 fail the comparison of wheels. With slips times 0.3 of two to four wheels, slopes of at
// least 0.15 and noise of at most 0.025 every drive fails it, whether the faulty wheels are the same throughout
// or change every 10 moments.
TEST(SensorProof, WheelsOfSoundDrivesAreProportional) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(0.0, 1.0);
  constexpr int kWheels = 6;
  const char* const names[kWheels] = {"a", "b", "c", "d", "e", "f"};
  int refused = 0, missed = 0;
  for (int drive = 0; drive < 500; ++drive) {
    const double height = 0.1 + 0.2 * any(random), noise = 0.01 + 0.03 * any(random);
    const int rows = 60 + static_cast<int>(140.0 * any(random)), faulty = 2 + drive % 3;
    double scales[kWheels];
    for (double& scale : scales) scale = 1.0 + 0.03 * normal(random);
    const auto found = [&](double scale, bool changes) {
      SensorProof proof;
      for (int i = 0; i < rows; ++i) {
        const double gradient = height * std::sin(0.15 * i);
        double slips[kWheels], mean = 0.0;
        for (int w = 0; w < kWheels; ++w) {
          const bool reads_less = (w + (changes ? i / 10 : 0)) % kWheels < faulty;
          slips[w] = (reads_less ? scale : 1.0) * scales[w] * (0.1 + 0.6 * gradient) + noise * normal(random);
          mean += slips[w] / kWheels;
        }
        for (int w = 0; w < kWheels; ++w)
          proof.take({.run = "r",
                      .wheel = names[w],
                      .reading = {.time_s = 5.0 * i, .place = {0.6 * i, 7.0}, .slip = slips[w]},
                      .measured_gradient = gradient + 0.005 * normal(random),
                      .map_gradient = gradient,
                      .class_slip = 0.1 + 0.6 * gradient,
                      .mean_slip = mean});
      }
      return proof.failedTest();
    };
    refused += found(1.0, false) == SensorProof::FailedTest::WheelScale ? 1 : 0;
    for (const bool changes : {false, true})
      missed += height > 0.15 && noise < 0.025 && found(0.3, changes) == SensorProof::FailedTest::Nothing;
  }
  std::cout << refused << " refused, " << missed << " missed\n";
  EXPECT_LE(refused, 5);
  EXPECT_EQ(missed, 0);
}

TEST(SensorProof, NothingIsProvenByWhatIsStuckSilentOrOff) {
  const double kSilent = std::nan("");
  EXPECT_FALSE(proofOf([](Row& r, int) { r.reading.slip = 0.05; }).pullSound("a", "w"));
  EXPECT_FALSE(proofOf([&](Row& r, int) { r.measured_gradient = kSilent; }).pullSound("a", "w"));
  EXPECT_FALSE(proofOf([](Row& r, int) { r.measured_gradient = 0.2; }).pullSound("a", "w"));
  EXPECT_FALSE(proofOf([](Row& r, int) { r.measured_gradient += 0.05; }).pullSound("a", "w"));
  EXPECT_FALSE(proofOf([&](Row& r, int) { r.map_gradient = kSilent; }).pullSound("a", "w"));
  EXPECT_FALSE(proofOf([](Row& r, int) { r.reading.place = {1.0, 1.0}; }).pullSound("a", "w")) << "it stood";
  EXPECT_FALSE(proofOf([](Row& r, int) { r.torque_pull = 0.3; }).torqueSound("a", "w"));
  EXPECT_FALSE(proofOf([](Row& r, int) { r.torque_pull += 0.1; }).torqueSound("a", "w"));
}

TEST(SensorProof, DoubtsWhatSticksOnTheWay) {
  EXPECT_TRUE(
      proofOf([](Row& r, int i) { r.reading.slip = i > 80 ? 0.1 : r.reading.slip; }).isSuspect("a", "w"));
}

TEST(SensorProof, AJumpCountsUntilThePoseIsBack) {
  EXPECT_TRUE(proofOf([](Row& r, int i) { r.reading.place.y_m += i > 60 ? 8.0 : 0.0; }).displaced("a"));
  EXPECT_FALSE(
      proofOf([](Row& r, int i) { r.reading.place.y_m += i > 60 && i < 90 ? 8.0 : 0.0; }).displaced("a"));
}

}  // namespace sensor_proof_test
}  // namespace talus::costmap
