#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include <talus/terramech/strength/plate_trials.hpp>

namespace talus::terramech {
namespace {

struct FittedTrial {
  PressureSinkage fit;
  double weight = 0.0, log_depth = 0.0;  ///< sum of sigma^2, and mean of ln z with these weights
};

std::optional<FittedTrial> fitted(const PlateTrial& trial) {
  PressureSinkageFit fitter;
  FittedTrial f;
  for (const PlateReading& r : trial.readings) {
    fitter.add(r);
    const double w = r.pressure_Pa * r.pressure_Pa;
    f.weight += w;
    f.log_depth += w * std::log(r.sinkage_m);
  }
  f.log_depth /= f.weight;
  try {
    f.fit = fitter.estimate();
  } catch (const std::domain_error&) {
    return {};
  }
  return f;
}

TrialSoil soilOf(const std::string& name, const std::vector<FittedTrial>& trials) {
  TrialSoil soil{.soil = name, .trials = trials.size()};
  double weight = 0.0, log_depth = 0.0;
  std::vector<Estimate> exponents;
  for (const FittedTrial& t : trials) {
    exponents.push_back({t.fit.sinkage_exponent, t.fit.exponent_std});
    weight += t.weight;
    log_depth += t.weight * t.log_depth;
  }
  log_depth /= weight;
  soil.depth_m = std::exp(log_depth);
  soil.exponent = randomEffect(exponents);
  soil.fit.sinkage_exponent = soil.exponent.mean.value;
  soil.fit.exponent_std = soil.exponent.mean.std;
  std::map<double, std::vector<Estimate>> pressures;  // pressures by plate size
  for (const FittedTrial& t : trials)
    for (const PlateModulus& p : t.fit.plates)
      pressures[p.plate_width_m].push_back(
          {std::log(p.sinkage_modulus) + t.fit.sinkage_exponent * log_depth,
           std::hypot(t.fit.residual_std / std::sqrt(static_cast<double>(trials.size())),
                      (log_depth - t.log_depth) * t.fit.exponent_std)});
  double freedom = 0.0;
  for (const auto& [width_m, values] : pressures) {
    const RandomEffect pressure = randomEffect(values);
    soil.fit.plates.push_back(
        {.plate_width_m = width_m,
         .sinkage_modulus = std::exp(pressure.mean.value - soil.fit.sinkage_exponent * log_depth)});
    const double free = static_cast<double>(values.size()) - 1.0;
    soil.pressure_spread += free * pressure.spread * pressure.spread;
    freedom += free;
  }
  soil.pressure_spread = freedom > 0.0 ? std::sqrt(soil.pressure_spread / freedom) : 0.0;
  separateModuli(soil.fit);
  return soil;
}

}  // namespace

RandomEffect randomEffect(std::span<const Estimate> values) {
  constexpr double kExact = 1e-12;  // limits the weight of a trial without scatter
  const auto weighted = [&](double between) {
    double sum = 0.0, square = 0.0, mean = 0.0;
    for (const Estimate& v : values) {
      const double w = 1.0 / (v.std * v.std + between + kExact);
      sum += w;
      square += w * w;
      mean += w * v.value;
    }
    return std::array{mean / sum, sum, square};
  };
  const auto [mean, sum, square] = weighted(0.0);
  double q = 0.0;
  for (const Estimate& v : values) q += std::pow(v.value - mean, 2) / (v.std * v.std + kExact);
  const double free = static_cast<double>(values.size()) - 1.0;
  const double between = free > 0.0 ? std::max(0.0, (q - free) / (sum - square / sum)) : 0.0;
  const auto at = weighted(between);
  return {{at[0], 1.0 / std::sqrt(at[1])}, std::sqrt(between)};
}

std::vector<TrialSoil> trialSoils(std::span<const PlateTrial> trials) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<FittedTrial>> of_soil;
  for (const PlateTrial& trial : trials) {
    if (std::ranges::find(names, trial.soil) == names.end()) names.push_back(trial.soil);
    if (auto f = fitted(trial)) of_soil[trial.soil].push_back(std::move(*f));
  }
  std::vector<TrialSoil> soils;
  for (const std::string& name : names) {
    const auto found = of_soil.find(name);
    if (found == of_soil.end())
      throw std::domain_error("pressure-sinkage: n is identifiable only with two depths per plate");
    soils.push_back(soilOf(name, found->second));
  }
  return soils;
}

}  // namespace talus::terramech
