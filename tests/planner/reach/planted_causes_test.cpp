#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {
namespace planted_causes_test {

using costmap::Hazard;
using maps::Point;

constexpr int kSide = 44;  // cells of 1 m
constexpr int kNarrow = 9;

enum class Cause { KeepOut, Class, Rocks, Cliff, Bank, Across, Soil, Unknown, Rim };

// Text that the reason of a refusal must contain for each cause, in the order of Cause.
const char* const kSaid[] = {"keep-out areas, or cells that a layer",
                             "terrain classes declared impassable",
                             "rocks (the layer",
                             "steps higher than the wheels climb",
                             "slopes close every way",
                             "the roll limit closes",
                             "soil closes every way",
                             "unobserved ground closes",
                             "the rim of the map"};

// One obstacle between start and goal: straight, bent, or a ring around one of them.
class Barrier {
 public:
  Barrier(int shape, std::mt19937& random) : shape_(shape % 4) {
    const auto draw = [&random](double from, double to) {
      return from + (to - from) * std::uniform_real_distribution<>(0.0, 1.0)(random);
    };
    middle_ = {draw(19.0, 25.0), draw(19.0, 25.0)};
    tilt_ = draw(-0.5, 0.5);
    radius_m_ = draw(6.5, 8.0);
    start = {draw(3.0, 8.0), draw(12.0, 32.0)};
    goal = {draw(36.0, 41.0), draw(12.0, 32.0)};
    if (shape_ == 2) start = middle_;
    if (shape_ == 3) goal = middle_;
    if (random() % 2 == 0) {
      turned_ = true;
      std::swap(start.x_m, start.y_m);
      std::swap(goal.x_m, goal.y_m);
    }
  }

  // Distance from the centre of the obstacle [m]: negative on the start's side, positive on the goal's side.
  double operator()(Point at) const {
    if (turned_) std::swap(at.x_m, at.y_m);
    const double dx = at.x_m - middle_.x_m, dy = at.y_m - middle_.y_m;
    switch (shape_) {
      case 0:
        return (dx + tilt_ * dy) / std::hypot(1.0, tilt_);
      case 1:
        return (dx + tilt_ * std::abs(dy)) / std::hypot(1.0, tilt_);
      case 2:
        return std::hypot(dx, dy) - radius_m_;
      default:
        return radius_m_ - std::hypot(dx, dy);
    }
  }

  Point start, goal;

