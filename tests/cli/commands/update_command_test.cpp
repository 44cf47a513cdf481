#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/terramech/contact/rover.hpp>
#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/io/soil_library.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace update_command_test {

using nlohmann::json;

const std::vector<std::string> kGround{"flat.asc", "--ignore-crs", "--resolution", "1",
                                       "--soil",   "sandy_loam",   "--rover",      "sojourner"};

// A flat site of sandy loam and its traversability map.
class Site {
 public:
  Site() {
    folder.write("flat.asc", asciiGrid(60, 40, [](int, int) { return 0.0; }));
    std::vector<std::string> words{"costmap"};
    words.insert(words.end(), kGround.begin(), kGround.end());
    words.insert(words.end(), {"-o", "map.ot"});
    EXPECT_EQ(runTalus(words, folder.path()).code, 0);
  }

  json run(const std::vector<std::string>& words) const {
    const Ran ran = runTalus(words, folder.path());
    EXPECT_EQ(ran.code, 0) << ran.err;
    warnings = ran.err;
    return json::parse(ran.out);
  }

  // Value of a named entry of `causes` that `talus explain` prints for a cell.
  double cause(const std::string& map, const std::string& place, const std::string& name) const {
    const json why = run({"explain", map, "--at", place, "--json"});
    for (const json& cause : why["causes"])
      if (cause["name"] == name) return cause["value"];
    ADD_FAILURE() << name;
    return std::nan("");
  }

  Folder folder;
  mutable std::string warnings;
};

// Telemetry of the rover's four wheels on a drive east along y = 20 over the given soil; `off_Nm` is a torque
// offset.
std::string driveOver(const terramech::Soil& soil, double off_Nm = 0.0) {
  const terramech::Rover rover = terramech::loadRover("sojourner");
  const double load_N = terramech::wheelLoad_N(rover);
  std::string text = "run,wheel,time_s,x_m,y_m,heading_rad,slope_rad,load_N,slip,torque_Nm,sinkage_m\n";
  for (int moment = 0; moment < 20; ++moment)
    for (int wheel = 0; wheel < 4; ++wheel) {
      const double slip = 0.35 + 0.01 * moment;
      const auto forces = terramech::equilibrium(soil, rover.wheel, {.load_N = load_N, .slip = slip});
      text += fmt::format("a,w{},{},{},{},0,{},{},{},{},{}\n", wheel, moment, 10 + moment + 0.3 * (wheel / 2),
                          20.2 - 0.4 * (wheel % 2), std::atan(forces.drawbar_pull_N / load_N), load_N, slip,
                          forces.torque_Nm + off_Nm, forces.sinkage_m);
    }
  return text;
}

void changeDatabase(const std::string& path, const char* sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(database);
  sqlite3_close(database);
}

terramech::Soil weak() {
  terramech::Soil soil = terramech::loadSoil("sandy_loam");
  soil.friction_angle_rad *= 0.8;
  soil.cohesion_Pa *= 0.5;
  return soil;
}

TEST(UpdateCommand, WeakGroundIsEstimatedAndExplained) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  const json out = site.run({"update", "map.ot", "t.csv", "-o", "map2.ot", "--json"});
  EXPECT_EQ(out["rows_used"], 80);
  EXPECT_EQ(out["rows_rejected"], 0);
  EXPECT_GT(out["cells_changed"].get<int>(), 50);
  EXPECT_TRUE(out["categories_changed"].is_number());
  const double before = site.cause("map.ot", "20,20", "drawbar_pull_over_load"),
               after = site.cause("map2.ot", "20,20", "drawbar_pull_over_load");
  const terramech::Rover rover = terramech::loadRover("sojourner");
  const double load_N = terramech::wheelLoad_N(rover);
  // Closed form: the forward model at the reference slip on the true soil
  const double truth =
      terramech::equilibrium(weak(), rover.wheel, {.load_N = load_N, .slip = 0.5}).drawbar_pull_N / load_N;
  EXPECT_LT(std::abs(after - truth), 0.4 * std::abs(before - truth))
      << before << ' ' << after << ' ' << truth;
}

TEST(UpdateCommand, RepeatedUpdateYieldsTheSameMap) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  site.run({"update", "map.ot", "t.csv", "-o", "a.ot", "--journal", "e.db", "--json"});
  site.run({"update", "map.ot", "t.csv", "-o", "b.ot", "--json"});
  site.run({"update", "map.ot", "--replay", "--journal", "e.db", "-o", "c.ot", "--json"});
  EXPECT_EQ(fileContent(site.folder / "a.ot"), fileContent(site.folder / "b.ot"));
  EXPECT_EQ(fileContent(site.folder / "a.ot"), fileContent(site.folder / "c.ot"));
  EXPECT_NE(fileContent(site.folder / "a.ot"), fileContent(site.folder / "map.ot"));
}

