#include <cmath>
#include <string>

#include <talus/common/common.hpp>
#include <talus/terramech/calibration/tables/line_estimate.hpp>

#include "calibration/wheel_table.hpp"
#include "linear_world.hpp"
#include "temporary_file.hpp"

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
namespace plate_estimate_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

// Rows of tau = (c + sigma tan phi)(1 - e^{-j/K}) with c = 900 Pa, tan phi = 0.6, K = 0.015 m.
std::string shearRows() {
  std::string text = "normal_stress_Pa,shear_stress_Pa,shear_displacement_m\n";
  for (const double sigma : {1000.0, 3000.0, 8000.0})
    for (const double j : {0.004, 0.012, 0.03})
      text += number(sigma) + "," + number((900.0 + 0.6 * sigma) * -std::expm1(-j / 0.015)) + "," +
              number(j) + "\n";
  return text;
}

// Rows of p = (k_c/b + k_phi) z^n with k_phi = 4e5, n = 0.8, b = 50, 80 and 120 mm.
std::string plateRows(double cohesive_modulus) {
  std::string text = "plate_width_m,pressure_Pa,sinkage_m\n";
  for (const double b : {0.05, 0.08, 0.12})
    for (const double z : {0.005, 0.01, 0.02, 0.03})
      text +=
          number(b) + "," + number((cohesive_modulus / b + 4e5) * std::pow(z, 0.8)) + "," + number(z) + "\n";
  return text;
}

SoilEstimate estimate(const std::string& content, EstimateOptions options = {}) {
  const test::TemporaryFile file{content};
  options.table = file.path();
  options.method = "bevameter";
  return plateEstimate(options, {});
}

TEST(PlateEstimate, ExactShearTestsRecoverTheSoil) {
  const SoilEstimate found = estimate(shearRows());
  EXPECT_EQ(found.rows_used, 9U);
  EXPECT_NEAR(found.cohesion_Pa, 900.0, 0.01);
  EXPECT_NEAR(found.tan_friction, 0.6, 1e-6);
  EXPECT_NEAR(found.shear_modulus_m, 0.015, 1e-7);
  // Closed form: divided by the mobilised share, every point lies on the line.
  ASSERT_EQ(found.points.size(), 9U);
  for (const StressPair& p : found.points) EXPECT_NEAR(p.shear_Pa, 900.0 + 0.6 * p.normal_Pa, 0.05);
}

TEST(PlateEstimate, ExactPlateTestsRecoverTheModuli) {
  const SoilEstimate found = estimate(plateRows(2000.0));
  EXPECT_NEAR(found.sinkage_exponent, 0.8, 1e-9);
  ASSERT_TRUE(found.cohesive_modulus && found.frictional_modulus);
  EXPECT_NEAR(*found.cohesive_modulus, 2000.0, 1e-3);
  EXPECT_NEAR(*found.frictional_modulus, 4e5, 0.1);
  EXPECT_EQ(found.plates.size(), 3U);
  EXPECT_TRUE(found.warnings.empty());
  EXPECT_TRUE(std::isnan(found.cohesion_Pa));  // pressure tests do not determine the cohesion
}

TEST(PlateEstimate, NegativeOrUnidentifiableModuliAreReported) {
  EXPECT_THAT(estimate(plateRows(-2000.0)).warnings, ElementsAre(HasSubstr("k_c < 0")));
  EXPECT_THAT(estimate(plateRows(0.0), {.plate_width_m = 0.1}).unseen,
              ElementsAre(HasSubstr("cohesive_modulus, frictional_modulus")));
}

TEST(PlateEstimate, PriorAppliesToShearTestsOnly) {
  const test::TemporaryFile prior{
      "{cohesion_Pa: {mean: 2000, std: 100}, friction_angle_rad: {mean: 0.5, std: 0.3}, sinkage_exponent: "
      "1.0, "
      "cohesive_modulus: 0, frictional_modulus: 1.0e6, shear_modulus_m: 0.02}\n",
      ".yaml"};
  EXPECT_NEAR(estimate(shearRows(), {.prior = prior.path()}).cohesion_Pa, 900.0,
              1.0);  // exact rows reduce the standard deviation
  EXPECT_THAT([&] { estimate(plateRows(0.0), {.prior = prior.path()}); },
              ThrowsMessage<InputError>(HasSubstr("the table has no shear test")));
}

}  // namespace plate_estimate_test

}  // namespace talus::terramech
