#include <cmath>
#include <stdexcept>
#include <vector>

#include <talus/planner/check/route_risk.hpp>

namespace talus::planner {
namespace {

// A straight route of stretches of one length, each with its own probability of failing per correlation
// length.
Route straight(const std::vector<double>& failing, double metres, double correlation_m) {
  Route route;
  double hazard = 0.0;
  for (std::size_t i = 0; i <= failing.size(); ++i) {
    RouteVertex vertex;
    vertex.x_m = metres * static_cast<double>(i);
    vertex.immobilisation_risk = -std::expm1(-hazard);
    route.vertices.push_back(vertex);
    if (i < failing.size()) hazard -= std::log1p(-failing[i]) / correlation_m * metres;
  }
  return route;
}

double withinFour(const RouteRisk& risk) {
  return 4 * risk.standard_error;
}  // 4 sigma: 1 in 16000 by chance

TEST(RouteRisk, OneStretchFailsAsOftenAsItSays) {
  const RouteRisk risk = routeRisk(straight({0.2}, 1.0, 5.0), {.worlds = 20000});
  EXPECT_NEAR(risk.immobilisation, 0.2, withinFour(risk));  // Closed form: P(beta + u < 0) = p
}

TEST(RouteRisk, FarStretchesFailIndependentlyNearOnesTogether) {
  const std::vector<double> failing(10, 0.05);
  // Closed form: independent stretches, 1 - (1 - p)^n; fully alike ones, p.
  const RouteRisk far =
      routeRisk(straight(failing, 100.0, 5.0), {.correlation_length_m = 5.0, .worlds = 20000});
  EXPECT_NEAR(far.immobilisation, 1 - std::pow(0.95, 10), withinFour(far));
  const RouteRisk near =
      routeRisk(straight(failing, 1e-4, 5.0), {.correlation_length_m = 5.0, .worlds = 20000});
  EXPECT_NEAR(near.immobilisation, 0.05,
              withinFour(near) + 0.002);  // 0.002: they are a millimetre apart, not at one place
}

TEST(RouteRisk, TheTailLooksAtTheWorstWorldsAndItsPlace) {
  const RouteRisk risk = routeRisk(straight({1e-6, 0.3, 1e-6}, 10.0, 5.0));
  EXPECT_EQ(risk.worst_x_m, 10.0);
  // Closed form: E[u | u < -1.645] = -phi(1.645) / 0.05 = -2.063; beta of 0.3 is 0.524; 0.1 for 200 draws in
  // the tail.
  EXPECT_NEAR(risk.cvar, 0.524 - 2.063, 0.1);
  EXPECT_LT(risk.cvar, routeRisk(straight({1e-6, 0.3, 1e-6}, 10.0, 5.0), {.tail = 1.0}).cvar);
}

TEST(RouteRisk, SafeGroundHasNone) {
  EXPECT_EQ(routeRisk(straight({0.0, 0.0}, 1.0, 5.0)).immobilisation, 0.0);
  EXPECT_EQ(routeRisk(Route{}).immobilisation, 0.0);
}

TEST(RouteRisk, SameSeedSameBits) {
  const Route route = straight({0.1, 0.2, 0.05}, 2.0, 5.0);
  EXPECT_EQ(routeRisk(route).cvar, routeRisk(route).cvar);
  EXPECT_NE(routeRisk(route, {.seed = 2}).cvar, routeRisk(route).cvar);
}

TEST(RouteRisk, RefusesOptionsOutOfRange) {
  EXPECT_THROW(routeRisk(Route{}, {.correlation_length_m = 0.0}), std::invalid_argument);
  EXPECT_THROW(routeRisk(Route{}, {.tail = 0.0}), std::invalid_argument);
  EXPECT_THROW(routeRisk(Route{}, {.worlds = 0}), std::invalid_argument);
}

}  // namespace
}  // namespace talus::planner
