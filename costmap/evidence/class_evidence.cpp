#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <boost/container/small_vector.hpp>

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

// Replaces A by U of A = U^T U: row-major upper triangle with reciprocal diagonal. The noise makes A positive
// definite. The inner loops here and below run along rows without a running sum, so that their steps are
// independent.
void factorise(std::vector<double>& a, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    double* const row = a.data() + j * n;
    row[j] = 1.0 / std::sqrt(row[j]);
    for (std::size_t k = j + 1; k < n; ++k) row[k] *= row[j];
    for (std::size_t i = j + 1; i < n; ++i) {
      const double factor = row[i];
      if (factor == 0.0) continue;
      double* const below = a.data() + i * n;
      for (std::size_t k = i; k < n; ++k) below[k] -= factor * row[k];
    }
  }
}

// Solves U^T x = b in place; leading zeros are skipped.
void solveLower(const std::vector<double>& u, std::span<double> x) {
  const std::size_t n = x.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (x[k] == 0.0) continue;
    const double* const row = u.data() + k * n;
    const double value = x[k] *= row[k];
    for (std::size_t i = k + 1; i < n; ++i) x[i] -= row[i] * value;
  }
}

// Solves U x = b in place; l is the transpose of U.
void solveUpper(const std::vector<double>& l, std::span<double> x) {
  for (std::size_t k = x.size(); k-- > 0;) {
    const double* const row = l.data() + k * x.size();
    const double value = x[k] *= row[k];
    for (std::size_t i = 0; i < k; ++i) x[i] -= row[i] * value;
  }
}

}  // namespace

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
  const std::size_t n = evidence_.size();
  const double prior = variation_.pull_std * variation_.pull_std;
  factor_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j)
      factor_[i * n + j] =
          sparseKernel(evidence_[i].place, evidence_[j].place, variation_.correlation_length_m);
    factor_[i * n + i] += evidence_[i].variance / prior;
  }
  factorise(factor_, n);
  transposed_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i; j < n; ++j) transposed_[j * n + i] = factor_[i * n + j];
}

LearnedPlace GaussianProcess::learned(const maps::Point& place) const {
  boost::container::small_vector<double, 64> weight;
  for (const PlaceEvidence& e : evidence_)
    weight.push_back(sparseKernel(place, e.place, variation_.correlation_length_m));
  if (std::ranges::all_of(weight, [](double k) { return k == 0.0; }))
    return {.departure = {.pull = {0.0, variation_.pull_std}, .sinkage = {0.0, variation_.sinkage_std}}};
  solveLower(factor_, {weight.data(), weight.size()});
  double explained = 0.0;
  for (const double v : weight) explained += v * v;
  solveUpper(transposed_, {weight.data(), weight.size()});
  LearnedPlace out{.departure = {}, .any = true};
  GroundBelief& belief = out.departure;
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    out.weight += weight[i];
    belief.pull.value += weight[i] * evidence_[i].pull;
    if (!std::isnan(evidence_[i].sinkage)) belief.sinkage.value += weight[i] * evidence_[i].sinkage;
  }
  const double left = std::sqrt(std::fmax(1.0 - explained, 0.0));
  belief.pull.std = left * variation_.pull_std;
  belief.sinkage.std = left * variation_.sinkage_std;
  return out;
}

