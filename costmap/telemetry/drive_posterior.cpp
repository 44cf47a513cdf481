#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <talus/costmap/telemetry/drive_posterior.hpp>

namespace talus::costmap {
namespace {

constexpr int kParts = DriveEstimate::kParts;
constexpr std::size_t kChunk = 16;      // moments of one chunk
constexpr double kGradientStep = 0.01;  // width of a bin of gradients
constexpr double kIntegralScale = 2.0 / 3.0;
constexpr double kModelError = 0.02, kSlipNoise = 0.015, kGradientNoise = 0.01, kSecondNoise = 0.03;
constexpr double kMostSecondStd = 0.1;  // a second slip with a greater error is not used
constexpr double kMostVariance = 1.0;   // greatest variance of a slip, where the curve is flat
constexpr double kLeastShare = 0.02, kLeastSteepness = 0.05;
constexpr double kEvidence = 0.5;  // power of the likelihood: the curve of a class is never exact
constexpr std::array<double, 5> kVariations{0.0, 0.35, 0.7, 1.0, 1.4};
// Errors of a slip that is computed from the class, and of one unrelated to the ground.
constexpr std::array<double, 5> kComputedErrors{0.001, 0.002, 0.004, 0.007, 0.01},
    kUnrelatedErrors{0.01, 0.03, 0.07, 0.15, 0.3};
constexpr double kReferenceSlip = 0.5;

constexpr int kSlips = 291;
constexpr double kLeastSlip = -0.5, kSlipStep = 0.005;
double slipAt(double i) noexcept {
  return kLeastSlip + kSlipStep * i;
}

// Mean pull of all wheels of a rover over slip, and their thrust over that of the class at the reference
// slip.
struct Curve {
  std::array<double, kSlips> pull{}, share{};

  Curve(const GroundModel& model, int class_index, int rutted, int wheels) {
    const double in_rut = static_cast<double>(rutted) / wheels;
    const double thrust = model.reference(class_index, false).torque_over_load_radius;
    for (int i = 0; i < kSlips; ++i) {
      const SteadyWheel fresh = model.steady(class_index, {.slip = slipAt(i)});
      const SteadyWheel rut =
          rutted > 0 ? model.steady(class_index, {.slip = slipAt(i), .in_rut = true}) : fresh;
      const auto at = static_cast<std::size_t>(i);
      pull[at] = (1.0 - in_rut) * fresh.drawbar_pull_over_load + in_rut * rut.drawbar_pull_over_load;
      share[at] = (1.0 - in_rut) * fresh.torque_over_load_radius + in_rut * rut.torque_over_load_radius;
      share[at] = std::max(share[at] / thrust, kLeastShare);
    }
  }