// The journal cannot rebuild a map that contains drives missing from the journal; the update must warn.
TEST(UpdateCommand, MissingJournalDrivesAreReported) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  site.folder.write("u.csv", driveOver(weak(), 0.1));
  site.run({"update", "map.ot", "t.csv", "-o", "a.ot", "--journal", "e.db", "--json"});
  EXPECT_EQ(site.warnings.find("lacks"), std::string::npos);
  site.run({"update", "a.ot", "u.csv", "-o", "b.ot", "--journal", "other.db", "--json"});
  EXPECT_NE(site.warnings.find("the journal lacks 1 drive that the map contains"), std::string::npos)
      << site.warnings;
  site.run({"update", "a.ot", "u.csv", "-o", "b.ot", "--journal", "e.db", "--json"});
  EXPECT_EQ(site.warnings.find("lacks"), std::string::npos);
}

// Property: a journal without usable rows for the map is refused. Otherwise the new map would list drives
// whose evidence the map does not contain, and a later update with those drives would be skipped.
TEST(UpdateCommand, JournalOfAnotherAreaIsRejected) {
  const Site site;
  site.folder.write("d.csv", driveOver(terramech::loadSoil("dry_sand")));
  site.run({"update", "map.ot", "d.csv", "-o", "b.ot", "--journal", "e.db", "--json"});
  std::string far = asciiGrid(20, 20, [](int, int) { return 0.0; });
  site.folder.write("far.asc", far.replace(far.find("xllcorner 0"), 11, "xllcorner 5000"));
  std::vector<std::string> words{"costmap", "far.asc"};
  words.insert(words.end(), kGround.begin() + 1, kGround.end());
  words.insert(words.end(), {"-o", "far.ot"});
  ASSERT_EQ(runTalus(words, site.folder.path()).code, 0);
  const Ran ran =
      runTalus({"update", "far.ot", "--replay", "--journal", "e.db", "-o", "c.ot"}, site.folder.path());
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, testing::HasSubstr("e.db: none of its 80 rows lies on this map"));
}

TEST(UpdateCommand, JournalWithMissingOrModifiedRowsIsRejected) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  site.folder.write("u.csv", driveOver(weak(), 0.1));
  for (const char* sql : {"DELETE FROM evidence WHERE id = 5", "DELETE FROM evidence",
                          "UPDATE evidence SET slip = 0.1 WHERE id = 2",
                          "UPDATE evidence SET id = -1 WHERE id = 5; UPDATE evidence SET id = 5 WHERE id = 6;"
                          "UPDATE evidence SET id = 6 WHERE id = -1"}) {
    std::filesystem::remove(site.folder / "e.db");
    site.run({"update", "map.ot", "t.csv", "-o", "a.ot", "--journal", "e.db", "--json"});
    changeDatabase(site.folder / "e.db", sql);
    const std::string before = fileContent(site.folder / "e.db");
    const Ran ran =
        runTalus({"update", "a.ot", "u.csv", "-o", "b.ot", "--journal", "e.db"}, site.folder.path());
    EXPECT_EQ(ran.code, 2) << sql;
    EXPECT_NE(ran.err.find("checksum mismatch"), std::string::npos) << ran.err;
    EXPECT_EQ(fileContent(site.folder / "e.db"), before) << sql;
    EXPECT_FALSE(std::filesystem::exists(site.folder / "b.ot"));
  }
}

TEST(UpdateCommand, RowsOfAGrownOrRepeatedLogCountOnce) {
  const Site site;
  const std::string all = driveOver(terramech::loadSoil("dry_sand")), rows = all.substr(all.find('\n') + 1);
  std::size_t half = 0;
  for (int line = 0; line < 41; ++line) half = all.find('\n', half) + 1;
  site.folder.write("half.csv", all.substr(0, half));
  site.folder.write("all.csv", all);
  site.folder.write("twice.csv", all + rows);
  const json whole = site.run({"update", "map.ot", "all.csv", "-o", "whole.ot", "--json"});
  site.run({"update", "map.ot", "half.csv", "-o", "half.ot", "--json"});
  const json further = site.run({"update", "half.ot", "all.csv", "-o", "grown.ot", "--json"});
  EXPECT_EQ(further["rows_counted_before"], 40);
  EXPECT_EQ(further["rows_used"].get<int>() + further["rows_rejected"].get<int>() + 40,
            whole["rows_used"].get<int>() + whole["rows_rejected"].get<int>());
  EXPECT_THAT(
      site.warnings,
      testing::HasSubstr(
          "all.csv: the first 40 rows of this drive are in the map already; the later rows are added"));
  const json doubled = site.run({"update", "map.ot", "twice.csv", "-o", "twice.ot", "--json"});
  EXPECT_EQ(doubled["rows_used"], whole["rows_used"]);
  EXPECT_EQ(doubled["rows_counted_before"], 80);
  EXPECT_THAT(site.warnings, testing::HasSubstr("twice.csv: 80 rows repeat earlier rows in every field"));
  EXPECT_EQ(fileContent(site.folder / "twice.ot"), fileContent(site.folder / "whole.ot"));
}

