#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <talus/costmap/journal/evidence_journal.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/terramech_io.hpp>

#include "bad_input.hpp"

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
    EXPECT_EQ(runTalus(joined(joined({"costmap"}, kGround), {"-o", "map.ot"}), folder.path()).code, 0);
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

  // Starts an update in the background; the caller waits for it.
  pid_t start(const std::string& journal, const std::string& output) const {
    const pid_t child = ::fork();
    if (child != 0) return child;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    if (::chdir(folder.path().c_str()) != 0) ::_exit(99);
    ::execl(TALUS_PROGRAM, "talus", "update", "map.ot", "t.csv", "-o", output.c_str(), "--journal",
            journal.c_str(), static_cast<char*>(nullptr));
    ::_exit(98);
  }

  int code(const std::vector<std::string>& words) const { return runTalus(words, folder.path()).code; }

  json replay(const std::string& journal, const std::string& output) const {
    return run({"update", "map.ot", "--replay", "--journal", journal, "-o", output, "--json"});
  }

  std::string content(const std::string& name) const { return fileContent(folder / name); }

  Folder folder;
  mutable std::string warnings;
};

// A site with a drive of 60 rows.
struct DrivenSite : Site {
  DrivenSite() {
    std::string text = "time_s,x_m,y_m,slope_rad,load_N,slip\n";
    for (int row = 0; row < 60; ++row)
      text += fmt::format("{},{},20.5,0.02,10,{}\n", row, 5.0 + 0.8 * row, 0.3 + 0.001 * (row % 7));
    folder.write("t.csv", text);
  }
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
  std::vector<std::string> ground = kGround;
  ground[0] = "far.asc";
  ASSERT_EQ(site.code(joined(joined({"costmap"}, ground), {"-o", "far.ot"})), 0);
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
}

TEST(UpdateCommand, TorqueOffsetDoesNotChangeTheEstimate) {
  const Site site;
  site.folder.write("t.csv", driveOver(weak()));
  site.folder.write("biased.csv", driveOver(weak(), 0.3));
  site.run({"update", "map.ot", "t.csv", "-o", "sound.ot", "--json"});
  site.run({"update", "map.ot", "biased.csv", "-o", "biased.ot", "--json"});
  EXPECT_NEAR(site.cause("biased.ot", "20,20", "drawbar_pull_over_load"),
              site.cause("sound.ot", "20,20", "drawbar_pull_over_load"), 0.03);
}

TEST(UpdateCommand, SimulatedTelemetryUpdatesTheMap) {
  const Site site;
  site.folder.write("truth.yaml", "classes: {0: lunar_nominal}\n");
  const Ran ran =
      runTalus(joined(joined({"drive"}, kGround), {"--truth", "truth.yaml", "--start", "5,20", "--goal",
                                                   "50,20", "--telemetry", "t.csv", "--json"}),
               site.folder.path());
  ASSERT_TRUE(ran.code == 0 || ran.code == 1) << ran.err;
  const json out = site.run({"update", "map.ot", "t.csv", "-o", "map2.ot", "--json"});
  EXPECT_GT(out["rows_used"].get<int>(), 4);
  EXPECT_EQ(out["rows_rejected"], 0) << site.warnings;
  EXPECT_GT(out["cells_changed"].get<int>(), 0);
}

