// Stable interface for other programs: JSON fields of every subcommand by name and type, and table columns.
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace interface_test {

using nlohmann::json;

// A gentle slope with a bump, 40 x 30 cells of 1 m.
double bump(int column, int row) {
  return 0.02 * column + 0.4 * std::exp(-0.05 * (std::pow(column - 20, 2) + std::pow(row - 15, 2)));
}

// A drive along y = 15 at six levels of slip, six rows each, by the forward model with 2 % noise.
std::string telemetry() {
  std::string text =
      "run,wheel,time_s,x_m,y_m,heading_rad,load_N,slip,torque_Nm,sinkage_m,drawbar_pull_N,wheel_radius_m,"
      "wheel_width_m\n";
  const terramech::Soil soil = terramech::loadSoil("sandy_loam");
  for (int row = 0; row < 36; ++row) {
    const double load_N = 60.0 + 8.0 * (row % 6);
    const double slip = 0.1 + 0.12 * (row / 6);
    const terramech::WheelForces forces =
        equilibrium(soil, {.radius_m = 0.1, .width_m = 0.1}, {.load_N = load_N, .slip = slip});
    const double off = 1.0 + 0.02 * std::sin(12.9 * row);
    for (const double value :
         {row / 6 + 0.0, 1.0, row + 0.0, 4 + 0.8 * row, 15.0, 0.0, load_N, slip, forces.torque_Nm * off,
          forces.sinkage_m / off, forces.drawbar_pull_N * off, 0.1})
      text += std::to_string(value) + ",";
    text += "0.1\n";
  }
  return text;
}

constexpr const char* kCases =
    "cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,"
    "wheel_width_m,load_N,slip\n1000,0.5,1,500000,0.01,0.4,0.1,0.1,0.1,80,0.3\n";

// Input files of the calls below, written once.
const Folder& site() {
  static const Folder* const folder = [] {
    auto* made = new Folder;
    made->write("dem.asc", asciiGrid(40, 30, bump));
    made->write("t.csv", telemetry());
    made->write("cases.csv", kCases);
    made->write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n");
    made->write("truth.yaml", "{random: {spread: 0.1, patches: 1, patch_radius_m: 2}}\n");
    return made;
  }();
  return *folder;
}

const std::vector<std::string> kGround{"dem.asc",    "--resolution", "1",   "--soil",
                                       "sandy_loam", "--rover",      "fido"};
const std::vector<std::string> kEnds{"--start", "4,4", "--goal", "35,25"};

struct Call {
  std::string name;                 ///< subcommand
  std::vector<std::string> words;   ///< arguments after the subcommand
  std::vector<std::string> fields;  ///< type and JSON pointer of each stable field: `number /cost`
};

const std::vector<std::string> kRouteFields{
    "string /status",   "number /cost",     "number /energy_J",      "number /time_s",
    "number /length_m", "number /max_slip", "number /max_slope_rad", "number /lower_bound",
    "number /gap",      "string /planner",  "number /seconds/load",  "number /seconds/costmap"};

// Ordered so that each call finds the output files of the calls before.
std::vector<Call> calls() {
  const std::vector<std::string> route = joined(kGround, kEnds);
  return {
      {"info",
       {"dem.asc", "--resolution", "1"},
       {"number /width", "number /height", "number /resolution_m", "number /valid_fraction",
        "number /slope_deg/p50", "number /slope_deg/p90", "number /slope_deg/p99", "any /crs", "any /body"}},
      {"wheel",
       {"--soil", "dry_sand", "--rover", "fido", "--load", "80", "--slip", "0.3"},
       {"number /sinkage_m", "number /entry_angle_rad", "number /torque_Nm", "number /drawbar_pull_N"}},
      {"estimate",
       {"t.csv", "--method", "linear-offset", "--shear-modulus", "0.01"},
       {"string /method", "number /cohesion_Pa", "number /friction_angle_rad", "number /shear_modulus_m",
        "number /covariance/0/0", "number /covariance/1/1", "number /rows_used", "number /rows_rejected"}},
      {"assess",
       {"t.csv", "--slope", "0.1"},
       {"number /0/row", "number /0/drawbar_pull_over_load", "number /0/std", "number /0/sinkage_over_radius",
        "string /0/category"}},
      {"trace",
       {"t.csv", "--base", "base.yaml", "--model-out", "model.yaml"},
       {"number /base/rmse/drawbar_pull_over_load", "number /base/rmse/sinkage_over_radius", "array /effects",
        "array /rejected", "object /refined/rmse", "string /held_out/scheme", "any /held_out/base_rmse",
        "any /held_out/refined_rmse", "any /held_out/noise_floor"}},
      {"costmap",
       joined(kGround, {"-o", "map.ot", "--geotiff", "l.tif", "--png", "map.png"}),
       {"number /cells", "number /categories/safe", "number /categories/marginal",
        "number /categories/dangerous", "number /categories/unknown", "number /seconds"}},
      {"update",
       {"map.ot", "t.csv", "-o", "map2.ot"},
       {"number /rows_used", "number /rows_rejected", "number /cells_changed", "number /categories_changed"}},
      {"update",
       {"map2.ot", "--list"},
       {"string /drives/0/drive", "string /drives/0/sensors", "number /drives/0/classes/0/without"}},
      {"plan", joined(route, {"-o", "route.geojson"}),
       joined(kRouteFields, {"number /seconds/plan", "number /seconds/proof"})},
      {"score", joined(kGround, {"--path", "route.geojson"}), joined(kRouteFields, {"array /violations"})},
      {"explain",
       joined(kGround, {"--at", "20,15", "--heading", "0.5", "--next"}),
       {"any /next", "string /category", "array /causes", "string /causes/0/name", "any /causes/0/value"}},
      {"drive",
       joined(route, {"--truth", "truth.yaml"}),
       {"string /outcome", "number /energy_J", "number /length_m", "number /replans", "number /max_slip",
        "number /categories_changed"}},
  };
}

bool isOfKind(const json& value, const std::string& kind) {
  return kind == "any" || kind == value.type_name();
}

TEST(Interface, EveryCommandPrintsItsDocumentedJsonFields) {
  for (const Call& call : calls()) {
    SCOPED_TRACE(call.name);
    const Ran ran = runTalus(joined({"--json", call.name}, call.words), site().path());
    ASSERT_EQ(ran.code, 0) << ran.err;
    const json printed = json::parse(ran.out, nullptr, false);
    ASSERT_FALSE(printed.is_discarded());
    for (const std::string& field : call.fields) {
      const auto space = field.find(' ');
      const json::json_pointer pointer(field.substr(space + 1));
      ASSERT_TRUE(printed.contains(pointer)) << field;
      EXPECT_TRUE(isOfKind(printed[pointer], field.substr(0, space)))
          << field << " is " << printed[pointer].type_name();
    }
  }
}

TEST(Interface, GlobalOptionsAreAcceptedAfterTheSubcommandAndQuietIsSilent) {
  const Ran before = runTalus({"--json", "info", "dem.asc", "--resolution", "1"}, site().path());
  const Ran after = runTalus({"info", "dem.asc", "--resolution", "1", "--json", "--quiet"}, site().path());
  EXPECT_EQ(before.out, after.out);
  EXPECT_EQ(after.err, "");
}

TEST(Interface, TablesKeepTheirColumnsAndGetTheDocumentedOnes) {
  const Folder folder;
  folder.write("cases.csv", kCases);
  ASSERT_EQ(runTalus({"wheel", "--cases", "cases.csv", "-o", "out.csv"}, folder.path()).code, 0);
  const std::string text = fileContent(folder / "out.csv");
  EXPECT_EQ(text.substr(0, text.find('\n')), std::string(kCases).substr(0, std::string(kCases).find('\n')) +
                                                 ",sinkage_m,entry_angle_rad,torque_Nm,drawbar_pull_N");
  folder.write("t.csv", telemetry());
  folder.write("base.yaml", "{soil: sandy_loam, model: wong-reece}\n");
  ASSERT_EQ(runTalus({"predict", "t.csv", "--model", "base.yaml", "-o", "p.csv"}, folder.path()).code, 0);
  const std::string predicted = fileContent(folder / "p.csv");
  const std::string header = predicted.substr(0, predicted.find('\n'));
  for (const char* column :
       {"predicted_drawbar_pull_N", "predicted_drawbar_pull_N_std", "predicted_sinkage_m",
        "predicted_sinkage_m_std", "predicted_torque_Nm", "predicted_torque_Nm_std"})
    EXPECT_THAT(header, testing::HasSubstr(column));
}

// Property: after SIGINT every subcommand ends with exit code 130 and leaves no partial file.
TEST(Interface, InterruptEndsWithCode130AndWritesNoFile) {
  std::string drive = "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n";
  for (int k = 0; k < 60000; ++k)
    drive +=
        fmt::format("{},{},0.0166,{},0.1,0.1\n", 60 + k % 41, 2.4 + 0.02 * (k % 83), 0.2 + 0.05 * (k % 13));
  const std::string table = site().write("long.csv", drive);
  const std::vector<std::vector<std::string>> long_work{
      joined(joined({"drive"}, joined(kGround, kEnds)), {"--truth", "truth.yaml", "--worlds", "100000"}),
      {"estimate", table, "--method", "wong-reece", "--html", "late.html"},
      {"assess", table, "--extrapolate"},
      {"reproduce", "--goals", "--soils", "100000"},
      {"generate", "craters", "--size", "8000", "-o", "late.tif"}};
  for (const auto& work : long_work) {
    SCOPED_TRACE(work.front());
    const auto before = site().names();
    const Ran ran = runTalus(work, site().path(), 0.5);
    EXPECT_EQ(ran.code, 130) << ran.err;
    EXPECT_EQ(site().names(), before);
  }
}

}  // namespace interface_test
}  // namespace talus::cli
