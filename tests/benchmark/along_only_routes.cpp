// Benefit of costs for cross slopes on a real map: routes between random pairs by a planner with
// longitudinal slopes only, judged on the map with both, beside the routes planned on that map. One row for
// each pair; with a folder the routes are written as CSV for `talus score DEM --path`.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <random>
#include <string>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/maps/maps_io.hpp>
#include <talus/planner/planner.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace {

using namespace talus;
using costmap::Refusal;
using costmap::TraversabilityMap;
using planner::Route;
using planner::RouteStatus;

TraversabilityMap mapOf(const maps::ElevationMap& elevation, const char* soil, const char* rover,
                        bool crossing) {
  costmap::MapLayers layers;
  layers.elevation = elevation;
  costmap::GroundModel::Parts ground;
  ground.rover = terramech::loadRover(rover);
  ground.classes = {{.soil = terramech::loadSoil(soil)}};
  ground.prices_crossing = crossing;
  return {std::move(layers), std::make_shared<const costmap::GroundModel>(std::move(ground)), {}};
}

Route planned(const TraversabilityMap& map, maps::Point start, maps::Point goal) {
  PlanRequest request;
  request.start = start;
  request.goal = goal;
  return Planner().plan(map.published(), request);
}

// Shares of a route's length on which a map refuses the heading: for lack of side force, of pull, of either.
struct Refused {
  double side = 0.0, pull = 0.0, any = 0.0;
};

Refused refusedOn(const TraversabilityMap& map, const Route& route) {
  constexpr double kStep_m = 0.05;
  Refused sum;
  double length = 0.0;
  for (std::size_t i = 1; i < route.vertices.size(); ++i) {
    const auto &a = route.vertices[i - 1], &b = route.vertices[i];
    const double metres = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
    if (!(metres > 0.0)) continue;
    const int steps = static_cast<int>(std::ceil(metres / kStep_m));
    for (int k = 0; k < steps; ++k) {
      const double t = (k + 0.5) / steps;
      const auto cell = map.grid().cellAt({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
      if (!cell) continue;
      const Refusal why =
          map.published()
              ->cost()
              .detail(map.published()->at(*cell), {(b.x_m - a.x_m) / metres, (b.y_m - a.y_m) / metres})
              .refusal;
      sum.side += why == Refusal::SideForce ? metres / steps : 0.0;
      sum.pull += why == Refusal::Pull ? metres / steps : 0.0;
      sum.any += why != Refusal::None ? metres / steps : 0.0;
    }
    length += metres;
  }
  return {sum.side / length, sum.pull / length, sum.any / length};
}

void save(const std::string& file, const Route& route) {
  std::ofstream out(file);
  out.precision(12);
  out << "x_m,y_m\n";
  for (const auto& v : route.vertices) out << v.x_m << ',' << v.y_m << '\n';
}

void run(const std::array<const char*, 3>& ground, int pairs, unsigned seed, const std::string& folder) {
  const maps::ElevationMap elevation = maps::readElevation(ground[0], {});
  const TraversabilityMap along = mapOf(elevation, ground[1], ground[2], false),
                          both = mapOf(elevation, ground[1], ground[2], true);
  std::mt19937 random(seed);
  const maps::Grid& grid = both.grid();
  const auto place = [&] {
    return grid.centre({static_cast<int>(random() % static_cast<unsigned>(grid.width)),
                        static_cast<int>(random() % static_cast<unsigned>(grid.height))});
  };
  std::printf("pair  along-only kJ  refused: side force  pull    any     both ways kJ  longer\n");
  int drawn = 0, refused = 0, without = 0;
  for (int tries = 0; drawn < pairs && tries < 50 * pairs; ++tries) {
    const maps::Point start = place(), goal = place();
    const Route before = planned(along, start, goal);
    if (before.status != RouteStatus::Found) continue;
    const Route after = planned(both, start, goal);
    const Refused share = refusedOn(both, before);
    ++drawn;
    refused += share.any > 0.0 ? 1 : 0;
    without += after.status != RouteStatus::Found ? 1 : 0;
    std::printf("%4d  %13.1f  %18.1f %% %5.1f %% %5.1f %%  ", drawn, before.energy_J / 1e3, 100 * share.side,
                100 * share.pull, 100 * share.any);
    if (after.status == RouteStatus::Found)
      std::printf("%12.1f  %5.1f %%\n", after.energy_J / 1e3, 100 * (after.length_m / before.length_m - 1));
    else
      std::printf("%s\n", std::string(name(after.status)).c_str());
    if (folder.empty()) continue;
    save(folder + "/" + std::to_string(drawn) + "_along_only.csv", before);
    if (after.status == RouteStatus::Found) save(folder + "/" + std::to_string(drawn) + "_both.csv", after);
  }
  std::printf("%d pairs, along-only routes with a refused metre: %d, pairs without a route: %d\n", drawn,
              refused, without);
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 6) {
    std::fprintf(stderr, "usage: along_only_routes DEM SOIL ROVER PAIRS SEED [FOLDER]\n");
    return 2;
  }
  try {
    run({arguments[1], arguments[2], arguments[3]}, std::atoi(arguments[4]),
        static_cast<unsigned>(std::atoi(arguments[5])), count > 6 ? arguments[6] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
