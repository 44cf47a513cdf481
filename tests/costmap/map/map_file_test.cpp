#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include <octomap/AbstractOcTree.h>
#include <site_fixture.hpp>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/map/map_file.hpp>

namespace talus::costmap {

namespace map_file_test {

using testing::HasSubstr;

MapText example() {
  MapText text;
  text.grid = {.width = 7, .height = 9, .resolution_m = 0.1, .south_west = {-1.0 / 3.0, 1e-300}};
  text.source = "a \\n map\nof two lines\\";
  text.footprint_radius_m = 0.45;
  text.ground = testGround()->parts();
  text.ground.rover.steering = terramech::Steering::Ackermann;
  text.ground.policy.allow_unknown = true;
  text.ground.classes[0].soil.digging_exponent = 0.1;
  text.ground.classes[0].soil.slip_sinkage_exponent = 0.3;
  text.ground.classes[0].soil.side_bulldozing = 0.0;
  text.ground.classes[1].effects = {{.name = "empirical",
                                     .covariate = "slip",
                                     .channel = terramech::Channel::Torque,
                                     .parameters = {0.1, -0.2},
                                     .knots = {0.0, 0.7},
                                     .only_column = "wheel",
                                     .only_value = "front\nleft"}};
  return text;
}

std::string replaced(std::string lines, const std::string& old, const std::string& by) {
  const std::size_t at = lines.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return lines.replace(at, old.size(), by);
}

TEST(MapText, RoundTripIsExact) {
  const MapText back = parsed(written(example()), "m");
  EXPECT_EQ(back.grid, example().grid);
  EXPECT_EQ(back.source, example().source);
  EXPECT_FALSE(back.coordinate_system);
  EXPECT_EQ(back.ground.rover.name, "test rover");
  EXPECT_EQ(back.ground.rover.steering, terramech::Steering::Ackermann);
  EXPECT_TRUE(back.ground.policy.allow_unknown);
  ASSERT_EQ(back.ground.classes.size(), 2U);
  EXPECT_EQ(back.ground.classes[0].soil.digging_exponent, 0.1);
  EXPECT_EQ(back.ground.classes[0].soil.slip_sinkage_exponent, 0.3);
  EXPECT_EQ(back.ground.classes[0].soil.side_bulldozing, 0.0);
  EXPECT_EQ(back.ground.classes[1].effects[0].knots, (std::vector<double>{0.0, 0.7}));
  EXPECT_EQ(back.ground.classes[1].effects[0].parameters, (std::vector<double>{0.1, -0.2}));
  EXPECT_EQ(back.ground.classes[1].effects[0].channel, terramech::Channel::Torque);
  EXPECT_EQ(back.ground.classes[1].effects[0].only_value, "front\nleft");
  EXPECT_EQ(written(back), written(example()));
}

// Property: the centre of mass is stored; a centred mass would underestimate tipping.
TEST(MapText, CentreOfMassRoundTrips) {
  MapText text = example();
  text.ground.rover.centre_of_mass_ahead_m = 0.07;
  text.ground.rover.centre_of_mass_left_m = -0.03;
  const std::string lines = written(text);
  const terramech::Rover back = parsed(lines, "m").ground.rover;
  EXPECT_EQ(back.centre_of_mass_ahead_m, 0.07);
  EXPECT_EQ(back.centre_of_mass_left_m, -0.03);
  // A map without the two lines has a rover with a centred mass.
  const std::string older = replaced(lines, "rover.centre_of_mass_left_m -0.03\n", "");
  EXPECT_EQ(parsed(older, "m").ground.rover.centre_of_mass_left_m, 0.0);
}

// Property: every field of the coordinate system is stored; on Mars, a planetocentric latitude read as
// planetographic has an error of up to 20 km.
TEST(MapText, CoordinateSystemRoundTripsCompletely) {
  for (const bool planetocentric : {false, true}) {
    MapText text = example();
    text.coordinate_system = {.name = "Mars / Ocentric",
                              .ellipsoid = maps::kMars,
                              .projection = {.method = maps::ProjectionMethod::LambertConformalConic,
                                             .latitude_of_origin_rad = 0.1,
                                             .central_meridian_rad = 0.2,
                                             .standard_parallel_1_rad = 0.3,
                                             .standard_parallel_2_rad = 0.4,
                                             .scale = 0.9996,
                                             .false_easting_m = 5e5,
                                             .false_northing_m = -1e7},
                              .planetocentric = planetocentric,
                              .wkt = "PROJCRS[\"a\",\n  b]"};
    const auto back = parsed(written(text), "m").coordinate_system;
    ASSERT_TRUE(back);
    EXPECT_EQ(back->name, "Mars / Ocentric");
    EXPECT_EQ(back->ellipsoid, maps::kMars);
    EXPECT_EQ(back->planetocentric, planetocentric);
    EXPECT_EQ(back->wkt, text.coordinate_system->wkt);
    const maps::Point a = maps::Georeference(*back).forward({0.35, 0.25});
    EXPECT_EQ(a, maps::Georeference(*text.coordinate_system).forward({0.35, 0.25}));
  }
}

TEST(MapText, MissingUnknownAndNonNumericLinesAreRejected) {
  const std::string lines = written(example());
  const auto refusal = [&](const std::string& text) {
    try {
      parsed(text, "map.ot");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(lines), "accepted");
  EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "")), HasSubstr("map.ot: damaged"));
  EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "")), HasSubstr("'grid.width' is missing"));
  EXPECT_THAT(refusal(lines + "grid.depth 3\n"), HasSubstr("'grid.depth' is unknown"));
  EXPECT_THAT(refusal(lines + "grid\n"), HasSubstr("line 'grid' has no value"));
  for (const char* bad : {"seven", "7 cells", "7.5", "", "99999999999"})
    EXPECT_THAT(refusal(replaced(lines, "grid.width 7\n", "grid.width " + std::string(bad) + "\n")),
                HasSubstr("'grid.width' is not a number"))
        << bad;
  EXPECT_THAT(refusal(replaced(lines, "footprint_radius_m 0.45\n", "footprint_radius_m 1e999\n")),
              HasSubstr("'footprint_radius_m' is not a number"));
  EXPECT_THAT(refusal(replaced(lines, "classes 2\n", "classes 255\n")), HasSubstr("255 classes"));
  EXPECT_THAT(refusal(replaced(lines, "effects 1\n", "effects 100000\n")), HasSubstr("is 100000"));
}

