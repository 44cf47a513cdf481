#include <filesystem>
#include <fstream>
#include <sstream>

#include <talus/common/input_error.hpp>
#include <talus/common/input_file.hpp>
#include <talus/planner/bench/moving_ai.hpp>

namespace talus::planner {
namespace {

struct Scenario {
  std::string map;
  int width = 0, height = 0, start_x = 0, start_y = 0, goal_x = 0, goal_y = 0;
  double optimum = 0.0;
};

std::shared_ptr<const costmap::TravelCost> flatCost() {
  costmap::TravelCurve curve{};
  curve.cost_J_per_m.fill(1.0F);
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
