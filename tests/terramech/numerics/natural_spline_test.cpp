#include <vector>

#include <talus/terramech/numerics/natural_spline.hpp>

namespace talus::terramech {
namespace natural_spline_test {

TEST(NaturalSpline, IsNaturalAndConstantOutside) {
  const std::vector<double> x{0.0, 1.0, 2.0}, y{0.0, 1.0, 0.0};
  // Closed form: natural cubic through (0,0), (1,1), (2,0) is 1.5 t - 0.5 t^3 on the first piece.
  const NaturalSpline spline{x, y};
  EXPECT_NEAR(spline(0.5), 1.5 * 0.5 - 0.5 * 0.125, 1e-12);
  EXPECT_EQ(spline(-3.0), 0.0);
  EXPECT_EQ(spline(9.0), 0.0);
}

// Closed form: a straight line is its own natural spline; one knot is a constant, none is 0.
TEST(NaturalSpline, ReproducesLinesAndAcceptsFewKnots) {
  const NaturalSpline line{{-2.0, 0.5, 1.0, 4.0}, {-3.0, 2.0, 3.0, 9.0}};
  for (const double x : {-2.0, -1.1, 0.7, 3.3}) EXPECT_NEAR(line(x), 2.0 * x + 1.0, 1e-12) << x;
  EXPECT_EQ(NaturalSpline({1.0}, {5.0})(7.0), 5.0);
  EXPECT_EQ(NaturalSpline()(7.0), 0.0);
}

}  // namespace natural_spline_test
}  // namespace talus::terramech
