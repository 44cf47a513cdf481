#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <talus/terramech/numerics/range.hpp>
#include <talus/terramech/numerics/scalar_minimum.hpp>
#include <talus/terramech/strength/bevameter.hpp>

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
  double mean_x = 0.0;
  double mean_k = 0.0;
  const auto n = static_cast<double>(fit.plates.size());
  for (const PlateModulus& p : fit.plates)
    mean_x += 1.0 / p.plate_width_m / n, mean_k += p.sinkage_modulus / n;
  double xx = 0.0;
  double xk = 0.0;
  for (const PlateModulus& p : fit.plates) {
    const double dx = 1.0 / p.plate_width_m - mean_x;
    xx += dx * dx;
    xk += dx * (p.sinkage_modulus - mean_k);
  }
  fit.cohesive_modulus = xk / xx;
  fit.frictional_modulus = mean_k - xk / xx * mean_x;
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

void PressureSinkageFit::add(const PlateReading& reading) {
  const RangeCheck range("plate reading");
  range.above("plate_width_m", reading.plate_width_m, 0.0);
  range.above("sinkage_m", reading.sinkage_m, 0.0);
  range.above("pressure_Pa", reading.pressure_Pa, 0.0);
  auto plate = std::ranges::find(plates_, reading.plate_width_m, &Plate::width_m);
  if (plate == plates_.end()) plate = plates_.insert(plates_.end(), Plate{.width_m = reading.plate_width_m});
  const double w = reading.pressure_Pa * reading.pressure_Pa;
  const double x = std::log(reading.sinkage_m);
  const double y = std::log(reading.pressure_Pa);
  const double dx = x - plate->x;
  const double dy = y - plate->y;
  plate->weight += w;
  plate->x += dx * w / plate->weight;
  plate->y += dy * w / plate->weight;
  plate->xx += w * dx * (x - plate->x);
  plate->xy += w * dx * (y - plate->y);
  plate->yy += w * dy * (y - plate->y);
  ++count_;
}

PressureSinkage PressureSinkageFit::estimate() const {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  double weight = 0.0;
  for (const Plate& p : plates_) xx += p.xx, xy += p.xy, yy += p.yy, weight += p.weight;
  if (!(xx > 0.0))
    throw std::domain_error("pressure-sinkage: n is identifiable only with two depths per plate");
  PressureSinkage fit;
  fit.sinkage_exponent = xy / xx;
  for (const Plate& p : plates_) {
    fit.plates.push_back(
        {.plate_width_m = p.width_m, .sinkage_modulus = std::exp(p.y - fit.sinkage_exponent * p.x)});
  }
  const double left = std::max(0.0, yy - fit.sinkage_exponent * xy);
  fit.residual_std = std::sqrt(left / weight);
  const double free = static_cast<double>(count_) - static_cast<double>(plates_.size()) - 1.0;
  fit.exponent_std = std::sqrt(left / std::max(free, 1.0) / xx);
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

}  // namespace talus::terramech
