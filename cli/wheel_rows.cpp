#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <cli/wheel_rows.hpp>
#include <terramech/soil_library.hpp>
#include <terramech/telemetry_reader.hpp>

namespace talus::cli {
namespace {

using terramech::Telemetry;

// The wheel of the rows, which must all have the same.
terramech::Wheel wheelOf(const Telemetry& table, const WheelRowOptions& options) {
  if (!options.rover.empty()) return terramech::loadRover(options.rover).wheel;
  const auto* radius = table.find("wheel_radius_m");
  const auto* width = table.find("wheel_width_m");
  if (radius == nullptr || width == nullptr) {
    throw InputError(
        {.where = table.source,
         .reason = fmt::format("lacks column {}", radius == nullptr ? "wheel_radius_m" : "wheel_width_m"),
         .remedy = "add it, or name the rover with --rover"});
  }
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!std::isfinite((*radius)[k]) || !std::isfinite((*width)[k])) {
      throw InputError({.where = fmt::format("{}:{}", table.source, table.lines[k]),
                        .reason = "has no wheel_radius_m or wheel_width_m",
                        .remedy = "fill it in, or name the rover with --rover"});
    }
    if ((*radius)[k] == radius->front() && (*width)[k] == width->front()) continue;
    throw InputError({.where = fmt::format("{}:{}", table.source, table.lines[k]),
                      .reason = "another wheel than in the first row",
                      .remedy = "one file for each size of wheel"});
  }
  return {.radius_m = radius->front(), .width_m = width->front()};
}

std::optional<std::string> unusable(const terramech::WheelSample& s, const WheelRowOptions& options) {
  if (!(s.sinkage_m > 0.0)) return "sinkage_m = 0: the wheel has no contact to infer stresses from";
  if (options.needs_slip && !(s.slip > 0.0))
    return fmt::format("slip = {:g}, must be > 0: a driven wheel", s.slip);
  return std::nullopt;
}

}  // namespace

WheelRows readWheelRows(const std::filesystem::path& path, const WheelRowOptions& options,
                        const Watch& watch) {
  terramech::TelemetryOptions reading{.required = {"load_N", "torque_Nm", "sinkage_m"}};
  if (options.needs_slip) reading.required.emplace_back("slip");
  if (!options.rover.empty()) reading.wheel_radius_m = terramech::loadRover(options.rover).wheel.radius_m;
  const Telemetry table = terramech::readTelemetry(path, reading, watch);
  WheelRows rows{.source = table.source,
                 .wheel = wheelOf(table, options),
                 .samples = {},
                 .lines = {},
                 .rejected = table.rejected};
  const auto* slip = table.find("slip");
  for (std::size_t k = 0; k < table.size(); ++k) {
    const terramech::WheelSample sample{.load_N = table.at("load_N")[k],
                                        .torque_Nm = table.at("torque_Nm")[k],
                                        .sinkage_m = table.at("sinkage_m")[k],
                                        .slip = slip == nullptr || std::isnan((*slip)[k]) ? 0.0 : (*slip)[k]};
    if (const auto reason = unusable(sample, options)) {
      rows.rejected.push_back({.line = table.lines[k], .reason = *reason});
      continue;
    }
    rows.samples.push_back(sample);
    rows.lines.push_back(table.lines[k]);
  }
  std::ranges::stable_sort(rows.rejected, {}, &terramech::RejectedRow::line);
  if (!rows.samples.empty()) return rows;
  throw InputError({.where = fmt::format("{}:{}", rows.source, rows.rejected.front().line),
                    .reason = fmt::format("no usable row: {}", rows.rejected.front().reason),
                    .remedy = ""});
}

}  // namespace talus::cli
