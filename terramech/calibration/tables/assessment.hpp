#pragma once

#include <optional>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/telemetry.hpp>
#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {

/// Options for the assessment of the rows of a telemetry table: drawbar pull and traversability category of
/// each row.
struct AssessOptions {
  TableFile table;  ///< CSV file
  /// Formula for the drawbar pull without a model, one of pullFormulas().
  std::string formula = "single-force";
  std::string model;  ///< file of a base or refined model; empty: pull from the readings of T, z and i
  std::string rover;  ///< library name or file of the rover with default wheel dimensions; may be empty
  /// Steepest slope that the rover must climb; 10 deg (thesis Fig. 3.12).
  double slope_rad = 0.17453292519943295;
  double margin_rad = 0.0;      ///< uncertainty (+-) of that slope
  double z_threshold = 0.5;     ///< z/r (sinkage over radius) at or above which the category drops one level
  double z_critical = 0.75;     ///< z/r above which the ground is dangerous
  double noise = 0.05;          ///< relative standard deviation of each reading [-]
  double reference_slip = 0.5;  ///< slip of the forecasts with `extrapolate`
  /// true: the pull at the reference slip and the maximum pull are forecast as well.
  bool extrapolate = false;
};

/// Assessment of one row.
struct Assessment {
  std::size_t line = 0;                   ///< line number in the file
  double slip = 0.0;                      ///< measured slip [-]
  Estimate pull;                          ///< drawbar pull over load, DP/W [-], at the measured slip
  Estimate sinkage_over_radius;           ///< sinkage over radius, z/r [-]
  double torque_over_load_radius = 0.0;   ///< torque ratio T/(W r) [-]
  Category category = Category::Unknown;  ///< traversability category of the mean pull and sinkage
  CategoryProbability probability{};      ///< probability of each category
  std::optional<PullForecast> forecast;   ///< pull forecast, if AssessOptions::extrapolate is true
};

/// Assessment of all rows of a table.
struct AssessedTable {
  std::vector<Assessment> rows;       ///< usable rows in the order of the file
  std::vector<RejectedRow> rejected;  ///< unusable rows, with the reason
  /// Effects of the model that are sensor faults and therefore not applied.
  std::vector<std::string> left_out;
};

/// Reads the table and assesses each row, from its readings or with the model. Throws InputError for invalid
/// input.
AssessedTable assessTable(const AssessOptions& options, const ProgressMonitor& watch);

}  // namespace talus::terramech
