#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

#include <talus/terramech/contact/wong_reece_batch.hpp>

#include "reference/reference_table.hpp"

namespace talus::terramech {
namespace wong_reece_batch_test {

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

}  // namespace wong_reece_batch_test
}  // namespace talus::terramech
