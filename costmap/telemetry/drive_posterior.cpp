#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include <talus/costmap/telemetry/drive_posterior.hpp>

namespace talus::costmap {
namespace {

constexpr int kParts = DriveEstimate::kParts;
constexpr std::size_t kChunk = 16;      // moments of one chunk
constexpr double kGradientStep = 0.01;  // width of a bin of gradients
constexpr double kIntegralScale = 2.0 / 3.0;
constexpr double kModelError = 0.01, kSlipNoise = 0.015, kGradientNoise = 0.01, kSecondNoise = 0.03,
                 kOffset = 0.1;
constexpr double kUnrelatedOffset = 0.3, kFaultOffset = 0.03;
constexpr double kEvidence = 0.5;  // power of the likelihood: the curve of a class is never exact
constexpr double kCoarseEvidence = 0.1;
constexpr double kNegligible = 1e-4;    // probability of a hypothesis by the first grid that the second omits
constexpr double kMostSecondStd = 0.1;  // a second slip with a greater error is not used
constexpr double kMostVariance = 1.0;   // greatest variance of a slip, where the curve is flat
constexpr double kLeastShare = 0.02, kLeastSteepness = 0.05;
// Levels of the errors: share of the variation between places, and share of the errors of curve and gradient.
constexpr std::array<double, 5> kVariations{0.0, 0.0, 0.4, 0.8, 1.3}, kNoises{0.3, 1.0, 1.0, 1.0, 1.0};
// Errors of a slip that is computed from the class, and of one unrelated to the ground.
constexpr std::array<double, 5> kComputedErrors{0.001, 0.002, 0.003, 0.006, 0.01},
    kUnrelatedErrors{0.01, 0.02, 0.04, 0.12, 0.3};
// Resistances are a sum of normal distributions about nodes: positions over their deviation without that of one
// node, and deviation of one node over that of all.
constexpr std::array<double, 5> kResistances{-2.0, -1.0, 0.0, 1.0, 2.0};
constexpr double kNodeStd = 0.4;
constexpr double kNodesStd = 0.917;  // (1 - kNodeStd^2)^(1/2)
constexpr double kReferenceSlip = 0.5;
constexpr double kNoSlip = std::numeric_limits<double>::quiet_NaN();

constexpr int kSlips = 146;
constexpr double kLeastSlip = -0.5, kSlipStep = 0.01;
double slipAt(double i) noexcept {
  return kLeastSlip + kSlipStep * i;
}

// Curve of all wheels of a rover on one soil of a class. Ground whose pull at the reference slip departs by D from
// that of the class has at a slip the mean pull base + D share. Bends are changes for a change of the resistance by
// its standard deviation, at equal D.
struct Curve {
  std::array<double, kSlips> base{}, share{}, base_bend{}, share_bend{};

  Curve(const GroundModel& soil, int rutted, int wheels, double of_class) {
    const double in_rut = static_cast<double>(rutted) / wheels;
    const SteadyWheel& reference = soil.reference(0, false);
    for (int i = 0; i < kSlips; ++i) {
      const SteadyWheel fresh = soil.steady(0, {.slip = slipAt(i)});
      const SteadyWheel rut = rutted > 0 ? soil.steady(0, {.slip = slipAt(i), .in_rut = true}) : fresh;
      const auto at = static_cast<std::size_t>(i);
      const double pull = (1.0 - in_rut) * fresh.drawbar_pull_over_load + in_rut * rut.drawbar_pull_over_load,
                   thrust =
                       (1.0 - in_rut) * fresh.torque_over_load_radius + in_rut * rut.torque_over_load_radius;
      share[at] = std::max(thrust / reference.torque_over_load_radius, kLeastShare);
      base[at] = pull - (reference.drawbar_pull_over_load - of_class) * share[at];
    }
  }

