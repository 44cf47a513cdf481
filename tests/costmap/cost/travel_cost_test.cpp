#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <refused.hpp>
#include <site_fixture.hpp>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/cost/learned_cells.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/maps/maps.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::costmap {
namespace travel_cost_test {

// A curve whose cost in each bin is the number of the bin, so that a cost identifies the bin.
TravelCurve numbered() {
  std::vector<float> costs;
  for (int bin = 0; bin < TravelCurve::kBins; ++bin) costs.push_back(static_cast<float>(bin));
  return TravelCurve(std::move(costs));
}

CostGrid plain(int side) {
  const maps::Grid grid{.width = side, .height = side, .resolution_m = 1.0, .south_west = {}};
  return flattened(maps::Raster<CellCode>(grid, CellCode({.curve = 0})),
                   std::make_shared<TravelCost>(TravelCost::Limits{}, std::vector{numbered()}));
}

TEST(CostGrid, RevisionChangesOnlyItsRange) {
  const CostGrid before = plain(200);
  const maps::CellBox range{{60, 60}, {70, 66}};
  const CostGrid after =
      revised(before, {.ranges = {range},
                       .code = [](maps::Cell, CellCode code) { return code.withCurve(CellCode::kBlocked); },
                       .cost = [&] { return before.content().cost; }});
  EXPECT_EQ(after.version(), before.version() + 1);
  for (int row = 0; row < 200; ++row)
    for (int column = 0; column < 200; ++column) {
      const bool inside = column >= 60 && column <= 70 && row >= 60 && row <= 66;
      ASSERT_EQ(after.at({column, row}).curve(), inside ? CellCode::kBlocked : 0) << column << ' ' << row;
      ASSERT_EQ(before.at({column, row}).curve(), 0);
    }
}

TEST(CostGrid, ElevationMatchesTheSourceRaster) {
  maps::Raster<float> heights(plain(150).grid());
  for (int row = 0; row < 150; ++row)
    for (int column = 0; column < 150; ++column)
      heights[{column, row}] = static_cast<float>((7 * column + 3 * row) % 11);
  CostGrid::Content content = plain(150).content();
  EXPECT_FALSE(CostGrid(content).elevation_m({1.0, 1.0})) << "not known";
  content.elevation_m = tiled(heights);
  const CostGrid grid(content);
  for (const maps::Point p :
       {maps::Point{0.1, 0.1}, {63.9, 64.2}, {64.0, 127.7}, {149.9, 149.9}, {31.4, 15.9}})
    EXPECT_EQ(grid.elevation_m(p), maps::elevationAt(heights, p)) << p.x_m << ' ' << p.y_m;
  EXPECT_FALSE(grid.elevation_m({150.5, 1.0}));
  content.elevation_m = HeightTable(1, grid.content().elevation_m[0]);
  EXPECT_THROW(CostGrid{content}, std::invalid_argument);
}

// Property: after any sequence of shared tiles is set in several tables, each table equals a plain list.
TEST(TileTable, CopiesAreIndependent) {
  const auto tileOf = [](std::uint8_t curve) {
    auto tile = std::make_shared<CostTile>();
    tile->cells.fill(CellCode({.curve = curve}));
    return TileTable::Shared(std::move(tile));
  };
  std::vector<std::vector<TileTable::Shared>> plain{std::vector<TileTable::Shared>(150, tileOf(0))};
  std::vector<TileTable> tables{TileTable(plain[0])};
  std::mt19937 random(5);
  for (int i = 0; i < 60; ++i) {
    const std::size_t from = random() % tables.size(), at = random() % 150;
    TileTable next = tables[from];
    std::vector<TileTable::Shared> same = plain[from];
    same[at] = tileOf(static_cast<std::uint8_t>(i + 1));
    next.set(at, same[at]);
    tables.push_back(std::move(next));
    plain.push_back(std::move(same));
  }
  for (std::size_t t = 0; t < tables.size(); ++t) {
    ASSERT_EQ(tables[t].size(), 150U);
    for (std::size_t i = 0; i < 150; ++i) {
      ASSERT_EQ(tables[t][i], plain[t][i]);
      ASSERT_EQ(&tables[t].tile(i), plain[t][i].get());
    }
  }
}

CostGrid oneGround(double doubt = 1.0) {
  const auto model = testGround();
  const maps::Grid grid{.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}};
  GroundBelief belief = model->prior(0);
  belief.pull.std *= doubt;
  return flattened(
      maps::Raster<CellCode>(grid, CellCode({.curve = 0})),
      std::make_shared<TravelCost>(model->limits(), std::vector<GroundCost>{model->ground(0, belief)}));
}

