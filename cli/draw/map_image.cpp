#include <algorithm>
#include <cmath>
#include <numbers>

#include <talus/cli/draw/map_image.hpp>
#include <talus/common/common.hpp>

namespace talus::cli {
namespace {

using maps::Cell;
using maps::Raster;

/// Gradient by central differences, one-sided at edges and beside cells without data; zero for an isolated
/// cell.
class Gradient {
 public:
  explicit Gradient(const Raster<float>& z) : z_(z) {}

  double x(Cell c) const { return along({c.column - 1, c.row}, c, {c.column + 1, c.row}); }
  double y(Cell c) const { return along({c.column, c.row - 1}, c, {c.column, c.row + 1}); }

 private:
  double value(Cell c) const { return z_.grid().contains(c) ? static_cast<double>(z_[c]) : std::nan(""); }

  double along(Cell before, Cell at, Cell after) const {
    const bool has_before = !std::isnan(value(before));
    const bool has_after = !std::isnan(value(after));
    const double low = value(has_before ? before : at);
    const double high = value(has_after ? after : at);
    const int steps = int{has_before} + int{has_after};
    return steps == 0 ? 0.0 : (high - low) / (steps * z_.grid().resolution_m);
  }

  const Raster<float>& z_;
};

/// Vertical exaggeration: scales the 90 % quantile of slope to 25 deg; 1 to 20.
double exaggeration(const Raster<float>& z) {
  const Gradient gradient(z);
  std::vector<double> steepness;
  const std::size_t stride = std::max<std::size_t>(1, z.values().size() / 20000);
  for (std::size_t i = 0; i < z.values().size(); i += stride) {
    const auto width = static_cast<std::size_t>(z.grid().width);
    const Cell c{static_cast<int>(i % width), static_cast<int>(i / width)};
    if (!std::isnan(z[c])) steepness.push_back(std::hypot(gradient.x(c), gradient.y(c)));
  }
  if (steepness.empty()) return 1.0;
  const auto p90 =
      steepness.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(steepness.size() - 1));
  std::nth_element(steepness.begin(), p90, steepness.end());
  return std::clamp(std::tan(25.0 * kDegree) / std::max(*p90, 1e-6), 1.0, 20.0);
}

/// Builds an image from draw(cell), with the northernmost row first.
template <typename Draw>
Image imageOf(const maps::Grid& grid, Draw draw) {
  Image image(grid.width, grid.height);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      image.at(column, grid.height - 1 - row) = draw(Cell{column, row});
  return image;
}

}  // namespace

Raster<float> hillshade(const Raster<float>& elevation_m) {
  const Gradient gradient(elevation_m);
  const double factor = exaggeration(elevation_m);
  // unit vector to the sun: azimuth 315 deg, elevation 45 deg
  constexpr double kSunX = -0.5, kSunY = 0.5, kSunZ = std::numbers::sqrt2 / 2.0;
  Raster<float> shade(elevation_m.grid(), std::nanf(""));
  for (int row = 0; row < elevation_m.grid().height; ++row) {
    for (int column = 0; column < elevation_m.grid().width; ++column) {
      const Cell c{column, row};
      if (std::isnan(elevation_m[c])) continue;
      const double gx = factor * gradient.x(c);
      const double gy = factor * gradient.y(c);
      const double cosine = (-gx * kSunX - gy * kSunY + kSunZ) / std::sqrt(1.0 + gx * gx + gy * gy);
      shade[c] = static_cast<float>(std::clamp(0.12 + 0.88 * cosine, 0.0, 1.0));
    }
  }
  return shade;
}

Range lightRange(const Raster<float>& shade) {
  const auto range = innerRange(shade);
  if (!range) return {};
  return range->high > range->low + 0.02 ? *range : Range{range->low - 0.5, range->low + 0.5};
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

}  // namespace talus::cli
