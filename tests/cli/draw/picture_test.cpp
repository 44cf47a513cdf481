#include <cmath>

#include <talus/cli/draw/picture.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace picture_test {

maps::Raster<float> plane(double per_column, double per_row) {
  maps::Raster<float> z({8, 8, 1.0, {0.0, 0.0}});
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 8; ++column)
      z[{column, row}] = static_cast<float>(per_column * column + per_row * row);
  return z;
}

TEST(Hillshade, SlopesFacingNorthWestAreBrighter) {
  // Property: with the sun in the north-west, a slope descending to the north-west is brighter than flat
  // ground, and a slope descending to the south-east is darker.
  const float flat = hillshade(plane(0.0, 0.0))[{4, 4}];
  EXPECT_GT((hillshade(plane(0.3, -0.3))[{4, 4}]), flat);
  EXPECT_LT((hillshade(plane(-0.3, 0.3))[{4, 4}]), flat);
}

TEST(Hillshade, NoDataIsPreservedAndDoesNotSpread) {
  maps::Raster<float> z = plane(0.1, 0.0);
  const float whole = hillshade(z)[{0, 0}];
  z[{4, 4}] = std::nanf("");
  const maps::Raster<float> shade = hillshade(z);
  EXPECT_TRUE(std::isnan((shade[{4, 4}])));
  EXPECT_NEAR((shade[{5, 4}]), whole, 1e-6);  // float rounding of the elevations
}

// Property: outliers do not compress the brightness range; a plane of constant brightness has a non-empty
// range.
TEST(Hillshade, LightRangeIgnoresOutliers) {
  maps::Raster<float> shade({10, 10, 1.0, {0.0, 0.0}}, 0.4F);
  shade[{0, 0}] = 0.0F;
  shade[{1, 0}] = std::nanf("");
  for (int column = 0; column < 10; ++column) shade[{column, 5}] = 0.6F;
  EXPECT_FLOAT_EQ(static_cast<float>(lightRange(shade).low), 0.4F);
  EXPECT_FLOAT_EQ(static_cast<float>(lightRange(shade).high), 0.6F);
  const Range flat = lightRange(maps::Raster<float>({3, 3, 1.0, {0.0, 0.0}}, 0.7F));
  EXPECT_GT(flat.high, flat.low);
}

TEST(MapImage, TopRowIsNorth) {
  maps::Raster<HeadingShares> headings({1, 2, 1.0, {0.0, 0.0}});
  headings[{0, 0}].count[2] = 1;  // south: none
  headings[{0, 1}].count[0] = 1;  // north: all
  Image image = headingImage(headings);
  EXPECT_EQ(image.at(0, 0), pixel(colourOf(terramech::Category::Safe)));
  EXPECT_EQ(image.at(0, 1), pixel(colourOf(terramech::Category::Dangerous)));
}

TEST(MapImage, ClassesHaveTheirColours) {
  ValueLayer layer{.name = "sets", .unit = "", .values = plane(0.0, 0.0), .range = {0.0, 1.0}};
  layer.classes = {{"one", rgb(0x0072B2)}, {"two", rgb(0xE69F00)}};
  layer.values[{7, 7}] = 1.0F;
  Image image = valueImage(layer);
  EXPECT_EQ(image.at(0, 0), pixel(rgb(0x0072B2)));
  EXPECT_EQ(image.at(7, 0), pixel(rgb(0xE69F00)));
}

TEST(MapImage, MissingValuesAreTransparent) {
  ValueLayer layer{.name = "slope", .unit = "deg", .values = plane(1.0, 0.0), .range = {0.0, 7.0}};
  layer.values[{3, 3}] = std::nanf("");
  Image image = valueImage(layer);
  EXPECT_EQ(image.at(3, 4), 0U);
  EXPECT_EQ(image.at(0, 0), pixel(viridis().front()));
  EXPECT_EQ(image.at(7, 0), pixel(viridis().back()));
}

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
