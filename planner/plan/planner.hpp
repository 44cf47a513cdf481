#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/windowed_map.hpp>
#include <talus/planner/plan/map.hpp>
#include <talus/planner/plugin/global_planner.hpp>

namespace talus {

using planner::Route;
using planner::RouteVertex;

/// What a given polyline costs, as a route with the planner "none". A polyline that may not be driven has the status
/// NoRoute, an infinite cost, and energy and time of the cells with finite values.
struct Score : Route {
  std::vector<planner::Violation> violations{};  ///< places where it may not be driven, with the reason
  std::optional<Route> best{};  ///< with PlanRequest::prove: the route of plan() between its ends
};

/// Planner of routes: one of Talus' own planners, or a planner from a shared library (a plugin), which runs in a
/// child process. The search takes account of the chassis and the risk limit of the request. Each route is checked
/// with planner::violations(), and each vertex has the elevation of the map. If there is no route, the result has the
/// status and the reason. Computed data are kept for later routes on the same map or on a newer version of the map,
/// without effect on the routes. Not thread-safe: use one object per thread; the objects may share a map.
class Planner {
 public:
  /// Selects an own planner by `settings.planner`; empty: the default planner. `plugin` is the file of a shared
  /// library whose planner of that name is used instead. Throws std::invalid_argument with field, value and bound for
  /// a setting out of range, and with the most similar name for an unknown planner; InputError under the conditions
  /// of planner::loadPlugin().
  explicit Planner(const PlannerSettings& settings = {}, const std::string& plugin = {});
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;
  ~Planner();

  /// Returns the name of the planner for reports.
  const std::string& name() const noexcept;

  /// Returns the capabilities of the selected own planner. For a plugin, unsupported fields of a request are
  /// rejected in the child process.
  PlannerCapabilities capabilities() const;

  /// Plans a route on a map, whose hazards the reason names. Throws std::invalid_argument if a field of the request
  /// is out of its range, or if the planner does not support a field that is set.
  Route plan(const Map& map, PlanRequest request);

  /// Plans a route on a version of a map, not null, or throws in the same way.
  Route plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request);

  /// Plans a route with the planner "field" on a map that is not held in memory. A route on a coarse overview
  /// of the map guides the search, and windows of full resolution are computed along the overview route. The status
  /// NoRoute is not a proof, because routes that the overview does not resolve are missed. Of the optional
  /// constraints only via points are supported.
  Route plan(planner::WindowedMap& map, const PlanRequest& request);

  /// Returns what a polyline of at least one point costs on a map under the cost function of the planners. Of the
  /// request, `chassis` (checked, too), `prove` (also plans between the ends) and `watch` are used.
  Score score(const costmap::TraversabilityMap& map, const std::vector<maps::Point>& path,
              PlanRequest request = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus
