#include <cmath>

#include <talus/planner/refine/corridor_search.hpp>
#include <talus/planner/refine/edge_path.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace edge_path_test {

using maps::Point;
using testing::drawn;
using testing::randomMap;

double priced(const MotionCost& cost, const EdgePath& path) {
  const auto points = path.points(cost.map().grid());
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += cost({points[i - 1], points[i]});
  return sum;
}

// Property: after turns are shifted along their edges, both adjacent cells allow both headings.
TEST(EdgePath, ShiftedTurnsAreValid) {
  int slid = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const MotionCost cost(
        randomMap({.width = 30, .height = 30, .seed = seed, .blocked = 0.05, .roughness = 0.25}));
    EdgePath path = searchCorridor(cost, {{1.5, 1.5}, {28.3, 27.1}}, 1e9, {.reach_cells = 30});
    if (path.empty()) continue;
    ++slid;
    const double before = cost.along(path.points(cost.map().grid()));
    slideTurns(cost.map(), path, 0.5 / 3, 4);
    EXPECT_LE(cost.along(path.points(cost.map().grid())), before) << seed;
  }
  EXPECT_GT(slid, 10);
}

// Property: shifting never increases the cost, keeps ends and cells, and yields refraction by Snell's law.
TEST(EdgePath, ShiftingReducesCostAndKeepsEndsAndCells) {
  std::vector<std::string> rows(40, std::string(40, '.'));
  for (auto& row : rows) row.replace(20, 20, std::string(20, '2'));
  const MotionCost cost(drawn(rows));
  const Point from{3.5, 5.5}, to{36.5, 30.5};
  EdgePath path = searchCorridor(cost, {from, to}, 1e9, {.reach_cells = 8, .points_per_edge = 3});
  const double before = priced(cost, path);
  const auto cells = path.cells;
  slideTurns(cost.map(), path, 0.5 / 3, 6);
  double best = 1e9;  // Closed form, by scanning where the border is crossed.
  for (double y = 5.5; y < 30.5; y += 1e-3)
    best = std::min(best,
                    10 * std::hypot(20 - from.x_m, y - from.y_m) + 30 * std::hypot(to.x_m - 20, to.y_m - y));
  const double after = priced(cost, path);
  EXPECT_LT(after, before);
  EXPECT_EQ(path.cells, cells);
  EXPECT_EQ(path.points(cost.map().grid()).front(), from);
  EXPECT_EQ(path.points(cost.map().grid()).back(), to);
  EXPECT_GE(after, best * (1 - 1e-9));
  EXPECT_LT(after, best * 1.01);
}

}  // namespace edge_path_test
}  // namespace talus::planner
