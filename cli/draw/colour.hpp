#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <talus/terramech/mobility/category.hpp>

namespace talus::cli {

/// A colour with components 0 to 1; alpha (opacity) is not premultiplied.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
  double alpha = 1.0;
};

/// Returns the colour 0xRRGGBB.
constexpr Colour rgb(unsigned hex) {
  return {.red = (hex >> 16 & 255) / 255.0, .green = (hex >> 8 & 255) / 255.0, .blue = (hex & 255) / 255.0};
}

/// Returns a colour as a pixel with premultiplied alpha, in cairo's format ARGB32.
std::uint32_t pixel(Colour colour);

/// Returns the colour with another alpha.
constexpr Colour faded(Colour c, double alpha) {
  c.alpha = alpha;
  return c;
}

/// Returns planner::categoryColour().
Colour colourOf(terramech::Category category);

/// The headings in which planners enter a cell.
enum class AllowedHeadings : std::uint8_t { All, Some, None, Unknown };

/// Names of AllowedHeadings in legends.
inline constexpr std::array kAllowedNames{"all", "some", "none", "unknown"};

/// Returns the colour of allowed headings: that of the category safe, marginal, dangerous or unknown.
inline Colour colourOf(AllowedHeadings allowed) {
  return colourOf(static_cast<terramech::Category>(allowed));
}

/// Values of the argument `relief` of lit(), for categories and for other layers. Category colours must
/// differ by 30 of CIE L*a*b* under any shading.
inline constexpr double kCategoryRelief = 0.08;
inline constexpr double kValueRelief = 0.3;

/// Returns a colour under a light of 0 to 1: each component times 1 - relief + relief * light. The HTML page
/// uses the same formula.
constexpr Colour lit(Colour c, double light, double relief) {
  const double f = 1.0 - relief + relief * light;
  return {.red = f * c.red, .green = f * c.green, .blue = f * c.blue, .alpha = c.alpha};
}

/// Returns colour i modulo 8 of eight colours that are distinguishable for colour-blind readers (Okabe and
/// Ito).
Colour seriesColour(std::size_t i);

/// A colour scale: support colours, equally spaced from low to high values.
using Scale = std::span<const Colour>;

/// Returns the scale for magnitudes: dark blue over green to yellow with uniform lightness steps (viridis).
Scale viridis();

/// Returns the scale for signed values: blue over white to red; white is zero.
Scale blueRed();

/// Returns the colour of a scale at t, clamped to [0, 1], in 32 steps.
Colour at(Scale scale, double t);

}  // namespace talus::cli
