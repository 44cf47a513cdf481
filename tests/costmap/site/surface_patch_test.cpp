#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <refused.hpp>
#include <site_map.hpp>

#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/site/surface_patch.hpp>
#include <talus/costmap/surface/surface_shape.hpp>

namespace talus::costmap {

namespace surface_patch_test {

using maps::Cell;
using testing::HasSubstr;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kRefused = std::numeric_limits<float>::infinity();

double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0;
}

MapLayers hills(int side) {
  MapLayers layers = drawn(std::vector<std::string>(static_cast<std::size_t>(side),
                                                    std::string(static_cast<std::size_t>(side), '1')));
  forEachCell(allOf(layers.elevation.grid()), [&](Cell c) {
    layers.elevation.elevation_m[c] =
        static_cast<float>(2.0 * std::sin(0.2 * c.column) * std::cos(0.15 * c.row));
    layers.classes[c] = c.column > side / 2 ? 2 : 1;
  });
  return layers;
}

CostLayer layer(const maps::Grid& grid, const std::string& name, float J_per_m) {
  return {.name = name, .added_J_per_m = maps::Raster<float>(grid, J_per_m), .unseen_J_per_m = J_per_m};
}

TraversabilityMap with(MapLayers layers, std::vector<CostLayer> costs, const TravelPolicy& policy = {}) {
  layers.costs = std::move(costs);
  return TraversabilityMap(std::move(layers), testGround(policy), {});
}

double costAt(const TraversabilityMap& map, Cell cell, int k) {
  const double heading = 0.3926990817 * k;
  return static_cast<double>(map.published()->cost().costPerMetre(map.published()->at(cell),
                                                                  {std::cos(heading), std::sin(heading)}));
}

template <typename Check>
void inEachHeading(const maps::Grid& grid, const Check& check) {
  forEachCell(allOf(grid), [&](Cell c) {
    for (int k = 0; k < 16; ++k) check(c, k);
  });
}

// Property: sums of values with two digits are exact. In every heading, across slopes too, the cost of a
// metre is the cost without layers plus the sum of the layers, and no refusal changes.
TEST(AddedCost, TwoDigitSumsAreExact) {
  const MapLayers ground = hills(30);
  const maps::Grid grid = ground.elevation.grid();
  std::vector<CostLayer> costs{layer(grid, "shadow", 0.0F), layer(grid, "radio", 10.0F)};
  forEachCell(allOf(grid),
              [&](Cell c) { costs[0].added_J_per_m[c] = 10.0F * static_cast<float>(c.row % 5); });
  const TraversabilityMap plain = with(ground, {}), dearer = with(ground, costs);
  int allowed = 0;
  inEachHeading(grid, [&](Cell c, int k) {
    const double before = costAt(plain, c, k), after = costAt(dearer, c, k);
    ASSERT_EQ(std::isinf(before), std::isinf(after));
    if (std::isinf(before)) return;
    ++allowed;
    // Costs are stored as floats, with one rounding each.
    EXPECT_NEAR(after - before, 10.0 + 10.0 * (c.row % 5), 3e-7 * after);
  });
  EXPECT_GT(allowed, 1000);
}

// Property: any value is rounded up, by at most a fifth from 0.1 J on.
TEST(AddedCost, ValuesAreRoundedUp) {
  const maps::Grid grid{.width = 100, .height = 100, .resolution_m = 1.0, .south_west = {}};
  std::mt19937 random(5);
  CostLayer many = layer(grid, "many", 0.0F);
  for (float& v : many.added_J_per_m.values())
    v = uniform(random) < 0.2 ? 0.0F : static_cast<float>(std::pow(10.0, 8.0 * uniform(random) - 2.0));
  const AddedCost added({many});
  forEachCell(allOf(grid), [&](Cell c) {
    const auto value = static_cast<double>(many.added_J_per_m[c]);
    const double taken = added.J_per_m(added.step(c));
    ASSERT_GE(taken, value * (1.0 - 1e-7));
    ASSERT_EQ(taken == 0.0, value == 0.0);
    ASSERT_LE(taken, std::max(1.2 * value, 0.1) * (1.0 + 1e-6));
  });
}

// Property: increasing the values of a layer lowers no cost in any heading and allows no refused motion.
TEST(AddedCost, AddedLayerNeverLowersACost) {
  std::mt19937 random(11);
  for (int round = 0; round < 2; ++round) {
    const MapLayers ground = hills(40);
    const maps::Grid grid = ground.elevation.grid();
    const TravelPolicy policy{.allow_unknown = round % 2 == 1};
    CostLayer less = layer(grid, "own", 0.0F);
    for (float& v : less.added_J_per_m.values()) {
      const double kind = uniform(random);
      v = kind < 0.02   ? kRefused
          : kind < 0.04 ? kNaN
                        : std::round(static_cast<float>(10.0 * uniform(random)));
    }
    less.unseen_J_per_m = 10.0F;
    CostLayer more = less;
    for (float& v : more.added_J_per_m.values()) {
      const double kind = uniform(random);
      if (kind < 0.3 && !std::isnan(v)) v += std::round(static_cast<float>(5.0 * uniform(random)));
      if (kind > 0.98) v = kRefused;
    }
    more.unseen_J_per_m = 15.0F;
    const TraversabilityMap base = with(ground, {}, policy), a = with(ground, {less}, policy);
    inEachHeading(grid, [&](Cell c, int k) { ASSERT_GE(costAt(a, c, k), costAt(base, c, k)); });
    const TraversabilityMap b = with(ground, {more}, policy);
    inEachHeading(grid, [&](Cell c, int k) { ASSERT_GE(costAt(b, c, k), costAt(a, c, k)); });
    CostLayer second = layer(grid, "second", 0.0F);
    for (float& v : second.added_J_per_m.values()) v = uniform(random) < 0.1 ? 20.0F : 0.0F;
    const TraversabilityMap both = with(ground, {less, second}, policy);
    inEachHeading(grid, [&](Cell c, int k) { ASSERT_GE(costAt(both, c, k), costAt(a, c, k)); });
  }
}

TEST(AddedCost, RefusedAndNoDataCellsFollowThePolicy) {
  const MapLayers ground = drawn({"11111111", "11111111", "11111111", "11111111", "11111111", "11111111"});
  const maps::Grid grid = ground.elevation.grid();
  CostLayer own = layer(grid, "own", 5.0F);
  own.added_J_per_m[{1, 1}] = kRefused;
  own.added_J_per_m[{6, 4}] = kNaN;
  own.unseen_J_per_m = 40.0F;
  const TraversabilityMap closed = with(ground, {own}), open = with(ground, {own}, {.allow_unknown = true});
  const TraversabilityMap plain = with(ground, {}, {.allow_unknown = true});
  for (const TraversabilityMap* map : {&closed, &open}) {
    EXPECT_TRUE(std::isinf(costAt(*map, {1, 1}, 0)));
    EXPECT_THAT(explain(*map, {1, 1}).verdict, HasSubstr("refused by layer 'own'"));
  }
  EXPECT_TRUE(std::isinf(costAt(closed, {6, 4}, 0)));
  EXPECT_THAT(explain(closed, {6, 4}).verdict, HasSubstr("no data in layer 'own'"));
  EXPECT_NEAR(costAt(open, {6, 4}, 0) - costAt(plain, {6, 4}, 0), 40.0, 1e-3);
  const Explanation why = explain(open, {4, 3});
  EXPECT_TRUE(std::ranges::any_of(
      why.causes, [](const Cause& c) { return c.name == "layer_own_J_per_m" && c.value == 5.0; }));
}

// Property: patches, new weights and telemetry keep the added cost of a layer; a patch that removes a
// keep-out area does not remove a refusal of a layer.
TEST(AddedCost, PatchesWeightsAndEvidenceKeepTheAddedCost) {
  MapLayers ground = hills(30);
  const maps::Grid grid = ground.elevation.grid();
  CostLayer own = layer(grid, "own", 0.0F);
  forEachCell(allOf(grid),
              [&](Cell c) { own.added_J_per_m[c] = static_cast<float>(c.row * grid.width + c.column); });
  own.added_J_per_m[{20, 20}] = kRefused;
  TraversabilityMap map = with(ground, {own});
  SurfacePatch patch{.elevation_m = maps::Raster<float>(grid, 0.0F),
                     .keep_out = maps::Raster<std::uint8_t>(grid, 0)};
  map.patch(patch);
  ground.elevation.elevation_m = patch.elevation_m;
  const auto check = [&](TraversabilityMap& plain) {
    inEachHeading(grid, [&](Cell c, int k) {
      const float asked = own.added_J_per_m[c];
      ASSERT_GE(costAt(map, c, k), (costAt(plain, c, k) + static_cast<double>(asked)) * (1.0 - 3e-7));
    });
  };
  TraversabilityMap plain = with(ground, {});
  check(plain);
  EXPECT_TRUE(std::isinf(costAt(map, {20, 20}, 0)));
  WheelObservation seen;
  seen.place = grid.centre({8, 8});
  seen.pull = {0.1, 0.05};
  seen.sinkage = {0.3, 0.05};
  for (TraversabilityMap* each : {&map, &plain}) {
    ASSERT_TRUE(each->learn(seen));
    each->publish();
  }
  check(plain);
  const auto cheap = reweighted(*map.published(), {.energy = 1.0, .time_W = 0.0, .risk_J = 0.0});
  const Cell middle{15, 15};
  EXPECT_GE(cheap->cost().costPerMetre(cheap->at(middle), {}), own.added_J_per_m[middle]);
}

// Property: costs stay finite with four classes in patches, whose borders are further kinds of ground.
TEST(AddedCost, ManyClassesAndValuesStayFeasible) {
  std::mt19937 random(13);
  MapLayers ground = hills(80);
  const maps::Grid grid = ground.elevation.grid();
  GroundModel::Parts parts = testGround()->parts();
  for (int number = 3; number <= 4; ++number) {
    parts.classes.push_back(parts.classes.front());
    parts.classes.back().number = number;
    parts.classes.back().soil.friction_angle_rad *= 1.0 - 0.02 * number;
  }
  const auto model = std::make_shared<const GroundModel>(std::move(parts));
  CostLayer own = layer(grid, "own", 0.0F);
  forEachCell(allOf(grid), [&](Cell c) {
    ground.classes[c] = static_cast<std::uint8_t>(1 + (c.column / 10 + c.row / 10) % 4);
    own.added_J_per_m[c] = static_cast<float>(100.0 * uniform(random));
  });
  const TraversabilityMap plain(ground, model, {});
  ground.costs = {own};
  const TraversabilityMap dearer(std::move(ground), model, {});
  inEachHeading(grid, [&](Cell c, int k) {
    const double cost = costAt(dearer, c, k), before = costAt(plain, c, k);
    ASSERT_EQ(std::isfinite(cost), std::isfinite(before));
    ASSERT_GE(cost, (before + static_cast<double>(own.added_J_per_m[c])) * (1.0 - 3e-7));
  });
}

TEST(AddedCost, AddedCostAppliesToOpenedUnseenCells) {
  const MapLayers ground = drawn({"1111111", "1111111", "111?111", "1111111", "1111111"});
  const maps::Grid grid = ground.elevation.grid();
  const TravelPolicy open{.allow_unknown = true};
  const TraversabilityMap plain = with(ground, {}, open),
                          dearer = with(ground, {layer(grid, "own", 10.0F)}, open);
  ASSERT_TRUE(std::isfinite(costAt(plain, {3, 2}, 0)));
  EXPECT_NEAR(costAt(dearer, {3, 2}, 0) - costAt(plain, {3, 2}, 0), 10.0, 1e-3);
}

// Property: evidence of a class has the same effect on cells with and without an added cost.
TEST(AddedCost, ClassEvidenceAppliesUnderALayer) {
  const MapLayers ground = drawn(std::vector<std::string>(90, std::string(90, '1')));
  const maps::Grid grid = ground.elevation.grid();
  TraversabilityMap plain = with(ground, {}), dearer = with(ground, {layer(grid, "own", 10.0F)});
  const Cell far{85, 85};
  const double before = costAt(plain, far, 0);
  for (int k = 0; k < 6; ++k) {
    WheelObservation weak;
    weak.place = grid.centre({10 + 8 * k, 10});
    weak.pull = {0.12, 0.05};
    weak.sinkage = {0.2, 0.05};
    for (TraversabilityMap* map : {&plain, &dearer}) map->learn(weak);
  }
  for (TraversabilityMap* map : {&plain, &dearer}) map->publish();
  ASSERT_GT(costAt(plain, far, 0), before);
  EXPECT_NEAR(costAt(dearer, far, 0) - costAt(plain, far, 0), 10.0, 3e-7 * costAt(plain, far, 0) + 1e-3);
}

TEST(AddedCost, InvalidLayersAreRejectedWithOneLine) {
  const MapLayers ground = drawn({"111", "111"});
  maps::Grid other = ground.elevation.grid();
  other.width = 2;
  const auto refusal = [&](CostLayer wrong) -> std::string {
    try {
      with(ground, {std::move(wrong)});
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "taken";
  };
  const maps::Grid grid = ground.elevation.grid();
  EXPECT_THAT(refusal(layer(other, "own", 1.0F)), HasSubstr("layer 'own' lies on another grid"));
  EXPECT_THAT(refusal(layer(grid, "own", -1.0F)), HasSubstr("must be 0 to 1e6"));
  EXPECT_THAT(refusal(layer(grid, "own", 1e30F)), HasSubstr("must be 0 to 1e6"));
  EXPECT_THAT(refusal({"own", {}, 0.0F}), HasSubstr("another grid"));
  CostLayer doubt = layer(grid, "own", 1.0F);
  doubt.unseen_J_per_m = kNaN;
  EXPECT_THAT(refusal(doubt), HasSubstr("unseen_J_per_m"));
}

const maps::Grid kMap{.width = 40, .height = 30, .resolution_m = 0.5, .south_west = {10.0, 20.0}};

MapLayers flat() {
  MapLayers layers;
  layers.elevation.elevation_m = maps::Raster<float>(kMap, 3.0F);
  layers.classes = maps::Raster<std::uint8_t>(kMap, 1);
  return layers;
}

TraversabilityMap flatMap() {
  return TraversabilityMap(flat(), testGround(), {});
}

// A grid of 4 x 4 cells with its corner at a place.
maps::Grid gridAt(maps::Point south_west) {
  return {.width = 4, .height = 4, .resolution_m = 0.5, .south_west = south_west};
}

SurfacePatch heightsAt(maps::Point south_west, float height_m = 3.1F) {
  SurfacePatch patch;
  patch.elevation_m = maps::Raster<float>(gridAt(south_west), height_m);
  return patch;
}

std::string refusal(TraversabilityMap& map, const SurfacePatch& patch) {
  try {
    map.patch(patch);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "taken";
}

struct Wrong {
  const char* what;
  SurfacePatch patch;
  const char* said;
};

std::vector<Wrong> wrongPatches() {
  const auto with = [](SurfacePatch patch, const auto& change) {
    change(patch);
    return patch;
  };
  return {
      {"off the map", heightsAt({1000.0, 20.0}), "reaches off the map of 40 x 30 cells"},
      {"partly off", heightsAt({28.5, 20.0}), "cut it to the map"},
      {"far off", heightsAt({1e300, 20.0}), "lies off the map"},
      {"nowhere", heightsAt({NAN, 20.0}), "lies off the map"},
      {"between cells", heightsAt({10.2, 20.0}), "between the cells"},
      {"other resolution",
       with(heightsAt({10.0, 20.0}),
            [](SurfacePatch& p) {
              p.elevation_m = maps::Raster<float>(
                  {.width = 4, .height = 4, .resolution_m = 0.25, .south_west = {10, 20}}, 3.0F);
            }),
       "resolution_m = 0.25, must be the map's 0.5"},
      {"resolution NaN",
       with(heightsAt({10.0, 20.0}),
            [](SurfacePatch& p) {
              p.elevation_m = maps::Raster<float>(
                  {.width = 4, .height = 4, .resolution_m = NAN, .south_west = {10, 20}}, 3.0F);
            }),
       "must be the map's 0.5"},
      {"all NaN", heightsAt({12.0, 22.0}, NAN), "nothing was observed"},
      {"no layer", {}, "no layer has a cell"},
      {"1e30",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.elevation_m[{2, 1}] = 1e30F;
            }),
       "elevation_m = 1e+30 at (13.25, 22.75) m, column 2, row 1, must be NaN or within"},
      {"infinite",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.elevation_m[{0, 0}] = INFINITY;
            }),
       "elevation_m = inf at"},
      {"a share of 2",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) { p.rock_abundance = maps::Raster<float>(p.elevation_m.grid(), 2.0F); }),
       "rock_abundance = 2 at (12.25, 22.25) m, column 0, row 0, must be NaN or 0 to 1"},
      {"two grids",
       with(heightsAt({12.0, 22.0}),
            [](SurfacePatch& p) {
              p.keep_out = maps::Raster<std::uint8_t>(gridAt({12.0, 22.5}), 1);
            }),
       "give all layers of a patch on one grid"},
  };
}

