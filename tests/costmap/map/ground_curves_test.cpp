#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <site_map.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/costmap/map/ground_curves.hpp>

namespace talus::costmap {

namespace ground_curves_test {

// Property: cached results equal those of the map for any order of requests over cells of several classes.
TEST(PlaceBeliefs, CachedBeliefsEqualTheMap) {
  std::vector<std::string> rows(40, std::string(20, '1') + std::string(20, '2'));
  rows[5][5] = '?';
  rows[6][6] = '#';
  TraversabilityMap map = mapOf(rows);
  for (const double x_m : {110.5, 130.5})
    map.learn({.time_s = 1.0, .place = {x_m, 220.5}, .pull = {0.05, 0.05}, .sinkage = {0.6, 0.05}});
  map.publish();
  PlaceBeliefs beliefs(map);
  for (int row = 39; row >= 0; --row)
    for (int column = 0; column < 40; ++column) {
      const maps::Cell cell{column, row};
      ASSERT_EQ(beliefs.at(cell), map.belief(cell)) << column << ' ' << row;
      const auto one = beliefs.ground(cell), other = map.ground(cell);
      ASSERT_EQ(one.has_value(), other.has_value());
      if (one) {
        ASSERT_EQ(one->pull.value, other->pull.value);
      }
    }
  EXPECT_LT(beliefs.ground({10, 20})->pull.value, beliefs.ground({0, 0})->pull.value);
}

using terramech::Category;

constexpr int kSide = 24;

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Patches of sand and dust, obstacles, unseen cells and keep-out polygons on undulating ground.
MapLayers anySite(std::mt19937_64& random) {
  std::vector<std::string> rows(kSide, std::string(kSide, '1'));
  for (int patch = 0; patch < 4; ++patch) {
    const char what = "2223?#"[random() % 6];
    const std::size_t size = what == '2' ? 6 : 2;
    const std::size_t row = random() % (kSide - size), column = random() % (kSide - size);
    for (std::size_t r = row; r < row + size; ++r) rows[r].replace(column, size, size, what);
  }
  MapLayers layers = drawn(rows);
  const double height = uniform(random, 0.0, 1.5), phase = uniform(random, 0.0, 6.0);
  for (int row = 0; row < kSide; ++row)
    for (int column = 0; column < kSide; ++column)
      layers.elevation.elevation_m[{column, row}] +=
          static_cast<float>(height * std::sin(0.4 * column + phase) * std::cos(0.3 * row));
  return layers;
}

// A short drive with readings of ground that is weaker or stronger than estimated.
void learnSomething(TraversabilityMap& map, std::mt19937_64& random, int readings) {
  maps::Point at{100.0 + uniform(random, 2.0, kSide - 2.0), 200.0 + uniform(random, 2.0, kSide - 2.0)};
  for (int i = 0; i < readings; ++i) {
    at = {at.x_m + uniform(random, -1.0, 1.0), at.y_m + uniform(random, -1.0, 1.0)};
    map.learn({.time_s = 1.0 * i,
               .place = at,
               .pull = {uniform(random, -0.3, 0.4), 0.03},
               .sinkage = {uniform(random, 0.05, 0.9), 0.05}});
  }
}

Direction heading(int step) {
  const double angle = step * 2.0 * std::numbers::pi / 16.0;
  return {std::cos(angle), std::sin(angle)};
}

bool equal(const TravelState& a, const TravelState& b) {
  return a.energy_J_per_m == b.energy_J_per_m && a.time_s_per_m == b.time_s_per_m &&
         a.risk_per_m == b.risk_per_m && a.refusal == b.refusal && a.category == b.category;
}

// A model with sand as class 1, dust as class 2, and further classes without cells up to `classes` in all.
std::shared_ptr<const GroundModel> declaring(int classes) {
  GroundModel::Parts parts = testGround()->parts();
  for (int number = 3; number <= classes; ++number)
    parts.classes.push_back({.number = number, .soil = testSand()});
  return std::make_shared<GroundModel>(std::move(parts));
}

// Property: declared classes without cells do not change the costs of a map, before and after evidence is
// added; such classes use no curve numbers.
TEST(GroundCurves, UnusedClassesDoNotAffectCosts) {
  const std::vector<std::string> rows{"1122112211", "1111222211", "1212121211", "1111111111", "2222111122"};
  TraversabilityMap few(drawn(rows, 0.1), declaring(2), {}), many(drawn(rows, 0.1), declaring(250), {});
  const auto same = [&] {
    const auto a = few.published(), b = many.published();
    int different = 0;
    for (int row = 0; row < a->grid().height; ++row)
      for (int column = 0; column < a->grid().width; ++column)
        for (const Direction heading : {Direction{1.0, 0.0}, Direction{-1.0, 0.0}, Direction{0.0, 1.0}})
          different += a->cost().costPerMetre(a->at({column, row}), heading) !=
                       b->cost().costPerMetre(b->at({column, row}), heading);
    return different == 0;
  };
  EXPECT_TRUE(same());
  for (int k = 0; k < 40; ++k) {
    WheelObservation observation;
    observation.place = {100.5 + 0.25 * k, 202.5};
    observation.pull = {0.02 + 0.004 * k, 0.03};
    observation.sinkage = {0.2, 0.05};
    EXPECT_EQ(few.learn(observation), many.learn(observation));
  }
  few.publish();
  many.publish();
  EXPECT_TRUE(same());
}

// Property: a heading that explain() rates dangerous or unknown has infinite cost; an allowed heading has
// finite cost, equal to that of the detailed state.
TEST(GroundCurves, DangerousAndUnknownHeadingsHaveInfiniteCost) {
  std::mt19937_64 random(22);
  int dangerous = 0, allowed = 0;
  for (int trial = 0; trial < 4; ++trial) {
    TraversabilityMap map(anySite(random), testGround(), {});
    learnSomething(map, random, 12);
    map.publish();
    const auto grid = map.published();
    for (int row = 0; row < kSide; row += 2)
      for (int column = 0; column < kSide; ++column) {
        const maps::Cell cell{column, row};
        for (int k = 0; k < 16; k += 5) {
          const Explanation told = explain(map, cell, heading(k));
          const bool finite = std::isfinite(grid->cost().costPerMetre(grid->at(cell), heading(k)));
          EXPECT_EQ(finite, grid->cost().detail(grid->at(cell), heading(k)).refusal == Refusal::None);
          if (told.category == Category::Dangerous || told.category == Category::Unknown) {
            EXPECT_FALSE(finite) << column << ' ' << row << ' ' << told.verdict;
            ++dangerous;
          }
          allowed += finite;
        }
      }
  }
  EXPECT_GT(dangerous, 100);
  EXPECT_GT(allowed, 100);
}

// Property: an additional hazard of any kind never lowers a cost.
TEST(GroundCurves, AddedHazardNeverLowersACost) {
  std::mt19937_64 random(23);
  for (int trial = 0; trial < 10; ++trial) {
    const MapLayers without = anySite(random);
    MapLayers with = without;
    const maps::Cell place{static_cast<int>(random() % kSide), static_cast<int>(random() % kSide)};
    with.declared = maps::Raster<Hazard>(with.elevation.grid(), Hazard::None);
    if (trial % 2 == 0)
      with.keep_out[place] = 1;
    else
      with.declared[place] = Hazard::Rocks;
    const TraversabilityMap before(without, testGround(), {}), after(with, testGround(), {});
    for (int row = 0; row < kSide; ++row)
      for (int column = 0; column < kSide; ++column)
        for (int k = 0; k < 16; ++k) {
          const maps::Cell cell{column, row};
          EXPECT_GE(after.published()->cost().costPerMetre(after.published()->at(cell), heading(k)),
                    before.published()->cost().costPerMetre(before.published()->at(cell), heading(k)))
              << trial << ' ' << column << ' ' << row;
        }
  }
}

// Property: cells of a straight path beside weak ground have the mean of the wheels on both.
TEST(GroundCurves, CellsNextToWeakGroundUseTheWheelMean) {
  std::vector<std::string> rows(kSide, std::string(kSide, '1'));
  for (std::string& row : rows) row.replace(12, 6, 6, '2');
  const TraversabilityMap map = mapOf(rows);
  const GroundBelief sand = *map.costs().ground({5, 12}), dust = *map.costs().ground({15, 12});
  const GroundBelief beside = *map.costs().ground({11, 12});
  // Closed form: two or three of four wheels stand on the weaker ground; the result is rounded down to a
  // step of 0.005.
  EXPECT_LE(beside.pull.value, 0.5 * (sand.pull.value + dust.pull.value));
  EXPECT_GT(beside.pull.value, 0.25 * sand.pull.value + 0.75 * dust.pull.value - 0.0051);
  EXPECT_EQ(map.costs().ground({9, 12})->pull.value, sand.pull.value) << "out of reach";
  EXPECT_GT(map.published()->cost().detail(map.published()->at({11, 12}), {0, 1}).risk_per_m,
            map.published()->cost().detail(map.published()->at({5, 12}), {0, 1}).risk_per_m);
}

// Property: a map of more estimates than curves of one byte blocks no cell, and no cost is below that of the
// estimate.
TEST(GroundCurves, ManyEstimatesHaveTheirOwnCurves) {
  std::mt19937_64 random(25);
  TraversabilityMap map(drawn(std::vector<std::string>(80, std::string(80, '1'))), testGround(), {});
  for (int row = 0; row < 80; row += 2)
    for (int column = 0; column < 80; column += 2)
      map.learn({.time_s = 1.0,
                 .place = map.grid().centre({column, row}),
                 .pull = {uniform(random, -0.5, 0.6), 0.03},
                 .sinkage = {uniform(random, 0.05, 2.0), 0.05}});
  map.publish();
  int blocked = 0, cheaper = 0;  // the edge of the map is blocked and not counted
  for (int row = 1; row < 79; ++row)
    for (int column = 1; column < 79; ++column) {
      const CellCode code = map.published()->at({column, row});
      blocked += code.curve() >= CellCode::kUnknown;
      const auto exact =
          static_cast<double>(map.model().ground(0, *map.ground({column, row})).curve.price(0.0, 0.0));
      cheaper +=
          static_cast<double>(map.published()->cost().costPerMetre(code, {1, 0})) < (1.0 - 1e-6) * exact;
    }
  EXPECT_EQ(blocked, 0);
  EXPECT_EQ(cheaper, 0);
}

// Property: a cell is unknown if a wheel of a long rover may stand on a cell without a class, two cells away.
TEST(GroundCurves, UnclassifiedCellUnderAWheelIsUnknown) {
  terramech::Rover rover = testRover();
  rover.wheelbase_m = 3.0;
  MapLayers layers = drawn(std::vector<std::string>(kSide, std::string(kSide, '2')));
  layers.classes[{12, 12}] = 255;
  const auto mapUnder = [&](bool allow_unknown) {
    return TraversabilityMap(layers,
                             std::make_shared<GroundModel>(
                                 GroundModel::Parts{.rover = rover,
                                                    .classes = {GroundClass{.number = 1, .soil = testDust()},
                                                                GroundClass{.number = 2, .soil = testSand()}},
                                                    .policy = {.allow_unknown = allow_unknown}}),
                             {});
  };
  const TraversabilityMap closed = mapUnder(false), open = mapUnder(true);
  ASSERT_EQ(closed.surface().hazards({14, 12}), Hazard::None);
  EXPECT_EQ(closed.published()->at({14, 12}).curve(), CellCode::kUnknown);
  EXPECT_NE(explain(closed, {14, 12}, std::nullopt).verdict.find("without a soil class"), std::string::npos);
  EXPECT_LT(open.costs().ground({14, 12})->pull.value, open.costs().ground({18, 12})->pull.value - 0.02)
      << "as ground of the first class";
  EXPECT_LT(closed.published()->at({18, 12}).curve(), CellCode::kUnknown);
}

}  // namespace ground_curves_test

}  // namespace talus::costmap
