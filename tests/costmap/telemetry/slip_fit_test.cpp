// Estimation of ground strength, slip-sensor offset and scale from slip against slope, on drives with known
// values of all three.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <rover_drive.hpp>

#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/costmap/telemetry/slip_fit.hpp>

namespace talus::costmap {
namespace slip_fit_test {

double none(const std::string&) {
  return 0.0;
}

// Test sand with strength and shear modulus multiplied by factors.
terramech::Soil sand(double strength, double modulus = 1.0) {
  terramech::Soil soil = testSand();
  soil.cohesion_Pa *= strength;
  soil.friction_angle_rad = std::atan(strength * std::tan(soil.friction_angle_rad));
  soil.shear_modulus_m *= modulus;
  return soil;
}

double pullOf(const terramech::Soil& soil) {
  return groundOf(soil, 4)->reference(0, false).gradient;
}

// Posterior from the rows of a drive, on a map that classifies the ground as test sand.
std::shared_ptr<const SlipPosterior> fitted(const TraversabilityMap& map, const Drive& drive,
                                            const std::function<double(double)>& read) {
  constexpr std::size_t kWheels = 4;
  SlipFit fit(map.model());
  for (std::size_t i = 0; i < drive.rows.size(); i += kWheels) {
    SlipFit::Moment moment{.run = drive.run[i],
                           .rutted = 2,
                           .wheels = 4,
                           .place = {drive.rows[i][kX], drive.rows[i][kY]},
                           .gradient = std::tan(drive.rows[i][kSlope])};
    for (std::size_t w = i; w < i + kWheels; ++w) moment.slip += read(drive.rows[w][kSlip]) / kWheels;
    fit.take(moment);
  }
  return fit.fitted(none);
}

struct Sensor {
  double offset, scale;
};

// Property: for ground of any strength the offset is found to within 0.02 and the scale to within 0.2. The
// conservative pull exceeds that of the ground by at most 0.02. For a sound sensor the conservative pull is
// at most 0.07 below that of the ground, and not below the class if the ground is stronger.
TEST(SlipFit, SlipBiasAndStrengthAreSeparated) {
  const TraversabilityMap map = mapOf(testSand(), 4);
  const double of_class = map.model().prior(0).pull.value;
  for (const double strength : {0.85, 0.93, 1.0, 1.1, 1.2}) {
    const terramech::Soil soil = sand(strength);
    const Drive drive = driveOver(map, soil, 3);
    for (const Sensor& sensor : {Sensor{0.0, 1.0},
                                 {-0.1, 1.0},
                                 {0.1, 1.0},
                                 {0.0, 0.8},
                                 {-0.05, 0.8},
                                 {0.0, 0.5},
                                 {0.0, 0.3},
                                 {0.0, 0.2}}) {
      const auto fit = fitted(map, drive, [&](double slip) { return sensor.offset + sensor.scale * slip; });
      const double counted = of_class + fit->departure[0].value - fit->caution[0];
      const std::string named =
          std::to_string(strength) + " " + std::to_string(sensor.offset) + " " + std::to_string(sensor.scale);
      EXPECT_NEAR(fit->slip_bias, sensor.offset, 0.02) << named;
      EXPECT_NEAR(fit->slip_scale, sensor.scale, 0.2) << named;
      EXPECT_LE(counted, std::max(pullOf(soil), of_class) + 0.005) << named;
      if (sensor.scale < 1.0) continue;
      EXPECT_GE(counted, std::min(pullOf(soil), of_class) - 0.02) << named;
      EXPECT_GE(counted, pullOf(soil) - 0.07) << named;
    }
  }
}

// Property: on ground of any strength and the shear modulus of the class, a sensor that compresses slips above
// 0.2 is more probable than not, and for a linear sensor less probable than not.
TEST(SlipFit, CompressingSensorIsDistinguishedFromSoundSensors) {
  const TraversabilityMap map = mapOf(testSand(), 4);
  for (const double strength : {0.85, 0.93, 1.0, 1.1, 1.2}) {
    const Drive drive = driveOver(map, sand(strength), 3);
    const auto probability = [&](const std::function<double(double)>& read) {
      return fitted(map, drive, read)->compressing;
    };
    for (const Sensor& sensor : {Sensor{0.0, 1.0}, {-0.1, 1.0}, {0.1, 1.0}, {0.0, 0.8}, {0.0, 0.5}})
      EXPECT_LT(probability([&](double slip) { return sensor.offset + sensor.scale * slip; }), 0.5)
          << strength << ' ' << sensor.offset << ' ' << sensor.scale;
    for (const double scale : {0.3, 0.5})
      EXPECT_GT(
          probability([&](double slip) { return std::min(slip, 0.2) + scale * std::max(slip - 0.2, 0.0); }),
          0.5)
          << strength << ' ' << scale;
  }
}

// Property: a larger shear modulus, which resembles a sensor scale above 1, is estimated as weak ground.
TEST(SlipFit, LargerShearModulusIsEstimatedAsWeakGround) {
  const TraversabilityMap map = mapOf(testSand(), 4);
  for (const double modulus : {1.0, 1.5, 2.0, 3.0}) {
    const terramech::Soil soil = sand(1.1, modulus);
    const auto fit = fitted(map, driveOver(map, soil, 5), [](double slip) { return slip; });
    EXPECT_LE(map.model().prior(0).pull.value + fit->departure[0].value, pullOf(soil) + 0.02) << modulus;
  }
}

// Closed form: without a moment the standard deviation is infinite. With moments on one slope alone the
// standard deviation exceeds that of the class.
TEST(SlipFit, ConstantSlopeLeavesStrengthUnidentified) {
  const TraversabilityMap map = mapOf(testSand(), 4);
  SlipFit fit(map.model());
  EXPECT_TRUE(std::isinf(fit.fitted(none)->departure[0].std));
  EXPECT_EQ(fit.fitted(none)->departure[0].value, 0.0);
  for (int i = 0; i < 400; ++i)
    fit.take({.run = "a", .wheels = 4, .place = {0.5 * i, 0.0}, .gradient = 0.02, .slip = 0.05});
  EXPECT_GT(fit.fitted(none)->departure[0].std, map.model().parts().classes[0].mean_std);
  fit.take({.run = "a", .wheels = 4, .place = {0.0, 0.0}, .gradient = std::nan(""), .slip = 0.05});
  EXPECT_EQ(fit.moments(), 400U);
}

// Property: the class estimate after a drive equals the strength of weaker ground to within 0.02. For
// stronger ground the class estimate moves by at least a quarter of the difference and never beyond. Slips
// read 0.1 too small do not change these properties.
TEST(SlipFit, ClassEstimateFollowsGroundStrengthDespiteSlipOffset) {
  for (const double strength : {0.85, 0.93, 1.1, 1.2, 1.3})
    for (const double offset : {0.0, -0.1}) {
      TraversabilityMap map = mapOf(testSand(), 4);
      const double of_class = map.model().prior(0).pull.value, truth = pullOf(sand(strength));
      Drive drive = driveOver(map, sand(strength), 3);
      for (auto& row : drive.rows) row[kSlip] += offset;
      const DriveReport report = addDrive(map, tableOf(drive, false));
      const double believed = map.evidence().classBelief(0).pull.value;
      ASSERT_EQ(report.learned.size(), 1U);
      EXPECT_NEAR(report.learned[0].counted_on, believed, 0.02) << strength << ' ' << offset;
      EXPECT_NEAR(report.slip_offset, offset, 0.01);
      if (strength < 1.0) {
        EXPECT_NEAR(believed, truth, 0.02) << strength << ' ' << offset;
      } else {
        EXPECT_GT(believed, of_class + 0.25 * (truth - of_class)) << strength << ' ' << offset;
        EXPECT_LE(believed, truth) << strength << ' ' << offset;
      }
      if (offset == 0.0) {
        EXPECT_NEAR(report.learned[0].if_sound.value, truth, 2.0 * report.learned[0].if_sound.std + 0.01)
            << strength;
      }
    }
}

// Pull and thrust of fresh ground against slip, in fine steps.
struct FineCurve {
  std::vector<double> slip, pull, share;

