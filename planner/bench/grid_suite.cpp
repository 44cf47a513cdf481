#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <queue>
#include <random>
#include <sstream>
#include <stdexcept>
#include <utility>

#include <talus/common/common.hpp>
#include <talus/planner/bench/grid_suite.hpp>

namespace talus::planner {

namespace {

using maps::Cell;
using Walls = maps::Raster<std::uint8_t>;  // 1: blocked

// Coordinates in units of half a cell: odd at cell centres, even at corners.
struct Place {
  int x = 0, y = 0;
};

bool blocked(const Walls& walls, Cell cell) {
  return !walls.grid().contains(cell) || walls[cell] != 0;
}

// Returns true if the open segment between two positions enters no blocked cell; running along a wall is
// allowed. In each column of cells, the cells entered are those whose rows overlap the segment's heights in
// the column. Integer arithmetic only.
bool sees(const Walls& walls, Place a, Place b) {
  if (a.x > b.x) std::swap(a, b);
  const long dx = b.x - a.x, dy = b.y - a.y;
  const auto open = [&](long column, long row) {
    return !blocked(walls, {static_cast<int>(column), static_cast<int>(row)});
  };
  if (dx == 0) {
    const long column = a.x / 2, besides = a.x % 2 == 0 ? column - 1 : column;
    for (long row = std::min(a.y, b.y) / 2; 2 * row < std::max(a.y, b.y); ++row)
      if (!open(column, row) && !open(besides, row)) return false;
    return true;
  }
  const long row_height = 2 * dx;
  for (long column = a.x / 2; 2 * column < b.x; ++column) {
    const auto height = [&](long x) { return a.y * dx + (std::clamp<long>(x, a.x, b.x) - a.x) * dy; };
    const auto [least, most] = std::minmax({height(2 * column), height(2 * column + 2)});
    if (least == most && least % row_height == 0) {  // along a row of corners
      if (!open(column, least / row_height) && !open(column, least / row_height - 1)) return false;
      continue;
    }
    for (long row = least / row_height; row * row_height < most || row * row_height < least + 1; ++row)
      if (!open(column, row)) return false;
  }
  return true;
}

// Corners at which a shortest path may turn: exactly one of the four surrounding cells is blocked.
std::vector<Place> bends(const Walls& walls) {
  std::vector<Place> found;
  const maps::Grid& grid = walls.grid();
  for (int row = 1; row < grid.height; ++row)
    for (int column = 1; column < grid.width; ++column) {
      const int around = blocked(walls, {column - 1, row - 1}) + blocked(walls, {column, row - 1}) +
                         blocked(walls, {column - 1, row}) + blocked(walls, {column, row});
      if (around == 1) found.push_back({2 * column, 2 * row});
    }
  return found;
}

double apart_m(Place a, Place b) {
  return 0.5 * std::hypot(a.x - b.x, a.y - b.y);
}

// Dijkstra's algorithm over the positions, each connected to all positions visible from it.
double shortest_m(const Walls& walls, const std::vector<Place>& places, std::size_t from, std::size_t to) {
  std::vector<double> best(places.size(), kInfinity);
  std::vector<bool> done(places.size());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  best[from] = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const std::size_t at = open.top().second;
    open.pop();
    if (done[at]) continue;
    if (at == to) return best[to];
    done[at] = true;
    for (std::size_t next = 0; next < places.size(); ++next) {
      const double through = best[at] + apart_m(places[at], places[next]);
      if (done[next] || through >= best[next] || !sees(walls, places[at], places[next])) continue;
      best[next] = through;
      open.emplace(through, next);
    }
  }
  return kInfinity;
}

Walls wallsOf(const costmap::CostGrid& map) {
  Walls walls(map.grid());
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column)
      walls[{column, row}] = map.at({column, row}).curve() >= costmap::CellCode::kUnknown;
  return walls;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }

 private:
  std::mt19937_64 engine_;
};

// Places random blocks until their areas sum to a fifth of the map. The sum
// includes overlaps and areas beyond the map's border.
Walls blocks(const maps::Grid& grid, Random& random) {
  Walls walls(grid);
  const int largest = std::max(2, grid.width / 6);
  for (int covered = 0; covered * 5 < grid.width * grid.height;) {
    const Cell low{random.below(grid.width), random.below(grid.height)};
    const int width = 1 + random.below(largest), height = 1 + random.below(largest);
    covered += width * height;
    for (int row = low.row; row < std::min(grid.height, low.row + height); ++row)
      for (int column = low.column; column < std::min(grid.width, low.column + width); ++column)
        walls[{column, row}] = 1;
  }
  return walls;
}

