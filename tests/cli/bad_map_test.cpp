// Maps that cannot be used, told in one line by every command that reads one.
#include "bad_input.hpp"

namespace talus::cli {
namespace {

TEST(BadInput, ElevationMaps) {
  const BadFiles files;
  expectRefused(files,
                {
                    {{"info"}, 2, "DEM"},
                    {{"info", "missing.tif"}, 2, "missing.tif"},
                    {{"info", "dangling.tif"}, 2, "dangling.tif"},
                    {{"info", "folder"}, 2, "folder"},
                    {{"info", "empty"}, 2, "empty"},
                    {{"info", "garbage.tif"}, 2, "garbage.tif"},
                    {{"info", "tiff_head.tif"}, 2, "tiff_head.tif"},
                    {{"info", "garbage.npz"}, 2, "garbage.npz"},
                    {{"info", "good.asc"}, 2, "--resolution"},
                    {{"info", "cut.asc", "--resolution", "1"}, 2, "cut.asc"},
                    {{"info", "nodata.asc", "--resolution", "1"}, 2, "nodata.asc"},
                    {{"info", "huge.asc", "--resolution", "1"}, 2, "huge.asc"},
                    {{"info", "far.asc", "--resolution", "1"}, 2, "beyond 131072 m"},
                    {{"info", "good.asc", "--resolution", "0"}, 2, "resolution"},
                    {{"info", "good.asc", "--resolution", "nan"}, 2, "resolution"},
                    {{"info", "good.asc", "--resolution", "-1"}, 2, "resolution"},
                    {{"info", "good.asc", "--resolution", "1", "--band", "7"}, 2, "band"},
                    {{"info", "good.asc", "--resolution", "1", "--window", "1,2,3"}, 2, "1,2,3"},
                    {{"info", "good.asc", "--resolution", "1", "--window", "900,900,950,950"}, 2, "good.asc"},
                    {{"info", "good.asc", "--resolution", "1", "--footprint", "-1"}, 2, "footprint"},
                    {{"info", "good.asc", "--resolution", "1", "more"}, 2, "unknown argument 'more'"},
                });
}

}  // namespace
}  // namespace talus::cli
