#include <cmath>
#include <numeric>

#include <talus/terramech/numerics/gauss_legendre.hpp>

namespace talus::terramech {
namespace gauss_legendre_test {

template <std::size_t N>
double integralOfPower(int power) {
  constexpr auto rule = gaussLegendre<N>();
  double sum = 0.0;
  for (std::size_t k = 0; k < N; ++k) sum += rule.weight[k] * std::pow(rule.node[k], power);
  return sum;
}

TEST(GaussLegendre, IsExactForPolynomialsOfItsDegree) {
  for (int power = 0; power <= 15; ++power)
    EXPECT_NEAR(integralOfPower<8>(power), 1.0 / (power + 1), 1e-15);  // Closed form.
  EXPECT_GT(std::abs(integralOfPower<8>(16) - 1.0 / 17.0), 1e-13);
  EXPECT_NEAR(integralOfPower<24>(40), 1.0 / 41.0, 1e-15);
}

TEST(GaussLegendre, NodesAreSortedWithinTheIntervalAndWeightsSumToOne) {
  constexpr auto rule = gaussLegendre<24>();
  EXPECT_GT(rule.node.front(), 0.0);
  EXPECT_LT(rule.node.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(rule.node.begin(), rule.node.end()));
  EXPECT_NEAR(std::accumulate(rule.weight.begin(), rule.weight.end(), 0.0), 1.0, 1e-15);
}

}  // namespace gauss_legendre_test
}  // namespace talus::terramech