  // Least slip at which ground with a departure has the pull of a gradient (B2).
  double slipOn(double gradient, double departure) const {
    const auto at = [&](std::size_t i) { return pull[i] + departure * share[i]; };
    std::size_t from = 0;
    while (from + 2 < pull.size() && at(from + 1) < gradient) ++from;
    const double low = at(from), high = at(from + 1);
    return slipAt(static_cast<double>(from) +
                  (high > low ? std::clamp((gradient - low) / (high - low), 0.0, 1.0) : 1.0));
  }
  double pullAt(double slip) const {
    const double at = std::clamp((slip - kLeastSlip) / kSlipStep, 0.0, kSlips - 1.001);
    const auto i = static_cast<std::size_t>(at);
    return pull[i] + (at - static_cast<double>(i)) * (pull[i + 1] - pull[i]);
  }
};

// Hypothesis of the slip sensor: from part `from` on, `after` replaces `sensor`, with an offset of its own.
struct Hypothesis {
  const char* kind;
  double prior;
  double offset_std;
  std::size_t sensor, after = 0;
  int from = kParts;
  bool of_shape = true;  // the scale is that of the shear modulus of the ground
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
};

Hypotheses hypotheses() {
  using Kind = SlipSensor::Kind;
  constexpr double kShape = 0.2, kSound = 0.015, kOffset = 0.1, kStep = 0.05;
  constexpr int kLow = -46, kTop = 14;
  Hypotheses h;
  std::vector<std::pair<std::size_t, double>> sound;
  double of_shape = 0.0;
  for (int i = kLow; i <= kTop; ++i) {
    const double log_scale = kStep * i, off = log_scale / kShape, density = std::exp(-0.5 * off * off);
    if (density > 1e-3) {
      sound.emplace_back(h.sensors.size(), density);
      of_shape += density;
    }
    h.sensors.push_back({Kind::Linear, std::exp(log_scale)});
  }
  const std::size_t unrelated = h.sensors.size();
  h.sensors.push_back({Kind::Unrelated, 0.0});
  for (const auto& [sensor, density] : sound) {
    const double part = density / of_shape;
    h.all.push_back({"sound", 0.80 * part, kSound, sensor});
    h.all.push_back({"offset", 0.05 * part, kOffset, sensor});
    for (int from = 1; from < kParts; ++from) {
      h.all.push_back({"step", 0.02 / (kParts - 1) * part, kOffset, sensor, sensor, from});
      h.all.push_back({"stuck", 0.01 / (kParts - 1) * part, kOffset, sensor, unrelated, from});
    }
  }
  int scales = 0;
  for (int i = kLow; i <= 2; ++i) ++scales;
  for (int i = kLow; i <= 2; ++i)
    h.all.push_back({"scale", 0.05 / scales, 0.03, static_cast<std::size_t>(i - kLow), 0, kParts, false});
  const auto add = [&](const char* kind, double prior, const std::vector<SlipSensor>& of_kind) {
    for (const SlipSensor& one : of_kind) {
      h.all.push_back(
          {kind, prior / static_cast<double>(of_kind.size()), 0.03, h.sensors.size(), 0, kParts, false});
      h.sensors.push_back(one);
    }
  };
  std::vector<SlipSensor> knees;
  for (const double knee : {0.1, 0.2, 0.3})
    for (const double scale : {0.0, 0.25, 0.5, 0.75}) knees.push_back({Kind::Knee, scale, knee});
  add("compressed", 0.03, knees);
  add("uphill", 0.02, {{Kind::Uphill, 0.25}, {Kind::Uphill, 0.4}, {Kind::Uphill, 0.55}, {Kind::Uphill, 0.7}});
  add("by gradient", 0.02,
      {{Kind::ByGradient, 0.5}, {Kind::ByGradient, 1.0}, {Kind::ByGradient, 1.5}, {Kind::ByGradient, 2.0}});
  add("of class", 0.005, {{Kind::OfClass}});
  h.all.push_back({"unrelated", 0.02, 0.3, unrelated, 0, kParts, false});
  return h;
}

// The log-likelihood is -(a b^2 - 2 f b + q)/2 in the offset b of the sensor.
struct Parabola {
  double a = 0.0, f = 0.0, q = 0.0;
  void add(double w, double r, double rest) noexcept {
    a += w;
    f += w * r;
    q += w * r * r + rest;
  }
  Parabola& operator+=(const Parabola& p) noexcept {
    a += p.a;
    f += p.f;
    q += p.q;
    return *this;
  }
  // Logarithm of the likelihood with b, normal with the standard deviation `std`, integrated.
  double marginal(double std) const noexcept {
    const double n = kEvidence * a, m = kEvidence * f, v = std * std;
    return -0.5 * (kEvidence * q - m * m / (n + 1.0 / v) + std::log1p(n * v));
  }
  double offset(double std) const noexcept { return f / (a + 1.0 / (kEvidence * std * std)); }
};

// Readings of one bin of gradients in one part, weighted by the number of squares.
struct Reading {
  const Curve* curve = nullptr;
  int part = 0;
  double weight = 0.0, gradient = 0.0, slip = 0.0, scatter = 0.0, second = 0.0, seconds = 0.0,
         second_variance = 0.0, of_class = 0.0;
  std::array<double, kVariations.size()> variance{};  // of the slip (B3)
};

// All moments on ground of one class.
struct OfClass {
  std::size_t index = 0;
  double mean_std = 0.0;
  std::map<std::pair<int, int>, Curve> curves{};
  std::vector<Reading> readings{};

