#include <filesystem>

#include <sys/stat.h>

#include <talus/cli/app/output_file.hpp>
#include <talus/talus.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::string& path, const std::vector<std::string>& inputs = {}) {
  try {
    checkOutput(path, inputs);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(CheckOutput, KeepsInputsJournalsDevicesAndForeignLinks) {
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

TEST(CheckOutput, HoldsForEveryCall) {
  const BadFiles files;
  const std::string map = "good.asc";
  files.folder().write("mission.yaml",
                       "maps: {dem: good.asc, resolution_m: 1, ignore_crs: true}\nsoil: sandy_loam\n"
                       "rover: sojourner\nstart: [5, 5]\ngoal: [9, 9]\noutput: words.csv\n");
  const std::vector<std::string> ground{"good.asc", "--ignore-crs", "--resolution", "1"};
  const auto call = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), ground.begin(), ground.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expectRefused(files,
                {{call({"costmap"}, {"-o", "./good.asc"}), 2, "also an input"},
                 {call({"costmap"}, {"-o", "m.ot", "--png", "m.ot"}), 2, "another output"},
                 {call({"costmap"}, {"-o", "/dev/null"}), 2, "device"},
                 {{"wheel", "--cases", "words.csv", "-o", "words.csv"}, 2, "also an input"},
                 {{"update", "m.ot", "words.csv", "-o", "j.db", "--journal", "j.db"}, 2, "also an input"},
                 {{"plan", "mission.yaml"}, 2, "is no route"}});
}

}  // namespace
}  // namespace talus::cli