TEST(SurfacePatch, InvalidPatchIsRejectedWithOneLineAndMapUnchanged) {
  TraversabilityMap map = flatMap();
  const auto before = map.published();
  for (const Wrong& wrong : wrongPatches()) {
    const std::string said = refusal(map, wrong.patch);
    EXPECT_NE(said.find(wrong.said), std::string::npos) << wrong.what << ": " << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    EXPECT_EQ(map.published(), before) << wrong.what;
    for (const float h : map.elevation().elevation_m.values()) ASSERT_EQ(h, 3.0F) << wrong.what;
  }
}

// Property: a map rejects the layer values that a patch rejects; an invalid height or rock abundance is not
// treated as missing.
TEST(SurfacePatch, MapLayersAreValidatedLikePatches) {
  for (const float bad : {1e30F, INFINITY, -INFINITY}) {
    MapLayers layers = flat();
    layers.elevation.elevation_m[{1, 2}] = bad;
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "column 1, row 2, must be NaN or -131072 to 131072")
        << bad;
  }
  for (const float bad : {-9999.0F, -INFINITY, 2.0F}) {
    MapLayers layers = flat();
    layers.rock_abundance = maps::Raster<float>(layers.elevation.grid(), 0.0F);
    layers.rock_abundance[{1, 2}] = bad;
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "column 1, row 2, must be NaN or 0 to 1")
        << bad;
  }
  for (const double bad : {1e-9, 1e9, static_cast<double>(NAN)}) {
    MapLayers layers;
    const maps::Grid grid{.width = 4, .height = 4, .resolution_m = bad, .south_west = {}};
    layers.elevation.elevation_m = maps::Raster<float>(grid, 0.0F);
    EXPECT_REFUSED(TraversabilityMap(std::move(layers), testGround(), {}), std::invalid_argument,
                   "must be finite, of 0.001 m to 1000 km")
        << bad;
  }
}