  // Slip on a gradient, its changes for a change of the pull and of the resistance, and the share of the thrust.
  struct Driven {
    double slip, by_pull, by_resistance, share;
  };
  // Least slip at which ground with a departure has the pull of a gradient (B2).
  Driven on(double gradient, double departure) const {
    const auto at = [&](std::size_t i) { return base[i] + departure * share[i]; };
    std::size_t from = 0;
    while (from + 2 < base.size() && at(from + 1) < gradient) ++from;
    const double low = at(from), high = at(from + 1);
    const double by_pull = 1.0 / std::max((high - low) / kSlipStep, kLeastSteepness);
    return {slipAt(static_cast<double>(from) +
                   (high > low ? std::clamp((gradient - low) / (high - low), 0.0, 1.0) : 1.0)),
            by_pull, -by_pull * (base_bend[from] + departure * share_bend[from]), share[from]};
  }
  double pullAt(double slip, double departure) const {
    const double at = std::clamp((slip - kLeastSlip) / kSlipStep, 0.0, kSlips - 1.001);
    const auto i = static_cast<std::size_t>(at);
    const double low = base[i] + departure * share[i], high = base[i + 1] + departure * share[i + 1];
    return low + (at - static_cast<double>(i)) * (high - low);
  }
};
using Curves = std::vector<Curve>;  // by node of the resistance

Curves curvesOf(const GroundModel& model, int class_index, int rutted, int wheels) {
  Curves curves;
  const double of_class = model.reference(class_index, false).drawbar_pull_over_load;
  for (const double node : kResistances)
    curves.emplace_back(*model.withResistance(class_index, node * kNodesStd), rutted, wheels, of_class);
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::size_t less = k > 0 ? k - 1 : 0, more = std::min(k + 1, curves.size() - 1);
    const double between = (kResistances[more] - kResistances[less]) * kNodesStd;
    for (std::size_t i = 0; i < kSlips; ++i) {
      curves[k].base_bend[i] = (curves[more].base[i] - curves[less].base[i]) / between;
      curves[k].share_bend[i] = (curves[more].share[i] - curves[less].share[i]) / between;
    }
  }
  return curves;
}

// Hypothesis of the slip sensor: from part `from` on, `after` replaces `sensor`, with an offset of its own.
struct Hypothesis {
  const char* kind;
  double prior;
  double offset_std;
  std::size_t sensor, after;
  int from = kParts;
};

// Logarithm of the prior of a departure over mean_std: normal, or with the probability 0.1 (the soil is another
// than that of the class) with three times the standard deviation.
double logPrior(double departure) {
  const double square = departure * departure;
  return std::log(0.9 * std::exp(-0.5 * square) + 0.1 / 3.0 * std::exp(-0.5 * square / 9.0));
}
constexpr double kPriorVariance = 0.9 + 0.1 * 9.0;  // over that of mean_std

struct Hypotheses {
  std::vector<SlipSensor> sensors;
  std::vector<Hypothesis> all;

  // Those with a probability above kNegligible.
  Hypotheses probable(const std::vector<double>& weights) const {
    Hypotheses out;
    std::vector<std::size_t> number(sensors.size(), sensors.size());
    const auto kept = [&](std::size_t sensor) {
      if (number[sensor] == sensors.size()) {
        number[sensor] = out.sensors.size();
        out.sensors.push_back(sensors[sensor]);
      }
      return number[sensor];
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!(weights[i] > kNegligible)) continue;
      out.all.push_back(all[i]);
      out.all.back().sensor = kept(all[i].sensor);
      out.all.back().after = kept(all[i].after);
    }
    return out;
  }
};

// With one slip, faults of the sensor are on ground with the shear modulus of the class, because the slip times a scale
// and the shear modulus times it give one curve.
Hypotheses hypotheses(double modulus_std, bool twice) {
  using Kind = SlipSensor::Kind;
  constexpr double kSound = 0.015;
  constexpr int kModuli = 7, kScales = 16;
  constexpr double kModulusStep = 0.35, kScaleStep = 0.15;  // of the logarithm; the former over its deviation
  Hypotheses h;
  const auto onModuli = [&](int step, const auto& add) {
    for (int i = -kModuli; i <= kModuli; i += step) {
      const double off = kModulusStep * i;
      add(std::exp((off - 0.5 * modulus_std) * modulus_std),
          step * kModulusStep * std::exp(-0.5 * off * off) / std::sqrt(2.0 * std::numbers::pi));
    }
  };
  const auto add = [&](const char* kind, double prior, double offset_std, SlipSensor sensor) {
    const std::size_t at = h.sensors.size();
    h.all.push_back({kind, prior, offset_std, at, at});
    h.sensors.push_back(sensor);
  };
  const auto addEach = [&](const char* kind, double prior, const std::vector<SlipSensor>& of_kind,
                           double offset_std = kFaultOffset) {
    for (SlipSensor sensor : of_kind) {
      const double each = prior / static_cast<double>(of_kind.size());
      if (!twice) add(kind, each, offset_std, sensor);
      if (twice)
        onModuli(2, [&](double modulus, double part) {
          sensor.modulus = modulus;
          add(kind, each * part, offset_std, sensor);
        });
    }
  };
  addEach("unrelated", 0.02, {{Kind::Unrelated}}, kUnrelatedOffset);
  addEach("of class", 0.005, {{Kind::OfClass}});
  std::vector<SlipSensor> knees, scales;
  for (const double knee : {0.1, 0.2, 0.3})
    for (const double scale : {0.0, 0.25, 0.5, 0.75}) knees.push_back({Kind::Knee, scale, knee});
  for (int i = 0; i < kScales; ++i) scales.push_back({Kind::Linear, 1.1 * std::exp(-kScaleStep * i)});
  addEach("compressed", 0.03, knees);
  addEach("scale", 0.05, scales);
  addEach("uphill", 0.02,
          {{Kind::Uphill, 0.25}, {Kind::Uphill, 0.4}, {Kind::Uphill, 0.55}, {Kind::Uphill, 0.7}});
  addEach(
      "by gradient", 0.02,
      {{Kind::ByGradient, 0.5}, {Kind::ByGradient, 1.0}, {Kind::ByGradient, 1.5}, {Kind::ByGradient, 2.0}});
  std::vector<SlipSensor> seconds{{.second = 0.0, .second_offset_std = kUnrelatedOffset}};
  for (const double second : {0.4, 0.6, 0.8, 1.0, 1.25})
    seconds.push_back({.second = second, .second_offset_std = kOffset});
  if (twice) addEach("second", 0.02, seconds, kSound);
  onModuli(1, [&](double modulus, double part) {
    const std::size_t sensor = h.sensors.size();
    add("sound", 0.80 * part, kSound, {.modulus = modulus});
    h.all.push_back({"offset", 0.05 * part, kOffset, sensor, sensor});
    for (int from = 1; from < kParts; ++from) {
      h.all.push_back({"step", 0.02 / (kParts - 1) * part, kOffset, sensor, sensor, from});
      h.all.push_back({"stuck", 0.01 / (kParts - 1) * part, kOffset, sensor, 0, from});
    }
  });
  return h;
}

