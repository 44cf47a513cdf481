#include <cmath>
#include <queue>

#include <campaign_part.hpp>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/reach/reach.hpp>
#include <talus/planner/route/polyline.hpp>

#include "contour_plane.hpp"
#include "drawn_map.hpp"
#include "steered_ground.hpp"

namespace talus::planner {
namespace reach_test {

using testing::randomMap;

bool reaches(const costmap::CostGrid& map, maps::Point from, maps::Point to) {
  HeadingSets headings(map.cost());
  Reach reach(map, headings, Reach::Sense::From, from);
  return reach.reaches(to, 0.0);
}

// A slope that may only be descended, and not along its contour: bin 0 contains climbs of up to 0.002.
TEST(Reach, ReachIsDirectional) {
  maps::Raster<costmap::CellCode> ramp({.width = 4, .height = 3, .resolution_m = 1.0, .south_west = {}},
                                       costmap::CellCode({.dz_dx = 0.2, .dz_dy = 0.0, .curve = 0}));
  const costmap::CostGrid map = costmap::flattened(ramp, testing::onlyAlong(-1.0, -1.0 / 512.0));
  EXPECT_FALSE(reaches(map, {1.5, 1.5}, {3.5, 1.5}));
  EXPECT_TRUE(reaches(map, {3.5, 1.5}, {1.5, 1.5}));
  HeadingSets headings(map.cost());
  const Reach to(map, headings, Reach::Sense::To, {1.5, 1.5});
  EXPECT_TRUE(to.holds({3, 1}));
  EXPECT_FALSE(to.holds({0, 1}));
}

// Closed form: descending headings on both sides of the fall line together reach everything below the start.
TEST(Reach, DescendingHeadingsReachEverythingBelow) {
  const double steep = 0.3;
  // Descents of at most 0.1 along the heading: both directions of the contour and slightly below.
  maps::Raster<costmap::CellCode> plane({.width = 12, .height = 12, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.0, .dz_dy = steep, .curve = 0}));
  const costmap::CostGrid map = costmap::flattened(plane, testing::onlyAlong(-0.1, -0.002));
  EXPECT_FALSE(reaches(map, {6.0, 5.5}, {6.0, 7.5}));
  EXPECT_TRUE(reaches(map, {6.0, 5.5}, {6.0, 3.5}));
  EXPECT_FALSE(reaches(map, {1.0, 5.5}, {11.0, 5.5}));
  // The descent is 0.3 * 0.2 / 10; the first allowed node of the curve lies at 1/256.
  EXPECT_TRUE(reaches(map, {1.0, 5.5}, {11.0, 5.3}));
}

// Reachability from the centre of a map by brute force: every motion by MotionCost between points of a
// lattice, four to a cell's side, at most three points apart.
struct Tally {
  int open = 0;    // reached by brute force
  int wrong = 0;   // reached by brute force but proven unreachable by Reach
  int proven = 0;  // reached by neither method
};

void compare(const std::shared_ptr<const costmap::CostGrid>& map, Tally& tally) {
  const MotionCost cost(map);
  constexpr int kFine = 4;
  const int side = map->grid().width * kFine;
  const auto place = [&](int k) { return maps::Point{(k % side + 0.5) / kFine, (k / side + 0.5) / kFine}; };
  const int from = side * (side / 2) + side / 2;
  if (!cost.allowed(place(from))) return;
  std::vector<bool> seen(static_cast<std::size_t>(side * side), false);
  std::queue<int> todo;
  seen[static_cast<std::size_t>(from)] = true;
  todo.push(from);
  while (!todo.empty()) {
    const int at = todo.front();
    todo.pop();
    for (int dy = -3; dy <= 3; ++dy)
      for (int dx = -3; dx <= 3; ++dx) {
        const int x = at % side + dx, y = at / side + dy;
        if (x < 0 || y < 0 || x >= side || y >= side) continue;
        const int next = y * side + x;
        if (seen[static_cast<std::size_t>(next)] || !std::isfinite(cost({place(at), place(next)}))) continue;
        seen[static_cast<std::size_t>(next)] = true;
        todo.push(next);
      }
  }
  HeadingSets headings(map->cost());
  Reach reach(*map, headings, Reach::Sense::From, place(from));
  for (int k = 0; k < side * side; ++k) {
    const bool reached = reach.reaches(place(k), 0.0);
    tally.open += seen[static_cast<std::size_t>(k)];
    tally.wrong += seen[static_cast<std::size_t>(k)] && !reached;
    tally.proven += !seen[static_cast<std::size_t>(k)] && !reached;
  }
}

// TALUS_RANDOM_MAPS="FIRST COUNT" replaces the 90 and 120 maps of each run; a campaign consists of such
// runs.
TEST(Reach, NoFalseProofOnRandomMaps) {
  const CampaignPart part = campaignPart("TALUS_RANDOM_MAPS", 90);
  Tally tally;
  for (unsigned seed = part.first; seed < part.end(); ++seed)
    compare(randomMap({.width = 7, .height = 7, .seed = seed, .blocked = 0.25, .roughness = 0.5}), tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.open, 2000);
  EXPECT_GT(tally.proven, 2000);
}

// Every cell has a cone of headings: downhill only, on ground that falls southwards overall. Sides of cells
// are entered in several sections, from both sides of a blocked cell.
TEST(Reach, NoFalseProofOnRandomDescents) {
  const CampaignPart part = campaignPart("TALUS_RANDOM_MAPS", 120);
  Tally tally;
  for (unsigned seed = part.first; seed < part.end(); ++seed) compare(testing::randomDescent(seed), tally);
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.open, 2000);
  EXPECT_GT(tally.proven, 2000);
}

}  // namespace reach_test
}  // namespace talus::planner
