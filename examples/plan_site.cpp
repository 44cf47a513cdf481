// Shows   planning on a site of files after a drive. Needs talus::site.
// Prints  rows learned, length, energy and proven gap of the route, and its vertices.
// Files   talus generate rocks --size 330x140 -o hill.tif; echo '{}' >truth.yaml
//         talus drive hill.tif --terrain hill_classes.tif --soils hill_soils.yaml --rover mer --truth truth.yaml
//         --start 12,30 --goal 60,50 --telemetry drive.csv   (on the same line)
#include <cstdio>
#include <exception>
#include <utility>

#include <talus/talus.hpp>

int main() try {
  talus::Site site = talus::readSite(
      {.elevation = "hill.tif", .classes = "hill_classes.tif", .soils = "hill_soils.yaml", .rover = "mer"});
  talus::Map map(std::move(site));  // hazards, ground of each class, cost
  const talus::LearnReport learned = map.learn(talus::readTelemetry("drive.csv"));
  std::printf("%zu rows used, %zu may raise an estimate\n", learned.used, learned.raising);

  talus::Planner planner;  // keeps its data between calls
  const talus::Route route =
      planner.plan(map, {.start = {12, 30}, .goal = {310, 120}, .tolerance_m = 0.5, .prove = true});
  if (!route.found()) return std::printf("%s\n", route.reason.c_str()), 1;
  std::printf("%.0f m, %.0f J, at most %.1f %% above the best\n", route.length_m, route.energy_J,
              100 * route.gap);
  for (const talus::RouteVertex& v : route.vertices)
    std::printf("%.2f %.2f %.3f\n", v.x_m, v.y_m, v.heading_rad);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
