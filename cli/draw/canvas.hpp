#pragma once

#include <memory>
#include <span>
#include <string>

#include <talus/cli/draw/colour.hpp>

namespace talus::cli {

struct Image;

/// A place on paper: x to the right, y down, in pixels.
struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// A rectangle on paper, from its upper left corner.
struct Box {
  double x = 0.0;
  double y = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// How a line is drawn.
struct Stroke {
  Colour colour;
  double width = 1.0;
  bool dashed = false;
};

/// How a text is drawn and which of its points lies at the spot.
struct TextStyle {
  double size = 12.0;
  Colour colour = rgb(0x222222);
  bool bold = false;
  double anchor = 0.0;   ///< 0 left, 0.5 middle, 1 right
  bool upright = false;  ///< turned a quarter to the left
  bool halo = false;     ///< white rim, to stay legible on a map
};

/// A page to draw on, ending as PNG or SVG. Not to be shared between threads.
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
  /// Many of one colour as one shape: where they overlap they are no darker.
  void discs(std::span<const Spot> centres, double radius, Colour colour);
  void text(const std::string& text, Spot spot, const TextStyle& style = {});
  double textWidth(const std::string& text, const TextStyle& style = {});

  /// Scales the image into the box; enlarged pixels stay square.
  void image(const Image& image, const Box& box);

  /// Until unclip(), nothing is drawn outside the box.
  void clip(const Box& box);
  void unclip();

  /// The finished file; nothing can be drawn afterwards.
  std::string bytes();

 private:
  struct Surface;
  std::unique_ptr<Surface> surface_;
};

/// The image as a PNG file.
std::string png(const Image& image);

/// The box outline of a stroke.
void outline(Canvas& canvas, const Box& box, const Stroke& stroke);

}  // namespace talus::cli
