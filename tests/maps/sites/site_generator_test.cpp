#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <refused.hpp>

#include <talus/maps/maps.hpp>
#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace site_generator_test {

constexpr SiteKind kKinds[] = {SiteKind::Craters, SiteKind::Dunes, SiteKind::Rocks};

std::vector<std::uint32_t> bits(const Site& site) {
  std::vector<std::uint32_t> out;
  for (float v : site.map.elevation_m.values()) out.push_back(std::bit_cast<std::uint32_t>(v));
  for (float v : site.rock_abundance.values()) out.push_back(std::bit_cast<std::uint32_t>(v));
  out.insert(out.end(), site.classes.values().begin(), site.classes.values().end());
  return out;
}

TEST(SiteGenerator, ResultIsIndependentOfThreadCountAndReproducedBySeed) {
  for (SiteKind kind : kKinds) {
    const SiteOptions options{.kind = kind, .width = 150, .height = 200, .seed = 5};
    SiteOptions threads = options;
    threads.threads = 3;
    SiteOptions other = options;
    other.seed = 6;
    EXPECT_EQ(bits(generateSite(options)), bits(generateSite(threads)));
    EXPECT_NE(bits(generateSite(options)), bits(generateSite(other)));
  }
}

TEST(SiteGenerator, EverySiteIsCompleteWithSeveralClasses) {
  for (SiteKind kind : kKinds) {
    const Site site = generateSite({.kind = kind, .width = 400, .height = 400, .seed = 2});
    EXPECT_DOUBLE_EQ(validFraction(site.map.elevation_m), 1.0);
    std::map<int, int> classes;
    for (std::uint8_t c : site.classes.values()) ++classes[c];
    EXPECT_GE(classes.size(), 3U);
    for (const auto& [number, count] : classes) EXPECT_TRUE(number >= 1 && number <= 4) << number;
    for (float k : site.rock_abundance.values()) ASSERT_TRUE(k >= 0 && k < 0.5F);
    // Property: the ground is mostly gentle, and steep in some places.
    const TerrainMetrics m = terrainMetrics(site.map.elevation_m, {.radius_m = 2.0});
    std::vector<float> slopes;
    for (int r = 0; r < 400; ++r)
      for (int c = 0; c < 400; ++c) slopes.push_back(m.slope_rad({c, r}));
    std::sort(slopes.begin(), slopes.end());
    EXPECT_LT(slopes[slopes.size() / 2], 0.25F);
    EXPECT_GT(slopes[slopes.size() * 99 / 100], 0.15F);
    EXPECT_EQ(site.map.georeference->body(), kind == SiteKind::Craters ? "Moon" : "Mars");
  }
}

TEST(SiteGenerator, InvalidOptionsAreRejected) {
  EXPECT_REFUSED(generateSite({.width = 4}), std::invalid_argument,
                 "width = 4.000000, must be 8 to 20000 cells");
  EXPECT_REFUSED(generateSite({.height = 30000}), std::invalid_argument,
                 "height = 30000.000000, must be 8 to 20000 cells");
  EXPECT_REFUSED(generateSite({.resolution_m = std::nan("")}), std::invalid_argument,
                 "resolution_m = nan, must be 0.01 to 1000");
  EXPECT_REFUSED(generateSite({.threads = 0}), std::invalid_argument, "threads = 0.000000, must be >= 1");
}

// Property: outside rocky ground (abundance above 0.2) the area of the rock class equals the area that
// boulders cover.
TEST(SiteGenerator, RockClassAreaMatchesRockAbundance) {
  const Site site =
      generateSite({.kind = SiteKind::Rocks, .width = 300, .height = 300, .resolution_m = 0.25});
  double share = 0.0, abundance = 0.0;
  for (int row = 0; row < 300; ++row)
    for (int column = 0; column < 300; ++column) {
      const double k = static_cast<double>(site.rock_abundance[{column, row}]);
      if (k > 0.2) continue;
      share += site.classes[{column, row}] == static_cast<std::uint8_t>(SiteClass::Rock);
      // golombek_rapp_1997, diameters from 1.5 cells to 4 m.
      const double q = 1.79 + 0.152 / k;
      abundance += k * (std::exp(-0.375 * q) - std::exp(-4.0 * q));
    }
  // Tolerance: a fifth, because boulders overlap and the centre of a cell determines its class.
  EXPECT_NEAR(share / abundance, 1.0, 0.2);
}

}  // namespace site_generator_test

