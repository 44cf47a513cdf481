#include <cmath>
#include <limits>
#include <stdexcept>

#include <refused.hpp>

#include <talus/costmap/surface/floors.hpp>

namespace talus::costmap {
namespace floors_test {

TEST(Floors, WheelIsAssignedToTheNearestFloor) {
  const Floors floors({{5, 3.0F}, {2, 1.0F}, {5, -2.0F}}, 9);
  ASSERT_EQ(floors.of(5).size(), 2U);
  EXPECT_EQ(floors.of(5)[0].height_m, -2.0F);
  EXPECT_TRUE(floors.of(4).empty());
  // Closed form: the top is at 8 m; the midpoint of 8 and 3 is 5.5, that of 3 and -2 is 0.5.
  EXPECT_FALSE(floors.under(5, 5.6, 8.0).has_value());
  EXPECT_EQ(floors.under(5, 5.4, 8.0)->height_m, 3.0F);
  EXPECT_EQ(floors.under(5, 0.6, 8.0)->height_m, 3.0F);
  EXPECT_EQ(floors.under(5, 0.4, 8.0)->height_m, -2.0F);
  EXPECT_FALSE(floors.under(4, -20.0, 8.0).has_value());
  EXPECT_FALSE(floors.under(5, std::nan(""), 8.0).has_value()) << "an unknown height is on top";
}

TEST(Floors, FloorsOutsideTheMapAreRejected) {
  EXPECT_REFUSED(Floors({{9, 1.0F}}, 9), std::invalid_argument,
                 "a floor of cell 9 at 1.000000 m, must be a height in one of 9 cells");
  EXPECT_REFUSED(Floors({{1, std::numeric_limits<float>::infinity()}}, 9), std::invalid_argument,
                 "a floor of cell 1 at inf m, must be a height in one of 9 cells");
}

}  // namespace floors_test
}  // namespace talus::costmap
