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
#include <talus/planner/route/problem.hpp>

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

/// Settings of the planners of OMPL. The default values performed best on maps of 1000 x 1000 cells.
struct SamplingSettings {
  std::string planner = "RRTstar";  ///< name of plannerNames() except "field"
  /// Limit of the total length of all evaluated motions [cell sides], > 0. It gives the same result on every
  /// machine and applies only to problems without a time limit.
  std::uint64_t work = 4'000'000;
  double range_cells = 40.0;  ///< length of the longest motion that is added to a tree [cells], > 0
  /// true: no initial route; false: the planner starts from the route of the field planner.
  bool cold = false;
  std::map<std::string, std::string> parameters{};  ///< parameters of the OMPL planner, in the units of OMPL
  std::function<void(double)> better{};  ///< called with the cost [J] of each improvement of the present leg
};

/// Parses a planner name of plannerNames() with optional settings, such as "NAME", "NAME:cold" or
/// "NAME:range=20:cold". Throws std::invalid_argument for an unknown name, for "cold" or a parameter of a
/// planner that is not of OMPL, for an unknown parameter and for an invalid value.
SamplingSettings samplingSettings(const std::string& words);

/// Returns all planner names, and the names of the OMPL planners followed by ":cold".
std::vector<std::string> warmAndCold();

/// Returns the text that samplingSettings() parses to these settings.
std::string wordsOf(const SamplingSettings& settings);

/// Runs one OMPL planner for a problem without via points. Start and goal of the problem must lie in cells
/// that allow some heading. `known` is the plan with the known route from which the planner may start. The
/// status of the result is Found only if every motion and turn of the route is allowed.
Plan runOmpl(const Problem& leg, const SamplingSettings& settings, const Plan& known);

/// Function that returns an initial route for a problem without via points. A status other than Found means
/// that no initial route is known.
using InitialPathProvider = std::function<Plan(const Problem& leg)>;

/// Plans with the sampling planners of OMPL under the exact cost, leg by leg through the via points. `scout`
/// gives the initial route of each leg; if `scout` is empty, the planners start without a route. The result
/// is never more expensive than the initial route, and contains only allowed motions. Without a time limit,
/// equal problems and seeds give identical results; with a time limit, the result depends on the machine.
/// Throws std::invalid_argument for an unknown planner or a setting out of range.
Plan planBySampling(const Problem& problem, const SamplingSettings& settings,
                    const InitialPathProvider& scout = {});

}  // namespace talus::planner
