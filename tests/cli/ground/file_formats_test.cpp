#include <algorithm>

#include <fmt/format.h>
#include <gdal_priv.h>
#include <yaml-cpp/yaml.h>

#include <talus/cli/ground/file_formats.hpp>
#include <talus/cli/ground/mission.hpp>
#include <talus/maps/raster/gdal_dataset.hpp>
#include <talus/terramech/estimate/telemetry.hpp>

#include "bad_input.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace file_formats_test {

constexpr int kWidth = 700, kHeight = 600;

// Flat terrain with a wall and an area without data.
std::string site() {
  return asciiGrid(kWidth, kHeight, [](int column, int row) {
    return column < 200 && row < 150 ? -9999.0 : column == 300 ? 9.0 : 0.0;
  });
}

// Property: at three places, both files have the category that `talus explain` prints.
TEST(CategoryFiles, CategoryFilesMatchExplain) {
  const Folder folder;
  folder.write("site.asc", site());
  const Ran ran =
      runTalus({"costmap", "site.asc", "--resolution", "1", "--soil", "bedrock", "--rover", "fido",
                "--categories", "c.tif", "--geotiff", "l.tif", "--nav2", "n.yaml", "--quiet"},
               folder.path());
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(folder.names(),
            (std::vector<std::string>{"c.qml", "c.tif", "l.qml", "l.tif", "n.pgm", "n.yaml", "site.asc"}));
  const maps::Dataset file = maps::openRaster(folder / "c.tif");
  GDALRasterBand& band = *file->GetRasterBand(1);
  EXPECT_STREQ(band.GetMetadataItem("CLASS_2"), "dangerous");
  ASSERT_NE(band.GetColorTable(), nullptr);
  EXPECT_GT(band.GetColorTable()->GetColorEntry(0)->c2, band.GetColorTable()->GetColorEntry(0)->c1)
      << "green";
  EXPECT_THAT(fileContent(folder / "c.qml"),
              testing::HasSubstr("value=\"2\" color=\"#9e1020\" alpha=\"255\" label=\"dangerous\""));
  EXPECT_THAT(fileContent(folder / "l.qml"), testing::HasSubstr("band=\"8\""));
  EXPECT_THAT(fileContent(folder / "l.qml"),
              testing::HasSubstr("color=\"#9e1020\" alpha=\"255\" label=\"none\""));
  ASSERT_EQ(band.GetOverviewCount(), 1);
  // Property: the category of an overview cell is at least the worst category of the cells below.
  std::vector<std::uint8_t> fine(kWidth * kHeight), coarse(kWidth * kHeight / 4);
  ASSERT_EQ(
      band.RasterIO(GF_Read, 0, 0, kWidth, kHeight, fine.data(), kWidth, kHeight, GDT_Byte, 0, 0, nullptr),
      CE_None);
  ASSERT_EQ(band.GetOverview(0)->RasterIO(GF_Read, 0, 0, kWidth / 2, kHeight / 2, coarse.data(), kWidth / 2,
                                          kHeight / 2, GDT_Byte, 0, 0, nullptr),
            CE_None);
  for (int row = 0; row < kHeight; ++row)
    for (int column = 0; column < kWidth; ++column)
      ASSERT_GE(coarse[static_cast<std::size_t>(row / 2 * (kWidth / 2) + column / 2)],
                fine[static_cast<std::size_t>(row * kWidth + column)]);
  const std::string picture = fileContent(folder / "n.pgm");
  const std::string head = "P5\n700 600\n255\n";
  ASSERT_EQ(picture.size(), head.size() + kWidth * kHeight);
  EXPECT_TRUE(picture.starts_with(head));
  for (const auto& [column, from_north, category, grey] :
       {std::tuple{600, 100, 0, 0xFE}, {300, 300, 2, 0x00}, {50, kHeight - 50, 3, 0x80}}) {
    std::uint8_t value = 99;
    ASSERT_EQ(band.RasterIO(GF_Read, column, from_north, 1, 1, &value, 1, 1, GDT_Byte, 0, 0, nullptr),
              CE_None);
    EXPECT_EQ(value, category) << column;
    const auto at = head.size() + static_cast<std::size_t>(from_north * kWidth + column);
    EXPECT_EQ(static_cast<unsigned char>(picture[at]), grey) << column;
  }
  const YAML::Node yaml = YAML::LoadFile(folder / "n.yaml");
  EXPECT_EQ(yaml["image"].as<std::string>(), "n.pgm");
  EXPECT_EQ(yaml["resolution"].as<double>(), 1.0);
  // Closed form: thresholds of map_server's trinary mode; only cells written as free are read as free.
  const double free = yaml["free_thresh"].as<double>(), occupied = yaml["occupied_thresh"].as<double>();
  EXPECT_LT((255 - 0xFE) / 255.0, free);
  EXPECT_GT((255 - 0x80) / 255.0, free);
  EXPECT_LT((255 - 0x80) / 255.0, occupied);
}

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
