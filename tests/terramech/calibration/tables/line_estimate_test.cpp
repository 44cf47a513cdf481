#include <cmath>

#include <talus/common/input_error.hpp>
#include <talus/terramech/calibration/tables/line_estimate.hpp>

#include "calibration/wheel_table.hpp"
#include "linear_world.hpp"

namespace talus::terramech {
namespace line_estimate_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

// Rows of a world with the stresses that the method assumes.
std::string linearRows(const LinearWorld& world, double second_radius_m = kMadeWheel.radius_m) {
  std::string text = kWheelHead + "\n";
  int k = 0;
  for (const WheelSample& s : linearSamples(kMadeWheel, world))
    text += wheelLine(s, {.radius_m = k++ % 2 ? second_radius_m : kMadeWheel.radius_m,
                          .width_m = kMadeWheel.width_m}) +
            "\n";
  return text;
}

SoilEstimate estimate(const std::string& content, EstimateOptions options) {
  const test::TemporaryFile file{content};
  options.table = file.path();
  return lineEstimate(options, {});
}

// Closed form: the rows have cohesion c = 3000 Pa and tan phi = 0.5 (phi: friction angle). Tolerance: the
// quadrature of the samples, 1e-7, amplified by the fit of the line.
TEST(LineEstimate, IsExactForDataOfItsOwnModel) {
  const SoilEstimate iagnemma =
      estimate(linearRows({.offset = false}), {.method = "iagnemma", .shear_modulus = "0.02"});
  EXPECT_NEAR(iagnemma.cohesion_Pa, 3000.0, 3.0);
  EXPECT_NEAR(iagnemma.tan_friction, 0.5, 1e-3);
  EXPECT_EQ(iagnemma.shear_modulus_m, 0.02);
  EXPECT_EQ(iagnemma.rows_used, 10U);
  EXPECT_EQ(iagnemma.points.size(), 10U);
}

TEST(LineEstimate, RecursiveEstimateEqualsBatchEstimate) {
  for (const char* method : {"linear-offset", "iagnemma", "sojourner"}) {
    const EstimateOptions all{.method = method, .shear_modulus = "0.02"};
    EstimateOptions recursive = all;
    recursive.recursive = true;
    const SoilEstimate a = estimate(linearRows({}), all), b = estimate(linearRows({}), recursive);
    ASSERT_EQ(b.running.size(), 10U) << method;
    EXPECT_NEAR(b.cohesion_Pa, a.cohesion_Pa, 1e-6 * std::abs(a.cohesion_Pa)) << method;
    EXPECT_NEAR(b.running.back().cohesion_Pa, a.cohesion_Pa, 1e-6 * std::abs(a.cohesion_Pa)) << method;
    EXPECT_TRUE(std::isnan(b.running.front().cohesion_Pa)) << method;  // one row does not determine a line
    EXPECT_EQ(b.running.front().line, 2U);
  }
}

TEST(LineEstimate, UnstatedShearModulusIsEstimated) {
  const SoilEstimate found = estimate(linearRows({}), {.method = "linear-offset"});
  EXPECT_NEAR(found.shear_modulus_m, 0.02, 0.002);
}

TEST(LineEstimate, ShearModulusComesFromTheFileColumnThenThePrior) {
  std::string content = linearRows({});
  std::string with_column;
  for (std::size_t at = 0, end; (end = content.find('\n', at)) != std::string::npos; at = end + 1)
    with_column += content.substr(at, end - at) + (at == 0 ? ",shear_modulus_m\n" : ",0.017\n");
  EXPECT_EQ(estimate(with_column, {.method = "linear-offset"}).shear_modulus_m, 0.017);
  const test::TemporaryFile prior{
      "{cohesion_Pa: {mean: 3000, std: 500}, friction_angle_rad: {mean: 0.46, std: 0.1}, sinkage_exponent: "
      "1.0, "
      "cohesive_modulus: 0, frictional_modulus: 1.0e6, shear_modulus_m: 0.023}\n",
      ".yaml"};
  EXPECT_EQ(estimate(content, {.method = "linear-offset", .prior = prior.path()}).shear_modulus_m, 0.023);
}

TEST(LineEstimate, WheelSizesRequireAStatedModulus) {
  EXPECT_THAT([] { estimate(linearRows({}, 0.16), {.method = "linear-offset"}); },
              ThrowsMessage<InputError>(HasSubstr("wheels of several sizes")));
  EXPECT_EQ(estimate(linearRows({}, 0.16), {.method = "linear-offset", .shear_modulus = "0.02"}).rows_used,
            10U);
}

}  // namespace line_estimate_test
}  // namespace talus::terramech
