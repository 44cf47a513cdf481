#include <cmath>
#include <random>

#include <talus/terramech/numerics/lane_math.hpp>

namespace talus::terramech {
namespace lane_math_test {

class Random {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine_);
  }

 private:
  std::mt19937_64 engine_{3};
};

TEST(LaneMath, MatchesTheStandardLibrary) {
  Random random;
  for (int k = 0; k < 20000; ++k) {
    const double x = random.between(-690.0, 300.0), angle = random.between(1e-6, 1.5707);
    EXPECT_NEAR(lanes::exponential(x) / std::exp(x), 1.0, 2e-12);
    EXPECT_NEAR(lanes::logarithm(std::exp(x)), x, 2e-12);
    EXPECT_NEAR(lanes::sine(angle) / std::sin(angle), 1.0, 3e-11);
    const double half = std::sin(0.5 * angle);
    EXPECT_NEAR(lanes::versine(angle) / (2.0 * half * half), 1.0, 4e-12);
  }
}

TEST(LaneMath, FourLanesAreBitIdenticalToOne) {
  Random random;
  for (int k = 0; k < 2000; ++k) {
    const lanes::Four x{random.between(-30.0, 1.5), random.between(0.01, 1.5), 1.0,
                        random.between(0.01, 1.5)};
    const lanes::Four e = lanes::exponential(x), s = lanes::sine(x);
    for (int lane = 0; lane < 4; ++lane) {  // Property: the same operations in the same order.
      EXPECT_EQ(e[lane], lanes::exponential(static_cast<double>(x[lane])));
      EXPECT_EQ(s[lane], lanes::sine(static_cast<double>(x[lane])));
    }
  }
}

}  // namespace lane_math_test
}  // namespace talus::terramech
