#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

#include <octomap/AbstractOcTree.h>
#include <site_map.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

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
                testing::HasSubstr("map of version 3; this program reads version 10; write the map again"));
  }
}

TEST(MapFile, InaccessiblePathsAreRejected) {
  EXPECT_THROW(readMap("/nonexistent/map.ot"), InputError);
  EXPECT_THROW(writeMap(site(), "/nonexistent/map.ot"), InputError);
}

// Incremental against full publication, over random drives, patches, refusals and moves.

using maps::Cell;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

struct Case {
  unsigned seed = 1;
  double resolution_m = 0.5;
  int rounds = 12, most_readings = 12;
  bool one_class = false;     // no class raster
  double pull_spread = 0.15;  // standard deviation of the readings' pull
  bool costs = false;         // true if a cost layer is added
  bool runs_out = false;      // true if the cost curves run out
  bool forgets = false;       // true if some evidence is removed again
  TravelPolicy policy{};
};

class Sequence {
 public:
  explicit Sequence(const Case& how) : how_(how), random_(how.seed) {
    map_.emplace(layers(), testGround(how.policy), TraversabilityMap::Options{});
  }

  void run();
  int compared() const { return compared_; }
  int drivable() const { return drivable_; }
  int forgotten() const { return forgotten_; }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }
  int whole(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<unsigned>(high - low + 1));
  }
  float height(Cell c) { return static_cast<float>(0.3 * std::sin(0.2 * c.column) * std::cos(0.15 * c.row)); }
  std::uint8_t classAt(Cell c) const { return (c.column / 13 + c.row / 11) % 3 == 0 ? 2 : 1; }
  MapLayers layers();
  maps::Point anywhere();
  WheelObservation reading(const maps::Point& place);
  void drive();
  void patch();
  bool isBetterThanBelieved(Cell cell) const;
  void publishedIsAtOnce();

  Case how_;
  std::mt19937 random_;
  std::optional<TraversabilityMap> map_;
  std::vector<SavedBlock> counted_;
  int compared_ = 0, drivable_ = 0, forgotten_ = 0;
};

MapLayers Sequence::layers() {
  const maps::Grid grid{
      .width = 72, .height = 66, .resolution_m = how_.resolution_m, .south_west = {10.0, -7.0}};
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  if (!how_.one_class) layers.classes = maps::Raster<std::uint8_t>(grid, 1);
  if (how_.costs) layers.costs = {{"own", maps::Raster<float>(grid, 0.0F), 5.0F}};
  forEachCell(allOf(grid), [&](Cell c) {
    layers.elevation.elevation_m[c] = height(c);
    if (!how_.one_class) layers.classes[c] = uniform(0.0, 1.0) < 0.004 ? 255 : classAt(c);
    if (how_.costs && c.column % 9 < 4)
      layers.costs[0].added_J_per_m[c] = static_cast<float>(10 * (c.column % 9));
  });
  return layers;
}

maps::Point Sequence::anywhere() {
  const maps::Grid& grid = map_->grid();
  return {grid.south_west.x_m + uniform(0.0, grid.width * grid.resolution_m),
          grid.south_west.y_m + uniform(0.0, grid.height * grid.resolution_m)};
}

// Random observation: verified, suspected, with a shared error, with bounds or sinkage, and with a random
// position uncertainty.
WheelObservation Sequence::reading(const maps::Point& place) {
  WheelObservation seen{.time_s = 1.0, .place = place};
  seen.pull = {0.22 + uniform(-how_.pull_spread, how_.pull_spread), uniform(0.0, 1.0) < 0.8 ? 0.04 : 0.12};
  seen.sinkage = {uniform(0.05, 0.4), 0.05};
  seen.trust = static_cast<Trust>(whole(0, 2));
  if (uniform(0.0, 1.0) < 0.3) seen.shared_std = uniform(0.0, 0.1);
  if (uniform(0.0, 1.0) < 0.15) seen.pose_std_m = uniform(0.0, 4.0);
  if (uniform(0.0, 1.0) < 0.1) seen.here.most_pull = uniform(-0.2, 0.2);
  if (uniform(0.0, 1.0) < 0.1) seen.here.least_sinkage = uniform(0.3, 1.0);
  return seen;
}

void Sequence::drive() {
  if (how_.forgets && whole(0, 2) == 0)
    for (const SavedBlock& heard : std::exchange(counted_, {})) {
      map_->forget(heard);
      ++forgotten_;
    }
  maps::Point at = anywhere();
  for (int k = whole(1, how_.most_readings); k > 0; --k) {
    const WheelObservation seen = reading(at);
    if (const auto heard = map_->evidence().readingsOf(seen); heard && how_.forgets && whole(0, 1) == 0)
      counted_.push_back(*heard);
    map_->learn(seen);
    at = {at.x_m + uniform(-0.5, 1.5), at.y_m + uniform(-0.5, 1.0)};
  }
}

// Changes classes and heights; holes remain.
void Sequence::patch() {
  const maps::Grid& grid = map_->grid();
  const Cell first{whole(0, grid.width - 1), whole(0, grid.height - 1)};
  maps::Grid part = grid;
  part.width = whole(1, std::min(24, grid.width - first.column));
  part.height = whole(1, std::min(24, grid.height - first.row));
  part.south_west = {grid.south_west.x_m + first.column * grid.resolution_m,
                     grid.south_west.y_m + first.row * grid.resolution_m};
  SurfacePatch seen;
  seen.elevation_m = maps::Raster<float>(part, kNaN);
  if (!map_->surface().classes().empty()) seen.classes = maps::Raster<std::uint8_t>(part, 255);
  const int by = whole(0, 20);
  forEachCell(allOf(part), [&](Cell c) {
    const Cell there{first.column + c.column, first.row + c.row};
    seen.elevation_m[c] = height(there);
    if (!seen.classes.empty()) seen.classes[c] = classAt({there.column + by, there.row});
  });
  map_->patch(seen);
}

