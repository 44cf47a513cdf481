#pragma once

#include <functional>
#include <string>
#include <utility>

#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/grid/tube_planner.hpp>
#include <talus/planner/pose/drive_planner.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/planner/sampling/sampling_planner.hpp>

namespace talus::planner {

/// Any planner on offer, by its name: the field, drives within a turning radius, or one of OMPL's improving
/// on the field's route. What the field worked out for a map and a goal is kept from plan to plan. Not
/// thread-safe: one object a thread; they may share a map.
class NamedPlanner {
 public:
  /// By samplingSettings(): a name of planner_names.hpp, of OMPL's also "NAME:cold:range=20". Throws std::invalid_argument as it does.
  explicit NamedPlanner(const std::string& name = {});

  /// Whether it keeps headings and a turning radius.
  bool drives() const noexcept {
    return settings_.planner == DrivePlanner::kName || settings_.planner == DrivePlanner::kSampling;
  }

  /// The offered name.
  const std::string& name() const noexcept { return settings_.planner; }

  /// Calls back with every better cost in joules as it is found; sampling planners only, for routes without
  /// via points.
  void onBetter(std::function<void(double)> better) { settings_.better = std::move(better); }

  /// From this many cells on the field is settled in a tube only (TubePlanner), unless the problem requires
  /// the whole: at twenty bytes a cell it would take more than 400 MB.
  static constexpr std::size_t kLarge = 20'000'000;

  /// A route through all via points in order to the goal that costs least, or why there is none. Throws
  /// std::invalid_argument without a map.
  Plan plan(const Problem& problem);

 private:
  Plan planOne(const Problem& problem);
  Plan planField(const Problem& problem);

  SamplingSettings settings_;
  FieldPlanner field_;
  DrivePlanner drive_;
  TubePlanner tube_;
};

}  // namespace talus::planner