TEST(MapTree, TreeContainsEveryCellAtItsHeight) {
  const TraversabilityMap map =
      mapOf({"11111222", "11111222", "11?11222", "11111#22", "11111122", "30111122"}, 0.3);
  const TraversabilityTree tree = treeOf(map);
  for (int row = 0; row < map.grid().height; ++row)
    for (int column = 0; column < map.grid().width; ++column) {
      const maps::Cell cell{column, row};
      const double elevation = static_cast<double>(map.elevation().elevation_m[cell]);
      if (std::isnan(elevation)) continue;
      const CellBelief* found = tree.find(map.surface().keys().key(cell, elevation));
      ASSERT_NE(found, nullptr);
      EXPECT_EQ(*found, map.belief(cell)) << column << ' ' << row;
    }
}

TraversabilityMap site() {
  return mapOf({"1122", "1?22", "11#2", "1111"}, 0.05);
}

std::string bytesOf(const TraversabilityMap& map) {
  std::stringstream stream;
  writeMap(map, stream);
  return stream.str();
}

TraversabilityMap fromBytes(const std::string& bytes) {
  std::istringstream stream(bytes);
  return readMap(stream, {.name = "map.ot", .threads = 1});
}

TEST(MapFile, CostGridAndBytesRoundTrip) {
  const TraversabilityMap map = site();
  const std::string bytes = bytesOf(map);
  const TraversabilityMap back = fromBytes(bytes);
  EXPECT_EQ(bytesOf(back), bytes);
  ASSERT_EQ(back.grid(), map.grid());
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      EXPECT_EQ(back.published()->at({column, row}), map.published()->at({column, row}));
  const CellCode cell = map.published()->at({0, 0});
  EXPECT_EQ(back.published()->cost().costPerMetre(cell, {0.6, 0.8}),
            map.published()->cost().costPerMetre(cell, {0.6, 0.8}));
}

TEST(MapFile, CostLayersRoundTrip) {
  MapLayers layers = drawn({"1122", "1122", "1111"});
  CostLayer own{.name = "shadow", .added_J_per_m = maps::Raster<float>(layers.elevation.grid(), 3.0F)};
  own.added_J_per_m[{3, 2}] = NAN;
  own.added_J_per_m[{0, 0}] = INFINITY;
  own.unseen_J_per_m = 9.0F;
  layers.costs = {own, own};
  layers.costs[1].name = "radio";
  const TraversabilityMap map(std::move(layers), testGround(), {});
  const TraversabilityMap back = fromBytes(bytesOf(map));
  EXPECT_EQ(bytesOf(back), bytesOf(map));
  ASSERT_EQ(back.surface().costLayers().size(), 2U);
  EXPECT_EQ(back.surface().costLayers()[1].name, "radio");
  EXPECT_EQ(back.surface().costLayers()[1].unseen_J_per_m, 9.0F);
  const CellCode cell = map.published()->at({1, 1});
  EXPECT_EQ(back.published()->cost().costPerMetre(back.published()->at({1, 1}), {}),
            map.published()->cost().costPerMetre(cell, {}));
  EXPECT_EQ(back.surface().hazards({0, 0}), map.surface().hazards({0, 0}));
}

