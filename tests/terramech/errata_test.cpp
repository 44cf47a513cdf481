// Printing errors of the thesis, each demonstrated by quadrature or by other equations of the thesis.
// docs/validation.md has the list.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <thesis_runs.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {
namespace errata_test {

constexpr double kTheta1 = 0.8;
constexpr double kThetaM = 0.4;

template <class F>
double integral(F&& f, double a, double b) {  // Simpson, 2000 intervals: below 1e-12 here
  constexpr int kIntervals = 2000;
  const double step = (b - a) / kIntervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(a + i * step);
  return sum * step / 3.0;
}

TEST(Errata, Equation23OffsetTerm) {
  const double truth = integral([](double t) { return (1.0 - t / kThetaM) * std::sin(t); }, 0.0, kThetaM);
  EXPECT_NEAR(1.0 - std::sin(kThetaM) / kThetaM, truth, 1e-12);
  EXPECT_GT(std::abs(std::cos(kThetaM) - std::sin(kThetaM) / kThetaM + kThetaM - truth), 0.1);  // as printed
}

TEST(Errata, Equation29FollowsFromTheCorrectedFormOnly) {
  // M1 of Eq. 2.10 as printed, from W and T of stresses with tau_offset; with the corrected Eq. 2.3, identity
  // 2.9 is satisfied.
  const Wheel wheel = kThesisWheel;
  const double z = sinkage_m(wheel, kTheta1), c = 4000.0, t = 0.5, sigma_m = 18000.0, k = 0.02;
  WheelSample s{.load_N = 0.0, .torque_Nm = 0.0, .sinkage_m = z, .slip = 0.5};
  const auto [a, b] = mobilisation(wheel, s, k);
  const double tau_m = (c + sigma_m * t) * a, tau_o = c * b;
  const LinearStressMoments m(kTheta1);
  s.torque_Nm = 0.1 * 0.01 * (0.5 * kTheta1 * tau_m + 0.5 * kThetaM * tau_o);
  const auto miss = [&](double offset_term) {
    s.load_N = 0.01 * (m.peak_cos * sigma_m + m.peak_sin * tau_m + offset_term * tau_o);
    const LinearOffsetCoefficients q = linearOffset(wheel, s, k);
    return std::abs(q.m1 * c * t + c + q.m3_Pa * t - q.m4_Pa);
  };
  EXPECT_LT(miss(1.0 - std::sin(kThetaM) / kThetaM), 1e-6);
  EXPECT_GT(miss(std::cos(kThetaM) - std::sin(kThetaM) / kThetaM + kThetaM), 100.0);
}

TEST(Errata, EntryAngleIsAnArccosine) {
  // Sinkage over radius z/r = 1/2 gives 60 degrees (stated in the thesis after Eq. 3.12); arctan(1 - z/r)
  // would be 27 degrees.
  EXPECT_NEAR(entryAngle_rad(kThesisWheel, 0.05), std::acos(0.5), 1e-15);
  EXPECT_GT(std::abs(std::atan(0.5) - std::acos(0.5)), 0.5);
}

TEST(Errata, SinkageIsQuadraticInEntryAngleForSmallAngles) {
  const double theta_1 = 0.05;
  EXPECT_NEAR(sinkage_m(kThesisWheel, theta_1) / 0.1 / (0.5 * theta_1 * theta_1), 1.0, 1e-3);
}

TEST(Errata, Equation312CollapsesExactly) {
  for (const double t1 : {0.2, 0.7, 1.2}) {
    const double p = 2.0 * std::cos(0.5 * t1) - std::cos(t1) - 1.0,
                 q = 2.0 * std::sin(0.5 * t1) - std::sin(t1);
    const double sinc = std::sin(0.25 * t1) / (0.25 * t1);
    EXPECT_NEAR(q / p, std::tan(0.5 * t1), 1e-12);
    EXPECT_NEAR((p * p + q * q) / p * 4.0 / (t1 * t1), sinc * sinc / std::cos(0.5 * t1), 1e-12);
  }
}

TEST(Errata, Equation314FactorToSecondOrder) {
  const auto exact = [](double t1) {
    return std::pow(std::sin(0.25 * t1) / (0.25 * t1), 2) / std::cos(0.5 * t1);
  };
  EXPECT_NEAR((exact(0.01) - 1.0) / 1e-4, 5.0 / 48.0, 1e-4);  // printed: 1/4
  // Values at 60 degrees: exact 1.129, printed expansion 1.274, correct expansion 1.114, used in the thesis
  // 1.
  EXPECT_NEAR(exact(std::acos(0.5)), 1.129, 5e-4);
}

TEST(Errata, TorqueIsTheRadiusTimesTheShear) {
  // Eqs. 3.8, B.4: the last line, r^2 b theta_1 tau_m / 2, is r times the integral of tau over the area r b d
  // theta.
  const double r = 0.1, b = 0.1, tau_m = 5000.0;
  const auto triangle = [&](double t) { return tau_m * (1.0 - std::abs(2.0 * t / kTheta1 - 1.0)); };
  const double shear = integral(triangle, 0.0, 0.4) + integral(triangle, 0.4, 0.8);
  EXPECT_NEAR(r * r * b * shear, r * r * b * kTheta1 * tau_m / 2.0, 1e-12);
}

TEST(Errata, PeakAngleIsNotHalfTheEntryAngle) {
  // c1 + c2 i over slip 0.2 to 0.8 with Table 2.1's 0.43 and 0.32: 0.494 to 0.686, printed "around 0.5".
  EXPECT_NEAR(0.43 + 0.32 * 0.2, 0.494, 1e-12);
  EXPECT_NEAR(0.43 + 0.32 * 0.8, 0.686, 1e-12);
}

TEST(Errata, MobilisationTermsDifferFromOneOverTable21) {
  // App. D.2 assumes B = 1 and A(i_max) = 1. Over Table 2.1 the medians are about 0.66 for A at slip 0.8 and
  // 0.42 for B at slip 0.2.
  ThesisRuns runs(1);
  std::vector<double> a, b;
  for (int k = 0; k < 101; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    a.push_back(mobilisation(kThesisWheel, run.truth[6], run.soil.shear_modulus_m).peak);
    b.push_back(mobilisation(kThesisWheel, run.truth[0], run.soil.shear_modulus_m).bottom);
  }
  std::nth_element(a.begin(), a.begin() + 50, a.end());
  std::nth_element(b.begin(), b.begin() + 50, b.end());
  EXPECT_NEAR(a[50], 0.66, 0.06);
  EXPECT_NEAR(b[50], 0.42, 0.06);
}

TEST(Errata, TopsoilOfSection35IsNotSafeByEquation321) {
  const auto limits = thresholds({.slope_rad = 10.0 * kDegree, .margin_rad = 0.0});
  for (const auto& [torque, sinkage] : {std::pair{0.1, 0.2}, std::pair{0.3, 0.4}}) {
    const WheelSample s{.load_N = 80.0, .torque_Nm = 8.0 * torque, .sinkage_m = 0.1 * sinkage, .slip = 0.5};
    const double pull = kThesisPlane.at(kThesisWheel, s);
    EXPECT_NEAR(pull, -0.2, 1e-12);
    EXPECT_EQ(categorise({.drawbar_pull_over_load = pull, .sinkage_over_radius = sinkage}, limits),
              Category::Dangerous);
  }
}

}  // namespace errata_test
}  // namespace talus::terramech
