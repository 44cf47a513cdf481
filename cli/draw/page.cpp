#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/canvas.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/picture.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/common/common.hpp>

// Embeds the bytes of two files between three symbols in the read-only data.
asm(R"(
  .section .rodata
  talus_page_template: .incbin ")" TALUS_PAGE_TEMPLATE R"("
  talus_report_template: .incbin ")" TALUS_REPORT_TEMPLATE R"("
  talus_report_template_end: .byte 0
  .global talus_page_template
  .global talus_report_template
  .global talus_report_template_end
  .text
)");

extern "C" {
// NOLINTNEXTLINE(readability-identifier-naming)
extern const char talus_page_template[], talus_report_template[], talus_report_template_end[];
}

namespace talus::cli {
namespace {

using costmap::CellCode;
using costmap::TravelCurve;
using maps::Cell;
using nlohmann::ordered_json;

/// Returns a number for the data of an HTML page: nine significant digits; null for NaN and infinity.
ordered_json number(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.9g}", value));
}

/// Returns an image as a data URI of a PNG file.
std::string dataUri(const Image& image) {
  return "data:image/png;base64," + base64(png(image));
}

/// Returns a data URI of an image with 24 bits per cell, in red, green and blue; word(cell) returns the bits.
template <typename Word>
std::string wordsUri(const maps::Grid& grid, Word word) {
  return dataUri(imageOf(grid, [&](Cell cell) { return 0xFF000000U | word(cell); }));
}

/// Adds the values as integers with the decimals of the layer, or fewer if 24 bits do not suffice. 0 is no
/// value; other values are stored as 1 + steps above the lowest value.
void addValues(ordered_json& json, const ValueLayer& layer) {
  const std::vector<double> ends = quantiles(layer.values, {0.0, 1.0});
  const double low = std::isnan(ends[0]) ? 0.0 : ends[0], high = std::isnan(ends[0]) ? 0.0 : ends[1];
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

ordered_json legendEntry(Colour colour, const std::string& label) {
  return {{"colour", hex(colour)}, {"label", label}};
}

/// Returns 32 colours of a scale in hexadecimal form, from low to high.
ordered_json coloursOf(Scale scale) {
  ordered_json colours;
  for (int i = 0; i < 32; ++i) colours.push_back(hex(at(scale, i / 31.0)));
  return colours;
}

/// Returns the colour and label of each category.
ordered_json categoryLegend() {
  return jsonList(std::array{terramech::Category::Safe, terramech::Category::Marginal,
                             terramech::Category::Dangerous, terramech::Category::Unknown},
                  [](auto category) { return legendEntry(colourOf(category), terramech::name(category)); });
}

ordered_json headingLegend() {
  ordered_json legend;
  for (std::size_t i = 0; i < kAllowedNames.size(); ++i)
    legend.push_back(legendEntry(colourOf(static_cast<AllowedHeadings>(i)), kAllowedNames[i]));
  return legend;
}

/// Returns the layers of a scene for an HTML page, a picture of the ground first, then allowed headings. Each layer but the picture has a name, a coloured image,
/// a legend or a colour bar with range and unit, and the values that cli/page/probe.js shows: integers in
/// units of the layer's last decimal, or the shares of the four AllowedHeadings.
ordered_json layersOf(const Scene& scene) {
  ordered_json layers = ordered_json::array();
  if (!scene.image.empty())
    layers.push_back({{"name", "image"}, {"image", dataUri(groundImage(scene.image))}, {"relief", 0.0}});
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
      json["legend"] =
          jsonList(layer.classes, [](const LayerClass& one) { return legendEntry(one.colour, one.name); });
    addValues(json, layer);
    layers.push_back(std::move(json));
  }
  return layers;
}

/// Returns latitudes and longitudes [deg] on a square lattice over the scene, row by row from the south-west. The
/// arc between lattice points of a map of n cells of size c differs from its chord by (n c / 32)^2 / (8 R): a
/// twentieth of a cell for 1200 cells of 490 m on the Moon. Returns null without a georeference.
ordered_json latticeOf(const Scene& scene) {
  if (!scene.georeference || !scene.georeference->reachesPlaces()) return nullptr;
  const maps::Georeference& places = *scene.georeference;
  const maps::Grid& grid = scene.grid();
  constexpr int intervals = 32;
  ordered_json lattice{
      {"intervals", intervals}, {"latitude", ordered_json::array()}, {"longitude", ordered_json::array()}};
  for (int j = 0; j <= intervals; ++j)
    for (int i = 0; i <= intervals; ++i) {
      const double step_m = grid.resolution_m / intervals;
      const maps::GeoPoint place = places.reverse(
          {grid.south_west.x_m + i * step_m * grid.width, grid.south_west.y_m + j * step_m * grid.height});
      lattice["latitude"].push_back(number(place.latitude_rad / kDegree));
      lattice["longitude"].push_back(number(place.longitude_rad / kDegree));
    }
  return lattice;
}

constexpr std::uint32_t kNoCurve = 65535;
constexpr int kImageWidth = 4096;         // browsers limit the height of an image
constexpr double kMostWord = 16777214.0;  // largest 24-bit value, less one for "refused"

/// Range of the cost-curve nodes within the limits of pitch and roll: index of the bin of the steepest
/// descent, number of bins in a row, and number of rows from the level row.
struct Nodes {
  int first_bin, bins, rows;