 private:
  int shape_;
  bool turned_ = false;
  Point middle_;
  double tilt_, radius_m_;
};

struct Site {
  costmap::MapLayers layers;
  terramech::Rover rover = costmap::testRover();
  Point start, goal;
};

maps::Grid gridOf(int width, int height) {
  return {.width = width, .height = height, .resolution_m = 1.0, .south_west = {}};
}

Site levelSite(const maps::Grid& grid) {
  Site made;
  made.layers.elevation = maps::ElevationMap{.elevation_m = maps::Raster<float>(grid, 0.0F)};
  return made;
}

template <typename Height>
void addHeights(Site& site, Height height) {
  maps::Raster<float>& heights = site.layers.elevation.elevation_m;
  for (int row = 0; row < heights.grid().height; ++row)
    for (int column = 0; column < heights.grid().width; ++column)
      heights[{column, row}] += static_cast<float>(height(heights.grid().centre({column, row})));
}

template <typename T>
maps::Raster<T> banded(const maps::Grid& grid, const Barrier& barrier, T there, T elsewhere) {
  maps::Raster<T> made(grid, elsewhere);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      if (std::abs(barrier(grid.centre({column, row}))) <= 2.0) made[{column, row}] = there;
  return made;
}

// A strip whose ground has a cross slope in the middle, to the left or right, along x or y.
Site leaningStrip(std::mt19937& random) {
  const bool along_y = random() % 2 == 0;
  const double lean = (random() % 2 == 0 ? 1.0 : -1.0) * (0.62 + 0.01 * static_cast<double>(random() % 8));
  const double middle_m = 26.0 + static_cast<double>(random() % 8);
  Site made = levelSite(along_y ? gridOf(kNarrow, 60) : gridOf(60, kNarrow));
  made.rover.max_pitch_rad = 0.5;
  made.rover.max_roll_rad = 0.1;
  addHeights(made, [&](Point at) {
    if (along_y) std::swap(at.x_m, at.y_m);
    const double share = std::clamp(1.5 - std::abs(at.x_m - middle_m) / 10.0, 0.0, 1.0);
    return lean * share * (at.y_m - 0.5 * kNarrow);
  });
  made.start = {4.5, 4.5};
  made.goal = along_y ? Point{4.5, 55.5} : Point{55.5, 4.5};
  return made;
}

// Moves start or goal into the clearance from the rim.
void moveToRim(Site& site, std::mt19937& random) {
  Point& end = random() % 2 == 0 ? site.start : site.goal;
  (random() % 2 == 0 ? end.x_m : end.y_m) = random() % 2 == 0 ? 0.5 : kSide - 0.5;
}

Site planted(Cause cause, int shape, std::mt19937& random) {
  if (cause == Cause::Across) return leaningStrip(random);
  const maps::Grid grid = gridOf(kSide, kSide);
  const Barrier barrier(shape, random);
  Site made = levelSite(grid);
  made.start = barrier.start;
  made.goal = barrier.goal;
  const double phase = static_cast<double>(random() % 100),
               steep = 0.34 + 0.01 * static_cast<double>(random() % 8);
  const double cliff_m = (random() % 2 == 0 ? 1.0 : -1.0) * (0.5 + 0.1 * static_cast<double>(random() % 8));
  addHeights(made, [&](Point at) { return 0.1 * std::sin(0.3 * at.x_m + phase) * std::cos(0.25 * at.y_m); });
  if (cause == Cause::KeepOut) made.layers.keep_out = banded<std::uint8_t>(grid, barrier, 1, 0);
  if (cause == Cause::Class) made.layers.classes = banded<std::uint8_t>(grid, barrier, 9, 1);
  if (cause == Cause::Soil) made.layers.classes = banded<std::uint8_t>(grid, barrier, 2, 1);
  if (cause == Cause::Rocks) made.layers.rock_abundance = banded<float>(grid, barrier, 0.6F, 0.0F);
  if (cause == Cause::Cliff) addHeights(made, [&](Point at) { return barrier(at) > 0.0 ? cliff_m : 0.0; });
  if (cause == Cause::Bank) {
    made.rover.max_pitch_rad = made.rover.max_roll_rad = 0.2;
    addHeights(made, [&](Point at) { return steep * std::clamp(barrier(at) + 3.0, 0.0, 6.0); });
  }
  if (cause == Cause::Unknown)
    addHeights(made, [&](Point at) {
      return std::abs(barrier(at)) <= 2.0 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    });
  if (cause == Cause::Rim) moveToRim(made, random);
  return made;
}

Plan planOn(Site site) {
  terramech::Soil powder = costmap::testDust();
  powder.cohesion_Pa = 0.0;
  powder.friction_angle_rad = 0.05;
  const auto model = std::make_shared<const costmap::GroundModel>(
      costmap::GroundModel::Parts{.rover = site.rover,
                                  .classes = {costmap::GroundClass{.number = 1, .soil = costmap::testSand()},
                                              costmap::GroundClass{.number = 2, .soil = powder}}});
  const costmap::TraversabilityMap map(std::move(site.layers), model, {});
  Problem problem;
  problem.map = map.published();
  problem.start = site.start;
  problem.goal = site.goal;
  problem.hazards = [&map](maps::Cell cell) { return map.surface().hazards(cell); };
  return FieldPlanner().plan(problem);
}

// Property: the reason names the planted cause and no other, for any shape and place.
TEST(PlantedCauses, AreNamedAlone) {
  for (int cause = 0; cause < 9; ++cause)
    for (unsigned seed = 1; seed <= 7; ++seed) {
      SCOPED_TRACE(std::string(kSaid[cause]) + ", seed " + std::to_string(seed));
      std::mt19937 random(100 * static_cast<unsigned>(cause) + seed);
      const Plan plan = planOn(planted(static_cast<Cause>(cause), static_cast<int>(seed), random));
      EXPECT_NE(plan.status, RouteStatus::Found);
      EXPECT_NE(plan.status, RouteStatus::NoneFound);
      for (int other = 0; other < 9; ++other)
        EXPECT_EQ(plan.reason.find(kSaid[other]) != std::string::npos, other == cause) << plan.reason;
    }
}

// Two obstacles, one behind the other: removing one of them opens no route, and both are named.
TEST(PlantedCauses, TwoObstaclesAreNamedTogether) {
  const auto between = [](const std::function<void(Site&)>& plant) {
    Site site = levelSite(gridOf(kSide, kSide));
    site.start = {5.5, 20.5};
    site.goal = {38.5, 20.5};
    plant(site);
    const Plan plan = planOn(std::move(site));
    EXPECT_EQ(plan.status, RouteStatus::NoRoute);
    return plan;
  };
  const auto nothing = [](double west_m) {
    return [west_m](Point at) {
      return std::abs(at.x_m - west_m) <= 2.0 ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    };
  };
  const Plan bank = between([](Site& site) {
    site.rover.max_pitch_rad = site.rover.max_roll_rad = 0.2;
    addHeights(site, [](Point at) {
      return 0.4 * std::clamp(at.x_m - 12.0, 0.0, 6.0) + (at.x_m > 28.0 ? 0.8 : 0.0);
    });
  });
  EXPECT_EQ(bank.obstruction->lifting, Constraint::Hazard);
  EXPECT_EQ(bank.obstruction->hazard, Hazard::Step);
  EXPECT_EQ(bank.obstruction->also, Constraint::Slope);
  EXPECT_THAT(bank.reason, ::testing::HasSubstr("steps and slopes close every way together"));
  const Plan unseen = between([&](Site& site) {
    site.layers.classes = maps::Raster<std::uint8_t>(gridOf(kSide, kSide), 1);
    for (int row = 0; row < kSide; ++row) site.layers.classes[{14, row}] = 9;
    addHeights(site, nothing(28.0));
  });
  EXPECT_THAT(unseen.reason,
              ::testing::HasSubstr("impassable classes and unobserved ground close every way"));
}

}  // namespace planted_causes_test
}  // namespace talus::planner
