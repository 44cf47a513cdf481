#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include <talus/terramech/io/wheel_rows.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::terramech {

namespace {

// Returns the wheel of each row: that of the option `rover`, otherwise that of the file's columns.
std::vector<Wheel> wheelsOf(const Telemetry& table, const WheelRowOptions& options) {
  if (!options.rover.empty()) return {table.size(), loadRover(options.rover).wheel};
  const auto* radius = table.find("wheel_radius_m");
  const auto* width = table.find("wheel_width_m");
  if (radius == nullptr || width == nullptr) {
    throw InputError(
        {.where = table.source,
         .reason = fmt::format("lacks column {}", radius == nullptr ? "wheel_radius_m" : "wheel_width_m"),
         .remedy = "add it, or pass --rover"});
  }
  std::vector<Wheel> wheels;
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!std::isfinite((*radius)[k]) || !std::isfinite((*width)[k])) {
      throw InputError({.where = fmt::format("{}:{}", table.source, table.lines[k]),
                        .reason = "has no wheel_radius_m or wheel_width_m",
                        .remedy = "fill it in, or pass --rover"});
    }
    wheels.push_back({.radius_m = (*radius)[k], .width_m = (*width)[k]});
  }
  return wheels;
}

bool sameSize(const Wheel& a, const Wheel& b) {
  return a.radius_m == b.radius_m && a.width_m == b.width_m;
}

std::optional<std::string> unusable(const WheelSample& s, const Wheel& wheel, double slip_angle_rad,
                                    const WheelRowOptions& options) {
  if (std::abs(slip_angle_rad) > kStraightUpTo_rad)
    return fmt::format(
        "slip_angle_rad = {:g}: only straight wheels are evaluated here; pass a --model, or wong-reece with "
        "side_force_N",
        slip_angle_rad);
  if (!(s.sinkage_m > 0.0)) return "sinkage_m = 0: no contact area to infer stresses from";
  if (s.sinkage_m >= options.deepest * wheel.radius_m)
    return fmt::format("sinkage_m = {:g}, must be < {:g}: the wheel model ends at the axle", s.sinkage_m,
                       options.deepest * wheel.radius_m);
  if (options.needs_slip && !(s.slip > 0.0))
    return fmt::format("slip = {:g}, must be > 0 (driven wheel)", s.slip);
  return std::nullopt;
}

// Returns why a row is rejected that has a side force but no slip angle; a straight wheel has slip angle 0.
std::string angleFault(const Telemetry& table, std::size_t row) {
  const auto* force = table.find("side_force_N");
  const auto* angle = table.find("slip_angle_rad");
  if (force == nullptr || !std::isfinite((*force)[row]) || (*force)[row] == 0.0) return {};
  if (angle != nullptr && std::isfinite((*angle)[row])) return {};
  return fmt::format(
      "side_force_N = {:g} without slip_angle_rad, which is needed to interpret the force; fill it in, 0 for "
      "a "
      "straight "
      "wheel",
      (*force)[row]);
}

[[noreturn]] void refuseAll(const std::string& source, const std::vector<RejectedRow>& rejected) {
  throw InputError(
      {fmt::format("{}:{}", source, rejected.front().line), "no usable row: " + rejected.front().reason, ""});
}

// Moves each row with a fault to the rejected rows; `faults` has one text per row.
void leaveOut(Telemetry& t, const std::vector<std::string>& faults) {
  for (std::size_t row = 0; row < faults.size(); ++row) {
    if (faults[row].empty()) continue;
    t.rejected.push_back({.line = t.lines[row], .reason = faults[row]});
    for (Telemetry::Numbers& column : t.rejected_numbers) column.values.push_back(t.at(column.name)[row]);
  }
  const auto keep = [&](auto& values) {
    std::size_t to = 0;
    for (std::size_t row = 0; row < faults.size(); ++row)
      if (faults[row].empty()) values[to++] = values[row];
    values.resize(to);
  };
  for (Telemetry::Numbers& column : t.numbers) keep(column.values);
  for (Telemetry::Words& column : t.words) keep(column.values);
  keep(t.lines);
}

// Returns the numeric columns that an estimator of straight wheels does not use. The caller uses the shear
// modulus.
std::vector<std::string> ignoredOf(const Telemetry& table) {
  constexpr std::string_view kRead[] = {"load_N",         "torque_Nm",      "sinkage_m",
                                        "slip",           "slip_angle_rad", "side_force_N",
                                        "wheel_radius_m", "wheel_width_m",  "shear_modulus_m"};
  std::vector<std::string> ignored;
  for (const Telemetry::Numbers& column : table.numbers)
    if (std::ranges::find(kRead, column.name) == std::end(kRead)) ignored.push_back(column.name);
  return ignored;
}

}  // namespace

void leaveOutWithoutSlipAngle(Telemetry& telemetry) {
  std::vector<std::string> faults;
  for (std::size_t row = 0; row < telemetry.size(); ++row) faults.push_back(angleFault(telemetry, row));
  leaveOut(telemetry, faults);
  if (telemetry.size() > 0) return;
  refuseAll(telemetry.source, telemetry.rejected);
}

WheelRows readWheelRows(const TableFile& file, const WheelRowOptions& options, const ProgressMonitor& watch) {
  TelemetryOptions reading{.required = {"load_N", "torque_Nm", "sinkage_m"}};
  if (options.needs_slip) reading.required.emplace_back("slip");
  if (!options.rover.empty()) reading.wheel_radius_m = loadRover(options.rover).wheel.radius_m;
  Telemetry table = readTelemetry(file, reading, watch);
  leaveOutWithoutSlipAngle(table);
  const std::vector<Wheel> wheels = wheelsOf(table, options);
  WheelRows rows{.source = table.source,
                 .wheel = wheels.front(),
                 .samples = {},
                 .wheels = {},
                 .lines = {},
                 .ignored = ignoredOf(table),
                 .rejected = table.rejected};
  const auto* slip = table.find("slip");
  const auto* slip_angle = table.find("slip_angle_rad");
  for (std::size_t k = 0; k < table.size(); ++k) {
    const WheelSample sample{.load_N = table.at("load_N")[k],
                             .torque_Nm = table.at("torque_Nm")[k],
                             .sinkage_m = table.at("sinkage_m")[k],
                             .slip = slip == nullptr || std::isnan((*slip)[k]) ? 0.0 : (*slip)[k]};
    if (const auto reason =
            unusable(sample, wheels[k], slip_angle == nullptr ? 0.0 : (*slip_angle)[k], options)) {
      rows.rejected.push_back({.line = table.lines[k], .reason = *reason});
      continue;
    }
    if (rows.samples.empty()) rows.wheel = wheels[k];
    rows.one_wheel = rows.one_wheel && sameSize(rows.wheel, wheels[k]);
    rows.samples.push_back(sample);
    rows.wheels.push_back(wheels[k]);
    rows.lines.push_back(table.lines[k]);
  }
  std::ranges::stable_sort(rows.rejected, {}, &RejectedRow::line);
  if (!rows.samples.empty()) return rows;
  refuseAll(rows.source, rows.rejected);
}

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
