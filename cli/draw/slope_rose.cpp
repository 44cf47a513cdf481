#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <talus/cli/draw/slope_rose.hpp>
#include <talus/common/constants.hpp>

namespace talus::cli {
namespace {

constexpr double kPanel = 300.0, kRadius = 108.0, kTop = 44.0;
constexpr Colour kRefused = rgb(0xd9a5a5), kRim = rgb(0x999999), kCurve = rgb(0x1b3fbf);

Spot at(Spot centre, double heading_rad, double radius) {
  return {centre.x + radius * std::cos(heading_rad), centre.y - radius * std::sin(heading_rad)};
}

void circle(Canvas& canvas, Spot centre, double radius) {
  std::vector<Spot> spots;
  for (int k = 0; k <= 72; ++k) spots.push_back(at(centre, k * std::numbers::pi / 36, radius));
  canvas.line(spots, {.colour = kRim, .width = 0.7});
}

// One panel: magnitude of a quantity over the headings.
struct Quantity {
  std::string title;
  double (*value)(const RoseHeading&);
};

void drawPanel(Canvas& canvas, const SlopeRose& rose, const Quantity& quantity, Spot centre) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(rose.headings.size());
  double most = 0.0;
  for (const RoseHeading& h : rose.headings) {
    const double value = quantity.value(h);
    if (!h.refused && std::isfinite(value)) most = std::max(most, value);
    if (!h.refused) continue;
    const std::array<Spot, 4> sector{centre, at(centre, h.heading_rad - step / 2, kRadius),
                                     at(centre, h.heading_rad, kRadius),
                                     at(centre, h.heading_rad + step / 2, kRadius)};
    canvas.polygon(sector, kRefused);
  }
  for (const double share : {0.5, 1.0}) circle(canvas, centre, share * kRadius);
  const std::size_t n = rose.headings.size();
  for (std::size_t i = 0; i < n && most > 0.0; ++i) {
    const RoseHeading &a = rose.headings[i], &b = rose.headings[(i + 1) % n];
    const double from = quantity.value(a), to = quantity.value(b);
    if (a.refused || b.refused || !std::isfinite(from + to)) continue;
    const std::array<Spot, 2> piece{at(centre, a.heading_rad, kRadius * from / most),
                                    at(centre, b.heading_rad, kRadius * to / most)};
    canvas.line(piece, {.colour = kCurve, .width = 2.0});
  }
  if (rose.uphill_rad) {
    const std::array<Spot, 2> arrow{at(centre, *rose.uphill_rad, kRadius),
                                    at(centre, *rose.uphill_rad, kRadius + 9.0)};
    canvas.line(arrow, {.colour = rgb(0x222222), .width = 3.0});
    const Spot label = at(centre, *rose.uphill_rad, kRadius + 22.0);
    canvas.text("up", {label.x, label.y + 4.0}, {.size = 11.0, .anchor = 0.5});
  }
  canvas.text(quantity.title, {centre.x, kTop}, {.size = 13.0, .bold = true, .anchor = 0.5});
  canvas.text(most > 0.0 ? fmt::format("rim {:.3g}", most) : std::string("no heading is allowed"),
              {centre.x, centre.y + kRadius + 34.0}, {.size = 11.0, .anchor = 0.5});
}

}  // namespace

std::string draw(const SlopeRose& rose, Canvas::Kind kind) {
  const std::array<Quantity, 3> quantities{
      {{"cost [J/m]", [](const RoseHeading& h) { return h.cost_J_per_m; }},
       {"slip [-]", [](const RoseHeading& h) { return std::abs(h.slip); }},
       {"slip angle [deg]", [](const RoseHeading& h) { return std::abs(h.slip_angle_rad) / kDegree; }}}};
  const double width = 3.0 * kPanel, height = kTop + 2.0 * kRadius + 100.0;
  Canvas canvas({.width = static_cast<int>(width), .height = static_cast<int>(height), .kind = kind});
  canvas.fill({0.0, 0.0, width, height}, rgb(0xffffff));
  canvas.text(rose.title, {12.0, 20.0}, {.size = 13.0});
  for (std::size_t i = 0; i < quantities.size(); ++i)
    drawPanel(canvas, rose, quantities[i], {kPanel * (static_cast<double>(i) + 0.5), kTop + kRadius + 40.0});
  canvas.text("east is right, north is up; shaded headings are refused", {12.0, height - 10.0},
              {.size = 11.0});
  return canvas.bytes();
}

}  // namespace talus::cli