// Property: without PROJ a map has metric coordinates only, but preserves its coordinate system for a machine
// with PROJ.
TEST(MapFile, UnsupportedSystemRoundTripsWithoutGeographicCoordinates) {
  MapLayers layers = drawn({"11", "11"});
  layers.elevation.georeference.emplace(
      maps::CoordinateSystem{.name = "CH1903 / LV03",
                             .ellipsoid = maps::kEarth,
                             .projection = {.method = maps::ProjectionMethod::Foreign},
                             .wkt = "W"});
  const std::string bytes = bytesOf(TraversabilityMap(std::move(layers), testGround(), {}));
  const TraversabilityMap bare = fromBytes(bytes);
  EXPECT_EQ(bare.elevation().places(), nullptr);
  EXPECT_EQ(bytesOf(bare), bytes);
  std::istringstream stream(bytes);
  const TraversabilityMap known = readMap(
      stream,
      {.name = "map.ot", .georeference = [](const maps::CoordinateSystem& read, const maps::Grid& on) {
         EXPECT_EQ(read.wkt, "W");
         EXPECT_EQ(on.width, 2);
         return maps::Georeference({.name = read.name, .ellipsoid = maps::kEarth});
       }});
  EXPECT_NE(known.elevation().places(), nullptr);
}

// Property: a refused place stays refused after a map is written and read.
TEST(MapFile, RefusedAreasRoundTrip) {
  TraversabilityMap map = mapOf(std::vector<std::string>(12, std::string(12, '1')));
  map.refuse({106.0, 206.0}, 2.1);
  map.refuse({101.0, 201.0}, 1.0);
  map.publish();
  const TraversabilityMap back = fromBytes(bytesOf(map));
  EXPECT_EQ(bytesOf(back), bytesOf(map));
  int refused = 0;
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column < 12; ++column) {
      EXPECT_EQ(back.published()->at({column, row}), map.published()->at({column, row}));
      EXPECT_EQ(back.surface().hazards({column, row}), map.surface().hazards({column, row}));
      refused += has(back.surface().hazards({column, row}), Hazard::Obstacle) ? 1 : 0;
    }
  EXPECT_GT(refused, 10);
  for (const double bad : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_THROW(map.refuse({106.0, 206.0}, bad), std::invalid_argument);
  EXPECT_THROW(map.refuse({NAN, 206.0}, 1.0), std::invalid_argument);
}

TEST(MapFile, OctoMapReadsTheTree) {
  std::istringstream stream(bytesOf(site()));
  const std::unique_ptr<octomap::AbstractOcTree> tree(octomap::AbstractOcTree::read(stream));
  ASSERT_NE(tree, nullptr);
  EXPECT_EQ(tree->getTreeType(), "TraversabilityTree");
}

TEST(MapFile, EveryTruncationIsRejected) {
  const std::string bytes = bytesOf(site());
  for (std::size_t length = 0; length < bytes.size(); length += 7)
    EXPECT_THROW(fromBytes(bytes.substr(0, length)), InputError) << length;
}

TEST(MapFile, EveryFlippedBitIsRejected) {
  const std::string bytes = bytesOf(site());
  for (std::size_t bit = 0; bit < 8 * bytes.size(); bit += 5) {
    std::string damaged = bytes;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    EXPECT_THROW(fromBytes(damaged), InputError) << bit;
  }
}

TEST(MapFile, TrailingBytesAreRejected) {
  EXPECT_THROW(fromBytes(bytesOf(site()) + "x"), InputError);
  EXPECT_THROW(fromBytes(bytesOf(site()) + bytesOf(site())), InputError);
}

TEST(MapFile, DriveListRoundTrips) {
  TraversabilityMap map = site();
  map.noteDrive("b", {});
  map.noteDrive("first part", {7, "sound"});
  map.noteDrive("a", {7, "sound"}, "first part");
  const TraversabilityMap read = fromBytes(bytesOf(map));
  EXPECT_THAT(read.drives(), testing::ElementsAre(testing::Key("a"), testing::Key("b")));
  EXPECT_EQ(read.drives().at("a").number, 7);
  EXPECT_EQ(read.drives().at("a").sensors, "sound");
}

// Property: a map of another version is rejected with one line that states the version and the remedy.
TEST(MapFile, OtherVersionIsRejectedNamingBothVersions) {
  std::string bytes = bytesOf(site());
  bytes[bytes.size() - 12] = 3;
  try {
    fromBytes(bytes);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("map of version 3; this program reads version 8; write the map again"));
  }
}

TEST(MapFile, InaccessiblePathsAreRejected) {
  EXPECT_THROW(readMap("/nonexistent/map.ot"), InputError);
  EXPECT_THROW(writeMap(site(), "/nonexistent/map.ot"), InputError);
}

}  // namespace map_file_test

}  // namespace talus::costmap
