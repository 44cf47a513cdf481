// Planned risk against Monte-Carlo simulation: rovers drive over ground with spatially correlated pull,
// drawn from the uncertainty that the planner uses.
#include <cmath>
#include <map>
#include <random>
#include <utility>

#include <Eigen/Cholesky>

#include <talus/costmap/ground/ground_model.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/terramech/mobility/slope_equilibrium.hpp>

#include "site_fixture.hpp"

namespace talus::planner {
namespace risk_worlds_test {

constexpr double kCorrelation_m = 5.0;

// Undulating ground with gradients up to two to three standard deviations below the largest pull of the
// soil. Entrapment is certain on ground that is too weak.
struct RiskyGround {
  std::shared_ptr<const costmap::CostGrid> map;
  std::shared_ptr<const terramech::SlopeEquilibrium> rover;
  double thrust = 0.0;    // gross thrust over load at the reference slip
  double pull_std = 0.0;  // standard deviation of place and class together
  double shared = 0.0;    // share of the class in the variance
};

RiskyGround riskyGround(double steepest) {
  costmap::GroundModel::Parts parts;
  parts.rover = costmap::testRover();
  parts.classes = {{.number = 0, .soil = costmap::testSand(), .pull_std = 0.05, .mean_std = 0.03}};
  parts.policy.entrapment = 1.0;
  parts.policy.correlation_length_m = kCorrelation_m;
  parts.policy.allow_dangerous = true;
  parts.policy.risk_weight_J = 0.0;
  const costmap::GroundModel model(parts);
  RiskyGround ground;
  ground.rover = std::make_shared<const terramech::SlopeEquilibrium>(
      terramech::SlopeEquilibrium(parts.classes[0].soil, parts.rover).withoutRuts());
  ground.thrust = model.reference(0, false).torque_over_load_radius;
  ground.pull_std = model.prior(0).pull.std;
  ground.shared = std::pow(parts.classes[0].mean_std / ground.pull_std, 2);
  double most_pull = 0.0;  // steepest climb on ground of the class
  while (ground.rover->leastStrength({most_pull + 0.002, 0.0}) < 1.0) most_pull += 0.002;
  maps::Raster<costmap::CellCode> cells({.width = 60, .height = 40, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 60; ++column) {
      const double swell = 0.5 + 0.5 * std::sin(0.5 * column) * std::cos(0.2 * row);
      // Steep in the south, gentle in the north, so that the cheapest route is not the safest.
      const double share = swell * (1.0 - 0.4 * row / 40.0);
      cells[{column, row}] =
          costmap::CellCode({.dz_dx = (most_pull - steepest * ground.pull_std) * share, .curve = 0});
    }
  const costmap::TravelCost::Limits limits{.max_along = 0.9, .max_across = 0.9};
  ground.map = std::make_shared<costmap::CostGrid>(costmap::flattened(
      cells, std::make_shared<costmap::TravelCost>(
                 limits, std::vector{model.ground(0, model.prior(0))},
                 costmap::SoilUncertainty{
                     .correlation_length_m = kCorrelation_m, .entrapment = 1.0, .shared = {ground.shared}})));
  return ground;
}

// Number of standard deviations by which a place may be weaker than the class before a slope fails; rows and
// bins as in the cost table.
double deviationsToLose(const RiskyGround& ground, double along, double across) {
  const double least = ground.rover->leastStrength(
      {std::round(along * 256) / 256.0, std::ceil(std::abs(across) * 64 - 1e-9) / 64.0}, 1.0);
  return (1.0 - least) * ground.thrust / ground.pull_std;
}

// Share of worlds in which the pull of some cell of the route is below the gradient. Each cell has one pull.
// The departure of the class is common to all cells; the remaining departures are correlated exponentially
// with the distance of the cell centres.
double stuckShare(const RiskyGround& ground, const std::vector<maps::Point>& route, int worlds) {
  const maps::Grid& grid = ground.map->grid();
  std::map<std::size_t, double> least;  // reserve of each cell entered, in deviations
  const auto points = subdivided(route, 0.02);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const maps::Point a = points[i - 1], b = points[i];
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, metres = std::hypot(dx, dy);
    if (!(metres > 0.0)) continue;
    const maps::Cell cell = *grid.cellAt({a.x_m + dx / 2, a.y_m + dy / 2});
    const auto code = ground.map->at(cell);
    const double gradient = (code.dzDx() * dx + code.dzDy() * dy) / metres;
    const double across = std::abs(code.dzDy() * dx - code.dzDx() * dy) / metres;
    const double reserve = deviationsToLose(ground, gradient, across);
    const auto [entry, fresh] = least.try_emplace(grid.index(cell), reserve);
    if (!fresh) entry->second = std::min(entry->second, reserve);
  }
  std::vector<maps::Point> middles;
  std::vector<double> reserve;
  for (const auto& [index, value] : least) {
    const int at = static_cast<int>(index);
    middles.push_back(grid.centre({at % grid.width, at / grid.width}));
    reserve.push_back(value);
  }
  const auto n = static_cast<Eigen::Index>(middles.size());
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const maps::Point a = middles[static_cast<std::size_t>(i)], b = middles[static_cast<std::size_t>(j)];
      covariance(i, j) = std::exp(-std::hypot(a.x_m - b.x_m, a.y_m - b.y_m) / kCorrelation_m);
    }
  const Eigen::MatrixXd root = covariance.llt().matrixL();
  std::mt19937_64 random(7);
  std::normal_distribution<double> gauss;
  int stuck = 0;
  Eigen::VectorXd white(n);
  for (int world = 0; world < worlds; ++world) {
    for (Eigen::Index i = 0; i < n; ++i) white(i) = gauss(random);
    const Eigen::VectorXd place = root * white;
    const Eigen::VectorXd u =
        (std::sqrt(1.0 - ground.shared) * place).array() + std::sqrt(ground.shared) * gauss(random);
    bool fails = false;
    for (Eigen::Index i = 0; i < n && !fails; ++i) fails = reserve[static_cast<std::size_t>(i)] + u(i) < 0.0;
    stuck += fails;
  }
  return static_cast<double>(stuck) / worlds;
}

Problem acrossSwells(const RiskyGround& ground) {
  return {.map = ground.map, .start = {2.5, 4.5}, .goal = {57.5, 6.5}, .prove = false};
}

// Half the width of the 99.9 % interval of a share estimated from `worlds` worlds.
double spread(double share, int worlds) {
  return 3.3 * std::sqrt(share * (1.0 - share) / worlds);
}

TEST(RiskWorlds, PlannedRiskEqualsTheShareOfImmobilisedRovers) {
  for (const double steepest : {1.0, 1.5, 3.0}) {
    const RiskyGround ground = riskyGround(steepest);
    NamedPlanner planner;
    const Plan plan = planner.plan(acrossSwells(ground));
    ASSERT_EQ(plan.status, RouteStatus::Found);
    const Route route = annotated(plan, {.map = *ground.map, .planner = "field"});
    RouteRiskOptions options = riskOptions(*ground.map);
    options.worlds = 20000;
    const RouteRisk risk = routeRisk(route, options);
    const double stuck = stuckShare(ground, plan.points, 20000);
    // A cell that is only cut at a corner counts less along the route than in the plane: an eighth at most.
    EXPECT_NEAR(risk.immobilisation, stuck, stuck / 8 + spread(stuck, 10000)) << steepest;
    // The printed risk, from 400 worlds, agrees within sampling error.
    RouteRiskOptions printed = options;
    printed.worlds = 400;
    EXPECT_NEAR(route.vertices.back().immobilisation_risk, risk.immobilisation,
                3.3 * std::hypot(routeRisk(route, printed).standard_error, risk.standard_error))
        << steepest;
  }
}

// Property: with a chance constraint the share of immobilised rovers is below the limit, and without it
// above.
TEST(RiskWorlds, ChanceConstraintIsMetInSimulatedWorlds) {
  constexpr double kLimit = 0.03;
  constexpr int kWorlds = 10000;
  const RiskyGround ground = riskyGround(1.0);
  NamedPlanner planner;
  const Problem problem = acrossSwells(ground);
  const double free = stuckShare(ground, planner.plan(problem).points, kWorlds);
  EXPECT_GT(free - spread(free, kWorlds), kLimit);
  const Plan safe = planWithinRisk(problem, planner, kLimit);
  ASSERT_EQ(safe.status, RouteStatus::Found) << safe.reason;
  const double kept = stuckShare(ground, safe.points, kWorlds);
  EXPECT_LE(kept - spread(kept, kWorlds), kLimit);
}

}  // namespace risk_worlds_test
}  // namespace talus::planner
