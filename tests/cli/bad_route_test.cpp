// Invalid calls of plan, bench and view.
#include "bad_input.hpp"

namespace talus::cli {
namespace bad_route_test {

using Words = std::vector<std::string>;

/// A call of `talus plan` on a map of the folder.
Words plan(const std::string& map, const Words& more) {
  return joined({"plan", map, "--resolution", "1", "--soil", "sandy_loam", "--rover", "fido"}, more);
}

/// The same between two places of a good map.
Words route(const Words& more) {
  return plan("good.asc", joined({"--start", "5,5", "--goal", "9,9"}, more));
}

TEST(BadInput, InvalidPlanCallsAreRejectedWithOneLine) {
  const BadFiles files;
  expectRefused(files,
                {
                    {plan("good.asc", {"--start", "5,5"}), 2, "--goal"},
                    {plan("good.asc", {"--goal", "5,5"}), 2, "--start"},
                    {plan("good.asc", {"--start", "5;5", "--goal", "9,9"}), 2, "5;5"},
                    {plan("good.asc", {"--start", "nan,5", "--goal", "9,9"}), 2, "nan,5"},
                    {plan("good.asc", {"--start", "5d,5d", "--goal", "9,9"}), 2, "CRS"},
                    {plan("good.asc", {"--start", "-5,5", "--goal", "9,9"}), 2, "outside"},
                    {plan("good.asc", {"--start", "5,5", "--goal", "64.1,9"}), 2, "outside"},
                    {plan("good.asc", {"--start", "text.json", "--goal", "9,9"}), 2, "text.json"},
                    {plan("good.asc", {"--start", "point_less.json", "--goal", "9,9"}), 2, "point_less.json"},
                    {plan("fortress.asc", {"--start", "27.5,31.5", "--goal", "5,5"}), 2,
                     "the nearest traversable cell"},
                    {plan("fortress.asc", {"--start", "5,5", "--goal", "27.5,31.5"}), 2, "goal"},
                    {plan("fortress.asc", {"--start", "5,5", "--goal", "31.5,31.5"}), 1, ""},
                    {plan("one.asc", {"--start", "0.5,0.5", "--goal", "0.5,0.5"}), 2, ""},
                    {plan("nodata.asc", {"--start", "5,5", "--goal", "9,9"}), 2, "nodata.asc"},
                    {route({"--planner", "feild"}), 2, "field"},
                    {route({"--planner", "prmstar"}), 2, "PRMstar"},
                    {route({"--time", "-1"}), 2, "--time"},
                    {route({"-o", "no/r.geojson"}), 2, "no does not exist"},
                    {route({"-o", "folder"}), 2, "is a directory"},
                    {route({"--html", "no/r.html"}), 2, "no does not exist"},
                    {route({"--png", "folder"}), 2, "is a directory"},
                    {route({"--map", "garbage.ot"}), 2, "garbage.ot"},
                    {route({"--map", "head.ot"}), 2, "head.ot"},
                    {route({"--terrain", "garbage.tif"}), 2, "garbage.tif"},
                    {route({"--rocks", "missing.tif"}), 2, "missing.tif"},
                    {route({"--keep-out", "text.json"}), 2, "text.json"},
                    {route({"--keep-out", "point_less.json"}), 2, "point_less.json"},
                    {route({"--soils", "list.yaml"}), 2, "list.yaml"},
                    {route({"--footprint", "nan"}), 2, "--footprint"},
                    {route({"--risk-weight", "nan"}), 2, "--risk-weight"},
                    {route({"--slope-uncertainty-deg", "200"}), 2, "slope_margin_rad"},
                    {route({"-o", "r.gpx"}), 2, "the map has no CRS"},
                    {route({"-o", "r.kml"}), 2, "the map has no CRS"},
                    {route({"-o", "r.shp"}), 2, "is named .shp"},
                    {plan("good.asc", {"--start", "garbage.tif", "--goal", "9,9"}), 2, "garbage.tif"},
                    {route({"--keep-out", "garbage.tif"}), 2, "GDAL opens no vector file"},
                    {{"plan", "missing.yaml"}, 2, "missing.yaml"},
                    {{"plan", "garbage.yaml"}, 2, "garbage.yaml"},
                    {{"plan", "unknown_key.yaml"}, 2, "unknown_key.yaml"},
                });
}

TEST(BadInput, InvalidSoilsAndRoversAreRejectedWithOneLine) {
  const BadFiles files;
  std::vector<BadCall> calls;
  for (const char* option : {"--soil", "--rover", "--soils"}) {
    for (const char* file :
         {"garbage.yaml", "unknown_key.yaml", "open.yaml", "list.yaml", "nan.yaml", "empty", "folder"})
      calls.push_back(
          {{"plan", "good.asc", "--resolution", "1", "--start", "5,5", "--goal", "9,9", option, file},
           2,
           file});
    calls.push_back(
        {{"plan", "good.asc", "--resolution", "1", "--start", "5,5", "--goal", "9,9", option, "no_such"},
         2,
         "no_such"});
  }
  expectRefused(files, calls);
}

TEST(BadInput, InvalidBenchCallsAreRejectedWithOneLine) {
  const BadFiles files;
  expectRefused(files,
                {
                    {{"bench", "nosuite"}, 2, "nosuite: no such file"},
                    {{"bench", "none.scen"}, 2, "none.scen"},
                    {{"bench", "empty.csv"}, 2, "empty.csv"},
                    {{"bench", "garbage.tif"}, 2, "garbage.tif"},
                    {{"bench", "folder"}, 2, "is a directory"},
                    {{"bench", "good.asc"}, 2, "--resolution"},
                    {{"bench", "nodata.asc", "--resolution", "1"}, 2, "nodata.asc"},
                    {{"bench", "one.asc", "--resolution", "1"}, 2, "no slope"},
                    {{"bench", "grids", "nosuite"}, 2, "nosuite"},
                    {{"bench", "grids", "grids"}, 2, "named twice"},
                    {{"bench", "grids", "--planners", "field,Field"}, 2, "planner field: is named twice"},
                    {{"bench", "grids", "--planners", "feild"}, 2, "nearest is 'field'"},
                    {{"bench", "grids", "--planners", "PRM*"}, 2, "PRMstar"},
                    {{"bench", "grids", "--planners", "field:cold"}, 2, "only those begin cold"},
                    {{"bench", "grids", "--planners", "RRT*:speed=3"}, 2, "speed"},
                    {{"bench", "grids", "--runs", "-1"}, 2, "-1, must be finite, > 0"},
                    {{"bench", "grids", "--pairs", "0"}, 2, "0, must be finite, > 0"},
                    {{"bench", "grids", "--pairs", "99999999999"}, 2, "--pairs"},
                    {{"bench", "grids", "--time", "nan"}, 2, "nan, must be finite, > 0"},
                    {{"bench", "grids", "--time", "-2"}, 2, "--time"},
                    {{"bench", "grids", "--seed", "-1"}, 2, "--seed"},
                    {{"bench", "grids", "--side", "3"}, 2, "--side"},
                    {{"bench", "grids", "--soil", "nope"}, 2, "without an elevation map"},
                    {{"bench", "good.asc", "--resolution", "1", "--soil", "nope"}, 2, "nope"},
                    {{"bench", "grids", "-o", "good.asc"}, 2, "good.asc"},
                    {{"bench", "grids", "-o", "good.asc/out"}, 2, "cannot be created"},
                    {{"bench", "grids", "-o", "/proc/talus"}, 2, "cannot be created"},
                });
}

TEST(BadInput, InvalidViewCallsAreRejectedWithOneLine) {
  const BadFiles files;
  expectRefused(files,
                {
                    {{"view"}, 2, "FILE"},
                    {{"view", "missing.geojson"}, 2, "missing.geojson"},
                    {{"view", "text.json"}, 2, "text.json"},
                    {{"view", "point_less.json"}, 2, "point_less.json"},
                    {{"view", "no_route.geojson"}, 2, "no_route.geojson: 'y_m' has 1 values for 2 vertices"},
                    {{"view", "garbage.ot"}, 2, "garbage.ot"},
                    {{"view", "head.ot"}, 2, "head.ot"},
                    {{"view", "garbage.tif"}, 2, "garbage.tif"},
                    {{"view", "folder"}, 2, "folder"},
                    {{"view", "good.asc", "--resolution", "1", "-o", "no/page.html"}, 2, "no does not exist"},
                    {{"view", "good.asc", "--resolution", "1", "--png", "folder"}, 2, "is a directory"},
                });
}

}  // namespace bad_route_test
}  // namespace talus::cli