  void add(const GroundModel& model, int rutted, int wheels, Reading reading) {
    const auto class_index = static_cast<int>(index);
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
    reading.of_class = c.slipOn(reading.gradient, 0.0);
    reading.curve = &c;
    readings.push_back(reading);
  }

  // Sums over departure and variation for each hypothesis, relative to exp(greatest).
  struct Sums {
    double weight = 0.0, first = 0.0, second = 0.0, offset = 0.0, changed = 0.0;
  };
  struct Table {
    std::vector<Sums> sums;
    double greatest = -std::numeric_limits<double>::infinity();
  };

  // Sums of the likelihood over the first parts, of one sensor at the given slips.
  using Parts = std::array<Parabola, kParts + 1>;
  Parts partsOf(const SlipSensor& sensor, const std::vector<double>& slips, std::size_t t) const {
    Parts until{};
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const Reading& r = readings[k];
      const double variance =
          sensor.kind == SlipSensor::Kind::OfClass     ? kComputedErrors[t] * kComputedErrors[t]
          : sensor.kind == SlipSensor::Kind::Unrelated ? kUnrelatedErrors[t] * kUnrelatedErrors[t]
                                                       : r.variance[t];
      const double w = r.weight / variance;
      until[static_cast<std::size_t>(r.part) + 1].add(w,
                                                      r.slip - sensor.read(slips[k], r.gradient, r.of_class),
                                                      w * r.scatter + r.weight * std::log(variance));
    }
    for (std::size_t k = 0; k < kParts; ++k) until[k + 1] += until[k];
    return until;
  }

  // Logarithm of the likelihood of the second slips, if they are `scale` times the given slips.
  double bySecond(double scale, const std::vector<double>& slips, std::size_t t) const {
    double log = 0.0;
    for (std::size_t k = 0; k < readings.size(); ++k)
      if (const Reading& r = readings[k]; r.seconds > 0.0) {
        const double off = r.second - scale * slips[k], variance = r.variance[t] + r.second_variance;
        log -= 0.5 * kEvidence * r.weight * (off * off / variance + std::log(variance));
      }
    return log;
  }

  // Part of the strength at the reference slip that the shear modulus of a hypothesis makes.
  double shapeOf(const Hypothesis& one, const Hypotheses& h) const {
    const Curve& fresh = curves.begin()->second;
    return one.of_shape
               ? fresh.pullAt(kReferenceSlip / h.sensors[one.sensor].scale) - fresh.pullAt(kReferenceSlip)
               : 0.0;
  }

  // One hypothesis with one departure and variation: its departure, log-likelihood and offsets.
  struct Term {
    std::size_t hypothesis;
    double departure, log, offset, changed;
  };
  static Term termOf(const Hypothesis& one, const std::vector<Parts>& until) {
    const auto from = static_cast<std::size_t>(one.from);
    const Parabola& first = until[one.sensor][from];
    Term term{0, 0.0, first.marginal(one.offset_std), first.offset(one.offset_std), 0.0};
    if (one.from == kParts) return term;
    const Parabola &all = until[one.after][kParts], &before = until[one.after][from];
    const Parabola rest{all.a - before.a, all.f - before.f, all.q - before.q};
    const double std = one.after == one.sensor ? one.offset_std : 0.3;
    term.log += rest.marginal(std);
    term.changed = rest.offset(std);
    return term;
  }

