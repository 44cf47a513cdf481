#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <planner/any_angle.hpp>

namespace talus::planner {
namespace {

using maps::Point;
using Route = std::vector<Point>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double distance_m(Point a, Point b) noexcept {
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
}

Point between(Point a, Point b, double share) noexcept {
  return {a.x_m + share * (b.x_m - a.x_m), a.y_m + share * (b.y_m - a.y_m)};
}

double length_m(const Route& route) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) sum += distance_m(route[i - 1], route[i]);
  return sum;
}

// The route cut into pieces of about equal length. pieces[i] runs from station i to station i + 1, both
// included.
std::vector<Route> cutIntoPieces(const Route& route, double piece_m) {
  const double whole_m = length_m(route);
  const double count = std::max(1.0, std::round(whole_m / piece_m));
  std::vector<Route> pieces{{route.front()}};
  double walked_m = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    const double leg_m = distance_m(route[i - 1], route[i]);
    for (auto k = static_cast<double>(pieces.size()); k < count; k = static_cast<double>(pieces.size())) {
      const double share = (k * whole_m / count - walked_m) / leg_m;
      if (!(share < 1.0)) break;
      const Point station = between(route[i - 1], route[i], std::max(share, 0.0));
      pieces.back().push_back(station);
      pieces.push_back({station});
    }
    pieces.back().push_back(route[i]);
    walked_m += leg_m;
  }
  return pieces;
}

double costOf(const MotionCost& cost, const Route& piece) noexcept {
  double sum = 0.0;
  for (std::size_t i = 1; i < piece.size(); ++i) sum += cost({piece[i - 1], piece[i]});
  return sum;
}

void append(Route& route, const Route& piece) {
  for (const Point p : piece)
    if (route.empty() || !(route.back() == p)) route.push_back(p);
}

// Stretches between any two of the piece ends, straight wherever that is cheaper.
Route shortCut(const MotionCost& cost, const Route& route, double piece_m, const StopCheck& stop) {
  const auto pieces = cutIntoPieces(route, piece_m);
  const std::size_t n = pieces.size();
  std::vector<double> best(n + 1, kInfinity);
  std::vector<std::size_t> next(n, 0);
  best[n] = 0.0;
  for (std::size_t i = n; i-- > 0;) {
    if (stop()) return route;
    next[i] = i + 1;
    best[i] = costOf(cost, pieces[i]) + best[i + 1];
    for (std::size_t j = i + 1; j <= n; ++j) {
      const Point to = j < n ? pieces[j].front() : route.back();
      const double through = best[j] < best[i] ? cost({pieces[i].front(), to}) + best[j] : kInfinity;
      if (through < best[i]) {
        best[i] = through;
        next[i] = j;
      }
    }
  }
  Route made;
  for (std::size_t i = 0; i < n; i = next[i]) {
    const Point to = next[i] < n ? pieces[next[i]].front() : route.back();
    const bool straight = next[i] > i + 1 || cost({pieces[i].front(), to}) + best[next[i]] <= best[i];
    append(made, straight ? Route{pieces[i].front(), to} : pieces[i]);
  }
  return made;
}

// Places to choose from at one station; the first is the station itself.
struct Station {
  Route places{};
  std::vector<int> offsets{};         // steps to the left of the route
  std::vector<double> best{};         // from the place to the end
  std::vector<std::size_t> choice{};  // the place at the next station
};

// Whether the place has a drive curve at all; headings are left to the motions.
bool enterable(const costmap::CostGrid& map, Point place) noexcept {
  const auto cell = map.grid().cellAt(place);
  return cell && map.at(*cell).curve() < map.cost().curves().size();
}

Station stationAt(const MotionCost& cost, const Segment& chord, Point here, double apart_m, int candidates) {
  Station station{{here}, {0}, {}, {}};
  const double chord_m = distance_m(chord.from, chord.to);
  if (chord_m <= 0.0) return station;
  const Point left{-(chord.to.y_m - chord.from.y_m) / chord_m, (chord.to.x_m - chord.from.x_m) / chord_m};
  for (int k = 1; k <= candidates; ++k)
    for (const int offset : {k, -k}) {
      const Point place{here.x_m + offset * apart_m * left.x_m, here.y_m + offset * apart_m * left.y_m};
      if (!enterable(cost.map(), place)) continue;
      station.places.push_back(place);
      station.offsets.push_back(offset);
    }
  return station;
}