  explicit Nodes(const costmap::TravelCost::Limits& limits) {
    const auto bin = [](double along) {
      return static_cast<int>(std::floor(along * TravelCurve::kBinsPerUnit)) + TravelCurve::kBins / 2;
    };
    first_bin = std::max(0, bin(-limits.max_along));
    bins = std::min(TravelCurve::kBins - 1, bin(limits.max_along) + 1) - first_bin + 1;
    rows = static_cast<int>(limits.max_across * TravelCurve::kRowsPerUnit) + 2;
  }
};

/// Image of the costs [J/m] of all curves, as 24-bit words on a logarithmic scale. Word 0 is a refused
/// heading; word w > 0 is the cost low exp(span (w - 1)), with a relative error of a few millionths.
ordered_json tableOf(const std::vector<const TravelCurve*>& curves, const Nodes& nodes) {
  std::vector<double> costs;
  double low = INFINITY, high = 0.0;
  for (const TravelCurve* curve : curves)
    for (int row = 0; row < nodes.rows; ++row)
      for (int bin = 0; bin < nodes.bins; ++bin) {
        const float* its = curve->rows() + std::min(row, curve->lastRow()) * TravelCurve::kBins;
        const double cost = std::max(1e-6, static_cast<double>(its[nodes.first_bin + bin]));
        costs.push_back(cost);
        if (!std::isfinite(cost)) continue;
        low = std::min(low, cost);
        high = std::max(high, cost);
      }
  const double span = low < high ? std::log(high / low) : 1.0;
  Image image(kImageWidth, static_cast<int>(costs.size()) / kImageWidth + 1);
  std::ranges::fill(image.argb, 0xFF000000U);
  for (std::size_t i = 0; i < costs.size(); ++i)
    if (std::isfinite(costs[i]))
      image.argb[i] |=
          1U + static_cast<std::uint32_t>(std::round(std::log(costs[i] / low) / span * kMostWord));
  return {{"image", dataUri(image)},  {"width", image.width},
          {"height", image.height},   {"curves", curves.size()},
          {"first", nodes.first_bin}, {"bins", nodes.bins},
          {"rows", nodes.rows},       {"low", std::isfinite(low) ? low : 1.0},
          {"span", span / kMostWord}};
}

/// Returns the data from which cli/page/rose.js computes the cost by heading: the cost curves used by the
/// cells, at nodes within the limits of pitch and roll, an image of the gradients of the cells, and an image
/// of their curve indices and categories. Returns null if the scene has no costs.
ordered_json headingCostsOf(const Scene& scene) {
  if (!scene.costs) return nullptr;
  const costmap::TravelCost& cost = *scene.costs->cost;
  std::map<std::uint32_t, std::uint32_t> numbers;
  std::vector<const TravelCurve*> curves;
  const auto numberOf = [&](CellCode code) {
    if (code.curve() >= cost.curves().size()) return kNoCurve;
    const auto [known, added] = numbers.try_emplace(code.curve(), static_cast<std::uint32_t>(curves.size()));
    if (added) curves.push_back(&cost.curves()[code.curve()]);
    return known->second;
  };
  const auto gradient = [&](maps::Cell cell) {
    const CellCode code = scene.costs->codes[cell];
    return static_cast<std::uint32_t>((code.stepsX() & 4095) << 12 | (code.stepsY() & 4095));
  };
  const auto kind = [&](maps::Cell cell) {
    return numberOf(scene.costs->codes[cell]) | static_cast<std::uint32_t>(scene.costs->categories[cell])
                                                    << 16U;
  };
  ordered_json json{{"gradients", wordsUri(scene.grid(), gradient)}, {"kinds", wordsUri(scene.grid(), kind)}};
  json["table"] = tableOf(curves, Nodes(cost.limits()));
  json["most"] = {{"along", cost.limits().max_along}, {"across", cost.limits().max_across}};
  return json;
}

/// Indices of all vertices, or of 4000 evenly selected vertices, including both ends, for a longer route.
std::vector<std::size_t> selection(std::size_t count) {
  constexpr std::size_t kMost = 4000;
  std::vector<std::size_t> chosen;
  const std::size_t n = std::min(count, kMost);
  for (std::size_t i = 0; i < n; ++i) chosen.push_back(n < 2 ? 0 : i * (count - 1) / (n - 1));
  return chosen;
}

ordered_json routeOf(const planner::Route& route) {
  const std::vector<double> s = distances_m(route);
  ordered_json points = ordered_json::array();
  for (const std::size_t i : selection(s.size())) {
    const planner::RouteVertex& v = route.vertices[i];
    points.push_back({{"s", number(s[i])},
                      {"x", number(v.x_m)},
                      {"y", number(v.y_m)},
                      {"elevation", number(v.elevation_m)},
                      {"slope", number(v.slope_along_rad / kDegree)},
                      {"across", number(v.slope_across_rad / kDegree)},
                      {"slip", number(v.slip)},
                      {"angle", number(v.slip_angle_rad / kDegree)},
                      {"energy", number(v.energy_J / 1000.0)},
                      {"time", number(v.time_s)},
                      {"risk", number(v.immobilisation_risk)},
                      {"category", terramech::name(v.category)}});
    if (v.reverse) points.back()["reverse"] = true;
    if (v.turn_rad != 0.0) points.back()["turn"] = number(v.turn_rad);
  }
  return points;
}

ordered_json places(const std::vector<maps::Point>& points) {
  return jsonList(points, [](const maps::Point& p) -> ordered_json {
    return {number(p.x_m), number(p.y_m)};
  });
}

// Track points as rows of plain numbers, because a drive has thousands of points.
ordered_json storyOf(const TraverseRecord& story) {
  ordered_json out;
  out["track"] = jsonList(story.drive.track, [](const planner::TrackPoint& t) -> ordered_json {
    return {number(t.time_s), number(t.place.x_m),         number(t.place.y_m),
            number(t.slip),   number(t.energy_J / 1000.0), number(t.sinkage_m)};
  });
  out["events"] = jsonList(story.drive.events, [](const planner::TraverseEvent& e) -> ordered_json {
    return {{"time", number(e.time_s)}, {"text", e.text}, {"route", places(e.route)}};
  });
  out["changes"] = jsonList(story.changes, [&](const CellChange& c) -> ordered_json {
    const maps::Point centre = story.grid.centre(c.cell);
    return {number(c.time_s), number(centre.x_m), number(centre.y_m),
            hex(colourOf(static_cast<terramech::Category>(c.category)))};
  });
  out["patches"] = jsonList(story.patches, [](const planner::SoilPatch& p) -> ordered_json {
    return {number(p.centre.x_m), number(p.centre.y_m), number(p.radius_m)};
  });
  out["cell"] = story.grid.resolution_m;
  return out;
}

ordered_json routesOf(const Scene& scene) {
  ordered_json routes = ordered_json::array();
  for (std::size_t i = 0; i < scene.routes.size(); ++i)
    routes.push_back({{"name", scene.routes[i].name},
                      {"colour", hex(seriesColour(i))},
                      {"points", routeOf(scene.routes[i].route)}});
  if (routes.empty() && scene.route)
    routes.push_back({{"name", ""}, {"colour", "#1b3fbf"}, {"points", routeOf(*scene.route)}});
  return routes;
}

ordered_json dataOf(const Scene& scene) {
  const maps::Grid& grid = scene.grid();
  ordered_json data;
  data["bounds"] = {{"west", grid.south_west.x_m},
                    {"south", grid.south_west.y_m},
                    {"east", grid.south_west.x_m + grid.width * grid.resolution_m},
                    {"north", grid.south_west.y_m + grid.height * grid.resolution_m}};
  data["grid"] = {{"width", grid.width},
                  {"height", grid.height},
                  {"cell", grid.resolution_m},
                  {"cells_per_pixel", scene.cells_per_pixel}};
  data["places"] = latticeOf(scene);
  const maps::Raster<float> shade = hillshade(scene.elevation_m);
  const Range light = lightRange(shade);
  data["shade"] = dataUri(shadeImage(shade));
  data["light"] = {{"low", number(light.low)}, {"high", number(light.high)}};
  data["layers"] = layersOf(scene);
  data["areas"] = jsonList(scene.areas, [](const HatchedArea& area) -> ordered_json {
    return {{"name", area.name}, {"colour", hex(area.colour)}, {"image", dataUri(hatchImage(area))}};
  });
  data["headings"] = headingCostsOf(scene);
  data["categories"] = categoryLegend();
  data["scales"] = {{"magnitude", coloursOf(viridis())}, {"signed", coloursOf(blueRed())}};
  data["facts"] = scene.facts;
  data["marks"] = jsonList(scene.marks, [](const auto& mark) -> ordered_json {
    return {{"letter", mark.first}, {"x", number(mark.second.x_m)}, {"y", number(mark.second.y_m)}};
  });
  data["rings"] = jsonList(scene.rings, [](const Ring& ring) -> ordered_json {
    return {{"x", number(ring.centre.x_m)},
            {"y", number(ring.centre.y_m)},
            {"radius", number(ring.radius_m)},
            {"label", ring.label}};
  });
  data["provenance"] = scene.provenance;
  data["routes"] = routesOf(scene);
  data["comparison"] = jsonList(scene.comparison, [](const ComparedFact& fact) -> ordered_json {
    return {{"name", fact.name}, {"values", fact.values}};
  });
  if (scene.story) data["story"] = storyOf(*scene.story);
  return data;
}

/// JSON for a script element. "<" occurs only inside strings and is escaped, because "</script" or
/// "<!--<script" would change how the page is parsed.
std::string embedded(const ordered_json& data) {
  std::string text = jsonText(data);
  boost::replace_all(text, "<", "\\u003c");
  return text;
}

}  // namespace

