// Several levels: a road under a bridge, as in a point cloud.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <octomap/OcTree.h>
#include <site_fixture.hpp>
#include <unistd.h>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/map/explanation.hpp>
#include <talus/costmap/map/map_file.hpp>
#include <talus/costmap/surface/octomap_surface.hpp>
#include <talus/costmap/telemetry/drive_evidence.hpp>

namespace talus::costmap {
namespace bridge_test {

constexpr double kVoxel_m = 0.5;
constexpr double kRoad_m = 0.25, kDeck_m = 3.25;  // centres of voxels

// A plain of 40 m by 20 m; a deck 3 m above the plain from x = 16 m to 24 m, with free space beneath.
OctomapGround bridge(double ceiling_m = std::numeric_limits<double>::infinity()) {
  octomap::OcTree tree(kVoxel_m);
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 40; ++y) {
      const auto voxel = [&](double z) {
        return octomap::point3d(static_cast<float>(kVoxel_m * x + 0.25),
                                static_cast<float>(kVoxel_m * y + 0.25), static_cast<float>(z));
      };
      tree.updateNode(voxel(kRoad_m), true);
      if (x >= 32 && x < 48) tree.updateNode(voxel(kDeck_m), true);
    }
  std::stringstream stream;
  tree.writeBinaryConst(stream);
  return octomapGround(stream, "bridge.bt", ceiling_m);
}

TraversabilityMap mapOf(OctomapGround ground) {
  MapLayers layers;
  const std::size_t cells = ground.surface.grid().size();
  layers.elevation = std::move(ground.surface);
  layers.floors = Floors(std::move(ground.floors), cells);
  return TraversabilityMap(std::move(layers), testGround(), {});
}

// Readings of weak ground every half metre at the height z_m, between two values of x.
terramech::Telemetry drive(double z_m, double from_m, double to_m) {
  terramech::Telemetry out;
  out.source = "drive.csv";
  std::vector<double> x, y, z, load, slip, slope, time;
  for (double at = from_m; at <= to_m; at += 0.5) {
    x.push_back(at);
    y.push_back(10.2);
    z.push_back(z_m);
    load.push_back(55.8);
    slip.push_back(0.6 + 0.01 * static_cast<double>(x.size() % 5));
    slope.push_back(0.0);
    time.push_back(at);
    out.lines.push_back(x.size() + 1);
  }
  out.numbers = {{"x_m", x},     {"y_m", y},           {"z_m", z},      {"load_N", load},
                 {"slip", slip}, {"slope_rad", slope}, {"time_s", time}};
  return out;
}

maps::Cell cellAt(const TraversabilityMap& map, double x) {
  return *map.grid().cellAt({x, 10.2});
}

CellBelief roadBelief(const TraversabilityMap& map, double x) {
  const maps::Cell cell = cellAt(map, x);
  return map.belief(cell, map.surface().floors().of(map.grid().index(cell))[0]);
}

TEST(Bridge, EvidenceBelowTheDeckDoesNotAffectTheDeckCell) {
  TraversabilityMap map = mapOf(bridge());
  const CellBelief deck = map.belief(cellAt(map, 20.0)), road = roadBelief(map, 20.0);
  addDrive(map, drive(kRoad_m, 17.0, 23.0), nullptr);
  // All ground has one soil, so that evidence on the road changes the class. The cell of the deck has no
  // evidence and has the estimate of the class.
  const CellBelief after = map.belief(cellAt(map, 20.0)), below = roadBelief(map, 20.0);
  EXPECT_EQ(after.evidence, 0.0F);
  EXPECT_EQ(deck.evidence, 0.0F);
  EXPECT_GT(below.evidence, 0.0F);
  EXPECT_LT(below.pull_mean, road.pull_mean - 0.05F);
  EXPECT_EQ(after.pull_mean, static_cast<float>(map.evidence().classBelief(0).pull.value));
  EXPECT_GT(after.pull_mean, below.pull_mean + 0.03F);
  EXPECT_TRUE(has(below.hazards, Hazard::Unknown)) << "its shape is not judged";
}

TEST(Bridge, RasterClassIsNotUpdatedFromTheLowerFloor) {
  OctomapGround ground = bridge();
  MapLayers layers;
  layers.classes = maps::Raster<std::uint8_t>(ground.surface.grid(), 2);
  const std::size_t cells = ground.surface.grid().size();
  layers.elevation = std::move(ground.surface);
  layers.floors = Floors(std::move(ground.floors), cells);
  TraversabilityMap map(std::move(layers), testGround(), {});
  const CellBelief deck = map.belief(cellAt(map, 20.0));
  addDrive(map, drive(kRoad_m, 17.0, 23.0), nullptr);
  EXPECT_EQ(map.belief(cellAt(map, 20.0)), deck) << "to the bit";
  EXPECT_EQ(map.evidence().posterior(0).places, 0.0);
  EXPECT_EQ(map.evidence().posterior(1).places, 0.0);
  EXPECT_EQ(roadBelief(map, 20.0).terrain_class, 1);
  EXPECT_GT(roadBelief(map, 20.0).evidence, 0.0F);
}

TEST(Bridge, EvidenceOnTheDeckDoesNotAffectTheRoad) {
  TraversabilityMap map = mapOf(bridge());
  addDrive(map, drive(kDeck_m, 17.0, 23.0), nullptr);
  EXPECT_GT(map.belief(cellAt(map, 20.0)).evidence, 0.0F);
  EXPECT_EQ(roadBelief(map, 20.0).evidence, 0.0F);
  EXPECT_EQ(roadBelief(map, 20.0).pull_mean, static_cast<float>(map.evidence().classBelief(0).pull.value));
}

TEST(Bridge, EvidenceBeforeTheBridgeExtendsToTheRoadBelow) {
  TraversabilityMap map = mapOf(bridge());
  addDrive(map, drive(kRoad_m, 8.0, 15.5), nullptr);
  const float away = static_cast<float>(map.evidence().classBelief(0).pull.value);
  EXPECT_LT(roadBelief(map, 16.3).pull_mean, away - 0.02F) << "a metre beneath the deck";
  EXPECT_EQ(roadBelief(map, 22.0).pull_mean, away) << "beyond the correlation length";
}

// A road that rises by one voxel every metre and a half, under a deck far above the road.
TEST(Bridge, ClimbingRoadIsOneFloor) {
  octomap::OcTree tree(kVoxel_m);
  const auto road_m = [](int x) { return kVoxel_m * (x / 3) + 0.25; };
  for (int x = 0; x < 80; ++x)
    for (int y = 0; y < 40; ++y) {
      const auto voxel = [&](double z) {
        return octomap::point3d(static_cast<float>(kVoxel_m * x + 0.25),
                                static_cast<float>(kVoxel_m * y + 0.25), static_cast<float>(z));
      };
      tree.updateNode(voxel(road_m(x)), true);
      if (x >= 32 && x < 48) tree.updateNode(voxel(14.25), true);
    }
  std::stringstream stream;
  tree.writeBinaryConst(stream);
  TraversabilityMap map = mapOf(octomapGround(stream, "bridge.bt"));
  const float before = roadBelief(map, 17.7).pull_mean;
  for (double x = 10.0; x < 15.5; x += 0.5)
    addDrive(map, drive(road_m(static_cast<int>(2.0 * x)), x, x), nullptr);
  const float away = static_cast<float>(map.evidence().classBelief(0).pull.value);
  EXPECT_EQ(away, before) << "one place, which moves no class";
  EXPECT_LT(roadBelief(map, 17.7).pull_mean, away - 0.005F) << "told by ground half a metre and more below";
  // Cells of one block share evidence if their roads differ by one voxel in height.
  addDrive(map, drive(road_m(38) + 0.1, 19.2, 19.2), nullptr);
  std::size_t with_own = 0;
  for (double x = 17.2; x < 21.0; x += 0.5) with_own += roadBelief(map, x).evidence > 0.0F;
  EXPECT_EQ(with_own, static_cast<std::size_t>(map.evidence().blockCells()));
  EXPECT_EQ(map.evidence().floorEvidence().size(), 1U);
}

TEST(Bridge, RowsWithoutHeightOrFloorAreAssignedToTheTop) {
  TraversabilityMap map = mapOf(bridge());
  terramech::Telemetry rows = drive(kRoad_m, 17.0, 23.0);
  std::erase_if(rows.numbers, [](const auto& column) { return column.name == "z_m"; });
  addDrive(map, rows, nullptr);
  EXPECT_GT(map.belief(cellAt(map, 20.0)).evidence, 0.0F);
  // On ground without other floors, a z_m with another vertical datum has no effect.
  TraversabilityMap plain = mapOf(bridge()), offset = mapOf(bridge());
  addDrive(plain, drive(kRoad_m, 2.0, 10.0), nullptr);
  addDrive(offset, drive(kRoad_m - 2500.0, 2.0, 10.0), nullptr);
  EXPECT_EQ(plain.belief(cellAt(plain, 6.0)), offset.belief(cellAt(offset, 6.0)));
}

// Property: the slope of the deck is not used for the road beneath.
TEST(Bridge, RowWithoutSlopeUsesTheSlopeOfItsOwnFloor) {
  TraversabilityMap map = mapOf(bridge());
  const auto without_slope = [](double z_m) {
    terramech::Telemetry rows = drive(z_m, 17.0, 23.0);
    for (auto& column : rows.numbers)
      if (column.name == "slope_rad") column.name = "heading_rad";  // eastwards
    return rows;
  };
  EXPECT_EQ(addDrive(map, without_slope(kRoad_m), nullptr).used, 0U);
  EXPECT_GT(addDrive(map, without_slope(kDeck_m), nullptr).used, 0U);
}

TEST(Bridge, BelowTheCeilingTheRoadIsTheMapSurface) {
  TraversabilityMap map = mapOf(bridge(2.0));
  EXPECT_EQ(map.surface().hazards(cellAt(map, 20.0)), Hazard::None);
  addDrive(map, drive(kDeck_m, 17.0, 23.0), nullptr);
  EXPECT_EQ(map.belief(cellAt(map, 20.0)).evidence, 0.0F) << "the deck is the other floor";
  addDrive(map, drive(kRoad_m, 17.0, 23.0), nullptr);
  EXPECT_GT(map.belief(cellAt(map, 20.0)).evidence, 0.0F);
}

TEST(Bridge, BothFloorsRoundTripThroughFileAndJournal) {
  const auto path = std::filesystem::path(::testing::TempDir()) / ("bridge" + std::to_string(::getpid()));
  std::filesystem::remove(path);
  TraversabilityMap map = mapOf(bridge()), rebuilt = mapOf(bridge());
  {
    EvidenceJournal journal(path.string());
    addDrive(map, drive(kRoad_m, 12.0, 23.0), &journal);
    addDrive(map, drive(kDeck_m, 17.0, 20.0), &journal);
    replay(rebuilt, journal);
  }
  std::filesystem::remove(path);
  std::stringstream first, second, third;
  writeMap(map, first);
  writeMap(rebuilt, second);
  EXPECT_TRUE(first.str() == second.str()) << "replayed";
  const TraversabilityMap back = readMap(first, {.name = "map.ot", .threads = 1});
  writeMap(back, third);
  EXPECT_TRUE(first.str() == third.str()) << "read back";
  EXPECT_GT(roadBelief(back, 20.0).evidence, 0.0F);
  EXPECT_EQ(roadBelief(back, 20.0), roadBelief(map, 20.0));
}

TEST(Bridge, ExplanationListsBothFloors) {
  TraversabilityMap map = mapOf(bridge());
  addDrive(map, drive(kRoad_m, 17.0, 23.0), nullptr);
  const Explanation told = explain(map, cellAt(map, 20.0));
  const auto value = [&](const char* name) {
    const auto cause =
        std::find_if(told.causes.begin(), told.causes.end(), [&](const Cause& c) { return c.name == name; });
    return cause == told.causes.end() ? std::nan("") : cause->value;
  };
  EXPECT_NEAR(value("elevation_m"), kDeck_m, 1e-6);
  EXPECT_NEAR(value("floor_elevation_m"), kRoad_m, 1e-6);
  EXPECT_GT(value("floor_evidence_samples"), 0.0);
  EXPECT_EQ(value("evidence_samples"), 0.0);
}

}  // namespace bridge_test
}  // namespace talus::costmap
