#include <cmath>
#include <limits>
#include <memory>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/ground/ground_model.hpp>
#include <talus/terramech/mobility/turning.hpp>

namespace talus::costmap {
namespace travel_cost_test {

// A curve whose cost in each bin is the number of the bin, so that a cost identifies the bin.
TravelCurve numbered() {
  TravelCurve curve{};
  for (int bin = 0; bin < TravelCurve::kBins; ++bin)
    curve.cost_J_per_m[static_cast<std::size_t>(bin)] = static_cast<float>(bin);
  return curve;
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
  auto rows = std::make_shared<std::vector<float>>();
  for (int i = 0; i < kRows * TravelCurve::kBins; ++i)
    rows->push_back(random() % 20 == 0 ? std::numeric_limits<float>::infinity()
                                       : static_cast<float>(random() % 1000));
  TravelCurve curve = numbered();
  curve.crossing = rows;
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
        want += weight *
                static_cast<double>(
                    (*rows)[static_cast<std::size_t>(row * TravelCurve::kBins + static_cast<int>(x) + dx)]);
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
                        std::vector<TravelCurve>(1));
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
  EXPECT_NO_THROW(TravelCost({}, std::vector<TravelCurve>(254)));
  EXPECT_THROW(TravelCost({}, std::vector<TravelCurve>(65535)), std::invalid_argument);
}

}  // namespace travel_cost_test
}  // namespace talus::costmap
