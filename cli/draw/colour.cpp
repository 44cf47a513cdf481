#include <algorithm>
#include <cmath>

#include <talus/cli/draw/colour.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::cli {

std::uint32_t pixel(Colour c) {
  const auto byte = [](double v) {
    return static_cast<std::uint32_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
  };
  return byte(c.alpha) << 24 | byte(c.red * c.alpha) << 16 | byte(c.green * c.alpha) << 8 |
         byte(c.blue * c.alpha);
}

Colour colourOf(terramech::Category category) {
  return rgb(planner::categoryColour(category));
}

Colour seriesColour(std::size_t i) {
  static constexpr std::array kColours{rgb(0x0072B2), rgb(0xD55E00), rgb(0x009E73), rgb(0xCC79A7),
                                       rgb(0xE69F00), rgb(0x56B4E9), rgb(0x000000), rgb(0xB8A800)};
  return kColours[i % kColours.size()];
}

Scale viridis() {
  static constexpr std::array kAnchors{rgb(0x440154), rgb(0x472D7B), rgb(0x3B528B),
                                       rgb(0x2C728E), rgb(0x21918C), rgb(0x28AE80),
                                       rgb(0x5EC962), rgb(0xADDC30), rgb(0xFDE725)};
  return kAnchors;
}

Scale blueRed() {
  static constexpr std::array kAnchors{rgb(0x2166AC), rgb(0x67A9CF), rgb(0xD1E5F0), rgb(0xF7F7F7),
                                       rgb(0xFDDBC7), rgb(0xEF8A62), rgb(0xB2182B)};
  return kAnchors;
}

Colour at(Scale scale, double t) {
  constexpr double kSteps = 31.0;
  const double stepped = std::round(std::clamp(t, 0.0, 1.0) * kSteps) / kSteps;
  const double place = stepped * static_cast<double>(scale.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(place), scale.size() - 2);
  const double f = place - static_cast<double>(i);
  const auto mix = [f](double a, double b) { return a + f * (b - a); };
  const Colour a = scale[i];
  const Colour b = scale[i + 1];
  return {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue), 1.0};
}

}  // namespace talus::cli
