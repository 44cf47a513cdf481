#include <cmath>

#include <talus/terramech/contact/contact_geometry.hpp>
#include <talus/terramech/contact/linear_stress.hpp>

namespace talus::terramech {
namespace linear_stress_test {

// Simpson's rule over [a, b], 400 intervals: error below 1e-11 for these integrands.
template <class F>
double integral(F&& f, double a, double b) {
  constexpr int kIntervals = 400;
  const double step = (b - a) / kIntervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(a + i * step);
  return sum * step / 3.0;
}

TEST(LinearStressMoments, MomentsEqualTheirIntegrals) {
  // Closed form, checked by quadrature; the last moment is the corrected offset term of Eq. 2.3.
  for (const double theta_1 : {0.01, 0.3, 0.9, 1.5}) {
    const LinearStressMoments m(theta_1);
    const double h = 0.5 * theta_1;
    const auto triangle = [&](double t) { return t < h ? t / h : (theta_1 - t) / h; };
    const auto offset = [&](double t) { return 1.0 - t / h; };
    const auto over = [&](auto weight, auto part) { return [=](double t) { return weight(t) * part(t); }; };
    const auto cosine = [](double t) { return std::cos(t); };
    const auto sine = [](double t) { return std::sin(t); };
    EXPECT_NEAR(m.peak_cos,
                integral(over(triangle, cosine), 0, h) + integral(over(triangle, cosine), h, theta_1), 1e-10);
    EXPECT_NEAR(m.peak_sin, integral(over(triangle, sine), 0, h) + integral(over(triangle, sine), h, theta_1),
                1e-10);
    EXPECT_NEAR(m.offset_cos, integral(over(offset, cosine), 0, h), 1e-10);
    EXPECT_NEAR(m.offset_sin, integral(over(offset, sine), 0, h), 1e-10);
  }
}

TEST(LinearStressMoments, PrintedOffsetTermOfEquation23DiffersFromTheIntegral) {
  // Printed in: thesis Eq. 2.3, cos(theta_m) - sin(theta_m)/theta_m + theta_m. Found wrong.
  const LinearStressMoments m(0.8);
  const double printed = std::cos(0.4) - std::sin(0.4) / 0.4 + 0.4;
  EXPECT_GT(std::abs(printed - m.offset_sin), 0.2);
}

TEST(Mobilisation, IsJanosiHanamotoAtMidContactAndBottom) {
  // Closed form: Eqs. C.6, C.7 at theta_1/2 and 0.
  const Wheel wheel{.radius_m = 0.1, .width_m = 0.1};
  const WheelSample sample{.load_N = 80, .torque_Nm = 3, .sinkage_m = 0.02, .slip = 0.4};
  const double theta_1 = entryAngle_rad(wheel, sample.sinkage_m);
  const auto share = [&](double theta) {
    const double j = 0.1 * (theta_1 - theta - 0.6 * (std::sin(theta_1) - std::sin(theta)));
    return 1.0 - std::exp(-j / 0.02);
  };
  EXPECT_NEAR(mobilisation(wheel, sample, 0.02).peak, share(0.5 * theta_1), 1e-14);
  EXPECT_NEAR(mobilisation(wheel, sample, 0.02).bottom, share(0.0), 1e-14);
}

}  // namespace linear_stress_test
}  // namespace talus::terramech
