#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <talus/cli/draw/colour.hpp>

namespace talus::cli {

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
  bool dashed = false;
};

/// Style of a text, and its alignment relative to the given position.
struct TextStyle {
  double size = 12.0;
  Colour colour = rgb(0x222222);
  bool bold = false;
  double anchor = 0.0;   ///< part of the text at the given position: 0 left end, 0.5 middle, 1 right end
  bool upright = false;  ///< true if the text is turned 90 deg counter-clockwise
  bool halo = false;     ///< true if the text has a white outline for legibility on a map
};

/// Drawing surface that produces a PNG or SVG file. Not thread-safe.
class Canvas {
 public:
  enum class Kind { Png, Svg };
  struct Options {
    int width = 0;
    int height = 0;
    Kind kind = Kind::Png;
    bool transparent = false;
  };

  explicit Canvas(const Options& options);
  ~Canvas();
  Canvas(Canvas&&) noexcept;

  void fill(const Box& box, Colour colour);
  void line(std::span<const Spot> spots, const Stroke& stroke);
  void polygon(std::span<const Spot> spots, Colour colour);
  void disc(Spot centre, double radius, Colour colour);
  /// Draws many discs of one colour as one shape, so that overlaps are no darker.
  void discs(std::span<const Spot> centres, double radius, Colour colour);
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
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

/// Returns the bytes of an image as a PNG file.
std::string png(const Image& image);

/// Returns bytes in Base64 encoding, for data URIs.
std::string base64(const std::string& bytes);

/// Draws the outline of the box.
void outline(Canvas& canvas, const Box& box, const Stroke& stroke);

}  // namespace talus::cli