// A log-likelihood, quadratic in the resistance R: level + slope R - curvature R^2/2.
struct Quadratic {
  double level = 0.0, slope = 0.0, curvature = 0.0;
  Quadratic& operator+=(const Quadratic& q) noexcept {
    level += q.level;
    slope += q.slope;
    curvature += q.curvature;
    return *this;
  }
  // R is normal with the standard deviation `std`: its mean, and the logarithm of the integral over it.
  double mean(double std) const noexcept { return slope / (curvature + 1.0 / (std * std)); }
  double integral(double std) const noexcept {
    return level + 0.5 * slope * mean(std) - 0.5 * std::log1p(curvature * std * std);
  }
};

// Log-likelihood -1/2 (sum of w (r - b - x R)^2 + rest) of residuals r, in the offset b of the sensor and in R.
struct Residuals {
  double w = 0.0, r = 0.0, x = 0.0, rr = 0.0, rx = 0.0, xx = 0.0;
  void add(double weight, double residual, double by_curve, double rest) noexcept {
    w += weight;
    r += weight * residual;
    x += weight * by_curve;
    rr += weight * residual * residual + rest;
    rx += weight * residual * by_curve;
    xx += weight * by_curve * by_curve;
  }
  Residuals operator-(const Residuals& o) const noexcept {
    return {w - o.w, r - o.r, x - o.x, rr - o.rr, rx - o.rx, xx - o.xx};
  }
  Residuals& operator+=(const Residuals& o) noexcept {
    return *this = {w + o.w, r + o.r, x + o.x, rr + o.rr, rx + o.rx, xx + o.xx};
  }
  // With b, normal with the standard deviation `std`, integrated; without b for std = 0.
  Quadratic marginal(double std) const noexcept {
    const double n = std > 0.0 ? 1.0 / (w + 1.0 / (std * std)) : 0.0;
    return {-0.5 * (rr - n * r * r + std::log1p(w * std * std)), rx - n * r * x, xx - n * x * x};
  }
  double offset(double std, double by_curve) const noexcept {
    return (r - x * by_curve) / (w + 1.0 / (std * std));
  }
};

// Readings of one bin of gradients in one part, weighted by the number of squares.
struct Reading {
  const Curves* curves = nullptr;
  int part = 0;
  double weight = 0.0, gradient = 0.0, slip = 0.0, scatter = 0.0, second = 0.0, seconds = 0.0,
         second_variance = 0.0, of_class = 0.0, in_rut = 0.0;
};

// All moments on ground of one class.
struct OfClass {
  const GroundModel& model;
  int index;
  const GroundClass& ground;
  Curves fresh;
  std::map<std::pair<int, int>, Curves> curves{};
  std::vector<Reading> readings{};

  OfClass(const GroundModel& of_model, int of)
      : model(of_model),
        index(of),
        ground(model.parts().classes[static_cast<std::size_t>(of)]),
        fresh(curvesOf(model, of, 0, 1)) {}

