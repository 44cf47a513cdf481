#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Where a route cheaper than the best one known can still pass, and samples of it.
/// A place belongs to it when its lower bounds, from the start and on to the goal, sum to no more than the
/// best cost (the informed set of Gammell et al. 2014 [gammell_2014], here under the drive cost). Half of the
/// samples are drawn close to the route known already, where most of what can be gained lies; the other half
/// keep the planners complete. Immutable, safe to share between threads.
class ImprovableRegion {
 public:
  /// What it is made of.
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    maps::Point start;
    maps::Point goal;
    double goal_tolerance_m = 0.0;         ///< the route may end so far from the goal
    std::vector<maps::Point> known_route;  ///< empty when none is known
    double known_cost_J = 0.0;             ///< of that route
    bool hand_out_route = false;           ///< samplers begin with the known route's points
  };

  using Engine = std::mt19937_64;

  explicit ImprovableRegion(Parts parts);

  /// Admissible lower bounds in joules: straight at the cheapest metre of the map.
  double fromStart(maps::Point place) const;
  double toGoal(maps::Point place) const;
  double between(const Segment& ends) const;

  /// Cost of the cheapest metre of the map in joules.
  double cheapestMetre_J() const noexcept { return cheapest_J_per_m_; }

  /// Whether a route through the place can cost less than max_cost_J.
  bool improves(maps::Point place, double max_cost_J) const;

  /// Moves place to a random place of the region; false when none was found in a hundred tries.
  bool sample(Engine& engine, double max_cost_J, maps::Point& place) const;

  const Parts& parts() const noexcept { return parts_; }

 private:
  maps::Point anywhere(Engine& engine) const;
  maps::Point besideRoute(Engine& engine) const;

  Parts parts_;
  MotionCost motion_;
  double cheapest_J_per_m_ = 0.0;
  std::vector<double> route_metres_;  // cumulative length of the known route
  std::vector<std::uint32_t> cells_;  // cells of the region at the known cost
};

}  // namespace talus::planner
