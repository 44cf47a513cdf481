#include <talus/cli/soil/table_options.hpp>
#include <talus/common/common.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/io/csv_reader.hpp>

#include "run_program.hpp"

namespace talus::cli {

namespace table_options_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

const std::string kHeader =
    "id,cohesion_Pa,friction_angle_rad,sinkage_exponent,sinkage_modulus,shear_modulus_m,c1,c2,wheel_radius_m,"
    "wheel_width_m,load_N,slip,note\n";
const std::string kGood = "7,800,0.56,0.9,1.6e6,0.018,0.43,0.32,0.1,0.1,80,0.3,\"a, \"\"b\"\"\"\n";

std::vector<std::vector<std::string>> rowsOf(const std::string& path) {
  terramech::CsvReader reader{path};
  std::vector<std::vector<std::string>> rows{reader.header()};
  for (terramech::CsvRow row; reader.next(row);) rows.push_back(row.fields);
  return rows;
}

std::string errorOf(const Folder& folder, const std::string& content) {
  try {
    solveWheelTable(folder.write("in.csv", content), folder / "out.csv", 2, {});
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(WheelCaseTable, ForcesAreAppendedAndEveryColumnKept) {
  const Folder folder;
  const WheelCaseTable table =
      solveWheelTable(folder.write("in.csv", kHeader + kGood), folder / "out.csv", 2, {});
  EXPECT_EQ(table.solved, 1U);
  const auto rows = rowsOf(folder / "out.csv");
  ASSERT_THAT(rows, SizeIs(2));
  ASSERT_THAT(rows[0], SizeIs(17));
  EXPECT_EQ(rows[0][13], "sinkage_m");
  EXPECT_EQ(rows[1][0], "7");
  EXPECT_EQ(rows[1][4], "1.6e6");
  EXPECT_EQ(rows[1][12], "a, \"b\"");
  const auto want = terramech::equilibrium({.name = "",
                                            .cohesion_Pa = 800.0,
                                            .friction_angle_rad = 0.56,
                                            .sinkage_exponent = 0.9,
                                            .frictional_modulus = 1.6e6,
                                            .shear_modulus_m = 0.018},
                                           {}, {.load_N = 80.0, .slip = 0.3});
  EXPECT_NEAR(std::stod(rows[1][13]) / want.sinkage_m, 1.0, 1e-8);  // Property: equal to the solver.
  EXPECT_NEAR(std::stod(rows[1][16]), want.drawbar_pull_N, 1e-6);
}

TEST(WheelCaseTable, SlipAngleYieldsASideForce) {
  const Folder folder;
  std::string header = kHeader, good = kGood;
  header.replace(header.find("slip,"), 5, "slip,slip_angle_rad,");
  good.replace(good.find("0.3,"), 4, "0.3,0.25,");
  std::string bad = good;
  bad.replace(bad.find("0.25"), 4, "1.9");
  const WheelCaseTable table =
      solveWheelTable(folder.write("in.csv", header + good + bad), folder / "out.csv", 2, {});
  const auto rows = rowsOf(folder / "out.csv");
  ASSERT_THAT(rows[0], SizeIs(19));
  EXPECT_EQ(rows[0][18], "side_force_N");
  const auto want = terramech::equilibrium({.name = "",
                                            .cohesion_Pa = 800.0,
                                            .friction_angle_rad = 0.56,
                                            .sinkage_exponent = 0.9,
                                            .frictional_modulus = 1.6e6,
                                            .shear_modulus_m = 0.018},
                                           {}, {.load_N = 80.0, .slip = 0.3, .slip_angle_rad = 0.25});
  EXPECT_NEAR(std::stod(rows[1][18]), want.side_force_N,
              1e-4);  // Property: equal to the solver within 1e-6.
  ASSERT_THAT(table.refused, SizeIs(1));
  EXPECT_THAT(table.refused[0].reason, HasSubstr("slip_angle_rad = 1.9"));
}

TEST(WheelCaseTable, InvalidRowsAreReportedByLineAndKept) {
  const Folder folder;
  const auto with = [](const std::string& from, const std::string& to) {
    std::string row = kGood;
    return row.replace(row.find(from), from.size(), to);
  };
  const std::string input = kHeader + kGood + with(",80,", ",-80,") + with("0.56", "steep") +
                            with(",0.3,", ",1.5,") + with(",80,", ",9e6,") + "1,2,3\n" + with("800", "nan") +
                            kGood;
  const WheelCaseTable table = solveWheelTable(folder.write("in.csv", input), folder / "out.csv", 2, {});
  EXPECT_EQ(table.solved, 2U);
  ASSERT_THAT(table.refused, SizeIs(6));
  EXPECT_EQ(table.refused[0].line, 3U);
  EXPECT_THAT(table.refused[0].reason, HasSubstr("load_N = -80, must be > 0"));
  EXPECT_THAT(table.refused[1].reason, HasSubstr("friction_angle_rad = 'steep', must be a number"));
  EXPECT_THAT(table.refused[2].reason, HasSubstr("slip = 1.5, must be in [-1, 1]"));
  EXPECT_THAT(table.refused[3].reason, HasSubstr("sinks to its axle"));
  EXPECT_THAT(table.refused[4].reason, HasSubstr("has 3 fields"));
  EXPECT_THAT(table.refused[5].reason, HasSubstr("cohesion_Pa = nan, must be finite"));
  const auto rows = rowsOf(folder / "out.csv");
  EXPECT_THAT(rows, SizeIs(9));
  EXPECT_EQ(rows[2][13], "");
}

TEST(WheelCaseTable, ResultColumnsAreReplaced) {
  const Folder folder;
  const WheelCaseTable table = solveWheelTable(folder.write("in.csv", "torque_Nm," + kHeader + "99," + kGood),
                                               folder / "out.csv", 2, {});
  EXPECT_TRUE(table.replaced);
  EXPECT_THAT(rowsOf(folder / "out.csv")[0], SizeIs(17));
}

TEST(WheelCaseTable, InvalidTablesAreRejectedWithoutOutput) {
  const Folder folder;
  EXPECT_THAT(errorOf(folder, "load_N,slip\n80,0.2\n"),
              HasSubstr("in.csv:1: no column cohesion_Pa, friction_angle_rad"));
  EXPECT_THAT(errorOf(folder, kHeader), HasSubstr("no rows after the header"));
  EXPECT_THAT(errorOf(folder, kHeader + "1,2\n"), HasSubstr("in.csv:2: no row can be solved"));
  EXPECT_THAT(folder.names(), ElementsAre("in.csv"));
}

// A load above a thousand tonnes is refused before the search for an equilibrium.
TEST(WheelCaseTable, ExcessiveLoadsAreRejected) {
  const Folder folder;
  std::string row = kGood;
  row.replace(row.find(",80,"), 4, ",1e12,");
  const WheelCaseTable table =
      solveWheelTable(folder.write("in.csv", kHeader + kGood + row), folder / "out.csv", 2, {});
  EXPECT_EQ(table.solved, 1U);
  ASSERT_THAT(table.refused, SizeIs(1));
  EXPECT_THAT(table.refused[0].reason, HasSubstr("load_N = 1e12, must be at most 1e+07"));
}

}  // namespace table_options_test

}  // namespace talus::cli
