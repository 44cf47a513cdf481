#include <cmath>
#include <numbers>

#include <gmock/gmock.h>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace rock_field_test {

TEST(Rock, RockIsAHemisphere) {
  const Rock rock{{0, 0}, 2.0};
  // Closed form: sqrt(R^2 - d^2).
  EXPECT_DOUBLE_EQ(rock.height_m(0.0), 2.0);
  EXPECT_NEAR(rock.height_m(1.2), 1.6, 1e-12);
  EXPECT_EQ(rock.height_m(2.0), 0.0);
  EXPECT_EQ(rock.height_m(5.0), 0.0);
}

TEST(RockField, CoveredAreaMatchesTheSizeDistribution) {
  const Grid grid{.width = 800, .height = 800, .resolution_m = 1.0, .south_west = {100.0, -50.0}};
  const double k = 0.1;
  const RockOptions options{.seed = 3, .least_diameter_m = 0.5, .greatest_diameter_m = 4.0};
  const auto rocks = rockField(
      grid, [&](Point) { return k; }, options);
  double larger_than_1_m2 = 0.0, all_m2 = 0.0;
  for (const Rock& rock : rocks) {
    ASSERT_TRUE(rock.centre.x_m >= 100.0 && rock.centre.x_m <= 900.0);
    const double area_m2 = std::numbers::pi * rock.radius_m * rock.radius_m;
    all_m2 += area_m2;
    if (2.0 * rock.radius_m > 1.0) larger_than_1_m2 += area_m2;
  }
  // Printed in golombek_rapp_1997: F(D) = k exp(-q D), q = 1.79 + 0.152 / k. Some 10 000 rocks: 3 %.
  const double q = 1.79 + 0.152 / k;
  const auto share = [&](double d) { return k * std::exp(-q * d); };
  EXPECT_NEAR(all_m2 / 640000.0, share(0.5) - share(4.0), 0.03 * share(0.5));
  // Diameters have twelve steps; 1 m is the limit of a step: 0.5 * 8^(4/12).
  EXPECT_NEAR(larger_than_1_m2 / 640000.0, share(1.0) - share(4.0), 0.06 * share(1.0));
}

TEST(RockField, RocksLieOnlyWhereAbundanceIsPositiveAndSeedReproduces) {
  const Grid grid{.width = 64, .height = 64, .resolution_m = 1.0};
  const auto half = [](Point p) { return p.x_m < 32.0 ? 0.0 : 0.2; };
  const auto first = rockField(grid, half, {.seed = 5});
  const auto again = rockField(grid, half, {.seed = 5});
  const auto other = rockField(grid, half, {.seed = 6});
  ASSERT_FALSE(first.empty());
  for (const Rock& rock : first) EXPECT_GE(rock.centre.x_m, 32.0);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].centre.x_m, again[i].centre.x_m);
  EXPECT_TRUE(other.size() != first.size() || other[0].centre.x_m != first[0].centre.x_m);
}

}  // namespace rock_field_test
}  // namespace talus::maps
