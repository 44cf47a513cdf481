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

/// Where one route of many begins and ends.
struct PlacePair {
  maps::Point start;
  maps::Point goal;
  std::optional<double> start_heading_rad;  ///< for planners of drives
  std::optional<double> goal_heading_rad;
};

/// Reads columns start_x_m, start_y_m, goal_x_m, goal_y_m, and, where there are any, start_heading_rad and
/// goal_heading_rad. @throws InputError naming file, line and column
std::vector<PlacePair> readPairs(const std::string& path);

/// What all of them have in common.
struct PairedRequest {
  std::shared_ptr<const costmap::CostGrid> map;
  PlanRequest request;  ///< but start and goal; a heading of a pair replaces its own
  PlannerSettings settings{};
};

/// Plans them all, over the ranks of the campaign: a line of JSON each, in order, as `talus plan --json` prints it with `pair`, and status, planner and `reason` alone
/// where there is no route. What went wrong with one pair is its line's reason and stops no other. Empty but
/// on the leading rank.
std::vector<nlohmann::ordered_json> planPairs(const std::vector<PlacePair>& pairs,
                                              const PairedRequest& common, planner::RoutePlanner& planner,
                                              const Campaign& campaign);

/// The lines as CSV: pair, status, planner, cost, energy_J, time_s, length_m, max_slip, max_slope_rad,
/// lower_bound, gap, immobilisation_risk, reason.
std::string pairsCsv(const std::vector<nlohmann::ordered_json>& lines);

}  // namespace talus::cli