// True if a cell is published as stronger, or with less sinkage, than its estimate. Tolerance: a millionth of
// a rounding step.
bool Sequence::isBetterThanBelieved(Cell cell) const {
  constexpr double kRounded = 1e-6, kTail = 6.0;
  const auto known = map_->ground(cell), published = map_->costs().ground(cell);
  if (!known || !published) return false;
  const auto low = [](const Estimate& e) { return e.value - kTail * e.std; };
  return published->pull.value > known->pull.value + kRounded ||
         low(published->pull) > low(known->pull) + kRounded ||
         published->sinkage.value < known->sinkage.value - kRounded;
}

// Compares with moved({0, 0}), which builds the map from the same layers, evidence and refused places.
void Sequence::publishedIsAtOnce() {
  const TraversabilityMap at_once = map_->moved({0, 0});
  const auto a = map_->published(), b = at_once.published();
  int different = 0, cheaper = 0, better = 0;
  forEachCell(allOf(map_->grid()), [&](Cell c) {
    const CellCode mine = a->at(c), its = b->at(c);
    different += mine.stepsX() != its.stepsX() || mine.stepsY() != its.stepsY();
    for (int k = 0; k < 16; ++k) {
      const Direction heading{std::cos(k * std::numbers::pi / 8.0), std::sin(k * std::numbers::pi / 8.0)};
      const float x = a->cost().costPerMetre(mine, heading), y = b->cost().costPerMetre(its, heading);
      different += std::bit_cast<std::uint32_t>(x) != std::bit_cast<std::uint32_t>(y);
      cheaper += x < y;
      drivable_ += std::isfinite(x);
    }
    if ((c.column + 5 * c.row + compared_) % 23 == 0) better += isBetterThanBelieved(c);
    different += a->cost().detail(mine, {1.0, 0.0}).category != b->cost().detail(its, {1.0, 0.0}).category;
  });
  ++compared_;
  ASSERT_EQ(better, 0) << "seed " << how_.seed << ", comparison " << compared_;
  ASSERT_EQ(cheaper, 0) << "seed " << how_.seed << ", comparison " << compared_;
  if (!how_.runs_out) {
    ASSERT_EQ(different, 0) << "seed " << how_.seed << ", comparison " << compared_;
  }
}

void Sequence::run() {
  for (int round = 0; round < how_.rounds && !testing::Test::HasFatalFailure(); ++round) {
    const int what = whole(0, 9);
    if (what == 0) map_->refuse(anywhere(), uniform(0.3, 1.5));
    if (what == 1) {
      map_.emplace(map_->moved({whole(-1, 1), 0}));
      counted_.clear();
    }
    if (what < 9) drive();
    if (what == 2 || what == 9)
      patch();
    else
      map_->publish();
    publishedIsAtOnce();
  }
}

void runAll(Case how, unsigned seeds) {
  int drivable = 0;
  for (const unsigned first = how.seed; how.seed < first + seeds; ++how.seed) {
    Sequence sequence(how);
    sequence.run();
    EXPECT_EQ(sequence.compared(), how.rounds);
    drivable += sequence.drivable();
  }
  EXPECT_GT(drivable, 10000);
}

// Property: incremental equals full publication if some of the evidence is removed again.
TEST(PublishOrder, IncrementalEqualsFullPublicationWithForgottenReadings) {
  int forgotten = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Sequence sequence({.seed = seed, .one_class = seed == 4, .forgets = true});
    sequence.run();
    if (testing::Test::HasFatalFailure()) return;
    forgotten += sequence.forgotten();
  }
  EXPECT_GT(forgotten, 20);
}

// Property: after any evidence, patches, refusals and moves, in pieces of any size, the costs are
// bit-identical to those of the whole map published at once.
TEST(PublishOrder, IncrementalEqualsFullPublication) {
  runAll({.seed = 1, .rounds = 20}, 3);
}

TEST(PublishOrder, IncrementalEqualsFullPublicationForSingleReadings) {
  runAll({.seed = 11, .rounds = 40, .most_readings = 1}, 2);
}

// Case with more places than one Gaussian process uses, and blocks of several cells.
TEST(PublishOrder, IncrementalEqualsFullPublicationForDenseEvidence) {
  runAll({.seed = 21, .resolution_m = 0.25, .rounds = 12, .most_readings = 80, .pull_spread = 0.05}, 2);
}

TEST(PublishOrder, IncrementalEqualsFullPublicationWithoutClassRaster) {
  runAll({.seed = 31, .resolution_m = 1.0, .rounds = 25, .one_class = true}, 2);
}

TEST(PublishOrder, IncrementalEqualsFullPublicationWithUnknownAllowed) {
  runAll({.seed = 41, .rounds = 8, .policy = {.allow_unknown = true, .pose_error_m = 0.0}}, 2);
}

// Property: if the curves run out, no cost of incremental publication is lower than that of full
// publication.
TEST(PublishOrder, IncrementalCostIsNotLowerOnCurveOverflow) {
  runAll({.seed = 51, .rounds = 10, .most_readings = 40, .pull_spread = 0.5, .costs = true, .runs_out = true},
         1);
}

}  // namespace map_file_test
}  // namespace talus::costmap
