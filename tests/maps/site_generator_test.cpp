#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>

#include <maps/crater_field.hpp>
#include <maps/dune_field.hpp>
#include <maps/rock_field.hpp>
#include <maps/site_generator.hpp>
#include <maps/terrain_metrics.hpp>

namespace talus::maps {
namespace {

constexpr SiteKind kKinds[] = {SiteKind::Craters, SiteKind::Dunes, SiteKind::Rocks};

std::vector<std::uint32_t> bits(const Site& site) {
  std::vector<std::uint32_t> out;
  for (float v : site.map.elevation_m.values()) out.push_back(std::bit_cast<std::uint32_t>(v));
  for (float v : site.rock_abundance.values()) out.push_back(std::bit_cast<std::uint32_t>(v));
  out.insert(out.end(), site.classes.values().begin(), site.classes.values().end());
  return out;
}

TEST(SiteGenerator, SameSeedSameBitsWhateverTheThreads) {
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

TEST(SiteGenerator, EverySiteIsWholeAndVaried) {
  for (SiteKind kind : kKinds) {
    const Site site = generateSite({.kind = kind, .width = 400, .height = 400, .seed = 2});
    EXPECT_DOUBLE_EQ(validFraction(site.map.elevation_m), 1.0);
    std::map<int, int> classes;
    for (std::uint8_t c : site.classes.values()) ++classes[c];
    EXPECT_GE(classes.size(), 3U);
    for (const auto& [number, count] : classes) EXPECT_TRUE(number >= 1 && number <= 4) << number;
    for (float k : site.rock_abundance.values()) ASSERT_TRUE(k >= 0 && k < 0.5F);
    // A rover's ground: mostly gentle, somewhere steep.
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

TEST(SiteGenerator, RefusesNonsense) {
  EXPECT_THROW(generateSite({.width = 4}), std::invalid_argument);
  EXPECT_THROW(generateSite({.height = 30000}), std::invalid_argument);
  EXPECT_THROW(generateSite({.resolution_m = std::nan("")}), std::invalid_argument);
  EXPECT_THROW(generateSite({.threads = 0}), std::invalid_argument);
}

TEST(CraterField, SizesFollowTheLaw) {
  const Grid grid{.width = 3000, .height = 3000, .resolution_m = 1.0};
  const auto craters =
      craterField(grid, {.seed = 1, .least_diameter_m = 4, .greatest_diameter_m = 400, .density = 0.04});
  const auto larger = [&](double d) {
    return std::count_if(craters.begin(), craters.end(), [=](const Crater& c) { return 2 * c.radius_m > d; });
  };
  // Closed form: numbers go with D^-2 - Dmax^-2.
  EXPECT_NEAR(static_cast<double>(larger(8)) / static_cast<double>(larger(16)), 4.0, 0.25);
  EXPECT_NEAR(static_cast<double>(larger(4)), 0.04 * 3800 * 3800 / 16, 100);
}

TEST(CraterField, FreshCraterHasTheProportionsOfFreshOnes) {
  const Crater crater{.centre = {}, .radius_m = 10, .age = 0};
  // Printed in: Pike (1977): depth a fifth of the diameter, rim 0.036 of it. The rounding of the rim takes
  // some.
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

TEST(DuneField, SlipFacesLieAtTheAngleOfRepose) {
  const DuneField dunes({.seed = 3, .wavelength_m = 60, .height_m = 4, .repose_rad = 0.576, .wind_rad = 0.0});
  int faces = 0;
  for (double y = 0; y < 600; y += 7)
    for (double x = 0; x < 600; x += 0.5) {
      const Sand here = dunes.at(x, y);
      const Sand there = dunes.at(x + 0.05, y);
      if (!here.slip_face || !there.slip_face) continue;
      ++faces;
      // Closed form: along the wind a slip face falls at the angle of repose.
      ASSERT_NEAR(std::atan((here.height_m - there.height_m) / 0.05), 0.576, 1e-6);
    }
  EXPECT_GT(faces, 500);
}

TEST(DuneField, SandIsContinuousExceptNowhere) {
  const DuneField dunes({.seed = 4});
  for (double y = 0; y < 300; y += 3.1)
    for (double x = 0; x < 300; x += 0.1)
      ASSERT_LT(std::abs(dunes.at(x + 0.1, y).height_m - dunes.at(x, y).height_m), 0.12) << x << "," << y;
}

TEST(RockField, CoversTheShareThatTheLawGives) {
  const Grid grid{.width = 400, .height = 400, .resolution_m = 1.0};
  const double k = 0.2;
  const auto rocks = rockField(grid, [=](Point) { return k; },
                               {.seed = 1, .least_diameter_m = 0.5, .greatest_diameter_m = 4});
  double area = 0;
  for (const Rock& rock : rocks) area += 3.14159265 * rock.radius_m * rock.radius_m;
  // Closed form: F(0.5) - F(4) with F(D) = k exp(-(1.79 + 0.152 / k) D).
  const double q = 1.79 + 0.152 / k;
  EXPECT_NEAR(area / (400 * 400), k * (std::exp(-0.5 * q) - std::exp(-4 * q)), 0.002);
}

}  // namespace
}  // namespace talus::maps
