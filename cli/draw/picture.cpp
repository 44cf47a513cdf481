#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <vector>

#include <fmt/format.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/common/common.hpp>

namespace talus::cli {

using maps::Cell;
using maps::Raster;

Raster<float> hillshade(const Raster<float>& elevation_m) {
  const maps::TerrainMetrics metrics = maps::terrainMetrics(elevation_m, {});
  Raster<float> steepness(elevation_m.grid()), shade(elevation_m.grid(), std::nanf(""));
  for (std::size_t i = 0; i < shade.values().size(); ++i)
    steepness.values()[i] = std::hypot(metrics.dz_dx.values()[i], metrics.dz_dy.values()[i]);
  // Exaggeration: scales the 90 % quantile of slope to 25 deg; 1 to 20.
  const double p90 = quantiles(steepness, {0.9}).front();
  const double factor =
      std::isnan(p90) ? 1.0 : std::clamp(std::tan(25.0 * kDegree) / std::max(p90, 1e-6), 1.0, 20.0);
  // unit vector to the sun: azimuth 315 deg, elevation 45 deg
  constexpr double kSunX = -0.5, kSunY = 0.5, kSunZ = std::numbers::sqrt2 / 2.0;
  const auto gradient = [factor](float value) {
    return std::isnan(value) ? 0.0 : factor * static_cast<double>(value);
  };
  for (std::size_t i = 0; i < shade.values().size(); ++i) {
    if (std::isnan(elevation_m.values()[i])) continue;
    const double gx = gradient(metrics.dz_dx.values()[i]), gy = gradient(metrics.dz_dy.values()[i]);
    const double cosine = (-gx * kSunX - gy * kSunY + kSunZ) / std::sqrt(1.0 + gx * gx + gy * gy);
    shade.values()[i] = static_cast<float>(std::clamp(0.12 + 0.88 * cosine, 0.0, 1.0));
  }
  return shade;
}

Range lightRange(const Raster<float>& shade) {
  const std::vector<double> ends = quantiles(shade, kInner);
  if (std::isnan(ends[0])) return {};
  return ends[1] > ends[0] + 0.02 ? Range{ends[0], ends[1]} : Range{ends[0] - 0.5, ends[0] + 0.5};
}

Image shadeImage(const Raster<float>& shade) {
  return imageOf(shade.grid(), [&](Cell c) {
    const auto v = static_cast<double>(shade[c]);
    return std::isnan(v) ? 0U : pixel({v, v, v, 1.0});
  });
}

Image headingImage(const Raster<HeadingShares>& headings) {
  return imageOf(headings.grid(), [&](Cell c) {
    Colour sum{.alpha = 0.0};
    int total = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const int n = headings[c].count[i];
      const Colour colour = colourOf(static_cast<AllowedHeadings>(i));
      sum.red += n * colour.red;
      sum.green += n * colour.green;
      sum.blue += n * colour.blue;
      total += n;
    }
    return total == 0 ? 0U : pixel({sum.red / total, sum.green / total, sum.blue / total, 1.0});
  });
}

Image groundImage(const Raster<std::uint32_t>& ground) {
  return imageOf(ground.grid(), [&](Cell c) { return ground[c]; });
}

Scale scaleOf(const ValueLayer& layer) {
  return layer.zero_in_middle ? blueRed() : viridis();
}

Image valueImage(const ValueLayer& layer) {
  const Scale scale = scaleOf(layer);
  return imageOf(layer.values.grid(), [&](Cell c) {
    const auto v = static_cast<double>(layer.values[c]);
    if (std::isnan(v)) return 0U;
    if (!layer.classes.empty()) return pixel(layer.classes[static_cast<std::size_t>(v)].colour);
    return pixel(at(scale, (v - layer.range.low) / (layer.range.high - layer.range.low)));
  });
}

Image hatchImage(const HatchedArea& area) {
  constexpr int kPixels = 900, kPeriod = 8, kStroke = 3;
  const maps::Grid& grid = area.mask.grid();
  const int fine = std::max(1, kPixels / std::max(grid.width, grid.height));
  Image image(grid.width * fine, grid.height * fine);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (area.mask[{x / fine, grid.height - 1 - y / fine}] != 0 && (x + y) % kPeriod < kStroke)
        image.at(x, y) = pixel(faded(area.colour, 0.85));
  return image;
}

