#include <filesystem>
#include <utility>

#include <sys/stat.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/common/common.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace output_file_test {

namespace fs = std::filesystem;

std::string refusal(const std::string& path, const std::vector<std::string>& inputs = {}) {
  try {
    checkOutput(path, inputs);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string missionTo(const std::string& output, const std::string& goal = "9, 9") {
  return "maps: {dem: good.asc, resolution_m: 1, ignore_crs: true}\nsoil: sandy_loam\nrover: sojourner\n"
         "start: [5, 5]\ngoal: [" +
         goal + "]\noutput: " + output + "\n";
}

TEST(CheckOutput, InputsJournalsDevicesAndForeignLinksAreProtected) {
  const Folder folder, other;
  folder.write("in.csv", "x");
  folder.write("e.db", "SQLite format 3 and more");
  other.write("far", "x");
  fs::create_symlink(other / "far", folder / "link");
  fs::create_symlink("in.csv", folder / "near");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal(folder / "in.csv", {folder.path().string() + "/./in.csv"}),
              testing::HasSubstr("also an input"));
  EXPECT_THAT(
      refusal(folder / "new", {folder.path().string() + "/../" + folder.path().filename().string() + "/new"}),
      testing::HasSubstr("also an input"));
  EXPECT_THAT(refusal(folder / "near", {folder / "in.csv"}), testing::HasSubstr("also an input"));
  EXPECT_THAT(refusal(folder / "e.db"), testing::HasSubstr("SQLite"));
  EXPECT_THAT(refusal(folder / "link"), testing::HasSubstr("link to another folder"));
  EXPECT_THAT(refusal(folder / "pipe"), testing::HasSubstr("FIFO"));
  EXPECT_THAT(refusal("/dev/null"), testing::HasSubstr("pass --force"));
  EXPECT_EQ(refusal(folder / "near"), "");
  EXPECT_EQ(refusal(folder / "in.csv", {folder / "e.db"}), "");
}

// Regression: `update -o e.db-wal --journal e.db` returned 0, but SQLite had overwritten the output file.
TEST(CheckOutput, SqliteFilesOfAJournalAreProtected) {
  const Folder folder;
  folder.write("e.db", "SQLite format 3 and more");
  folder.write("text", "x");
  fs::create_symlink("e.db-wal", folder / "link");
  for (const char* name : {"e.db-wal", "e.db-shm", "e.db-journal", "./e.db-wal", "link"})
    EXPECT_NE(refusal(folder / name), "") << name;
  EXPECT_THAT(refusal(folder / "e.db-wal"), testing::HasSubstr("is a part of the journal"));
  for (const char* name : {"text-wal", "none-wal", "e.db-wall", "e.db.ot"})
    EXPECT_EQ(refusal(folder / name), "") << name;
}

// The check also covers a journal that does not exist yet, in any spelling of both paths.
TEST(CheckOutput, OutputMustNotBePartOfTheJournal) {
  const Folder folder;
  fs::create_directory(folder / "f");
  fs::create_symlink("j.db", folder / "link.db");
  fs::create_symlink(".", folder / "here");
  const auto refused = [&](const std::string& output, const std::string& journal) {
    try {
      checkBesideJournal(folder / output, folder / journal);
    } catch (const InputError&) {
      return true;
    }
    return false;
  };
  for (const char* output : {"j.db", "j.db-wal", "f/../j.db-shm", "here/j.db-journal", "link.db"})
    for (const char* journal : {"j.db", "./j.db", "f/../j.db", "here/j.db", "link.db"})
      EXPECT_TRUE(refused(output, journal)) << output << ' ' << journal;
  EXPECT_FALSE(refused("link.db-wal", "link.db")) << "SQLite's files lie beside what the link leads to";
  EXPECT_FALSE(refused("j2.db-wal", "j.db"));
}

// Headers, data of labels, georeferences and checksums belong to an input; other files beside it do not.
TEST(CheckOutput, PartsOfAnInputAreProtected) {
  const Folder folder;
  folder.write("h.bsq", std::string(1600, '\1'));
  folder.write("h.hdr",
               "ENVI\nsamples = 20\nlines = 20\nbands = 1\nheader offset = 0\ndata type = 4\n"
               "interleave = bsq\nbyte order = 0\n");
  folder.write("p.dat", std::string(1600, '\1'));
  folder.write("p.lbl",
               "PDS_VERSION_ID = PDS3\nRECORD_TYPE = FIXED_LENGTH\nRECORD_BYTES = 80\nFILE_RECORDS = 20\n"
               "^IMAGE = \"p.dat\"\nOBJECT = IMAGE\nLINES = 20\nLINE_SAMPLES = 20\nSAMPLE_TYPE = PC_REAL\n"
               "SAMPLE_BITS = 32\nEND_OBJECT = IMAGE\nEND\n");
  for (const char* other : {"h.png", "h.bsq.sha256"}) folder.write(other, "x");
  const auto answer = [&](const std::string& output, const std::string& input) {
    try {
      checkOutput(folder / output, {folder / input});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(answer("h.hdr", "h.bsq"), testing::HasSubstr("is a part of the input"));
  EXPECT_THAT(answer("h.bsq.sha256", "h.bsq"), testing::HasSubstr("is a part of the input"));
  EXPECT_THAT(answer("p.dat", "p.lbl"), testing::HasSubstr("is a part of the input"));
  EXPECT_EQ(answer("h.png", "h.bsq"), "");
}

TEST(CheckOutput, EveryCommandProtectsItsInputs) {
  const BadFiles files;
  const std::string map = "good.asc";
  files.folder().write("mission.yaml", missionTo("words.csv"));
  const std::vector<std::string> ground{"good.asc", "--ignore-crs", "--resolution", "1"};
  const auto call = [&](const std::vector<std::string>& words, const std::vector<std::string>& more) {
    return joined(joined(words, ground), more);
  };
  expectRefused(
      files,
      {{call({"costmap"}, {"-o", "./good.asc"}), 2, "also an input"},
       {call({"costmap"}, {"-o", "m.ot", "--png", "m.ot"}), 2, "another output"},
       {call({"costmap"}, {"-o", "/dev/null"}), 2, "device"},
       {{"wheel", "--cases", "words.csv", "-o", "words.csv"}, 2, "also an input"},
       {{"update", "m.ot", "words.csv", "-o", "j.db", "--journal", "j.db"}, 2, "also an input"},
       {{"update", "m.ot", "words.csv", "-o", "j.db-wal", "--journal", "j.db"}, 2, "part of the journal"},
       {{"update", "m.ot", "words.csv", "-o", "j.db-wal", "--journal", "j.db", "--force"},
        2,
        "part of the journal"},
       {{"update", "words.csv-wal", "m.csv", "-o", "m.ot", "--journal", "words.csv"},
        2,
        "part of the journal"},
       {{"plan", "mission.yaml"}, 2, "is no route"}});
}

// Regression: `generate -o site.asc` wrote a GeoTIFF under that name.
TEST(CheckOutput, ExtensionOfAnotherFormatIsRejected) {
  const BadFiles files;
  expectRefused(
      files,
      {{{"generate", "craters", "--size", "20", "-o", "s.asc"},
        2,
        "is named .asc, but a .tif file is written"},
       {{"generate", "craters", "--size", "20", "-o", "s.PNG"}, 2, "name it s.tif"},
       {{"costmap", "good.asc", "-o", "m.bt"}, 2, "a .ot file"},
       {{"costmap", "good.asc", "--geotiff", "m.ot"}, 2, "a .tif file"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "--png", "r.jpg"}, 2, "a .png file"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "r.html"}, 2, "r.html"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "x.tif"}, 2, "name it x.geojson"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "q.npz"}, 2, "name it q.geojson"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "q.geojson.gz"},
        2,
        "name it q.geojson,"},
       {{"plan", "good.asc", "--pairs", "words.csv", "-o", "x.geojson"}, 2, "name it x.csv"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "r.pdf"}, 2, "is named .pdf"},
       {{"plan", "good.asc", "--start", "5,5", "--goal", "9,9", "-o", "r.ZIP"}, 2, "is named .ZIP"},
       {{"costmap", "good.asc", "-o", "m.db"}, 2, "name it m.ot"},
       {{"generate", "craters", "--size", "20", "-o", "s.vrt"}, 2, "name it s.tif"},
       {{"costmap", "good.asc", "--unsafe", "u.shp"}, 2, "u.gpkg"},
       {{"costmap", "good.asc", "--png", "good.asc"}, 2, "also an input"}});
  for (const char* name : {"s.tif", "s.TIFF", "s", "s.raster"})
    EXPECT_EQ(runTalus({"generate", "craters", "--size", "20", "-o", name}, files.folder().path()).code, 0)
        << name;
  EXPECT_EQ(
      runTalus({"generate", "craters", "--size", "20", "-o", "s.asc", "--force"}, files.folder().path()).code,
      0);
}

