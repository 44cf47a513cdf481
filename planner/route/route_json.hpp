#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// A quantity of each vertex in files and tables of routes.
struct VertexColumn {
  const char* name;
  double RouteVertex::*value;
};
/// The quantities of every route, in the order of files.
inline constexpr VertexColumn kVertexColumns[] = {
    {"x_m", &RouteVertex::x_m},
    {"y_m", &RouteVertex::y_m},
    {"elevation_m", &RouteVertex::elevation_m},
    {"heading_rad", &RouteVertex::heading_rad},
    {"slope_along_rad", &RouteVertex::slope_along_rad},
    {"slope_across_rad", &RouteVertex::slope_across_rad},
    {"slip", &RouteVertex::slip},
    {"slip_angle_rad", &RouteVertex::slip_angle_rad},
    {"side_force_over_load", &RouteVertex::side_force_over_load},
    {"stability_margin_rad", &RouteVertex::stability_margin_rad},
    {"sinkage_m", &RouteVertex::sinkage_m},
    {"torque_Nm", &RouteVertex::torque_Nm},
    {"drawbar_pull_margin", &RouteVertex::drawbar_pull_margin},
    {"energy_J", &RouteVertex::energy_J},
    {"time_s", &RouteVertex::time_s},
    {"immobilisation_risk", &RouteVertex::immobilisation_risk},
};

/// The quantities of a route as a whole, in the order of files.
inline constexpr std::pair<const char*, double RouteSummary::*> kSummaryColumns[] = {
    {"cost", &RouteSummary::cost},
    {"energy_J", &RouteSummary::energy_J},
    {"time_s", &RouteSummary::time_s},
    {"energy_p90_J", &RouteSummary::energy_p90_J},
    {"time_p90_s", &RouteSummary::time_p90_s},
    {"length_m", &RouteSummary::length_m},
    {"max_slip", &RouteSummary::max_slip},
    {"max_slope_rad", &RouteSummary::max_slope_rad},
    {"max_slope_across_rad", &RouteSummary::max_slope_across_rad},
    {"max_slip_angle_rad", &RouteSummary::max_slip_angle_rad},
    {"lower_bound", &RouteSummary::lower_bound},
    {"gap", &RouteSummary::gap},
};

/// Returns the colour 0xRRGGBB of a category: white with a trace of green, amber, dark red and black. Lightness
/// decreases with danger in equal steps (99, 66, 33, 0 of CIE L*), so that the colours stay distinguishable
/// for colour-blind readers, in grey print and under shading.
unsigned categoryColour(terramech::Category category) noexcept;

/// Data with which a route can be computed again.
struct RouteOrigin {
  std::vector<InputFile> files;      ///< files that the planner read; paths as given to it
  std::uint64_t seed = 1;            ///< seed of the planner
  std::string rover{};               ///< name of the rover
  std::vector<std::string> soils{};  ///< names of the soils, one per terrain class of the map
  std::string reading{};             ///< how the heights were read (ElevationMap); empty if unknown
  std::string command{};             ///< shell command that computes the route; empty if unknown
};

/// Returns the origin of routes on a map that was made from `files`.
RouteOrigin originOf(const costmap::TraversabilityMap& map, std::vector<InputFile> files, std::uint64_t seed);

/// Returns the origin in the JSON form of "inputs" of a route file.
nlohmann::ordered_json originJson(const RouteOrigin& origin);

/// Returns the status and the summary of the route. If there is no route, the summary values are null, and
/// "obstruction" contains the cause if it is known.
nlohmann::ordered_json summaryJson(const Route& route);

/// Returns the route in the form of a GeoJSON FeatureCollection. Positions are longitude, latitude and
/// elevation if the map has a CRS, otherwise map coordinates [m] with "crs": "local". A LineString needs two
/// positions; therefore the position of a route with a single vertex is repeated. The layout is documented at
/// `talus plan`.
nlohmann::ordered_json routeGeoJson(const Route& route, const maps::ElevationMap& map,
                                    const RouteOrigin& origin);

/// File names that writeRoute() accepts, as the type name of an option.
inline constexpr const char* kRouteFiles = "ROUTE.geojson|ROUTE.gpkg|ROUTE.gpx|ROUTE.kml|ROUTE.csv";

/// Checks, before planning, that the file format of `path` can store routes of the map. @throws InputError
/// otherwise
void requireRouteFormat(const std::string& path, const maps::ElevationMap& map);

/// Writes a route of routeGeoJson() in the format that the ending of the file name selects: GeoPackage (in
/// the CRS of the map, with the layers route, vertices and segments, and styles for QGIS), GPX and KML (Earth only), CSV
/// of the vertices, and GeoJSON for all other endings. `warn` receives a line if GeoJSON cannot state the frame of the
/// map. @throws InputError
void writeRoute(const std::string& path, const nlohmann::ordered_json& route, const maps::ElevationMap& map,
                const std::function<void(std::string_view)>& warn);

}  // namespace talus::planner
