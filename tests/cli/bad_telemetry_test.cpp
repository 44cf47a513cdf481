// Unusable telemetry tables, models and traversability maps: every subcommand that reads such a file reports
// the error in one line.
#include <filesystem>

#include <gmock/gmock.h>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace bad_telemetry_test {

TEST(BadInput, InvalidTelemetryIsRejectedWithOneLine) {
  std::vector<BadCall> calls{
      {{"estimate"}, 2, "talus estimate --help"},
      {{"estimate", "words.csv", "--method", "foo"}, 2, "foo not in"},
      {{"assess", "words.csv", "--slope", "9"}, 2, ""},
      {{"trace", "words.csv", "--base", "list.yaml"}, 2, ".yaml"},
      {{"predict", "words.csv", "--model", "missing.yaml", "-o", "out.csv"}, 2, "missing.yaml"},
      {{"predict", "words.csv", "--model", "nan.yaml", "-o", "out.csv"}, 2, "nan.yaml"},
      {{"predict", "words.csv", "--model", "sandy_loam"}, 2, "--output"},
      {{"predict", "words.csv", "--model", "sandy_loam", "--rover", "mer", "-o", "o.csv"},
       2,
       "load_N is missing"},
  };
  for (const char* file : {"missing.csv", "folder", "empty.csv", "head_only.csv", "wrong_columns.csv",
                           "words.csv", "garbage.csv"}) {
    calls.push_back({{"estimate", file, "--method", "iagnemma"}, 2, file});
    calls.push_back({{"assess", file}, 2, file});
    calls.push_back({{"trace", file}, 2, file});
  }
  expectRefused(BadFiles(), calls);
}

// Property: a unit conversion of a column is reported. A column in an unknown unit is refused without output.
TEST(BadInput, KnownColumnInAnotherUnitIsRejectedByEveryCommand) {
  const Folder folder;
  folder.write("t.csv",
               "load_N,slip,torque_Nm,sinkage_mm,wheel_radius_m,wheel_width_m\n80,0.2,2,12,0.1,0.1\n");
  folder.write("g.csv",
               "load_kg,slip,torque_Nm,sinkage_mm,wheel_radius_m,wheel_width_m\n80,0.2,2,12,0.1,0.1\n");
  for (const std::vector<std::string>& call : {std::vector<std::string>{"trace", "FILE", "--html", "out"},
                                               {"estimate", "FILE", "--method", "wong-reece"},
                                               {"estimate", "FILE", "--method", "bevameter"},
                                               {"assess", "FILE"},
                                               {"assess", "FILE", "--model", "sandy_loam"},
                                               {"predict", "FILE", "--model", "sandy_loam", "-o", "out"}}) {
    const auto of = [&](const std::string& file) {
      std::vector<std::string> words = call;
      words[1] = file;
      return runTalus(words, folder.path());
    };
    EXPECT_THAT(of("t.csv").err,
                testing::HasSubstr("t.csv: column sinkage_mm is read as sinkage_m, times 0.001\n"))
        << call[0];
    std::filesystem::remove(folder / "out");
    const Ran ran = of("g.csv");
    EXPECT_EQ(ran.code, 2) << call[0];
    EXPECT_THAT(ran.err, testing::HasSubstr("g.csv:1: column load_kg has another unit than the known column"))
        << call[0];
    EXPECT_EQ(ran.out, "");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }
}

TEST(BadInput, InvalidColumnMappingsAreRejected) {
  const Folder folder;
  folder.write("t.csv", "Fz;slip_pct;T;z\n80;20;2;0,012\n");
  folder.write("columns", "load_N=Fz\n\n# remark\nslip=slip_pct:percent\nload_N=T\n");
  const auto line = [&](const std::vector<std::string>& more) {
    const Ran ran = runTalus(joined({"assess", "t.csv"}, more), folder.path());
    EXPECT_EQ(ran.code, 2) << ran.out;
    return ran.err;
  };
  EXPECT_THAT(line({"--column", "load_N"}), testing::HasSubstr("'load_N' is not KNOWN=NAME[:UNIT]"));
  EXPECT_THAT(line({"--column", "load=Fz"}), testing::HasSubstr("did you mean load_N?"));
  EXPECT_THAT(line({"--column", "load_N=Fz", "--column", "load_N=T"}),
              testing::HasSubstr("load_N is mapped twice"));
  EXPECT_THAT(line({"--column", "load_N=Fz:deg"}), testing::HasSubstr("'deg' is no unit of load_N"));
  EXPECT_THAT(line({"--columns", "columns"}), testing::HasSubstr("load_N is mapped twice"));
  EXPECT_THAT(line({"--columns", "missing"}), testing::HasSubstr("missing: cannot be opened"));
  EXPECT_THAT(line({"--radius", "0"}), testing::HasSubstr("--radius"));
  EXPECT_THAT(line({}), testing::HasSubstr("no column load_N"));
}