  explicit FineCurve(const GroundModel& model) {
    const double thrust = model.reference(0, false).torque_over_load_radius;
    for (int i = 0; i <= 2900; ++i) {
      slip.push_back(-0.5 + 0.0005 * i);
      const SteadyWheel wheel = model.steady(0, {.slip = slip.back()});
      pull.push_back(wheel.gradient);
      share.push_back(std::max(wheel.torque_over_load_radius / thrust, 0.02));
    }
  }
  double slipOn(double gradient, double departure) const {
    std::size_t low = 0, high = slip.size() - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (pull[middle] + departure * share[middle] < gradient ? low : high) = middle;
    }
    return slip[low];
  }
  std::size_t at(double of) const { return static_cast<std::size_t>(std::lround((of + 0.5) / 0.0005)); }
};

// Closed form: the posterior of (B3), (B4) by importance sampling. Draws from the prior, weighted by their
// likelihood, give the mean to within four of their standard errors, and the variance to a fifth.
TEST(SlipFit, FitMatchesImportanceSamplingOfThePosterior) {
  const TraversabilityMap map = mapOf(testSand(), 4);
  const GroundClass& ground = map.model().parts().classes[0];
  const double p = ground.pull_std, q = ground.mean_std;
  const FineCurve curve(map.model());
  struct Read {
    double gradient, slip, steepness, share;
  };
  std::vector<Read> reads;
  SlipFit fit(map.model());
  for (int i = 0; i < 12; ++i) {
    const double gradient = 0.005 + 0.01 * (2 * i - 6), slip = 0.9 * curve.slipOn(gradient, 0.0) - 0.03;
    const std::size_t at = curve.at(slip);
    reads.push_back({gradient, slip, std::max((curve.pull[at + 10] - curve.pull[at - 10]) / 0.01, 0.05),
                     curve.share[at]});
    fit.take({.run = "a", .wheels = 4, .place = {10.0 * i, 0.0}, .gradient = gradient, .slip = slip});
  }
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  double all = 0.0, squares = 0.0, mean = 0.0, second = 0.0, bias = 0.0;
  for (int draw = 0; draw < 100000; ++draw) {
    const double d = q * normal(random), b = 0.1 * normal(random), usual = 0.45 * std::abs(normal(random));
    const double s = std::exp(uniform(random) < 0.1 ? -2.3 * uniform(random) : -usual);
    constexpr double kShares[] = {0.0, 0.35, 0.7, 1.0, 1.4};
    const double t = kShares[random() % 5];
    double log = -40.0;
    for (const Read& r : reads) {
      const double of_place = std::hypot(t * p, 0.02) * r.share / r.steepness;
      const double v =
          std::min(of_place * of_place + 0.015 * 0.015 + 1e-4 / (r.steepness * r.steepness), 1.0);
      const double miss = r.slip - b - s * curve.slipOn(r.gradient, d);
      log -= 0.5 * (miss * miss / v + std::log(v));
    }
    const double w = std::exp(log);
    all += w;
    squares += w * w;
    mean += w * d;
    second += w * d * d;
    bias += w * b;
  }
  mean /= all;
  const double variance = second / all - mean * mean, error = std::sqrt(variance * squares) / all;
  ASSERT_LT(error, 0.004);
  const auto found = fit.fitted(none);
  EXPECT_NEAR(found->departure[0].value, mean, 4.0 * error);
  EXPECT_NEAR(found->slip_bias, bias / all, 0.005);
  const double own = found->departure[0].std;
  EXPECT_NEAR(1.0 / (1.0 / (own * own) + 1.0 / (q * q)), variance, 0.2 * variance);
}

}  // namespace slip_fit_test
}  // namespace talus::costmap
