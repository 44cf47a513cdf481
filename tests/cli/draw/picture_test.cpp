#include <talus/cli/draw/picture.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace picture_test {

using testing::StartsWith;

TEST(Picture, MapWithARouteIsDrawn) {
  const std::string bytes = drawPicture(exampleScene());
  EXPECT_THAT(bytes, StartsWith("\x89PNG"));
  keep("picture.png", bytes);
}

TEST(Picture, MapWithoutCategoriesShowsItsFirstLayer) {
  const std::string bytes = drawPicture(sceneOf(exampleMap(), {.title = "Slope of the example"}));
  EXPECT_THAT(bytes, StartsWith("\x89PNG"));
  keep("picture_slope.png", bytes);
}

TEST(Picture, SingleCellWithoutDataIsDrawn) {
  maps::ElevationMap map;
  map.elevation_m = maps::Raster<float>({1, 1, 1.0, {0.0, 0.0}}, std::nanf(""));
  EXPECT_THAT(drawPicture(sceneOf(map, {.title = "nothing"})), StartsWith("\x89PNG"));
}

TEST(Picture, PictureIsDeterministic) {
  EXPECT_EQ(drawPicture(exampleScene()), drawPicture(exampleScene()));
}

}  // namespace picture_test
}  // namespace talus::cli
