#include <cmath>
#include <stdexcept>

#include <talus/terramech/numerics/monotone_curve.hpp>

namespace talus::terramech {
namespace monotone_curve_test {

TEST(MonotoneCurve, InterpolatesItsPointsAndIsConstantOutside) {
  const MonotoneCurve curve{{0.0, 1.0, 3.0}, {1.0, 2.0, 2.5}};
  for (const auto& [x, y] : {std::pair{0.0, 1.0}, {1.0, 2.0}, {3.0, 2.5}, {-1.0, 1.0}, {9.0, 2.5}})
    EXPECT_DOUBLE_EQ(curve.at(x), y);
}

TEST(MonotoneCurve, IsMonotoneBetweenMonotonePoints) {
  const MonotoneCurve curve{{0.0, 0.1, 0.2, 1.0, 1.1}, {0.0, 0.0, 5.0, 5.1, 20.0}};
  double last = -1.0;
  for (int k = 0; k <= 1100; ++k) {  // Property: monotone.
    const double y = curve.at(k * 1e-3);
    EXPECT_GE(y, last);
    last = y;
  }
}

TEST(MonotoneCurve, IsExactOnAStraightLine) {
  const MonotoneCurve curve{{0.0, 0.3, 1.0}, {1.0, 1.6, 3.0}};
  EXPECT_NEAR(curve.at(0.7), 2.4, 1e-15);  // Closed form.
}

TEST(MonotoneCurve, UnorderedPointsAreRejected) {
  EXPECT_THROW(MonotoneCurve({0.0, 0.0}, {1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(MonotoneCurve({0.0}, {1.0}), std::invalid_argument);
  EXPECT_THROW(MonotoneCurve({0.0, 1.0}, {1.0}), std::invalid_argument);
}

}  // namespace monotone_curve_test
}  // namespace talus::terramech
