#include <cmath>

#include <talus/terramech/estimate/pull_formula.hpp>

namespace talus::terramech {
namespace pull_formula_test {

TEST(PullFormula, EachNameSelectsItsFormula) {
  const Wheel wheel{.radius_m = 0.15, .width_m = 0.15};
  const WheelSample s{.load_N = 80.0, .torque_Nm = 5.0, .sinkage_m = 0.02, .slip = 0.3};
  const ReadingErrors errors = ReadingErrors::relative(0.05);
  const Estimate ours = pullOverLoad(wheel, s, errors);
  const auto by = [&](const char* name) { return pullOverLoadBy(name, wheel, s, errors); };
  EXPECT_EQ(by("single-force").value, ours.value);
  EXPECT_EQ(by("single-force").std, ours.std);
  EXPECT_EQ(by("small-angle").value, pullAtSmallAngle(wheel, s));
  EXPECT_EQ(by("triangular").value, pullOfTriangularStress(wheel, s));
  EXPECT_EQ(by("plane").value, kThesisPlane.at(wheel, s));
  // Property: the standard deviation includes the model error of the formula (drawbar_pull.hpp) in addition
  // to the errors of the readings.
  for (const char* name : {"small-angle", "triangular", "plane"}) EXPECT_GT(by(name).std, ours.std) << name;
  EXPECT_THROW(by("no-such"), std::invalid_argument);
  for (const std::string& name : pullFormulas()) EXPECT_NO_THROW(by(name.c_str()));
}

}  // namespace pull_formula_test
}  // namespace talus::terramech