TEST(SurfacePatch, ClassPatchRequiresAMapWithClasses) {
  MapLayers layers = flat();
  layers.classes = {};
  TraversabilityMap map(std::move(layers), testGround(), {});
  SurfacePatch patch;
  patch.classes = maps::Raster<std::uint8_t>(gridAt({12.0, 22.0}), 2);
  EXPECT_NE(refusal(map, patch).find("build it with a class raster"), std::string::npos);
}

// Property: a class that a later patch introduces costs as much as on a map built with the class.
TEST(SurfacePatch, NewClassCostsAsOnAMapBuiltWithIt) {
  MapLayers with = flat();
  const SurfacePatch patch = [] {
    SurfacePatch dust;
    dust.classes = maps::Raster<std::uint8_t>(gridAt({14.0, 24.0}), 2);
    return dust;
  }();
  const maps::Cell inside{9, 9};
  for (int row = 8; row < 12; ++row)
    for (int column = 8; column < 12; ++column) with.classes[{column, row}] = 2;
  const TraversabilityMap begun(std::move(with), testGround(), {});
  TraversabilityMap patched = flatMap();
  const auto cost = [&](const TraversabilityMap& map) {
    return map.published()->cost().costPerMetre(map.published()->at(inside), {});
  };
  const float sand = cost(patched);
  patched.patch(patch);
  EXPECT_EQ(cost(patched), cost(begun));
  EXPECT_NE(cost(patched), sand);
  EXPECT_EQ(patched.costs().category(inside), begun.costs().category(inside));
}