// Square rooms with walls one cell thick; each wall between two rooms has a door of one to three cells.
Walls rooms(const maps::Grid& grid, Random& random) {
  Walls walls(grid);
  const int room = std::max(7, grid.width / 8);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      walls[{column, row}] = row % room == room - 1 || column % room == room - 1;
  for (int y = 0; y < grid.height; y += room)
    for (int x = 0; x < grid.width; x += room)
      for (const bool east : {true, false}) {
        const int wide = 1 + random.below(3), at = 1 + random.below(room - 2 - wide);
        for (int k = 0; k < wide; ++k) {
          const Cell door = east ? Cell{x + room - 1, y + at + k} : Cell{x + at + k, y + room - 1};
          if (grid.contains(door)) walls[door] = 0;
        }
      }
  return walls;
}

// Fills blocked cells that meet only at a corner: a passage through a single point is not drivable.
void closeDiagonals(Walls& walls) {
  const maps::Grid& grid = walls.grid();
  for (bool changed = true; changed;) {
    changed = false;
    for (int row = 0; row + 1 < grid.height; ++row)
      for (int column = 0; column + 1 < grid.width; ++column) {
        auto &a = walls[{column, row}], &b = walls[{column + 1, row}], &c = walls[{column, row + 1}],
             &d = walls[{column + 1, row + 1}];
        if (a == d && b == c && a != b) {
          a = b = c = d = 1;
          changed = true;
        }
      }
  }
}

}  // namespace

double shortestAroundWalls_m(const costmap::CostGrid& map, Cell from, Cell to) {
  const Walls walls = wallsOf(map);
  auto places = bends(walls);
  places.push_back({2 * from.column + 1, 2 * from.row + 1});
  places.push_back({2 * to.column + 1, 2 * to.row + 1});
  return map.grid().resolution_m * shortest_m(walls, places, places.size() - 2, places.size() - 1);
}

std::vector<BenchmarkCase> gridCases(int side, int pairs, std::uint64_t seed) {
  if (side < 16) throw std::invalid_argument("grids: side = " + std::to_string(side) + ", must be >= 16");
  if (pairs < 1) throw std::invalid_argument("grids: pairs = " + std::to_string(pairs) + ", must be > 0");
  const maps::Grid grid{.width = side, .height = side, .resolution_m = 1.0, .south_west = {0.0, 0.0}};
  Random random(seed);
  std::vector<BenchmarkCase> cases;
  for (const bool blocky : {true, false}) {
    Walls walls = blocky ? blocks(grid, random) : rooms(grid, random);
    closeDiagonals(walls);
    const auto map = evenGround(walls);
    int made = 0;
    for (int tries = 0; tries < 1000 && made < pairs; ++tries) {
      const Cell from{random.below(side), random.below(side)}, to{random.below(side), random.below(side)};
      if (walls[from] || walls[to] || std::hypot(to.column - from.column, to.row - from.row) < side / 2.0)
        continue;
      const double optimum_m = shortestAroundWalls_m(*map, from, to);
      if (std::isinf(optimum_m)) continue;
      cases.push_back({.name = (blocky ? "blocks " : "rooms ") + std::to_string(++made),
                       .map = map,
                       .start = grid.centre(from),
                       .goal = grid.centre(to),
                       .optimum_J = optimum_m});
    }
  }
  return cases;
}

namespace {

struct Scenario {
  std::string map;
  int width = 0, height = 0, start_x = 0, start_y = 0, goal_x = 0, goal_y = 0;
  double optimum = 0.0;
};

std::shared_ptr<const costmap::TravelCost> flatCost() {
  const costmap::TravelCurve curve(std::vector<float>(costmap::TravelCurve::kBins, 1.0F));
  return std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curve});
}

[[noreturn]] void refuse(const std::string& path, std::size_t line, const std::string& reason) {
  throw InputError({path + ":" + std::to_string(line), reason, "see movingai.com/benchmarks/formats.html"});
}

// Opens a regular file; the stream fails for other files, because opening a FIFO would block.
std::ifstream opened(const std::string& path) {
  checkInput(path);
  std::error_code error;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, error))
    file.open(path);
  else
    file.setstate(std::ios::failbit);
  return file;
}

