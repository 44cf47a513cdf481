#include <algorithm>
#include <cmath>

#include <talus/terramech/estimate/state_population.hpp>

namespace talus::terramech {
namespace {

Estimate logLoad(const WheelSample& sample, const ReadingErrors& errors) {
  return {.value = std::log(sample.load_N), .std = errors.load.std(sample.load_N) / sample.load_N};
}

}  // namespace

void StatePopulation::Spread::add(const Estimate& reading) {
  count += 1.0;
  const double away = reading.value - mean;
  mean += away / count;
  squares += away * (reading.value - mean);
  error_variance += (reading.std * reading.std - error_variance) / count;
}

// Combines a reading with the population. V, the variance of the true values, is the variance of Student's
// predictive distribution of the readings minus the mean error variance.
Estimate StatePopulation::Spread::combine(const Estimate& reading) const {
  if (count <= 3.0) return reading;
  const double of_readings = squares / (count - 1.0) * (count + 1.0) / count * (count - 1.0) / (count - 3.0);
  const double least = error_variance / count;
  const double variance = std::max(of_readings - error_variance, least);
  const double share = variance / (variance + reading.std * reading.std);
  return {.value = mean + share * (reading.value - mean), .std = std::sqrt(share) * reading.std};
}

void StatePopulation::add(const WheelSample& sample, const ReadingErrors& errors) {
  log_load_.add(logLoad(sample, errors));
  slip_.add({.value = sample.slip, .std = errors.slip.std(sample.slip)});
}

Estimate StatePopulation::load(const WheelSample& sample, const ReadingErrors& errors) const {
  const Estimate log_load = log_load_.combine(logLoad(sample, errors));
  const double load = std::exp(log_load.value);
  return {.value = load, .std = log_load.std * load};
}

Estimate StatePopulation::slip(const WheelSample& sample, const ReadingErrors& errors) const {
  const Estimate slip = slip_.combine({.value = sample.slip, .std = errors.slip.std(sample.slip)});
  return {.value = std::clamp(slip.value, 0.0, 1.0), .std = slip.std};
}

}  // namespace talus::terramech
