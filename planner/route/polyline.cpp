#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <talus/planner/route/polyline.hpp>

namespace talus::planner {
Polyline subdivided(const Polyline& points, double longest_m) {
  Polyline result;
  if (!points.empty()) result.push_back(points.front());
  for (std::size_t i = 1; i < points.size(); ++i) {
    const maps::Point a = points[i - 1];
    const maps::Point b = points[i];
    const int parts = static_cast<int>(std::ceil(distance_m(a, b) / longest_m));
    for (int k = 1; k < parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      result.push_back({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
    }
    result.push_back(b);
  }
  return result;
}

double length_m(const Polyline& points) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += distance_m(points[i - 1], points[i]);
  return sum;
}

std::vector<Polyline> cutFromEnd(const Polyline& points, double piece_m, double offset_m) {
  double before_m = length_m(points);  // length of the remaining path
  const double shortest_m = piece_m / 2;
  std::vector<Polyline> backwards{{points.back()}};
  double walked_m = 0.0, next_m = offset_m;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    const maps::Point from = points[i + 1], to = points[i];
    const double leg_m = distance_m(from, to);
    for (; walked_m + leg_m > next_m && before_m - (next_m - walked_m) > shortest_m; next_m += piece_m) {
      const double share = (next_m - walked_m) / leg_m;
      const maps::Point cut{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)};
      backwards.back().push_back(cut);
      backwards.push_back({cut});
    }
    backwards.back().push_back(to);
    walked_m += leg_m;
    before_m -= leg_m;
  }
  for (Polyline& piece : backwards) std::reverse(piece.begin(), piece.end());
  std::reverse(backwards.begin(), backwards.end());
  return backwards;
}

std::pair<Polyline, Polyline> splitAt(const Polyline& points, double left_m) {
  Polyline behind{points.back()};
  for (std::size_t i = points.size() - 1; i-- > 0; left_m -= distance_m(points[i + 1], points[i])) {
    const maps::Point from = points[i + 1], to = points[i];
    const double leg_m = distance_m(from, to);
    if (left_m >= leg_m && i > 0) {
      behind.push_back(to);
      continue;
    }
    const double share = leg_m > 0.0 ? std::min(left_m / leg_m, 1.0) : 0.0;
    const maps::Point cut{from.x_m + share * (to.x_m - from.x_m), from.y_m + share * (to.y_m - from.y_m)};
    behind.push_back(cut);
    Polyline before(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    before.push_back(cut);
    std::reverse(behind.begin(), behind.end());
    return {before, behind};
  }
  return {points, points};
}

Polyline cutWithin(Polyline points, maps::Point goal, double tolerance_m) {
  if (!(tolerance_m > 0.0) || points.empty()) return points;
  const double reach_m = tolerance_m * (1.0 - 1e-9);  // keeps the end inside despite rounding
  const auto apart_m = [&](maps::Point p) { return std::hypot(p.x_m - goal.x_m, p.y_m - goal.y_m); };
  const auto inside = std::ranges::find_if(points, [&](maps::Point p) { return apart_m(p) <= reach_m; });
  // A leg may also intersect the circle between two points outside it.
  for (auto to = points.begin() + 1; to != points.end() && to <= inside; ++to) {
    const maps::Point from = *(to - 1);
    const double dx = to->x_m - from.x_m, dy = to->y_m - from.y_m, square = dx * dx + dy * dy;
    const double along = (goal.x_m - from.x_m) * dx + (goal.y_m - from.y_m) * dy;
    const double far = apart_m(from);
    const double root = along * along - square * (far * far - reach_m * reach_m);
    if (far <= reach_m || !(square > 0.0) || root < 0.0 || along <= 0.0) continue;
    const double t = (along - std::sqrt(root)) / square;
    if (t > 1.0) continue;
    *to = {from.x_m + t * dx, from.y_m + t * dy};
    points.erase(to + 1, points.end());
    return points;
  }
  if (inside != points.end()) points.erase(inside + 1, points.end());
  return points;
}

void append(Polyline& points, const Polyline& piece) {
  for (const maps::Point p : piece)
    if (points.empty() || !(points.back() == p)) points.push_back(p);
}

namespace {

std::uint64_t hashOf(maps::Point p) noexcept {
  std::uint64_t hash = std::bit_cast<std::uint64_t>(p.x_m) * 0x9e3779b97f4a7c15U;
  hash = (hash ^ (hash >> 32)) + std::bit_cast<std::uint64_t>(p.y_m);
  hash *= 0xbf58476d1ce4e5b9U;
  return hash ^ (hash >> 29);
}

}  // namespace

std::vector<Polyline> cutAtMarks(const Polyline& points, double apart_m) {
  std::vector<double> at_m(points.size(), 0.0);
  std::vector<std::uint64_t> hash(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    hash[i] = hashOf(points[i]);
    if (i > 0)
      at_m[i] =
          at_m[i - 1] + std::hypot(points[i].x_m - points[i - 1].x_m, points[i].y_m - points[i - 1].y_m);
  }
  const auto isMark = [&](std::size_t i) {
    for (std::size_t k = i; k-- > 0 && at_m[i] - at_m[k] <= apart_m;)
      if (hash[k] <= hash[i]) return false;
    for (std::size_t k = i + 1; k < points.size() && at_m[k] - at_m[i] <= apart_m; ++k)
      if (hash[k] <= hash[i]) return false;
    return true;
  };
  std::vector<Polyline> pieces(1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    pieces.back().push_back(points[i]);
    if (i > 0 && i + 1 < points.size() && isMark(i)) pieces.push_back({points[i]});
  }
  return pieces;
}

}  // namespace talus::planner