TEST(BadInput, InvalidTraversabilityMapCallsAreRejectedWithOneLine) {
  const std::vector<std::string> site{"good.asc",   "--resolution", "1",   "--soil",
                                      "sandy_loam", "--rover",      "fido"};
  const auto with = [&site](const char* command, const std::vector<std::string>& more) {
    std::vector<std::string> words{command};
    words.insert(words.end(), site.begin(), site.end());
    return joined(words, more);
  };
  expectRefused(BadFiles(), {
                                {{"costmap"}, 2, "DEM"},
                                {{"costmap", "missing.tif", "-o", "m.ot"}, 2, "missing.tif"},
                                {{"costmap", "one.asc", "--resolution", "1", "-o", "m.ot"}, 2, "one.asc"},
                                {{"costmap", "head.ot", "-o", "m.ot"}, 2, "head.ot"},
                                {with("costmap", {"-o", "no/m.ot"}), 2, "no/m.ot"},
                                {with("costmap", {"--png", "no/p.png"}), 2, "no/p.png"},
                                {with("costmap", {"--geotiff", "no/l.tif"}), 2, "no/l.tif"},
                                {with("costmap", {"--octovis", "folder"}), 2, "is a directory"},
                                {with("costmap", {"--footprint", "nan"}), 2, "--footprint"},
                                {with("explain", {}), 2, "--at"},
                                {with("explain", {"--at", "5"}), 2, "--at 5"},
                                {with("explain", {"--at", "500,5"}), 2, "outside"},
                                {with("explain", {"--at", "5,5", "--heading", "nan"}), 2, "--heading"},
                                {{"update"}, 2, "MAP"},
                                {{"update", "missing.ot", "words.csv", "-o", "m.ot"}, 2, "missing.ot"},
                                {{"update", "garbage.ot", "words.csv", "-o", "m.ot"}, 2, "garbage.ot"},
                                {{"update", "head.ot", "words.csv", "-o", "m.ot"}, 2, "head.ot"},
                            });
}

TEST(BadInput, InvalidSitesAndPluginsAreRejectedWithOneLine) {
  const BadFiles files;
  expectRefused(
      files,
      {
          {{"generate"}, 2, "KIND"},
          {{"generate", "craters"}, 2, "--output is required"},
          {{"generate", "crater", "-o", "s.tif"}, 2, "crater not in {craters,dunes,rocks}"},
          {{"generate", "lake.yaml", "-o", "s.tif"}, 2, "lake.yaml not in {craters,dunes,rocks}"},
          {{"generate", "craters", "--size", "axb", "-o", "s.tif"}, 2, "--size axb"},
          {{"generate", "craters", "--size", "20000", "-o", "s.tif", "--max-memory", "512MB"}, 2, "--size: "},
          {{"generate", "craters", "-o", "no/s.tif"}, 2, "no does not exist"},
          {{"generate", "craters", "-o", "folder"}, 2, "is a directory"},
          {{"generate", "craters", "--size", "5", "-o", "s.tif"}, 2, "--size 5"},
          {{"generate", "craters", "--resolution", "nan", "-o", "s.tif"}, 2, "resolution"},
          {{"plugins", "missing.so"}, 2, "missing.so"},
          {{"plugins", "garbage.tif"}, 2, "garbage.tif"},
          {{"plugins", "folder"}, 2, "folder"},
      });
}

}  // namespace bad_telemetry_test
}  // namespace talus::cli
