#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <site_map.hpp>

#include <talus/cli/app/context.hpp>
#include <talus/cli/ground/ground_options.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>

#include "bad_input.hpp"
#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace ground_options_test {

std::map<std::string, maps::Raster<float>> layersOf(const costmap::TraversabilityMap& map) {
  std::map<std::string, maps::Raster<float>> layers;
  for (maps::Layer& layer : siteLayers(map, 1)) layers.emplace(layer.name, std::move(layer.values));
  return layers;
}

// Closed form: a plane rising eastwards by 0.1 has slope atan 0.1; uphill costs more than downhill; cells
// without elevation are NaN except for their category.
TEST(SiteLayers, LayersOfAPlaneMatchClosedForm) {
  const std::vector<std::string> rows(14, "1111111?222222");
  auto layers = layersOf(costmap::mapOf(rows, 0.1));
  EXPECT_EQ(layers.size(), 13U);
  const maps::Cell sand{3, 7}, hole{7, 7}, dust{11, 7};
  EXPECT_NEAR(layers["slope"][sand], std::atan(0.1), 1e-4);
  EXPECT_NEAR(layers["elevation"][sand], 1000.3, 1e-3);
  EXPECT_NEAR(layers["step"][sand], layers["step"][dust], 1e-3);
  EXPECT_GT(layers["energy_per_metre_uphill"][sand], layers["energy_per_metre_downhill"][sand]);
  EXPECT_EQ(layers["class"][sand], 1.0F);
  EXPECT_EQ(layers["class"][dust], 2.0F);
  EXPECT_TRUE(std::isnan(layers["elevation"][hole]));
  EXPECT_TRUE(std::isnan(layers["energy_per_metre_uphill"][hole]));
}

// Property: the layer equals a count of 720 headings by the cost of a metre; each kind of cell occurs.
TEST(SiteLayers, AllowedHeadingsMatchTheCostsOfHeadings) {
  std::set<float> seen;
  for (const double gradient : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5}) {
    const auto map = costmap::mapOf(std::vector<std::string>(14, "1111111222222"), gradient);
    auto layers = layersOf(map);
    const auto grid = map.published();
    for (const maps::Cell cell : {maps::Cell{3, 7}, maps::Cell{10, 7}}) {
      int allowed = 0;
      for (int k = 0; k < 720; ++k) {
        const double heading = k * std::numbers::pi / 360.0;
        allowed +=
            std::isfinite(grid->cost().costPerMetre(grid->at(cell), {std::cos(heading), std::sin(heading)}));
      }
      const float expected = allowed == 720 ? 0.0F : allowed > 0 ? 1.0F : 2.0F;
      EXPECT_EQ(layers["allowed_headings"][cell], expected) << gradient;
      seen.insert(expected);
    }
  }
  EXPECT_EQ(seen.size(), 3U);
}

// Property: the weaker soil has less drawbar pull and more sinkage; categories equal those of the map.
TEST(SiteLayers, LayersMatchTheMap) {
  const auto map = costmap::mapOf({"1111111222222", "1111111222222", "11111112222#2", "1111111222222"});
  auto layers = layersOf(map);
  EXPECT_GT((layers["drawbar_pull_over_load"][{2, 1}]), (layers["drawbar_pull_over_load"][{11, 2}]));
  EXPECT_LT((layers["sinkage_over_radius"][{2, 1}]), (layers["sinkage_over_radius"][{11, 2}]));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 13; ++column)
      EXPECT_EQ((layers["category"][{column, row}]), static_cast<float>(map.belief({column, row}).category));
  EXPECT_TRUE(std::isnan(layers["energy_per_metre_uphill"][{11, 1}]));  // keep-out cell
}

using testing::HasSubstr;
using testing::ThrowsMessage;

double ramp(int column, int row) {
  return column + 100.0 * row;
}

ElevationFile elevationOf(const std::string& line) {
  CLI::App app;
  ElevationFile options;
  addMapOptions(app, options);
  app.parse(line);
  return options;
}

