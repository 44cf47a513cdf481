#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <talus/costmap/evidence/class_evidence.hpp>

namespace talus::costmap {

namespace {

// Kernel of two places. Most pairs are farther apart than the correlation length and need only one
// comparison.
double sparseKernel(const maps::Point& a, const maps::Point& b, double correlation_length_m) noexcept {
  const double x_m = a.x_m - b.x_m, y_m = a.y_m - b.y_m;
  const double squared = x_m * x_m + y_m * y_m;
  if (squared >= correlation_length_m * correlation_length_m) return 0.0;
  return costmap::sparseKernel(std::sqrt(squared), correlation_length_m);
}

}  // namespace

std::int64_t fixedPoint(double value) noexcept {
  return static_cast<std::int64_t>(std::llround(value * SourceReadings::kUnit));
}

double sparseKernel(double distance_m, double correlation_length_m) noexcept {
  const double d = distance_m / correlation_length_m;
  if (d >= 1.0) return 0.0;
  const double turn = 2.0 * std::numbers::pi * d;
  return (2.0 + std::cos(turn)) / 3.0 * (1.0 - d) + std::sin(turn) / (2.0 * std::numbers::pi);
}

double otherSoilProbability(double difference, double variance) noexcept {
  constexpr double kOtherSoil = 0.02, kOtherStd = 0.3;
  const double square = difference * difference;
  const double own = (1.0 - kOtherSoil) * std::exp(-0.5 * square / variance) / std::sqrt(variance);
  const double other = kOtherSoil * std::exp(-0.5 * square / (kOtherStd * kOtherStd)) / kOtherStd;
  return other / (own + other);
}

GaussianProcess::GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation)
    : evidence_(std::move(evidence)), variation_(variation) {
  const auto n = static_cast<Eigen::Index>(evidence_.size());
  const double prior = variation_.pull_std * variation_.pull_std;
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PlaceEvidence& own = evidence_[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < n; ++j)
      covariance(i, j) = sparseKernel(own.place, evidence_[static_cast<std::size_t>(j)].place,
                                      variation_.correlation_length_m);
    covariance(i, i) += own.variance / prior;
  }
  factor_.compute(covariance);
}

LearnedPlace GaussianProcess::learned(const maps::Point& place) const {
  Eigen::VectorXd kernel(static_cast<Eigen::Index>(evidence_.size()));
  for (Eigen::Index i = 0; i < kernel.size(); ++i)
    kernel[i] =
        sparseKernel(place, evidence_[static_cast<std::size_t>(i)].place, variation_.correlation_length_m);
  if (kernel.isZero(0.0))
    return {.departure = {.pull = {0.0, variation_.pull_std}, .sinkage = {0.0, variation_.sinkage_std}}};
  const Eigen::VectorXd weight = factor_.solve(kernel);
  const double explained = kernel.dot(weight);
  LearnedPlace out{.departure = {}, .any = true};
  GroundBelief& belief = out.departure;
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    const double w = weight[static_cast<Eigen::Index>(i)];
    out.weight += w;
    belief.pull.value += w * evidence_[i].pull;
    if (!std::isnan(evidence_[i].sinkage)) belief.sinkage.value += w * evidence_[i].sinkage;
  }
  const double left = std::sqrt(std::fmax(1.0 - explained, 0.0));
  belief.pull.std = left * variation_.pull_std;
  belief.sinkage.std = left * variation_.sinkage_std;
  return out;
}

namespace {

constexpr double kUnit = SourceReadings::kUnit;
// Prior probability that the sensors of a source are faulty, by Trust.
constexpr std::array<double, 3> kFaulty{0.5, 0.07, 0.001};
constexpr double kFaultStd = 2.0;      // departures that faulty sensors read, over mean_std
constexpr double kLeastError = 0.005;  // least error of a source [-]
constexpr double kWeightStep = 1.0 / 64.0;
constexpr double kDay_s = 86400.0;

// Rounded towards 0, so that little evidence leaves a class as it was.
double rounded(double value, double step) noexcept {
  return step > 0.0 ? std::trunc(value / step + std::copysign(1e-6, value)) * step : value;
}
double roundedUp(double value, double step, double most) noexcept {
  return step > 0.0 ? std::min(std::ceil(value / step - 1e-6) * step, most) : value;
}

// Departure that a source read, weighted over its places, and the correlation of the ground then with that of the
// source before, and with the present one.
struct Heard {
  Source source;
  double days, mean, shared, variance, before = 1.0, now = 1.0;
};

// Sorts sources by time and sets their correlations; the correlation time is in days, 0: no change.
void sortByTime(std::vector<Heard>& heard, double correlation_days) {
  double newest = 0.0;
  for (const Heard& one : heard) newest = std::max(newest, one.days);
  for (Heard& one : heard)
    if (one.days == 0.0) one.days = newest;
  std::ranges::stable_sort(heard, {}, &Heard::days);
  for (std::size_t i = 0; i < heard.size() && correlation_days > 0.0; ++i) {
    heard[i].before = std::exp((heard[i > 0 ? i - 1 : 0].days - heard[i].days) / correlation_days);
    heard[i].now = std::exp((heard[i].days - newest) / correlation_days);
  }
}

// A hypothesis while sources are added: log of its weight, mean and variance of D'.
struct Hypothesis {
  double log_weight, mean, variance;
  std::vector<bool> faulty{};