  void add(int rutted, int wheels, Reading reading) {
    auto known = curves.find({rutted, wheels});
    if (known == curves.end())
      known = curves.emplace(std::pair(rutted, wheels), curvesOf(model, index, rutted, wheels)).first;
    reading.curves = &known->second;
    reading.in_rut = static_cast<double>(rutted) / wheels;
    reading.of_class = known->second[kResistances.size() / 2].on(reading.gradient, 0.0).slip;
    readings.push_back(reading);
  }

  // Share of the wheels that ran in ruts.
  double inRut() const {
    double rutted = 0.0, all = 0.0;
    for (const Reading& r : readings) {
      rutted += r.weight * r.in_rut;
      all += r.weight;
    }
    return rutted / all;
  }

  // Sums over departure, resistance and variation, relative to exp(greatest).
  struct Sums {
    double greatest = -std::numeric_limits<double>::infinity();
    double weight = 0.0, first = 0.0, second = 0.0, at = 0.0, at2 = 0.0, resistance = 0.0, offset = 0.0,
           changed = 0.0;

    void add(double log, double departure, double at_class, double of_resistance, double of_offset,
             double of_changed) noexcept {
      if (log > greatest) {
        const double less = std::exp(greatest - log);
        for (double* sum : {&weight, &first, &second, &at, &at2, &resistance, &offset, &changed})
          *sum *= less;
        greatest = log;
      }
      const double w = std::exp(log - greatest);
      weight += w;
      first += w * departure;
      second += w * departure * departure;
      at += w * at_class;
      at2 += w * at_class * at_class;
      resistance += w * of_resistance;
      offset += w * of_offset;
      changed += w * of_changed;
    }
  };
  using Table = std::vector<Sums>;  // by hypothesis

  // Variance of the slip at a place: ground that varies, curve and gradient.
  double variance(const Curve::Driven& driven, std::size_t t) const {
    const double place =
                     std::hypot(kVariations[t] * ground.pull_std, kNoises[t] * kModelError) * driven.share,
                 gradient = kNoises[t] * kGradientNoise;
    return std::min((place * place + gradient * gradient) * driven.by_pull * driven.by_pull, kMostVariance);
  }