// Closed form: elevation as a function of column and row; with a window, only cells inside the window are
// read.
TEST(MapOptions, ElevationFollowsTheReadOptions) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(12, 9, ramp));
  const auto whole = readMap(elevationOf(dem + " --resolution 1"));
  EXPECT_EQ(whole.grid().width, 12);
  EXPECT_NEAR((whole.elevation_m[{5, 3}]), 305.0, 1e-4);
  const auto part = readMap(elevationOf(dem + " --resolution 1 --window 2,3,6,8"));
  EXPECT_EQ(part.grid().width, 4);
  EXPECT_EQ(part.grid().height, 5);
  EXPECT_NEAR((part.elevation_m[{0, 0}]), 302.0, 1e-4);
  const auto scaled = readMap(elevationOf(dem + " --resolution 1 --vertical-scale 0.5 --nodata 7"));
  EXPECT_NEAR((scaled.elevation_m[{5, 3}]), 152.5, 1e-4);
  EXPECT_TRUE(std::isnan(scaled.elevation_m[{7, 0}]));
}

TEST(MapOptions, InvalidReadOptionsAreRejected) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(12, 9, ramp));
  EXPECT_THAT([&] { readMap(elevationOf(dem + " --resolution 1 --below 3")); },
              ThrowsMessage<InputError>(HasSubstr("remove --below")));
  EXPECT_THAT([&] { readMap(elevationOf(dem + " --resolution 1 --max-cells 50")); },
              ThrowsMessage<InputError>(HasSubstr("12 x 9 cells are too many")));
  for (const char* count : {"-1", "0", "1e300"})
    EXPECT_THROW(elevationOf(dem + " --max-cells " + count), CLI::ParseError) << count;
  EXPECT_THROW(elevationOf("--band 1"), CLI::RequiredError);
}

// Closed form: two keep-out squares block the cells of both; layers without a file stay empty.
TEST(MapOptions, KeepOutFilesAreCombined) {
  const Folder folder;
  const auto square = [&folder](const std::string& name, int x) {
    const std::string a = std::to_string(x) + ".2", b = std::to_string(x) + ".8";
    return folder.write(name, R"({"type":"Polygon","crs":"local","coordinates":[[[)" + a + ",1.2],[" + b +
                                  ",1.2],[" + b + ",1.8],[" + a + ",1.8],[" + a + ",1.2]]]}");
  };
  SiteFiles files{.elevation = folder.write("dem.asc", asciiGrid(12, 9, ramp))};
  files.elevation.read.resolution_m = 1.0;
  files.keep_out = {square("a.json", 2), square("b.json", 7)};
  const costmap::MapLayers layers = readSite(files).layers;
  EXPECT_TRUE(layers.classes.empty() && layers.rock_abundance.empty());
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 12; ++column)
      EXPECT_EQ((layers.keep_out[{column, row}]) != 0, row == 1 && (column == 2 || column == 7));
}

double flat(int, int) {
  return 5.0;
}

GroundOptions parsed(const std::string& line) {
  CLI::App app;
  GroundOptions options;
  addGroundOptions(app, options);
  app.parse(line);
  return options;
}

Context quiet() {
  Context context;
  context.quiet = true;
  context.threads = 1;
  return context;
}

// Closed form: degrees are converted to radians; a flag inverts the default of its threshold.
TEST(GroundOptions, PolicyFollowsTheCommandLine) {
  const auto policy =
      parsed("dem.tif --no-marginal --allow-unknown --slope-uncertainty-deg 10 --time-weight 3").policy;
  EXPECT_FALSE(policy.allow_marginal);
  EXPECT_TRUE(policy.allow_unknown);
  EXPECT_FALSE(policy.allow_dangerous);
  EXPECT_NEAR(policy.slope_margin_rad, 10.0 * kDegree, 1e-12);
  EXPECT_EQ(policy.time_weight_W, 3.0);
  EXPECT_EQ(policy.risk_weight_J, costmap::TravelPolicy{}.risk_weight_J);
  EXPECT_THROW(parsed("dem.tif --soil a --model b.yaml"), CLI::ExcludesError);
}

