#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/route/polyline.hpp>

namespace talus::planner {

/// Region through which a route can be cheaper than the best known route, and random samples of the region. A
/// point belongs to the region if the sum of the lower bounds from the start to the point and from the point
/// to the goal is at most the cost of the known route. This is the informed set of Gammell et al. 2014
/// [gammell_2014], with the cost function of the map. Half of the samples are drawn near the known route,
/// because most improvements are found there. The other half is drawn from the whole region, so that the
/// planners remain probabilistically complete. Immutable and safe to share between threads.
class ImprovableRegion {
 public:
  /// Map, start, goal and best known route, which define the region.
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    maps::Point start;
    maps::Point goal;
    double goal_tolerance_m = 0.0;         ///< permitted distance of the end of a route from the goal [m]
    std::vector<maps::Point> known_route;  ///< empty if no route is known
    double known_cost_J = 0.0;             ///< cost of the known route [J]
    bool hand_out_route = false;           ///< true: samplers first return the points of the known route
  };

  using Engine = std::mt19937_64;

  explicit ImprovableRegion(Parts parts);

  /// Returns an admissible lower bound [J] of the cost from the start to `place`, from `place` to the goal,
  /// or between two points: the distance times the lowest cost per metre of the map.
  double fromStart(maps::Point place) const;
  double toGoal(maps::Point place) const;
  double between(const Segment& ends) const;

  /// Returns the lowest cost per metre of the map [J/m].
  double cheapestMetre_J() const noexcept { return cheapest_J_per_m_; }

  /// Returns true if the lower bound of the cost of a route through `place` is at most `max_cost_J`.
  bool improves(maps::Point place, double max_cost_J) const;

  /// Sets `place` to a random point of the region for the cost `max_cost_J`. Returns false if 100 attempts
  /// found no such point.
  bool sample(Engine& engine, double max_cost_J, maps::Point& place) const;

  const Parts& parts() const noexcept { return parts_; }

 private:
  maps::Point anywhere(Engine& engine) const;
  maps::Point besideRoute(Engine& engine) const;

  Parts parts_;
  MotionCost motion_;
  double cheapest_J_per_m_ = 0.0;
  std::vector<double> route_metres_;  // length of the known route from the start to each of its points
  std::vector<std::uint32_t> cells_;  // indices of the cells of the region for the known cost
};

}  // namespace talus::planner
