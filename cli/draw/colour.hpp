#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <talus/terramech/mobility/category.hpp>

namespace talus::cli {

/// A colour, each part 0 to 1; not premultiplied.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;
};

/// 0xRRGGBB as a colour.
constexpr Colour rgb(unsigned hex) {
  return {.red = (hex >> 16 & 255) / 255.0, .green = (hex >> 8 & 255) / 255.0, .blue = (hex & 255) / 255.0};
}

/// The same colour, more or less transparent.
constexpr Colour faded(Colour c, double alpha) {
  c.alpha = alpha;
  return c;
}

/// White with a trace of green, amber, dark red and black of a category: a ramp towards danger whose steps of lightness
/// (99, 66, 33, 0 of CIE L*) stay apart for every kind of colour vision, in grey print and under the light of lit().
Colour colourOf(terramech::Category category);

/// Share of a colour that the light of the hillshade changes: of categories, whose colours are to differ by 30 of CIE
/// L*a*b* under any light, and of other layers.
inline constexpr double kCategoryRelief = 0.08;
inline constexpr double kValueRelief = 0.3;

/// A colour under light, 0 to 1: each part times 1 - relief + relief * light. The page multiplies images by the same share.
constexpr Colour lit(Colour c, double light, double relief) {
  const double f = 1.0 - relief + relief * light;
  return {.red = f * c.red, .green = f * c.green, .blue = f * c.blue, .alpha = c.alpha};
}

/// Colour number i of eight that stay apart for every kind of colour vision (Okabe and Ito); repeats after
/// eight.
Colour seriesColour(std::size_t i);

/// Anchors of a colour scale, equally spaced from low to high.
using Scale = std::span<const Colour>;

/// Dark blue over green to yellow, even in lightness (viridis): for magnitudes.
Scale viridis();

/// Blue over white to red: for signed values with zero in the middle.
Scale blueRed();

/// Colour of a scale at t in [0, 1], in 32 steps; the ends beyond.
Colour at(Scale scale, double t);

}  // namespace talus::cli
