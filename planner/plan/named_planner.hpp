#pragma once

#include <functional>
#include <string>
#include <utility>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/pose/pose_planner.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::planner {

/// Planner selected by name: the field planner, drives with a turning radius, or an OMPL planner that
/// improves the field's route. The field for a map and a goal is cached between plans. Not thread-safe: use
/// one object per thread; objects may share a map.
class NamedPlanner {
 public:
  /// Accepts the names of samplingSettings(): a name of planner_names.hpp; OMPL's planners also accept
  /// options, as in "NAME:cold:range=20". Throws std::invalid_argument for an invalid name.
  explicit NamedPlanner(const std::string& name = {});

  /// Returns true if the planner honours headings and a turning radius.
  bool drives() const noexcept {
    return settings_.planner == PosePlanner::kName || settings_.planner == PosePlanner::kSampling;
  }

  /// The canonical name.
  const std::string& name() const noexcept { return settings_.planner; }

  /// Sets a callback for each improved cost [J]. Only sampling planners call it, for routes without via
  /// points.
  void onBetter(std::function<void(double)> better) { settings_.better = std::move(better); }

  /// From this number of cells the field is computed in a tube only (TubePlanner), unless the problem
  /// requires the whole field: at 20 bytes per cell the field would exceed 400 MB.
  static constexpr std::size_t kLarge = 20'000'000;

  /// Returns the cheapest route found through all via points in order to the goal, or the reason why there is
  /// none. Throws std::invalid_argument if the problem has no map.
  Plan plan(const Problem& problem);

 private:
  Plan planOne(const Problem& problem);
  Plan planField(const Problem& problem);

  SamplingSettings settings_;
  FieldPlanner field_;
  PosePlanner drive_;
  TubePlanner tube_;
};

}  // namespace talus::planner
