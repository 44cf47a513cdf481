#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/draw/route_comparison.hpp>
#include <talus/cli/draw/route_summary.hpp>

namespace talus::cli {
namespace {

using maps::Point;
using planner::Route;

double distanceToLine_m(Point p, const Route& line) {
  double least = INFINITY;
  for (std::size_t i = 0; i < line.vertices.size(); ++i) {
    const planner::RouteVertex& a = line.vertices[i];
    const planner::RouteVertex& b = line.vertices[std::min(i + 1, line.vertices.size() - 1)];
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, length2 = dx * dx + dy * dy;
    const double along =
        length2 > 0.0 ? std::clamp(((p.x_m - a.x_m) * dx + (p.y_m - a.y_m) * dy) / length2, 0.0, 1.0) : 0.0;
    least = std::min(least, std::hypot(a.x_m + along * dx - p.x_m, a.y_m + along * dy - p.y_m));
  }
  return least;
}

/// Calls visit(distance from the start, place) at regular steps along a route, including both ends.
template <typename Visit>
void walk(const Route& route, double step_m, Visit visit) {
  const std::vector<double> s = distances_m(route);
  visit(0.0, Point{route.vertices.front().x_m, route.vertices.front().y_m});
  for (std::size_t i = 0; i + 1 < s.size(); ++i) {
    const planner::RouteVertex &a = route.vertices[i], &b = route.vertices[i + 1];
    const int pieces = std::max(1, static_cast<int>(std::ceil((s[i + 1] - s[i]) / step_m)));
    for (int k = 1; k <= pieces; ++k) {
      const double t = static_cast<double>(k) / pieces;
      visit(s[i] + t * (s[i + 1] - s[i]), Point{a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
  }
}

std::string partingText(const Parting& part) {
  return fmt::format("{:.1f} to {:.1f} m of the first, at most {:.1f} m apart", part.from_m, part.to_m,
                     part.most_m);
}

/// Facts of all routes, one row per name in order of first occurrence. Several values of one name in a route,
/// such as files, are joined.
std::vector<ComparedFact> rowsOf(const std::vector<NamedRoute>& routes) {
  std::vector<ComparedFact> rows;
  for (std::size_t i = 0; i < routes.size(); ++i) {
    std::vector<Fact> facts = summaryOf(routes[i].route);
    facts.insert(facts.end(), routes[i].provenance.begin(), routes[i].provenance.end());
    for (const Fact& fact : facts) {
      auto row =
          std::find_if(rows.begin(), rows.end(), [&](const ComparedFact& r) { return r.name == fact.first; });
      if (row == rows.end())
        row = rows.insert(rows.end(), {fact.first, std::vector<std::string>(routes.size())});
      std::string& cell = row->values[i];
      cell += (cell.empty() ? "" : "; ") + fact.second;
    }
  }
  return rows;
}

}  // namespace

std::vector<Parting> partings(const Route& route, const Route& other, double tolerance_m) {
  std::vector<Parting> found;
  if (route.vertices.empty() || other.vertices.empty()) return found;
  const double step_m = std::max(0.5 * tolerance_m, route.summary.length_m / 4000.0);
  bool apart = false;
  double last_m = 0.0;
  Point last{route.vertices.front().x_m, route.vertices.front().y_m};
  walk(route, step_m, [&](double s, Point p) {
    const double distance_m = distanceToLine_m(p, other);
    const bool now = distance_m > tolerance_m;
    if (now && !apart) found.push_back({.from_m = last_m, .to_m = s, .most_m = 0.0, .begin = last, .end = p});
    if (now || apart) {
      found.back().to_m = s;
      found.back().end = p;
      found.back().most_m = std::max(found.back().most_m, distance_m);
    }
    apart = now;
    last_m = s;
    last = p;
  });
  return found;
}

void compare(Scene& scene, std::vector<NamedRoute> routes) {
  for (ComparedFact& row : rowsOf(routes)) {
    const bool same = std::all_of(row.values.begin(), row.values.end(),
                                  [&](const std::string& v) { return v == row.values.front(); });
    if (same)
      scene.facts.emplace_back(row.name, row.values.front());
    else
      scene.comparison.push_back(std::move(row));
  }
  const double cell_m = scene.grid().resolution_m / scene.cells_per_pixel;
  ComparedFact where{fmt::format("parts (> {:.3g} m)", 2.0 * cell_m), {"-"}};
  for (std::size_t i = 1; i < routes.size(); ++i) {
    std::string text;
    for (const Parting& part : partings(routes.front().route, routes[i].route, 2.0 * cell_m)) {
      text += (text.empty() ? "" : "; ") + partingText(part);
      scene.partings.emplace_back(part.begin, fmt::format("{} parts: {}", routes[i].name, partingText(part)));
      scene.partings.emplace_back(part.end, fmt::format("{} is back: {}", routes[i].name, partingText(part)));
    }
    where.values.push_back(text.empty() ? "nowhere" : text);
  }
  scene.comparison.push_back(std::move(where));
  scene.route = routes.front().route;
  scene.routes = std::move(routes);
}

}  // namespace talus::cli