std::string_view pageTemplate() {
  return {talus_page_template, talus_report_template};
}

std::string_view reportTemplate() {
  return {talus_report_template, talus_report_template_end};
}

std::string escaped(const std::string& text) {
  constexpr std::pair<char, const char*> kEntities[] = {
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'\'', "&#39;"}, {'"', "&quot;"}};
  std::string html;
  for (const char c : text) {
    const auto* const entity = std::ranges::find(kEntities, c, &std::pair<char, const char*>::first);
    entity == std::end(kEntities) ? html += c : html += entity->second;
  }
  return html;
}

std::string filledPage(std::string_view empty, const std::string& title, const std::string& text,
                       const ordered_json& data) {
  // The title is replaced before the data are inserted, so that user text in the data is never taken for a
  // place-holder.
  std::string html(empty);
  boost::replace_all(html, "@TALUS_TITLE@", escaped(title));
  boost::replace_all(html, "@TALUS_TEXT@", text);
  const std::string place = "@TALUS_DATA@";
  return html.replace(html.rfind(place), place.size(), embedded(data));
}

std::string page(const Scene& scene) {
  return filledPage(pageTemplate(), scene.title, escaped(scene.subtitle), dataOf(scene));
}

void saveScene(const Scene& scene, const std::filesystem::path& html, const std::filesystem::path& png) {
  if (!png.empty()) writeFile(png, drawPicture(scene));
  if (!html.empty()) writeFile(html, page(scene));
}

}  // namespace talus::cli