  // Residuals of the first parts for one sensor. Where the slip was measured twice: given the second slip.
  using Parts = std::array<Residuals, kParts + 1>;
  Parts partsOf(const SlipSensor& sensor, const std::vector<Curve::Driven>& driven,
                const std::vector<double>& variances, std::size_t t, double evidence) const {
    Parts until{};
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const Reading& r = readings[k];
      const double slip = driven[k].slip;
      const double gain = sensor.gain(slip, r.gradient), of_ground = variances[k];
      double residual = r.slip - sensor.read(slip, r.gradient, r.of_class),
             by_resistance = gain * driven[k].by_resistance,
             variance = sensor.kind == SlipSensor::Kind::OfClass ? kComputedErrors[t] * kComputedErrors[t]
                        : sensor.kind == SlipSensor::Kind::Unrelated
                            ? kUnrelatedErrors[t] * kUnrelatedErrors[t]
                            : kSlipNoise * kSlipNoise + gain * gain * of_ground;
      if (const double scale = sensor.modulus * sensor.second; r.seconds > 0.0 && scale > 0.0) {
        const double known = of_ground / (of_ground + r.second_variance / (scale * scale));
        residual -= gain * known * (r.second / scale - slip);
        by_resistance *= 1.0 - known;
        variance -= gain * gain * known * of_ground;
      }
      const double weight = evidence * r.weight, w = weight / variance;
      until[static_cast<std::size_t>(r.part) + 1].add(w, residual, by_resistance,
                                                      w * r.scatter + weight * std::log(variance));
    }
    for (std::size_t k = 0; k < kParts; ++k) until[k + 1] += until[k];
    return until;
  }

  // Likelihood of the second slips.
  Quadratic bySecond(const SlipSensor& sensor, const std::vector<Curve::Driven>& driven,
                     const std::vector<double>& variances, std::size_t t, double evidence) const {
    Residuals all;
    const double scale = sensor.modulus * sensor.second;
    for (std::size_t k = 0; k < readings.size(); ++k)
      if (const Reading& r = readings[k]; r.seconds > 0.0) {
        const double variance = scale > 0.0 ? scale * scale * variances[k] + r.second_variance
                                            : kUnrelatedErrors[t] * kUnrelatedErrors[t];
        const double weight = evidence * r.weight;
        all.add(weight / variance, r.second - scale * driven[k].slip, scale * driven[k].by_resistance,
                weight * std::log(variance));
      }
    return all.marginal(sensor.second_offset_std);
  }

  // Adds one hypothesis with one departure, node of the resistance and variation.
  void add(Sums& sums, const Hypothesis& one, const std::vector<Parts>& until, Quadratic all, double log,
           double departure, std::size_t node, double modulus) const {
    const auto from = static_cast<std::size_t>(one.from);
    const Residuals &first = until[one.sensor][from],
                    rest = until[one.after][kParts] - until[one.after][from];
    const double std = one.after == one.sensor ? one.offset_std : kUnrelatedOffset;
    all += first.marginal(one.offset_std);
    if (one.from < kParts) all += rest.marginal(std);
    const double resistance = all.mean(kNodeStd);
    // A shear modulus of m times that of the class changes the pull at the reference slip, too.
    sums.add(log + all.integral(kNodeStd),
             fresh[node].pullAt(kReferenceSlip / modulus, departure) -
                 model.reference(index, false).drawbar_pull_over_load,
             departure, kResistances[node] * kNodesStd + resistance, first.offset(one.offset_std, resistance),
             rest.offset(std, resistance));
  }

  // The coarse table has every second node and variation, and readings of less weight, so that its grid meets the
  // likelihood.
  Table table(const std::vector<double>& departures, const Hypotheses& h, bool coarse) const {
    const std::size_t step = coarse ? 2 : 1;
    const double evidence = coarse ? kCoarseEvidence : kEvidence;
    Table out(h.all.size());
    std::vector<Curve::Driven> driven(readings.size());
    std::vector<double> variances(readings.size());
    for (const double departure : departures)
      for (std::size_t node = 0; node < kResistances.size(); node += step) {
        for (std::size_t k = 0; k < readings.size(); ++k)
          driven[k] = (*readings[k].curves)[node].on(readings[k].gradient, departure);
        const double of_prior =
            logPrior(departure / ground.mean_std) - 0.5 * kResistances[node] * kResistances[node];
        for (std::size_t t = 0; t < kVariations.size(); t += step) {
          for (std::size_t k = 0; k < readings.size(); ++k) variances[k] = variance(driven[k], t);
          std::map<std::array<double, 3>, Quadratic> known;
          std::vector<Quadratic> by_second;
          std::vector<Parts> until;
          for (const SlipSensor& sensor : h.sensors) {
            const std::array key{sensor.modulus, sensor.second, sensor.second_offset_std};
            if (!known.contains(key)) known[key] = bySecond(sensor, driven, variances, t, evidence);
            by_second.push_back(known[key]);
            until.push_back(partsOf(sensor, driven, variances, t, evidence));
          }
          for (std::size_t i = 0; i < h.all.size(); ++i) {
            const std::size_t sensor = h.all[i].sensor;
            add(out[i], h.all[i], until, by_second[sensor], of_prior, departure, node,
                h.sensors[sensor].modulus);
          }
        }
      }
    return out;
  }
};

// Posterior probabilities of the hypotheses, from the prior and all classes.
std::vector<double> weighed(const std::vector<OfClass::Table>& of_classes, const Hypotheses& h) {
  std::vector<double> weights;
  for (std::size_t i = 0; i < h.all.size(); ++i) {
    weights.push_back(std::log(h.all[i].prior));
    for (const OfClass::Table& table : of_classes)
      weights.back() += table[i].greatest + std::log(table[i].weight);
  }
  const double greatest = *std::ranges::max_element(weights);
  double sum = 0.0;
  for (double& w : weights) sum += w = std::exp(w - greatest);
  for (double& w : weights) w /= sum;
  return weights;
}

// Mean and standard deviation of the departure over the hypotheses that `counts` accepts.
template <typename Counts>
Estimate departureBy(const std::vector<double>& weights, const OfClass::Table& table, const Counts& counts,
                     double OfClass::Sums::*first = &OfClass::Sums::first,
                     double OfClass::Sums::*square = &OfClass::Sums::second) {
  double all = 0.0, mean = 0.0, second = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const OfClass::Sums& sums = table[i];
    if (!(sums.weight > 0.0) || !counts(i)) continue;
    all += weights[i];
    mean += weights[i] * sums.*first / sums.weight;
    second += weights[i] * sums.*square / sums.weight;
  }
  mean /= all;
  return {mean, std::sqrt(std::max(second / all - mean * mean, 1e-6))};
}

std::vector<double> grid(double low, double high, int points) {
  std::vector<double> out;
  for (int i = 0; i < points; ++i) out.push_back(low + (high - low) * i / (points - 1));
  return out;
}

