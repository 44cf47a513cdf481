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

/// One planning problem of a benchmark suite.
struct BenchmarkCase {
  std::string name;
  std::shared_ptr<const costmap::CostGrid> map;
  maps::Point start;
  maps::Point goal;
  double optimum_J = std::numeric_limits<double>::quiet_NaN();  ///< optimal cost [J] if known, else NaN
  Kinematics kinematics{};                                      ///< kinematics for planners of drives
  std::shared_ptr<const SlipWorld> world{};  ///< world in which routes are driven; null: routes are not
                                             ///< driven
  std::string group{};                       ///< cases of one group are scored together
};

/// A cost and the time at which it was reached.
struct CostAtTime {
  double seconds = 0.0;
  double cost_J = 0.0;
};

/// Result of one run of one planner on one case.
struct BenchmarkRun {
  std::string planner;
  std::size_t case_index = 0;
  std::uint64_t seed = 1;
  RouteStatus status = RouteStatus::NoneFound;
  bool crashed = false;    ///< the process ended without an answer
  bool breached = false;   ///< the independent check found a violation along the route
  double seconds = 0.0;    ///< planning time (wall clock)
  double megabytes = 0.0;  ///< peak memory of the process
  double cost_J = std::numeric_limits<double>::infinity();
  double lower_bound_J = 0.0;
  double length_m = 0.0;
  int turns = 0;
  int cusps = 0;                     ///< drives only: changes between forward and reverse
  int turns_in_place = 0;            ///< drives only
  double max_curvature_1_m = 0.0;    ///< drives only
  double clearance_cells = 0.0;      ///< from the route to the nearest cell without a drive curve, at most 10
  bool reached = false;              ///< worlds only: the rover reached the goal
  double drive_s = 0.0;              ///< worlds only: duration of the drive
  double max_slip = 0.0;             ///< worlds only: largest slip on the drive
  std::vector<CostAtTime> progress;  ///< decreasing costs, none below the route's cost; empty without a route
};

/// Cases, planners and limits of a benchmark.
struct BenchmarkPlan {
  std::vector<BenchmarkCase> cases;
  std::vector<std::string> planners;             ///< names of plannerNames() and of plugins
  std::map<std::string, std::string> plugins{};  ///< shared library of each plugin, by name
  int seeds = 1;                                 ///< runs per case and planner, with seeds 1 to `seeds`
  double time_limit_s = 1.0;                     ///< per run
  std::string began = "1970-01-01 00:00:00";     ///< start time for the logs, UTC
};

/// One run of a benchmark.
struct BenchmarkJob {
  std::string planner;
  std::size_t case_index = 0;
  std::uint64_t seed = 1;
};

/// All runs of a benchmark, ordered by planner, case and seed.
std::vector<BenchmarkJob> jobsOf(const BenchmarkPlan& plan);

/// Executes one run in a process of its own, so that a crash, an abort or an endless run is a result and does
/// not end the benchmark. Must be called while the program has no other threads. Returns the result as bytes
/// for benchmarkRun() on this machine or another machine of the same kind; empty if the process ended without
/// an answer or a stop was requested. Throws std::runtime_error if no process can be created.
std::string runIsolated(const BenchmarkPlan& plan, const BenchmarkJob& job,
                        const ProgressMonitor& watch = {});

/// Converts the bytes returned by runIsolated() to a run.
BenchmarkRun benchmarkRun(const BenchmarkJob& job, const std::string& bytes);

/// Executes all jobs one after another; returns fewer runs when stopped.
std::vector<BenchmarkRun> runBenchmark(const BenchmarkPlan& plan, const ProgressMonitor& watch = {});

/// Returns true if the run ended with a route without violations. Costs of other runs are meaningless.
bool stands(const BenchmarkRun& run) noexcept;

/// Best known cost of a case [J]: the optimum if known, else the lowest cost of all runs with stands();
/// infinite if there is none.
double bestKnown_J(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index);

}  // namespace talus::planner
