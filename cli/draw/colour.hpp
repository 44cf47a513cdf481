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

/// Green, amber, red, grey of a category. Their lightness differs (58, 76, 39, 68 of CIE L*), so that they
/// stay apart for every kind of colour vision and in grey print.
Colour colourOf(terramech::Category category);

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
