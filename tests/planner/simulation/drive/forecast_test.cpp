// The forecast of a route against drives in worlds that are drawn from the belief of the planner.
#include <algorithm>
#include <cmath>

#include <site_map.hpp>

#include <talus/planner/check/annotation.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/simulation/simulation.hpp>

namespace talus::planner {
namespace forecast_test {

constexpr std::size_t kWorlds = 24;

// Ground of class 1 that rises eastwards and swells.
costmap::TraversabilityMap siteOf(double rise, double swell_m) {
  costmap::MapLayers layers = costmap::drawn(std::vector<std::string>(24, std::string(36, '1')), rise);
  for (int row = 0; row < 24; ++row)
    for (int column = 0; column < 36; ++column)
      layers.elevation.elevation_m[{column, row}] +=
          static_cast<float>(swell_m * std::sin(0.4 * column) * std::cos(0.3 * row));
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  for (costmap::GroundClass& ground : parts.classes) ground.rut_stiffness_std = 1.5;
  return {std::move(layers), std::make_shared<costmap::GroundModel>(std::move(parts)), {}};
}

// Property: of the worlds in which the rover arrives, the mean energy and time are as forecast, and 90 % do not
// exceed the forecast. Tolerances: 3 standard errors of the mean and 3 % for the balance of the yaw moment, which the
// simulator leaves out; 3.3 standard errors of the share.
TEST(Forecast, EnergyAndTimeOfDrivesAreAsForecast) {
  for (const auto& [rise, swell_m] : {std::pair(0.0, 0.0), std::pair(0.06, 0.0), std::pair(0.03, 0.25)}) {
    const auto map = siteOf(rise, swell_m);
    Truth truth;
    truth.as_believed = true;
    const maps::Point start{104.5, 206.5}, goal{130.5, 216.5};
    const SimulationSite site(map, {.truth = truth, .start = start, .goal = goal, .firm = {}, .seed = 3});
    const auto grid = map.published();
    NamedPlanner planner;
    const Plan plan = planner.plan({.map = grid, .start = start, .goal = goal, .prove = false});
    ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
    const RouteSummary forecast = annotated(plan, {.map = *grid, .planner = "field"});
    double sum = 0.0, squares = 0.0, time_s = 0.0, within = 0.0, arrived = 0.0;
    for (const WorldResult& world :
         site.worlds({.belief = SoilKnowledge::Prior, .first = 0, .count = kWorlds})) {
      if (world.drive.outcome != Outcome::Reached) continue;
      arrived += 1.0;
      sum += world.drive.energy_J;
      squares += world.drive.energy_J * world.drive.energy_J;
      time_s += world.drive.time_s;
      within += world.drive.energy_J <= forecast.energy_p90_J ? 1.0 : 0.0;
    }
    ASSERT_GT(arrived, 15.0) << rise;
    const double mean = sum / arrived, error = std::sqrt((squares / arrived - mean * mean) / arrived);
    EXPECT_NEAR(forecast.energy_J, mean, 3.0 * error + 0.03 * mean) << rise << ' ' << swell_m;
    EXPECT_NEAR(forecast.time_s, time_s / arrived,
                3.0 * error / mean * forecast.time_s + 0.03 * forecast.time_s);
    EXPECT_NEAR(within / arrived, 0.9, 3.3 * std::sqrt(0.09 / arrived)) << rise << ' ' << swell_m;
    std::printf("rise %.2f swell %.2f: arrived %.0f, energy %.1f of %.1f kJ, within %.2f\n", rise, swell_m,
                arrived, forecast.energy_J / 1e3, mean / 1e3, within / arrived);
  }
}

}  // namespace forecast_test
}  // namespace talus::planner
