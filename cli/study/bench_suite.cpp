#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include <talus/cli/app/context.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/common/input_error.hpp>
#include <talus/costmap/ground/ground_class.hpp>
#include <talus/maps/sites/site_generator.hpp>
#include <talus/planner/bench/grid_suite.hpp>
#include <talus/planner/bench/moving_ai.hpp>
#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/kinematics.hpp>
#include <talus/terramech/io/soil_library.hpp>

namespace talus::cli {
namespace {

using planner::BenchmarkCase;

maps::Point anywhere(const maps::Grid& grid, std::mt19937_64& random) {
  const auto pick = [&random](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  const int column = pick(grid.width);
  return grid.centre({column, pick(grid.height)});
}

// Distant places between which the field planner finds a route; fewer than `count` if the map has few such
// places.
std::vector<BenchmarkCase> pairsOn(const std::string& name,
                                   const std::shared_ptr<const costmap::CostGrid>& map, int count,
                                   std::uint64_t seed) {
  const maps::Grid& grid = map->grid();
  const double least_m = 0.5 * grid.resolution_m * std::hypot(grid.width, grid.height);
  std::mt19937_64 random(seed);
  planner::FieldPlanner field;
  std::vector<BenchmarkCase> cases;
  // Limits the unsuccessful field searches: drawing places is fast, but each search without a route covers
  // the whole map.
  int in_vain = 0;
  for (int tries = 0; tries < 1000 && in_vain < 20 && static_cast<int>(cases.size()) < count; ++tries) {
    planner::Problem problem;
    problem.map = map;
    problem.prove = false;
    problem.start = anywhere(grid, random);
    problem.goal = anywhere(grid, random);
    if (std::hypot(problem.goal.x_m - problem.start.x_m, problem.goal.y_m - problem.start.y_m) < least_m)
      continue;
    const planner::MotionCost cost(map);
    if (!cost.allowed(problem.start) || !cost.allowed(problem.goal)) continue;
    if (field.plan(problem).status != planner::RouteStatus::Found) {
      ++in_vain;
      continue;
    }
    cases.push_back({.name = name + " " + std::to_string(cases.size() + 1),
                     .map = map,
                     .start = problem.start,
                     .goal = problem.goal});
  }
  return cases;
}

// Assigns the rover's kinematics, with the option's turning radius, to the cases.
void giveKinematics(std::vector<BenchmarkCase>& cases, const costmap::GroundModel& model,
                    const SuiteOptions& options) {
  for (BenchmarkCase& made : cases) {
    made.kinematics = planner::kinematicsOn(model, made.map->cost());
    if (options.turning_radius_m >= 0.0) made.kinematics.turning_radius_m = options.turning_radius_m;
  }
}

std::shared_ptr<const costmap::GroundModel> generatedGround() {
  costmap::GroundModel::Parts parts;
  parts.rover = terramech::loadRover("mer");
  const std::array soils{std::pair{maps::SiteClass::Firm, "mars_crusty"},
                         std::pair{maps::SiteClass::Loose, "sand"},
                         std::pair{maps::SiteClass::VeryLoose, "mars_drift"}};
  for (const auto& [site_class, soil] : soils)
    parts.classes.push_back(
        costmap::groundClass(static_cast<int>(site_class), terramech::loadSoilPrior(soil), parts.rover));
  return std::make_shared<const costmap::GroundModel>(std::move(parts));
}

std::vector<BenchmarkCase> generatedCases(const SuiteOptions& options, const Context& context) {
  std::vector<BenchmarkCase> cases;
  const auto model = generatedGround();
  for (const auto& [kind, name] :
       {std::pair{maps::SiteKind::Craters, "craters"}, std::pair{maps::SiteKind::Dunes, "dunes"},
        std::pair{maps::SiteKind::Rocks, "rocks"}}) {
    maps::Site site = maps::generateSite({.kind = kind,
                                          .width = options.side_cells,
                                          .height = options.side_cells,
                                          .resolution_m = 1.0,
                                          .seed = context.seed});
    costmap::MapLayers layers;
    layers.elevation = std::move(site.map);
    layers.classes = std::move(site.classes);
    layers.rock_abundance = std::move(site.rock_abundance);
    const auto map = costmap::TraversabilityMap(std::move(layers), model, {}).published();
    for (BenchmarkCase& made : pairsOn(name, map, options.pairs, context.seed))
      cases.push_back(std::move(made));
  }
  giveKinematics(cases, *model, options);
  return cases;
}

// Each world yields two cases: planned with the mean slip of the visible terrain, and with the tail of the
// slip distribution.
std::vector<BenchmarkCase> slipCases(const SuiteOptions& options, const Context& context) {
  std::vector<BenchmarkCase> cases;
  for (int k = 1; k <= options.pairs; ++k)
    for (const bool risk_aware : {false, true}) {
      const auto world = std::make_shared<const planner::SlipWorld>(planner::slipWorld(
          {.seed = context.seed * 1000 + static_cast<std::uint64_t>(k), .risk_aware = risk_aware}));
      const maps::Grid& grid = world->map->grid();
      const std::string group = risk_aware ? "slip tail" : "slip mean";
      cases.push_back({.name = group + " " + std::to_string(k),
                       .map = world->map,
                       .start = grid.centre({8, 8}),
                       .goal = grid.centre({grid.width - 9, grid.height - 9}),
                       .kinematics = {.turning_radius_m = std::max(0.0, options.turning_radius_m)},
                       .world = world,
                       .group = group});
    }
  return cases;
}

std::vector<BenchmarkCase> mapCases(const std::string& path, const SuiteOptions& options,
                                    const Context& context) {
  GroundOptions ground = options.ground;
  ground.elevation.path = path;
  const Ground read = readGround(ground, context);
  auto cases =
      pairsOn(std::filesystem::path(path).stem().string(), read.map.published(), options.pairs, context.seed);
  if (static_cast<int>(cases.size()) < options.pairs)
    context.warn(path + ": " + std::to_string(cases.size()) +
                 " pairs of distant places with a route between them, fewer than requested");
  giveKinematics(cases, read.map.model(), options);
  return cases;
}

std::vector<BenchmarkCase> casesOf(const std::string& name, const SuiteOptions& options,
                                   const Context& context) {
  if (name == "generated") return generatedCases(options, context);
  if (name == "slip") return slipCases(options, context);
  if (name == "grids") return planner::gridCases(64, options.pairs, context.seed);
  if (name.ends_with(".scen")) return planner::readMovingAi(name, static_cast<std::size_t>(options.pairs));
  return mapCases(name, options, context);
}

bool isMap(const std::string& name) {
  return name != "generated" && name != "slip" && name != "grids" && !name.ends_with(".scen");
}

void refuseUnusedGround(const SuiteOptions& options) {
  const GroundOptions& g = options.ground;
  const bool given = !g.soil.empty() || !g.soils.empty() || !g.model.empty() || !g.rover.empty() ||
                     !g.classes.empty() || !g.rocks.empty() || !g.keep_out.empty();
  if (given && std::ranges::none_of(options.names, isMap))
    throw InputError({"talus bench", "a soil, rover or layer is given without an elevation map",
                      "name a map; the other suites have their own terrain"});
}

}  // namespace

std::vector<BenchmarkCase> suiteCases(const SuiteOptions& options, const Context& context) {
  refuseUnusedGround(options);
  std::vector<BenchmarkCase> all;
  std::set<std::string> names;
  for (const std::string& name : options.names)
    for (BenchmarkCase& made : casesOf(name, options, context)) {
      // Maps in different folders may have the same name; log files are named after cases.
      std::string unique = made.name;
      for (int k = 2; !names.insert(unique).second; ++k) unique = made.name + " of map " + std::to_string(k);
      made.name = unique;
      all.push_back(std::move(made));
    }
  return all;
}

}  // namespace talus::cli
