#include <cmath>

#include <nlohmann/json.hpp>

#include <talus/common/common.hpp>

#include "bad_input.hpp"

namespace talus::cli {
namespace estimate_command_test {

using nlohmann::json;
using testing::HasSubstr;

// Ten readings on loam (cohesion c = 2436 Pa, friction angle phi = 24.9 deg, shear modulus K = 20.3 mm) of an
// independent Wong-Reece implementation, rounded.
constexpr const char* kHeader = "load_N,torque_Nm,sinkage_m,slip,wheel_radius_m,wheel_width_m\n";

std::string drive() {
  std::string text = kHeader;
  // Values of talus wheel for the library's loam; the last digits do not affect the test.
  const double rows[][4] = {{80.95, 2.40, 0.0159, 0.2}, {66.59, 2.35, 0.0150, 0.3},
                            {82.55, 3.15, 0.0178, 0.4}, {71.49, 3.05, 0.0171, 0.5},
                            {63.35, 2.93, 0.0166, 0.6}, {93.83, 4.15, 0.0210, 0.7},
                            {77.09, 3.68, 0.0193, 0.8}, {65.61, 3.13, 0.0176, 0.7},
                            {85.56, 3.63, 0.0192, 0.6}, {60.52, 2.69, 0.0160, 0.5}};
  for (const auto& r : rows) {
    text += std::to_string(r[0]) + "," + std::to_string(r[1]) + "," + std::to_string(r[2]) + "," +
            std::to_string(r[3]) + ",0.1,0.1\n";
  }
  return text;
}

json estimated(const std::vector<std::string>& more, const std::string& table) {
  const Ran ran = runTalus(joined({"--json", "estimate", table}, more));
  EXPECT_EQ(ran.code, 0) << ran.err;
  return json::parse(ran.out);
}

TEST(EstimateCommand, EveryMethodPrintsTheDocumentedFields) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  for (const char* method : {"sojourner", "iagnemma", "linear-offset", "wong-reece"}) {
    const json result = estimated({"--method", method}, table);
    EXPECT_EQ(result.at("method"), method);
    for (const char* field : {"cohesion_Pa", "friction_angle_rad"})
      EXPECT_TRUE(result.at(field).is_number()) << field;
    EXPECT_TRUE(result.contains("shear_modulus_m"));
    EXPECT_EQ(result.at("covariance").size(), 2u);
    EXPECT_EQ(result.at("rows_used"), 10);
    EXPECT_EQ(result.at("rows_rejected"), 0);
  }
}

TEST(EstimateCommand, ShearModulusIsTakenOrEstimatedAsRequested) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  EXPECT_DOUBLE_EQ(estimated({"--method", "iagnemma", "--shear-modulus", "0.02"}, table)["shear_modulus_m"],
                   0.02);
  for (const char* how : {"error-minimisation", "effective-torque", "effective-torque-printed", "joint"}) {
    const double k =
        estimated({"--method", "linear-offset", "--shear-modulus", how}, table)["shear_modulus_m"];
    EXPECT_GT(k, 0.001) << how;
    EXPECT_LE(k, 0.1) << how;
  }
}

TEST(EstimateCommand, PriorNarrowsWongReece) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  const std::string prior = folder.write(
      "prior.yaml",
      "soil: {name: known, cohesion_Pa: {mean: 2400, std: 10}, friction_angle_deg: {mean: 25, std: 0.1}, "
      "sinkage_exponent: {mean: 0.85, std: 0.3}, cohesive_modulus: 0, frictional_modulus: {mean: 1.7e6, std: "
      "4e5}, shear_modulus_m: {mean: 0.02, std: 0.005}}\n");
  const json result = estimated({"--method", "wong-reece", "--prior", prior}, table);
  EXPECT_NEAR(result["cohesion_Pa"], 2400.0, 40.0);
  EXPECT_NEAR(result["friction_angle_rad"], 25.0 * kDegree, 0.01);
}