// Readings of one class, by wheels in ruts, part and gradient.
template <typename SumsOfMoments>
OfClass gathered(const GroundModel& model, const SumsOfMoments& sums, int index, double second_std,
                 const DriveEstimate& out) {
  struct Weighed {
    double weight = 0.0, gradient = 0.0, slip = 0.0, squares = 0.0, second = 0.0, seconds = 0.0;
  };
  std::map<std::pair<int, int>, double> of_square;
  for (const auto& [key, sum] : sums)
    if (std::get<0>(key) == index) of_square[{std::get<4>(key), std::get<5>(key)}] += sum.count;
  std::map<std::tuple<int, int, int, int>, Weighed> bins;
  for (const auto& [key, sum] : sums) {
    const auto& [of_class, rutted, wheels, chunk, x, y, step] = key;
    if (of_class != index) continue;
    const double weight = sum.count / of_square[{x, y}], slip = sum.slip / sum.count;
    const double gradient = out.gradient(sum.gradient / sum.count);
    Weighed& w = bins[{rutted, wheels, out.partOf(chunk * kChunk),
                       static_cast<int>(std::floor(gradient / kGradientStep))}];
    w.weight += weight;
    w.gradient += weight * gradient;
    w.slip += weight * slip;
    w.squares += weight * slip * slip;
    if (!out.twice || sum.seconds == 0.0) continue;
    w.seconds += weight;
    w.second += weight * sum.second / sum.seconds;
  }
  OfClass one(model, index);
  for (const auto& [key, w] : bins) {
    const double slip = w.slip / w.weight;
    one.add(std::get<0>(key), std::get<1>(key),
            {.part = std::get<2>(key),
             .weight = w.weight,
             .gradient = w.gradient / w.weight,
             .slip = slip,
             .scatter = std::max(w.squares / w.weight - slip * slip, 0.0),
             .second = w.seconds > 0.0 ? w.second / w.seconds : 0.0,
             .seconds = w.seconds,
             .second_variance = kSecondNoise * kSecondNoise + second_std * second_std});
  }
  return one;
}

bool anyHypothesis(std::size_t) noexcept {
  return true;
}

// Sets the kind of sensor, and the most probable sensor where a slip depends on the ground; returns the number of its
// hypothesis.
std::size_t nameSensor(const Hypotheses& h, const std::vector<double>& weights, DriveEstimate& out) {
  std::map<std::string, double> kinds;
  std::size_t best = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    kinds[h.all[i].kind] += weights[i];
    if (!out.twice && !h.sensors[h.all[i].sensor].informs()) continue;
    out.informing += weights[i];
    if (weights[i] > weights[best]) best = i;
  }
  for (const auto& [kind, weight] : kinds)
    if (weight > out.probability) {
      out.probability = weight;
      out.hypothesis = kind;
    }
  out.uninforming = kinds["of class"] > kinds["unrelated"] ? "of class" : "unrelated";
  out.sensor = h.sensors[h.all[best].sensor];
  out.changed_from = h.all[best].from;
  out.changed_informs = h.all[best].from == kParts || h.sensors[h.all[best].after].informs();
  return best;
}

// Strength of one class over the hypotheses.
DriveEstimate::OfClass strengthBy(const Hypotheses& h, const std::vector<double>& weights,
                                  const OfClass::Table& table, const OfClass& of, bool twice) {
  const auto isSound = [&](std::size_t i) {
    const std::string_view kind = h.all[i].kind;
    return kind == "sound" || kind == "second";
  };
  const auto informs = [&](std::size_t i) { return twice || h.sensors[h.all[i].sensor].informs(); };
  const double rut2 = std::pow(of.inRut() * of.ground.rut_std, 2);
  const auto by = [&](const auto& counts) {
    const Estimate mean = departureBy(weights, table, counts);
    return Estimate{mean.value, std::sqrt(mean.std * mean.std + rut2)};
  };
  const Estimate read = by(informs);
  const double q2 = kPriorVariance * of.ground.mean_std * of.ground.mean_std,
               left = std::max(1.0 / (read.std * read.std) - 1.0 / q2, 0.01 / q2);
  return {.departure = by(anyHypothesis),
          .if_sound = by(isSound),
          .read = read.value / (read.std * read.std * left),
          .shared_std = 1.0 / std::sqrt(left)};
}

}  // namespace

double SlipSensor::read(double slip, double gradient, double of_class) const noexcept {
  const double of_wheels = modulus * slip;
  switch (kind) {
    case Kind::Linear:
      return scale * of_wheels;
    case Kind::Knee:
      return std::min(of_wheels, knee) + scale * std::max(of_wheels - knee, 0.0);
    case Kind::Uphill:
      return gradient > 0.0 ? scale * of_wheels : of_wheels;
    case Kind::ByGradient:
      return of_wheels - scale * std::max(gradient, 0.0);
    case Kind::OfClass:
      return of_class;
    case Kind::Unrelated:
      break;
  }
  return 0.0;
}

