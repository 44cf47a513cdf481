#include <cmath>

#include <site_map.hpp>

#include <talus/planner/simulation/drive/simulation_site.hpp>

namespace talus::planner {
namespace simulation_site_test {

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

}  // namespace simulation_site_test
}  // namespace talus::planner