TEST(EstimateCommand, PriorNarrowsTheLinearMethods) {
  // Property: a prior of zero variance determines the result; a very wide prior has no effect. The shear
  // modulus K of the prior is used if the call states none.
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  const auto prior = [&](const char* name, const char* cohesion, const char* friction) {
    return folder.write(name, std::string("soil: {name: x, cohesion_Pa: ") + cohesion +
                                  ", friction_angle_deg: " + friction +
                                  ", sinkage_exponent: 0.9, cohesive_modulus: 0, frictional_modulus: 1.7e6, "
                                  "shear_modulus_m: 0.013}\n");
  };
  const std::string known = prior("known.yaml", "2400", "25");
  const std::string vague = prior("vague.yaml", "{mean: 0, std: 1e8}", "{mean: 30, std: 1e6}");
  for (const char* method : {"iagnemma", "linear-offset", "sojourner"}) {
    const json fixed = estimated({"--method", method, "--prior", known}, table);
    EXPECT_NEAR(fixed["cohesion_Pa"], 2400.0, 1e-6) << method;
    EXPECT_NEAR(fixed["friction_angle_rad"], 25.0 * kDegree, 1e-9) << method;
    const json free = estimated({"--method", method, "--shear-modulus", "0.013"}, table);
    const json open = estimated({"--method", method, "--prior", vague}, table);
    EXPECT_NEAR(open["cohesion_Pa"].get<double>(), free["cohesion_Pa"].get<double>(), 0.1) << method;
    EXPECT_EQ(open["shear_modulus_m"], free["shear_modulus_m"]) << method;
  }
}

TEST(EstimateCommand, RecursiveEstimateEqualsBatchEstimate) {
  // Property: with K given, recursive and batch least squares are equal.
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  for (const char* method : {"iagnemma", "linear-offset"}) {
    const std::vector<std::string> call{"--method", method, "--shear-modulus", "0.02"};
    std::vector<std::string> recursive = call;
    recursive.emplace_back("--recursive");
    const json all = estimated(call, table), running = estimated(recursive, table);
    constexpr double exact = 1e-9;
    const double std_Pa = std::sqrt(all["covariance"][0][0].get<double>());
    EXPECT_NEAR(running["cohesion_Pa"].get<double>(), all["cohesion_Pa"].get<double>(), exact * std_Pa);
    ASSERT_EQ(running["running"].size(), 10u) << method;
    EXPECT_EQ(running["running"][9]["line"], 11);
    EXPECT_EQ(running["running"][9]["cohesion_Pa"], running["cohesion_Pa"]);
    EXPECT_NEAR(running["running"][9]["cohesion_std_Pa"].get<double>(),
                std::sqrt(running["covariance"][0][0].get<double>()), 1e-6);
    EXPECT_FALSE(all.contains("running"));
  }
}

TEST(EstimateCommand, RecursiveEstimateSupportsEveryModulusCriterion) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  for (const char* how : {"error-minimisation", "effective-torque", "effective-torque-printed", "joint"}) {
    const json result =
        estimated({"--method", "linear-offset", "--shear-modulus", how, "--recursive"}, table);
    EXPECT_TRUE(result["running"][0]["cohesion_Pa"].is_null()) << how;  // one row does not determine the soil
    EXPECT_TRUE(result["running"][9]["cohesion_Pa"].is_number()) << how;
    const double k = result["shear_modulus_m"];
    EXPECT_GE(k, 0.002) << how;
    EXPECT_LE(k, 0.1) << how;
  }
}

TEST(EstimateCommand, RejectedRowsAreListedByLine) {
  const Folder folder;
  const std::string table =
      folder.write("drive.csv", drive() + "-3,1,0.01,0.3,0.1,0.1\n80,1,0.01,-0.2,0.1,0.1\n");
  const json result = estimated({"--method", "linear-offset", "--shear-modulus", "0.02"}, table);
  EXPECT_EQ(result["rows_used"], 10);
  ASSERT_EQ(result["rows_rejected"], 2);
  EXPECT_EQ(result["rejected"][0]["line"], 12);
  EXPECT_THAT(result["rejected"][1]["reason"].get<std::string>(), HasSubstr("slip"));
}

