#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/talus.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/category_probability.hpp>

namespace talus::cli {

/// What `talus assess` is asked for.
struct AssessOptions {
  std::string table;
  std::string formula = "single-force";
  std::string model;  ///< file of a base or refined model; empty: the pull follows from T, z and i as read
  std::string rover;
  std::string html;
  double slope_rad = 0.17453292519943295;  ///< 10 deg (thesis Fig. 3.12)
  double margin_rad = 0.0;
  double z_threshold = 0.5;
  double z_critical = 0.75;
  double noise = 0.05;
  double reference_slip = 0.5;
  bool extrapolate = false;
};

/// What a row comes to.
struct Assessment {
  std::size_t line = 0;
  double slip = 0.0;
  terramech::Uncertain pull;  ///< DP/W
  terramech::Uncertain sinkage_over_radius;
  double torque_over_load_radius = 0.0;
  terramech::Category category = terramech::Category::Unknown;
  terramech::CategoryProbability probability{};
  std::optional<terramech::PullForecast> forecast;
};

/// The rows of a table, judged.
struct AssessedTable {
  std::vector<Assessment> rows;
  std::vector<terramech::RejectedRow> rejected;
  std::vector<std::string> left_out;  ///< effects of the model that are faults of a sensor
};

/// Reads the table and judges each row, by its readings or by the model. Throws InputError for what is wrong
/// with the input.
AssessedTable assessTable(const AssessOptions& options, const ProgressMonitor& watch);

}  // namespace talus::cli
