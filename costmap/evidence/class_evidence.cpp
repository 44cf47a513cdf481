#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <talus/costmap/evidence/class_evidence.hpp>
#include <talus/costmap/evidence/spreading.hpp>

namespace talus::costmap {
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
  struct Heard {
    Source source;
    double mean, shared, variance;
  };
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
        const double variance = error + (faulty ? kFaultStd * kFaultStd * q2 : 1.0 / before.precision);
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