namespace crater_field_test {

TEST(CraterField, SizesFollowThePowerLaw) {
  const Grid grid{.width = 3000, .height = 3000, .resolution_m = 1.0};
  const auto craters =
      craterField(grid, {.seed = 1, .least_diameter_m = 4, .greatest_diameter_m = 400, .density = 0.04});
  const auto larger = [&](double d) {
    return std::count_if(craters.begin(), craters.end(), [=](const Crater& c) { return 2 * c.radius_m > d; });
  };
  // Closed form: the number of craters above D is proportional to D^-2 - Dmax^-2.
  EXPECT_NEAR(static_cast<double>(larger(8)) / static_cast<double>(larger(16)), 4.0, 0.25);
  EXPECT_NEAR(static_cast<double>(larger(4)), 0.04 * 3800 * 3800 / 16, 100);
}

TEST(CraterField, FreshCraterMatchesPikeProportions) {
  const Crater crater{.centre = {}, .radius_m = 10, .age = 0};
  // Printed in: Pike (1977): the depth is 0.2 and the rim height 0.036 of the diameter. Tolerance: rounding
  // of the rim.
  EXPECT_NEAR(crater.height_m(10) - crater.height_m(0), 0.2 * 20, 0.2);
  EXPECT_NEAR(crater.height_m(10), 0.036 * 20, 0.12);
  EXPECT_EQ(crater.height_m(30), 0.0);
  double steepest = 0;
  for (double r = 0; r < 30; r += 0.1) {
    steepest = std::max(steepest, std::abs(crater.height_m(r + 0.1) - crater.height_m(r)) / 0.1);
    EXPECT_LT(std::abs(crater.height_m(r + 0.1) - crater.height_m(r)), 0.1)
        << "no cliff, also where the ejecta end";
  }
  EXPECT_LT(std::atan(steepest) * 57.3, 40);
  const Crater worn{.centre = {}, .radius_m = 10, .age = 1};
  EXPECT_LT(worn.height_m(10) - worn.height_m(0), 0.06 * 20);
}

}  // namespace crater_field_test

namespace dune_field_test {

TEST(DuneField, SlipFacesHaveTheAngleOfRepose) {
  const DuneField dunes({.seed = 3, .wavelength_m = 60, .height_m = 4, .repose_rad = 0.576, .wind_rad = 0.0});
  int faces = 0;
  for (double y = 0; y < 600; y += 7)
    for (double x = 0; x < 600; x += 0.5) {
      const Sand here = dunes.at(x, y);
      const Sand there = dunes.at(x + 0.05, y);
      if (!here.slip_face || !there.slip_face) continue;
      ++faces;
      // Closed form: along the wind the slope of a slip face is the angle of repose.
      ASSERT_NEAR(std::atan((here.height_m - there.height_m) / 0.05), 0.576, 1e-6);
    }
  EXPECT_GT(faces, 500);
}

TEST(DuneField, SurfaceIsContinuous) {
  const DuneField dunes({.seed = 4});
  for (double y = 0; y < 300; y += 3.1)
    for (double x = 0; x < 300; x += 0.1)
      ASSERT_LT(std::abs(dunes.at(x + 0.1, y).height_m - dunes.at(x, y).height_m), 0.12) << x << "," << y;
}

}  // namespace dune_field_test

namespace landscape_test {

constexpr Grid kGrid{.width = 200, .height = 160, .resolution_m = 1.0};
constexpr SiteKind kKinds[] = {SiteKind::Craters, SiteKind::Dunes, SiteKind::Rocks};

std::vector<Point> places(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> x(0.0, 200.0), y(0.0, 160.0);
  std::vector<Point> out(4000);
  for (Point& p : out) p = {x(random), y(random)};
  return out;
}

std::vector<Ground> groundAt(SiteKind kind, std::uint64_t seed) {
  const auto landscape = makeLandscape(kGrid, {.kind = kind, .seed = seed});
  std::vector<Ground> out;
  for (const Point& p : places(1)) out.push_back(landscape->at(p));
  return out;
}

// Property: the ground at a place depends only on kind, grid and seed.
TEST(Landscape, SameSeedReproducesTheGround) {
  for (SiteKind kind : kKinds) {
    const auto first = groundAt(kind, 9), again = groundAt(kind, 9), other = groundAt(kind, 10);
    int differing = 0;
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].height_m, again[i].height_m);
      ASSERT_EQ(first[i].soil, again[i].soil);
      differing += first[i].height_m != other[i].height_m ? 1 : 0;
    }
    EXPECT_GT(differing, 3900);
  }
}

TEST(Landscape, RockSharesAreWithinTheStatedRange) {
  // Printed in: golombek_rapp_1997; Viking and Pathfinder sites have rock abundances of 1 to 35 %.
  for (const Ground& g : groundAt(SiteKind::Rocks, 4)) {
    ASSERT_TRUE(g.rock_share >= 0.01 && g.rock_share <= 0.35);
    ASSERT_EQ(g.soil == SiteClass::Rock, g.rock_share > 0.2);
  }
  for (const Ground& g : groundAt(SiteKind::Craters, 4))
    ASSERT_TRUE(g.rock_share >= 0.004 && g.rock_share <= 0.3 && g.soil != SiteClass::Rock);
  // Bedrock occurs between dunes only; sand has no rocks.
  for (const Ground& g : groundAt(SiteKind::Dunes, 4))
    ASSERT_TRUE(g.soil == SiteClass::Rock ? g.rock_share <= 0.25 : g.rock_share == 0.0);
}

