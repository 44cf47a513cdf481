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

}  // namespace talus::costmap
