#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <talus/costmap/telemetry/slip_fit.hpp>

namespace talus::costmap {
namespace {

constexpr double kGradientStep = 0.01;  // width of a bin of gradients
constexpr double kIntegralScale = 2.0 / 3.0;

// Standard deviations of the prior of the sensor.
struct SensorPrior {
  double bias, log_scale;
};
constexpr SensorPrior kAny{0.1, 0.45}, kSound{0.03, 0.05};

constexpr double kModelError = 0.02, kSlipNoise = 0.015, kGradientNoise = 0.01;
constexpr double kMostVariance = 1.0;  // greatest variance of a slip, where the curve is flat
constexpr double kLeastShare = 0.02, kLeastSteepness = 0.05;
constexpr std::array<double, 5> kVariations{0.0, 0.35, 0.7, 1.0, 1.4};

// Grid of the posterior.
constexpr std::size_t kBiases = 101, kScales = 33;
constexpr int kDepartures = 73;
constexpr double kMostBias = 0.25, kMostLogScale = 1.6;
constexpr double kLeastDeparture = -6.0, kMostDeparture = 3.0;  // in units of mean_std

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
  // Sums of the posterior over departure and variation, for one pair of bias and scale.
  struct Sums {
    double weight = 0.0, first = 0.0, second = 0.0;
  };
  // For a given departure, variation and scale, the log-likelihood is -(a b^2 - 2 f b + q)/2 in the bias b.
  struct Parabola {
    double departure, a, f, q;
    std::size_t scale;
    double at(double bias) const { return -0.5 * (a * bias * bias - 2.0 * f * bias + q); }
    double greatest() const { return at(std::clamp(f / std::max(a, 1e-12), -kMostBias, kMostBias)); }
  };

  std::size_t index = 0;
  double mean_std = 0.0;
  std::map<std::pair<int, int>, Curve> curves{};
  std::vector<Reading> readings{};

  void add(const GroundModel& model, int rutted, int wheels, Reading reading);
  std::vector<Parabola> parabolas(const std::vector<double>& departures) const;
  std::vector<Sums> sums(const std::vector<double>& departures) const;
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
    const std::vector<double>& departures) const {
  std::vector<Parabola> all;
  std::vector<double> slips(readings.size());
  for (const double departure : departures) {
    std::map<const Curve*, std::size_t> from;
    for (std::size_t k = 0; k < readings.size(); ++k)
      slips[k] = readings[k].curve->slipOn(readings[k].gradient, departure, from[readings[k].curve]);
    const double of_prior = departure * departure / (mean_std * mean_std);
    for (std::size_t t = 0; t < kVariations.size(); ++t)
      for (std::size_t s = 0; s < kScales; ++s) {
        const double scale = std::exp(logScaleAt(s));
        Parabola p{departure, 0.0, 0.0, of_prior, s};
        for (std::size_t k = 0; k < readings.size(); ++k) {
          const Reading& reading = readings[k];
          const double w = reading.weight / reading.variance[t], r = reading.slip - scale * slips[k];
          p.a += w;
          p.f += w * r;
          p.q += w * (r * r + reading.scatter) + reading.weight * std::log(reading.variance[t]);
        }
        all.push_back(p);
      }
  }
  return all;
}

std::vector<SlipFit::OfClass::Sums> SlipFit::OfClass::sums(const std::vector<double>& departures) const {
  constexpr double kNothing = 40.0;  // terms below the greatest log-likelihood by more are ignored
  const std::vector<Parabola> all = parabolas(departures);
  double greatest = -std::numeric_limits<double>::infinity();
  for (const Parabola& p : all) greatest = std::max(greatest, p.greatest());
  std::vector<Sums> out(kBiases * kScales);
  for (const Parabola& p : all) {
    if (p.greatest() < greatest - kNothing) continue;
    for (std::size_t b = 0; b < kBiases; ++b) {
      const double log = p.at(biasAt(b)) - greatest;
      if (log < -kNothing) continue;
      Sums& sums = out[b * kScales + p.scale];
      const double w = std::exp(log);
      sums.weight += w;
      sums.first += w * p.departure;
      sums.second += w * p.departure * p.departure;
    }
  }
  return out;
}

namespace {

// Posterior weight of each pair of bias and scale, from the prior and all classes; the sum is 1.
template <typename Sums>
std::vector<double> weighed(const std::vector<std::vector<Sums>>& of_classes, const SensorPrior& prior) {
  std::vector<double> weights(kBiases * kScales);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double b = biasAt(i / kScales) / prior.bias, s = logScaleAt(i % kScales) / prior.log_scale;
    weights[i] = -0.5 * (b * b + s * s);
    for (const auto& sums : of_classes) weights[i] += std::log(std::max(sums[i].weight, 1e-300));
  }
  const double greatest = *std::ranges::max_element(weights);
  double all = 0.0;
  for (double& w : weights) all += w = std::exp(w - greatest);
  for (double& w : weights) w /= all;
  return weights;
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
  std::vector<std::vector<OfClass::Sums>> anywhere, there;
  for (const OfClass& one : driven) anywhere.push_back(one.sums(departuresTo(one.mean_std)));
  const std::vector<double> any = weighed(anywhere, kAny), sound = weighed(anywhere, kSound);
  for (std::size_t k = 0; k < driven.size(); ++k) {
    const std::size_t c = driven[k].index;
    const Estimate found = out->learned[c] = departureBy(any, anywhere[k]);
    out->if_sound[c] = departureBy(sound, anywhere[k]);
    const double left = 1.0 / (found.std * found.std) - 1.0 / (driven[k].mean_std * driven[k].mean_std);
    out->departure[c].value = found.value;
    if (left > 0.0) out->departure[c].std = 1.0 / std::sqrt(left);
    out->caution[c] = std::clamp(found.value, 0.0, found.std);
    there.push_back(driven[k].sums({found.value}));
  }
  const std::vector<double> sensor = weighed(there, kAny);
  out->slip_bias = out->slip_scale = 0.0;
  for (std::size_t i = 0; i < sensor.size(); ++i) {
    out->slip_bias += sensor[i] * biasAt(i / kScales);
    out->slip_scale += sensor[i] * std::exp(logScaleAt(i % kScales));
  }
  return out;
}

}  // namespace talus::costmap