// Property: a patch replaces only the tiles within its reach; all other tiles are shared with the previous
// version.
TEST(SurfacePatch, PatchSharesUnaffectedTiles) {
  MapLayers layers;
  const maps::Grid grid{.width = 640, .height = 640, .resolution_m = 0.5, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid, 0.0F);
  TraversabilityMap map(std::move(layers), testGround(), {});
  const auto before = map.published();
  map.patch(heightsAt({176.0, 176.0}, 0.01F));  // in the middle of tile (5, 5)
  const auto after = map.published();
  std::size_t changed = 0;
  for (std::size_t t = 0; t < before->content().tiles.size(); ++t)
    changed += before->content().tiles[t] != after->content().tiles[t];
  EXPECT_EQ(changed, 1U);
}

// Property: a map built without data takes its base elevation from the first patch.
TEST(SurfacePatch, FirstPatchSetsTheBaseElevation) {
  MapLayers layers;
  const maps::Grid grid{.width = 60, .height = 60, .resolution_m = 0.05, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid, NAN);
  TraversabilityMap map(std::move(layers), testGround(), {});
  EXPECT_EQ(map.costs().countCategories().unknown, grid.size());
  SurfacePatch patch;
  patch.elevation_m = maps::Raster<float>(grid, -4500.0F);
  map.patch(patch);
  EXPECT_GT(map.costs().countCategories().safe, 1000U);
  EXPECT_DOUBLE_EQ(map.surface().keys().baseElevation_m(), -4500.0);
  patch.elevation_m = maps::Raster<float>(grid, 4500.0F);
  EXPECT_NE(refusal(map, patch).find("within 1638.35 m of -4500 m"), std::string::npos);
}

