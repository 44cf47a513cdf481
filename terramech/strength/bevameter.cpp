#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/strength/bevameter.hpp>
#include <talus/terramech/strength/strength_lines.hpp>

namespace talus::terramech {

namespace {

// Smallest ratio of plate widths b from which the moduli k_c/b and k_phi can be separated (ours): in one soil
// k = k_c/b + k_phi varies by 20 % and more between places.
constexpr double kLeastWidthRatio = 1.2;
constexpr double kLeastModulus_m = 1e-4;
constexpr double kMostModulus_m = 0.2;

std::string widthsRefusal(const std::vector<PlateModulus>& plates) {
  if (plates.size() < 2) return "one plate size: k_c/b and k_phi are not identifiable separately";
  const auto [narrow, wide] = std::ranges::minmax_element(plates, {}, &PlateModulus::plate_width_m);
  if (wide->plate_width_m > kLeastWidthRatio * narrow->plate_width_m) return {};
  return "plate sizes within 20 % of each other: k_c/b and k_phi are not identifiable separately";
}

}  // namespace

void separateModuli(PressureSinkage& fit) {
  fit.refused = widthsRefusal(fit.plates);
  if (!fit.refused.empty()) return;
  PairMoments line;
  for (const PlateModulus& p : fit.plates) line.add(1.0 / p.plate_width_m, p.sinkage_modulus);
  fit.cohesive_modulus = line.xy / line.xx;
  fit.frictional_modulus = line.y - line.xy / line.xx * line.x;
}

namespace {

MohrCoulombLine mobilisedLine(std::span<const ShearReading> readings, double modulus) {
  MohrCoulombLine line;
  for (const ShearReading& r : readings) {
    const double share = -std::expm1(-r.displacement_m / modulus);
    line.add({.normal_Pa = r.normal_Pa, .shear_Pa = r.shear_Pa / share}, share * share);
  }
  return line;
}

}  // namespace

PressureSinkage fitPressureSinkage(std::span<const PlateReading> readings) {
  const RangeCheck range("plate reading");
  std::vector<std::pair<double, PairMoments>> plates;  // width, and moments of ln z and ln sigma
  for (const PlateReading& r : readings) {
    range.above("plate_width_m", r.plate_width_m, 0.0);
    range.above("sinkage_m", r.sinkage_m, 0.0);
    range.above("pressure_Pa", r.pressure_Pa, 0.0);
    auto plate = std::ranges::find(plates, r.plate_width_m, &std::pair<double, PairMoments>::first);
    if (plate == plates.end()) plate = plates.insert(plates.end(), {r.plate_width_m, {}});
    plate->second.add(std::log(r.sinkage_m), std::log(r.pressure_Pa), squared(r.pressure_Pa));
  }
  PairMoments sum;
  for (const auto& [width_m, m] : plates)
    sum.xx += m.xx, sum.xy += m.xy, sum.yy += m.yy, sum.weight += m.weight;
  if (!(sum.xx > 0.0))
    throw std::domain_error("pressure-sinkage: n is identifiable only with two depths per plate");
  PressureSinkage fit;
  fit.sinkage_exponent = sum.xy / sum.xx;
  for (const auto& [width_m, m] : plates)
    fit.plates.push_back(
        {.plate_width_m = width_m, .sinkage_modulus = std::exp(m.y - fit.sinkage_exponent * m.x)});
  const double left = std::max(0.0, sum.yy - fit.sinkage_exponent * sum.xy);
  fit.residual_std = std::sqrt(left / sum.weight);
  const double free = static_cast<double>(readings.size()) - static_cast<double>(plates.size()) - 1.0;
  fit.exponent_std = std::sqrt(left / std::max(free, 1.0) / sum.xx);
  separateModuli(fit);
  return fit;
}

ShearFit fitShear(std::span<const ShearReading> readings) {
  if (readings.size() < 3) throw std::domain_error("shear test: at least three readings are required");
  const auto error = [&](double k) { return mobilisedLine(readings, k).relativeResidual(); };
  const Minimum best = globalMinimum(error, kLeastModulus_m, kMostModulus_m);
  return {.strength = mobilisedLine(readings, best.at).estimate(),
          .shear_modulus_m = best.at,
          .modulus_at_bound = best.at < 1.01 * kLeastModulus_m || best.at > 0.99 * kMostModulus_m};
}

namespace {

struct FittedTrial {
  PressureSinkage fit;
  double weight = 0.0, log_depth = 0.0;  ///< sum of sigma^2, and mean of ln z with these weights
};

std::optional<FittedTrial> fitted(const PlateTrial& trial) {
  FittedTrial f;
  for (const PlateReading& r : trial.readings) {
    const double w = r.pressure_Pa * r.pressure_Pa;
    f.weight += w;
    f.log_depth += w * std::log(r.sinkage_m);
  }
  f.log_depth /= f.weight;
  try {
    f.fit = fitPressureSinkage(trial.readings);
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
