#include <algorithm>
#include <cmath>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace {

double entryOf(const Wheel& wheel, const WheelSample& sample) {
  RangeCheck("drawbar pull").above("load_N", sample.load_N, 0.0);
  return entryAngle_rad(wheel, sample.sinkage_m);
}

// Standard deviation of the estimate due to one reading: central difference quotient times std.
double effect(const Wheel& wheel, const WheelSample& sample, double WheelSample::*field, double std,
              const PullAngleModel& model) {
  if (!(std > 0.0)) return 0.0;
  const auto moved = [&](double step) {
    WheelSample s = sample;
    s.*field += step;
    return pullOfSingleForce(wheel, s, model.angle_rad(wheel, s));
  };
  const double step = field == &WheelSample::sinkage_m ? std::min(std, 0.5 * sample.sinkage_m) : 1e-3 * std;
  return (moved(step) - moved(-step)) / (2.0 * step) * std;
}

}  // namespace

double torqueOverLoadRadius(const Wheel& wheel, const WheelSample& sample) {
  RangeCheck("drawbar pull").above("load_N", sample.load_N, 0.0);
  return sample.torque_Nm / (wheel.radius_m * sample.load_N);
}

double pullOfSingleForce(const Wheel& wheel, const WheelSample& sample, double theta_rad) {
  return torqueOverLoadRadius(wheel, sample) / std::cos(theta_rad) - std::tan(theta_rad);
}

double pullAtSmallAngle(const Wheel& wheel, const WheelSample& sample) {
  return torqueOverLoadRadius(wheel, sample) - 0.5 * entryOf(wheel, sample);
}

double pullOfTriangularStress(const Wheel& wheel, const WheelSample& sample) {
  const double theta_1 = entryOf(wheel, sample);
  const double quarter = 0.25 * theta_1;
  const double sinc = quarter > 0.0 ? std::sin(quarter) / quarter : 1.0;
  return sinc * sinc / std::cos(0.5 * theta_1) * torqueOverLoadRadius(wheel, sample) -
         std::tan(0.5 * theta_1);
}

double PullPlane::at(const Wheel& wheel, const WheelSample& sample) const {
  return c1 * torqueOverLoadRadius(wheel, sample) + c2 * sample.sinkage_m / wheel.radius_m + c3;
}

double PullAngleModel::angle_rad(const Wheel& wheel, const WheelSample& sample) const {
  const double theta_1 = entryOf(wheel, sample);
  return (a0 + a1 * sample.slip + a2 * theta_1 + a3 * torqueOverLoadRadius(wheel, sample)) * theta_1;
}

Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample, const ReadingErrors& noise,
                      const PullAngleModel& model) {
  const double value = pullOfSingleForce(wheel, sample, model.angle_rad(wheel, sample));
  const double load = effect(wheel, sample, &WheelSample::load_N, noise.load.std(sample.load_N), model);
  const double torque =
      effect(wheel, sample, &WheelSample::torque_Nm, noise.torque.std(sample.torque_Nm), model);
  const double sinkage =
      effect(wheel, sample, &WheelSample::sinkage_m, noise.sinkage.std(sample.sinkage_m), model);
  const double slip = effect(wheel, sample, &WheelSample::slip, noise.slip.std(sample.slip), model);
  return {.value = value, .std = std::hypot(std::hypot(load, torque), std::hypot(sinkage, slip), model.std)};
}

Estimate climbableSlope_rad(const Estimate& pull_over_load) {
  const double p = pull_over_load.value;
  return {.value = std::atan(p), .std = pull_over_load.std / (1.0 + p * p)};
}

}  // namespace talus::terramech
