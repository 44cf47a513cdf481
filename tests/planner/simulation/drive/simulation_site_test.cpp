#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>
#include <site_map.hpp>

#include <talus/planner/simulation/simulation.hpp>

namespace talus::planner {

namespace simulation_site_test {

TEST(Share, IntervalIsWilsons) {
  // Closed form: Wilson (1927) for 0 and 10 of 10, 5 of 10, computed by hand
  EXPECT_NEAR(share(0, 10).interval_95[1], 0.27753, 1e-5);
  EXPECT_NEAR(share(10, 10).interval_95[0], 0.72247, 1e-5);
  EXPECT_NEAR(share(5, 10).interval_95[0], 0.23659, 1e-5);
  EXPECT_DOUBLE_EQ(share(5, 10).value, 0.5);
  EXPECT_TRUE(std::isnan(share(0, 0).value));
}

// Closed form: for 1, 2, 3, 6 the mean is 3, the standard deviation sqrt(14 / 3), the standard error half of
// it.
TEST(Mean, IntervalFollowsFromTheStandardError) {
  const Sampled of = mean({1.0, 2.0, 3.0, 6.0});
  EXPECT_DOUBLE_EQ(of.value, 3.0);
  EXPECT_NEAR(of.interval_95[1] - 3.0, 1.959964 * std::sqrt(14.0 / 3.0) / 2.0, 1e-5);
  EXPECT_NEAR(of.interval_95[0] + of.interval_95[1], 6.0, 1e-12);
  EXPECT_TRUE(std::isnan(mean({}).value));
}

TEST(Compared, RatesCountWorldsSolvedWithPerfectKnowledge) {
  const auto drive = [](Outcome outcome, double energy_J) {
    WorldResult r;
    r.drive.outcome = outcome;
    r.drive.energy_J = energy_J;
    return r;
  };
  const std::vector<WorldResult> mine{drive(Outcome::Reached, 110.0), drive(Outcome::Immobilised, 5.0),
                                      drive(Outcome::GaveUp, 1.0), drive(Outcome::Reached, 130.0)};
  const std::vector<WorldResult> best{drive(Outcome::Reached, 100.0), drive(Outcome::Reached, 100.0),
                                      drive(Outcome::GaveUp, 0.0), drive(Outcome::Reached, 100.0)};
  const Comparison out = compared(mine, best);
  EXPECT_EQ(out.rates.worlds, 3U);
  EXPECT_NEAR(out.rates.outcome[static_cast<std::size_t>(Outcome::Immobilised)].value, 1.0 / 3.0, 1e-12);
  EXPECT_DOUBLE_EQ(out.rates.outcome[static_cast<std::size_t>(Outcome::GaveUp)].value, 0.0);
  EXPECT_NEAR(out.energy_over_perfect_knowledge.value, 1.2, 1e-12);
  EXPECT_NEAR(out.energy_over_perfect_knowledge.interval_95[1] - 1.2, 1.959964 * 0.1,
              1e-6);  // std 0.1414 / sqrt(2)
  EXPECT_THROW(compared(mine, {}), std::invalid_argument);
}

using costmap::testDust;
using costmap::testSand;

terramech::Soil rock() {
  terramech::Soil soil = testSand();
  soil.friction_angle_rad = 0.75;
  soil.frictional_modulus = 5e7;
  soil.shear_modulus_m = 0.002;
  return soil;
}

// The south-west corner of a drawn map is 100,200.
SimulationSite::Parts across(Truth truth) {
  return {
      .truth = std::move(truth), .start = {105.5, 215.5}, .goal = {135.5, 215.5}, .firm = rock(), .seed = 7};
}

std::vector<std::string> plain() {
  return std::vector<std::string>(30, std::string(40, '1'));
}

TEST(SimulationSite, PerfectKnowledgeUsesTheTrueSoilOfEveryPatch) {
  const auto map = costmap::mapOf(plain());
  Truth truth;
  terramech::Soil firm = rock();
  truth.patches = {{{112.5, 215.5}, 2.0, testDust()}, {{125.5, 215.5}, 2.0, firm}};
  const SimulationSite site(map, across(truth));
  const TrueWorld world = site.trueWorld(0);
  const auto believed = site.estimatedMap(SoilKnowledge::PerfectKnowledge, world);
  const auto pull = [&](maps::Point p) { return believed.ground(*believed.grid().cellAt(p))->pull.value; };
  const auto model = costmap::testGround();
  // Closed form: the pull of the soil of each patch
  EXPECT_NEAR(pull({112.5, 215.5}), model->prior(1).pull.value, 1e-9);
  EXPECT_NEAR(pull({105.5, 215.5}), model->prior(0).pull.value, 1e-9);
  EXPECT_GT(pull({125.5, 215.5}), model->prior(0).pull.value + 0.05);
  EXPECT_EQ(site.world(SoilKnowledge::PerfectKnowledge, 0).drive.outcome, Outcome::Reached);
  EXPECT_EQ(site.world(SoilKnowledge::Prior, 0).drive.outcome, Outcome::Immobilised);
}

TEST(SimulationSite, GeometricBeliefAssumesFirmGround) {
  const auto map = costmap::mapOf(std::vector<std::string>(30, std::string(40, '2')));
  const SimulationSite site(map, across({}));
  const TrueWorld world = site.trueWorld(0);
  const auto believed = site.estimatedMap(SoilKnowledge::Geometry, world);
  EXPECT_GT(believed.ground({5, 5})->pull.value,
            site.estimatedMap(SoilKnowledge::Prior, world).ground({5, 5})->pull.value + 0.2);
}

// Property: on a plane too steep across, planning on longitudinal slopes alone follows a contour, and the
// rover slides.
TEST(SimulationSite, LongitudinalOnlyPlanningSlidesOnCrossSlopes) {
  costmap::GroundModel::Parts parts = costmap::testGround()->parts();
  parts.classes.front().soil.cohesion_Pa = 200.0;
  parts.classes.front().soil.friction_angle_rad = 0.52;
  const costmap::TraversabilityMap map(costmap::drawn(plain(), 0.3),
                                       std::make_shared<costmap::GroundModel>(parts), {});
  const SimulationSite site(map,
                            {.truth = {}, .start = {120.5, 206.5}, .goal = {120.5, 222.5}, .firm = rock()});
  EXPECT_EQ(site.world(SoilKnowledge::AlongOnly, 0).drive.outcome, Outcome::Slid);
  EXPECT_EQ(site.world(SoilKnowledge::Prior, 0).drive.outcome, Outcome::GaveUp);
}

TEST(SimulationSite, KeepOutAreasApplyUnderEveryBelief) {
  auto rows = plain();
  rows[10][20] = '#';
  const auto map = costmap::mapOf(rows);
  const SimulationSite site(map, across({}));
  const TrueWorld world = site.trueWorld(0);
  for (const SoilKnowledge belief : kBeliefs)
    EXPECT_TRUE(has(site.estimatedMap(belief, world).surface().hazards({20, 19}), costmap::Hazard::KeepOut))
        << name(belief);
}

TraverseStep step(double expected_slip, double slip, double expected_J_per_m, double J_per_m) {
  TraverseStep s;
  s.heading = {1.0, 0.0};
  s.length_m = 2.0;
  s.expected_slip = expected_slip;
  s.expected_energy_J_per_m = expected_J_per_m;
  s.truth.slip = slip;
  s.truth.energy_J_per_m = J_per_m;
  return s;
}

TEST(TraverseLog, ErrorsAreThoseOfTheRecordedSteps) {
  TraverseLog log;
  log.record(step(0.1, 0.2, 100.0, 150.0));
  log.record(step(0.3, 0.3, 200.0, 250.0));
  const PredictionErrors e = log.errors();
  // Closed form: sqrt(0.01 / 2); 50 over a mean of 200; (600 - 800) / 800.
  EXPECT_EQ(e.steps, 2);
  EXPECT_NEAR(e.slip_rmse, std::sqrt(0.005), 1e-12);
  EXPECT_NEAR(e.energy_rmse, 0.25, 1e-12);
  EXPECT_NEAR(e.energy_error, -0.25, 1e-12);
  EXPECT_EQ(TraverseLog{}.errors().steps, 0);
}

}  // namespace simulation_site_test

}  // namespace talus::planner