namespace {

constexpr double kMargin = 24.0;
constexpr double kHead = 64.0;
constexpr double kTitleLine = 24.0;
constexpr double kWarningLine = 16.0;
constexpr double kLegend = 210.0;
constexpr Colour kRoute = rgb(0x1B3FBF);
constexpr Colour kReverse = rgb(0xB3202C);
constexpr Colour kRing = rgb(0xD6006C);
constexpr Colour kWhite = rgb(0xFFFFFF);
constexpr Colour kInk = rgb(0x222222);

/// Applies the hillshade to the colours.
Image underLight(Image colours, const maps::Raster<float>& shade, double relief) {
  const Range range = lightRange(shade);
  for (int y = 0; y < colours.height; ++y) {
    for (int x = 0; x < colours.width; ++x) {
      const auto bright = static_cast<double>(shade[{x, colours.height - 1 - y}]);
      const double light = std::clamp((bright - range.low) / (range.high - range.low), 0.0, 1.0);
      std::uint32_t& p = colours.at(x, y);
      if (p == 0 || std::isnan(bright)) continue;
      p = pixel(lit(rgb(p & 0xFFFFFFU), light, relief));
    }
  }
  return colours;
}

/// Breaks the title into lines of the given width; words are not split.
std::vector<std::string> wrapped(const std::string& text, double width, const TextStyle& style) {
  Canvas measure({.width = 1, .height = 1});
  return wrappedLines(text, [&](const std::string& line) { return measure.textWidth(line, style) <= width; });
}

constexpr TextStyle kTitle{.size = 18, .bold = true};

/// State of a picture during drawing.
class Picture {
 public:
  explicit Picture(const Scene& scene)
      : scene_(scene),
        scale_(pixelsPerCell(scene.grid())),
        title_(wrapped(scene.title, scene.grid().width * scale_ + kLegend + kMargin, kTitle)),
        warning_(warningLines(scene)),
        head_(kHead + kTitleLine * static_cast<double>(title_.size() - 1) +
              kWarningLine * static_cast<double>(warning_.size())),
        map_{kMargin, head_, scene.grid().width * scale_, scene.grid().height * scale_},
        canvas_({.width = static_cast<int>(std::ceil(map_.width + kLegend + 3 * kMargin)),
                 .height = static_cast<int>(std::ceil(head_ + kMargin + std::max(map_.height, 420.0)))}) {}

  std::string draw() {
    for (std::size_t i = 0; i < title_.size(); ++i)
      canvas_.text(title_[i], {kMargin, 30 + kTitleLine * static_cast<double>(i)}, kTitle);
    double y = head_ - 14 - kWarningLine * static_cast<double>(warning_.size());
    canvas_.text(scene_.subtitle, {kMargin, y}, {.size = 12, .colour = rgb(0x555555)});
    for (const std::string& line : warning_)
      canvas_.text(line, {kMargin, y += kWarningLine}, {.size = 12, .colour = kReverse, .bold = true});
    canvas_.fill(map_, rgb(0xECECEC));
    ground();
    for (const HatchedArea& area : scene_.areas) canvas_.image(hatchImage(area), map_);
    canvas_.clip(map_);
    route();
    scaleBar();
    canvas_.unclip();
    outline(canvas_, map_, {.colour = rgb(0x888888)});
    legend();
    return canvas_.bytes();
  }

 private:
  std::vector<std::string> warningLines(const Scene& scene) const {
    const auto warning = scene.route ? warningOf(*scene.route) : std::nullopt;
    if (!warning) return {};
    return wrapped("warning: " + warning->text, scene.grid().width * scale_ + kLegend,
                   {.size = 12, .bold = true});
  }

  /// Enlarges small maps by an integer factor, to at most 900 pixels on the longer side.
  static double pixelsPerCell(const maps::Grid& grid) {
    return std::max(1.0, std::floor(900.0 / std::max(grid.width, grid.height)));
  }

  Spot spot(double x_m, double y_m) const {
    const maps::Grid& grid = scene_.grid();
    const double pixel_m = grid.resolution_m / scale_;
    return {map_.x + (x_m - grid.south_west.x_m) / pixel_m,
            map_.y + map_.height - (y_m - grid.south_west.y_m) / pixel_m};
  }

