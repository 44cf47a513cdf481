#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Core>
#include <fmt/format.h>

#include <talus/terramech/calibration/tables/soil_groups.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>

namespace talus::terramech {
namespace {

constexpr double kLarge = 0.5;   // mean deviation of a group, in standard deviations of one reading
constexpr double kChance = 5.0;  // threshold of excess(), in standard deviations of chi-squared

struct Group {
  double rows = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();  // of whitened residuals (W, T)

  double departure() const { return sum.norm() / rows; }
  double chiSquared() const { return sum.squaredNorm() / rows; }
};

std::vector<Eigen::Vector2d> residuals(const WheelRows& rows, const SoilPosterior& p,
                                       const ReadingErrors& noise) {
  SoilClass soil;
  const ContactSoil& m = p.mean;
  soil.parameters = {Marginal::fixed(m.cohesion_Pa), Marginal::fixed(m.friction_angle_rad),
                     Marginal::fixed(m.sinkage_exponent), Marginal::fixed(m.sinkage_modulus),
                     Marginal::fixed(m.shear_modulus_m)};
  soil.c1 = m.c1;
  soil.c2 = m.c2;
  const SoilObjective objective(soil, {.noise = noise, .outlier_share = 0.0});
  std::vector<Eigen::Vector2d> all;
  for (const WheelReading& r : rows.readings())
    all.push_back(objective.misfit(SoilVector::Zero(), r).residual);
  return all;
}

// Excess of a column's chi-squared over its expected value, in standard deviations; 0 if no group deviates by
// more than kLarge.
double excess(const std::map<std::string, Group>& groups) {
  double sum = 0.0, largest = 0.0;
  for (const auto& [name, group] : groups) {
    sum += group.chiSquared();
    if (group.rows > 1.0) largest = std::max(largest, group.departure());
  }
  const double expected = 2.0 * static_cast<double>(groups.size());
  return largest > kLarge ? (sum - expected) / std::sqrt(2.0 * expected) : 0.0;
}

}  // namespace

std::string groupsThatDisagree(const WheelRows& rows, const SoilPosterior& posterior,
                               const ReadingErrors& noise) {
  const std::vector<Eigen::Vector2d> residual = residuals(rows, posterior, noise);
  const std::string* worst = nullptr;
  std::map<std::string, Group> worst_groups;
  double most = kChance;
  for (const Telemetry::Words& column : rows.words) {
    std::map<std::string, Group> groups;
    for (std::size_t k = 0; k < residual.size(); ++k) {
      Group& group = groups[column.values[k]];
      group.rows += 1.0;
      group.sum += residual[k];
    }
    if (groups.size() < 2 || 2 * groups.size() > residual.size()) continue;
    if (const double beyond = excess(groups); beyond > most)
      most = beyond, worst = &column.name, worst_groups = groups;
  }
  if (worst == nullptr) return {};
  const auto& [name, group] = *std::ranges::max_element(
      worst_groups, {}, [](const auto& entry) { return entry.second.chiSquared(); });
  return fmt::format(
      "one soil does not fit all values of {0}: mean residual {2:.1f} sigma at {0} = {1}; split the file by "
      "{0}",
      *worst, name, group.departure());
}

}  // namespace talus::terramech
