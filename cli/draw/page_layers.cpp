#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/draw/map_image.hpp>
#include <talus/cli/draw/page_layers.hpp>
#include <talus/common/constants.hpp>

namespace talus::cli {
namespace {

using maps::Cell;
using nlohmann::ordered_json;

/// Adds the values as integers with the decimals of the layer, or fewer if 24 bits do not suffice. 0 is no
/// value; other values are stored as 1 + steps above the lowest value.
void addValues(ordered_json& json, const ValueLayer& layer) {
  double low = INFINITY, high = -INFINITY;
  for (const float v : layer.values.values())
    if (std::isfinite(v)) {
      low = std::min(low, static_cast<double>(v));
      high = std::max(high, static_cast<double>(v));
    }
  if (!(low <= high)) low = high = 0.0;
  int decimals = layer.decimals;
  while ((high - low) * std::pow(10.0, decimals) > 16777213.0) --decimals;
  const double scale = std::pow(10.0, decimals), first = std::round(low * scale);
  json["decimals"] = decimals;
  json["low"] = first;
  json["values"] = wordsUri(layer.values.grid(), [&](Cell cell) {
    const auto v = static_cast<double>(layer.values[cell]);
    return std::isfinite(v) ? static_cast<std::uint32_t>(std::round(v * scale) - first) + 1U : 0U;
  });
}

/// Shares of all, some, no and unknown headings, six bits each.
std::uint32_t sharesWord(const HeadingShares& shares) {
  int total = 0;
  for (const int n : shares.count) total += n;
  std::uint32_t word = 0;
  for (const int n : shares.count)
    word = word << 6U | static_cast<std::uint32_t>(total == 0 ? 0 : (63 * n + total / 2) / total);
  return word;
}

ordered_json legendOf(const ValueLayer& layer) {
  ordered_json legend = ordered_json::array();
  for (const LayerClass& one : layer.classes)
    legend.push_back({{"colour", hex(one.colour)}, {"label", one.name}});
  return legend;
}

/// Unit vector from the centre of the body; the latitude is used as the angle at the centre.
struct Direction {
  double x = 0.0, y = 0.0, z = 0.0;
};

Direction directionOf(maps::GeoPoint place) {
  const double c = std::cos(place.latitude_rad);
  return {c * std::cos(place.longitude_rad), c * std::sin(place.longitude_rad), std::sin(place.latitude_rad)};
}

maps::Point latticePoint(const maps::Grid& grid, double east, double north) {
  return {grid.south_west.x_m + east * grid.width * grid.resolution_m,
          grid.south_west.y_m + north * grid.height * grid.resolution_m};
}

/// Returns the largest interpolation error [m] of the page at centres of lattice squares; checked on both
/// diagonals of the lattice.
double latticeError_m(const maps::Georeference& places, const maps::Grid& grid, int intervals) {
  double most = 0.0;
  for (int i = 0; i < intervals; ++i)
    for (const int j : {i, intervals - 1 - i}) {
      Direction sum;
      for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        const Direction d = directionOf(places.reverse(latticePoint(
            grid, static_cast<double>(i + di) / intervals, static_cast<double>(j + dj) / intervals)));
        sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
      }
      const maps::Point middle = latticePoint(grid, (i + 0.5) / intervals, (j + 0.5) / intervals);
      const maps::Point met = places.forward({.latitude_rad = std::atan2(sum.z, std::hypot(sum.x, sum.y)),
                                              .longitude_rad = std::atan2(sum.y, sum.x)});
      const double error_m = std::hypot(met.x_m - middle.x_m, met.y_m - middle.y_m);
      if (std::isfinite(error_m)) most = std::max(most, error_m);
    }
  return most;
}

}  // namespace

ordered_json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.9g}", value));
}

std::string dataUri(const Image& image) {
  return "data:image/png;base64," + base64(png(image));
}

std::string wordsUri(const maps::Grid& grid, const std::function<std::uint32_t(maps::Cell)>& word) {
  Image image(grid.width, grid.height);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      image.at(column, grid.height - 1 - row) = 0xFF000000U | word(maps::Cell{column, row});
  return dataUri(image);
}

std::string hex(Colour c) {
  return fmt::format("#{:06x}", pixel(c) & 0xFFFFFFU);
}

ordered_json coloursOf(Scale scale) {
  ordered_json colours = ordered_json::array();
  for (int i = 0; i < 32; ++i) colours.push_back(hex(at(scale, i / 31.0)));
  return colours;
}

ordered_json categoryLegend() {
  ordered_json legend = ordered_json::array();
  for (const auto category : {terramech::Category::Safe, terramech::Category::Marginal,
                              terramech::Category::Dangerous, terramech::Category::Unknown})
    legend.push_back({{"colour", hex(colourOf(category))}, {"label", terramech::name(category)}});
  return legend;
}

ordered_json headingLegend() {
  ordered_json legend = ordered_json::array();
  for (std::size_t i = 0; i < kAllowedNames.size(); ++i)
    legend.push_back(
        {{"colour", hex(colourOf(static_cast<AllowedHeadings>(i)))}, {"label", kAllowedNames[i]}});
  return legend;
}

ordered_json layersOf(const Scene& scene) {
  ordered_json layers = ordered_json::array();
  if (!scene.headings.empty())
    layers.push_back({{"name", "allowed headings"},
                      {"image", dataUri(headingImage(scene.headings))},
                      {"relief", kCategoryRelief},
                      {"legend", headingLegend()},
                      {"shares", wordsUri(scene.headings.grid(),
                                          [&](Cell cell) { return sharesWord(scene.headings[cell]); })}});
  for (const ValueLayer& layer : scene.layers) {
    ordered_json json{{"name", layer.name}, {"image", dataUri(valueImage(layer))}, {"relief", kValueRelief}};
    if (layer.classes.empty())
      json["bar"] = {{"colours", coloursOf(scaleOf(layer))},
                     {"low", number(layer.range.low)},
                     {"high", number(layer.range.high)},
                     {"unit", layer.unit}};
    else
      json["legend"] = legendOf(layer);
    addValues(json, layer);
    layers.push_back(std::move(json));
  }
  return layers;
}

ordered_json latticeOf(const Scene& scene) {
  if (!scene.georeference || !scene.georeference->reachesPlaces()) return nullptr;
  const maps::Georeference& places = *scene.georeference;
  const maps::Grid& grid = scene.grid();
  int intervals = 8;
  while (intervals < 128 && latticeError_m(places, grid, intervals) > 0.05 * grid.resolution_m)
    intervals *= 2;
  ordered_json lattice{
      {"intervals", intervals}, {"latitude", ordered_json::array()}, {"longitude", ordered_json::array()}};
  for (int j = 0; j <= intervals; ++j)
    for (int i = 0; i <= intervals; ++i) {
      const maps::GeoPoint place = places.reverse(
          latticePoint(grid, static_cast<double>(i) / intervals, static_cast<double>(j) / intervals));
      lattice["latitude"].push_back(number(place.latitude_rad / kDegree));
      lattice["longitude"].push_back(number(place.longitude_rad / kDegree));
    }
  return lattice;
}

}  // namespace talus::cli
