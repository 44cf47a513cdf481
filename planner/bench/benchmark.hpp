#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

struct SlipWorld;

/// One question of a benchmark suite.
struct BenchmarkCase {
  std::string name;
  std::shared_ptr<const costmap::CostGrid> map;
  maps::Point start;
  maps::Point goal;
  double optimum_J = std::numeric_limits<double>::quiet_NaN();  ///< where it is known, else NaN
  Kinematics kinematics{};                                      ///< that planners of drives keep
  std::shared_ptr<const SlipWorld> world{};  ///< over which routes are driven; null: not driven
  std::string group{};                       ///< worlds of one group are scored together
};

/// A cost and when it was reached.
struct CostAtTime {
  double seconds = 0.0;
  double cost_J = 0.0;
};

/// How one run of one planner on one case went.
struct BenchmarkRun {
  std::string planner;
  std::size_t case_index = 0;
  std::uint64_t seed = 1;
  RouteStatus status = RouteStatus::NoneFound;
  bool crashed = false;    ///< the process did not live to answer
  bool breached = false;   ///< the independent check found a violation along the route
  double seconds = 0.0;    ///< wall clock of planning
  double megabytes = 0.0;  ///< peak memory of the process
  double cost_J = std::numeric_limits<double>::infinity();
  double lower_bound_J = 0.0;
  double length_m = 0.0;
  int turns = 0;
  int cusps = 0;                   ///< of drives: changes between forward and reverse
  int turns_in_place = 0;          ///< of drives
  double max_curvature_1_m = 0.0;  ///< of drives
  double clearance_cells = 0.0;  ///< from the route to the nearest cell that no heading may enter, at most 10
  bool reached = false;          ///< in worlds: the rover came to the goal
  double drive_s = 0.0;          ///< in worlds: time that the drive took
  double max_slip = 0.0;         ///< in worlds: largest slip met
  std::vector<CostAtTime> progress;  ///< ever better costs, none below the route's; empty without a route
};

/// What a benchmark runs.
struct BenchmarkPlan {
  std::vector<BenchmarkCase> cases;
  std::vector<std::string> planners;             ///< names of plannerNames(), and of plugins
  std::map<std::string, std::string> plugins{};  ///< shared libraries of those, by name
  int seeds = 1;                                 ///< runs a case and planner: seeds 1 to so many
  double time_limit_s = 1.0;                     ///< a run
  std::string began = "1970-01-01 00:00:00";     ///< for the logs, in UTC
};

/// One run to be made.
struct BenchmarkJob {
  std::string planner;
  std::size_t case_index = 0;
  std::uint64_t seed = 1;
};

/// All runs of a benchmark: planner by planner, case by case, seed by seed.
std::vector<BenchmarkJob> jobsOf(const BenchmarkPlan& plan);

/// One run in a process of its own: a crash, an abort or a run-away is a result, not the end of the
/// benchmark. Call it while the program has no other threads. Returns the answer as bytes, for benchmarkRun()
/// on this or another machine of the same kind; empty when the process did not live to answer, and when a
/// stop was requested, which ends it. Throws std::runtime_error when none can be made.
std::string runIsolated(const BenchmarkPlan& plan, const BenchmarkJob& job,
                        const ProgressMonitor& watch = {});

/// The inverse: a run from its bytes.
BenchmarkRun benchmarkRun(const BenchmarkJob& job, const std::string& bytes);

/// All jobs, one after another; fewer when a stop is requested.
std::vector<BenchmarkRun> runBenchmark(const BenchmarkPlan& plan, const ProgressMonitor& watch = {});

/// Whether a run ended with a route that the independent check allows: only its costs mean anything.
bool stands(const BenchmarkRun& run) noexcept;

/// The best cost known of a case: the optimum where it is known, else the best of all its runs whose routes
/// stand [J]; infinite for none.
double bestKnown_J(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index);

}  // namespace talus::planner
