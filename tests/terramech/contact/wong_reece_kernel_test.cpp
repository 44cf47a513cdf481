#include <cmath>
#include <random>

#include <talus/terramech/contact/wong_reece_kernel.hpp>

namespace talus::terramech::lanes {
namespace wong_reece_kernel_test {

// Closed form: int_0^1 s^k ds = 1/(k + 1). A rule of N points in t is exact if s^k ds has at most degree 2 N
// - 1 in t.
TEST(WongReeceKernel, QuadratureRulesAreExactForPolynomials) {
  const auto integral = [](const auto& rule, double exponent) {
    double sum = 0.0;
    for (std::size_t i = 0; i < rule.s.size(); ++i) sum += rule.ds[i] * std::pow(rule.s[i], exponent);
    return sum;
  };
  for (const double exponent : {0.0, 0.5, 1.0, 2.0, 3.0})
    EXPECT_NEAR(integral(kCoarse, exponent), 1.0 / (exponent + 1.0), 1e-14) << exponent;
  for (const double exponent : {0.0, 1.0 / 3.0, 1.0, 3.0, 7.0})
    EXPECT_NEAR(integral(kFine, exponent), 1.0 / (exponent + 1.0), 1e-14) << exponent;
}

struct Rim {
  double exponent, modulus, cohesion, tan_friction, radius_over_k, slip, peak, entry;
};

// Integrals of thesis C.3 and C.6 to C.10 over r b (torque: r^2 b), by the midpoint rule.
Sums<double> bruteForce(const Rim& rim) {
  constexpr int kSteps = 400000;
  const double middle = rim.peak * rim.entry;
  Sums<double> sums{0, 0, 0, 0};
  for (int k = 0; k < kSteps; ++k) {
    const double theta = rim.entry * (k + 0.5) / kSteps;
    const double mirrored = theta >= middle ? theta : rim.entry - theta / middle * (rim.entry - middle);
    const double sigma = rim.modulus * std::pow(std::cos(mirrored) - std::cos(rim.entry), rim.exponent);
    const double j_over_r = (rim.entry - theta) - (1.0 - rim.slip) * (std::sin(rim.entry) - std::sin(theta));
    const double tau =
        (rim.cohesion + sigma * rim.tan_friction) * (1.0 - std::exp(-rim.radius_over_k * j_over_r));
    const double step = rim.entry / kSteps;
    sums.load += step * (sigma * std::cos(theta) + tau * std::sin(theta));
    sums.torque += step * tau;
    sums.pull += step * (tau * std::cos(theta) - sigma * std::sin(theta));
  }
  return sums;
}

TEST(WongReeceKernel, SumsEqualTheStressIntegrals) {
  std::mt19937_64 random(2);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 12; ++i) {
    const Rim rim{.exponent = between(0.4, 1.5),
                  .modulus = between(1e4, 1e6),
                  .cohesion = between(0.0, 3000.0),
                  .tan_friction = between(0.1, 0.9),
                  .radius_over_k = between(2.0, 15.0),
                  .slip = between(0.0, 0.9),
                  .peak = between(0.4, 0.7),
                  .entry = between(0.2, 0.8)};
    const Sums<double> expected = bruteForce(rim);
    const Sums<double> seen =
        sumsAt<false>(Constants<double>{rim.exponent, std::log(rim.modulus), rim.cohesion, rim.tan_friction,
                                        rim.radius_over_k, 1.0 - rim.slip, rim.peak, 0.0},
                      rim.entry, kFine);
    // Tolerance: 1e-7 of the quadrature rule, and the error of the midpoint rule near zero, where sigma ~
    // s^n.
    EXPECT_NEAR(seen.load, expected.load, 2e-7 * expected.load) << i;
    EXPECT_NEAR(seen.torque, expected.torque, 2e-7 * expected.load) << i;
    EXPECT_NEAR(seen.pull, expected.pull, 2e-7 * expected.load) << i;
  }
}

// Property: solving for the load of a known entry angle returns the angle, from a start at half the angle.
TEST(WongReeceKernel, SolveRecoversTheEntryAngleOfALoad) {
  for (const double entry : {0.2, 0.45, 0.9}) {
    Constants<double> c{1.0, std::log(5e4), 500.0, 0.4, 6.0, 0.7, 0.5, 0.0};
    c.log_load = std::log(sumsAt<false>(c, entry, kFine).load);
    const Found<double> found = solve<false>(c, std::log(0.5 * entry));
    EXPECT_EQ(found.converged, 1.0);
    EXPECT_NEAR(std::exp(found.u), entry, 1e-7 * entry);
  }
}

}  // namespace wong_reece_kernel_test
}  // namespace talus::terramech::lanes
