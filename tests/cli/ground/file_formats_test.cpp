#include <algorithm>

#include <fmt/format.h>

#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace file_formats_test {

using terramech::FileKey;
using testing::HasSubstr;

// The formats as Markdown.
std::string formatsMarkdown() {
  std::string text;
  for (const FileFormat& format : fileFormats()) {
    text += fmt::format("## {}\n\n{}\n\n| name | meaning |\n|---|---|\n", format.title, format.about);
    for (const FileKey& key : format.keys) text += fmt::format("| `{}` | {} |\n", key.name, key.meaning);
    text += "\n";
  }
  text.pop_back();
  return text;
}

TEST(FileFormats, DocumentMatchesTheReaders) {
  const std::string document = fileContent(TALUS_SOURCE_DIR "/docs/formats.md");
  EXPECT_EQ(document.substr(std::min(document.find("## "), document.size())), formatsMarkdown());
}

// The list contains the columns known to the telemetry reader and the two text columns `run` and `wheel`.
TEST(FileFormats, TelemetryColumnsAreThoseOfTheReader) {
  std::vector<std::string> expected{"run", "wheel"};
  const auto& known = terramech::knownTelemetryColumns();
  expected.insert(expected.end(), known.begin(), known.end());
  EXPECT_EQ(terramech::namesOf(terramech::telemetryKeys()), expected);
}

// The list contains the supported vector formats and CSV tables with x_m, y_m.
TEST(FileFormats, VectorFormatsAreTheSupportedDrivers) {
  std::vector<std::string> expected = maps::vectorFormats();
  expected.emplace_back("CSV");
  for (const FileFormat& format : fileFormats())
    if (format.title == "Vector file") {
      EXPECT_EQ(terramech::namesOf(format.keys), expected);
    }
}

// Property: no listed key is refused as unknown; errors concern only the values.
TEST(FileFormats, EveryListedKeyIsAccepted) {
  const Folder folder;
  const auto refusal = [&](const std::string& yaml, const std::vector<std::string>& call) {
    folder.write("file.yaml", yaml);
    return runTalus(call, folder.path()).err;
  };
  for (const FileKey& key : missionKeys())
    EXPECT_THAT(refusal(std::string(key.name) + ": 1\n", {"plan", "file.yaml"}),
                Not(HasSubstr("unknown key")))
        << key.name;
  for (const FileKey& key : missionMapKeys())
    EXPECT_THAT(refusal("maps: {" + std::string(key.name) + ": 1}\n", {"plan", "file.yaml"}),
                Not(HasSubstr("unknown key")))
        << key.name;
  for (const FileKey& key : thresholdKeys())
    EXPECT_THAT(
        refusal("maps: {dem: x}\nthresholds: {" + std::string(key.name) + ": 1}\n", {"plan", "file.yaml"}),
        Not(HasSubstr("unknown key")))
        << key.name;
  EXPECT_THAT(refusal("maps: {dem: x}\nthresholds: {sinkage: 1}\n", {"plan", "file.yaml"}),
              HasSubstr("unknown key"));
}

TEST(FileFormats, KeyWithoutUnitSuggestsTheKnownKey) {
  const Folder folder;
  folder.write("soil.yaml", "cohesion: 1000\nfriction_angle: 30\n");
  folder.write("rover.yaml", "mass: 100\n");
  folder.write("mission.yaml", "maps: {dem: x.tif, resolution: 1}\n");
  EXPECT_THAT(
      runTalus({"wheel", "--soil", "soil.yaml", "--rover", "mer", "--slip", "0.1"}, folder.path()).err,
      HasSubstr("soil.yaml:1: unknown key 'cohesion'; did you mean cohesion_Pa?"));
  EXPECT_THAT(
      runTalus({"wheel", "--soil", "dry_sand", "--rover", "rover.yaml", "--slip", "0.1"}, folder.path()).err,
      HasSubstr("rover.yaml:1: unknown key 'mass'; did you mean mass_kg?"));
  EXPECT_THAT(runTalus({"plan", "mission.yaml"}, folder.path()).err,
              HasSubstr("mission.yaml:1: unknown key 'resolution'; did you mean resolution_m?"));
}

}  // namespace file_formats_test
}  // namespace talus::cli
