#include <array>
#include <cstdint>
#include <stdexcept>

#include <refused.hpp>

#include <talus/cli/draw/canvas.hpp>

namespace talus::cli {
namespace canvas_test {

using testing::HasSubstr;
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

// Property: an SVG contains the colour of each drawn element, and no other elements.
TEST(Canvas, SvgContainsExactlyTheDrawnElements) {
  const auto drawn = [](const auto& draw) {
    Canvas canvas({.width = 40, .height = 30, .kind = Canvas::Kind::Svg});
    draw(canvas);
    return canvas.bytes();
  };
  const std::array<Spot, 3> spots{{{1, 1}, {20, 5}, {30, 25}}};
  const Colour red = rgb(0xFF0000);
  const std::string empty = drawn([](Canvas&) {});
  EXPECT_THAT(empty, testing::Not(testing::ContainsRegex("100%, *0%, *0%")));
  for (const std::string& svg : {drawn([&](Canvas& c) {
                                   c.fill({2, 3, 10, 5}, red);
                                 }),
                                 drawn([&](Canvas& c) { c.polygon(spots, red); }), drawn([&](Canvas& c) {
                                   c.disc({10, 10}, 4.0, red);
                                 }),
                                 drawn([&](Canvas& c) { c.line(spots, {.colour = red, .width = 2.0}); })})
    EXPECT_THAT(svg, testing::ContainsRegex("100%, *0%, *0%"));
  EXPECT_THAT(drawn([&](Canvas& c) { c.line(spots, {.colour = red, .dashed = true}); }),
              HasSubstr("stroke-dasharray"));
  EXPECT_THAT(drawn([](Canvas& c) {
                c.clip({5, 5, 10, 10});
                c.fill({0, 0, 40, 30}, rgb(0x00FF00));
                c.unclip();
              }),
              HasSubstr("clip"));
}

// Property: text widths add up, increase with the font size, and do not grow for upright text.
TEST(Canvas, TextWidthIsAdditiveAndScalesWithSize) {
  Canvas canvas({.width = 10, .height = 10});
  const double one = canvas.textWidth("mmm"), two = canvas.textWidth("mmmmmm");
  EXPECT_GT(one, 0.0);
  EXPECT_NEAR(two, 2 * one, 1.0);
  EXPECT_GT(canvas.textWidth("mmm", {.size = 24.0}), 1.8 * one);
}

TEST(Canvas, InvalidSizeIsRejected) {
  EXPECT_REFUSED(Canvas({.width = -1, .height = 5}), std::runtime_error, "invalid value (typically too big)");
  EXPECT_REFUSED(Canvas({.width = 1'000'000, .height = 1'000'000}), std::runtime_error,
                 "invalid value (typically too big)");
}

}  // namespace canvas_test
}  // namespace talus::cli
