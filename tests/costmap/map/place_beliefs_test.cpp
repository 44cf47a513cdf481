#include <string>
#include <vector>

#include <site_map.hpp>

#include <talus/costmap/map/place_beliefs.hpp>
#include <talus/costmap/map/traversability_map.hpp>

namespace talus::costmap {
namespace place_beliefs_test {

// Property: cached results equal those of the map for any order of requests over cells of several classes.
TEST(PlaceBeliefs, CachedBeliefsEqualTheMap) {
  std::vector<std::string> rows(40, std::string(20, '1') + std::string(20, '2'));
  rows[5][5] = '?';
  rows[6][6] = '#';
  TraversabilityMap map = mapOf(rows);
  for (const double x_m : {110.5, 130.5})
    map.learn({.time_s = 1.0, .place = {x_m, 220.5}, .pull = {0.05, 0.05}, .sinkage = {0.6, 0.05}});
  map.publish();
  PlaceBeliefs beliefs(map);
  for (int row = 39; row >= 0; --row)
    for (int column = 0; column < 40; ++column) {
      const maps::Cell cell{column, row};
      ASSERT_EQ(beliefs.at(cell), map.belief(cell)) << column << ' ' << row;
      const auto one = beliefs.ground(cell), other = map.ground(cell);
      ASSERT_EQ(one.has_value(), other.has_value());
      if (one) {
        ASSERT_EQ(one->pull.value, other->pull.value);
      }
    }
  EXPECT_LT(beliefs.ground({10, 20})->pull.value, beliefs.ground({0, 0})->pull.value);
}

}  // namespace place_beliefs_test
}  // namespace talus::costmap