// The output path of a mission file may come from an untrusted source.
TEST(CheckOutput, MissionOutputIsProtected) {
  const BadFiles files;
  const Folder other;
  other.write("far", "x");
  fs::create_symlink(other / "far", files.folder() / "link");
  ASSERT_EQ(::mkfifo((files.folder() / "pipe").c_str(), 0600), 0);
  files.folder().write("keep_out.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature",
    "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[[1, 1], [2, 1], [2, 2], [1, 1]]]}}]})");
  std::vector<BadCall> calls;
  for (const auto& [output, says] :
       std::vector<std::pair<std::string, std::string>>{{"good.asc", "also an input"},
                                                        {"./good.asc", "also an input"},
                                                        {"link", "link to another"},
                                                        {"pipe", "a FIFO"},
                                                        {"/dev/null", "is a device"},
                                                        {"keep_out.geojson", "is no route of this mission"},
                                                        {"folder", "is no route"},
                                                        {"none/r.json", "none"}}) {
    const std::string name = "m" + std::to_string(calls.size()) + ".yaml";
    files.folder().write(name, missionTo(output));
    calls.push_back({{"plan", name}, 2, says});
  }
  files.folder().write("self.yaml", missionTo("self.yaml"));
  calls.push_back({{"plan", "self.yaml"}, 2, "also an input"});
  expectRefused(files, calls);
}

