#include "pull_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
          .slip = slip,
          .gravity_m_s2 = rover.gravity_m_s2};
}

double referencePull(const Soil& soil, const Rover& rover) {
  return drive(soil, wheelOf(rover, 1.0, PullCurve::kReferenceSlip)).drawbar_pull_N / rover.wheelLoad_N();
}

}  // namespace

double PullCurve::angle_rad(std::size_t node) {
  return kAngles_deg[node] * std::numbers::pi / 180.0;
}

PullCurve::PullCurve(const Soil& soil, const Rover& rover) {
  for (std::size_t angle = 0; angle < kAngles_deg.size(); ++angle)
    for (int row = 0; row < kRows; ++row)
      for (const double share : {kLight, kHeavy}) {
        LoadedWheel wheel = wheelOf(rover, share, slipOf(row));
        wheel.slip_angle_rad = angle_rad(angle);
        const WheelAnswer a = drive(soil, wheel);
        (share == kLight ? light_ : heavy_)[angle].push_back(
            {.pull = a.drawbar_pull_N / wheel.load_N,
             .sinkage = a.carried ? a.sinkage_m / wheel.radius_m : 1.0,
             .torque = a.torque_Nm / (wheel.load_N * wheel.radius_m),
             .side = a.side_force_N / wheel.load_N});
      }
}

double PullCurve::read(double Row::*field, const Use& use) const {
  const double at = std::clamp((use.slip + 1.0) / 0.05, 0.0, kRows - 1.0);
  const auto row = std::min<std::size_t>(static_cast<std::size_t>(at), kRows - 2);
  const double t = at - static_cast<double>(row);
  const std::vector<Row>&less = light_[use.angle], &more = heavy_[use.angle];
  const double light = less[row].*field * (1.0 - t) + less[row + 1].*field * t;
  const double heavy = more[row].*field * (1.0 - t) + more[row + 1].*field * t;
  return light + (heavy - light) * (use.load_share - kLight) / (kHeavy - kLight);
}

double PullCurve::pull(double slip, double load_share, std::size_t angle) const {
  return read(&Row::pull, {slip, load_share, angle});
}
double PullCurve::side(double slip, double load_share, std::size_t angle) const {
  return read(&Row::side, {slip, load_share, angle});
}
double PullCurve::sinkage(double slip, double load_share, std::size_t angle) const {
  return read(&Row::sinkage, {slip, load_share, angle});
}
double PullCurve::torque(double slip, double load_share, std::size_t angle) const {
  return read(&Row::torque, {slip, load_share, angle});
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
