// Unusable maps: every subcommand that reads a map reports the error in one line.
#include <sys/stat.h>

#include "bad_input.hpp"

namespace talus::cli {
namespace bad_map_test {

TEST(BadInput, InvalidElevationMapsAreRejectedWithOneLine) {
  const BadFiles files;
  expectRefused(
      files,
      {
          {{"info"}, 2, "DEM"},
          {{"info", "missing.tif"}, 2, "missing.tif"},
          {{"info", "dangling.tif"}, 2, "dangling.tif"},
          {{"info", "folder"}, 2, "folder"},
          {{"info", "empty"}, 2, "empty"},
          {{"info", "garbage.tif"}, 2, "garbage.tif"},
          {{"info", "tiff_head.tif"}, 2, "tiff_head.tif"},
          {{"info", "good.asc"}, 2, "--resolution"},
          {{"info", "cut.asc", "--resolution", "1"}, 2, "cut.asc"},
          {{"info", "nodata.asc", "--resolution", "1"}, 2, "nodata.asc"},
          {{"info", "huge.asc", "--resolution", "1"}, 2, "huge.asc"},
          {{"info", "far.asc", "--resolution", "1"}, 2, "beyond 131072 m"},
          {{"info", "good.asc", "--resolution", "0"}, 2, "resolution"},
          {{"info", "good.asc", "--resolution", "nan"}, 2, "resolution"},
          {{"info", "good.asc", "--resolution", "-1"}, 2, "resolution"},
          {{"info", "good.asc", "--resolution", "x"}, 2, "resolution"},
          {{"info", "good.asc", "--resolution", "1", "--band", "7"}, 2, "band"},
          {{"info", "good.asc", "--resolution", "1", "--max-cells", "5"}, 2, "too many"},
          {{"info", "words.csv"}, 2, "GDAL opens no raster"},
          {{"info", "good.asc", "--resolution", "1", "--window", "1,2,3"}, 2, "1,2,3"},
          {{"info", "good.asc", "--resolution", "1", "--window", "900,900,950,950"}, 2, "good.asc"},
          {{"info", "good.asc", "--resolution", "1", "--footprint", "-1"}, 2, "footprint"},
          {{"info", "good.asc", "--resolution", "1", "--window", "5,5,65d,65d"}, 2, "degrees"},
          {{"info", "good.asc", "--resolution", "1", "--max-memory", "GB"},
           2,
           "must be a whole decimal number"},
          {{"info", "good.asc", "--resolution", "1", "--max-memory", "0"}, 2, "--max-memory"},
          {{"info", "good.asc", "--resolution", "1", "--max-memory", "1"}, 2, "--max-memory"},
          {{"info", "good.asc", "--resolution", "1", "--max-memory", "90MB"}, 2, "must be 100 MB or more"},
          {{"info", "good.asc", "--resolution", ""}, 2, "--resolution: its value is empty"},
          {{"info", "good.asc", "--resolution", "1", "--seed", "18446744073709551616"}, 2, "must be 0 to"},
          {{"info", "good.asc", "--resolution", "1", "more"}, 2, "unknown argument 'more'"},
      });
}

// A FIFO without a writer would block the process that opens the file.
TEST(BadInput, FifosAndDevicesAreRejected) {
  const BadFiles files;
  ASSERT_EQ(::mkfifo((files.folder() / "pipe").c_str(), 0600), 0);
  const auto ground = [](std::vector<std::string> words) {
    words.insert(words.begin() + 1, {"good.asc", "--ignore-crs", "--resolution", "1"});
    return words;
  };
  expectRefused(files,
                {{{"info", "pipe"}, 2, "FIFO"},
                 {{"view", "pipe", "--html", "v.html"}, 2, "FIFO"},
                 {{"wheel", "--soil", "pipe", "--rover", "fido", "--slip", "0.2"}, 2, "FIFO"},
                 {{"wheel", "--soil", "/dev/zero", "--rover", "fido", "--slip", "0.2"}, 2, "is a device"},
                 {ground({"plan", "--start", "5,5", "--goal", "9,9", "--map", "pipe"}), 2, "FIFO"},
                 {ground({"plan", "--start", "5,5", "--goal", "9,9", "--keep-out", "pipe"}), 2, "FIFO"},
                 {{"update", "pipe", "t.csv", "-o", "m.ot"}, 2, "FIFO"},
                 {{"bench", "pipe"}, 2, "FIFO"}});
}

}  // namespace bad_map_test
}  // namespace talus::cli
