#include <cmath>
#include <numbers>

#include <talus/planner/pose/pose_sampling.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_sampling_test {

PoseProblem across(unsigned seed, const Kinematics& kinematics) {
  return {.map = testing::randomMap(
              {.width = 40, .height = 40, .seed = seed, .blocked = 0.03, .roughness = 0.15}),
          .start = {2.5, 2.5},
          .goal = {36.5, 35.5},
          .start_heading_rad = 0.0,
          .kinematics = kinematics,
          .watch = {}};
}

TEST(PoseSampling, ImprovedDriveIsNeverCostlierAlwaysValidAndReproducible) {
  // Property: tested over random maps and three kinds of kinematics.
  double gained = 0.0;
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (const Kinematics& kinematics :
         {Kinematics{.turning_radius_m = 2.0}, Kinematics{.turning_radius_m = 2.0, .may_reverse = false},
          Kinematics{}}) {
      const PoseProblem problem = across(seed, kinematics);
      const PosePlan known = HybridSearch({.heuristic_weight = 2.0}).plan(problem);
      if (known.status != RouteStatus::Found) continue;
      const PoseSamplingSettings settings{.seed = seed, .work = 20'000};
      const PosePlan better = improvedBySampling(problem, known, settings);
      ASSERT_EQ(better.status, RouteStatus::Found);
      EXPECT_LE(better.cost_J, known.cost_J);
      EXPECT_TRUE(mayBeDriven(*problem.map, better.path, problem.kinematics));
      const Pose end = chords(better.path, *problem.map).back(),
                 asked = chords(known.path, *problem.map).back();
      EXPECT_NEAR(end.place.x_m, asked.place.x_m, 1e-5);
      EXPECT_NEAR(std::remainder(end.heading_rad - asked.heading_rad, 2 * std::numbers::pi), 0.0, 1e-5);
      EXPECT_EQ(improvedBySampling(problem, known, settings).cost_J, better.cost_J);
      gained += known.cost_J - better.cost_J;
    }
  EXPECT_GT(gained, 0.0);
}

}  // namespace pose_sampling_test
}  // namespace talus::planner
