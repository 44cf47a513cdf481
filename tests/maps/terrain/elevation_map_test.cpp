#include <limits>
#include <random>

#include <talus/common/common.hpp>
#include <talus/maps/maps.hpp>

namespace talus::maps {

namespace elevation_map_test {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

TEST(ElevationMap, ValidFractionIsTheShareOfCellsWithData) {
  Raster<float> z({.width = 4, .height = 2, .resolution_m = 1.0, .south_west = {}}, 1.0F);
  EXPECT_EQ(validFraction(z), 1.0);
  z[{1, 1}] = z[{3, 0}] = kNaN;
  EXPECT_EQ(validFraction(z), 0.75);
}

TEST(ElevationMap, InterpolationIsBilinear) {
  const Grid grid{.width = 6, .height = 5, .resolution_m = 2.0, .south_west = {100.0, 50.0}};
  Raster<float> z(grid);
  // Closed form: bilinear interpolation reproduces a + b x + c y + d x y.
  const auto height = [](Point p) { return 3.0 + 0.5 * p.x_m - 0.25 * p.y_m + 0.125 * p.x_m * p.y_m; };
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      z[{column, row}] = static_cast<float>(height(grid.centre({column, row})));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> x(101.0, 111.0), y(51.0, 59.0);
  for (int i = 0; i < 200; ++i) {
    const Point p{x(random), y(random)};
    const auto seen = elevationAt(z, p);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(*seen, height(p), 1e-3);  // tolerance: float storage of some 700 m
  }
}

// Closed form: between the outermost centres and the edge of the map the elevation is not extrapolated.
TEST(ElevationMap, ElevationIsConstantBeyondTheOutermostCentres) {
  Raster<float> z(Grid{.width = 3, .height = 2, .resolution_m = 2.0});
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 3; ++c) z[{c, r}] = static_cast<float>(10 * c + r);
  EXPECT_EQ(elevationAt(z, {0.1, 0.1}), 0.0);
  EXPECT_EQ(elevationAt(z, {5.9, 3.9}), 21.0);
  EXPECT_EQ(elevationAt(z, {2.0, 3.9}), 6.0);
  EXPECT_FALSE(elevationAt(z, {6.0, 1.0}));
}

TEST(ElevationMap, OutsideTheMapAndNextToNoDataThereIsNoElevation) {
  Raster<float> z({.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}}, 5.0F);
  z[{1, 1}] = kNaN;
  EXPECT_FALSE(elevationAt(z, {-0.1, 2.0}));
  EXPECT_FALSE(elevationAt(z, {2.0, 4.1}));
  EXPECT_FALSE(elevationAt(z, {1.6, 1.6}));
  EXPECT_EQ(elevationAt(z, {3.2, 3.2}), 5.0);
}

using testing::HasSubstr;

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

ElevationMap localMap() {
  return {.elevation_m =
              Raster<float>(Grid{.width = 10, .height = 20, .resolution_m = 2.0, .south_west = {100, -50}}),
          .georeference = std::nullopt,
          .source = "yard.tif",
          .notes = {}};
}

TEST(Place, ParsesMetresAndDegrees) {
  EXPECT_EQ(std::get<Point>(parsePlace("12.5,-3e2")), (Point{12.5, -300}));
  EXPECT_EQ(std::get<Point>(parsePlace(" +1 , 2")), (Point{1, 2}));
  const GeoPoint place = std::get<GeoPoint>(parsePlace("-4.59d,137.44d"));
  EXPECT_DOUBLE_EQ(place.latitude_rad, -4.59 * kDegree);
  EXPECT_DOUBLE_EQ(place.longitude_rad, 137.44 * kDegree);
}

TEST(Place, InvalidTextIsQuotedInTheError) {
  for (const char* text : {"", "1", "1,2,3", "a,b", "1,", "nan,1", "1d,2", "91d,0d", "0d,361d", "1,2x",
                           "inf,0", "1;2", "010,1", "1d,-007d"}) {
    const std::string line = refusal([&] { parsePlace(text); });
    EXPECT_THAT(line, testing::AllOf(testing::StartsWith("'"), HasSubstr(text)));
    EXPECT_THAT(line, HasSubstr("write x,y in map metres"));
  }
}

TEST(Place, PositionOutsideTheMapIsRejectedWithTheMapExtent) {
  EXPECT_EQ(locate(Point{119.9, -50}, localMap(), "--start"), (Point{119.9, -50}));
  EXPECT_THAT(refusal([] {
                locate(Point{5, 900}, localMap(), "--start 5,900");
              }),
              HasSubstr("--start 5,900: x 5 m, y 900 m lies outside the map; the map spans x 100 to 120 m, y "
                        "-50 to -10 m"));
  EXPECT_THAT(refusal([] { locate(GeoPoint{}, localMap(), "--goal"); }), HasSubstr("'yard.tif' has no CRS"));
}

// Property: points on the border of the map, as stated in the message about its extent, are inside the map.
TEST(Place, MapBorderIsInsideTheMap) {
  const ElevationMap map = localMap();
  for (const Point corner : {Point{100, -50}, Point{120, -50}, Point{100, -10}, Point{120, -10}}) {
    const Point at = locate(corner, map, "--goal");
    EXPECT_TRUE(map.grid().cellAt(at));
    EXPECT_NEAR(at.x_m, corner.x_m, 1e-5);
    EXPECT_NEAR(at.y_m, corner.y_m, 1e-5);
  }
  EXPECT_THAT(refusal([&] {
                locate(Point{120.0001, -20}, map, "--goal");
              }),
              HasSubstr("lies outside the map"));
}

TEST(Place, DegreesAreConvertedByTheMapGeoreference) {
  ElevationMap map = localMap();
  map.georeference.emplace(CoordinateSystem{.name = "Moon", .ellipsoid = kMoon});
  const GeoPoint place = map.georeference->reverse({110, -30});
  const Point point = locate(place, map, "--goal");
  EXPECT_NEAR(point.x_m, 110, 1e-6);
  EXPECT_NEAR(point.y_m, -30, 1e-6);
  EXPECT_EQ(describe(point, map), "x 110.00 m, y -30.00 m (-0.000989d,0.003628d)");
  EXPECT_THAT(refusal([&] {
                locate(GeoPoint{0.5, 0.5}, map, "--goal");
              }),
              HasSubstr("at 28.647890d,28.647890d lies outside"));
  // Degrees without their suffix, in either order.
  for (const Point bare : {Point{-0.000989, 0.003628}, Point{0.003628, -0.000989}})
    EXPECT_THAT(refusal([&] { locate(bare, map, "--goal"); }), HasSubstr("write -0.000989d,0.003628d"));
  EXPECT_EQ(locate(Point{110, -30}, map, "--goal"), (Point{110, -30}));
}

TEST(Place, WindowRequiresFourNumbersOfOneUnit) {
  const Window window = parseWindow("1,2,3,4");
  EXPECT_EQ(std::get<Point>(window.second), (Point{3, 4}));
  for (const char* mixed : {"5,5,65d,65d", "5d,5d,65,65"})
    EXPECT_THAT(refusal([&] { parseWindow(mixed); }), HasSubstr("one corner is in metres")) << mixed;
  EXPECT_THAT(refusal([] { parseWindow("1,2,3"); }), HasSubstr("has not 4 numbers"));
}

}  // namespace elevation_map_test

}  // namespace talus::maps
