#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <talus/costmap/telemetry/slip_fit.hpp>

namespace talus::costmap {
namespace {

constexpr double kGradientStep = 0.01;  // width of a bin of gradients
constexpr double kIntegralScale = 2.0 / 3.0;

// Prior of the sensor: standard deviations of offset and logarithm of the scale, and probability of a scale
// whose logarithm is uniform over the grid.
struct SensorPrior {
  double bias, log_scale, any_scale;
};
constexpr SensorPrior kAny{0.1, 0.45, 0.1}, kSound{0.03, 0.05, 0.0};
constexpr double kCompressing = 0.1;  // prior probability of a sensor that compresses large slips
constexpr double kExcluded = 0.05;    // such a sensor is excluded below this posterior probability

constexpr double kModelError = 0.02, kSlipNoise = 0.015, kGradientNoise = 0.01;
constexpr double kMostVariance = 1.0;  // greatest variance of a slip, where the curve is flat
constexpr double kLeastShare = 0.02, kLeastSteepness = 0.05;
constexpr std::array<double, 5> kVariations{0.0, 0.35, 0.7, 1.0, 1.4};

// Grid of the posterior.
constexpr std::size_t kBiases = 101, kScales = 41;
constexpr int kDepartures = 73;
constexpr double kMostBias = 0.25, kMostLogScale = 2.3;
constexpr double kLeastDeparture = -6.0, kMostDeparture = 3.0;  // in units of mean_std

// Slip sensor without offset: linear if `knee` is 0, otherwise compressing above the knee (Eq. 3).
struct Sensor {
  double scale = 1.0, knee = 0.0;
  double read(double slip) const noexcept {
    if (knee == 0.0) return scale * slip;
    return std::min(slip, knee) + scale * std::max(slip - knee, 0.0);
  }
};

constexpr int kSlips = 291;
constexpr double kLeastSlip = -0.5, kSlipStep = 0.005;

double biasAt(std::size_t i) noexcept {
  return kMostBias * (2.0 * static_cast<double>(i) / (kBiases - 1) - 1.0);
}
double logScaleAt(std::size_t i) noexcept {
  return -kMostLogScale * static_cast<double>(i) / (kScales - 1);
}
double slipAt(double i) noexcept {
  return kLeastSlip + kSlipStep * i;
}

std::vector<Sensor> linearSensors() {
  std::vector<Sensor> all;
  for (std::size_t i = 0; i < kScales; ++i) all.push_back({.scale = std::exp(logScaleAt(i))});
  return all;
}
std::vector<Sensor> compressingSensors() {
  std::vector<Sensor> all;
  for (const double knee : {0.1, 0.2, 0.3})
    for (const double scale : {0.25, 0.5}) all.push_back({scale, knee});
  return all;
}

}  // namespace

// Mean pull of all wheels of a rover over slip, and their thrust over that of the class at the reference
// slip.
struct SlipFit::Curve {
  std::array<double, kSlips> pull{}, share{};

  Curve(const GroundModel& model, int class_index, int rutted, int wheels) {
    const double in_rut = static_cast<double>(rutted) / wheels;
    const double thrust = model.reference(class_index, false).torque_over_load_radius;
    for (int i = 0; i < kSlips; ++i) {
      const SteadyWheel fresh = model.steady(class_index, {.slip = slipAt(i)});
      const SteadyWheel rut =
          rutted > 0 ? model.steady(class_index, {.slip = slipAt(i), .in_rut = true}) : fresh;
      const auto at = static_cast<std::size_t>(i);
      pull[at] = (1.0 - in_rut) * fresh.gradient + in_rut * rut.gradient;
      share[at] = (1.0 - in_rut) * fresh.torque_over_load_radius + in_rut * rut.torque_over_load_radius;
      share[at] = std::max(share[at] / thrust, kLeastShare);
    }
  }

