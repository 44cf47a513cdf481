#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

#include <boost/math/quadrature/tanh_sinh.hpp>
#include <refused.hpp>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/contact/wong_reece_batch.hpp>

#include "reference/reference_table.hpp"

namespace talus::terramech {
namespace wong_reece_test {

Soil soilOf(const test::ReferenceRow& row) {
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

// Property: lugs of a straight wheel are equivalent to a soil with larger c and tan phi, by Bekker's formula
// for the sides of the soil between the lugs.
TEST(WongReece, GrouserSideShearScalesCohesionAndFriction) {
  const Wheel smooth{.radius_m = 0.13, .width_m = 0.2};
  Wheel lugged = smooth;
  lugged.grouser_height_m = 0.025;
  lugged.lug_thrust = 0.7;
  const double gain = 1.0 + 0.7 * 0.64 * 0.125 * std::atan(8.0);
  EXPECT_DOUBLE_EQ(shearGain(lugged), gain);
  Soil stronger = sand();
  stronger.cohesion_Pa *= gain;
  stronger.friction_angle_rad = std::atan(gain * std::tan(stronger.friction_angle_rad));
  for (const double slip : {-0.5, 0.0, 0.1, 0.4, 0.9}) {
    const WheelForces a = equilibrium(sand(), lugged, {.load_N = 120.0, .slip = slip}),
                      b = equilibrium(stronger, smooth, {.load_N = 120.0, .slip = slip});
    EXPECT_NEAR(a.drawbar_pull_N, b.drawbar_pull_N, 1e-9);
    EXPECT_NEAR(a.torque_Nm, b.torque_Nm, 1e-9);
    EXPECT_NEAR(a.sinkage_m, b.sinkage_m, 1e-12);
  }
  lugged.lug_thrust = 0.0;
  EXPECT_EQ(equilibrium(sand(), lugged, {.load_N = 120.0, .slip = 0.3}).drawbar_pull_N,
            equilibrium(sand(), smooth, {.load_N = 120.0, .slip = 0.3}).drawbar_pull_N);
}

// Property: slip sinkage at each slip is equivalent to a larger sinkage exponent, without and with a slip
// angle.
TEST(WongReece, SlipSinkageEqualsAnIncreasedSinkageExponent) {
  const Wheel wheel{.radius_m = 0.13, .width_m = 0.2};
  Soil digging = sand();
  digging.slip_sinkage_exponent = 0.4;
  for (const double slip : {-1.0, -0.5, 0.0, 0.1, 0.4, 0.9})
    for (const double beta : {0.0, 0.3}) {
      Soil grown = sand();
      grown.sinkage_exponent += 0.4 * std::abs(slip);
      const WheelOperation operation{.load_N = 60.0, .slip = slip, .slip_angle_rad = beta};
      const WheelForces a = equilibrium(digging, wheel, operation), b = equilibrium(grown, wheel, operation);
      EXPECT_NEAR(a.sinkage_m, b.sinkage_m, 1e-10);
      EXPECT_NEAR(a.drawbar_pull_N, b.drawbar_pull_N, 1e-6);
      EXPECT_NEAR(a.side_force_N, b.side_force_N, 1e-6);
    }
}

// Property (kobayashi_2010, wong_kobayashi_2012): sinkage and pull over weight of a given mass are
// independent of gravity.
TEST(WongReece, SinkageAndPullRatioOfAMassAreIndependentOfGravity) {
  const Wheel wheel{.radius_m = 0.13, .width_m = 0.2};
  Soil tested = sand();
  tested.test_gravity_m_s2 = 9.81;
  for (const double gravity : {1.62, 3.71, 9.81}) {
    const Soil here = underGravity(tested, gravity);
    for (const double slip : {0.1, 0.5}) {
      const WheelForces there = equilibrium(tested, wheel, {.load_N = 7.0 * 9.81, .slip = slip}),
                        now = equilibrium(here, wheel, {.load_N = 7.0 * gravity, .slip = slip});
      EXPECT_NEAR(now.sinkage_m / there.sinkage_m, 1.0, 1e-7);
      EXPECT_NEAR(now.drawbar_pull_N / gravity, there.drawbar_pull_N / 9.81, 1e-6);
    }
  }
  EXPECT_EQ(underGravity(tested, 20.0).frictional_modulus, tested.frictional_modulus);
  EXPECT_EQ(underGravity(sand(), 1.62).frictional_modulus, sand().frictional_modulus);
}

// Independent of the code under test: C.4 to C.10 as printed, with adaptive quadrature over the angle.
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

TEST(WongReece, MatchesTheReferenceCases) {
  const auto rows = test::referenceTable("equilibria");
  EXPECT_EQ(rows.size(), 53u);
  for (const auto& row : rows) {
    const Wheel wheel{.radius_m = row["wheel_radius_m"], .width_m = row["wheel_width_m"]};
    const WheelForces got = equilibrium(soilOf(row), wheel, {.load_N = row["load_N"], .slip = row["slip"]});
    // Closed form: independent adaptive quadrature, printed to 1e-8.
    EXPECT_NEAR(got.sinkage_m / row["sinkage_m"], 1.0, 1e-7);
    EXPECT_NEAR(got.entry_angle_rad / row["entry_angle_rad"], 1.0, 1e-7);
    EXPECT_NEAR(got.torque_Nm / row["torque_Nm"], 1.0, 1e-7);
    EXPECT_NEAR(got.drawbar_pull_N, row["drawbar_pull_N"], 1e-7 * row["load_N"]);
  }
}

TEST(WongReece, IntegralsMatchAdaptiveQuadrature) {
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

TEST(WongReece, EquilibriumCarriesTheGivenLoad) {
  std::mt19937_64 random{2};
  std::uniform_real_distribution<double> slip{-1.0, 1.0}, load{0.5, 300.0};
  for (int k = 0; k < 200; ++k) {
    const WheelOperation operation{.load_N = load(random), .slip = slip(random), .rebound = 0.1 * (k % 2)};
    const WheelForces forces = equilibrium(sand(), Wheel{}, operation);
    const ImposedContact contact = forcesAtEntry(sand(), Wheel{}, operation, forces.entry_angle_rad);
    // Property: the contact carries the load.
    EXPECT_NEAR(contact.load_N / operation.load_N, 1.0, 1e-11);
  }
}

TEST(WongReece, BrakedAndDrivenBranchesAreContinuousAtZeroSlip) {
  const auto at = [](double slip) { return equilibrium(sand(), Wheel{}, {.load_N = 80.0, .slip = slip}); };
  // Property: both definitions of slip agree to first order at slip 0.
  EXPECT_NEAR(at(-1e-9).drawbar_pull_N, at(1e-9).drawbar_pull_N, 1e-5);
  EXPECT_NEAR(at(-1e-9).torque_Nm, at(0.0).torque_Nm, 1e-6);
}

TEST(WongReece, LockedWheelMobilisesTheFullShearStrength) {
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

TEST(WongReece, StressIsZeroAtContactEndsAndPeaksAtTheC1C2Angle) {
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

// A soil, wheel and operation from the limits of the allowed ranges.
struct Extreme {
  Soil soil;
  Wheel wheel;
  WheelOperation operation;
};

Extreme extreme(std::mt19937_64& random) {
  std::uniform_real_distribution<double> even{0.0, 1.0};
  const auto log = [&](double low, double high) { return low * std::pow(high / low, even(random)); };
  const auto pick = random() % 8;
  const double slips[] = {-1.0, -1e-12, 0.0, 1e-12, 1.0};
  const double slip = pick < 5 ? slips[pick] : 2.0 * even(random) - 1.0;
  return {
      .soil = {.name = "extreme",
               .cohesion_Pa = pick == 5 ? 0.0 : log(1.0, 1e5),
               .friction_angle_rad = pick == 6 ? 0.0 : 1.4 * even(random),
               .sinkage_exponent = 0.1 + 1.9 * even(random),
               .frictional_modulus = log(1e2, 1e9),
               .shear_modulus_m = log(1e-5, 1.0)},
      .wheel = {.radius_m = log(0.005, 2.0), .width_m = log(0.002, 2.0)},
      .operation = {.load_N = log(1e-3, 1e8), .slip = slip, .rebound = pick == 7 ? 0.9 * even(random) : 0.0}};
}

TEST(WongReece, RandomInputsYieldFiniteEquilibriumOrDomainError) {
  // Property: the result carries the load, or std::domain_error is thrown; no NaN and no endless search
  // occur.
  std::mt19937_64 random{7};
  int answered = 0;
  for (int k = 0; k < 5000; ++k) {
    const Extreme e = extreme(random);
    try {
      const WheelForces f = equilibrium(e.soil, e.wheel, e.operation);
      ASSERT_TRUE(std::isfinite(f.torque_Nm) && std::isfinite(f.drawbar_pull_N));
      ASSERT_GT(f.entry_angle_rad, 0.0);
      ASSERT_LE(f.entry_angle_rad, 1.5707963267948968);
      const double carried = forcesAtEntry(e.soil, e.wheel, e.operation, f.entry_angle_rad).load_N;
      EXPECT_NEAR(carried / e.operation.load_N, 1.0, 1e-6);
      ++answered;
    } catch (const std::domain_error&) {
    }
  }
  EXPECT_GT(answered, 1500);  // about half of these soils carry their load
}

TEST(WongReece, ForcesScaleWithUnits) {
  // Property: lengths scaled by a and stresses by s (k_phi in N/m^(n+2) by s/a^n) scale forces by s a^2 and
  // torque by s a^3, and leave the angle unchanged.
  std::mt19937_64 random{8};
  for (int k = 0; k < 300; ++k) {
    const Extreme e = extreme(random);
    const double a = 0.37, s = 11.0;
    Extreme scaled = e;
    scaled.wheel = {.radius_m = a * e.wheel.radius_m, .width_m = a * e.wheel.width_m};
    scaled.soil.cohesion_Pa *= s;
    scaled.soil.frictional_modulus *= s / std::pow(a, e.soil.sinkage_exponent);
    scaled.soil.shear_modulus_m *= a;
    constexpr double kEntry = 0.6;
    const auto f = forcesAtEntry(e.soil, e.wheel, e.operation, kEntry);
    const auto g = forcesAtEntry(scaled.soil, scaled.wheel, scaled.operation, kEntry);
    const double scale = std::abs(f.load_N) + std::abs(f.forces.drawbar_pull_N);
    EXPECT_NEAR(g.load_N / (s * a * a) / scale, f.load_N / scale, 1e-10);
    EXPECT_NEAR(g.forces.drawbar_pull_N / (s * a * a) / scale, f.forces.drawbar_pull_N / scale, 1e-10);
    EXPECT_NEAR(g.forces.torque_Nm / (s * a * a * a), f.forces.torque_Nm,
                1e-9 * std::abs(f.forces.torque_Nm));
  }
}

TEST(WongReece, WheelPowerEqualsShearAndCompactionWork) {
  // Property: T omega - DP v = r b int tau (r omega - v cos) + sigma v sin: power equals the rates of
  // friction between rim and soil and of compression. The stresses are integrated separately by the
  // trapezoidal rule.
  for (const double slip : {-0.4, 0.0, 0.2, 0.7}) {
    const Wheel wheel{.radius_m = 0.12, .width_m = 0.08};
    const WheelOperation operation{.load_N = 70.0, .slip = slip, .rebound = 0.1};
    const WheelForces f = equilibrium(sand(), wheel, operation);
    const double omega = 1.0, v = travelRatio(slip) * wheel.radius_m * omega;
    const auto stresses = stressDistribution(sand(), wheel, operation, 20001);
    double lost = 0.0;
    for (std::size_t k = 0; k + 1 < stresses.size(); ++k) {
      const auto& p = stresses[k];
      lost += (p.shear_Pa * (wheel.radius_m * omega - v * std::cos(p.angle_rad)) +
               p.normal_Pa * v * std::sin(p.angle_rad)) *
              (stresses[k + 1].angle_rad - p.angle_rad);
    }
    lost *= wheel.radius_m * wheel.width_m;
    EXPECT_NEAR((f.torque_Nm * omega - f.drawbar_pull_N * v) / lost, 1.0, 2e-4) << slip;
    EXPECT_GT(lost, 0.0);
  }
}

TEST(WongReece, PullIncreasesWithSlipForAFixedPeakAngle) {
  // Property: with c2 = 0 the normal stress at a sinkage is independent of slip, and j, torque and pull
  // increase with slip.
  std::mt19937_64 random{9};
  for (int k = 0; k < 100; ++k) {
    Extreme e = extreme(random);
    e.soil.c2 = 0.0;
    ImposedContact last = forcesAtEntry(e.soil, e.wheel, {.load_N = 1.0, .slip = -1.0}, 0.7);
    for (int i = -9; i <= 10; ++i) {
      const auto here = forcesAtEntry(e.soil, e.wheel, {.load_N = 1.0, .slip = 0.1 * i}, 0.7);
      const double rounding = 1e-9 * std::abs(here.load_N);
      EXPECT_GE(here.forces.torque_Nm, last.forces.torque_Nm - rounding * e.wheel.radius_m);
      EXPECT_GE(here.forces.drawbar_pull_N, last.forces.drawbar_pull_N - rounding);
      last = here;
    }
  }
}

TEST(WongReece, LoadAndSlipOutOfRangeAreRejected) {
  const Wheel wheel{};
  EXPECT_REFUSED(equilibrium(sand(), wheel, {.load_N = 1e6, .slip = 0.2}), std::domain_error,
                 "sinks to its axle before the soil carries 1000000.000000 N");
  const auto on_sand = [&](const WheelOperation& operation) { return equilibrium(sand(), wheel, operation); };
  EXPECT_REFUSED(on_sand({.load_N = 0.0, .slip = 0.2}), std::invalid_argument, "load_N = 0, must be > 0");
  EXPECT_REFUSED(on_sand({.load_N = 50.0, .slip = 1.1}), std::invalid_argument,
                 "slip = 1.1, must be in [-1, 1]");
  EXPECT_REFUSED(on_sand({.load_N = 50.0, .slip = std::nan("")}), std::invalid_argument,
                 "slip = nan, must be finite");
  EXPECT_REFUSED(on_sand({.load_N = 50.0, .slip = 0.2, .rebound = -0.1}), std::invalid_argument,
                 "rebound = -0.1, must be in [0, 0.999]");
  EXPECT_REFUSED(on_sand({.load_N = 50.0, .slip = 0.2, .rebound = 1.0}), std::invalid_argument,
                 "rebound = 1, must be in [0, 0.999]");
  Soil soil = sand();
  soil.frictional_modulus = -1.0;
  EXPECT_REFUSED(equilibrium(soil, wheel, {.load_N = 50.0, .slip = 0.2}), std::invalid_argument,
                 "cohesive_modulus / width_m + frictional_modulus = -1, must be > 0");
  soil = sand();
  soil.c2 = 0.9;
  EXPECT_REFUSED(equilibrium(soil, wheel, {.load_N = 50.0, .slip = 0.8}), std::domain_error,
                 "the stress peak c1 + c2 slip = 1.150000 lies outside the contact, [0, 1]");
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine_);
  }

 private:
  std::mt19937_64 engine_;
};

/// Random cases over the ranges of Table 2.1 of the thesis and well beyond.
std::vector<WheelCase> wideCases(std::size_t count) {
  Random random{7};
  std::vector<WheelCase> cases(count);
  for (WheelCase& c : cases) {
    c = {.cohesion_Pa = random.between(0.0, 7e3),
         .friction_angle_rad = random.between(0.0, 0.75),
         .sinkage_exponent = random.between(0.1, 1.6),
         .sinkage_modulus = std::exp(random.between(12.0, 16.0)),
         .shear_modulus_m = random.between(0.005, 0.05),
         .wheel_radius_m = random.between(0.04, 0.4),
         .wheel_width_m = random.between(0.03, 0.4),
         .load_N = random.between(1.0, 300.0),
         .slip = random.between(-0.2, 1.0)};
    if (&c - cases.data() < static_cast<std::ptrdiff_t>(count / 2)) continue;
    c.grouser_height_m = random.between(0.0, 0.5 * c.wheel_radius_m);
    c.lug_thrust = random.between(0.0, 3.0);
    c.slip_sinkage_exponent = random.between(0.0, 0.6);
  }
  return cases;
}

std::vector<WheelForces> solved(const std::vector<WheelCase>& cases, BatchKernel kernel = BatchKernel::Best) {
  std::vector<WheelForces> forces(cases.size());
  equilibria(cases, forces, kernel);
  return forces;
}

TEST(WongReeceBatch, MatchesTheGeneralSolver) {
  const auto cases = wideCases(4001);
  const auto forces = solved(cases);
  int answered = 0;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    WheelForces want;
    try {
      want = equilibrium(cases[k]);
    } catch (const std::domain_error&) {
      EXPECT_TRUE(std::isnan(forces[k].sinkage_m));
      continue;
    }
    ++answered;
    const double load = cases[k].load_N;
    // Property: two codes, quadratures and root searches agree; 1e-7 is the batch's stated accuracy.
    EXPECT_NEAR(forces[k].sinkage_m / want.sinkage_m, 1.0, 1e-7) << k;
    EXPECT_NEAR(forces[k].drawbar_pull_N, want.drawbar_pull_N, 1e-7 * load) << k;
    EXPECT_NEAR(forces[k].torque_Nm, want.torque_Nm, 1e-7 * load * cases[k].wheel_radius_m) << k;
  }
  EXPECT_GT(answered, 3500);
}

/// The same cases at slip angles, with more braked wheels.
std::vector<WheelCase> slidingCases(std::size_t count) {
  Random random{13};
  std::vector<WheelCase> cases = wideCases(count);
  for (WheelCase& c : cases) {
    c.slip = random.between(-0.95, 1.0);
    c.slip_angle_rad = random.between(-1.57, 1.57);
    c.digging_exponent = random.between(0.0, 0.6);
    c.side_bulldozing = random.between(0.0, 2.0);
    c.gravity_m_s2 = random.between(1.0, 10.0);
  }
  return cases;
}

TEST(WongReeceBatch, MatchesTheGeneralSolverAtSlipAngles) {
  const auto cases = slidingCases(3001);
  std::vector<WheelForces> forces(cases.size());
  equilibria(cases, forces, BatchKernel::Best, Leftover::Nan);
  int fast = 0;
  for (std::size_t k = 0; k < cases.size(); ++k) {
    if (std::isnan(forces[k].sinkage_m)) continue;
    ++fast;
    const WheelForces want = equilibrium(cases[k]);
    const double load = cases[k].load_N;
    // Property: two codes, quadratures and root searches agree; 1e-6 is the batch's stated accuracy there.
    EXPECT_NEAR(forces[k].sinkage_m / want.sinkage_m, 1.0, 1e-6) << k;
    EXPECT_NEAR(forces[k].drawbar_pull_N, want.drawbar_pull_N, 1e-6 * load) << k;
    EXPECT_NEAR(forces[k].side_force_N, want.side_force_N, 1e-6 * std::max(load, std::abs(want.side_force_N)))
        << k;
    EXPECT_NEAR(forces[k].torque_Nm, want.torque_Nm, 1e-6 * load * cases[k].wheel_radius_m) << k;
  }
  EXPECT_GT(fast, 1500);
}

TEST(WongReeceBatch, StraightWheelResultIsIndependentOfSlidingCases) {
  auto mixed = wideCases(400);
  const auto straight = solved(mixed);
  const auto sliding = slidingCases(400);
  for (std::size_t k = 0; k < mixed.size(); k += 3) mixed[k] = sliding[k];
  const auto together = solved(mixed);
  for (std::size_t k = 0; k < mixed.size(); ++k) {
    if (k % 3 == 0) continue;
    EXPECT_EQ(std::memcmp(&straight[k], &together[k], sizeof(WheelForces)), 0) << k;
  }
}

TEST(WongReeceBatch, MatchesTheReferenceCases) {
  const auto rows = test::referenceTable("equilibria");
  std::vector<WheelCase> cases;
  for (const auto& row : rows)
    cases.push_back({row["cohesion_Pa"], row["friction_angle_rad"], row["sinkage_exponent"],
                     row["sinkage_modulus"], row["shear_modulus_m"], row["c1"], row["c2"],
                     row["wheel_radius_m"], row["wheel_width_m"], row["load_N"], row["slip"]});
  const auto forces = solved(cases);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    // Closed form: independent adaptive quadrature, printed to 1e-8.
    EXPECT_NEAR(forces[k].sinkage_m / rows[k]["sinkage_m"], 1.0, 2e-7);
    EXPECT_NEAR(forces[k].torque_Nm / rows[k]["torque_Nm"], 1.0, 2e-7);
    EXPECT_NEAR(forces[k].drawbar_pull_N, rows[k]["drawbar_pull_N"], 2e-7 * rows[k]["load_N"]);
  }
}

#if defined(__x86_64__)
TEST(WongReeceBatch, KernelsAreBitIdentical) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  const auto cases = wideCases(4003);
  const auto scalar = solved(cases, BatchKernel::Scalar), avx2 = solved(cases, BatchKernel::Avx2);
  EXPECT_EQ(std::memcmp(scalar.data(), avx2.data(), scalar.size() * sizeof(WheelForces)), 0);
  const auto sliding = slidingCases(2003);
  const auto one = solved(sliding, BatchKernel::Scalar), four = solved(sliding, BatchKernel::Avx2);
  EXPECT_EQ(std::memcmp(one.data(), four.data(), one.size() * sizeof(WheelForces)), 0);
}
#endif

TEST(WongReeceBatch, ResultIsIndependentOfOtherCasesInTheBatch) {
  const auto cases = wideCases(400);
  const auto together = solved(cases);
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const auto alone = solved({cases[k]});
    EXPECT_EQ(std::memcmp(&alone[0], &together[k], sizeof(WheelForces)), 0) << k;
  }
}

TEST(WongReeceBatch, UnsolvableCasesReturnNan) {
  std::vector<WheelCase> cases(
      5, wheelCase({.name = "s", .cohesion_Pa = 500.0, .friction_angle_rad = 0.5, .frictional_modulus = 1e6},
                   Wheel{}, {.load_N = 60.0, .slip = 0.3}));
  cases[1].load_N = 1e7;
  cases[2].slip = 1.5;
  cases[3].sinkage_modulus = std::nan("");
  const auto forces = solved(cases);
  EXPECT_GT(forces[0].sinkage_m, 0.0);
  EXPECT_TRUE(std::isnan(forces[1].sinkage_m));
  EXPECT_TRUE(std::isnan(forces[2].torque_Nm));
  EXPECT_TRUE(std::isnan(forces[3].drawbar_pull_N));
  EXPECT_EQ(forces[4].sinkage_m, forces[0].sinkage_m);
  std::vector<WheelForces> too_few(2);
  EXPECT_THROW(equilibria(cases, too_few), std::invalid_argument);
}

}  // namespace wong_reece_test
}  // namespace talus::terramech
