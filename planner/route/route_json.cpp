#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include <talus/common/common.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::planner {
namespace {

using Json = nlohmann::ordered_json;

Json position(const RouteVertex& vertex, const maps::ElevationMap& map) {
  Json made = Json::array();
  if (const maps::Georeference* places = map.places()) {
    const maps::GeoPoint place = places->reverse({vertex.x_m, vertex.y_m});
    made = {place.longitude_rad / kDegree, place.latitude_rad / kDegree};
  } else {
    made = {vertex.x_m, vertex.y_m};
  }
  if (std::isfinite(vertex.elevation_m)) made.push_back(vertex.elevation_m);
  return made;
}

template <typename Value>
Json values(const Route& route, Value value) {
  Json made = Json::array();
  for (const RouteVertex& vertex : route.vertices) made.push_back(value(vertex));
  return made;
}

void addVertices(Json& properties, const Route& route) {
  const auto add = [&](const char* key, double RouteVertex::*field) {
    properties[key] = values(route, [field](const RouteVertex& vertex) { return vertex.*field; });
  };
  add("x_m", &RouteVertex::x_m);
  add("y_m", &RouteVertex::y_m);
  add("elevation_m", &RouteVertex::elevation_m);
  add("heading_rad", &RouteVertex::heading_rad);
  add("slope_along_rad", &RouteVertex::slope_along_rad);
  add("slope_across_rad", &RouteVertex::slope_across_rad);
  add("slip", &RouteVertex::slip);
  add("slip_angle_rad", &RouteVertex::slip_angle_rad);
  add("side_force_over_load", &RouteVertex::side_force_over_load);
  add("stability_margin_rad", &RouteVertex::stability_margin_rad);
  add("sinkage_m", &RouteVertex::sinkage_m);
  add("torque_Nm", &RouteVertex::torque_Nm);
  add("drawbar_pull_margin", &RouteVertex::drawbar_pull_margin);
  properties["category"] =
      values(route, [](const RouteVertex& vertex) { return terramech::name(vertex.category); });
  // The totals are in "summary", to avoid confusion with these arrays.
  add("energy_J", &RouteVertex::energy_J);
  add("time_s", &RouteVertex::time_s);
  add("immobilisation_risk", &RouteVertex::immobilisation_risk);
  if (!route.drive) return;
  add("curvature_1_m", &RouteVertex::curvature_1_m);
  add("turn_rad", &RouteVertex::turn_rad);
  properties["reverse"] = values(route, [](const RouteVertex& vertex) { return vertex.reverse; });
}

Json obstructionJson(const Obstruction& why) {
  const auto place = [](maps::Point p) { return Json{{"x_m", p.x_m}, {"y_m", p.y_m}}; };
  Json made{{"cells_from_start", why.cells_from_start},
            {"cells_to_goal", why.cells_to_goal},
            {"last", place(why.last)},
            {"first", place(why.first)}};
  made["lifting"] = why.lifting ? Json(name(*why.lifting)) : Json(nullptr);
  if (why.hazard) made["hazard"] = name(*why.hazard);
  if (why.also) made["also"] = name(*why.also);
  return made;
}

}  // namespace

Json originJson(const RouteOrigin& origin) {
  Json files = Json::array();
  for (const InputFile& input : origin.files) {
    const std::string name = std::filesystem::path(input.path).filename();
    files.push_back({{"file", name}, {"path", input.path}, {"sha256", input.sha256}, {"size", input.size}});
    if (!input.role.empty()) files.back()["role"] = input.role;
    if (!input.used) files.back()["used"] = false;
  }
  Json made{{"files", files}, {"seed", origin.seed}, {"version", TALUS_VERSION}};
  if (!origin.rover.empty()) made["rover"] = origin.rover;
  if (!origin.soils.empty()) made["soils"] = origin.soils;
  if (!origin.reading.empty()) made["reading"] = origin.reading;
  if (!origin.command.empty()) made["command"] = origin.command;
  return made;
}

Json summaryJson(const Route& route) {
  const RouteSummary& s = route;
  Json made;
  made["status"] = std::string(name(route.status));
  if (route.vertices.empty()) {
    for (const char* key : {"cost", "energy_J", "time_s", "energy_p90_J", "time_p90_s", "length_m",
                            "max_slip", "max_slope_rad", "lower_bound", "gap", "immobilisation_risk"})
      made[key] = nullptr;
    made["planner"] = s.planner;
    if (route.obstruction) made["obstruction"] = obstructionJson(*route.obstruction);
    return made;
  }
  made["cost"] = s.cost;
  made["energy_J"] = s.energy_J;
  made["time_s"] = s.time_s;
  made["energy_p90_J"] = s.energy_p90_J;
  made["time_p90_s"] = s.time_p90_s;
  made["length_m"] = s.length_m;
  made["max_slip"] = s.max_slip;
  made["max_slope_rad"] = s.max_slope_rad;
  made["max_slope_across_rad"] = s.max_slope_across_rad;
  made["max_slip_angle_rad"] = s.max_slip_angle_rad;
  made["lower_bound"] = s.lower_bound;
  made["gap"] = s.gap;
  made["immobilisation_risk"] = route.vertices.back().immobilisation_risk;
  made["planner"] = s.planner;
  if (route.interrupted) made["interrupted"] = true;
  if (s.drive)
    made["drive"] = {{"cusps", s.drive->cusps},
                     {"turns_in_place", s.drive->turns_in_place},
                     {"turned_rad", s.drive->turned_rad},
                     {"max_curvature_1_m", s.drive->max_curvature_1_m}};
  return made;
}

Json routeGeoJson(const Route& route, const maps::ElevationMap& map, const RouteOrigin& origin) {
  Json line = values(route, [&map](const RouteVertex& vertex) { return position(vertex, map); });
  if (line.size() == 1) line.push_back(line.front());
  const Json summary = summaryJson(route);
  Json properties = summary;
  properties["summary"] = summary;
  addVertices(properties, route);
  properties["inputs"] = originJson(origin);
  properties["seed"] = origin.seed;
  properties["version"] = TALUS_VERSION;
  if (map.places() == nullptr) properties["crs"] = "local";
  Json feature;
  feature["type"] = "Feature";
  feature["geometry"] = {{"type", "LineString"}, {"coordinates", line}};
  feature["properties"] = properties;
  Json made;
  made["type"] = "FeatureCollection";
  if (map.places() == nullptr) made["crs"] = "local";
  made["features"] = Json::array({feature});
  return made;
}

}  // namespace talus::planner