  // Least slip at which ground with a departure has the pull of a gradient (Eq. 1); the search starts at
  // index `from`.
  double slipOn(double gradient, double departure, std::size_t& from) const {
    const auto at = [&](std::size_t i) { return pull[i] + departure * share[i]; };
    while (from + 2 < pull.size() && at(from + 1) < gradient) ++from;
    const double low = at(from), high = at(from + 1);
    return slipAt(static_cast<double>(from) +
                  (high > low ? std::clamp((gradient - low) / (high - low), 0.0, 1.0) : 1.0));
  }
};

// All moments on ground of one class.
struct SlipFit::OfClass {
  // Readings of one bin of gradients, weighted by the number of squares.
  struct Reading {
    const Curve* curve = nullptr;
    double weight = 0.0, gradient = 0.0, slip = 0.0, scatter = 0.0;
    std::array<double, kVariations.size()> variance{};  // of the slip (Eq. 2)
  };
  // Sums of the likelihood, times the prior of the departure, over departure and variation.
  struct Sums {
    double weight = 0.0, first = 0.0, second = 0.0;
  };
  // Sums for each pair of bias and sensor, relative to exp(greatest).
  struct Table {
    std::vector<Sums> sums;
    double greatest = -std::numeric_limits<double>::infinity();
  };
  // For a given departure, variation and sensor, the log-likelihood is -(a b^2 - 2 f b + q)/2 in the bias b.
  struct Parabola {
    double departure, a, f, q;
    std::size_t sensor;
    double at(double bias) const { return -0.5 * (a * bias * bias - 2.0 * f * bias + q); }
    double greatest() const { return at(std::clamp(f / std::max(a, 1e-12), -kMostBias, kMostBias)); }
  };

  std::size_t index = 0;
  double mean_std = 0.0;
  std::map<std::pair<int, int>, Curve> curves{};
  std::vector<Reading> readings{};

