#include <cmath>

#include <talus/maps/maps_io.hpp>

#include "layer_fixture.hpp"

namespace talus::maps {
namespace geotiff_writer_test {

using testing::HasSubstr;

TEST(GeoTiffWriter, RoundTripIsExact) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  Raster<float> slope(dem.grid(), 0.5F);
  slope[{1, 2}] = std::numeric_limits<float>::quiet_NaN();
  const std::string path = folder / "layers.tif";
  writeGeoTiff({path, &*dem.georeference}, {{"elevation", "m", dem.elevation_m}, {"slope", "", slope}});
  const ElevationMap back = readElevation(path);
  EXPECT_EQ(back.grid(), dem.grid());
  EXPECT_EQ(back.elevation_m.values(), dem.elevation_m.values());
  EXPECT_EQ(back.georeference->system().name, dem.georeference->system().name);
  const ElevationMap second = readElevation(path, {.band = 2});
  EXPECT_TRUE(std::isnan(second.elevation_m[{1, 2}]));
  EXPECT_EQ((second.elevation_m[{0, 0}]), 0.5F);
  Raster<std::uint8_t> classes(dem.grid(), 3);
  classes[{0, 0}] = kNoClass;
  writeGeoTiff({folder / "classes.tif", &*dem.georeference}, "class", classes, kNoClass);
  EXPECT_EQ(drawing(readTerrainClasses({.path = folder / "classes.tif"}, dem)), "3333\n3333\n.333\n");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(path).parent_path()))
    files += entry.exists() ? 1 : 0;
  EXPECT_EQ(files, 3) << "no file may be left beside";
}

TEST(GeoTiffWriter, InvalidPathOrLayersAreRejected) {
  const TemporaryFolder folder;
  const ElevationMap dem = map(folder);
  EXPECT_THAT(refusal([&] {
                writeGeoTiff({folder / "no/where.tif"}, {{"z", "m", dem.elevation_m}});
              }),
              HasSubstr("does not exist; make it first"));
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {}), std::invalid_argument);
  EXPECT_THROW(writeGeoTiff({folder / "a.tif"}, {{"z", "m", dem.elevation_m},
                                                 {"s", "", Raster<float>(Grid{.width = 2, .height = 2})}}),
               std::invalid_argument);
}

}  // namespace geotiff_writer_test
}  // namespace talus::maps
