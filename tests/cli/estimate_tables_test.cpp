// Tables with several wheels or soils, or with columns that differ from the documentation.
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <talus/terramech/contact/wheel_on_soil.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace estimate_tables_test {

using nlohmann::json;
using terramech::Soil;
using terramech::Wheel;
using testing::HasSubstr;

constexpr const char* kHeader = "soil,load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n";

Soil soilOf(double cohesion_Pa, double friction_rad, double modulus) {
  return {.name = "made",
          .cohesion_Pa = cohesion_Pa,
          .friction_angle_rad = friction_rad,
          .sinkage_exponent = 1.0,
          .cohesive_modulus = 0.0,
          .frictional_modulus = modulus,
          .shear_modulus_m = 0.015};
}

// Exact rows of a wheel on a soil; the loads are proportional to radius times width of the wheel.
std::string rowsOf(const std::string& name, const Soil& soil, const Wheel& wheel) {
  std::string text;
  for (int k = 0; k < 9; ++k) {
    const double load = 8000.0 * wheel.radius_m * wheel.width_m * (0.75 + 0.25 * (k % 3));
    const double slip = 0.15 + 0.07 * k;
    const auto f = equilibrium(soil, wheel, {.load_N = load, .slip = slip});
    text += fmt::format("{},{},{},{},{},{},{}\n", name, load, f.torque_Nm, f.sinkage_m, slip, wheel.radius_m,
                        wheel.width_m);
  }
  return text;
}

TEST(EstimateTables, RowsOfTwoWheelSizesUseTheirOwnSize) {
  // Property: exact rows of a small and a large wheel yield the soil, because each row uses its own wheel
  // size.
  const Folder folder;
  const Soil soil = soilOf(1500.0, 0.45, 8e5);
  const std::string both = kHeader + rowsOf("a", soil, {.radius_m = 0.1, .width_m = 0.1}) +
                           rowsOf("a", soil, {.radius_m = 0.25, .width_m = 0.2});
  const std::string table = folder.write("both.csv", both);
  const Ran ran = runTalus({"--json", "estimate", table, "--method", "wong-reece", "--noise", "0.005"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const json found = json::parse(ran.out);
  EXPECT_NEAR(found["cohesion_Pa"], 1500.0, 150.0);
  EXPECT_NEAR(found["friction_angle_rad"], 0.45, 0.02);
  EXPECT_EQ(found["rows_used"], 18);
  EXPECT_THAT(ran.err, HasSubstr("for wheels 0.1 to 0.2 m wide"));
  for (const char* method : {"iagnemma", "linear-offset"}) {
    const auto line = [&](const std::string& rows, const std::string& name) {
      const Ran r = runTalus({"--json", "estimate", folder.write(name, kHeader + rows), "--method", method,
                              "--shear-modulus", "0.015"});
      EXPECT_EQ(r.code, 0) << r.err;
      return json::parse(r.out)["cohesion_Pa"].get<double>();
    };
    const double small = line(rowsOf("a", soil, {.radius_m = 0.1, .width_m = 0.1}), "small.csv");
    const double large = line(rowsOf("a", soil, {.radius_m = 0.25, .width_m = 0.2}), "large.csv");
    const double together = line(both.substr(both.find('\n') + 1), "again.csv");
    EXPECT_GT(together, std::min(small, large) - 400.0) << method;
    EXPECT_LT(together, std::max(small, large) + 400.0) << method;
  }
  const Ran assessed = runTalus({"--json", "assess", table});
  EXPECT_EQ(assessed.code, 0) << assessed.err;
  EXPECT_EQ(json::parse(assessed.out).size(), 18u);
}

TEST(EstimateTables, RowsOfSeveralSoilsAreRefused) {
  // Property: no soil explains rows of two soils; a soil under two names explains them.
  const Folder folder;
  const Wheel wheel{.radius_m = 0.15, .width_m = 0.12};
  const Soil firm = soilOf(500.0, 0.6, 3e6), soft = soilOf(3000.0, 0.4, 3e5);
  const auto said = [&](const Soil& other, int code) {
    const std::string table =
        folder.write("soils.csv", kHeader + rowsOf("upper", firm, wheel) + rowsOf("lower", other, wheel));
    const Ran ran = runTalus({"--json", "estimate", table, "--method", "wong-reece"});
    EXPECT_EQ(ran.code, code) << ran.err;
    return ran.err;
  };
  EXPECT_THAT(said(soft, 1), HasSubstr("no soil explains the rows"));
  EXPECT_THAT(said(firm, 0), testing::Not(HasSubstr("no soil explains")));
}

TEST(EstimateTables, PlatesWithoutWidthAreRoundWithAreaFromForce) {
  // Closed form: F = p pi d^2/4 for round plates of diameter d = 60 and 100 mm with k_c = 5e3, k_phi = 1e6, n
  // = 1.1; rows of a wheel are refused.
  const Folder folder;
  std::string text = "plate,z_m,F_N,p_Pa\n";
  for (int k = 1; k <= 8; ++k) {
    for (const double d : {0.06, 0.1}) {
      const double p = (5e3 / d + 1e6) * std::pow(0.003 * k, 1.1);
      text += fmt::format("plate_{:.0f},{},{},{}\n", 1e3 * d, 0.003 * k, p * 0.7853981633974483 * d * d, p);
    }
    text += fmt::format("wheel,{},{},{}\n", 0.003 * k, 10.0 * k * k, 5e3 * k);
  }
  const std::string table = folder.write("plates.csv", text);
  const Ran ran = runTalus({"--json", "estimate", table, "--method", "bevameter"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("assuming round plates"));
  const json found = json::parse(ran.out);
  EXPECT_EQ(found["rows_used"], 16);
  EXPECT_EQ(found["rows_rejected"], 8);
  EXPECT_THAT(found["rejected"][0]["reason"].get<std::string>(), HasSubstr("the plate is not flat"));
  EXPECT_NEAR(found["sinkage_exponent"], 1.1, 1e-4);
  EXPECT_NEAR(found["cohesive_modulus"], 5e3, 20.0);
  EXPECT_NEAR(found["frictional_modulus"], 1e6, 1e3);
  const Ran stated =
      runTalus({"--json", "estimate", table, "--method", "bevameter", "--plate-width", "0.07"});
  EXPECT_EQ(json::parse(stated.out)["plates"][0]["plate_width_m"], 0.07);
  const Ran wrong = runTalus({"estimate", table, "--method", "iagnemma", "--plate-width", "0.07"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--plate-width"));
}

}  // namespace estimate_tables_test
}  // namespace talus::cli