TEST(EstimateCommand, IllConditionedDataIsReported) {
  const Folder folder;
  std::string text = kHeader;
  for (int k = 0; k < 6; ++k) text += "80,3.0" + std::to_string(k) + ",0.018,0.5,0.1,0.1\n";
  const Ran ran = runTalus(
      {"estimate", folder.write("same.csv", text), "--method", "linear-offset", "--shear-modulus", "0.02"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("ill-conditioned: friction_angle_rad"));
}

TEST(EstimateCommand, SinglePlateYieldsOnlyItsModulus) {
  // Closed form: p = 2e6 z^0.8 of one plate determines the modulus k = 2e6, but not k_c and k_phi separately.
  const Folder folder;
  std::string text = "plate_width_m,pressure_Pa,sinkage_m\n";
  for (int k = 1; k <= 6; ++k)
    text += "0.1," + std::to_string(2e6 * std::pow(0.004 * k, 0.8)) + "," + std::to_string(0.004 * k) + "\n";
  const json result = estimated({"--method", "bevameter"}, folder.write("plate.csv", text));
  EXPECT_NEAR(result["sinkage_exponent"], 0.8, 1e-6);
  ASSERT_EQ(result["plates"].size(), 1u);
  EXPECT_DOUBLE_EQ(result["plates"][0]["plate_width_m"], 0.1);
  EXPECT_NEAR(result["plates"][0]["sinkage_modulus"].get<double>() / 2e6, 1.0, 1e-5);
  EXPECT_FALSE(result.contains("cohesive_modulus"));
  EXPECT_FALSE(result.contains("frictional_modulus"));
  EXPECT_THAT(result["unseen"][0].get<std::string>(), HasSubstr("frictional_modulus"));
  EXPECT_TRUE(result["cohesion_Pa"].is_null());
}

TEST(EstimateCommand, ImplausibleSoilIsReported) {
  // Property: the Wong-Reece model does not describe a sinkage that triples with slip at constant load.
  const Folder folder;
  const std::string table = folder.write("sinking.csv", std::string(kHeader) +
                                                            "80,3.0,0.0055,0.1,0.157,0.165\n"
                                                            "80,4.2,0.0075,0.2,0.157,0.165\n"
                                                            "80,4.8,0.0100,0.3,0.157,0.165\n"
                                                            "80,5.0,0.0125,0.4,0.157,0.165\n"
                                                            "80,5.3,0.0175,0.6,0.157,0.165\n");
  const Ran ran = runTalus({"--json", "estimate", table, "--method", "iagnemma", "--shear-modulus", "0.011"});
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("outside the range of any soil"));
  EXPECT_EQ(json::parse(ran.out)["plausible"], false);
  EXPECT_EQ(estimated({"--method", "wong-reece"}, folder.write("drive.csv", drive()))["plausible"], true);
}

TEST(EstimateCommand, BevameterFitsShearAndPlateTests) {
  const Folder folder;
  std::string text =
      "normal_stress_Pa,shear_stress_Pa,shear_displacement_m,plate_width_m,pressure_Pa,sinkage_m\n";
  for (const double sigma : {5000.0, 10000.0, 20000.0}) {
    for (int k = 1; k <= 6; ++k) {
      const double j = 0.008 * k;
      const double tau = (700.0 + 0.6 * sigma) * (1.0 - std::exp(-j / 0.015));
      const double width = k % 2 == 0 ? 0.05 : 0.1;
      const double pressure = (5000.0 / width + 1e6) * std::pow(0.005 * k, 0.9);
      text += std::to_string(sigma) + "," + std::to_string(tau) + "," + std::to_string(j) + "," +
              std::to_string(width) + "," + std::to_string(pressure) + "," + std::to_string(0.005 * k) + "\n";
    }
  }
  const json result = estimated({"--method", "bevameter"}, folder.write("plates.csv", text));
  EXPECT_NEAR(result["cohesion_Pa"], 700.0, 1.0);
  EXPECT_NEAR(result["shear_modulus_m"], 0.015, 1e-5);
  EXPECT_NEAR(result["sinkage_exponent"], 0.9, 1e-4);
  EXPECT_NEAR(result["cohesive_modulus"], 5000.0, 20.0);
}

