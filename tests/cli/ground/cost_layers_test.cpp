#include <algorithm>
#include <cstdlib>
#include <functional>

#include <nlohmann/json.hpp>

#include "bad_input.hpp"
#include "beyond_memory.hpp"

namespace talus::cli {
namespace cost_layers_test {

using nlohmann::json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

constexpr int kWidth = 40, kHeight = 24;

// An ASCII raster with the text value(column, row), counted from the south-west.
std::string raster(const std::function<std::string(int, int)>& value) {
  std::string text = "ncols 40\nnrows 24\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  for (int row = kHeight - 1; row >= 0; --row) {
    for (int column = 0; column < kWidth; ++column) text += value(column, row) + ' ';
    text += '\n';
  }
  return text;
}

// Level ground and cost layers: 20 J/m everywhere; a wall with a gap in the north of high cost, refused, or
// no data.
class CostLayers : public testing::Test {
 protected:
  CostLayers() {
    const auto wall = [](const std::string& there) {
      return raster([there](int c, int r) { return c >= 18 && c < 22 && r < 18 ? there : std::string("0"); });
    };
    folder.write("dem.asc", raster([](int, int) { return "0"; }));
    folder.write("shadow.asc", raster([](int, int) { return "20"; }));
    folder.write("dear.asc", wall("100000"));
    folder.write("refused.asc", wall("inf"));
    folder.write("unseen.asc", raster([](int c, int r) {
                   return c >= 18 && c < 22 && r < 18 ? "-9999" : c == 39 ? "100000" : "0";
                 }));
    folder.write("straight.csv", "x_m,y_m\n5.5,5.5\n35.5,5.5\n");
  }

  Ran run(const std::string& call, const Words& more) const {
    return runTalus(joined({call, "dem.asc", "--quiet", "--ignore-crs", "--resolution", "1", "--soil",
                            "sandy_loam", "--rover", "fido", "--json"},
                           more),
                    folder.path());
  }
  json score(const Words& more, int code = 0) const {
    const Ran ran = run("score", joined({"--path", "straight.csv"}, more));
    EXPECT_EQ(ran.code, code) << ran.err;
    return json::parse(ran.out);
  }
  json plan(const Words& more) const {
    const Ran ran = run("plan", joined({"--start", "5.5,5.5", "--goal", "35.5,5.5"}, more));
    EXPECT_EQ(ran.code, 0) << ran.err;
    return ran.code == 0 ? json::parse(ran.out) : json();
  }

