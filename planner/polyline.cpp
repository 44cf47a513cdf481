#include <cmath>

#include <planner/polyline.hpp>

namespace talus::planner {

std::vector<maps::Point> subdivided(const std::vector<maps::Point>& points, double longest_m) {
  std::vector<maps::Point> result;
  if (!points.empty()) result.push_back(points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const maps::Point a = points[i - 1];
    const maps::Point b = points[i];
    const int parts = static_cast<int>(std::ceil(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m) / longest_m));
    for (int k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      result.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
    result.push_back(b);
  }
  return result;
}

}  // namespace talus::planner
