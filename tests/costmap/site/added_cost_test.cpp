#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include <gmock/gmock.h>
#include <site_map.hpp>

#include <talus/costmap/cost/cost_weights.hpp>
#include <talus/costmap/map/explanation.hpp>
#include <talus/costmap/site/added_cost.hpp>
#include <talus/costmap/surface/cell_boxes.hpp>

namespace talus::costmap {
namespace added_cost_test {

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

}  // namespace added_cost_test
}  // namespace talus::costmap