TEST(GroundOptions, GroundHasTheGivenSoilAndRover) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(20, 20, flat));
  const Ground ground =
      readGround(parsed(dem + " --resolution 1 --soil sandy_loam --rover fido --footprint 1.5"), quiet());
  EXPECT_EQ(ground.map.model().rover().name, "fido");
  ASSERT_EQ(ground.map.model().parts().classes.size(), 1U);
  EXPECT_EQ(ground.map.surface().footprintRadius_m(), 1.5);
  EXPECT_EQ(ground.files.front().path, dem);
  // Property: a built map is recognised as such as the DEM argument and as --map.
  const std::string built = folder / "map.ot";
  costmap::writeMap(ground.map, built);
  for (const std::string& line : {built, "any.tif --map " + built}) {
    const Ground again = readGround(parsed(line), quiet());
    EXPECT_EQ(again.map.model().rover().name, "fido");
    EXPECT_EQ(again.map.costs().countCategories().safe, ground.map.costs().countCategories().safe);
  }
  EXPECT_NO_THROW(readGround(parsed(built + " --rover fido"), quiet()));
  // Property: options that conflict with a built map are refused, not ignored.
  for (const char* ignored :
       {"--keep-out rocks.geojson", "--no-marginal", "--unmonitored", "--risk-weight 1", "--pose-error 2",
        "--soil dry_sand", "--soils s.yaml", "--terrain c.tif", "--terrain-band 1", "--rocks r.tif",
        "--model m.yaml", "--footprint 1", "--below 3"})
    EXPECT_THAT([&] { readGround(parsed(built + " " + ignored), quiet()); },
                ThrowsMessage<InputError>(HasSubstr("is a built map")))
        << ignored;
  for (const char* reading : {"--resolution 2", "--window 0,0,5,5", "--nodata 5", "--band 1", "--ignore-crs",
                              "--vertical-scale 2", "--max-cells 10"})
    EXPECT_THAT([&] { readGround(parsed(built + " " + reading), quiet()); },
                ThrowsMessage<InputError>(HasSubstr("has a grid of its own")))
        << reading;
  for (const std::string& line : {built, dem + " --resolution 1 --map " + built})
    EXPECT_THAT([&] { readGround(parsed(line + " --rover mer"), quiet()); },
                ThrowsMessage<InputError>(HasSubstr("was built for rover 'fido'")));
}

TEST(GroundOptions, BuiltMapMustMatchTheElevationMap) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(20, 20, flat));
  const std::string steep = folder.write("steep.asc", asciiGrid(20, 20, [](int c, int) { return 0.5 * c; }));
  const std::string small = folder.write("small.asc", asciiGrid(10, 20, flat));
  const std::string built = folder / "map.ot";
  costmap::writeMap(readGround(parsed(dem + " --resolution 1 --soil sandy_loam --rover fido"), quiet()).map,
                    built);
  EXPECT_NO_THROW(readGround(parsed(dem + " --resolution 1 --map " + built), quiet()));
  const auto refuses = [&](const std::string& other, const char* said) {
    EXPECT_THAT([&] { readGround(parsed(other + " --map " + built), quiet()); },
                ThrowsMessage<InputError>(HasSubstr(said)))
        << other;
  };
  refuses(steep + " --resolution 1", "was not built from");
  refuses(small + " --resolution 1", "was not built from");
  refuses(dem + " --resolution 2", "states cells of 1");
}

TEST(GroundOptions, OversizedFootprintIsRejected) {
  const Folder folder;
  const std::string dem =
      folder.write("dem.asc", asciiGrid(20, 20, flat)) + " --resolution 1 --rover fido --footprint ";
  EXPECT_NO_THROW(readGround(parsed(dem + "1.5"), quiet()));
  EXPECT_THAT([&] { readGround(parsed(dem + "50"), quiet()); },
              ThrowsMessage<InputError>(HasSubstr("hide the steps and slopes")));
}

// Values that are valid alone but not in combination are reported with their file.
TEST(GroundOptions, InvalidRoverAndSoilValuesAreReportedWithTheirFile) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(20, 20, flat)) + " --resolution 1";
  const std::string rover = folder.write(
      "two.yaml",
      "name: two\nmass_kg: 100\nwheels: {count: 2, radius_m: 0.1, width_m: 0.1}\nwheelbase_m: 1\n"
      "track_m: 1\nclearance_m: 0.2\nmax_torque_Nm: 20\n");
  EXPECT_THAT([&] { readGround(parsed(dem + " --soil sandy_loam --rover " + rover), quiet()); },
              ThrowsMessage<InputError>(HasSubstr("two.yaml: rover 'two': wheels.count = 2, must be even")));
  const std::string soil = folder.write(
      "soil.yaml",
      "name: doubt\ncohesion_Pa: {mean: 500, std: 1e12}\nfriction_angle_deg: 30\nsinkage_exponent: 1\n"
      "frictional_modulus: 1e6\nshear_modulus_m: 0.02\n");
  EXPECT_THAT([&] { readGround(parsed(dem + " --rover fido --soil " + soil), quiet()); },
              ThrowsMessage<InputError>(HasSubstr("soil.yaml: soil 'doubt': cohesion_Pa = 5e+11")));
}

