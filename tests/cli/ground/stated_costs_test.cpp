#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace stated_costs_test {

using nlohmann::json;
using testing::HasSubstr;
using Words = std::vector<std::string>;

// A plane of 80 x 80 m that rises northward by 0.2.
void writePlane(const Folder& folder) {
  std::string text = "ncols 80\nnrows 80\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column) text += fmt::format("{} ", 0.2 * (80 - row));
  folder.write("plane.asc", text);
}

json planned(const Folder& folder, const std::string& curve, const std::string& start,
             const std::string& goal) {
  folder.write("curve.csv", curve);
  const Ran ran = runTalus({"plan", "plane.asc", "--resolution", "1", "--cost-curve", "curve.csv", "--start",
                            start, "--goal", goal, "--json"},
                           folder.path());
  EXPECT_EQ(ran.code, 0) << ran.err;
  return ran.code == 0 ? json::parse(ran.out) : json();
}

// Cost of friction 0.3 and of the climb, nothing when braking, up to a gradient of `limit`.
std::string frictionAndClimb(double limit) {
  std::string text = "gradient_along,cost_per_m\n";
  for (const double g : {-limit, -0.3, 0.0, limit})
    if (g >= -limit) text += fmt::format("{},{}\n", g, std::max(0.3 + g, 1e-6));
  return text;
}

TEST(CostCurveFile, RoutesOnPlanesHaveTheClosedFormOfRoweAndRoss) {
  // Printed in: rowe_ross_1990, cases of a plane: straight, along the limit heading, switchback, braking.
  const Folder folder;
  writePlane(folder);
  const json straight = planned(folder, frictionAndClimb(0.5), "10.5,10.5", "60.5,40.5");
  EXPECT_NEAR(straight["cost"], 0.3 * std::hypot(50.0, 30.0) + 6.0, 0.02);
  EXPECT_LE(straight["gap"], 0.002);
  EXPECT_TRUE(straight["time_s"].is_null());  // a stated cost has no speed
  // A climb of 8 m at most 0.1 steep is 80 m long, whatever the turns.
  const json limit = planned(folder, frictionAndClimb(0.1), "10.5,20.5", "50.5,60.5"),
             switchback = planned(folder, frictionAndClimb(0.1), "40.5,20.5", "40.5,60.5");
  EXPECT_NEAR(limit["cost"], 0.3 * 80.0 + 8.0, 0.15);
  EXPECT_NEAR(switchback["cost"], 0.3 * 80.0 + 8.0, 0.3);
  EXPECT_LE(limit["lower_bound"], 32.0 + 1e-3);
  const json braking =
      planned(folder, "gradient_along,cost_per_m\n-0.3,1e-6\n-0.1,1e-6\n0.3,0.4\n", "30.5,70.5", "40.5,30.5");
  EXPECT_LT(braking["cost"], 1e-4);
}

TEST(CostCurveFile, CostsFollowTheGradientAcrossAndTheClass) {
  // Along a contour of the plane the gradient along is 0 and that across 0.2; class 2 costs three times class 1.
  const Folder folder;
  writePlane(folder);
  const std::string across =
      "gradient_along,gradient_across,cost_per_m\n-0.5,0,1\n0.5,0,1\n-0.5,0.4,3\n0.5,0.4,3\n";
  EXPECT_NEAR(planned(folder, across, "10.5,20.5", "50.5,20.5")["cost"], 40.0 * 2.0, 0.1);
  std::string classes = "ncols 80\nnrows 80\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -9999\n";
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column) classes += column < 30 ? "1 " : "2 ";
  folder.write("classes.asc", classes);
  folder.write("curve.csv", "class,gradient_along,cost_per_m\n1,-0.5,1\n1,0.5,1\n2,-0.5,3\n2,0.5,3\n");
  const Words words{"plan",      "plane.asc", "--resolution", "1",       "--cost-curve",
                    "curve.csv", "--terrain", "classes.asc",  "--start", "10.5,20.5",
                    "--goal",    "50.5,20.5", "--json"};
  const Ran ran = runTalus(words, folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NEAR(json::parse(ran.out)["cost"], 19.5 + 3.0 * 20.5, 0.05);
}

