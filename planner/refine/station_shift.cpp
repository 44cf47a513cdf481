#include <cmath>
#include <vector>

#include <talus/common/constants.hpp>
#include <talus/planner/refine/station_shift.hpp>

namespace talus::planner {
namespace {

using maps::Point;

// Candidate positions at one station; the first is the station itself.
struct Station {
  Polyline places{};
  std::vector<int> offsets{};         // steps to the left of the route
  std::vector<double> best{};         // cost from the position to the end
  std::vector<std::size_t> choice{};  // position at the next station
};

// Returns true if the place has a drive curve; headings are checked with the motions.
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

// Chooses the next position for every position of `from`, at most `swing` steps sideways. The first position
// may also keep the present piece.
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

}  // namespace

Polyline shifted(const MotionCost& cost, const Polyline& route, double piece_m, const ShiftOptions& options,
                 const StopCheck& stop) {
  const auto pieces = cutFromEnd(route, piece_m, piece_m);
  const std::size_t n = pieces.size();
  // Slightly less than a power of two, which would put positions on cell edges.
  const double apart_m = 0.98 * piece_m / options.candidates;
  std::vector<Station> stations(n + 1);
  stations[n] = {{route.back()}, {0}, {0.0}, {0}};
  for (std::size_t i = n; i-- > 0;) {
    if (stop()) return route;
    const Point here = pieces[i].front(), after = pieces[i].back(),
                before = i > 0 ? pieces[i - 1].front() : here;
    stations[i] = stationAt(cost, {before, after}, here, apart_m, i > 0 ? options.candidates : 0);
    choose(cost, stations[i], stations[i + 1], cost.ofLegs(pieces[i]), options.swing);
  }
  Polyline made;
  for (std::size_t i = 0, a = 0; i < n; ++i) {
    const std::size_t b = stations[i].choice[a];
    const Point from = stations[i].places[a], to = stations[i + 1].places[b];
    const bool straight = a + b > 0 || cost({from, to}) + stations[i + 1].best[b] <= stations[i].best[a];
    append(made, straight ? Polyline{from, to} : pieces[i]);
    a = b;
  }
  return made;
}

}  // namespace talus::planner