// A random observation of ground weaker or stronger than the class, sometimes with immobilisation.
WheelObservation anywhere(std::mt19937_64& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  WheelObservation seen{.time_s = 1.0,
                        .place = {between(10.0, 30.0), between(20.0, 35.0)},
                        .pull = {between(-0.1, 0.4), 0.05},
                        .sinkage = {between(0.0, 0.3), 0.05}};
  seen.shared_std = 0.03;
  seen.trust = static_cast<Trust>(random() % 3);
  seen.pose_std_m = random() % 2 == 0 ? 0.0 : 0.4;
  if (random() % 8 == 0) seen.here.most_pull = between(-0.2, 0.1);
  if (random() % 8 == 0) seen.here.least_sinkage = between(0.5, 1.0);
  return seen;
}

// Property: readings on ground of a known class without heights have, after a patch adds the heights, the
// same effect as on a map built with the heights. The map built without any data is included.
TEST(SurfacePatch, EvidenceFromBeforeThePatchIsRetained) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    std::mt19937_64 random(seed);
    MapLayers whole = flat();
    for (int row = 0; row < kMap.height; ++row)
      for (int column = 0; column < kMap.width; ++column)
        whole.elevation.elevation_m[{column, row}] = 3.0F + 0.05F * static_cast<float>((column * row) % 3);
    MapLayers unseen = whole;
    SurfacePatch rest;
    rest.elevation_m = whole.elevation.elevation_m;
    for (int row = 0; row < kMap.height; ++row)
      for (int column = seed % 3 == 0 ? 0 : 15; column < kMap.width; ++column)
        unseen.elevation.elevation_m[{column, row}] = NAN;
    TraversabilityMap begun(std::move(whole), testGround({.allow_unknown = seed % 2 == 0}), {});
    TraversabilityMap patched(std::move(unseen), testGround({.allow_unknown = seed % 2 == 0}), {});
    for (int i = 0; i < 60; ++i) {
      const WheelObservation seen = anywhere(random);
      EXPECT_TRUE(begun.learn(seen));
      EXPECT_TRUE(patched.learn(seen));
      if (i % 20 == 0) patched.publish();
    }
    begun.publish();
    patched.publish();
    patched.patch(rest);
    for (int row = 0; row < kMap.height; ++row)
      for (int column = 0; column < kMap.width; ++column) {
        const maps::Cell cell{column, row};
        const GroundBelief now = *patched.ground(cell), expected = *begun.ground(cell);
        ASSERT_EQ(now.pull.value, expected.pull.value) << seed;
        ASSERT_EQ(now.sinkage.value, expected.sinkage.value) << seed;
        ASSERT_EQ(patched.costs().category(cell), begun.costs().category(cell)) << seed;
        const auto a = patched.published(), b = begun.published();
        for (const Direction heading : {Direction{1.0, 0.0}, {0.6, -0.8}, {0.0, 1.0}})
          ASSERT_EQ(a->cost().costPerMetre(a->at(cell), heading),
                    b->cost().costPerMetre(b->at(cell), heading))
              << seed << ' ' << column << ' ' << row;
      }
  }
}

