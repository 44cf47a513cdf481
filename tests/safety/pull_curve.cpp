#include "pull_curve.hpp"

#include <algorithm>
#include <cmath>

namespace safety {
namespace {

constexpr int kRows = 41;
constexpr double kLight = 0.7, kHeavy = 1.1;

double slipOf(int row) {
  return -1.0 + 0.05 * row;
}

LoadedWheel wheelOf(const Rover& rover, double load_share, double slip) {
  return {.radius_m = rover.wheel_radius_m,
          .width_m = rover.wheel_width_m,
          .load_N = load_share * rover.wheelLoad_N(),
          .slip = slip};
}

double referencePull(const Soil& soil, const Rover& rover) {
  return drive(soil, wheelOf(rover, 1.0, PullCurve::kReferenceSlip)).drawbar_pull_N / rover.wheelLoad_N();
}

}  // namespace

PullCurve::PullCurve(const Soil& soil, const Rover& rover) {
  for (int row = 0; row < kRows; ++row)
    for (const double share : {kLight, kHeavy}) {
      const LoadedWheel wheel = wheelOf(rover, share, slipOf(row));
      const WheelAnswer a = drive(soil, wheel);
      (share == kLight ? light_ : heavy_)
          .push_back({.pull = a.drawbar_pull_N / wheel.load_N,
                      .sinkage = a.carried ? a.sinkage_m / wheel.radius_m : 1.0,
                      .torque = a.torque_Nm / (wheel.load_N * wheel.radius_m)});
    }
}

double PullCurve::read(double Row::*field, double slip, double load_share) const {
  const double at = std::clamp((slip + 1.0) / 0.05, 0.0, kRows - 1.0);
  const auto row = std::min<std::size_t>(static_cast<std::size_t>(at), kRows - 2);
  const double t = at - static_cast<double>(row);
  const double light = light_[row].*field * (1.0 - t) + light_[row + 1].*field * t;
  const double heavy = heavy_[row].*field * (1.0 - t) + heavy_[row + 1].*field * t;
  return light + (heavy - light) * (load_share - kLight) / (kHeavy - kLight);
}

double PullCurve::pull(double slip, double load_share) const {
  return read(&Row::pull, slip, load_share);
}
double PullCurve::sinkage(double slip, double load_share) const {
  return read(&Row::sinkage, slip, load_share);
}
double PullCurve::torque(double slip, double load_share) const {
  return read(&Row::torque, slip, load_share);
}

double classDeviation(const SoilPrior& prior, const Rover& rover) {
  double variance = 0.0;
  for (double Soil::*const field :
       {&Soil::cohesion_Pa, &Soil::friction_angle_rad, &Soil::sinkage_exponent, &Soil::cohesive_modulus,
        &Soil::frictional_modulus, &Soil::shear_modulus_m}) {
    const double deviation = prior.deviation.*field;
    if (!(deviation > 0.0)) continue;
    Soil more = prior.mean, less = prior.mean;
    more.*field += 0.5 * deviation;
    less.*field = std::max(less.*field - 0.5 * deviation, 1e-3 * prior.mean.*field);
    const double change =
        (referencePull(more, rover) - referencePull(less, rover)) / (more.*field - less.*field) * deviation;
    variance += change * change;
  }
  return variance > 0.0 ? std::sqrt(variance) : 0.05;
}

}  // namespace safety
