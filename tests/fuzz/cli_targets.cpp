#include <algorithm>
#include <sstream>

#include <CLI/CLI.hpp>

#include <talus/cli/app/options.hpp>
#include <talus/cli/app/output_file.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/cli/route/route_reader.hpp>
#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

#include "targets.hpp"

namespace talus::fuzz {
namespace {

// A call of one word a line, up to the work: nothing is read or written.
void readOptions(const std::string& bytes) {
  CLI::App app;
  cli::PlanOptions plan;
  std::uint64_t seed = 0, memory = 0;
  int threads = 0;
  cli::addGroundOptions(app, plan.ground);
  cli::addMotionOptions(app, plan.drive);
  cli::addOutput(app, "-o,--output", plan.output);
  app.add_option("--start", plan.start);
  app.add_option("--seed", seed)->check(cli::notNegative());
  app.add_option("--threads", threads)->check(CLI::Range(1, 1024));
  app.add_option("--max-memory", memory)->transform(CLI::AsSizeValue(false));
  std::vector<std::string> words;
  std::istringstream lines(bytes);
  for (std::string word; std::getline(lines, word);) words.push_back(word);
  std::reverse(words.begin(), words.end());
  try {
    app.parse(std::move(words));
  } catch (const CLI::Error& error) {
    throw InputError({"call", error.what(), ""});
  }
  cli::checkNumbers(app);
  if (!plan.start.empty()) maps::parsePlace(plan.start);
  if (!plan.ground.elevation.window.empty()) maps::parseWindow(plan.ground.elevation.window);
}

void readMissionFile(const std::string& bytes) {
  cli::PlanOptions options;
  options.ground.elevation.path = fileOf(bytes, ".yaml");
  cli::readMission(options);
}

}  // namespace

std::vector<Target> cliTargets() {
  return {
      {"options",
       {"dem.tif\n--resolution\n0.5\n--window\n0,0,5,5\n--start\n-4.59d,137.44d\n--seed\n7\n",
        "m.ot\n--start=5,5\n--goal-heading\n1.5\n--max-memory\n4GB\n--threads\n2\n-o\nr.json\n"},
       readOptions},
      {"mission",
       {"maps: {dem: dem.asc, resolution_m: 1, ignore_crs: true}\nsoil: s\nrover: r\nstart: [5, 20]\n"
        "goal: [[25, 20], [3, 4]]\nthresholds: {slope_margin_rad: 0.1, allow_unknown: true}\n"},
       readMissionFile},
      {"truth",
       {"patches:\n  - {x_m: 15, y_m: 20, radius_m: 2, soil: dry_sand}\nrandom: {spread: 0.1, patches: 1}\n"
        "effects:\n  - {name: slip_sinkage_ding, parameters: [0.4]}\n"},
       [](const std::string& bytes) { cli::readTruth(fileOf(bytes, ".yaml")); }},
      {"path",
       {"x_m,y_m\n5,2\n15,2\n", R"({"type":"LineString","crs":"local","coordinates":[[1,1],[5,1]]})"},
       [](const std::string& bytes) {
         cli::readPath(fileOf(bytes, bytes.starts_with('{') ? ".geojson" : ".csv"), flatMap());
       }},
      {"route",
       {},
       [](const std::string& bytes) { cli::readRoute(fileOf(bytes, ".geojson")); },
       {R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"x_m":[1,2],"y_m":[1,2],)"
        R"("elevation_m":[0,0],"heading_rad":[0,0],"slip":[0,0],"category":["safe","safe"],"inputs":[],"summary":{}},)"
        R"("geometry":{"type":"LineString","coordinates":[[1,1],[2,2]]}}]})"}},
  };
}

}  // namespace talus::fuzz