  void ground() {
    const maps::Raster<float> shade = hillshade(scene_.elevation_m);
    canvas_.image(shadeImage(shade), map_);
    if (!scene_.image.empty())
      canvas_.image(groundImage(scene_.image), map_);
    else if (!scene_.headings.empty())
      canvas_.image(underLight(headingImage(scene_.headings), shade, kCategoryRelief), map_);
    else if (!scene_.layers.empty())
      canvas_.image(underLight(valueImage(scene_.layers.front()), shade,
                               scene_.layers.front().classes.empty() ? kValueRelief : kCategoryRelief),
                    map_);
  }

  /// Draws the line of a route, and returns its vertices.
  std::vector<Spot> way(const planner::Route& route, Colour colour) {
    std::vector<Spot> spots;
    for (const planner::RouteVertex& v : route.vertices) spots.push_back(spot(v.x_m, v.y_m));
    canvas_.line(spots, {.colour = kWhite, .width = 5.5});
    canvas_.line(spots, {.colour = colour, .width = 2.8});
    return spots;
  }

  void route() {
    for (const Ring& ring : scene_.rings) encircle(ring);
    for (const auto& [letter, place] : scene_.marks) mark(spot(place.x_m, place.y_m), letter);
    if (!scene_.route || scene_.route->vertices.empty()) return;
    for (std::size_t i = scene_.routes.size(); i-- > 1;) way(scene_.routes[i].route, seriesColour(i));
    const std::vector<Spot> spots = way(*scene_.route, kRoute);
    manoeuvres(spots);
    mark(spots.front(), "S");
    mark(spots.back(), "G");
  }

  // Marks reverse sections, and points at which the direction changes or the rover turns in place.
  void manoeuvres(const std::vector<Spot>& spots) {
    const auto& vertices = scene_.route->vertices;
    for (std::size_t i = 0; i + 1 < spots.size(); ++i) {
      if (vertices[i].reverse)
        canvas_.line(std::array{spots[i], spots[i + 1]}, {.colour = kReverse, .width = 2.8});
      if (vertices[i].turn_rad != 0.0 || (i > 0 && vertices[i].reverse != vertices[i - 1].reverse))
        canvas_.disc(spots[i], 3.5, kReverse);
    }
  }

  void mark(Spot at, const char* letter) {
    canvas_.disc(at, 10.5, kWhite);
    canvas_.disc(at, 9.0, kRoute);
    canvas_.text(letter, {at.x, at.y + 4.5}, {.size = 12, .colour = kWhite, .bold = true, .anchor = 0.5});
  }

  // Draws a ring with a minimum radius outside the start and goal marks, even around a small set.
  void encircle(const Ring& ring) {
    const Spot centre = spot(ring.centre.x_m, ring.centre.y_m);
    const double radius = std::max(18.0, ring.radius_m * scale_ / scene_.grid().resolution_m + 8.0);
    std::vector<Spot> circle;
    for (int k = 0; k <= 72; ++k)
      circle.push_back({centre.x + radius * std::cos(k * std::numbers::pi / 36),
                        centre.y + radius * std::sin(k * std::numbers::pi / 36)});
    canvas_.line(circle, {.colour = kWhite, .width = 7});
    canvas_.line(circle, {.colour = kRing, .width = 3.5});
  }

  void scaleBar() {
    const double pixel_m = scene_.grid().resolution_m / scale_;
    const double length_m = roundBelow(0.25 * map_.width * pixel_m);
    const double length = length_m / pixel_m;
    const Spot left{map_.x + 16, map_.y + map_.height - 18};
    canvas_.line(std::array{left, Spot{left.x + length, left.y}}, {.colour = kWhite, .width = 8});
    canvas_.line(std::array{left, Spot{left.x + length, left.y}}, {.colour = kInk, .width = 4});
    const std::string label =
        length_m >= 1000.0 ? fmt::format("{:g} km", length_m / 1000.0) : fmt::format("{:g} m", length_m);
    canvas_.text(label, {left.x + length / 2, left.y - 10},
                 {.size = 13, .bold = true, .anchor = 0.5, .halo = true});
  }

  void northArrow(Spot tip) {
    canvas_.polygon(
        std::array{tip, Spot{tip.x + 9, tip.y + 27}, Spot{tip.x, tip.y + 21}, Spot{tip.x - 9, tip.y + 27}},
        kInk);
    canvas_.text("N", {tip.x, tip.y - 5}, {.size = 13, .bold = true, .anchor = 0.5});
  }

  /// Writes one line of the legend, and moves on to the next.
  void entry(Spot& at, const std::string& text, double indent = 36, const TextStyle& style = {}) {
    canvas_.text(text, {at.x + indent, at.y + 4}, style);
    at.y += 24;
  }