  const Folder folder;
};

// Closed form: 30 m at 20 J/m and at 40 J/m.
TEST_F(CostLayers, LayerCostIsAddedToCostAndEnergy) {
  const json plain = score({}), shadow = score({"--layer", "shadow=shadow.asc"}),
             both = score({"--layer", "shadow=shadow.asc", "--layer", "radio=shadow.asc"});
  EXPECT_NEAR(shadow["cost"].get<double>() - plain["cost"].get<double>(), 600.0, 1e-2);
  EXPECT_NEAR(shadow["energy_J"].get<double>() - plain["energy_J"].get<double>(), 600.0, 1e-2);
  EXPECT_NEAR(both["cost"].get<double>() - plain["cost"].get<double>(), 1200.0, 1e-2);
  EXPECT_LE(both["lower_bound"].get<double>(), both["cost"].get<double>());
  EXPECT_GT(both["lower_bound"].get<double>(), plain["lower_bound"].get<double>() + 1000.0);
}

TEST_F(CostLayers, RoutesAvoidExpensiveAndRefusedCells) {
  const json plain = plan({});
  EXPECT_NEAR(plain["length_m"].get<double>(), 30.0, 1e-6);
  for (const char* layer : {"wall=dear.asc", "wall=refused.asc", "wall=unseen.asc"}) {
    const json around = plan({"--layer", layer});
    EXPECT_GT(around["length_m"].get<double>(), 38.0) << layer;
    EXPECT_LE(around["lower_bound"].get<double>(), around["cost"].get<double>());
  }
}

TEST_F(CostLayers, ScoreDetectsRefusedCells) {
  for (const char* layer : {"wall=refused.asc", "wall=unseen.asc"}) {
    const json held = score({"--layer", layer}, 1);
    EXPECT_EQ(held["status"], "infeasible");
    EXPECT_FALSE(held["violations"].empty());
  }
  EXPECT_THAT(run("explain", {"--at", "20,5", "--layer", "wall=refused.asc"}).out,
              HasSubstr("refused by layer 'wall'"));
}

TEST_F(CostLayers, NoDataCellsCostTheMaximumIfUnknownIsAllowed) {
  const json dear = score({"--allow-unknown", "--layer", "wall=dear.asc"}),
             unseen = score({"--allow-unknown", "--layer", "wall=unseen.asc"});
  EXPECT_NEAR(unseen["cost"].get<double>(), dear["cost"].get<double>(), 1e-2);
  const Ran loud = runTalus({"score", "dem.asc", "--resolution", "1", "--soil", "sandy_loam", "--rover",
                             "fido", "--path", "straight.csv", "--layer", "wall=unseen.asc"},
                            folder.path());
  EXPECT_THAT(loud.err,
              HasSubstr("layer wall has no data in 72 of 960 cells: they count as unknown and are excluded"));
}

TEST_F(CostLayers, MapStoresItsLayers) {
  const Ran built = run("costmap", {"--layer", "wall=dear.asc", "-o", "map.ot", "--geotiff", "layers.tif"});
  ASSERT_EQ(built.code, 0) << built.err;
  const Ran planned =
      runTalus({"plan", "map.ot", "--start", "5.5,5.5", "--goal", "35.5,5.5", "--json"}, folder.path());
  ASSERT_EQ(planned.code, 0) << planned.err;
  EXPECT_EQ(json::parse(planned.out)["cost"], plan({"--layer", "wall=dear.asc"})["cost"]);
  const Ran why = runTalus({"explain", "map.ot", "--at", "20,5"}, folder.path());
  EXPECT_THAT(why.out, HasSubstr("layer_wall_J_per_m"));
  const Ran twice = runTalus(
      {"plan", "map.ot", "--start", "5.5,5.5", "--goal", "35.5,5.5", "--layer", "a=dear.asc"}, folder.path());
  EXPECT_EQ(twice.code, 2);
  EXPECT_THAT(twice.err, HasSubstr("give --layer to talus costmap"));
}

// Closed form: 4.5 m of the path lie in the shadow of the plugin's layer.
TEST_F(CostLayers, PluginLayerAddsCostAndRefusesCells) {
  const json plain = score({}), shadow = score({"--layer", std::string("shadow=") + TALUS_SHADOW_LAYER});
  EXPECT_NEAR(shadow["cost"].get<double>() - plain["cost"].get<double>(), 4.5 * 20.0, 1e-2);
  const Ran beyond = run("plan", {"--start", "5.5,5.5", "--goal", "39,5.5", "--layer",
                                  std::string("shadow=") + TALUS_SHADOW_LAYER});
  EXPECT_EQ(beyond.code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("goal 39.00,5.50 lies on a blocked cell"));
}

TEST_F(CostLayers, PluginErrorsAreOneLine) {
  const auto refused = [&](const std::string& library, const std::string& reason) {
    const Ran ran = run("score", {"--path", "straight.csv", "--layer", "own=" + library});
    EXPECT_EQ(ran.code, 2) << reason;
    EXPECT_THAT(ran.err, HasSubstr(reason));
    EXPECT_EQ(ran.out, "") << "what a layer prints, and the dynamic linker for it, is lost";
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  };
  for (const auto& [how, reason] :
       std::vector<std::pair<std::string, std::string>>{{"throws", "threw an error: no sun today"},
                                                        {"prints", "threw an error: after that"},
                                                        {"crashes", "ended its process (Aborted)"},
                                                        {"huge", kBeyondMemory},
                                                        {"short", "answered for 959 cells, must be 960"},
                                                        {"negative", "J/m, must be 0 to 1e6"},
                                                        {"beyond", "J/m, must be 0 to 1e6"}}) {
    ASSERT_EQ(setenv("SHADOW", how.c_str(), 1), 0);
    refused(TALUS_SHADOW_LAYER, reason);
  }
  unsetenv("SHADOW");
  refused(TALUS_PLUGIN, "exports no talus_layer");
  refused("missing.so", "missing.so: no such file");
}

TEST_F(CostLayers, ErrorsAreOneLine) {
  folder.write("negative.asc", raster([](int, int) { return "-3"; }));
  folder.write("beyond.asc", raster([](int, int) { return "1e30"; }));
  folder.write("words.asc", "no raster\n");
  const std::vector<std::pair<Words, std::string>> cases{
      {{"--layer", "shadow"}, "is not NAME=FILE"},
      {{"--layer", "=shadow.asc"}, "is not NAME=FILE"},
      {{"--layer", "shadow="}, "is not NAME=FILE"},
      {{"--layer", "a b=shadow.asc"}, "is not NAME=FILE"},
      {{"--layer", "shadow=missing.asc"}, "missing.asc"},
      {{"--layer", "shadow=words.asc"}, "words.asc"},
      {{"--layer", "shadow=negative.asc"}, "value -3 J/m is not 0 to 1e6"},
      {{"--layer", "shadow=beyond.asc"}, "J/m is not 0 to 1e6"},
      {{"--layer", "a=shadow.asc", "--layer", "a=dear.asc"}, "a layer of that name"},
  };
  for (const auto& [more, reason] : cases) {
    const Ran ran = run("score", joined({"--path", "straight.csv"}, more));
    EXPECT_EQ(ran.code, 2) << more.back();
    EXPECT_THAT(ran.err, HasSubstr(reason));
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

}  // namespace cost_layers_test
}  // namespace talus::cli