  Table table(const std::vector<double>& departures, const Hypotheses& h) const {
    std::vector<Term> terms;
    Table out{.sums = std::vector<Sums>(h.all.size())};
    std::vector<double> slips(readings.size());
    for (const double departure : departures) {
      for (std::size_t k = 0; k < readings.size(); ++k)
        slips[k] = readings[k].curve->slipOn(readings[k].gradient, departure);
      for (std::size_t t = 0; t < kVariations.size(); ++t) {
        std::vector<double> by_second;
        std::vector<Parts> until;
        for (const SlipSensor& sensor : h.sensors) {
          by_second.push_back(
              bySecond(sensor.kind == SlipSensor::Kind::Linear ? sensor.scale : 1.0, slips, t));
          until.push_back(partsOf(sensor, slips, t));
        }
        const double by_class = bySecond(1.0, slips, t), of_prior = logPrior(departure / mean_std);
        for (std::size_t i = 0; i < h.all.size(); ++i) {
          Term& term = terms.emplace_back(termOf(h.all[i], until));
          term.hypothesis = i;
          term.departure = departure + shapeOf(h.all[i], h);
          term.log += of_prior + (h.all[i].of_shape ? by_second[h.all[i].sensor] : by_class);
          out.greatest = std::max(out.greatest, term.log);
        }
      }
    }
    for (const Term& term : terms) {
      const double w = std::exp(term.log - out.greatest);
      Sums& sums = out.sums[term.hypothesis];
      sums.weight += w;
      sums.first += w * term.departure;
      sums.second += w * term.departure * term.departure;
      sums.offset += w * term.offset;
      sums.changed += w * term.changed;
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
      weights.back() += std::log(std::max(table.sums[i].weight, 1e-300));
  }
  const double greatest = *std::ranges::max_element(weights);
  double sum = 0.0;
  for (double& w : weights) sum += w = std::exp(w - greatest);
  for (double& w : weights) w /= sum;
  return weights;
}

// Mean and standard deviation of the departure over the hypotheses that `counts` accepts.
template <typename Counts>
Estimate departureBy(const std::vector<double>& weights, const OfClass::Table& table, const Counts& counts) {
  double all = 0.0, mean = 0.0, second = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const OfClass::Sums& sums = table.sums[i];
    if (!(sums.weight > 0.0) || !counts(i)) continue;
    all += weights[i];
    mean += weights[i] * sums.first / sums.weight;
    second += weights[i] * sums.second / sums.weight;
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
OfClass gathered(const GroundModel& model, const SumsOfMoments& sums, std::size_t index, double second_std,
                 const DriveEstimate& out) {
  struct Weighed {
    double weight = 0.0, gradient = 0.0, slip = 0.0, squares = 0.0, second = 0.0, seconds = 0.0;
  };
  std::map<std::pair<int, int>, double> of_square;
  for (const auto& [key, sum] : sums)
    if (std::get<0>(key) == static_cast<int>(index))
      of_square[{std::get<4>(key), std::get<5>(key)}] += sum.count;
  std::map<std::tuple<int, int, int, int>, Weighed> bins;
  for (const auto& [key, sum] : sums) {
    const auto& [of_class, rutted, wheels, chunk, x, y, step] = key;
    if (of_class != static_cast<int>(index)) continue;
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
  OfClass one{.index = index, .mean_std = model.parts().classes[index].mean_std};
  for (const auto& [key, w] : bins) {
    const double slip = w.slip / w.weight;
    one.add(model, std::get<0>(key), std::get<1>(key),
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

// Sets the kind of sensor, and the most probable sensor whose slip depends on the ground; returns the number of
// its hypothesis.
std::size_t nameSensor(const Hypotheses& h, const std::vector<double>& weights, DriveEstimate& out) {
  std::map<std::string, double> kinds;
  std::size_t best = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    kinds[h.all[i].kind] += weights[i];
    if (!h.sensors[h.all[i].sensor].informs()) continue;
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
                                  const OfClass::Table& table, double mean_std) {
  const auto isSound = [&](std::size_t i) { return std::string_view(h.all[i].kind) == "sound"; };
  const auto informs = [&](std::size_t i) { return h.sensors[h.all[i].sensor].informs(); };
  const Estimate read = departureBy(weights, table, informs);
  const double q2 = kPriorVariance * mean_std * mean_std,
               left = std::max(1.0 / (read.std * read.std) - 1.0 / q2, 0.01 / q2);
  return {.departure = departureBy(weights, table, anyHypothesis),
          .if_sound = departureBy(weights, table, isSound),
          .read = read.value / (read.std * read.std * left),
          .shared_std = 1.0 / std::sqrt(left)};
}

}  // namespace

double SlipSensor::read(double slip, double gradient, double of_class) const noexcept {
  switch (kind) {
    case Kind::Linear:
      return scale * slip;
    case Kind::Knee:
      return std::min(slip, knee) + scale * std::max(slip - knee, 0.0);
    case Kind::Uphill:
      return gradient > 0.0 ? scale * slip : slip;
    case Kind::ByGradient:
      return slip - scale * std::max(gradient, 0.0);
    case Kind::OfClass:
      return of_class;
    case Kind::Unrelated:
      break;
  }
  return 0.0;
}

double SlipSensor::slipOf(double read, double gradient) const noexcept {
  switch (kind) {
    case Kind::Knee:
      return read <= knee ? read : knee + (read - knee) / std::max(scale, 0.1);
    case Kind::Uphill:
      return gradient > 0.0 ? read / scale : read;
    case Kind::ByGradient:
      return read + scale * std::max(gradient, 0.0);
    default:
      return read / scale;
  }
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
  static const Hypotheses h = hypotheses();
  DriveEstimate out{.moments = moments_};
  for (const GroundClass& ground : model_.parts().classes)
    out.classes.push_back({.departure = {0.0, ground.mean_std},
                           .if_sound = {0.0, ground.mean_std},
                           .shared_std = std::numeric_limits<double>::infinity()});
  fitSlopes(out);
  out.twice = seconds_ > 0.5 * static_cast<double>(moments_) && second_std_ < kMostSecondStd;
  std::vector<OfClass> driven;
  for (std::size_t c = 0; c < out.classes.size(); ++c)
    if (OfClass one = gathered(model_, sums_, c, second_std_, out); !one.readings.empty())
      driven.push_back(std::move(one));
  if (driven.empty()) return out;
  std::vector<OfClass::Table> tables;
  std::vector<double> weights;
  // The second grid lies around the posterior by the first.
  for (const bool fine : {false, true}) {
    std::vector<OfClass::Table> next;
    for (std::size_t k = 0; k < driven.size(); ++k) {
      const double q = driven[k].mean_std;
      const Estimate at = fine ? departureBy(weights, tables[k], anyHypothesis) : Estimate{0.0, 1.6 * q};
      const double reach = 5.0 * std::max(at.std, 0.15 * q);
      next.push_back(driven[k].table(grid(at.value - reach, at.value + reach, fine ? 41 : 49), h));
    }
    tables = std::move(next);
    weights = weighed(tables, h);
  }
  const std::size_t best = nameSensor(h, weights, out);
  for (std::size_t k = 0; k < driven.size(); ++k) {
    DriveEstimate::OfClass& of = out.classes[driven[k].index];
    of = strengthBy(h, weights, tables[k], driven[k].mean_std);
    const OfClass::Sums& sums = tables[k].sums[best];
    of.at = sums.first / sums.weight - driven[k].shapeOf(h.all[best], h);
    out.offset += sums.offset / sums.weight / static_cast<double>(driven.size());
    out.changed_offset += sums.changed / sums.weight / static_cast<double>(driven.size());
  }
  return out;
}

}  // namespace talus::costmap
