#include <cmath>

#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {
namespace spreading_test {

constexpr Variation kVariation{.pull_std = 0.05, .sinkage_std = 0.1, .correlation_length_m = 4.0};

TEST(SparseKernel, KernelDecreasesFromOneToZero) {
  EXPECT_DOUBLE_EQ(sparseKernel(0.0, 4.0), 1.0);
  EXPECT_EQ(sparseKernel(4.0, 4.0), 0.0);
  EXPECT_NEAR(sparseKernel(2.0, 4.0), 1.0 / 6.0, 1e-12);  // Closed form: (2 - 1)/3 * 1/2
}

TEST(GaussianProcess, OnePlaceIsTheConjugateUpdate) {
  const GaussianProcess process({{.place = {0, 0}, .pull = 0.1, .sinkage = 0.0, .variance = 0.0025}},
                                kVariation);
  // Closed form: a prior and a measurement of equal variance average with equal weights.
  EXPECT_NEAR(process.learned({0, 0}).departure.pull.value, 0.05, 1e-12);
  EXPECT_NEAR(process.learned({0, 0}).departure.pull.std, 0.05 * std::sqrt(0.5), 1e-12);
  EXPECT_EQ(process.learned({5, 0}).departure.pull.value, 0.0);
  EXPECT_EQ(process.learned({5, 0}).departure.pull.std, 0.05);
}

TEST(GaussianProcess, RepeatedPlacesDoNotReduceNeighbourVarianceBelowItsLimit) {
  std::vector<PlaceEvidence> many(20, {.place = {0, 0}, .pull = 0.1, .sinkage = 0.0, .variance = 0.0025});
  const double k = sparseKernel(2.0, 4.0);
  // Property: a place 2 m away that is known exactly reduces the variance by the share k^2 at most.
  EXPECT_GE(GaussianProcess(many, kVariation).learned({2, 0}).departure.pull.std,
            0.05 * std::sqrt(1.0 - k * k));
}

}  // namespace spreading_test
}  // namespace talus::costmap
