// Ground with measured danger must not become safe by telemetry, tested through the program for several
// rovers, soils, row orders and missing columns.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace danger_kept_test {

using nlohmann::json;

const double kSilent = std::nan("");
constexpr int kWidth = 60, kHeight = 40;

// A rover, and the soil stated in its map.
struct Given {
  const char* rover;
  const char* soil;
};

class Ground {
 public:
  Ground(const Given& given, double gradient, const std::string& second_soil = {})
      : rover_(terramech::loadRover(given.rover)) {
    folder.write("site.asc", asciiGrid(kWidth, kHeight, [&](int column, int) { return gradient * column; }));
    std::vector<std::string> words{"costmap", "site.asc", "--ignore-crs", "--resolution",
                                   "1",       "--rover",  given.rover};
    if (second_soil.empty()) {
      words.insert(words.end(), {"--soil", given.soil});
    } else {
      folder.write("classes.asc",
                   asciiGrid(kWidth, kHeight, [](int column, int) { return column < 30 ? 1.0 : 2.0; }));
      folder.write("soils.yaml", fmt::format("classes: {{1: {}, 2: {}}}\n", given.soil, second_soil));
      words.insert(words.end(), {"--terrain", "classes.asc", "--soils", "soils.yaml"});
    }
    words.insert(words.end(), {"-o", "map.ot"});
    const Ran ran = runTalus(words, folder.path());
    EXPECT_EQ(ran.code, 0) << ran.err;
  }

  // A violation found by `talus score` gives exit code 1.
  json run(const std::vector<std::string>& words) const {
    const Ran ran = runTalus(words, folder.path());
    EXPECT_TRUE(ran.code == 0 || (ran.code == 1 && words[0] == "score")) << ran.err;
    return json::parse(ran.out);
  }

  json update(const std::string& csv, const std::string& from = "map.ot",
              const std::string& to = "new.ot") const {
    folder.write("t.csv", csv);
    return run({"update", from, "t.csv", "-o", to, "--json"});
  }

  // Estimate of a place: category, drawbar pull over load, sinkage over radius.
  struct Said {
    std::string category;
    double pull = std::nan(""), sinkage = std::nan("");
  };
  Said said(const std::string& map, const std::string& place) const {
    const json why = run({"explain", map, "--at", place, "--json"});
    Said out{.category = why["category"]};
    for (const json& cause : why["causes"]) {
      if (cause["name"] == "drawbar_pull_over_load") out.pull = cause["value"];
      if (cause["name"] == "sinkage_over_radius") out.sinkage = cause["value"];
    }
    return out;
  }

  // Succeeds if neither the category nor the drawbar pull of a place has improved after the update.
  ::testing::AssertionResult noBetter(const std::string& place) const {
    static const std::vector<std::string> order{"safe", "marginal", "dangerous"};
    const auto rank = [&](const Said& s) {
      return std::find(order.begin(), order.end(), s.category) - order.begin();
    };
    const Said before = said("map.ot", place), after = said("new.ot", place);
    if (rank(after) >= rank(before) && after.pull <= before.pull + 1e-6) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << place << ": " << before.category << ' ' << before.pull << " to "
                                         << after.category << ' ' << after.pull;
  }

  // Returns true if `talus score` reports a violation of the path.
  bool refused(const std::string& map, const std::string& csv) const {
    folder.write("path.csv", csv);
    const json out = run({"score", "site.asc", "--ignore-crs", "--resolution", "1", "--map", map, "--path",
                          "path.csv", "--json"});
    return !out["violations"].empty();
  }

  double load_N() const { return terramech::wheelLoad_N(rover_); }
  double radius_m() const { return rover_.wheel.radius_m; }

  Folder folder;

 private:
  terramech::Rover rover_;
};

class DangerKept : public ::testing::TestWithParam<Given> {};

INSTANTIATE_TEST_SUITE_P(Of, DangerKept,
                         ::testing::Values(Given{"sojourner", "sandy_loam"}, Given{"fido", "mars_crusty"}),
                         [](const auto& one) { return std::string(one.param.rover); });

