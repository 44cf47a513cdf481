#include <cmath>
#include <cstring>
#include <sstream>

#include <octomap/AbstractOcTree.h>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>

namespace talus::costmap {
namespace map_file_test {

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
