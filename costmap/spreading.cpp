#include <cmath>
#include <numbers>
#include <utility>

#include <talus/costmap/spreading.hpp>

namespace talus::costmap {
namespace {

// Most pairs lie too far apart: they cost a comparison.
double sparseKernel(const maps::Point& a, const maps::Point& b, double correlation_length_m) noexcept {
  const double x_m = a.x_m - b.x_m, y_m = a.y_m - b.y_m;
  const double squared = x_m * x_m + y_m * y_m;
  if (squared >= correlation_length_m * correlation_length_m) return 0.0;
  return costmap::sparseKernel(std::sqrt(squared), correlation_length_m);
}

// L of A = L L^T in place, row-major lower triangle; A is positive definite by its noise.
void factorise(std::vector<double>& a, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      a[i * n + j] = i == j ? std::sqrt(sum) : sum / a[j * n + j];
    }
}

// Zeros in front stay zeros.
void solveLower(const std::vector<double>& l, std::vector<double>& x) {
  const std::size_t n = x.size();
  std::size_t first = 0;
  while (first < n && x[first] == 0.0) ++first;
  for (std::size_t i = first; i < n; ++i) {
    for (std::size_t k = first; k < i; ++k) x[i] -= l[i * n + k] * x[k];
    x[i] /= l[i * n + i];
  }
}

void solveUpper(const std::vector<double>& l, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) x[i] -= l[k * n + i] * x[k];
    x[i] /= l[i * n + i];
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
  constexpr double kOrdinary = 2.0;  // standard deviations that its class explains
  const std::size_t n = evidence_.size();
  const double prior = variation_.pull_std * variation_.pull_std;
  for (const PlaceEvidence& e : evidence_) {
    const double needed = (e.pull * e.pull / (kOrdinary * kOrdinary) - e.variance) / prior;
    excess_.push_back(std::sqrt(std::fmax(needed, 1.0)) - 1.0);
  }
  for (const PlaceEvidence& e : evidence_) amplitude_.push_back(amplitude(e.place));
  factor_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      factor_[i * n + j] =
          amplitude_[i] * amplitude_[j] *
          sparseKernel(evidence_[i].place, evidence_[j].place, variation_.correlation_length_m);
    factor_[i * n + i] += evidence_[i].variance / prior;
    pull_.push_back(evidence_[i].pull);
    sinkage_.push_back(evidence_[i].sinkage);
  }
  factorise(factor_, n);
  for (std::vector<double>* y : {&pull_, &sinkage_}) {
    solveLower(factor_, *y);
    solveUpper(factor_, *y);
  }
}

double GaussianProcess::amplitude(const maps::Point& place) const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < evidence_.size(); ++i)
    if (excess_[i] > 0.0)
      most = std::fmax(most,
                       excess_[i] * sparseKernel(place, evidence_[i].place, variation_.correlation_length_m));
  return 1.0 + most;
}

GroundBelief GaussianProcess::at(const maps::Point& place) const {
  std::vector<double> k;
  k.reserve(evidence_.size());
  GroundBelief belief;
  const double here = amplitude(place);
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    k.push_back(here * amplitude_[i] *
                sparseKernel(place, evidence_[i].place, variation_.correlation_length_m));
    belief.pull.value += k[i] * pull_[i];
    belief.sinkage.value += k[i] * sinkage_[i];
  }
  solveLower(factor_, k);
  double explained = 0.0;
  for (const double v : k) explained += v * v;
  const double left = std::sqrt(std::fmax(here * here - explained, 0.0));
  belief.pull.std = left * variation_.pull_std;
  belief.sinkage.std = left * variation_.sinkage_std;
  return belief;
}

GroundBelief kernelInference(const std::vector<PlaceEvidence>& evidence, const Variation& variation,
                             const maps::Point& place) {
  const double prior = variation.pull_std * variation.pull_std;
  double weight = 1.0, pull = 0.0, sinkage = 0.0;
  for (const PlaceEvidence& e : evidence) {
    const double w = sparseKernel(place, e.place, variation.correlation_length_m) * prior / e.variance;
    weight += w;
    pull += w * e.pull;
    sinkage += w * e.sinkage;
  }
  const double left = 1.0 / std::sqrt(weight);
  return {.pull = {pull / weight, left * variation.pull_std},
          .sinkage = {sinkage / weight, left * variation.sinkage_std}};
}

}  // namespace talus::costmap
