#include <cmath>

#include <talus/cli/draw/colour.hpp>

namespace talus::cli {
namespace colour_test {

// CIE 1976 lightness L* of a colour of sRGB (IEC 61966-2-1), white being 100.
double lightness(Colour c) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  const double y = 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
  return y > 0.008856 ? 116.0 * std::cbrt(y) - 16.0 : 903.3 * y;
}

TEST(Colour, HexIsRedGreenBlue) {
  const Colour c = rgb(0xFF8000);
  EXPECT_EQ(c.red, 1.0);
  EXPECT_EQ(c.green, 128.0 / 255.0);
  EXPECT_EQ(c.blue, 0.0);
  EXPECT_EQ(faded(c, 0.25).alpha, 0.25);
}

// Closed form: the lightness that the header states, so that categories differ in grey print.
TEST(Colour, CategoriesDifferInLightness) {
  using terramech::Category;
  const std::pair<Category, double> stated[] = {
      {Category::Safe, 58}, {Category::Marginal, 76}, {Category::Dangerous, 39}, {Category::Unknown, 68}};
  for (const auto& [category, value] : stated) EXPECT_NEAR(lightness(colourOf(category)), value, 0.5);
}

// Property: viridis grows lighter all the way; blue to red is lightest in the middle; 32 steps, ends beyond.
TEST(Colour, ScalesAreOrderedByLightness) {
  for (int k = 0; k < 31; ++k) {
    EXPECT_LT(lightness(at(viridis(), k / 31.0)), lightness(at(viridis(), (k + 1) / 31.0))) << k;
    const Colour before = at(blueRed(), k / 31.0), after = at(blueRed(), (k + 1) / 31.0);
    EXPECT_EQ(lightness(before) < lightness(after),
              k < 15 || (k == 15 && lightness(before) < lightness(after)));
  }
  EXPECT_EQ(at(viridis(), -5.0).red, at(viridis(), 0.0).red);
  EXPECT_EQ(at(viridis(), 5.0).red, viridis().back().red);
  EXPECT_EQ(at(viridis(), 0.501).green, at(viridis(), 0.51).green);  // one step
}

TEST(Colour, SeriesRepeatAfterEight) {
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(seriesColour(i).red, seriesColour(i + 8).red);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(
          std::hypot(seriesColour(i).red - seriesColour(j).red, seriesColour(i).green - seriesColour(j).green,
                     seriesColour(i).blue - seriesColour(j).blue),
          0.15);
  }
}

}  // namespace colour_test
}  // namespace talus::cli
