#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <talus/terramech/mobility/category.hpp>

struct _cairo;  // NOLINT(bugprone-reserved-identifier): cairo_t

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

/// Returns a colour as text "#rrggbb".
std::string hex(Colour colour);

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

/// An image of pixels, top row first.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> argb;  ///< pixels as pixel() gives them

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), argb(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::uint32_t& at(int x, int y) noexcept {
    return argb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// A position on the canvas: x to the right, y down [pixels].
struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// A rectangle on the canvas; x, y is its upper left corner [pixels].
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Line style.
struct Stroke {
  Colour colour;
  double width = 1.0;
};

/// Style of a text, and its alignment relative to the given position.
struct TextStyle {
  double size = 12.0;
  Colour colour = rgb(0x222222);
  bool bold = false;
  double anchor = 0.0;  ///< part of the text at the given position: 0 left end, 0.5 middle, 1 right end
  bool halo = false;    ///< true if the text has a white outline for legibility on a map
};

/// Drawing surface that produces a PNG file. Not thread-safe.
class Canvas {
 public:
  struct Options {
    int width = 0;
    int height = 0;
  };

  explicit Canvas(const Options& options);

  void fill(const Box& box, Colour colour);
  void line(std::span<const Spot> spots, const Stroke& stroke);
  void polygon(std::span<const Spot> spots, Colour colour);
  void disc(Spot centre, double radius, Colour colour);
  void text(const std::string& text, Spot spot, const TextStyle& style = {});
  double textWidth(const std::string& text, const TextStyle& style = {});

  /// Draws an image scaled into a box without smoothing: enlarged pixels stay squares.
  void image(const Image& image, const Box& box);

  /// Limits drawing to the box until unclip().
  void clip(const Box& box);
  void unclip();

  /// Finishes the file and returns its bytes. Nothing can be drawn afterwards.
  std::string bytes();

 private:
  std::unique_ptr<_cairo, void (*)(_cairo*)> cairo_;
};

/// Returns the bytes of an image as a PNG file, compressed for speed.
std::string png(const Image& image);

/// Returns bytes in Base64 encoding, for data URIs.
std::string base64(const std::string& bytes);

/// Draws the outline of the box.
void outline(Canvas& canvas, const Box& box, const Stroke& stroke);

}  // namespace talus::cli
