#include <cmath>
#include <limits>
#include <random>

#include <talus/costmap/surface/unseen_slope.hpp>

namespace talus::costmap {
namespace unseen_slope_test {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

maps::Raster<float> plane(double dz_dx, double dz_dy) {
  maps::Raster<float> z({.width = 30, .height = 20, .resolution_m = 0.5, .south_west = {}}, 0.0F);
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 30; ++column)
      z[{column, row}] = static_cast<float>(0.5 * (dz_dx * column + dz_dy * row));
  return z;
}

// Closed form: on a plane the heights around a hole yield the plane's slope for any width of the hole;
// single precision.
TEST(UnseenSlope, PlaneSlopeIsRecovered) {
  std::mt19937 random(1);
  maps::Raster<float> z = plane(0.3, -0.2);
  for (float& height : z.values())
    if (random() % 3 != 0) height = kNone;
  int seen = 0;
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 30; ++column) {
      const UnseenSlope slope = unseenSlope(z, {column, row});
      for (const auto& [said, want] : {std::pair{slope.dz_dx, 0.3}, {slope.dz_dy, -0.2}}) {
        if (said == 0.0) continue;  // no known height on one side
        EXPECT_NEAR(said, want, 1e-5);
        ++seen;
      }
    }
  EXPECT_GT(seen, 700);
}

TEST(UnseenSlope, SlopeIsZeroBeyondTheReach) {
  maps::Raster<float> z({.width = 400, .height = 3, .resolution_m = 1.0, .south_west = {}}, kNone);
  z[{100, 1}] = 0.0F;
  z[{150, 1}] = -25.0F;
  EXPECT_EQ(unseenSlope(z, {125, 1}).dz_dx, -0.5);
  EXPECT_EQ(unseenSlope(z, {132, 1}).dz_dx, -0.5);
  EXPECT_EQ(unseenSlope(z, {133, 1}).dz_dx, 0.0);
  EXPECT_EQ(unseenSlope(z, {99, 1}).dz_dx, 0.0);
  EXPECT_EQ(unseenSlope(z, {125, 1}).dz_dy, 0.0);
}

}  // namespace unseen_slope_test
}  // namespace talus::costmap