  // Returns the hypothesis with one more source, sound or faulty, whose reading has the variance `of_ground` beside
  // that of its error.
  Hypothesis with(const Heard& one, double of_ground, bool is_faulty) const {
    Hypothesis h = *this;
    const double of_fault = kFaulty[static_cast<std::size_t>(one.source.trust)];
    const double all = one.variance + of_ground, off = one.mean - (is_faulty ? 0.0 : mean);
    h.log_weight += std::log(is_faulty ? of_fault : 1.0 - of_fault) - 0.5 * (std::log(all) + off * off / all);
    if (!is_faulty) {
      h.mean += variance / all * off;
      h.variance *= one.variance / all;
    }
    h.faulty.push_back(is_faulty);
    return h;
  }
};

}  // namespace

void ClassEvidence::count(std::span<const SourcePull> pulls, double prior, double places, int sign) {
  const double variance = ground_.pull_std * ground_.pull_std, q = ground_.mean_std;
  double most = 0.0;
  for (const SourcePull& one : pulls) {
    const double departure = one.pull - prior, shared2 = one.shared * one.shared;
    const double weight =
        places * variance / (variance + one.variance()) *
        (1.0 - otherSoilProbability(departure, variance + q * q + one.variance() + shared2));
    Sums& sums = sources_[one.source];
    sums.weight += sign * fixedPoint(weight);
    sums.departure += sign * fixedPoint(weight * departure);
    sums.shared += sign * fixedPoint(weight * one.shared);
    sums.days += sign * fixedPoint(weight * one.time_s / kDay_s);
    if (sums.weight == 0) sources_.erase(one.source);
    most = std::max(most, weight);
  }
  places_ += sign * fixedPoint(most);
}

void ClassEvidence::countSinkage(double departure, double places, int sign) {
  const double limit = 2.0 * ground_.sinkage_std;  // a deeper place counts as that deep
  sinkage_.weight += sign * fixedPoint(places);
  sinkage_.departure += sign * fixedPoint(places * std::clamp(departure, -limit, limit));
}

double ClassEvidence::places() const noexcept {
  return static_cast<double>(places_) / kUnit;
}

ClassState ClassEvidence::state(double step) const {
  const double p2 = ground_.pull_std * ground_.pull_std, q2 = ground_.mean_std * ground_.mean_std;
  const double of_places = places_ > 0 ? p2 / places() : 0.0;
  std::vector<Heard> heard;
  for (const auto& [source, sums] : sources_) {
    const double weight = static_cast<double>(sums.weight);
    const double shared = std::max(static_cast<double>(sums.shared) / weight, kLeastError);
    heard.push_back({source, static_cast<double>(sums.days) / weight,
                     static_cast<double>(sums.departure) / weight, shared,
                     shared * shared + std::max(p2 * kUnit / weight - of_places, 0.0)});
  }
  sortByTime(heard, ground_.soil.correlation_time_s / kDay_s);
  std::vector<Hypothesis> all{{0.0, 0.0, q2 + of_places}};
  for (const Heard& one : heard) {
    std::vector<Hypothesis> next;
    for (Hypothesis h : all) {
      h.mean *= one.before;
      h.variance = one.before * one.before * h.variance + (1.0 - one.before * one.before) * (q2 + of_places);
      next.push_back(h.with(one, kFaultStd * kFaultStd * q2 + of_places, true));
      next.push_back(h.with(one, h.variance, false));
    }
    std::ranges::stable_sort(next, std::greater{}, &Hypothesis::log_weight);
    if (next.size() > kMost) next.resize(kMost);
    all = std::move(next);
  }
  ClassState state;
  if (heard.empty()) all.clear(), state.hypotheses.push_back({.own_std = ground_.mean_std});
  double sum = 0.0;
  for (const Hypothesis& h : all) {
    const double share = q2 / (q2 + of_places);
    const double own = roundedUp(std::sqrt(q2 * (1.0 - share)), step, std::sqrt(q2));
    ClassHypothesis one{.weight = std::exp(h.log_weight - all.front().log_weight),
                        .pull = rounded(share * h.mean, step),
                        .own_std = own,
                        .shared_std = roundedUp(share * std::sqrt(h.variance), step,
                                                std::sqrt(std::max(q2 - own * own, 0.0)))};
    for (std::size_t i = 0; i < heard.size(); ++i) {
      const auto& [source, days, mean, shared, variance, before, now] = heard[i];
      const double changed = q2 * (1.0 - now * now);
      if (!h.faulty[i])
        one.sound.emplace_back(
            source, rounded((now - 1.0) * h.mean +
                                (mean - now * h.mean) * (shared * shared + changed) / (variance + changed),
                            step));
    }
    std::ranges::sort(one.sound);
    if (step > 0.0) one.weight = rounded(one.weight, kWeightStep);
    if (!(one.weight > 0.0)) continue;
    sum += one.weight;
    state.hypotheses.push_back(std::move(one));
  }
  for (ClassHypothesis& h : state.hypotheses) h.weight /= sum > 0.0 ? sum : 1.0;
  const double weight = static_cast<double>(sinkage_.weight) / kUnit;
  const double ratio2 = q2 / p2;  // variance of the class mean over that of places
  state.sinkage =
      rounded(ratio2 * static_cast<double>(sinkage_.departure) / kUnit / (ratio2 * weight + 1.0), step);
  return state;
}

}  // namespace talus::costmap