namespace {

constexpr double kUnit = 1048576.0;  // fixed-point units per 1
// Prior probability that the sensors of a source are faulty, by Trust.
constexpr std::array<double, 3> kFaulty{0.5, 0.07, 0.001};
constexpr double kFaultStd = 2.0;      // departures that faulty sensors read, over mean_std
constexpr double kLeastError = 0.005;  // least error of a source [-]
constexpr double kWeightStep = 1.0 / 64.0;

std::int64_t fixed(double value) {
  return static_cast<std::int64_t>(std::llround(value * kUnit));
}

// Rounded towards 0, so that little evidence leaves a class as it was.
double rounded(double value, double step) noexcept {
  return step > 0.0 ? std::trunc(value / step + std::copysign(1e-6, value)) * step : value;
}
double roundedUp(double value, double step, double most) noexcept {
  return step > 0.0 ? std::min(std::ceil(value / step - 1e-6) * step, most) : value;
}

// A hypothesis while sources are added: log of its weight, precision of D', and mean of D' times precision.
struct Hypothesis {
  double log_weight, precision, sum;
  std::vector<bool> faulty{};
};

// Departure that a source read, weighted over its places.
struct Heard {
  Source source;
  double mean, shared, variance;
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
    sums.weight += sign * fixed(weight);
    sums.departure += sign * fixed(weight * departure);
    sums.shared += sign * fixed(weight * one.shared);
    if (sums.weight == 0) sources_.erase(one.source);
    most = std::max(most, weight);
  }
  places_ += sign * fixed(most);
}

void ClassEvidence::countSinkage(double departure, double places, int sign) {
  const double limit = 2.0 * ground_.sinkage_std;  // a deeper place counts as that deep
  sinkage_.weight += sign * fixed(places);
  sinkage_.departure += sign * fixed(places * std::clamp(departure, -limit, limit));
}

double ClassEvidence::places() const noexcept {
  return static_cast<double>(places_) / kUnit;
}

ClassState ClassEvidence::state(double step) const {
  const double p2 = ground_.pull_std * ground_.pull_std, q2 = ground_.mean_std * ground_.mean_std;
  const double of_places = places_ > 0 ? p2 / places() : 0.0;
  std::vector<Hypothesis> all{{0.0, 1.0 / (q2 + of_places), 0.0}};
  std::vector<Heard> heard;
  for (const auto& [source, sums] : sources_) {
    const double weight = static_cast<double>(sums.weight) / kUnit;
    const double shared = std::max(static_cast<double>(sums.shared) / kUnit / weight, kLeastError);
    heard.push_back({source, static_cast<double>(sums.departure) / kUnit / weight, shared,
                     shared * shared + std::max(p2 / weight - of_places, 0.0)});
    std::vector<Hypothesis> next;
    for (const Hypothesis& before : all)
      for (const bool faulty : {false, true}) {
        const double of_fault = kFaulty[static_cast<std::size_t>(source.trust)],
                     error = heard.back().variance;
        const double variance =
            error + (faulty ? kFaultStd * kFaultStd * q2 + of_places : 1.0 / before.precision);
        const double off = heard.back().mean - (faulty ? 0.0 : before.sum / before.precision);
        Hypothesis h = before;
        h.log_weight +=
            std::log(faulty ? of_fault : 1.0 - of_fault) - 0.5 * (std::log(variance) + off * off / variance);
        h.precision += faulty ? 0.0 : 1.0 / error;
        h.sum += faulty ? 0.0 : heard.back().mean / error;
        h.faulty.push_back(faulty);
        next.push_back(std::move(h));
      }
    std::ranges::stable_sort(next, std::greater{}, &Hypothesis::log_weight);
    if (next.size() > kMost) next.resize(kMost);
    all = std::move(next);
  }
  ClassState state;
  if (heard.empty()) all.clear(), state.hypotheses.push_back({.own_std = ground_.mean_std});
  double sum = 0.0;
  for (const Hypothesis& h : all) {
    const double share = q2 / (q2 + of_places), mean = h.sum / h.precision;
    const double own = roundedUp(std::sqrt(q2 * (1.0 - share)), step, std::sqrt(q2));
    ClassHypothesis one{.weight = std::exp(h.log_weight - all.front().log_weight),
                        .pull = rounded(share * mean, step),
                        .own_std = own,
                        .shared_std = roundedUp(share / std::sqrt(h.precision), step,
                                                std::sqrt(std::max(q2 - own * own, 0.0)))};
    for (std::size_t i = 0; i < heard.size(); ++i)
      if (!h.faulty[i])
        one.sound.emplace_back(
            heard[i].source,
            rounded((heard[i].mean - mean) * heard[i].shared * heard[i].shared / heard[i].variance, step));
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