TEST(CostCurveFile, ErrorsAreOneLineWithTheirExitCode) {
  const Folder folder;
  writePlane(folder);
  const auto refuse = [&](const std::string& curve, const std::string& reason, const Words& more = {}) {
    folder.write("curve.csv", curve);
    Words words{"plan",      "plane.asc", "--resolution", "1",      "--cost-curve",
                "curve.csv", "--start",   "1,1",          "--goal", "9,9"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = runTalus(words, folder.path());
    EXPECT_EQ(ran.code, 2);
    EXPECT_THAT(ran.err, HasSubstr(reason));
  };
  const std::string good = "gradient_along,cost_per_m\n-0.5,1\n0.5,1\n";
  refuse("gradient_along,cost\n-0.5,1\n", "unknown column 'cost'");
  refuse("gradient_along\n-0.5\n", "no column cost_per_m");
  refuse("gradient_along,cost_per_m\n-0.5,-1\n0.5,1\n", "curve.csv:2");
  refuse("gradient_along,cost_per_m\n-0.5,1\n", "two gradients along");
  refuse("gradient_along,gradient_across,cost_per_m\n-0.5,0,2\n0.5,0,2\n-0.5,0.3,1\n0.5,0.3,2\n",
         "must not decrease across");
  refuse(good, "in place of --rover", {"--rover", "mer"});
  refuse(good, "belong together", {"--terrain", "plane.asc"});
}

// A ramp steeper than any stated gradient, and a wall of infinite cost beside cells of a great one: the reasons
// name costs, not a rover.
TEST(CostCurveFile, ReasonsAndLimitsAreThoseOfCosts) {
  const Folder folder;
  const std::string head = "ncols 20\nnrows 10\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  std::string ramp = head, wall = head;
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 20; ++column) {
      ramp += fmt::format("{} ", 1.2 * std::clamp(column - 8, 0, 4));
      wall += column == 10 ? "inf " : "500000 ";
    }
  folder.write("ramp.asc", ramp);
  folder.write("wall.asc", wall);
  folder.write("curve.csv",
               "gradient_along,gradient_across,cost_per_m\n-0.5,0,1\n0.5,0,1\n-0.5,0.4,3\n0.5,0.4,3\n");
  const auto plan = [&](Words words, const char* goal) {
    for (const char* word : {"--resolution", "1", "--start", "2.5,5.5", "--goal", goal})
      words.emplace_back(word);
    return runTalus(words, folder.path());
  };
  EXPECT_THAT(plan({"plan", "ramp.asc", "--cost-curve", "curve.csv"}, "17.5,5.5").err,
              HasSubstr("gradients without a finite stated cost close every way"));
  EXPECT_THAT(plan({"plan", "--cost", "wall.asc"}, "17.5,5.5").err,
              HasSubstr("cells of infinite cost close every way"));
  EXPECT_THAT(plan({"plan", "--cost", "wall.asc"}, "10.5,5.5").err,
              HasSubstr("lies on a blocked cell: an infinite cost"));
  EXPECT_NEAR(json::parse(plan({"plan", "--cost", "wall.asc", "--json"}, "7.5,5.5").out)["cost"], 5.0 * 5e5,
              1.0);
}

// A wall with a gap at its end, in a Nav2 map and as costs a metre: the shortest way turns at the wall's corner.
TEST(CostRaster, CostsAMetreAndNav2MapsAreGroundOfTheirOwn) {
  const Folder folder;
  std::string pgm = "P5\n40 20\n255\n", costs = "ncols 40\nnrows 20\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 40; ++column) {
      const bool wall = column == 20 && row >= 5;
      pgm += static_cast<char>(wall ? 0 : column < 2 ? 205 : 254);
      costs += wall ? "inf " : "2 ";
    }
  folder.write("nav.pgm", pgm);
  folder.write("nav.yaml",
               "image: nav.pgm\nresolution: 0.5\norigin: [-10, 5, 0]\nnegate: 0\noccupied_thresh: "
               "0.65\nfree_thresh: 0.19\n");
  folder.write("costs.asc", costs);
  const auto plan = [&](const Words& more) {
    Words words{"plan", "--cost", "--json", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return runTalus(words, folder.path());
  };
  const double way =
      2.0 * std::hypot(10.0 - 0.5, 9.5);  // cells from (10.5, 5.5) by the corners (20, 15), (21, 15)
  const Ran nav = plan({"nav.yaml", "--start=-4.75,7.75", "--goal=5.25,7.75"}),
            raster = plan({"costs.asc", "--resolution", "1", "--start", "10.5,5.5", "--goal", "30.5,5.5"});
  ASSERT_EQ(nav.code, 0) << nav.err;
  ASSERT_EQ(raster.code, 0) << raster.err;
  EXPECT_NEAR(json::parse(nav.out)["cost"], 0.5 * (way + 1.0), 0.02);
  EXPECT_NEAR(json::parse(raster.out)["cost"], 2.0 * (way + 1.0), 0.05);
  EXPECT_EQ(plan({"nav.yaml", "--start=-9.75,7.75", "--goal=5.25,7.75"}).code, 2);  // unknown ground
  // A wall is no unknown ground, and a cell of 2 m is as dear as the dearest of its four.
  const Ran allowed = plan({"nav.yaml", "--start=-4.75,7.75", "--goal=5.25,7.75", "--allow-unknown"});
  EXPECT_NEAR(json::parse(allowed.out)["cost"], 0.5 * (way + 1.0), 0.02);
  folder.write("utm.asc",
               "ncols 40\nnrows 20\nxllcorner 500000\nyllcorner 0\n" + costs.substr(costs.find("cells")));
  folder.write("utm.prj",
               "PROJCS[\"WGS 84 / UTM zone 31N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
               "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
               "PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_"
               "meridian\",3],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],"
               "PARAMETER[\"false_northing\",0],UNIT[\"metre\",1]]");
  const Ran coarse = plan({"utm.asc", "--resolution", "2", "--start", "500011,5", "--goal", "500031,5"});
  ASSERT_EQ(coarse.code, 0) << coarse.err;
  EXPECT_NEAR(json::parse(coarse.out)["cost"], 2.0 * (2.0 * std::hypot(9.0, 11.0) + 2.0), 0.05);
  EXPECT_THAT(
      plan({"costs.asc", "--resolution", "1", "--start", "1,1", "--goal", "9,9", "--rover", "mer"}).err,
      HasSubstr("in place of --rover"));
  folder.write("costs.asc", costs.replace(costs.rfind("2 "), 2, "0 "));
  EXPECT_THAT(plan({"costs.asc", "--resolution", "1", "--start", "1,1", "--goal", "9,9"}).err,
              HasSubstr("above 0"));
}

}  // namespace stated_costs_test
}  // namespace talus::cli
