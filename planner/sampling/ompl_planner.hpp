#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <ompl/base/Planner.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>

#include <talus/maps/maps.hpp>
#include <talus/planner/grid/field_planner.hpp>

namespace talus::planner {

/// Guard that suppresses the log output of OMPL while at least one guard exists in any thread. The last guard
/// restores the log handler of the program.
class QuietOmpl {
 public:
  QuietOmpl();
  ~QuietOmpl();
  QuietOmpl(const QuietOmpl&) = delete;
  QuietOmpl& operator=(const QuietOmpl&) = delete;
};

/// Calls `make` with the process-wide seed generator of OMPL set to `seed`. Calls of this function exclude
/// each other. Objects that `make` creates get the same random numbers, regardless of previous runs.
void withOmplSeed(std::uint64_t seed, const std::function<void()>& make);

/// RRT* [karaman_frazzoli_2011] with a tree that initially contains a known route, so that all samples
/// improve an existing solution. For states of MapSpace.
class SeededRRTstar : public ompl::geometric::RRTstar {
 public:
  /// Parameters in addition to those of RRT*.
  struct Seed {
    std::vector<maps::Point> route;  ///< known route from start to goal; empty: RRT* without a known route
    double spacing_m = 1.0;  ///< length of the parts into which the legs of the route are divided, > 0
    bool informed = false;   ///< true: sample only where the best cost can be reduced [gammell_2014]
  };

  SeededRRTstar(const ompl::base::SpaceInformationPtr& space, Seed seed);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& done) override;

 private:
  void plant();
  Motion* plantRoot();
  Motion* grow(Motion* parent, maps::Point place);

  Seed seed_;
};

/// Input of makeOmplPlanner().
struct PlannerParts {
  ompl::base::SpaceInformationPtr space;
  ompl::base::ProblemDefinitionPtr definition;
  /// Vertices of a known route from start to goal; empty if none is known.
  std::vector<maps::Point> known_route;
  double range_m = 1.0;    ///< length of the longest motion that is added to a tree, > 0
  std::uint64_t seed = 1;  ///< seed of the random samples
  /// Parameters of the planner; checkParameters() must accept them.
  std::map<std::string, std::string> parameters{};
};

/// Creates the planner of OMPL with a name of plannerNames(), with settings for drive costs; null if the name
/// is not that of an OMPL planner.
ompl::base::PlannerPtr makeOmplPlanner(const std::string& name, const PlannerParts& parts);

/// Returns true if the name is that of an OMPL planner.
bool isOmpls(const std::string& name);

/// Throws std::invalid_argument if `name` is not that of an OMPL planner, for an unknown parameter, and for
/// an invalid value.
void checkParameters(const std::string& name, const std::map<std::string, std::string>& parameters);

/// Adapter that offers FieldPlanner as a planner of OMPL over states of MapSpace, for SimpleSetup,
/// ompl::tools::Benchmark and similar tools. It uses the first start state and the goal (a single state,
/// whose threshold is the goal tolerance), and adds one solution path with its exact cost. Further start
/// states are ignored; for other types of goals it returns UNRECOGNIZED_GOAL_TYPE. The cost-to-go field of a
/// goal is kept until clear().
class FieldOmplPlanner : public ompl::base::Planner {
 public:
  FieldOmplPlanner(const ompl::base::SpaceInformationPtr& space, std::shared_ptr<const costmap::CostGrid> map,
                   int threads = 1);

  ompl::base::PlannerStatus solve(const ompl::base::PlannerTerminationCondition& done) override;
  void clear() override;

 private:
  ompl::base::PathPtr pathOf(const Plan& plan) const;

  std::shared_ptr<const costmap::CostGrid> map_;
  int threads_;
  std::unique_ptr<FieldPlanner> field_;
};

}  // namespace talus::planner