// A drive is counted once in map and journal if an update is killed at a random time and repeated. The
// environment variable TALUS_KILLS sets the number of kills (default 40).
TEST(UpdateCommand, DriveIsCountedOnceAfterRetryWhenKilledAtAnyMoment) {
  const DrivenSite site;
  ASSERT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "whole.ot"}), 0);
  const std::string whole = site.content("whole.ot");
  const auto began = std::chrono::steady_clock::now();
  int status = 0;
  ::waitpid(site.start("timing.db", "timing.ot"), &status, 0);
  ASSERT_EQ(status, 0);
  const auto takes = std::chrono::steady_clock::now() - began;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0.0, 1.2);
  const char* more = std::getenv("TALUS_KILLS");
  const int kills = more != nullptr ? std::atoi(more) : 40;
  for (int kill = 0; kill < kills; ++kill) {
    const pid_t child = site.start("evidence.db", "out.ot");
    std::this_thread::sleep_for(moment(random) * takes);
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    const std::string out = site.content("out.ot");
    ASSERT_TRUE(out.empty() || out == whole) << "a partial map after kill " << kill;
    if (kill % 4 != 3) continue;
    ASSERT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "retry.ot", "--journal", "evidence.db"}), 0);
    ASSERT_EQ(site.content("retry.ot"), whole) << kill;
    EXPECT_EQ(site.replay("evidence.db", "again.ot")["rows_used"], 60);
    ASSERT_EQ(site.content("again.ot"), whole) << kill;
    for (const char* name :
         {"evidence.db", "evidence.db-wal", "evidence.db-shm", "out.ot", "retry.ot", "again.ot"})
      std::filesystem::remove(site.folder / name);
  }
}

TEST(UpdateCommand, FailedUpdateLeavesTheJournalUnchanged) {
  const DrivenSite site;
  EXPECT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "no/out.ot", "--journal", "e.db"}), 2);
  site.folder.write("off.csv", "time_s,x_m,y_m,slope_rad,load_N,slip\n1,900,900,0,10,0.3\n");
  EXPECT_EQ(site.code({"update", "map.ot", "off.csv", "-o", "out.ot", "--journal", "e.db"}), 2);
  EXPECT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "out.ot", "--journal", "e.db"}), 0);
  EXPECT_EQ(site.replay("e.db", "again.ot")["rows_used"], 60);
  EXPECT_EQ(site.content("again.ot"), site.content("out.ot"));
}

// A drive is identified by its content, not by its file name.
TEST(UpdateCommand, RepeatedDriveIsCountedOnceWithAWarning) {
  const DrivenSite site;
  site.folder.write("copy.csv", site.content("t.csv"));
  ASSERT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "a.ot", "--journal", "e.db"}), 0);
  const Ran again =
      runTalus({"update", "a.ot", "copy.csv", "-o", "b.ot", "--journal", "e.db"}, site.folder.path());
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.err,
              testing::HasSubstr("all rows of this drive are in the map already; no row is added"));
  EXPECT_EQ(site.content("a.ot"), site.content("b.ot"));
  EXPECT_EQ(site.replay("e.db", "c.ot")["rows_used"], 60);
}

// Two updates in sequence, each starting from the map of the update before, equal one replay of both drives.
TEST(UpdateCommand, SequentialUpdatesEqualOneReplay) {
  const DrivenSite site;
  std::string text = "time_s,x_m,y_m,slope_rad,load_N,slip\n";
  for (int row = 0; row < 60; ++row)
    text += fmt::format("{},{},22.5,0.02,10,{}\n", 100 + row, 50.0 - 0.7 * row, 0.5 + 0.001 * (row % 7));
  site.folder.write("back.csv", text);
  ASSERT_EQ(site.code({"update", "map.ot", "t.csv", "-o", "first.ot", "--journal", "e.db"}), 0);
  ASSERT_EQ(site.code({"update", "first.ot", "back.csv", "-o", "both.ot", "--journal", "e.db"}), 0);
  EXPECT_EQ(site.replay("e.db", "again.ot")["rows_used"], 120);
  EXPECT_TRUE(site.content("both.ot") == site.content("again.ot"));
}

TEST(UpdateCommand, ConcurrentUpdatesShareAJournal) {
  const DrivenSite site;
  const pid_t a = site.start("evidence.db", "a.ot"), b = site.start("evidence.db", "b.ot");
  int first = -1, second = -1;
  ::waitpid(a, &first, 0);
  ::waitpid(b, &second, 0);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 0);
  EXPECT_EQ(site.content("a.ot"), site.content("b.ot"));
  EXPECT_EQ(site.replay("evidence.db", "c.ot")["rows_used"], 60);
  EXPECT_EQ(site.content("a.ot"), site.content("c.ot"));
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