TEST(CostWeights, CostIsTheWeightedSumOfEnergyTimeAndRisk) {
  const CostGrid map = oneGround(0.0);  // without failed attempts, which the cost includes
  const auto other = reweighted(map, {.energy = 2.0, .time_W = 3.0, .risk_J = 5e6});
  for (const double gradient : {-0.1, 0.0, 0.05}) {
    const CellCode cell({gradient, 0.0, 0});
    const TravelState state = map.cost().detail(cell, {1.0, 0.0});
    ASSERT_EQ(state.refusal, Refusal::None);
    const double expected = 2.0 * static_cast<double>(state.energy_J_per_m) +
                            3.0 * static_cast<double>(state.time_s_per_m) +
                            5e6 * static_cast<double>(state.risk_per_m);
    // Closed form. Tolerance: the table stores floats.
    EXPECT_NEAR(other->cost().costPerMetre(cell, {1.0, 0.0}), expected, 1e-6 * expected);
  }
}

TEST(CostWeights, ReweightingKeepsInfeasibilityAndSharesTiles) {
  const CostGrid map = oneGround();
  const auto other = reweighted(map, {.energy = 0.0, .time_W = 0.0, .risk_J = 0.0});
  for (double gradient = -0.9; gradient < 0.9; gradient += 0.01) {
    const CellCode cell({gradient, 0.0, 0});
    EXPECT_EQ(std::isinf(other->cost().costPerMetre(cell, {1.0, 0.0})),
              std::isinf(map.cost().costPerMetre(cell, {1.0, 0.0})));
  }
  EXPECT_EQ(other->content().tiles[0], map.content().tiles[0]);
}

TEST(CostWeights, NegativeWeightsAndMapsWithoutStatesAreRejected) {
  EXPECT_REFUSED(reweighted(oneGround(), {.energy = -1.0}), std::invalid_argument,
                 "energy, time_W and risk_J must be >= 0");
  EXPECT_REFUSED(reweighted(oneGround(), {.risk_J = std::nan("")}), std::invalid_argument,
                 "energy, time_W and risk_J must be >= 0");
  const maps::Grid grid{.width = 4, .height = 4, .resolution_m = 1.0, .south_west = {}};
  const CostGrid bare =
      flattened(maps::Raster<CellCode>(grid),
                std::make_shared<TravelCost>(TravelCost::Limits{}, std::vector{numbered()}));
  EXPECT_REFUSED(reweighted(bare, {}), std::domain_error, "holds no energy, time and risk to weigh");
}

TEST(LearnedCells, CellsAreStoredAndChangesReported) {
  LearnedCells cells({.width = 200, .height = 100, .resolution_m = 1.0, .south_west = {}});
  EXPECT_EQ((cells[{199, 99}]), 0U);
  EXPECT_FALSE(cells.set({70, 5}, 0)) << "it was that before";
  EXPECT_TRUE(cells.boxes().empty());
  EXPECT_TRUE(cells.set({70, 5}, 7));
  EXPECT_FALSE(cells.set({70, 5}, 7));
  EXPECT_TRUE(cells.set({75, 9}, 8));
  EXPECT_EQ((cells[{70, 5}]), 7U);
  EXPECT_EQ((cells[{71, 5}]), 0U);
  ASSERT_EQ(cells.boxes().size(), 1U);
  EXPECT_EQ(cells.boxes()[0].first, (maps::Cell{70, 5}));
  EXPECT_EQ(cells.boxes()[0].last, (maps::Cell{75, 9}));
}

Direction towards(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}

TEST(CellCode, GradientsAreRoundedToHalfAStepAndClamped) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> gradient(-1.999, 1.999);
  for (int i = 0; i < 1000; ++i) {
    const double x = gradient(random), y = gradient(random);
    const auto curve = static_cast<std::uint8_t>(random());
    const CellCode code({x, y, curve});
    EXPECT_NEAR(code.dzDx(), x, 0.5 * CellCode::kStep);
    EXPECT_NEAR(code.dzDy(), y, 0.5 * CellCode::kStep);
    EXPECT_EQ(code.curve(), curve);
    EXPECT_EQ(code.withCurve(7).stepsX(), code.stepsX());
    EXPECT_EQ(code.withCurve(7).curve(), 7);
  }
  EXPECT_EQ(CellCode({50.0, -50.0, 0}).dzDx(), 2.0 - CellCode::kStep);
  EXPECT_EQ(CellCode({50.0, -50.0, 0}).dzDy(), -2.0);
}