// Property: with two threads each patch is applied completely, or rejected because the other thread changes
// the map. After all patches are applied the map equals that of one thread.
TEST(SurfacePatch, ConcurrentPatchesAreAtomic) {
  TraversabilityMap map = flatMap();
  const auto keepPatching = [&](double x_m) {
    for (int k = 0; k < 40;) try {
        map.patch(heightsAt({x_m, 20.0 + 0.5 * (k % 20)}, 3.0F + 0.001F * static_cast<float>(k)));
        ++k;
      } catch (const std::logic_error& error) {
        if (dynamic_cast<const std::invalid_argument*>(&error) != nullptr ||
            std::string(error.what()).find("let one thread change it") == std::string::npos)
          ADD_FAILURE() << error.what();
      }
  };
  {
    std::jthread west([&] { keepPatching(10.0); }), east([&] { keepPatching(22.0); });
  }
  TraversabilityMap one = flatMap();
  for (const double x_m : {10.0, 22.0})
    for (int k = 0; k < 40; ++k)
      one.patch(heightsAt({x_m, 20.0 + 0.5 * (k % 20)}, 3.0F + 0.001F * static_cast<float>(k)));
  EXPECT_EQ(map.published()->version(), 81U);
  for (int row = 0; row < kMap.height; ++row)
    for (int column = 0; column < kMap.width; ++column)
      ASSERT_EQ(map.published()->at({column, row}), one.published()->at({column, row}))
          << column << ' ' << row;
}

}  // namespace surface_patch_test

}  // namespace talus::costmap
