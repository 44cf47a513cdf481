#include <cmath>
#include <numbers>

#include <talus/cli/draw/slope_rose.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace slope_rose_test {

using testing::HasSubstr;
using testing::StartsWith;

SlopeRose crossed(bool refused_across) {
  SlopeRose rose{.title = "cell 3,4", .headings = {}, .uphill_rad = 0.5};
  for (int k = 0; k < 72; ++k) {
    const double heading = k * std::numbers::pi / 36;
    const double across = std::abs(std::sin(heading - 0.5));
    rose.headings.push_back({.heading_rad = heading,
                             .cost_J_per_m = 100.0 + 50.0 * across,
                             .slip = -0.1,
                             .slip_angle_rad = 0.3 * across,
                             .refused = refused_across && across > 0.9});
  }
  return rose;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(SlopeRose, RefusedHeadingsAreShaded) {
  const std::string free = draw(crossed(false), Canvas::Kind::Svg),
                    held = draw(crossed(true), Canvas::Kind::Svg);
  EXPECT_THAT(free, HasSubstr("<svg"));
  // Property: each of the three panels shades the sector of a refused heading and interrupts the curve there.
  EXPECT_GE(count(held, "<path"), 3U);
  EXPECT_NE(free, held);
  EXPECT_THAT(draw(crossed(true), Canvas::Kind::Png), StartsWith("\x89PNG"));
}

TEST(SlopeRose, FullyRefusedHeadingsAreDrawn) {
  SlopeRose rose = crossed(false);
  for (RoseHeading& heading : rose.headings) heading = {.heading_rad = heading.heading_rad, .refused = true};
  rose.uphill_rad.reset();
  EXPECT_THAT(draw(rose, Canvas::Kind::Png), StartsWith("\x89PNG"));
}

}  // namespace slope_rose_test
}  // namespace talus::cli
