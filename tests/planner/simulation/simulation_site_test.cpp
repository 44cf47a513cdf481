#include <cmath>

#include <site_map.hpp>

#include <talus/planner/simulation/simulation_rates.hpp>
#include <talus/planner/simulation/simulation_site.hpp>

namespace talus::planner {
namespace {

using costmap::testDust;
using costmap::testSand;

terramech::Soil rock() {
  terramech::Soil soil = testSand();
  soil.friction_angle_rad = 0.75;
  soil.frictional_modulus = 5e7;
  soil.shear_modulus_m = 0.002;
  return soil;
}

// A drawing starts at 100,200.
SimulationSite::Parts across(Truth truth) {
  return {
      .truth = std::move(truth), .start = {105.5, 215.5}, .goal = {135.5, 215.5}, .firm = rock(), .seed = 7};
}

std::vector<std::string> plain() {
  return std::vector<std::string>(30, std::string(40, '1'));
}

Truth random(int patches) {
  Truth truth;
  truth.spread = 0.1;
  truth.random_patches = patches;
  truth.patch_radius_m = 2.0;
  truth.patch_soil = testDust();
  return truth;
}

TEST(SimulationSite, AWorldDependsOnItsNumberAlone) {
  const auto map = costmap::mapOf(plain());
  const SimulationSite site(map, across(random(3)));
  const auto all = site.worlds({.belief = Belief::OnLine, .first = 0, .count = 4});
  const auto late = site.worlds({.belief = Belief::OnLine, .first = 2, .count = 2});
  ASSERT_EQ(all.size(), 4U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all[2 + i].drive.energy_J, late[i].drive.energy_J);
    EXPECT_EQ(all[2 + i].drive.outcome, late[i].drive.outcome);
    EXPECT_EQ(all[2 + i].categories_changed, late[i].categories_changed);
  }
  EXPECT_NE(all[0].drive.energy_J, all[1].drive.energy_J);
}

TEST(SimulationSite, ClairvoyanceKnowsEveryPatchBySoil) {
  const auto map = costmap::mapOf(plain());
  Truth truth;
  terramech::Soil firm = rock();
  truth.patches = {{{112.5, 215.5}, 2.0, testDust()}, {{125.5, 215.5}, 2.0, firm}};
  const SimulationSite site(map, across(truth));
  const TrueWorld world = site.trueWorld(0);
  const auto believed = site.believed(Belief::PerfectKnowledge, world);
  const auto pull = [&](maps::Point p) { return believed.ground(*believed.grid().cellAt(p))->pull.value; };
  const auto model = costmap::testGround();
  // Closed form: the soil's own pull, each patch its own
  EXPECT_NEAR(pull({112.5, 215.5}), model->prior(1).pull.value, 1e-9);
  EXPECT_NEAR(pull({105.5, 215.5}), model->prior(0).pull.value, 1e-9);
  EXPECT_GT(pull({125.5, 215.5}), model->prior(0).pull.value + 0.05);
  EXPECT_EQ(site.world(Belief::PerfectKnowledge, 0).drive.outcome, Outcome::Reached);
  EXPECT_EQ(site.world(Belief::Prior, 0).drive.outcome, Outcome::Immobilised);
}

TEST(SimulationSite, GeometryTakesAllGroundForFirm) {
  const auto map = costmap::mapOf(std::vector<std::string>(30, std::string(40, '2')));
  const SimulationSite site(map, across({}));
  const TrueWorld world = site.trueWorld(0);
  const auto believed = site.believed(Belief::Geometry, world);
  EXPECT_GT(believed.ground({5, 5})->pull.value,
            site.believed(Belief::Prior, world).ground({5, 5})->pull.value + 0.2);
}

TEST(SimulationSite, KeepOutStaysUnderEveryBelief) {
  auto rows = plain();
  rows[10][20] = '#';
  const auto map = costmap::mapOf(rows);
  const SimulationSite site(map, across({}));
  const TrueWorld world = site.trueWorld(0);
  for (const Belief belief : {Belief::Geometry, Belief::Prior, Belief::OnLine, Belief::PerfectKnowledge})
    EXPECT_TRUE(has(site.believed(belief, world).hazards({20, 19}), costmap::Hazard::KeepOut))
        << name(belief);
}

TEST(DrawWorld, SparesStartAndGoal) {
  const auto map = costmap::mapOf(plain());
  const auto& classes = map.model().parts().classes;
  std::size_t patches = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const WorldSoils world = drawWorld(random(20), classes, map.grid(),
                                       {.seed = seed, .start = {105.5, 215.5}, .goal = {135.5, 215.5}});
    patches += world.patches.size();
    for (const SoilPatch& p : world.patches) {
      EXPECT_GE(std::hypot(p.centre.x_m - 105.5, p.centre.y_m - 215.5), p.radius_m + 2.0);
      EXPECT_GE(std::hypot(p.centre.x_m - 135.5, p.centre.y_m - 215.5), p.radius_m + 2.0);
      EXPECT_GE(p.radius_m, 1.0);
      EXPECT_LE(p.radius_m, 3.0);
    }
    EXPECT_EQ(world.classes.size(), 2U);
  }
  EXPECT_GT(patches, 600U);
  EXPECT_LT(patches, 1000U);
}

TEST(DrawWorld, SpreadIsWhatItSays) {
  const auto map = costmap::mapOf(plain());
  double sum = 0.0, squares = 0.0;
  constexpr int kDraws = 2000;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const auto world = drawWorld(random(0), map.model().parts().classes, map.grid(), {.seed = seed});
    const double factor = world.classes[0].cohesion_Pa / testSand().cohesion_Pa;
    sum += factor;
    squares += factor * factor;
  }
  const double mean = sum / kDraws, std = std::sqrt(squares / kDraws - mean * mean);
  EXPECT_NEAR(mean, 1.0, 0.01);  // Property: four standard errors of 2000 draws
  EXPECT_NEAR(std, 0.1, 0.007);
}

TEST(Share, IsWilsons) {
  // Closed form: Wilson (1927) for 0 and 10 of 10, 5 of 10, worked out by hand
  EXPECT_NEAR(share(0, 10).interval_95[1], 0.27753, 1e-5);
  EXPECT_NEAR(share(10, 10).interval_95[0], 0.72247, 1e-5);
  EXPECT_NEAR(share(5, 10).interval_95[0], 0.23659, 1e-5);
  EXPECT_DOUBLE_EQ(share(5, 10).value, 0.5);
  EXPECT_TRUE(std::isnan(share(0, 0).value));
}

TEST(Compared, CountsWhereTheClairvoyantGotThrough) {
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

}  // namespace
}  // namespace talus::planner
