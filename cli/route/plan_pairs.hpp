#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/plan/route_planner.hpp>

namespace talus::cli {

class Campaign;
class Part;

/// Start and goal of one of several routes.
struct PlacePair {
  maps::Point start;
  maps::Point goal;
  /// Heading at the start, for planners of drives (paths with headings).
  std::optional<double> start_heading_rad;
  /// Heading at the goal.
  std::optional<double> goal_heading_rad;
};

/// Returns the pairs of starts and goals of a CSV table with the columns start_x_m, start_y_m, goal_x_m,
/// goal_y_m and, if present, start_heading_rad and goal_heading_rad. @throws InputError with file, line and
/// column
std::vector<PlacePair> readPairs(const std::string& path);

/// Settings that apply to all pairs.
struct PairedRequest {
  std::shared_ptr<const costmap::CostGrid> map;
  PlanRequest request;  ///< request without start and goal; a heading of a pair replaces that of the request
  PlannerSettings settings{};
};

/// Plans the routes of the pairs of a part, distributed over the ranks of the campaign. Returns one JSON object per
/// pair in order: the output of `talus plan --json` with `pair`, or status, planner and `reason` if there is
/// no route. An error in one pair becomes the reason of that pair and stops no other pair. Returns an empty
/// vector on ranks other than 0.
std::vector<nlohmann::ordered_json> planPairs(const std::vector<PlacePair>& pairs,
                                              const PairedRequest& common, planner::RoutePlanner& planner,
                                              const Campaign& campaign, const Part& part);

/// Returns the results of planPairs() as CSV: pair, status, planner, cost, energy_J, time_s, length_m,
/// max_slip, max_slope_rad, lower_bound, gap, immobilisation_risk, reason.
std::string pairsCsv(const std::vector<nlohmann::ordered_json>& lines);

}  // namespace talus::cli