TEST(UpdateCommand, UnusableRowsAreCountedAndReported) {
  const Site site;
  const std::string text = driveOver(weak()) + "a,w0,30,500,20,0,0,10,0.2,0.1,0.01\n" +  // off the map
                           "a,w0,31,20,20,0,0,-3,0.2,0.1,0.01\n" +                       // load <= 0
                           "a,w0,2,20,20,0,0,10,0.4,0.1,0.01\n";                         // time decreases
  site.folder.write("t.csv", text);
  const json out = site.run({"update", "map.ot", "t.csv", "-o", "map2.ot", "--json"});
  EXPECT_EQ(out["rows_used"], 81);
  EXPECT_EQ(out["rows_rejected"], 2);
  EXPECT_NE(site.warnings.find("t.csv:83"), std::string::npos) << site.warnings;
  EXPECT_NE(site.warnings.find("time decreases"), std::string::npos) << site.warnings;
}

TEST(UpdateCommand, TorqueOffsetIsReportedAndExcluded) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  site.folder.write("biased.csv", driveOver(weak(), 0.3));
  site.run({"update", "map.ot", "t.csv", "-o", "sound.ot", "--json"});
  site.run({"update", "map.ot", "biased.csv", "-o", "biased.ot", "--json"});
  EXPECT_NE(site.warnings.find("torque offset"), std::string::npos) << site.warnings;
  EXPECT_NEAR(site.cause("biased.ot", "20,20", "drawbar_pull_over_load"),
              site.cause("sound.ot", "20,20", "drawbar_pull_over_load"), 0.03);
}

TEST(UpdateCommand, SimulatedTelemetryUpdatesTheMap) {
  const Site site;
  site.folder.write("truth.yaml", "classes: {0: lunar_nominal}\n");
  std::vector<std::string> words{"drive"};
  words.insert(words.end(), kGround.begin(), kGround.end());
  words.insert(words.end(), {"--truth", "truth.yaml", "--start", "5,20", "--goal", "50,20", "--telemetry",
                             "t.csv", "--json"});
  const Ran ran = runTalus(words, site.folder.path());
  ASSERT_TRUE(ran.code == 0 || ran.code == 1) << ran.err;
  const json out = site.run({"update", "map.ot", "t.csv", "-o", "map2.ot", "--json"});
  EXPECT_GT(out["rows_used"].get<int>(), 4);
  EXPECT_EQ(out["rows_rejected"], 0) << site.warnings;
  EXPECT_GT(out["cells_changed"].get<int>(), 0);
}

TEST(BadInput, InvalidUpdateCallsAreRejectedWithOneLine) {
  const Site site;
  const BadFiles files;
  std::filesystem::copy(site.folder / "map.ot", files.folder() / "map.ot");
  const std::string unfed = files.folder() / "unfed.db";
  costmap::EvidenceJournal{unfed};
  files.folder().write("off.csv", "x_m,y_m,load_N,slip,slope_rad\n900,900,10,0.2,0\n");
  files.folder().write("t.csv", driveOver(weak()));
  const Folder other;
  std::filesystem::create_symlink(other / "none.db", files.folder() / "far.db");
  expectRefused(files,
                {
                    {{"update", "map.ot", "missing.csv", "-o", "m.ot"}, 2, "missing.csv"},
                    {{"update", "map.ot", "empty.csv", "-o", "m.ot"}, 2, "empty.csv"},
                    {{"update", "map.ot", "wrong_columns.csv", "-o", "m.ot"}, 2, "wrong_columns.csv"},
                    {{"update", "map.ot", "off.csv", "-o", "m.ot"}, 2, "off.csv"},
                    {{"update", "map.ot", "-o", "m.ot"}, 2, "telemetry"},
                    {{"update", "map.ot", "--replay", "-o", "m.ot"}, 2, "--journal"},
                    {{"update", "map.ot", "--replay", "--journal", "no.db", "-o", "m.ot"}, 2, "no.db"},
                    {{"update", "map.ot", "--replay", "--journal", "empty", "-o", "m.ot"}, 2, "empty"},
                    {{"update", "map.ot", "--replay", "--journal", unfed, "-o", "m.ot"}, 2, "unfed"},
                    {{"update", "map.ot", "empty.csv", "--journal", "new.db", "-o", "m.ot"}, 2, "empty"},
                    {{"update", "flat.asc", "off.csv", "--journal", "new.db", "-o", "m.ot"}, 2, "flat"},
                    {{"update", "map.ot", "off.csv", "-o", "no/m.ot"}, 2, "no"},
                    {{"update", "map.ot", "t.csv", "-o", "m.ot", "--journal", ""}, 2, "its value is empty"},
                    {{"update", "map.ot", "t.csv", "-o", "m.ot", "--journal", ":memory:"}, 2, "name a file"},
                    {{"update", "map.ot", "t.csv", "-o", "m.ot", "--journal", "file:z.db?mode=memory"},
                     2,
                     "name a file"},
                    {{"update", "map.ot", "t.csv", "-o", "m.ot", "--journal", "z.db/"}, 2, "folder"},
                    {{"update", "map.ot", "t.csv", "-o", "m.ot", "--journal", "far.db"}, 2, "is a link to"},
                });
}

}  // namespace update_command_test
}  // namespace talus::cli