// A classes file replaces the soil of the body; with --soil the classes are added to that soil.
TEST(GroundOptions, ClassesFileIsCombinedWithANamedSoil) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(20, 20, flat)) + " --resolution 1 --rover fido";
  const std::string classes = folder.write("soils.yaml", "terrain_classes: {1: dry_sand, 2: sandy_loam}\n");
  const auto numbers = [](const Ground& ground) {
    std::vector<int> made;
    for (const auto& one : ground.map.model().parts().classes) made.push_back(one.number);
    return made;
  };
  EXPECT_THAT(numbers(readGround(parsed(dem + " --soils " + classes), quiet())), testing::ElementsAre(1, 2));
  EXPECT_THAT(numbers(readGround(parsed(dem + " --soils " + classes + " --soil sandy_loam"), quiet())),
              testing::ElementsAre(0, 1, 2));
  EXPECT_THAT([&] { readGround(parsed(dem + " --soil no_such"), quiet()); },
              ThrowsMessage<InputError>(HasSubstr("no_such")));
}

// Closed form: theta_m / theta_1 = c1 + c2 slip is 1.08 at slip 1, and -0.32 at slip -1: outside the contact.
TEST(GroundOptions, StressPeakOutsideTheContactIsRejectedNamingTheFile) {
  const Folder folder;
  const std::string dem = folder.write("dem.asc", asciiGrid(20, 20, flat)) + " --resolution 1 --rover fido";
  const auto soil = [](const std::string& peak) {
    return "{name: odd, cohesion_Pa: 500, friction_angle_deg: 30, sinkage_exponent: 1, frictional_modulus: "
           "1e6, "
           "shear_modulus_mm: 15, " +
           peak + "}\n";
  };
  const std::string bare = folder.write("bare.yaml", soil("c1: 0, c2: 0.32")),
                    model =
                        folder.write("model.yaml", "model: wong-reece\nsoil: " + soil("c1: 0.58, c2: 0.5")),
                    classes = folder.write("classes.yaml", "1: " + soil("c1: 0.58, c2: -0.6"));
  for (const std::string& given : {" --soil " + bare, " --model " + model, " --soils " + classes})
    EXPECT_THAT([&] { readGround(parsed(dem + given), quiet()); },
                ThrowsMessage<InputError>(testing::AllOf(HasSubstr(folder / ""), HasSubstr("stress peak"))))
        << given;
}

// Closed form: 1 of 25 pixels in each cell of column 2 has the weak class; one pixel in column 4 has no rock
// data, one pixel in column 6 has dense rocks.
TEST(GroundOptions, WeakestClassAndRocksOfPartialPixelsAreUsed) {
  const Folder folder;
  const auto raster = [&](const std::string& name, auto value) {
    std::string text = asciiGrid(50, 50, value);
    return folder.write(name, text.replace(text.find("cellsize 1"), 10, "cellsize 0.2"));
  };
  const auto inColumn = [](int x, int y, int column) { return x == 5 * column + 4 && y % 5 == 0; };
  const std::string rocks = raster("r.asc", [&](int x, int y) {
    return inColumn(x, y, 4) ? -9999.0 : inColumn(x, y, 6) ? 0.9 : 0.0;
  });
  const std::string dem = folder.write("dem.asc", asciiGrid(10, 10, flat));
  for (const int weak : {1, 2}) {
    const std::string classes =
        raster("c.asc", [&](int x, int y) { return inColumn(x, y, 2) ? weak : 3 - weak; });
    const std::string soils = folder.write("s.yaml", "classes: {" + std::to_string(weak) + ": dry_sand, " +
                                                         std::to_string(3 - weak) + ": firm_soil}\n");
    const std::string line =
        dem + " --resolution 1 --terrain " + classes + " --soils " + soils + " --rocks " + rocks;
    const Ground ground = readGround(parsed(line), quiet());
    for (int row = 2; row < 8; ++row)
      for (int column = 1; column < 9; ++column) {
        const maps::Cell cell{column, row};
        EXPECT_EQ(ground.map.surface().classNumber(cell), column == 2 ? weak : 3 - weak) << column;
        EXPECT_EQ(costmap::has(ground.map.surface().hazards(cell), costmap::Hazard::Unknown), column == 4)
            << column;
        EXPECT_EQ(costmap::has(ground.map.surface().hazards(cell), costmap::Hazard::Rocks), column == 6)
            << column;
      }
  }
}

