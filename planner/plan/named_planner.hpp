#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include <talus/planner/check/route_risk.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/pose/pose_planner.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::planner {

/// Returns the cheapest of the plans to the goals of `problem`. `plan` plans to a single goal; Plan::goal of
/// the result is the index of the selected goal. Goals are tried in the order of their straight-line lower
/// bounds. A goal is skipped if its lower bound is not below the best cost; therefore the result equals the
/// best of the plans to all goals. A goal that cannot be reached does not prevent plans to the other goals.
/// If no goal can be reached, status and reason are those of the first goal tried. The time limit applies to
/// all goals together.
Plan planToCheapest(const Problem& problem, const std::function<Plan(const Problem& one_goal)>& plan);

/// Planner selected by name. The planners are the field planner (polylines from a cost-to-go field), the
/// planner of drives (arcs with a turning radius), and planners of OMPL, which improve the route of the field
/// planner. The cost-to-go field of a map and a goal is kept for later plans. Not thread-safe: use one object
/// per thread; the objects may share a map.
class NamedPlanner {
 public:
  /// `name` is a name of problem.hpp; empty: the default planner. Options may follow the name of an
  /// OMPL planner, for example "NAME:cold:range=20" (samplingSettings()). Throws std::invalid_argument for an
  /// invalid name.
  explicit NamedPlanner(const std::string& name = {});

  /// Returns true if the planner computes drives, that is, takes account of headings and the turning radius.
  bool drives() const noexcept { return settings_.planner == PosePlanner::kName; }

  /// Returns the canonical name of the planner.
  const std::string& name() const noexcept { return settings_.planner; }

  /// Sets a function that is called with the cost [J] of each improved route. Only planners of OMPL call it,
  /// and only for problems without via points.
  void onBetter(std::function<void(double)> better) { settings_.better = std::move(better); }

  /// Returns the cheapest route found from the start through all via points in order to the goal, or a plan
  /// with the reason why there is no route. Throws std::invalid_argument if the problem has no map.
  Plan plan(const Problem& problem);

 private:
  Plan planOne(const Problem& problem);

  SamplingSettings settings_;
  FieldPlanner field_;
  PosePlanner drive_;
};

/// Returns the parameters of the risk simulation for a map, with the random seed `seed`. The correlation
/// length of `limit` is used only if the cost function of the map has none.
RouteRiskOptions riskOptions(const costmap::CostGrid& map, const RiskLimit& limit, std::uint64_t seed);

/// Plans under a chance constraint: returns the cheapest route found whose risk in annotated() is at most
/// max_risk, with max_risk in (0, 1). Routes that meet the constraint with a margin of two standard errors of
/// routeRisk() are preferred. The plan without the constraint is tried first. Then a price per unit of risk
/// is added to the cost. The price is raised until the constraint is met, and lowered as far as the
/// constraint permits (Lagrangian relaxation; routes that are not optimal for any price are missed
/// [everett_1963]). Without a time limit of the problem the search takes two seconds. If no route meets the
/// constraint, the status is NoneFound and the reason contains the lowest risk found. After a stop by
/// Problem::watch, the plan is marked `interrupted` or has the status Cancelled. Cost and lower bound of the
/// plan use the weights of the map. Throws std::invalid_argument if max_risk is out of range.
Plan planWithinRisk(const Problem& problem, NamedPlanner& planner, double max_risk);

}  // namespace talus::planner
