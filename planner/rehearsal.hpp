#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <costmap/traversability_map.hpp>
#include <planner/true_world.hpp>
#include <talus.hpp>

namespace talus::planner {

/// How a rehearsed drive ended.
enum class Outcome {
  Reached,      ///< the goal
  Immobilised,  ///< no slip gave the pull, neither on nor back, or nobody was watching the slip
  Tipped,       ///< the true ground was steeper than the rover may stand
  GaveUp,       ///< no route is left under what is believed
};

/// "reached", "immobilised", "tipped", "gave_up".
std::string_view name(Outcome outcome) noexcept;

/// What a rehearsal does.
struct RehearsalOptions {
  maps::Point start;
  maps::Point goal;
  double goal_tolerance_m = 0.0;  ///< >= 0
  bool senses =
      true;  ///< the rover watches its slip, learns and replans; else it drives the first route blindly
  double alarm_slip = 0.2;  ///< it stops and backs out when it slips so much more than the map says
  double step_m = 0.5;      ///< > 0
  int max_replans = 60;     ///< then it gives up
  std::uint64_t seed = 1;   ///< of the sensors' noise
  Watch watch;
};

/// What came of it.
struct Rehearsal {
  Outcome outcome = Outcome::GaveUp;
  double energy_J = 0.0;
  double time_s = 0.0;
  double length_m = 0.0;  ///< driven, backing out included
  double max_slip = 0.0;
  int replans = 0;
  std::vector<maps::Point> track;
};

/// Drives a rover over a true world with what a map believes, changing the map as it learns. Deterministic in
/// its seed.
Rehearsal rehearse(costmap::TraversabilityMap& map, const TrueWorld& world, const RehearsalOptions& options);

}  // namespace talus::planner