double rolling(int column, int row) {
  return 2.0 * std::sin(column / 9.0) * std::cos(row / 7.0);
}

GroundOptions options(const Folder& folder) {
  GroundOptions made;
  made.elevation.path = folder.write("dem.asc", asciiGrid(200, 150, rolling));
  made.elevation.read.resolution_m = 1.0;
  made.soil = "sandy_loam";
  made.rover = "fido";
  return made;
}

TEST(WindowedGround, WindowsAreUsedOnlyAboveTheCellLimit) {
  const Folder folder;
  const GroundOptions large = options(folder);
  EXPECT_TRUE(needsWindows(large, 29'999));
  EXPECT_FALSE(needsWindows(large, 30'000));
  GroundOptions built = large;
  built.map_file = "map.ot";
  EXPECT_FALSE(needsWindows(built, 10));
}

// Property: cell codes read by windows equal those of the full ground except near the edge of the DEM; the
// cells of the overview are larger by an integer factor and cover the map.
TEST(WindowedGround, WindowsAreBitIdenticalToTheFullGround) {
  const Folder folder;
  const GroundOptions of = options(folder);
  Context context;
  context.quiet = true;
  const Ground overview = readOverview(of, context), whole = readGround(of, context);
  EXPECT_GE(overview.map.grid().resolution_m, 2.0);
  EXPECT_GE(overview.map.grid().width * overview.map.grid().resolution_m, 200.0);
  EXPECT_GE(overview.map.grid().height * overview.map.grid().resolution_m, 150.0);
  planner::WindowedMap windows = windowsOn(of, overview, context);
  EXPECT_EQ(windows.grid().width, 200);
  const auto near = windows.around({{30.0, 30.0}, {80.0, 60.0}}, 8.0);
  const auto expected = whole.map.published();
  int same = 0;
  for (int row = 0; row < 150; ++row)
    for (int column = 0; column < 200; ++column) {
      const auto code = near->at({column, row});
      if (code.curve() == costmap::CellCode::kUnknown) continue;
      ASSERT_EQ(code, expected->at({column, row})) << column << "," << row;
      ++same;
    }
  EXPECT_GT(same, 3'000);
}

using maps::Point;
using testing::ElementsAre;

maps::ElevationMap placedMap() {
  maps::ElevationMap map = exampleMap();
  map.georeference.emplace(maps::CoordinateSystem{.name = "site", .ellipsoid = maps::kEarth});
  return map;
}

std::vector<Point> read(const std::string& name, const std::string& content) {
  const Folder folder;
  return readPath(folder.write(name, content), exampleMap());
}

TEST(PathReader, TablesAreReadWithColumnsInAnyOrder) {
  EXPECT_THAT(read("p.csv", "name,y_m,x_m\na,2,1\nb,4.5,3e1\n"), ElementsAre(Point{1, 2}, Point{30, 4.5}));
  EXPECT_THAT(read("p.TXT", "x_m,y_m\n1,2\n"), ElementsAre(Point{1, 2}));
}

// Property: the names of the columns state the frame, in any case and with units. Degrees are those of the
// georeference of the map; without names of degrees they are refused.
TEST(PathReader, ColumnNamesStateTheFrame) {
  for (const char* table :
       {"X,Y\n1,2\n", "x [m],y [m]\n1,2\n", "Easting,Northing\n1,2\n", "Y_M;X_M\n2;1\n", "x\ty\n1\t2\n"})
    EXPECT_THAT(read("p.csv", table), ElementsAre(Point{1, 2})) << table;
  const maps::GeoPoint place = placedMap().georeference->reverse({1300, 2100});
  const std::string lat = fmt::format("{:.12f}", place.latitude_rad / kDegree),
                    lon = fmt::format("{:.12f}", place.longitude_rad / kDegree);
  const Folder folder;
  for (const std::string names : {"lat,lon", "Latitude,Longitude", "LAT [deg],LON [deg]", "x,lat,lon"}) {
    const std::string file =
        folder.write("p.csv", names + (names[0] == 'x' ? "\n7," : "\n") + lat + "," + lon + "\n");
    const Point read = readPath(file, placedMap()).front();
    EXPECT_NEAR(read.x_m, 1300, 1e-5) << names;
    EXPECT_NEAR(read.y_m, 2100, 1e-5) << names;
  }
  const std::string bare = folder.write("bare.csv", "X,Y\n" + lon + "," + lat + "\n");
  EXPECT_THAT([&] { readPath(bare, placedMap()); },
              ThrowsMessage<InputError>(HasSubstr("name them lat and lon")));
}

// Property: the properties x_m, y_m of a route file are read bit for bit, even if its coordinates are
// rounded.
TEST(PathReader, RouteMetresAreReadExactly) {
  EXPECT_THAT(read("r.geojson", R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature",
      "geometry":{"type":"LineString","coordinates":[[0.11,7.02],[0.3,8]]},
      "properties":{"x_m":[0.1,0.30000000000000004],"y_m":[7,8]}}]})"),
              ElementsAre(Point{0.1, 7}, Point{0.30000000000000004, 8}));
}

// Regression: a route edited in another program was checked along its original line.
TEST(PathReader, InconsistentCoordinatesAreRejected) {
  const auto with = [](const std::string& coordinates) {
    return R"({"type":"FeatureCollection","crs":"local","features":[{"type":"Feature","geometry":{"type":"LineString",
        "coordinates":)" +
           coordinates + R"(},"properties":{"x_m":[1,3],"y_m":[7,8]}}]})";
  };
  EXPECT_THAT(read("r.geojson", with("[[1,7],[3,8]]")), ElementsAre(Point{1, 7}, Point{3, 8}));
  for (const auto& [coordinates, says] :
       {std::pair{"[[1,7],[3,9]]", "vertex 2: its coordinates lie 1 m from"},
        {"[[7,1],[8,3]]", "vertex 1: its coordinates lie"},
        {"[[1,7]]", "has 1 coordinates, but 2 values of x_m"},
        {"[[1,7],[2,7.5],[3,8]]", "has 3 coordinates, but 2"}})
    EXPECT_THAT([&] { read("r.geojson", with(coordinates)); }, ThrowsMessage<InputError>(HasSubstr(says)))
        << coordinates;
}

TEST(PathReader, FirstLineOfAGeoJsonIsRead) {
  EXPECT_THAT(read("l.json", R"({"type":"GeometryCollection","crs":"local","geometries":[
      {"type":"Point","coordinates":[9,9]},{"type":"LineString","coordinates":[[1,2],[3,4]]}]})"),
              ElementsAre(Point{1, 2}, Point{3, 4}));
}