  /// The same for what a line of a colour shows.
  void entry(Spot& at, const std::string& text, const Stroke& stroke) {
    canvas_.line(std::array{at, Spot{at.x + 26, at.y}}, stroke);
    entry(at, text);
  }

  void legend() {
    Spot at{map_.x + map_.width + kMargin, map_.y + 8};
    if (!scene_.image.empty())
      entry(at, "image of the ground", 0, {.bold = true});
    else if (!scene_.headings.empty())
      headingLegend(at);
    else if (!scene_.layers.empty())
      scaleLegend(at, scene_.layers.front());
    for (const HatchedArea& area : scene_.areas) {
      for (double x = at.x; x < at.x + 26; x += 6)
        canvas_.line(std::array{Spot{x, at.y + 7}, Spot{x + 6, at.y - 7}},
                     {.colour = area.colour, .width = 2});
      entry(at, area.name);
    }
    if (!scene_.rings.empty())
      entry(at, scene_.route ? "ring: see the warning" : "ring: the smaller set", {kRing, 3.5});
    if (scene_.route && !scene_.route->vertices.empty()) {
      entry(at, "route, start S to goal G", {kRoute, 3});
      if (scene_.route->drive) entry(at, "reverse; dots: turns in place", {kReverse, 3});
    }
    for (std::size_t i = 1; i < scene_.routes.size(); ++i)
      entry(at, scene_.routes[i].name, {seriesColour(i), 3});
    elevations(at);
    northArrow({at.x + 12, at.y + 80});
  }

  void swatch(Spot at, Colour colour) {
    canvas_.fill({at.x, at.y - 8, 26, 16}, colour);
    outline(canvas_, {at.x, at.y - 8, 26, 16}, {.colour = kInk, .width = 0.7});
  }

  void headingLegend(Spot& at) {
    entry(at, "allowed headings", 0, {.bold = true});
    const std::array<double, 4> shares = sharesOf(scene_.headings);
    for (std::size_t i = 0; i < shares.size(); ++i) {
      swatch(at, colourOf(static_cast<AllowedHeadings>(i)));
      entry(at, fmt::format("{}, {:.1f} %", kAllowedNames[i], 100.0 * shares[i]));
    }
  }

  void classLegend(Spot& at, const ValueLayer& layer) {
    for (const LayerClass& one : layer.classes) {
      swatch(at, one.colour);
      for (const std::string& line : wrapped(one.name, kLegend - 46, {.size = 12})) {
        canvas_.text(line, {at.x + 36, at.y + 4}, {.size = 12});
        at.y += 16;
      }
      at.y += 8;
    }
  }

  void scaleLegend(Spot& at, const ValueLayer& layer) {
    if (!layer.classes.empty()) return classLegend(at, layer);
    canvas_.text(layer.name + (layer.unit.empty() ? "" : " [" + layer.unit + "]"), {at.x, at.y + 4},
                 {.bold = true});
    at.y += 16;
    constexpr int kSteps = 96;
    for (int i = 0; i < kSteps; ++i)
      canvas_.fill({at.x + 2.0 * i, at.y, 2.0, 14}, cli::at(scaleOf(layer), i / (kSteps - 1.0)));
    canvas_.text(fmt::format("{:.3g}", layer.range.low), {at.x, at.y + 30}, {.size = 11});
    canvas_.text(fmt::format("{:.3g}", layer.range.high), {at.x + 2.0 * kSteps, at.y + 30},
                 {.size = 11, .anchor = 1.0});
    at.y += 52;
  }

  void elevations(Spot at) {
    const std::vector<double> ends = quantiles(scene_.elevation_m, {0.0, 1.0});
    if (std::isnan(ends[0])) return;
    canvas_.text(fmt::format("elevation {:.1f} to {:.1f} m", ends[0], ends[1]), {at.x, at.y + 8},
                 {.size = 11});
    canvas_.text("hillshade from the north-west", {at.x, at.y + 24}, {.size = 11});
    canvas_.text("light grey: no data", {at.x, at.y + 40}, {.size = 11});
  }

  const Scene& scene_;
  double scale_;
  std::vector<std::string> title_, warning_;
  double head_;
  Box map_;
  Canvas canvas_;
};

}  // namespace

std::string drawPicture(const Scene& scene) {
  return Picture(scene).draw();
}

}  // namespace talus::cli