// Closed form, by brute force: bilinear in the four nodes around a gradient, in double precision; infinite
// if a node with a weight above zero is refused.
TEST(TravelCost, CostIsBilinearAndInfiniteIfOneNodeIsInfeasible) {
  std::mt19937 random(7);
  constexpr int kRows = 30;
  std::vector<float> rows;
  for (int i = 0; i < kRows * TravelCurve::kBins; ++i)
    rows.push_back(random() % 20 == 0 ? std::numeric_limits<float>::infinity()
                                      : static_cast<float>(random() % 1000));
  const TravelCurve curve(rows);
  std::uniform_real_distribution<double> gradient(-0.9, 0.9);
  int refused = 0, allowed = 0;
  for (int i = 0; i < 20000; ++i) {
    const double snap = i % 3 == 0 ? 256.0 : 1e6;  // every third gradient lies on a node
    const double along = std::round(gradient(random) * snap) / snap,
                 across = std::round(gradient(random) * snap) / snap;
    const double x = along * 256.0 + 256.0, y = std::abs(across) * 64.0;
    double want = 0.0;
    for (const int dx : {0, 1})
      for (const int dy : {0, 1}) {
        const double fx = x - std::floor(x), fy = y - std::floor(y);
        const double weight = (dx == 1 ? fx : 1.0 - fx) * (dy == 1 ? fy : 1.0 - fy);
        if (weight <= 0.0) continue;
        const int row = std::min(static_cast<int>(std::floor(y)) + dy, kRows - 1);
        want +=
            weight * static_cast<double>(
                         rows[static_cast<std::size_t>(row * TravelCurve::kBins + static_cast<int>(x) + dx)]);
      }
    const float price = curve.price(along, across);
    ASSERT_EQ(std::isinf(price), std::isinf(want)) << along << ' ' << across;
    ++(std::isinf(want) ? refused : allowed);
    if (std::isfinite(want)) {
      ASSERT_NEAR(static_cast<double>(price), want, 1e-3);
    }
  }
  EXPECT_GT(refused, 2000);
  EXPECT_GT(allowed, 8000);
  EXPECT_TRUE(std::isinf(curve.price(1.0, 0.0)));
  EXPECT_TRUE(std::isinf(curve.price(-1.001, 0.0)));
}

TEST(TravelCost, UnknownAndBlockedCellsAreInfeasibleInEveryHeading) {
  const TravelCost cost({}, std::vector<TravelCurve>{numbered()});
  for (double heading = -3.0; heading < 3.2; heading += 0.4)
    for (const CellCode::Curve curve : {CellCode::Curve{1}, CellCode::kUnknown, CellCode::kBlocked}) {
      EXPECT_TRUE(std::isinf(cost.costPerMetre(CellCode({0.0, 0.0, curve}), towards(heading))));
      EXPECT_EQ(cost.detail(CellCode({0.0, 0.0, curve}), towards(heading)).refusal,
                curve == CellCode::kBlocked ? Refusal::Blocked : Refusal::Unknown);
    }
}

TEST(TravelCost, InfeasibilityNamesTheExceededLimit) {
  const auto model = testGround();
  const TravelCost cost({.max_along = 0.3, .max_across = 0.2},
                        std::vector<GroundCost>{model->ground(0, model->prior(0))});
  EXPECT_EQ(cost.detail(CellCode({0.4, 0.0, 0}), {1.0, 0.0}).refusal, Refusal::Pitch);
  EXPECT_EQ(cost.detail(CellCode({-0.4, 0.0, 0}), {1.0, 0.0}).refusal, Refusal::Pitch);
  EXPECT_EQ(cost.detail(CellCode({0.0, 0.25, 0}), {1.0, 0.0}).refusal, Refusal::Roll);
  EXPECT_EQ(cost.detail(CellCode({0.0, -0.25, 0}), {1.0, 0.0}).refusal, Refusal::Roll);
}

// Closed form: the projection of the centre of mass onto the plane in three dimensions, against the
// rectangle of the wheels.
TEST(TravelCost, TipsIfTheCentreOfMassProjectsOutsideTheWheels) {
  terramech::Rover rover = testRover();
  rover.wheelbase_m = 0.8;
  rover.track_m = 1.1;
  rover.centre_of_mass_height_m = 0.9;
  const TravelCost cost({.stance = std::make_shared<const terramech::RoverStance>(rover)},
                        std::vector{numbered()});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> gradient(-0.9, 0.9), angle(-3.2, 3.2);
  int tipped = 0;
  for (int i = 0; i < 3000; ++i) {
    const CellCode cell({gradient(random), gradient(random), 0});
    const Direction heading = towards(angle(random));
    const double size = std::sqrt(1.0 + cell.dzDx() * cell.dzDx() + cell.dzDy() * cell.dzDy());
    const double rise = cell.dzDx() * heading.x + cell.dzDy() * heading.y, run = std::hypot(1.0, rise);
    const double ahead_z = rise / run;  // z of the unit vector `ahead` on the plane; left = normal x ahead
    const double left_z = (-cell.dzDx() * heading.y + cell.dzDy() * heading.x) / (size * run);
    const double plumb = rover.centre_of_mass_height_m * size;
    const double off = std::max(plumb * std::abs(ahead_z) - 0.5 * rover.wheelbase_m,
                                plumb * std::abs(left_z) - 0.5 * rover.track_m);
    if (std::abs(off) < 1e-9) continue;
    ASSERT_EQ(cost.tips(cell, heading), off > 0.0) << off;
    tipped += off > 0.0 ? 1 : 0;
  }
  EXPECT_GT(tipped, 500);
  EXPECT_LT(tipped, 2500);
}

TEST(TravelCost, CurveCountIsLimitedByTheCellCode) {
  EXPECT_NO_THROW(TravelCost({}, std::vector(254, numbered())));
  EXPECT_THROW(TravelCost({}, std::vector(65535, numbered())), std::invalid_argument);
}

}  // namespace travel_cost_test
}  // namespace talus::costmap