// Rows of drawbar pull over load (DP/W) at slip 0.5 on level ground.
std::string pulls(const Ground& ground, double x_m, double y_m, double pull, int times, int& time_s) {
  std::string text;
  for (int i = 0; i < times; ++i, ++time_s)
    text += fmt::format("{},{},{},0,{},{},{}\n", time_s, x_m, y_m, ground.load_N(), 0.5 + 1e-3 * (i % 7),
                        pull * ground.load_N());
  return text;
}
const std::string kPulls = "time_s,x_m,y_m,slope_rad,load_N,slip,drawbar_pull_N\n";

TEST_P(DangerKept, OneWeakCellAmongStrongOnesStaysDangerous) {
  const Ground ground(GetParam(), 0.0);
  std::string text = kPulls;
  int time_s = 0;
  for (int row = 14; row < 27; ++row)
    for (int column = 14; column < 27; ++column)
      text += pulls(ground, column + 0.5, row + 0.5, column == 20 && row == 20 ? -0.25 : 0.35, 20, time_s);
  ground.update(text);
  EXPECT_EQ(ground.said("new.ot", "20.5,20.5").category, "dangerous");
  EXPECT_TRUE(ground.refused("new.ot", "x_m,y_m\n16.5,20.5\n25.5,20.5\n"));
}

TEST_P(DangerKept, ClassesInOneBlockHaveSeparateReadings) {
  const Ground ground(GetParam(), 0.0, "sand");
  for (const bool second_first : {false, true}) {
    int time_s = 0;
    std::string one = pulls(ground, 29.5, 20.5, 0.3, 20, time_s),
                two = pulls(ground, 30.5, 20.5, -0.3, 20, time_s);
    ground.update(kPulls + (second_first ? two + one : one + two));
    EXPECT_EQ(ground.said("new.ot", "30.5,20.5").category, "dangerous");
  }
}

const std::string kDrive = "wheel,time_s,x_m,y_m,heading_rad,slope_rad,load_N,slip,torque_Nm,sinkage_m\n";

// A row of one wheel; NaN is written as an empty field.
struct Reading {
  double x_m, y_m, slope_rad, slip, torque = std::nan(""), sinkage = std::nan("");  // T/(rW), z/r
};
std::string rowOf(const Ground& ground, const Reading& r, double time_s, double heading_rad = 0.0) {
  const auto cell = [](double value) { return std::isnan(value) ? std::string() : fmt::format("{}", value); };
  return fmt::format("w0,{},{},{},{},{},{},{},{},{}\n", time_s, r.x_m, r.y_m, heading_rad, r.slope_rad,
                     ground.load_N(), r.slip, cell(r.torque * ground.load_N() * ground.radius_m()),
                     cell(r.sinkage * ground.radius_m()));
}

// On a 14 deg slope, a nearly constant slip signal (stuck sensor) must not improve any cell.
TEST_P(DangerKept, StuckSlipSensorOnAClimbRaisesNothing) {
  const double gradient = std::tan(14.0 * std::numbers::pi / 180.0);
  const Ground ground(GetParam(), gradient);
  for (const double slip : {0.0, 0.02, -0.01})
    for (const bool with_torque : {false, true}) {
      std::string text = kDrive;
      for (int i = 0; i < 150; ++i)
        text += rowOf(ground,
                      {5.0 + 0.3 * i, 20.5, std::atan(gradient), slip + 1e-4 * (i % 5),
                       with_torque ? 0.3 : kSilent, with_torque ? 0.05 : kSilent},
                      i);
      ground.update(text);
      for (const char* place : {"30.5,20.5", "6.5,30.5"}) EXPECT_TRUE(ground.noBetter(place));
    }
}

