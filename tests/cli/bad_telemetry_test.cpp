// Tables of measurements, models and maps of beliefs that cannot be used, told in one line by every command
// that reads them.
#include <filesystem>

#include <gmock/gmock.h>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace bad_telemetry_test {

TEST(BadInput, Telemetry) {
  std::vector<BadCall> calls{
      {{"estimate"}, 2, "talus estimate --help"},
      {{"estimate", "words.csv", "--method", "foo"}, 2, "foo not in"},
      {{"assess", "words.csv", "--slope", "9"}, 2, ""},
      {{"trace", "words.csv", "--base", "list.yaml"}, 2, ".yaml"},
      {{"predict", "words.csv", "--model", "missing.yaml", "-o", "out.csv"}, 2, "missing.yaml"},
      {{"predict", "words.csv", "--model", "nan.yaml", "-o", "out.csv"}, 2, "nan.yaml"},
  };
  for (const char* file : {"missing.csv", "folder", "empty.csv", "head_only.csv", "wrong_columns.csv",
                           "words.csv", "garbage.csv"}) {
    calls.push_back({{"estimate", file, "--method", "iagnemma"}, 2, file});
    calls.push_back({{"assess", file}, 2, file});
    calls.push_back({{"trace", file}, 2, file});
  }
  expectRefused(BadFiles(), calls);
}

// Property: every table of wheels is held to the units of its columns; nothing is written of one that is not.
TEST(BadInput, AKnownColumnInAnotherUnit) {
  const Folder folder;
  const std::string rows = "\n80,0.2,2,12,0.1,0.1\n90,0.3,3,15,0.1,0.1\n";
  folder.write("t.csv", "load_N,slip,torque_Nm,sinkage_mm,wheel_radius_m,wheel_width_m" + rows);
  folder.write("c.csv", "cohesion_Pa,friction_angle_deg\n800,30\n");
  for (const std::vector<std::string>& call : {std::vector<std::string>{"trace", "t.csv", "--html", "out"},
                                               {"estimate", "t.csv", "--method", "wong-reece"},
                                               {"estimate", "t.csv", "--method", "bevameter"},
                                               {"assess", "t.csv", "--html", "out"},
                                               {"assess", "t.csv", "--model", "sandy_loam"},
                                               {"predict", "t.csv", "--model", "sandy_loam", "-o", "out"}}) {
    const Ran ran = runTalus(call, folder.path());
    EXPECT_EQ(ran.code, 2) << call[0];
    EXPECT_THAT(ran.err,
                testing::HasSubstr("t.csv:1: column sinkage_mm is in another unit than it is read in; write "
                                   "column sinkage_m, in m (sinkage_mm times 0.001)"))
        << call[0];
    EXPECT_EQ(ran.out, "");
  }
  const Ran ran = runTalus({"wheel", "--cases", "c.csv", "-o", "out"}, folder.path());
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, testing::HasSubstr("c.csv:1: column friction_angle_deg"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(BadInput, MapsOfBeliefs) {
  const std::vector<std::string> site{"good.asc",   "--resolution", "1",   "--soil",
                                      "sandy_loam", "--rover",      "fido"};
  const auto with = [&site](const char* command, const std::vector<std::string>& more) {
    std::vector<std::string> words{command};
    words.insert(words.end(), site.begin(), site.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
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

TEST(BadInput, SitesAndPlugins) {
  expectRefused(BadFiles(),
                {
                    {{"generate"}, 2, "KIND"},
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