TEST(Landscape, RollingGroundIsWithinItsAmplitude) {
  // Closed form: octaves of 0.03 x 0.6 x 160 m, each 2^-0.9 of the previous, of a noise bounded by sqrt(2).
  const double greatest_m = std::sqrt(2.0) * 0.03 * 0.6 * 160 / (1 - std::exp2(-0.9));
  double least = 0.0, most = 0.0;
  for (const Ground& g : groundAt(SiteKind::Rocks, 2)) {
    least = std::min(least, g.height_m);
    most = std::max(most, g.height_m);
  }
  EXPECT_GT(least, -greatest_m);
  EXPECT_LT(most, greatest_m);
  EXPECT_GT(most - least, 0.1 * greatest_m);
}

TEST(Landscape, UnknownKindIsRejected) {
  EXPECT_REFUSED(makeLandscape(kGrid, {.kind = static_cast<SiteKind>(9)}), std::invalid_argument,
                 "unknown kind");
}

}  // namespace landscape_test

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

namespace value_noise_test {

TEST(ValueNoise, MixedMatchesSplitMix64) {
  // Printed in: output of Vigna's splitmix64.c for the states 0 and 1234567; mixed() includes the increment.
  EXPECT_EQ(mixed(0), 0xE220A8397B1DCDAFULL);
  EXPECT_EQ(mixed(1234567), 6457827717110365317ULL);
  EXPECT_EQ(mixed(1234567 + 0x9E3779B97F4A7C15ULL), 3203168211198807973ULL);
}

// Property: mean 1/2 and variance 1/12 of the uniform distribution; tolerance: five standard errors.
TEST(ValueNoise, RandomRowIsUniform) {
  constexpr int kCount = 100000;
  RandomSequence random(7);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double value = random();
    ASSERT_TRUE(value >= 0.0 && value < 1.0);
    sum += value;
    squares += (value - 0.5) * (value - 0.5);
  }
  EXPECT_NEAR(sum / kCount, 0.5, 5 * std::sqrt(1.0 / 12 / kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 12, 5 * std::sqrt(1.0 / 180 / kCount));
}

TEST(ValueNoise, GradientNoiseIsZeroOnTheLatticeAndBounded) {
  const GradientNoise noise(3);
  double greatest = 0.0;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1e4, 1e4);
  for (int i = 0; i < 500000; ++i)
    greatest = std::max(greatest, std::abs(noise(place(random), place(random))));
  // Closed form: gradients within [-1, 1]^2, weighted at the centre of a square, give at most sqrt(2).
  EXPECT_LE(greatest, std::sqrt(2.0));
  EXPECT_GT(greatest, 0.7);
  for (int x = -3; x < 4; ++x)
    for (int y = -3; y < 4; ++y) EXPECT_EQ(noise(x, y), 0.0);
}

// Property: value and slope are continuous at the border of two squares (fifth-order curves).
TEST(ValueNoise, GradientNoiseIsSmoothAcrossCells) {
  const GradientNoise noise(11);
  constexpr double h = 1e-5;
  for (int i = -20; i < 20; ++i) {
    const double y = 0.37 * i;
    const double west = (noise(i, y) - noise(i - h, y)) / h;
    const double east = (noise(i + h, y) - noise(i, y)) / h;
    EXPECT_NEAR(east, west, 100 * h) << i;  // tolerance: second derivative times h
    const double south = (noise(y, i) - noise(y, i - h)) / h;
    const double north = (noise(y, i + h) - noise(y, i)) / h;
    EXPECT_NEAR(north, south, 100 * h) << i;
  }
}

TEST(ValueNoise, OctaveHalvesWavelengthAndScalesByHurstExponent) {
  const GradientNoise noise(5);
  const FractalGround one({.seed = 5, .longest_m = 30.0, .shortest_m = 30.0, .amplitude_m = 2.0});
  const FractalGround two(
      {.seed = 5, .longest_m = 30.0, .shortest_m = 15.0, .amplitude_m = 2.0, .hurst = 0.5});
  double greatest = 0.0;
  for (double x = 0.0; x < 3000.0; x += 7.3) {
    // Closed form: one octave is the noise itself.
    EXPECT_DOUBLE_EQ(one(x, 2 * x), 2.0 * noise(x / 30.0, 2 * x / 30.0));
    greatest = std::max(greatest, std::abs(two(x, 2 * x) - one(x, 2 * x)));
  }
  EXPECT_LE(greatest, 2.0);  // amplitude 2 / 2^hurst = sqrt(2), noise at most sqrt(2)
  EXPECT_GT(greatest, 0.5);
}

}  // namespace value_noise_test

}  // namespace talus::maps
