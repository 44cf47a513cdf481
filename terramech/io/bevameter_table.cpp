#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <talus/common/common.hpp>
#include <talus/terramech/io/bevameter_table.hpp>
#include <talus/terramech/io/terramech_io.hpp>

namespace talus::terramech {
namespace {

const std::vector<double>* either(const Telemetry& table, const char* name, const char* other) {
  const auto* column = table.find(name);
  return column != nullptr ? column : table.find(other);
}

// Returns a key of the test of each row: text columns with at most half as many distinct values as rows, and
// the columns `trial` and `test`.
std::vector<std::string> testsOf(const Telemetry& table) {
  std::vector<std::string> keys(table.size());
  for (const auto& column : table.words) {
    const std::set<std::string> words(column.values.begin(), column.values.end());
    for (std::size_t row = 0; row < keys.size() && 2 * words.size() <= keys.size(); ++row)
      keys[row] += column.values[row] + '\n';
  }
  for (const char* name : {"trial", "test"})
    if (const auto* column = table.find(name))
      for (std::size_t row = 0; row < keys.size(); ++row) keys[row] += std::to_string((*column)[row]) + '\n';
  return keys;
}

std::string soilOf(const Telemetry& table, std::size_t row) {
  for (const auto& column : table.words)
    if (column.name == "soil") return column.values[row];
  return {};
}

// Returns the diameter of the round plate with area F/p of each row, rounded to 0.1 mm, from the median of
// the test. NaN if the area varies within a test by more than 1 % (5 % to 95 % quantile).
std::vector<double> widthsOfRoundPlates(const Telemetry& table, const std::vector<double>& force,
                                        const std::vector<double>& pressure) {
  constexpr double kSpread = 0.01;
  constexpr double kRounding = 1e-4;
  const std::vector<std::string> tests = testsOf(table);
  std::map<std::string, std::vector<double>> areas;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (force[k] > 0.0 && pressure[k] > 0.0) areas[tests[k]].push_back(force[k] / pressure[k]);
  }
  std::vector<double> widths(table.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < table.size(); ++k) {
    auto& area = areas[tests[k]];
    if (area.empty()) continue;
    std::ranges::sort(area);
    const double low = area[area.size() / 20], high = area[area.size() - 1 - area.size() / 20];
    if (high > (1.0 + kSpread) * low) continue;
    const double diameter = 2.0 * std::sqrt(area[area.size() / 2] / std::numbers::pi);
    widths[k] = kRounding * std::round(diameter / kRounding);
  }
  return widths;
}

}  // namespace

BevameterTable readBevameterTable(const TableFile& file, double plate_width_m, const ProgressMonitor& watch) {
  const Telemetry table = readTelemetry(file, {}, watch);
  const auto* normal = table.find("normal_stress_Pa");
  const auto* shear = table.find("shear_stress_Pa");
  const auto* moved = table.find("shear_displacement_m");
  const auto* width = either(table, "plate_width_m", "plate_d_m");
  const auto* pressure = either(table, "pressure_Pa", "p_Pa");
  const auto* sinkage = either(table, "sinkage_m", "z_m");
  const auto* force = table.find("F_N");
  BevameterTable result{.shear = {}, .plates = {}, .rejected = table.rejected};
  std::vector<double> widths;
  if (plate_width_m > 0.0) {
    widths.assign(table.size(), plate_width_m);
  } else if (width == nullptr && force != nullptr && pressure != nullptr) {
    widths = widthsOfRoundPlates(table, *force, *pressure);
    result.width_from_force = true;
  }
  if (!widths.empty()) width = &widths;
  const bool sheared = normal != nullptr && shear != nullptr && moved != nullptr;
  const bool pressed = width != nullptr && pressure != nullptr && sinkage != nullptr;
  if (!sheared && !pressed) {
    throw InputError({.where = table.source,
                      .reason = "lacks the columns of a plate test or a shear test",
                      .remedy = "a shear test has normal_stress_Pa, shear_stress_Pa, shear_displacement_m; a "
                                "pressure-sinkage test plate_width_m (or state --plate-width), pressure_Pa, "
                                "sinkage_m"});
  }
  const std::vector<std::string> tests = testsOf(table);
  std::map<std::string, std::size_t> trials;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const bool shear_row = sheared && (*normal)[k] >= 0.0 && std::isfinite((*shear)[k]) && (*moved)[k] > 0.0;
    const bool press_row = pressed && (*width)[k] > 0.0 && (*pressure)[k] > 0.0 && (*sinkage)[k] > 0.0;
    if (shear_row) result.shear.push_back({(*normal)[k], (*shear)[k], (*moved)[k]});
    if (press_row) {
      const auto [at, fresh] = trials.try_emplace(tests[k], result.plates.size());
      if (fresh) result.plates.push_back({soilOf(table, k), at->first, {}});
      result.plates[at->second].readings.push_back({(*width)[k], (*sinkage)[k], (*pressure)[k]});
    }
    if (shear_row || press_row) continue;
    const bool no_plate = result.width_from_force && (*pressure)[k] > 0.0 && std::isnan((*width)[k]);
    result.rejected.push_back(
        {table.lines[k], no_plate ? "F_N / pressure changes during the test: the plate is not flat"
                                  : "unloaded: pressure, sinkage or shear displacement is not above 0"});
  }
  if (!result.shear.empty() || !result.plates.empty()) return result;
  throw InputError({.where = table.source,
                    .reason = "no usable row",
                    .remedy = "pressures and displacements must be > 0"});
}

}  // namespace talus::terramech