TEST(EstimateCommand, ErrorsAreOneLineWithTheirExitCode) {
  const BadFiles files;
  const auto write = [&](const char* name, const std::string& text) { files.folder().write(name, text); };
  write("good.csv", drive());
  write("lacking.csv", "load_N,torque_Nm\n80,3\n");
  write("unusable.csv", std::string(kHeader) + "80,3,0.01,-0.5,0.1,0.1\n");
  write("two.csv", drive() + "80,3,0.01,0.5,0.2,0.1\n");
  write("one.csv", std::string(kHeader) + "80,3,0.01,0.5,0.1,0.1\n");
  write("plates.csv", "plate_width_m,pressure_Pa,sinkage_m\n0.1,1e4,0.01\n0.1,2e4,0.02\n");
  const auto by = [](const std::string& method, const std::string& table,
                     const std::vector<std::string>& more = {}) {
    return joined({"estimate", table, "--method", method}, more);
  };
  expectRefused(files, {{by("iagnemma", "lacking.csv"), 2, "sinkage_m"},
                        {by("iagnemma", "unusable.csv"), 2, "no usable row"},
                        {by("iagnemma", "two.csv"), 2, "wheels of several sizes"},
                        {by("iagnemma", "one.csv", {"--shear-modulus", "0.02"}), 1, "at least two samples"},
                        {by("bevameter", "good.csv"), 2, "plate test"},
                        {by("iagnemma", "good.csv", {"--shear-modulus", "soft"}), 2, "soft"},
                        {by("iagnemma", "good.csv", {"--prior", "no_such"}), 2, "no_such"},
                        {by("bevameter", "plates.csv", {"--recursive"}), 2, "--recursive"},
                        {by("bevameter", "plates.csv", {"--prior", "sand"}), 2, "no shear test"},
                        {by("wong-reece", "good.csv", {"--prior", "no_such"}), 2, "no_such"}});
}

TEST(EstimateCommand, ModelEffectsAreAppliedAndListed) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  const std::string soil = "soil: loam\nmodel: wong-reece\n";
  const std::string bare = folder.write("bare.yaml", soil);
  const std::string digs = folder.write(
      "digs.yaml", soil +
                       "effects: [{name: slip_sinkage_ding, parameters: [0.6]}, {name: torque_offset, "
                       "parameters: [0.8]}]\n");
  const json plain = estimated({"--method", "wong-reece", "--model", bare}, table);
  const json dug = estimated({"--method", "wong-reece", "--model", digs}, table);
  EXPECT_FALSE(plain.contains("effects"));
  EXPECT_EQ(dug.at("effects"), json({"slip_sinkage_ding", "torque_offset"}));
  EXPECT_EQ(dug.at("rows_used"), 10);
  // Property: a torque offset of the sensor is not attributed to the soil strength.
  const auto strength = [](const json& e) {
    return e.at("cohesion_Pa").get<double>() + 10e3 * e.at("tan_friction").get<double>();
  };
  EXPECT_LT(strength(dug), strength(plain));
}

TEST(EstimateCommand, ModelRequiresWongReece) {
  const Folder folder;
  const std::string table = folder.write("drive.csv", drive());
  const std::string model = folder.write("m.yaml", "soil: loam\nmodel: wong-reece\n");
  const Ran linear = runTalus({"estimate", table, "--method", "linear-offset", "--model", model});
  EXPECT_EQ(linear.code, 2);
  EXPECT_THAT(linear.err, HasSubstr("use --method wong-reece"));
  const Ran row = runTalus({"estimate", table, "--method", "wong-reece", "--recursive", "--model", model});
  EXPECT_EQ(row.code, 2);
  EXPECT_THAT(row.err, HasSubstr("--recursive"));
  const std::string formula = folder.write("f.yaml", "soil: loam\nmodel: linear-formula\n");
  EXPECT_EQ(runTalus({"estimate", table, "--method", "wong-reece", "--model", formula}).code, 2);
}

}  // namespace estimate_command_test
}  // namespace talus::cli
