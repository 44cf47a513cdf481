#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <refused.hpp>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
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
}  // namespace talus::maps
