#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/motion_cost.hpp>

namespace talus::planner {

/// Region through which a route cheaper than the best known one can still pass, and random samples of the
/// region. A place belongs to the region if the lower bounds from the start and to the goal sum to at most
/// the best cost (the informed set of Gammell et al. 2014 [gammell_2014], here with the drive cost). Half of
/// the samples are drawn near the known route, because most improvements are found there; the other half is
/// drawn from the whole region and keeps the planners complete. Immutable and safe to share between threads.
class ImprovableRegion {
 public:
  /// Map, places and best known route that define the region.
  struct Parts {
    std::shared_ptr<const costmap::CostGrid> map;
    maps::Point start;
    maps::Point goal;
    double goal_tolerance_m = 0.0;         ///< largest distance of the route's end from the goal [m]
    std::vector<maps::Point> known_route;  ///< empty if no route is known
    double known_cost_J = 0.0;             ///< cost of the known route [J]
    bool hand_out_route = false;           ///< samplers first return the points of the known route
  };

  using Engine = std::mt19937_64;

  explicit ImprovableRegion(Parts parts);

  /// Admissible lower bounds [J]: straight-line distance times the lowest cost per metre of the map.
  double fromStart(maps::Point place) const;
  double toGoal(maps::Point place) const;
  double between(const Segment& ends) const;

  /// Lowest cost per metre of the map [J/m].
  double cheapestMetre_J() const noexcept { return cheapest_J_per_m_; }

  /// Returns true if a route through the place can cost at most max_cost_J.
  bool improves(maps::Point place, double max_cost_J) const;

  /// Sets `place` to a random place of the region. Returns false if 100 tries found no such place.
  bool sample(Engine& engine, double max_cost_J, maps::Point& place) const;

  const Parts& parts() const noexcept { return parts_; }

 private:
  maps::Point anywhere(Engine& engine) const;
  maps::Point besideRoute(Engine& engine) const;

  Parts parts_;
  MotionCost motion_;
  double cheapest_J_per_m_ = 0.0;
  std::vector<double> route_metres_;  // cumulative length of the known route
  std::vector<std::uint32_t> cells_;  // cells of the region for the known cost
};

}  // namespace talus::planner
