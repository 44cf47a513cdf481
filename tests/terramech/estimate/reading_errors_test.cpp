#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {
namespace reading_errors_test {

TEST(ReadingErrors, PartsAddInQuadrature) {
  // Closed form: hypot(0.03 x 100, 4) = 5; the sign of a reading does not matter.
  const ReadingError error{.relative = 0.03, .absolute = 4.0};
  EXPECT_DOUBLE_EQ(error.std(100.0), 5.0);
  EXPECT_DOUBLE_EQ(error.std(-100.0), 5.0);
  EXPECT_DOUBLE_EQ(error.std(0.0), 4.0);
}

TEST(ReadingErrors, RelativeErrorAppliesToAllFourReadings) {
  const ReadingErrors errors = ReadingErrors::relative(0.1);
  for (const ReadingError* e : {&errors.load, &errors.torque, &errors.sinkage, &errors.slip})
    EXPECT_DOUBLE_EQ(e->std(2.0), 0.2);
  EXPECT_DOUBLE_EQ(ReadingErrors{}.slip.std(0.4), 0.02);  // Printed in: the thesis, 5 % error of each reading
}

}  // namespace reading_errors_test
}  // namespace talus::terramech