std::shared_ptr<const costmap::CostGrid> readMap(const std::string& path) {
  std::ifstream file = opened(path);
  if (!file) throw InputError({path, "cannot be read", "put the scenario's map beside it"});
  std::string word, type;
  maps::Grid grid;
  file >> word >> type >> word >> grid.height >> word >> grid.width >> word;
  if (!file || word != "map" || grid.width < 1 || grid.height < 1 || grid.size() > 100'000'000)
    refuse(path, 4, "no MovingAI header (type, height, width, map)");
  maps::Raster<std::uint8_t> walls(grid, 1);
  std::string row;
  std::getline(file, row);
  for (int r = 0; r < grid.height; ++r) {
    if (!std::getline(file, row) || row.size() < static_cast<std::size_t>(grid.width))
      refuse(path, static_cast<std::size_t>(r) + 5, "a row shorter than the width");
    for (int c = 0; c < grid.width; ++c)
      if (std::string(".GS").find(row[static_cast<std::size_t>(c)]) != std::string::npos)
        walls[{c, grid.height - 1 - r}] = 0;
  }
  return evenGround(walls);
}

std::vector<Scenario> readScenarios(const std::string& path) {
  std::ifstream file = opened(path);
  std::string line;
  if (!file || !std::getline(file, line))
    throw InputError({path, "cannot be read", "name a MovingAI .scen file"});
  if (!line.starts_with("version")) refuse(path, 1, "no 'version' line");
  std::vector<Scenario> all;
  for (std::size_t n = 2; std::getline(file, line); ++n) {
    if (line.empty()) continue;
    std::istringstream words(line);
    Scenario s;
    int bucket = 0;
    words >> bucket >> s.map >> s.width >> s.height >> s.start_x >> s.start_y >> s.goal_x >> s.goal_y >>
        s.optimum;
    if (!words) refuse(path, n, "not a scenario of nine fields");
    all.push_back(std::move(s));
  }
  if (all.empty()) refuse(path, 1, "no scenario");
  return all;
}

std::string mapBeside(const std::string& scenario_path, const std::string& map) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path folder = fs::path(scenario_path).parent_path();
  const fs::path own = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  const auto leads_out = [&](const fs::path& file) {
    const fs::path from = fs::weakly_canonical(file, error).lexically_relative(own);
    return error || from.empty() || *from.begin() == "..";
  };
  const fs::path named = folder / map, beside = folder / fs::path(map).filename();
  const fs::path& found = fs::exists(named, error) && !leads_out(named) ? named : beside;
  if ((fs::exists(found, error) && leads_out(found)) || (!fs::exists(found, error) && leads_out(named)))
    throw InputError({scenario_path, "names the map '" + map.substr(0, 80) + "' outside of its folder",
                      "put the scenario's map beside it"});
  return found.string();
}

}  // namespace

std::shared_ptr<const costmap::CostGrid> evenGround(const maps::Raster<std::uint8_t>& walls) {
  maps::Raster<costmap::CellCode> cells(walls.grid());
  for (std::size_t i = 0; i < walls.values().size(); ++i)
    cells.values()[i] = costmap::CellCode(
        {.curve = walls.values()[i] == 0 ? costmap::CellCode::Curve{0} : costmap::CellCode::kBlocked});
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, flatCost()));
}

std::vector<BenchmarkCase> readMovingAi(const std::string& scenario_path, std::size_t most) {
  const std::vector<Scenario> all = readScenarios(scenario_path);
  const auto map = readMap(mapBeside(scenario_path, all.front().map));
  const maps::Grid& grid = map->grid();
  std::vector<BenchmarkCase> cases;
  const std::size_t count = std::min(most, all.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Scenario& s = all[count == 1 ? 0 : i * (all.size() - 1) / (count - 1)];
    const maps::Cell start{s.start_x, grid.height - 1 - s.start_y};
    const maps::Cell goal{s.goal_x, grid.height - 1 - s.goal_y};
    if (s.map != all.front().map || !grid.contains(start) || !grid.contains(goal))
      refuse(scenario_path, i + 2, "another map, or a place outside it");
    cases.push_back({.name = std::filesystem::path(s.map).stem().string() + " " + std::to_string(i + 1),
                     .map = map,
                     .start = grid.centre(start),
                     .goal = grid.centre(goal),
                     .optimum_J = s.optimum});
  }
  return cases;
}

}  // namespace talus::planner
