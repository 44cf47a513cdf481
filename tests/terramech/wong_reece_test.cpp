#include <cmath>
#include <random>
#include <stdexcept>

#include <boost/math/quadrature/tanh_sinh.hpp>

#include <terramech/shear_displacement.hpp>
#include <terramech/wong_reece.hpp>

#include "reference_table.hpp"

namespace talus::terramech {
namespace {

Soil soilOf(test::Row& row) {
  return {.name = "case",
          .cohesion_Pa = row["cohesion_Pa"],
          .friction_angle_rad = row["friction_angle_rad"],
          .sinkage_exponent = row["sinkage_exponent"],
          .frictional_modulus = row["sinkage_modulus"],
          .shear_modulus_m = row["shear_modulus_m"],
          .c1 = row["c1"],
          .c2 = row["c2"]};
}

Soil sand() {
  return {.name = "sand",
          .cohesion_Pa = 800.0,
          .friction_angle_rad = 0.56,
          .sinkage_exponent = 0.9,
          .frictional_modulus = 1.6e6,
          .shear_modulus_m = 0.018};
}

// Independent of the code under test: C.4 to C.10 as printed, adaptive quadrature over the angle itself.
ImposedContact adaptive(const Soil& soil, const Wheel& wheel, const WheelOperation& operation, double entry) {
  const double r = wheel.radius_m, k = soil.cohesive_modulus / wheel.width_m + soil.frictional_modulus;
  const double peak = (soil.c1 + soil.c2 * operation.slip) * entry;
  const double exit = -std::acos(1.0 - operation.rebound * (1.0 - std::cos(entry)));
  const double q = operation.slip >= 0.0 ? 1.0 - operation.slip : 1.0 / (1.0 + operation.slip);
  const auto sigma = [&](double theta) {
    const double front = theta >= peak ? theta : entry - (entry - peak) * (theta - exit) / (peak - exit);
    return k * std::pow(std::max(0.0, r * (std::cos(front) - std::cos(entry))), soil.sinkage_exponent);
  };
  const auto tau = [&](double theta) {
    const double j = r * ((entry - theta) - q * (std::sin(entry) - std::sin(theta)));
    const double sign = j < 0.0 ? -1.0 : 1.0;
    const double strength = soil.cohesion_Pa + sigma(theta) * std::tan(soil.friction_angle_rad);
    return theta >= entry ? 0.0 : sign * strength * (1.0 - std::exp(-std::abs(j) / soil.shear_modulus_m));
  };
  boost::math::quadrature::tanh_sinh<double> rule{12};
  const auto integral = [&](auto f) {
    double sum = 0.0;
    std::vector<double> ends{exit, peak, entry};
    const double zero = ShearDisplacement{{r, operation.slip, entry}}.signChange_rad(exit);
    if (zero == zero) ends.insert(ends.begin() + (zero > peak ? 2 : 1), zero);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      if (ends[i + 1] - ends[i] > 1e-12)
        sum += rule.integrate([&](double t) { return f(ends[i] + t); }, 0.0, ends[i + 1] - ends[i], 1e-12);
    return sum;
  };
  using std::cos, std::sin;
  const double rb = r * wheel.width_m;
  return {rb * integral([&](double t) { return sigma(t) * cos(t) + tau(t) * sin(t); }),
          {r * (1.0 - cos(entry)), entry, r * rb * integral(tau),
           rb * integral([&](double t) { return tau(t) * cos(t) - sigma(t) * sin(t); })}};
}

TEST(WongReece, AgreesWithTheReferenceCases) {
  if (test::referenceFolder().empty()) GTEST_SKIP() << "TALUS_REFERENCE is not set";
  for (auto row : test::readTable(test::referenceFolder() + "/forward_cases.csv")) {
    const Wheel wheel{.radius_m = row["wheel_radius_m"], .width_m = row["wheel_width_m"]};
    const WheelForces got = equilibrium(soilOf(row), wheel, {.load_N = row["load_N"], .slip = row["slip"]});
    // Closed form: independent adaptive quadrature, printed to 1e-8.
    EXPECT_NEAR(got.sinkage_m / row["sinkage_m"], 1.0, 1e-7);
    EXPECT_NEAR(got.entry_angle_rad / row["entry_angle_rad"], 1.0, 1e-7);
    EXPECT_NEAR(got.torque_Nm / row["torque_Nm"], 1.0, 1e-7);
    EXPECT_NEAR(got.drawbar_pull_N, row["drawbar_pull_N"], 1e-7 * row["load_N"]);
  }
}

TEST(WongReece, IntegralsAgreeWithAdaptiveQuadratureOverTheWholeRange) {
  std::mt19937_64 random{1};
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  };
  double worst = 0.0;
  for (int k = 0; k < 400; ++k) {
    const Soil soil{.name = "random",
                    .cohesion_Pa = between(0.0, 2e4),
                    .friction_angle_rad = between(0.0, 0.8),
                    .sinkage_exponent = between(0.1, 2.0),
                    .frictional_modulus = 1.5e6,
                    .shear_modulus_m = between(0.004, 0.05)};
    const Wheel wheel{.radius_m = between(0.03, 0.6), .width_m = between(0.02, 0.5)};
    const WheelOperation operation{.slip = between(-0.98, 1.0), .rebound = k % 3 ? 0.0 : between(0.0, 0.3)};
    const double entry = between(0.01, 1.5);
    const ImposedContact got = forcesAtEntry(soil, wheel, operation, entry);
    const ImposedContact want = adaptive(soil, wheel, operation, entry);
    const double scale = std::abs(want.load_N) + std::abs(want.forces.drawbar_pull_N);
    worst = std::max({worst, std::abs(got.load_N - want.load_N) / scale,
                      std::abs(got.forces.torque_Nm - want.forces.torque_Nm) / (scale * wheel.radius_m),
                      std::abs(got.forces.drawbar_pull_N - want.forces.drawbar_pull_N) / scale});
  }
  // Closed form: tanh-sinh to 1e-12.
  EXPECT_LT(worst, 1e-8);
}

TEST(WongReece, CarriesTheLoadItWasGiven) {
  std::mt19937_64 random{2};
  std::uniform_real_distribution<double> slip{-1.0, 1.0}, load{0.5, 300.0};
  for (int k = 0; k < 200; ++k) {
    const WheelOperation operation{.load_N = load(random), .slip = slip(random), .rebound = 0.1 * (k % 2)};
    const WheelForces forces = equilibrium(sand(), Wheel{}, operation);
    const ImposedContact contact = forcesAtEntry(sand(), Wheel{}, operation, forces.entry_angle_rad);
    // Property: equilibrium.
    EXPECT_NEAR(contact.load_N / operation.load_N, 1.0, 1e-11);
  }
}

TEST(WongReece, BrakedAndDrivenMeetAtNoSlip) {
  const auto at = [](double slip) { return equilibrium(sand(), Wheel{}, {.load_N = 80.0, .slip = slip}); };
  // Property: both slip definitions agree to first order at 0.
  EXPECT_NEAR(at(-1e-9).drawbar_pull_N, at(1e-9).drawbar_pull_N, 1e-5);
  EXPECT_NEAR(at(-1e-9).torque_Nm, at(0.0).torque_Nm, 1e-6);
}

TEST(WongReece, ALockedWheelFeelsTheWholeShearStrength) {
  const Soil soil = sand();
  const WheelOperation locked{.load_N = 40.0, .slip = -1.0};
  const auto stresses = stressDistribution(soil, Wheel{}, locked, 11);
  for (std::size_t k = 0; k + 1 < stresses.size(); ++k)  // Closed form: Mohr-Coulomb, against the motion
    EXPECT_NEAR(stresses[k].shear_Pa,
                -(soil.cohesion_Pa + stresses[k].normal_Pa * std::tan(soil.friction_angle_rad)), 1e-9);
  const WheelForces forces = equilibrium(soil, Wheel{}, locked);
  EXPECT_LT(forces.torque_Nm, 0.0);
  EXPECT_LT(forces.drawbar_pull_N, equilibrium(soil, Wheel{}, {.load_N = 40.0, .slip = -0.5}).drawbar_pull_N);
}

TEST(WongReece, StressesVanishAtBothEndsAndPeakWhereC2Says) {
  const auto stresses =
      stressDistribution(sand(), Wheel{}, {.load_N = 80.0, .slip = 0.5, .rebound = 0.1}, 1001);
  EXPECT_NEAR(stresses.front().normal_Pa, 0.0, 1.0);
  EXPECT_EQ(stresses.back().normal_Pa, 0.0);
  EXPECT_LT(stresses.front().angle_rad, 0.0);
  const auto highest = std::max_element(stresses.begin(), stresses.end(), [](const auto& a, const auto& b) {
    return a.normal_Pa < b.normal_Pa;
  });
  EXPECT_NEAR(highest->angle_rad / stresses.back().angle_rad, 0.43 + 0.32 * 0.5, 2e-3);  // Closed form: C.2
}

TEST(WongReece, RefusesWhatHasNoAnswer) {
  const Wheel wheel{};
  EXPECT_THROW(equilibrium(sand(), wheel, {.load_N = 1e6, .slip = 0.2}), std::domain_error);
  EXPECT_THROW(equilibrium(sand(), wheel, {.load_N = 0.0, .slip = 0.2}), std::invalid_argument);
  EXPECT_THROW(equilibrium(sand(), wheel, {.load_N = 50.0, .slip = 1.1}), std::invalid_argument);
  EXPECT_THROW(equilibrium(sand(), wheel, {.load_N = 50.0, .slip = std::nan("")}), std::invalid_argument);
  Soil soil = sand();
  soil.frictional_modulus = -1.0;
  EXPECT_THROW(equilibrium(soil, wheel, {.load_N = 50.0, .slip = 0.2}), std::invalid_argument);
  soil = sand();
  soil.c2 = 0.9;
  EXPECT_THROW(equilibrium(soil, wheel, {.load_N = 50.0, .slip = 0.8}), std::domain_error);
}

}  // namespace
}  // namespace talus::terramech