double SlipSensor::gain(double slip, double gradient) const noexcept {
  if (!informs()) return 0.0;
  return (kind == Kind::Knee && modulus * slip > knee) || kind == Kind::Linear ||
                 (kind == Kind::Uphill && gradient > 0.0)
             ? scale * modulus
             : modulus;
}

double SlipSensor::slipOf(double read, double gradient) const noexcept {
  switch (kind) {
    case Kind::Knee:
      return (read <= knee ? read : knee + (read - knee) / std::max(scale, 0.1)) / modulus;
    case Kind::Uphill:
      return (gradient > 0.0 ? read / scale : read) / modulus;
    case Kind::ByGradient:
      return (read + scale * std::max(gradient, 0.0)) / modulus;
    default:
      return read / (scale * modulus);
  }
}

std::pair<double, double> DriveEstimate::slip(std::size_t moment, std::pair<double, double> read,
                                              double gradient) const noexcept {
  const bool before = partOf(moment) < changed_from;
  if (displaced(moment) || !(informing > kLeastInforming)) return {kNoSlip, kNoSlip};
  if (!sensor.informs() || !(before || changed_informs))
    return {read.second / sensor.modulus, sensor.modulus};
  const double slip = sensor.slipOf(read.first - (before ? offset : changed_offset), gradient);
  return {slip, sensor.gain(slip, gradient)};
}

int DriveEstimate::partOf(std::size_t moment) const noexcept {
  const std::size_t chunks = moments / kChunk + 1;
  return static_cast<int>(std::min(moment / kChunk * kParts / chunks, std::size_t{kParts - 1}));
}

void DrivePosterior::take(const Moment& moment) {
  const std::size_t chunk = moments_ / kChunk;
  if (!std::isfinite(moment.place.x_m + moment.place.y_m)) return;
  const double side_m = kIntegralScale * model_.parts().policy.correlation_length_m;
  const auto step = [](double value, double of) {
    return static_cast<int>(std::clamp(std::floor(value / of), -1e9, 1e9));
  };
  const int column = step(moment.place.x_m, side_m), row = step(moment.place.y_m, side_m);
  const bool measured = std::isfinite(moment.gradient);
  const double gradient = measured ? moment.gradient : moment.map_gradient;
  if (measured && std::isfinite(moment.map_gradient)) {
    Slope& slope = slopes_[{chunk, column, row, step(moment.map_gradient, 0.05)}];
    slope.count += 1.0;
    slope.map += moment.map_gradient;
    slope.measured += moment.gradient;
  }
  if (!std::isfinite(gradient + moment.slip)) return;
  Sum& sum = sums_[{moment.class_index, moment.rutted, moment.wheels, chunk, column, row,
                    step(gradient, kGradientStep)}];
  sum.count += 1.0;
  sum.gradient += gradient;
  sum.slip += moment.slip;
  if (std::isfinite(moment.second_slip)) {
    sum.seconds += 1.0;
    sum.second += moment.second_slip;
    seconds_ += 1.0;
    second_std_ = std::max(second_std_, moment.second_std);
  }
  ++moments_;
}