// Two rows of high slip within a steady drive lower the estimate, with or without torque and sinkage.
TEST_P(DangerKept, TrapOfTwoRowsLowersTheEstimate) {
  const Ground ground(GetParam(), 0.0);
  for (const bool with_torque : {true, false})
    for (const double sinkage : {0.54, kSilent}) {
      std::string text = kDrive, quiet = kDrive;
      for (int i = 0; i < 60; ++i) {
        Reading r{10.0 + 0.4 * i, 20.5, 0.0, 0.1 + 0.001 * (i % 7), with_torque ? 0.2 : kSilent, 0.08};
        quiet += rowOf(ground, r, i);
        if (i == 30 || i == 31) r = {r.x_m, r.y_m, 0.0, 0.93, with_torque ? 0.35 : kSilent, sinkage};
        text += rowOf(ground, r, i);
      }
      ground.update(quiet, "map.ot", "quiet.ot");
      const json out = ground.update(text);
      EXPECT_EQ(out["rows_rejected"], 0) << out;
      const Ground::Said here = ground.said("new.ot", "22.2,20.5");
      EXPECT_LT(here.pull, ground.said("quiet.ot", "22.2,20.5").pull - 0.02);
      if (sinkage > 0.5) {
        EXPECT_GT(here.sinkage, 0.4) << "as at the reference slip";
        EXPECT_NE(here.category, "safe");
      }
    }
}

// Sinkage of 0.85 r at low slip on the whole drive, as by a sinkage offset or sensor drift.
TEST_P(DangerKept, DeepSinkageAtLowSlipIsNotSafe) {
  const Ground ground(GetParam(), 0.0);
  for (const double heading : {0.0, std::numbers::pi})
    for (const double torque : {0.15, kSilent}) {
      std::string text = kDrive;
      for (int i = 0; i < 60; ++i)
        text += rowOf(ground,
                      {heading > 0.0 ? 40.0 - 0.4 * i : 10.0 + 0.4 * i, 20.5, 0.0, 0.05 + 0.001 * (i % 9),
                       torque, 0.85},
                      i, heading);
      ground.update(text);
      EXPECT_NE(ground.said("new.ot", "22.2,20.5").category, "safe");
    }
}

TEST_P(DangerKept, SingleDeepSinkageReadingIsNotSafe) {
  const Ground ground(GetParam(), 0.0);
  for (const bool deep_first : {false, true}) {
    std::string text = kDrive;
    for (int i = 0; i < 61; ++i) {
      const bool deep = i == (deep_first ? 0 : 60);
      text += rowOf(ground, {20.5, 20.5, 0.0, 0.5, 0.3, deep ? 0.77 : kSilent}, i);
    }
    ground.update(text);
    const Ground::Said here = ground.said("new.ot", "20.5,20.5");
    EXPECT_GT(here.sinkage, 0.7);
    EXPECT_NE(here.category, "safe");
  }
}

// A pose jump places rows on weaker ground (soil mars_drift) that the rover never reached.
TEST_P(DangerKept, PoseJumpOntoWeakGroundRaisesNothing) {
  const Ground ground(GetParam(), 0.22, "mars_drift");
  for (const double jump_m : {20.0, 12.0})
    for (const bool back : {false, true}) {
      std::string text = kDrive;
      for (int i = 0; i < 120; ++i) {
        const bool off = i >= 50 && (!back || i < 90);
        text += rowOf(
            ground,
            {8.0 + 0.17 * i + (off ? jump_m : 0.0), 20.5, std::atan(0.22), 0.05 + 0.01 * (i % 3), 0.35, 0.05},
            2.0 * i);
      }
      ground.update(text);
      for (const char* place : {"32.5,20.5", "40.5,20.5", "50.5,10.5"}) EXPECT_TRUE(ground.noBetter(place));
    }
}

// A rover without progress: slip 0.98 on a slope, table without the column slope_rad.
TEST_P(DangerKept, StationaryRoverRaisesNothing) {
  for (const double gradient : {0.15, 0.3, 0.45}) {
    const Ground ground(GetParam(), gradient);
    std::string text = "time_s,x_m,y_m,heading_rad,load_N,slip\n";
    for (int i = 0; i < 40; ++i)
      text += fmt::format("{},{},{},0,{},{}\n", i, 20.5 + 0.01 * i, 20.5, ground.load_N(), 0.98);
    ground.update(text);
    EXPECT_TRUE(ground.noBetter("20.5,20.5"));
  }
}

}  // namespace danger_kept_test
}  // namespace talus::cli
