#include <talus/planner/bound/cheapest_metre.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cheapest_metre_test {

using testing::drawn;

// Closed form: the minimum over the curves that occur in cells: 10 J times the number of the curve plus one.
TEST(CheapestMetre, MinimumIsTakenOverCurvesInUse) {
  EXPECT_NEAR(cheapestMetre_J(*drawn({"234", "#?4"})), 30.0, 1e-5);
  EXPECT_NEAR(cheapestMetre_J(*drawn({"4.4"})), 10.0, 1e-5);
  EXPECT_EQ(cheapestMetre_J(*drawn({"#?"})), 0.0);
}

}  // namespace cheapest_metre_test
}  // namespace talus::planner