  void add(const GroundModel& model, int rutted, int wheels, Reading reading);
  std::vector<Parabola> parabolas(const std::vector<double>& departures,
                                  const std::vector<Sensor>& sensors) const;
  Table table(const std::vector<double>& departures, const std::vector<Sensor>& sensors) const;
};

void SlipFit::OfClass::add(const GroundModel& model, int rutted, int wheels, Reading reading) {
  const int class_index = static_cast<int>(index);
  const double pull_std = model.parts().classes[index].pull_std;
  const Curve& c = curves.try_emplace({rutted, wheels}, model, class_index, rutted, wheels).first->second;
  const auto at = static_cast<std::size_t>(
      std::clamp((reading.slip - kLeastSlip) / kSlipStep, 1.0, static_cast<double>(kSlips - 2)));
  const double steepness = std::max((c.pull[at + 1] - c.pull[at - 1]) / (2.0 * kSlipStep), kLeastSteepness);
  for (std::size_t t = 0; t < kVariations.size(); ++t) {
    const double place = std::hypot(kVariations[t] * pull_std, kModelError) * c.share[at] / steepness;
    const double slope = kGradientNoise / steepness;
    reading.variance[t] = std::min(place * place + kSlipNoise * kSlipNoise + slope * slope, kMostVariance);
  }
  reading.curve = &c;
  readings.push_back(reading);
}

std::vector<SlipFit::OfClass::Parabola> SlipFit::OfClass::parabolas(
    const std::vector<double>& departures, const std::vector<Sensor>& sensors) const {
  std::vector<Parabola> all;
  std::vector<double> slips(readings.size());
  for (const double departure : departures) {
    std::map<const Curve*, std::size_t> from;
    for (std::size_t k = 0; k < readings.size(); ++k)
      slips[k] = readings[k].curve->slipOn(readings[k].gradient, departure, from[readings[k].curve]);
    const double of_prior = departure * departure / (mean_std * mean_std);
    for (std::size_t t = 0; t < kVariations.size(); ++t)
      for (std::size_t s = 0; s < sensors.size(); ++s) {
        Parabola p{departure, 0.0, 0.0, of_prior, s};
        for (std::size_t k = 0; k < readings.size(); ++k) {
          const Reading& reading = readings[k];
          const double w = reading.weight / reading.variance[t], r = reading.slip - sensors[s].read(slips[k]);
          p.a += w;
          p.f += w * r;
          p.q += w * (r * r + reading.scatter) + reading.weight * std::log(reading.variance[t]);
        }
        all.push_back(p);
      }
  }
  return all;
}

SlipFit::OfClass::Table SlipFit::OfClass::table(const std::vector<double>& departures,
                                                const std::vector<Sensor>& sensors) const {
  constexpr double kNothing = 40.0;  // terms below the greatest log-likelihood by more are ignored
  const std::vector<Parabola> all = parabolas(departures, sensors);
  Table out{.sums = std::vector<Sums>(kBiases * sensors.size())};
  for (const Parabola& p : all) out.greatest = std::max(out.greatest, p.greatest());
  for (const Parabola& p : all) {
    if (p.greatest() < out.greatest - kNothing) continue;
    for (std::size_t b = 0; b < kBiases; ++b) {
      const double log = p.at(biasAt(b)) - out.greatest;
      if (log < -kNothing) continue;
      Sums& sums = out.sums[b * sensors.size() + p.sensor];
      const double w = std::exp(log);
      sums.weight += w;
      sums.first += w * p.departure;
      sums.second += w * p.departure * p.departure;
    }
  }
  return out;
}

namespace {

// Logarithm of the prior of a linear sensor's scale, up to a constant; 0 for a compressing sensor. The scale 1
// at the end of the grid has half the weight (trapezoidal rule).
double logOfScale(const Sensor& sensor, const SensorPrior& prior) {
  if (sensor.knee != 0.0) return 0.0;
  const double s = std::log(sensor.scale) / prior.log_scale;
  const double uniform = std::sqrt(0.5 * std::numbers::pi) * prior.log_scale / kMostLogScale;
  const double density = (1.0 - prior.any_scale) * std::exp(-0.5 * s * s) + prior.any_scale * uniform;
  return std::log(sensor.scale < 1.0 ? density : 0.5 * density);
}

// Posterior of the pairs of bias and sensor, from the prior and all classes.
struct SensorPosterior {
  std::vector<double> weights{};  // the sum is 1
  double log_evidence = 0.0;      // logarithm of the likelihood's mean over the prior
};
template <typename Table>
SensorPosterior weighed(const std::vector<Table>& of_classes, const std::vector<Sensor>& sensors,
                        const SensorPrior& prior) {
  SensorPosterior out{.weights = std::vector<double>(kBiases * sensors.size())};
  double of_prior = 0.0;
  for (std::size_t i = 0; i < out.weights.size(); ++i) {
    const Sensor& sensor = sensors[i % sensors.size()];
    const double b = biasAt(i / sensors.size()) / prior.bias;
    out.weights[i] = -0.5 * b * b + logOfScale(sensor, prior);
    of_prior += std::exp(out.weights[i]);
    for (const Table& table : of_classes) out.weights[i] += std::log(std::max(table.sums[i].weight, 1e-300));
  }
  const double greatest = *std::ranges::max_element(out.weights);
  double all = 0.0;
  for (double& w : out.weights) all += w = std::exp(w - greatest);
  for (double& w : out.weights) w /= all;
  out.log_evidence = greatest + std::log(all / of_prior);
  for (const Table& table : of_classes) out.log_evidence += table.greatest;
  return out;
}

// Mean and standard deviation of the departure.
template <typename Sums>
Estimate departureBy(const std::vector<double>& weights, const std::vector<Sums>& of_class) {
  double mean = 0.0, second = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Sums& sums = of_class[i];
    if (!(sums.weight > 0.0)) continue;
    mean += weights[i] * sums.first / sums.weight;
    second += weights[i] * sums.second / sums.weight;
  }
  return {mean, std::sqrt(std::max(second - mean * mean, 1e-8))};
}

std::vector<double> departuresTo(double mean_std) {
  std::vector<double> out;
  for (int i = 0; i < kDepartures; ++i)
    out.push_back(mean_std * (kLeastDeparture + (kMostDeparture - kLeastDeparture) * i / (kDepartures - 1)));
  return out;
}

}  // namespace

void SlipFit::take(const Moment& moment) {
  if (!std::isfinite(moment.gradient + moment.slip + moment.place.x_m + moment.place.y_m)) return;
  const double side_m = kIntegralScale * model_.parts().policy.correlation_length_m;
  const auto step = [](double value, double of) {
    return static_cast<int>(std::clamp(std::floor(value / of), -1e9, 1e9));
  };
  Sum& sum =
      sums_[{moment.class_index, moment.rutted, moment.wheels, moment.run, step(moment.place.x_m, side_m),
             step(moment.place.y_m, side_m), step(moment.gradient, kGradientStep)}];
  sum.count += 1.0;
  sum.gradient += moment.gradient;
  sum.slip += moment.slip;
  ++moments_;
}

