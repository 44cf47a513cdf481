#include "route.hpp"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace safety {

Route readRoute(const std::string& path) {
  std::ifstream file(path);
  const auto document = nlohmann::json::parse(file, nullptr, false);
  if (document.is_discarded()) throw std::runtime_error(path + ": no route");
  const auto& told = document.at("features").at(0).at("properties");
  Route route;
  const auto x_m = told.at("x_m").get<std::vector<double>>(), y_m = told.at("y_m").get<std::vector<double>>();
  for (std::size_t i = 0; i < x_m.size(); ++i) route.vertices.push_back({x_m[i], y_m[i]});
  for (const auto& z : told.at("elevation_m"))
    route.elevation_m.push_back(z.is_null() ? std::nan("") : z.get<double>());
  route.heading_rad = told.at("heading_rad").get<std::vector<double>>();
  route.category = told.at("category").get<std::vector<std::string>>();
  route.turn_rad.assign(x_m.size(), 0.0);
  if (told.contains("turn_rad")) route.turn_rad = told.at("turn_rad").get<std::vector<double>>();
  route.immobilisation_risk = told.at("summary").at("immobilisation_risk").get<double>();
  return route;
}

double Route::length_m() const {
  double sum = 0.0;
  for (std::size_t i = 1; i < vertices.size(); ++i)
    sum += std::hypot(vertices[i].x_m - vertices[i - 1].x_m, vertices[i].y_m - vertices[i - 1].y_m);
  return sum;
}

std::vector<Station> Route::stations(double step_m) const {
  std::vector<Station> out;
  double along_m = 0.0;
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const Place a = vertices[i], b = vertices[i + 1];
    const int turns = static_cast<int>(std::ceil(std::abs(turn_rad[i]) / 0.1));
    for (int k = 0; k <= turns && turns > 0; ++k)
      out.push_back({a, heading_rad[i] + turn_rad[i] * k / turns, along_m, true});
    const double length_m = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (!(length_m > 1e-9)) continue;
    const double heading = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
    const int parts = static_cast<int>(std::ceil(length_m / step_m));
    for (int k = 0; k <= parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      out.push_back({{a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)},
                     heading,
                     along_m + t * length_m,
                     false});
    }
    along_m += length_m;
  }
  return out;
}

}  // namespace safety