// A path is checked cell by cell, so the total length is limited, although each vertex lies near the map.
TEST(PathReader, PathLongerThanFourMillionCellsIsRejected) {
  std::string rows = "x_m,y_m\n";
  for (int k = 0; k < 100; ++k) rows += k % 2 == 0 ? "0,0\n" : "400000,0\n";
  EXPECT_THAT([&] { read("long.csv", rows); },
              ThrowsMessage<InputError>(HasSubstr("more than 4 million cells")));
}

TEST(PathReader, InvalidPathsAreRejectedWithOneLine) {
  struct Case {
    const char* name;
    const char* content;
    const char* says;
  };
  for (const Case& c :
       {Case{"a.csv", "x_m,z_m\n1,2\n", "names no columns of places"},
        {"n.csv", "lat,lon\n91,2\n", "n.csv:2: must be"},
        {"m.csv", "lat,lon\n1,2\n", "has no CRS for a latitude"},
        {"b.csv", "x_m,y_m\n1,2\n3,inf\n", "b.csv:3"},
        {"c.csv", "x_m,y_m\n", "contains no point"},
        {"d.json", R"({"type":"FeatureCollection","features":[]})", "contains no line"},
        {"e.json", R"({"type":"FeatureCollection","features":[7,{"properties":[]}]})",
         "has a geometry without a \"type\""},
        {"f.json", R"({"type":"LineString"})", "has no list of its positions"},
        {"g.json", R"({"type":"LineString","crs":"local","coordinates":[["a",2]]})", "g.json"},
        {"h.json", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":
            {"x_m":[1,"b"],"y_m":[1,2]},"geometry":null}]})",
         "contains no line"}})
    EXPECT_THAT([&] { read(c.name, c.content); }, ThrowsMessage<InputError>(HasSubstr(c.says))) << c.name;
}

}  // namespace ground_options_test

}  // namespace talus::cli