SlipFit::OfClass SlipFit::ofClass(int class_index,
                                  const std::function<double(const std::string&)>& excess) const {
  std::map<std::pair<int, int>, double> of_square;
  for (const auto& [key, sum] : sums_)
    if (std::get<0>(key) == class_index) of_square[{std::get<4>(key), std::get<5>(key)}] += sum.count;
  struct Weighed {
    double weight = 0.0, gradient = 0.0, slip = 0.0, squares = 0.0;
  };
  std::map<std::tuple<int, int, int>, Weighed> by_gradient;
  for (const auto& [key, sum] : sums_) {
    const auto& [of_class, rutted, wheels, run, x, y, gradient] = key;
    if (of_class != class_index) continue;
    const double weight = sum.count / of_square[{x, y}], slip = sum.slip / sum.count;
    const double steep = sum.gradient / sum.count - std::max(excess(run), 0.0);
    Weighed& w = by_gradient[{rutted, wheels, static_cast<int>(std::floor(steep / kGradientStep))}];
    w.weight += weight;
    w.gradient += weight * steep;
    w.slip += weight * slip;
    w.squares += weight * slip * slip;
  }
  const auto index = static_cast<std::size_t>(class_index);
  OfClass out{.index = index, .mean_std = model_.parts().classes[index].mean_std};
  for (const auto& [key, w] : by_gradient) {
    const double slip = w.slip / w.weight;
    out.add(model_, std::get<0>(key), std::get<1>(key),
            {.weight = w.weight,
             .gradient = w.gradient / w.weight,
             .slip = slip,
             .scatter = std::max(w.squares / w.weight - slip * slip, 0.0)});
  }
  return out;
}

std::shared_ptr<const SlipPosterior> SlipFit::fitted(
    const std::function<double(const std::string& run)>& excess) const {
  const std::size_t classes = model_.parts().classes.size();
  auto out = std::make_shared<SlipPosterior>();
  out->departure.assign(classes, {0.0, std::numeric_limits<double>::infinity()});
  out->caution.assign(classes, 0.0);
  for (const GroundClass& ground : model_.parts().classes) out->learned.push_back({0.0, ground.mean_std});
  out->if_sound = out->learned;
  std::vector<OfClass> driven;
  for (std::size_t c = 0; c < classes; ++c)
    if (OfClass one = ofClass(static_cast<int>(c), excess); !one.readings.empty())
      driven.push_back(std::move(one));
  if (driven.empty()) return out;
  const std::vector<Sensor> linear = linearSensors(), compressing = compressingSensors();
  std::vector<OfClass::Table> anywhere, compressed, there;
  for (const OfClass& one : driven) {
    anywhere.push_back(one.table(departuresTo(one.mean_std), linear));
    compressed.push_back(one.table(departuresTo(one.mean_std), compressing));
  }
  const SensorPosterior any = weighed(anywhere, linear, kAny), sound = weighed(anywhere, linear, kSound);
  const SensorPosterior bent = weighed(compressed, compressing, kAny);
  const double odds = std::exp(any.log_evidence - bent.log_evidence) * (1.0 - kCompressing) / kCompressing;
  out->compressing = 1.0 / (1.0 + odds);
  for (std::size_t k = 0; k < driven.size(); ++k) {
    const std::size_t c = driven[k].index;
    const Estimate found = out->learned[c] = departureBy(any.weights, anywhere[k].sums);
    out->if_sound[c] = departureBy(sound.weights, anywhere[k].sums);
    const double left = 1.0 / (found.std * found.std) - 1.0 / (driven[k].mean_std * driven[k].mean_std);
    out->departure[c].value = found.value;
    if (left > 0.0) out->departure[c].std = 1.0 / std::sqrt(left);
    out->caution[c] = std::clamp(found.value, 0.0, found.std);
    if (out->compressing > kExcluded) {
      const Estimate other = departureBy(bent.weights, compressed[k].sums);
      const double least = std::max(other.value - other.std, 0.0);
      out->caution[c] = std::max(out->caution[c], std::max(found.value, 0.0) - least);
    }
    there.push_back(driven[k].table({found.value}, linear));
  }
  const SensorPosterior sensor = weighed(there, linear, kAny);
  out->slip_bias = out->slip_scale = 0.0;
  for (std::size_t i = 0; i < sensor.weights.size(); ++i) {
    out->slip_bias += sensor.weights[i] * biasAt(i / kScales);
    out->slip_scale += sensor.weights[i] * linear[i % kScales].scale;
  }
  return out;
}

}  // namespace talus::costmap
