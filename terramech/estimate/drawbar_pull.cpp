#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <talus/terramech/contact/rim_contact.hpp>
#include <talus/terramech/contact/wheel_on_soil.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

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

namespace {

// Draws with a weight below this fraction of the mean weight are neglected.
constexpr double kLightest = 1e-3;

Estimate meanOf(const PairMoments& m) {
  return {.value = m.x, .std = std::sqrt(m.xx / m.weight)};
}

struct SolvedWheel {
  double pull_over_load = 0.0;
  double sinkage_over_radius = 1.0;
};

SolvedWheel reply(const Wheel& wheel, const Soil& soil, const WheelOperation& operation) {
  try {
    const WheelForces f = equilibrium(soil, wheel, operation);
    return {f.drawbar_pull_N / operation.load_N, f.sinkage_m / wheel.radius_m};
  } catch (const std::domain_error&) {  // sunk to the axle
    return {};
  }
}

// Systematic resampling: soils at equal steps of the cumulative weight.
std::vector<const ContactSoil*> evenly(const std::vector<SoilDraw>& draws, int count) {
  std::vector<const ContactSoil*> chosen;
  double sum = 0.0;
  for (const SoilDraw& d : draws) {
    sum += d.weight;
    while (static_cast<double>(chosen.size()) + 0.5 < sum * count &&
           static_cast<int>(chosen.size()) < count) {
      chosen.push_back(&d.soil);
    }
  }
  return chosen;
}

constexpr double kStep = 0.01;  // step of ln W

Estimate between(const Estimate& a, const Estimate& b, double share) {
  return {.value = std::lerp(a.value, b.value, share), .std = std::lerp(a.std, b.std, share)};
}

}  // namespace

Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample, const SoilPosterior& posterior,
                      const ReadingErrors& noise) {
  const SoilClass any;
  const SoilObjective objective(any, {noise, 0.0});
  const double lightest = kLightest / static_cast<double>(posterior.draws.size());
  PairMoments pull;
  for (const SoilDraw& d : posterior.draws) {
    if (d.weight < lightest) continue;
    const ForceVector f = contactForces(d.soil, wheel, objective.likelyState(d.soil, {wheel, sample}));
    pull.add(f[kPull] / f[kLoad], 0.0, d.weight);
  }
  return meanOf(pull);
}

PullForecast forecastPull(const Wheel& wheel, const SoilPosterior& posterior,
                          const PullForecastOptions& options) {
  const RangeCheck range("pull forecast");
  range.above("load_N", options.load_N, 0.0);
  range.above("reference_slip", options.reference_slip, 0.0);
  range.within("reference_slip", options.reference_slip, {0.0, 1.0});
  range.atLeast("draws", options.draws, 1);
  PairMoments reference, most, slip_of_most, sinkage;
  for (const ContactSoil* drawn : evenly(posterior.draws, options.draws)) {
    const Soil soil = soilOf(*drawn);
    const SolvedWheel at = reply(wheel, soil, {.load_N = options.load_N, .slip = options.reference_slip});
    reference.add(at.pull_over_load, 0.0);
    sinkage.add(at.sinkage_over_radius, 0.0);
    double best = -1e9;
    double best_slip = 0.0;
    for (const double slip : kForecastSlips) {
      const double pull = reply(wheel, soil, {.load_N = options.load_N, .slip = slip}).pull_over_load;
      if (pull > best) best = pull, best_slip = slip;
    }
    most.add(best, 0.0);
    slip_of_most.add(best_slip, 0.0);
  }
  return {.at_reference = meanOf(reference),
          .most = meanOf(most),
          .most_slip = slip_of_most.x,
          .sinkage_over_radius = meanOf(sinkage),
          .climbable_slope_rad = climbableSlope_rad(meanOf(most))};
}

const PullForecast& PullForecasts::solved(const Wheel& wheel, int step) {
  const auto [place, added] = kept_.try_emplace({wheel.radius_m, wheel.width_m, step});
  if (added) {
    place->second =
        forecastPull(wheel, soil_, {.load_N = std::exp(kStep * step), .reference_slip = reference_slip_});
  }
  return place->second;
}

PullForecast PullForecasts::at(const Wheel& wheel, double load_N) {
  const double place = std::log(load_N) / kStep;
  const double below = std::floor(place);
  const PullForecast& a = solved(wheel, static_cast<int>(below));
  const PullForecast& b = solved(wheel, static_cast<int>(below) + 1);
  const double share = place - below;
  return {.at_reference = between(a.at_reference, b.at_reference, share),
          .most = between(a.most, b.most, share),
          .most_slip = std::lerp(a.most_slip, b.most_slip, share),
          .sinkage_over_radius = between(a.sinkage_over_radius, b.sinkage_over_radius, share),
          .climbable_slope_rad = between(a.climbable_slope_rad, b.climbable_slope_rad, share)};
}

}  // namespace talus::terramech
