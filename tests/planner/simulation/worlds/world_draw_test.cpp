#include <algorithm>
#include <cmath>

#include <site_map.hpp>

#include <talus/planner/simulation/worlds/world_draw.hpp>

namespace talus::planner {
namespace world_draw_test {

using costmap::testDust;
using costmap::testSand;

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

TEST(DrawWorld, PatchesKeepClearOfStartAndGoal) {
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

TEST(DrawWorld, SpreadEqualsTheStatedStd) {
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

// Property: the same seed gives the same world; declared patches and true classes occur in every world.
TEST(DrawWorld, WorldDependsOnTheSeedOnly) {
  const auto map = costmap::mapOf(plain());
  const auto& classes = map.model().parts().classes;
  Truth truth = random(5);
  truth.patches = {{{110.5, 205.5}, 1.5, testDust()}};
  truth.classes = {{1, testDust()}};
  const auto draw = [&](std::uint64_t seed) { return drawWorld(truth, classes, map.grid(), {.seed = seed}); };
  const WorldSoils one = draw(3), same = draw(3), other = draw(4);
  ASSERT_EQ(one.patches.size(), same.patches.size());
  for (std::size_t i = 0; i < one.patches.size(); ++i)
    EXPECT_EQ(one.patches[i].centre, same.patches[i].centre);
  EXPECT_EQ(one.classes[0].cohesion_Pa, same.classes[0].cohesion_Pa);
  EXPECT_NE(one.classes[0].cohesion_Pa, other.classes[0].cohesion_Pa);
  EXPECT_NEAR(one.classes[0].cohesion_Pa, testDust().cohesion_Pa,
              0.6 * testDust().cohesion_Pa);  // six standard deviations
  for (const WorldSoils* world : {&one, &other})
    EXPECT_TRUE(std::ranges::any_of(world->patches, [](const SoilPatch& p) {
      return p.centre == maps::Point{110.5, 205.5} && p.radius_m == 1.5;
    }));
}

// Property: the draw of a class and of the random patches does not depend on other declarations or their
// order.
TEST(DrawWorld, ClassDrawDependsOnItsNumberOnly) {
  const auto map = costmap::mapOf(plain());
  std::vector<costmap::GroundClass> classes = map.model().parts().classes;
  ASSERT_EQ(classes.size(), 2U);
  const WorldSoils world = drawWorld(random(5), classes, map.grid(), {.seed = 3});
  std::ranges::reverse(classes);
  classes.insert(classes.begin(), costmap::GroundClass{.number = 99, .soil = testDust()});
  const WorldSoils more = drawWorld(random(5), classes, map.grid(), {.seed = 3});
  for (const std::size_t k : {0U, 1U}) {
    EXPECT_EQ(more.classes[2 - k].cohesion_Pa, world.classes[k].cohesion_Pa);
    EXPECT_EQ(more.classes[2 - k].friction_angle_rad, world.classes[k].friction_angle_rad);
  }
  ASSERT_EQ(more.patches.size(), world.patches.size());
  for (std::size_t i = 0; i < world.patches.size(); ++i) {
    EXPECT_EQ(more.patches[i].centre, world.patches[i].centre);
    EXPECT_EQ(more.patches[i].soil.cohesion_Pa, world.patches[i].soil.cohesion_Pa);
  }
  EXPECT_NE(world.classes[0].cohesion_Pa / testSand().cohesion_Pa,
            world.classes[1].cohesion_Pa / testDust().cohesion_Pa);
}

}  // namespace world_draw_test
}  // namespace talus::planner