// Property: a mission replaces the route that was planned for it, also after the mission was changed, and no route
// of another mission or of no mission.
TEST(CheckOutput, MissionReplacesItsOwnRouteOnly) {
  const BadFiles files;
  const auto mission = [&](const std::string& name, const std::string& goal, const std::string& output) {
    files.folder().write(name, missionTo(output, goal));
    return name;
  };
  const auto plan = [&](const std::vector<std::string>& more) {
    return runTalus(joined({"plan", "--quiet", "--no-proof"}, more), files.folder().path()).code;
  };
  const std::string route = "r.geojson";
  EXPECT_EQ(plan({mission("m.yaml", "9, 9", route)}), 0);
  const std::string first = fileContent(files.folder() / route);
  EXPECT_EQ(plan({mission("m.yaml", "9, 12", route)}), 0);
  EXPECT_NE(fileContent(files.folder() / route), first);
  EXPECT_EQ(plan({mission("other.yaml", "9, 9", route)}), 2);
  EXPECT_EQ(plan({"other.yaml", "-o", route}), 0);
  EXPECT_EQ(plan({"m.yaml"}), 2);
  EXPECT_EQ(plan({"good.asc", "--resolution", "1", "--ignore-crs", "--start", "5,5", "--goal", "9,9", "-o",
                  "s.geojson"}),
            0);
  EXPECT_EQ(plan({mission("m.yaml", "9, 9", "s.geojson")}), 2);
}

}  // namespace output_file_test
}  // namespace talus::cli
