#include <algorithm>
#include <array>
#include <cmath>

#include <talus/common/constants.hpp>
#include <talus/planner/refine/edge_path.hpp>
#include <talus/planner/route/heading_cost.hpp>

namespace talus::planner {
namespace {

constexpr int kReach = 1;       // positions to each side of a turn
constexpr double kFiner = 0.7;  // factor of the spacing of positions from round to round
constexpr int kPlaces = 2 * kReach + 1;
constexpr double kClear = 1.0 / 64;  // [cells] smallest distance of turns from corners

constexpr double kEnd = 2.0;  // [cells] a step that leaves the ends of a path only their own position

using Turn = EdgePath::Turn;

// Points to which a turn may move; the first of `places` is the present point of the turn.
struct Choice {
  std::array<Turn, kPlaces> places;
  std::array<double, kPlaces> best{};
  std::array<int, kPlaces> next{};
  int count = 0;
};

Choice choiceAround(Turn turn, double step) {
  Choice choice;
  choice.places[static_cast<std::size_t>(choice.count++)] = turn;
  const double at = turn.on_vertical ? turn.y : turn.x, cell = std::floor(at);
  for (int k = 1; k <= kReach; ++k)
    for (const double moved : {at + k * step, at - k * step}) {
      if (moved < cell + kClear || moved > cell + 1.0 - kClear) continue;
      Turn place = turn;
      (turn.on_vertical ? place.y : place.x) = moved;
      choice.places[static_cast<std::size_t>(choice.count++)] = place;
    }
  return choice;
}

// The cell of a motion, and the cells before and after it. A turn on an edge touches both adjacent cells, so
// these must allow the heading, too.
struct Passage {
  costmap::CellCode cell, before, after;
};

// Straight motion between two positions within a cell.
struct Straight {
  HeadingCost cost;
  double length;

  Straight(const costmap::TravelCost& drive, double dx, double dy) noexcept
      : Straight(drive, dx, dy, std::sqrt(dx * dx + dy * dy)) {}
  Straight(const costmap::TravelCost& drive, double dx, double dy, double far) noexcept
      : cost(drive, far > 0.0 ? costmap::Direction{dx / far, dy / far} : costmap::Direction{1.0, 0.0}),
        length(far) {}

  double within(costmap::CellCode cell) const noexcept {
    return length > 0.0 ? length * static_cast<double>(cost(cell)) : 0.0;
  }
  bool mayTurn(const Passage& passage) const noexcept {
    return !(length > 0.0) || (std::isfinite(cost(passage.before)) && std::isfinite(cost(passage.after)));
  }
};

void choose(const costmap::TravelCost& drive, const Passage& passage, Choice& from, const Choice& to) {
  for (std::size_t a = 0; a < static_cast<std::size_t>(from.count); ++a) {
    from.best[a] = kInfinity;
    for (std::size_t b = 0; b < static_cast<std::size_t>(to.count); ++b) {
      const Straight motion(drive, to.places[b].x - from.places[a].x, to.places[b].y - from.places[a].y);
      const double through = motion.within(passage.cell) + to.best[b];
      if (!(through < from.best[a]) || !motion.mayTurn(passage)) continue;
      from.best[a] = through;
      from.next[a] = static_cast<int>(b);
    }
  }
}

std::vector<Passage> passagesOf(const costmap::CostGrid& map, const EdgePath& path) {
  std::vector<Passage> passages;
  const std::size_t n = path.cells.size();
  const auto at = [&](std::size_t k) { return map.at(path.cells[k]); };
  for (std::size_t i = 0; i < n; ++i)
    passages.push_back({at(i), at(i > 0 ? i - 1 : i), at(i + 1 < n ? i + 1 : i)});
  return passages;
}

void slideOnce(const costmap::TravelCost& drive, const std::vector<Passage>& passages, double step,
               std::vector<Choice>& choices, EdgePath& path) {
  const std::size_t n = path.turns.size();
  choices[n - 1] = choiceAround(path.turns[n - 1], kEnd);
  for (std::size_t i = n - 1; i-- > 0;) {
    choices[i] = choiceAround(path.turns[i], i == 0 ? kEnd : step);
    choose(drive, passages[i], choices[i], choices[i + 1]);
  }
  for (std::size_t i = 0, a = 0; i < n; ++i) {
    path.turns[i] = choices[i].places[a];
    a = static_cast<std::size_t>(choices[i].next[a]);
  }
}

}  // namespace

std::vector<maps::Point> EdgePath::points(const maps::Grid& grid) const {
  std::vector<maps::Point> points;
  for (const Turn& turn : turns)
    points.push_back(
        {grid.south_west.x_m + turn.x * grid.resolution_m, grid.south_west.y_m + turn.y * grid.resolution_m});
  return points;
}

void slideTurns(const costmap::CostGrid& map, EdgePath& path, double coarsest_cells, int rounds) {
  if (path.turns.size() < 3) return;
  const auto passages = passagesOf(map, path);
  std::vector<Choice> choices(path.turns.size());
  double step = coarsest_cells;
  for (int k = 0; k < rounds; ++k, step *= kFiner) slideOnce(map.cost(), passages, step, choices, path);
}

}  // namespace talus::planner
