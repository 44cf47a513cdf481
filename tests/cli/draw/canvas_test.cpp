#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <gmock/gmock.h>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {

namespace canvas_test {

using Lab = std::array<double, 3>;

// Components of an sRGB colour in linear light (IEC 61966-2-1).
std::array<double, 3> linear(Colour c) {
  const auto part = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return {part(c.red), part(c.green), part(c.blue)};
}

// CIE 1976 L*a*b* of linear sRGB, white D65.
Lab labOf(const std::array<double, 3>& l) {
  const auto f = [](double t) {
    return t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
  };
  const double x = f((0.4124564 * l[0] + 0.3575761 * l[1] + 0.1804375 * l[2]) / 0.95047);
  const double y = f(0.2126729 * l[0] + 0.7151522 * l[1] + 0.0721750 * l[2]);
  const double z = f((0.0193339 * l[0] + 0.1191920 * l[1] + 0.9503041 * l[2]) / 1.08883);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

Lab seenByAll(Colour c) {
  return labOf(linear(c));
}

// Colour as perceived with deuteranopia: matrix of severity 1.0 of Machado, Oliveira and Fernandes (2009).
Lab seenByADeuteranope(Colour c) {
  const auto [r, g, b] = linear(c);
  const auto inside = [](double v) { return std::clamp(v, 0.0, 1.0); };
  return labOf({inside(0.367322 * r + 0.860646 * g - 0.227968 * b),
                inside(0.280085 * r + 0.672501 * g + 0.047413 * b),
                inside(-0.011820 * r + 0.042940 * g + 0.968881 * b)});
}

Lab printedInGrey(Colour c) {
  return {seenByAll(c)[0], 0.0, 0.0};
}

double lightness(Colour c) {
  return seenByAll(c)[0];
}

double difference(const Lab& a, const Lab& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

using terramech::Category;
constexpr std::array kCategories{Category::Safe, Category::Marginal, Category::Dangerous, Category::Unknown};

// Closed form: distance in CIE L*a*b* of each pair of categories under equal shading, for three types of
// vision.
TEST(Colour, CategoryColoursDifferByThirtyUnderAnyIllumination) {
  for (const auto& [sight, seen] :
       {std::pair{"colour", &seenByAll}, {"deuteranope", &seenByADeuteranope}, {"grey", &printedInGrey}}) {
    double least = INFINITY;
    for (int light = 0; light <= 20; ++light)
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) {
          const auto under = [&](Category c) {
            return seen(lit(colourOf(c), light / 20.0, kCategoryRelief));
          };
          least = std::min(least, difference(under(kCategories[i]), under(kCategories[j])));
        }
    EXPECT_GE(least, 30.0) << sight;
    testing::Test::RecordProperty(sight, std::to_string(least));
  }
}

// Property: lightness of viridis increases throughout; blue to red is lightest in the middle; both have 32
// steps.
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

using testing::StartsWith;

// Big-endian number of four bytes.
std::uint32_t number(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

// Printed in: PNG specification (ISO/IEC 15948), section 11.2.2: width and height are bytes 16 to 23.
TEST(Canvas, PngHasTheRequestedSize) {
  Canvas canvas({.width = 37, .height = 21});
  const std::string bytes = canvas.bytes();
  ASSERT_THAT(bytes, StartsWith("\x89PNG\r\n\x1a\n"));
  EXPECT_EQ(number(bytes, 16), 37U);
  EXPECT_EQ(number(bytes, 20), 21U);
  const std::string image = png(Image(3, 2));
  EXPECT_EQ(number(image, 16), 3U);
  EXPECT_EQ(number(image, 20), 2U);
}

}  // namespace canvas_test

}  // namespace talus::cli
