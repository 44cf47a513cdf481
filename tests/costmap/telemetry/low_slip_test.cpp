// Extrapolation of readings below the reference slip to the reference slip and beyond.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <rover_drive.hpp>

#include <talus/costmap/ground/ground_class.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>
#include <talus/terramech/contact/wong_reece.hpp>

namespace talus::costmap {
namespace low_slip_test {

constexpr double kReferenceSlip = 0.5;
constexpr double kTwelveDegrees = 0.2126;  // tangent of 12 deg
constexpr std::array<maps::Cell, 4> kCells{
    {{30, 23}, {16, 23}, {30, 26}, {30, 60}}};  // cells: driven twice (2), beside the drive, far from the
                                                // drive

// Soils of the library, and a strong soil with a small shear modulus.
std::vector<terramech::SoilPrior> priors() {
  const auto soil = [](const char* name, double cohesion_Pa, double friction_rad, double exponent,
                       double frictional_modulus, double shear_modulus_m) {
    return terramech::Soil{.name = name,
                           .cohesion_Pa = cohesion_Pa,
                           .friction_angle_rad = friction_rad,
                           .sinkage_exponent = exponent,
                           .frictional_modulus = frictional_modulus,
                           .shear_modulus_m = shear_modulus_m,
                           .c1 = 0.43,
                           .c2 = 0.32};
  };
  std::vector<terramech::SoilPrior> all(5);
  all[0].mean = soil("mars_crusty", 1100.0, 0.602, 0.85, 1750e3, 0.020);
  all[0].deviation = {.cohesion_Pa = 800.0,
                      .friction_angle_rad = 0.082,
                      .sinkage_exponent = 0.202,
                      .frictional_modulus = 144.3e3,
                      .shear_modulus_m = 0.0058};
  all[1].mean = soil("sandy_loam", 7445.0, 0.44, 0.7, 1515e3, 0.020);
  all[1].mean.cohesive_modulus = 5270.0;
  all[1].deviation = {.cohesion_Pa = 3663.0, .friction_angle_rad = 0.143, .shear_modulus_m = 0.0058};
  all[2].mean = soil("dry_sand", 1040.0, 0.489, 1.1, 1528e3, 0.020);
  all[2].mean.cohesive_modulus = 990.0;
  all[2].deviation = {.shear_modulus_m = 0.0058};
  all[3].mean = soil("clay", 6000.0, 0.393, 0.85, 1250e3, 0.020);
  all[3].deviation = {.cohesion_Pa = 577.0,
                      .friction_angle_rad = 0.0252,
                      .sinkage_exponent = 0.202,
                      .frictional_modulus = 144.3e3,
                      .shear_modulus_m = 0.0058};
  all[4].mean = soil("firm", 500.0, 0.646, 1.0, 1400e3, 0.012);
  all[4].deviation = {.friction_angle_rad = 0.052};
  return all;
}

terramech::SoilPrior firm() {
  return priors().back();
}

terramech::Soil drawn(const terramech::SoilPrior& prior, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  terramech::Soil soil = prior.mean;
  const auto& by = prior.deviation;
  soil.cohesion_Pa = std::max(0.0, soil.cohesion_Pa + by.cohesion_Pa * normal(random));
  soil.friction_angle_rad = std::max(0.15, soil.friction_angle_rad + by.friction_angle_rad * normal(random));
  soil.sinkage_exponent = std::clamp(soil.sinkage_exponent + by.sinkage_exponent * normal(random), 0.4, 1.5);
  soil.frictional_modulus += by.frictional_modulus * normal(random);
  soil.shear_modulus_m = std::max(0.004, soil.shear_modulus_m + by.shear_modulus_m * normal(random));
  return soil;
}

std::shared_ptr<const GroundModel> modelOf(const terramech::SoilPrior& prior) {
  return std::make_shared<GroundModel>(GroundModel::Parts{.rover = testRover(),
                                                          .classes = {groundClass(1, prior, testRover())},
                                                          .policy = {.allow_dangerous = true},
                                                          .prices_crossing = false});
}

struct LowSlip {
  double scale = 1.0, shift = 0.0;  // scale and offset of the slip reading
  bool felt = true;                 // true if torque and sinkage are columns of the file
  unsigned seed = 1;
};

// A drive over hills at slips up to 0.45; steeper places are avoided.
TraversabilityMap driven(const std::shared_ptr<const GroundModel>& model, double height_m,
                         const terramech::Soil& truth, const LowSlip& how) {
  TraversabilityMap map(hills(height_m), model, {});
  const Drive whole = driveOver(map, truth, how.seed, {8.5, 23.5, 38.5});
  Drive drive;
  for (std::size_t i = 0; i < whole.rows.size(); ++i) {
    if (whole.rows[i][kSlip] > 0.45) continue;
    drive.rows.push_back(whole.rows[i]);
    drive.rows.back()[kSlip] = std::max(how.scale * whole.rows[i][kSlip] + how.shift, -1.0);
    drive.run.push_back(whole.run[i]);
    drive.wheel.push_back(whole.wheel[i]);
  }
  addDrive(map, tableOf(drive, how.felt));
  return map;
}

// The steepest gradient that is not refused on ground with this pull at the reference slip.
double reach(const GroundModel& model, double pull) {
  GroundBelief belief = model.prior(0);
  belief.pull = {pull, 0.0};
  double low = -0.5, high = 1.0;
  while (high - low > 1e-3) {
    const double middle = 0.5 * (low + high);
    (model.state(0, belief, middle).refusal == Refusal::None ? low : high) = middle;
  }
  return low;
}

// Forces of a wheel on a soil at a slip.
terramech::WheelForces onWheel(const terramech::Soil& soil, double slip) {
  const terramech::Rover rover = testRover();
  return terramech::equilibrium(soil, rover.wheel, {.load_N = terramech::wheelLoad_N(rover), .slip = slip});
}

// Property: on ground weaker than its class, read at slips from 0.05 to 0.45 with the errors of good
// sensors, one reading exceeds the truth by more than 1 and 1.645 standard deviations no more often than the
// normal distribution does (0.16 and 0.05); with and without torque and sinkage.
TEST(LowSlip, SingleReadingOnWeakGroundIsCalibrated) {
  const terramech::Rover rover = testRover();
  const double load_N = terramech::wheelLoad_N(rover);
  for (const terramech::SoilPrior& prior : priors()) {
    const auto model = modelOf(prior);
    const WheelObserver observer(*model);
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform(0.05, 0.45);
    for (const bool felt : {true, false}) {
      int weak = 0, above = 0, far_above = 0;
      for (int i = 0; i < 1000; ++i) {
        const terramech::Soil soil = drawn(prior, random);
        const double slip = uniform(random), truth = onWheel(soil, kReferenceSlip).drawbar_pull_N / load_N;
        const terramech::WheelForces at = onWheel(soil, slip);
        const double none = std::numeric_limits<double>::quiet_NaN();
        const TelemetryReading reading{
            .load_N = load_N,
            .slip = slip + 0.03 * normal(random),
            .torque_Nm = felt ? at.torque_Nm * (1.0 + 0.03 * normal(random)) : none,
            .sinkage_m = felt ? at.sinkage_m * (1.0 + 0.03 * normal(random)) : none,
            .gradient = at.drawbar_pull_N / load_N + 0.01 * normal(random),
            .drawbar_pull_N = none};
        if (truth >= model->prior(0).pull.value) continue;
        const auto seen = observer.observe(0, reading);
        ASSERT_TRUE(seen);
        ++weak;
        above += seen->pull.value - seen->pull.std > truth ? 1 : 0;
        far_above += seen->pull.value - 1.645 * seen->pull.std > truth ? 1 : 0;
      }
      ASSERT_GT(weak, 400);
      EXPECT_LE(above, 0.16 * weak) << prior.mean.name << ' ' << felt;
      EXPECT_LE(far_above, 0.05 * weak) << prior.mean.name << ' ' << felt;
    }
  }
}

// Property: for soils drawn about their class and driven at slips up to 0.45, the pull at the reference slip
// and the steepest slope beyond exceed the truth by more than 1 and 1.645 standard deviations in no more
// worlds than the normal distribution does (0.16 and 0.05). Tolerance: two standard deviations of the count.
TEST(LowSlip, PullAndMaximumSlopeAreCalibrated) {
  std::mt19937_64 random(5);
  std::array<std::array<int, 2>, kCells.size()> above{}, beyond{};
  int worlds = 0;
  for (const terramech::SoilPrior& prior : priors()) {
    const auto model = modelOf(prior);
    const double height_m = prior.mean.name == "dry_sand" ? 0.2 : 0.5;
    for (int i = 0; i < 12; ++i, ++worlds) {
      const terramech::Soil truth = drawn(prior, random);
      const terramech::MobilityCurve own(truth, testRover());
      const double pull = own.reference().drawbar_pull_over_load, steepest = ExpectedTravel(own).last();
      const TraversabilityMap map =
          driven(model, height_m, truth, {.felt = i % 2 == 0, .seed = 100U + static_cast<unsigned>(i)});
      for (std::size_t c = 0; c < kCells.size(); ++c) {
        const Estimate seen = map.ground(kCells[c])->pull;
        for (const auto& [deviations, which] : {std::pair(1.0, 0U), {1.645, 1U}}) {
          const double less = seen.value - deviations * seen.std;
          above[c][which] += less > pull ? 1 : 0;
          beyond[c][which] += reach(*model, less) > steepest + 0.01 ? 1 : 0;
        }
      }
    }
  }
  const auto most = [&](double share) {
    return share * worlds + 2.0 * std::sqrt(share * (1.0 - share) * worlds);
  };
  for (std::size_t c = 0; c < kCells.size(); ++c)
    for (const auto& count : {above[c], beyond[c]}) {
      EXPECT_LE(count[0], most(0.16)) << kCells[c].column << ' ' << kCells[c].row;
      EXPECT_LE(count[1], most(0.05)) << kCells[c].column << ' ' << kCells[c].row;
    }
}

// Property: on ground of lower strength, the estimate from a low-slip reading is the departure at the
// reference slip, although the departure at the measured slip is far smaller.
TEST(LowSlip, StrengthDeficitIsExtrapolatedToTheReferenceSlip) {
  for (const terramech::SoilPrior& prior : {priors()[0], priors()[1], firm()}) {
    const auto model = modelOf(prior);
    const terramech::Rover rover = testRover();
    const double load_N = terramech::wheelLoad_N(rover), of_class = model->prior(0).pull.value;
    for (const double slip : {0.2, 0.3, 0.4})
      for (const double part : {0.7, 0.85}) {
        terramech::Soil weak = prior.mean;
        weak.cohesion_Pa *= part;
        weak.friction_angle_rad = std::atan(part * std::tan(weak.friction_angle_rad));
        const auto at = [&](double there) { return onWheel(weak, there).drawbar_pull_N / load_N; };
        const double truth = at(0.5), read = at(slip) - model->steady(0, {.slip = slip}).gradient;
        const auto seen = WheelObserver(*model).observe(0, {.load_N = load_N,
                                                            .slip = slip,
                                                            .torque_Nm = std::nan(""),
                                                            .sinkage_m = std::nan(""),
                                                            .gradient = at(slip),
                                                            .drawbar_pull_N = std::nan("")});
        ASSERT_TRUE(seen);
        EXPECT_LT(seen->pull.value - truth, seen->pull.std) << prior.mean.name << ' ' << slip << ' ' << part;
        EXPECT_LT(seen->pull.value - truth, 0.6 * (of_class + read - truth) + 0.01)
            << prior.mean.name << ' ' << slip << ' ' << part;
        EXPECT_GT(seen->pull.value - truth, -0.03) << prior.mean.name << ' ' << slip << ' ' << part;
      }
  }
}

// Property: a slope of 12 degrees is too steep here. A drive at low slip reduces the probability of that to
// no less than 0.85 of its previous value, if the soil lies several standard deviations from its class
// (weaker, with a smaller shear modulus) or its slip is read too small. (By shifting the curve, the
// probability was 0.4 to 0.85 of that.)
TEST(LowSlip, LowSlipDriveDoesNotReduceRiskOnSteepSlopes) {
  const auto model = modelOf(firm());
  const auto soil = [](double friction_rad, double modulus_m) {
    terramech::Soil out = firm().mean;
    out.friction_angle_rad = friction_rad;
    out.shear_modulus_m = modulus_m;
    return out;
  };
  constexpr double kHeight_m = 0.5;
  const TraversabilityMap before(hills(kHeight_m), model, {});
  for (const bool felt : {true, false})
    for (const auto& [truth, how] : {std::pair(soil(0.436, 0.004), LowSlip{}),
                                     {soil(0.5, 0.004), LowSlip{}},
                                     {soil(0.5, 0.008), LowSlip{}},
                                     {soil(0.445, 0.012), LowSlip{}},
                                     {soil(0.445, 0.012), LowSlip{.shift = -0.1}},
                                     {soil(0.445, 0.012), LowSlip{.scale = 0.5}}}) {
      LowSlip drive = how;
      drive.felt = felt;
      const TraversabilityMap after = driven(model, kHeight_m, truth, drive);
      for (const maps::Cell cell : kCells)
        EXPECT_GE(after.model().state(0, *after.ground(cell), kTwelveDegrees).weak,
                  0.85F * before.model().state(0, *before.ground(cell), kTwelveDegrees).weak)
            << truth.friction_angle_rad << ' ' << truth.shear_modulus_m << ' ' << how.scale << ' '
            << how.shift << ' ' << felt << ' ' << cell.column << ' ' << cell.row;
    }
}

}  // namespace low_slip_test
}  // namespace talus::costmap
