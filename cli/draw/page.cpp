#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/draw/heading_costs.hpp>
#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/draw/map_image.hpp>
#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/page_layers.hpp>
#include <talus/cli/draw/page_template.hpp>
#include <talus/cli/draw/route_summary.hpp>
#include <talus/common/constants.hpp>

namespace talus::cli {
namespace {

using nlohmann::ordered_json;

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
  ordered_json out = ordered_json::array();
  for (const maps::Point& p : points) out.push_back({number(p.x_m), number(p.y_m)});
  return out;
}

// Track points as rows of plain numbers, because a drive has thousands of points.
ordered_json storyOf(const TraverseRecord& story) {
  ordered_json out{{"track", ordered_json::array()},
                   {"events", ordered_json::array()},
                   {"changes", ordered_json::array()},
                   {"patches", ordered_json::array()},
                   {"cell", story.grid.resolution_m}};
  for (const planner::TrackPoint& t : story.drive.track)
    out["track"].push_back({number(t.time_s), number(t.place.x_m), number(t.place.y_m), number(t.slip),
                            number(t.energy_J / 1000.0), number(t.sinkage_m)});
  for (const planner::TraverseEvent& e : story.drive.events)
    out["events"].push_back({{"time", number(e.time_s)}, {"text", e.text}, {"route", places(e.route)}});
  for (const CellChange& c : story.changes) {
    const maps::Point centre = story.grid.centre(c.cell);
    out["changes"].push_back({number(c.time_s), number(centre.x_m), number(centre.y_m),
                              hex(colourOf(static_cast<terramech::Category>(c.category)))});
  }
  for (const planner::SoilPatch& p : story.patches)
    out["patches"].push_back({number(p.centre.x_m), number(p.centre.y_m), number(p.radius_m)});
  return out;
}

ordered_json marksOf(const Scene& scene) {
  ordered_json marks = ordered_json::array();
  for (const auto& [letter, place] : scene.marks)
    marks.push_back({{"letter", letter}, {"x", number(place.x_m)}, {"y", number(place.y_m)}});
  return marks;
}

ordered_json ringsOf(const Scene& scene) {
  ordered_json rings = ordered_json::array();
  for (const Ring& ring : scene.rings)
    rings.push_back({{"x", number(ring.centre.x_m)},
                     {"y", number(ring.centre.y_m)},
                     {"radius", number(ring.radius_m)},
                     {"label", ring.label}});
  return rings;
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

ordered_json comparisonOf(const Scene& scene) {
  ordered_json rows = ordered_json::array();
  for (const ComparedFact& fact : scene.comparison)
    rows.push_back({{"name", fact.name}, {"values", fact.values}});
  return rows;
}

ordered_json partingsOf(const Scene& scene) {
  ordered_json out = ordered_json::array();
  for (const auto& [place, text] : scene.partings)
    out.push_back({{"x", number(place.x_m)}, {"y", number(place.y_m)}, {"text", text}});
  return out;
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
  data["headings"] = headingCostsOf(scene);
  data["categories"] = categoryLegend();
  data["scales"] = {{"magnitude", coloursOf(viridis())}, {"signed", coloursOf(blueRed())}};
  data["facts"] = scene.facts;
  data["marks"] = marksOf(scene);
  data["rings"] = ringsOf(scene);
  data["provenance"] = scene.provenance;
  data["routes"] = routesOf(scene);
  data["comparison"] = comparisonOf(scene);
  data["partings"] = partingsOf(scene);
  if (scene.story) data["story"] = storyOf(*scene.story);
  return data;
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// JSON for a script element. "<" occurs only inside strings and is escaped, because "</script" or
/// "<!--<script" would change how the page is parsed.
std::string embedded(const ordered_json& data) {
  std::string text = jsonText(data);
  replaceAll(text, "<", "\\u003c");
  return text;
}

}  // namespace

std::string page(const Scene& scene) {
  // The title is replaced before the data are inserted, so that user text in the data is never taken for a
  // place-holder.
  std::string html(pageTemplate());
  replaceAll(html, "@TALUS_TITLE@", escaped(scene.title));
  replaceAll(html, "@TALUS_SUBTITLE@", escaped(scene.subtitle));
  const std::string place = "@TALUS_DATA@";
  return html.replace(html.rfind(place), place.size(), embedded(dataOf(scene)));
}

void savePage(const std::filesystem::path& path, const Scene& scene) {
  writeFile(path, page(scene));
}

}  // namespace talus::cli
