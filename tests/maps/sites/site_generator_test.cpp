#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>

#include <refused.hpp>

#include <talus/maps/sites/site_generator.hpp>
#include <talus/maps/terrain/terrain_metrics.hpp>

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
}  // namespace talus::maps
