#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <boost/container/small_vector.hpp>

#include <talus/costmap/evidence/spreading.hpp>

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

GaussianProcess::GaussianProcess(std::vector<PlaceEvidence> evidence, const Variation& variation)
    : evidence_(std::move(evidence)), variation_(variation) {
  const std::size_t n = evidence_.size();
  const double prior = variation_.pull_std * variation_.pull_std;
  const double most_sinkage = kOrdinary * variation_.sinkage_std;
  for (PlaceEvidence& e : evidence_) {
    e.pull = std::min(e.pull, kOrdinary * std::sqrt(prior + e.variance));
    e.sinkage = e.sinkage < -most_sinkage ? -most_sinkage : e.sinkage;
  }
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

double withSharedError(const SharedError& error) noexcept {
  const double explained = std::fmax(error.prior - error.variance, 0.0), c2 = error.shared * error.shared;
  return explained > 0.0 && c2 > 0.0 ? (error.variance * explained + error.prior * c2) / (explained + c2)
                                     : std::fmin(error.variance, error.prior);
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
  double sum = 0.0, positive = 0.0;
  for (const double w : weight) {
    sum += w;
    positive += std::max(0.0, w);
  }
  const double scale = positive > 0.0 ? std::clamp(sum, 0.0, 1.0) / positive : 0.0;
  LearnedPlace out{.departure = {}, .any = true, .weight = std::clamp(sum, 0.0, 1.0), .positive = positive};
  GroundBelief& belief = out.departure;
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    const PlaceEvidence& e = evidence_[i];
    const double w = std::max(0.0, weight[i]);
    out.shared += scale * w * e.shared;
    belief.pull.value += (e.pull > 0.0 ? scale * w : w) * e.pull;
    if (!std::isnan(e.sinkage)) belief.sinkage.value += (e.sinkage < 0.0 ? scale * w : w) * e.sinkage;
  }
  const double left = std::sqrt(std::fmax(1.0 - explained, 0.0));
  belief.pull.std = left * variation_.pull_std;
  belief.sinkage.std = left * variation_.sinkage_std;
  return out;
}

namespace {

// Squared amplitude a^2 of estimateAlone(), in units of the class's variance.
double amplitude2(const Departure& reading, double class_std) noexcept {
  const double ordinary = reading.departure / kOrdinary;
  return std::fmax((ordinary * ordinary - reading.variance) / (class_std * class_std), 1.0);
}

}  // namespace

double estimateAlone(const Departure& reading, double class_std) noexcept {
  const double a2 = amplitude2(reading, class_std);
  return reading.departure * a2 / (a2 + reading.variance / (class_std * class_std));
}

namespace {

// Departure that a weak place implies. a2: squared amplitude at the place, in units of the class's variance.
std::optional<GroundBelief> leftBy(const WeakPlace& weak, double a2, const Variation& variation,
                                   const maps::Point& place) {
  const double off_m = std::hypot(place.x_m - weak.place.x_m, place.y_m - weak.place.y_m) - weak.reach_m;
  if (off_m > 0.0 && !weak.beyond_reach) return std::nullopt;
  const double k = costmap::sparseKernel(std::fmax(off_m, 0.0), variation.correlation_length_m);
  if (k <= 0.0) return std::nullopt;
  const double a = std::sqrt(a2), here = 1.0 + (a - 1.0) * k;
  const double share = a2 / (a2 + weak.variance / (variation.pull_std * variation.pull_std));
  return GroundBelief{
      .pull = {here / a * k * share * weak.pull,
               here * variation.pull_std * std::sqrt(std::fmax(1.0 - k * k * share, 0.0))},
      .sinkage = {k * weak.sinkage, variation.sinkage_std * std::sqrt(std::fmax(1.0 - k * k, 0.0))}};
}

}  // namespace

std::optional<GroundBelief> weakness(const WeakPlace& weak, const Variation& variation,
                                     const maps::Point& place) {
  return leftBy(weak, amplitude2({weak.pull, weak.variance}, variation.pull_std), variation, place);
}

std::optional<GroundBelief> lowered(const WeakPlace& place, const Variation& variation,
                                    const maps::Point& at) {
  return leftBy(place, 1.0, variation, at);
}

GroundBelief weaker(const GroundBelief& a, const GroundBelief& b) noexcept {
  constexpr double kTail = 6.0;
  const double pull = std::fmin(a.pull.value, b.pull.value);
  const double low = std::fmin(a.pull.value - kTail * a.pull.std, b.pull.value - kTail * b.pull.std);
  const double sinkage = std::fmax(a.sinkage.value, b.sinkage.value);
  const double deep =
      std::fmax(a.sinkage.value + kTail * a.sinkage.std, b.sinkage.value + kTail * b.sinkage.std);
  return {.pull = {pull, (pull - low) / kTail}, .sinkage = {sinkage, (deep - sinkage) / kTail}};
}

}  // namespace talus::costmap
