#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/mobility/category.hpp>
#include <talus/terramech/mobility/category_probability.hpp>

namespace talus::terramech {

/// Options for the assessment of a table's rows.
struct AssessOptions {
  TableFile table;                       ///< the CSV
  std::string formula = "single-force";  ///< one of pullFormulas(), used without a model
  std::string model;  ///< file of a base or refined model; empty: pull from the readings T, z and i
  std::string rover;  ///< library name or file with default wheel dimensions; may be empty
  double slope_rad = 0.17453292519943295;  ///< 10 deg (thesis Fig. 3.12)
  double margin_rad = 0.0;                 ///< uncertainty of the slope, +-
  double z_threshold = 0.5;                ///< z/r above which the category drops one level
  double z_critical = 0.75;                ///< z/r above which the ground is dangerous
  double noise = 0.05;                     ///< relative standard deviation of each reading [-]
  double reference_slip = 0.5;             ///< slip of the forecasts of `extrapolate`
  bool extrapolate = false;                ///< also forecast pull at the reference slip and maximum pull
};

/// Assessment of a row.
struct Assessment {
  std::size_t line = 0;                   ///< line of the table
  double slip = 0.0;                      ///< measured slip [-]
  Estimate pull;                          ///< drawbar pull over load, DP/W [-]
  Estimate sinkage_over_radius;           ///< z/r [-]
  double torque_over_load_radius = 0.0;   ///< T/(W r) [-]
  Category category = Category::Unknown;  ///< category of the mean pull and sinkage
  CategoryProbability probability{};      ///< of each category
  std::optional<PullForecast> forecast;   ///< if AssessOptions::extrapolate
};

/// Assessment of a table.
struct AssessedTable {
  std::vector<Assessment> rows;       ///< usable rows in order
  std::vector<RejectedRow> rejected;  ///< unusable rows with the reason
  std::vector<std::string> left_out;  ///< effects of the model that are sensor faults
};

/// Reads the table and assesses each row from its readings or with the model. Throws InputError for invalid
/// input.
AssessedTable assessTable(const AssessOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