// Chooses the next place for every place of `from`, none farther than `swing` steps sideways; keeping the
// present piece is one of the choices of the first place.
void choose(const MotionCost& cost, Station& from, const Station& to, double kept_J, int swing) {
  from.best.assign(from.places.size(), kInfinity);
  from.choice.assign(from.places.size(), 0);
  from.best[0] = kept_J + to.best[0];
  for (std::size_t a = 0; a < from.places.size(); ++a)
    for (std::size_t b = 0; b < to.places.size(); ++b) {
      if (std::abs(from.offsets[a] - to.offsets[b]) > swing || !(to.best[b] < from.best[a])) continue;
      const double through = cost({from.places[a], to.places[b]}) + to.best[b];
      if (through < from.best[a]) {
        from.best[a] = through;
        from.choice[a] = b;
      }
    }
}

// One round of places beside stations.
Route shifted(const MotionCost& cost, const Route& route, double piece_m, const RefineOptions& options,
              const StopCheck& stop) {
  const auto pieces = cutIntoPieces(route, piece_m);
  const std::size_t n = pieces.size();
  // A little less than the power of two that would put places on the cells' edges.
  const double apart_m = 0.98 * piece_m / options.candidates;
  std::vector<Station> stations(n + 1);
  stations[n] = {{route.back()}, {0}, {0.0}, {0}};
  for (std::size_t i = n; i-- > 0;) {
    if (stop()) return route;
    const Point here = pieces[i].front(), after = pieces[i].back(),
                before = i > 0 ? pieces[i - 1].front() : here;
    stations[i] = stationAt(cost, {before, after}, here, apart_m, i > 0 ? options.candidates : 0);
    choose(cost, stations[i], stations[i + 1], costOf(cost, pieces[i]), options.swing);
  }
  Route made;
  for (std::size_t i = 0, a = 0; i < n; ++i) {
    const std::size_t b = stations[i].choice[a];
    const Point from = stations[i].places[a], to = stations[i + 1].places[b];
    const bool straight = a + b > 0 || cost({from, to}) + stations[i + 1].best[b] <= stations[i].best[a];
    append(made, straight ? Route{from, to} : pieces[i]);
    a = b;
  }
  return made;
}

// How far apart the ends of short cuts lie: so that all pairs together cross some three million cells.
double shortCutPiece_m(double route_m, double cell_m) {
  const double cells = std::max(route_m / cell_m, 1.0);
  const double count = std::clamp(std::sqrt(1.8e7 / cells), 24.0, 160.0);
  return std::max(route_m / count, cell_m);
}

}  // namespace

std::vector<Point> withoutIdleTurns(const MotionCost& cost, const std::vector<Point>& route) {
  if (route.size() < 3) return route;
  Route kept{route.front()};
  for (std::size_t i = 1; i + 1 < route.size(); ++i) {
    const double bent = cost({kept.back(), route[i]}) + cost({route[i], route[i + 1]});
    if (cost({kept.back(), route[i + 1]}) > bent * (1.0 + 1e-12)) kept.push_back(route[i]);
  }
  kept.push_back(route.back());
  return kept;
}

std::vector<Point> refined(const MotionCost& cost, Route route, const RefineOptions& options,
                           const StopCheck& stop) {
  if (route.size() < 2) return route;
  double best = cost.along(route);
  const auto take = [&](Route tried) {
    const double tried_J = cost.along(tried);
    if (tried_J >= best) return;
    best = tried_J;
    route = std::move(tried);
  };
  const double cell_m = cost.map().grid().resolution_m;
  take(shortCut(cost, route, shortCutPiece_m(length_m(route), cell_m), stop));
  for (double cells = options.coarsest_cells; cells >= options.finest_cells; cells /= 2)
    for (int k = 0; k < options.repeats && !stop(); ++k)
      take(shifted(cost, route, cells * cell_m, options, stop));
  const Route fewer = withoutIdleTurns(cost, route);
  return cost.along(fewer) <= best * (1.0 + 1e-9) ? fewer : route;
}

}  // namespace talus::planner