// Regression of the measured gradients on those of the map, with normal priors of offset (0.02) and scale
// (0.1); and the part from which the measured gradients are unrelated to the map.
void DrivePosterior::fitSlopes(DriveEstimate& out) const {
  constexpr double kOffset = 0.02, kScale = 0.1, kError = 0.02, kDisplaced = 0.01;
  struct Moments {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  };
  std::array<Moments, kParts + 1> until{};
  for (int part = 0; part < kParts; ++part) {
    Moments& m = until[static_cast<std::size_t>(part) + 1] = until[static_cast<std::size_t>(part)];
    for (const auto& [place, slope] : slopes_) {
      if (out.partOf(std::get<0>(place) * kChunk) != part) continue;
      const double x = slope.map / slope.count, y = slope.measured / slope.count;
      m.n += 1.0;
      m.x += x;
      m.y += y;
      m.xx += x * x;
      m.xy += x * y;
      m.yy += y * y;
    }
  }
  // Log-likelihood of the first `parts` parts with the regression of these parts, and of the others as normal
  // values of their own mean and variance.
  double best = -std::numeric_limits<double>::infinity();
  for (int from = 0; from <= kParts; ++from) {
    const Moments &m = until[static_cast<std::size_t>(from)], &all = until[kParts];
    const double v = kError * kError, a = m.n / v + 1.0 / (kOffset * kOffset), b = m.x / v,
                 c = m.xx / v + 1.0 / (kScale * kScale), f = m.y / v, g = m.xy / v + 1.0 / (kScale * kScale);
    const double determinant = a * c - b * b, offset = (f * c - b * g) / determinant,
                 scale = (a * g - b * f) / determinant;
    const double left = m.yy + m.n * offset * offset + scale * scale * m.xx - 2.0 * offset * m.y -
                        2.0 * scale * m.xy + 2.0 * offset * scale * m.x;
    const double error2 = (left + 4.0 * v) / (m.n + 4.0);  // with a prior of four readings
    double log = from == kParts ? 0.0 : std::log(kDisplaced);
    log -= 0.5 * m.n * std::log(error2) +
           0.5 * (offset * offset / (kOffset * kOffset) + (scale - 1.0) * (scale - 1.0) / (kScale * kScale));
    if (const double n = all.n - m.n; n > 0.0) {
      const double mean = (all.y - m.y) / n, variance = std::max((all.yy - m.yy) / n - mean * mean, 0.0);
      log -= 0.5 * n * std::log((n * variance + 4.0 * 0.01) / (n + 4.0));
    }
    if (log <= best) continue;
    best = log;
    out.displaced_from = from;
    out.slope_offset = offset;
    out.slope_scale = std::clamp(scale, 0.3, 3.0);
  }
}

DriveEstimate DrivePosterior::fitted() const {
  DriveEstimate out{.moments = moments_};
  for (const GroundClass& ground : model_.parts().classes)
    out.classes.push_back({.departure = {0.0, ground.mean_std},
                           .if_sound = {0.0, ground.mean_std},
                           .shared_std = std::numeric_limits<double>::infinity()});
  fitSlopes(out);
  out.twice = seconds_ > 0.5 * static_cast<double>(moments_) && second_std_ < kMostSecondStd;
  std::vector<OfClass> driven;
  double modulus_std = 0.0;
  for (int c = 0; c < static_cast<int>(out.classes.size()); ++c)
    if (std::ranges::any_of(sums_, [&](const auto& sum) { return std::get<0>(sum.first) == c; })) {
      driven.push_back(gathered(model_, sums_, c, second_std_, out));
      modulus_std = std::max(modulus_std, driven.back().ground.modulus_std);
    }
  if (driven.empty()) return out;
  Hypotheses h = hypotheses(modulus_std, out.twice);
  std::vector<OfClass::Table> tables;
  std::vector<double> weights;
  // The second grid lies around the posterior by the first.
  for (const bool fine : {false, true}) {
    std::vector<OfClass::Table> next;
    std::vector<Estimate> around;
    for (std::size_t k = 0; k < driven.size(); ++k)
      around.push_back(
          fine ? departureBy(weights, tables[k], anyHypothesis, &OfClass::Sums::at, &OfClass::Sums::at2)
               : Estimate{0.0, 1.6 * driven[k].ground.mean_std});
    if (fine) h = h.probable(weights);
    for (std::size_t k = 0; k < driven.size(); ++k) {
      const double reach = 5.0 * std::max(around[k].std, 0.15 * driven[k].ground.mean_std);
      next.push_back(
          driven[k].table(grid(around[k].value - reach, around[k].value + reach, fine ? 41 : 33), h, !fine));
    }
    tables = std::move(next);
    weights = weighed(tables, h);
  }
  const std::size_t best = nameSensor(h, weights, out);
  double second = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i)
    second += std::string_view(h.all[i].kind) == "second" ? weights[i] : 0.0;
  std::vector<GroundClass> found = model_.parts().classes;
  for (std::size_t k = 0; k < driven.size(); ++k) {
    DriveEstimate::OfClass& of = out.classes[static_cast<std::size_t>(driven[k].index)];
    of = strengthBy(h, weights, tables[k], driven[k], out.twice);
    const OfClass::Sums& sums = tables[k][best];
    of.at = sums.at / sums.weight;
    found[static_cast<std::size_t>(driven[k].index)] =
        model_.withResistance(driven[k].index, std::round(10.0 * sums.resistance / sums.weight) / 10.0)
            ->parts()
            .classes[0];
    out.offset += sums.offset / sums.weight / static_cast<double>(driven.size());
    out.changed_offset += sums.changed / sums.weight / static_cast<double>(driven.size());
  }
  out.twice = out.twice && second < 1.0 - DriveEstimate::kVerified;
  GroundModel::Parts parts = model_.parts();
  parts.classes = std::move(found);
  out.ground = std::make_shared<const GroundModel>(std::move(parts));
  return out;
}

}  // namespace talus::costmap
