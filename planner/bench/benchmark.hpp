#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/route/problem.hpp>

namespace talus::planner {

struct SlipWorld;

/// Case of a benchmark suite: one planning problem. Points are map coordinates [m].
struct BenchmarkCase {
  std::string name;
  std::shared_ptr<const costmap::CostGrid> map;
  maps::Point start;
  maps::Point goal;
  double optimum_J = std::numeric_limits<double>::quiet_NaN();  ///< optimal cost [J]; NaN if not known
  /// Constraints on the motion, for planners of drives (routes with a turning radius).
  Kinematics kinematics{};
  /// Slip world in which routes are driven; null: routes are not driven.
  std::shared_ptr<const SlipWorld> world{};
  std::string group{};  ///< name of the group; cases of one group are scored together
};

/// Cost of a route [J], and the planning time [s] after which it was reached.
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
  bool crashed = false;    ///< the planner process ended without a result
  bool breached = false;   ///< the route check (violations()) found a violation along the route
  double seconds = 0.0;    ///< planning time (wall clock)
  double megabytes = 0.0;  ///< peak memory of the process
  double cost_J = std::numeric_limits<double>::infinity();
  double lower_bound_J = 0.0;
  double length_m = 0.0;
  int turns = 0;                   ///< number of turns of the polyline
  int cusps = 0;                   ///< drives only: number of changes between forward and reverse
  int turns_in_place = 0;          ///< drives only: number of turns in place
  double max_curvature_1_m = 0.0;  ///< drives only: largest magnitude of curvature [1/m]
  /// Distance from the route to the nearest cell without a cost curve, at most 10 [cells].
  double clearance_cells = 0.0;
  bool reached = false;   ///< slip worlds only: the rover reached the goal
  double drive_s = 0.0;   ///< slip worlds only: duration of the drive
  double max_slip = 0.0;  ///< slip worlds only: largest slip of the drive [-]
  /// Decreasing costs, none below the cost of the route; empty without a route.
  std::vector<CostAtTime> progress;
};

/// Cases, planners and limits of a benchmark.
struct BenchmarkPlan {
  std::vector<BenchmarkCase> cases;
  std::vector<std::string> planners;             ///< names of plannerNames() and of `plugins`
  std::map<std::string, std::string> plugins{};  ///< path of the shared library of each plugin, by name
  int seeds = 1;              ///< number of runs per case and planner, with seeds 1 to `seeds`
  double time_limit_s = 1.0;  ///< time limit of a run
  std::string began = "1970-01-01 00:00:00";  ///< start time of the benchmark for the logs, UTC
};

/// Job of a benchmark: planner, case and seed of one run.
struct BenchmarkJob {
  std::string planner;
  std::size_t case_index = 0;
  std::uint64_t seed = 1;
};

/// Returns all jobs of a benchmark, ordered by planner, case and seed.
std::vector<BenchmarkJob> jobsOf(const BenchmarkPlan& plan);

/// Executes one job in a separate process, so that a crash, an abort or an endless loop is recorded as a
/// result and does not end the benchmark. The function must be called while the program has no other threads.
/// Returns the result as bytes, which benchmarkRun() can convert on this machine or on another machine of the
/// same kind. The bytes are empty if the process ended without a result or a stop was requested. Throws
/// std::runtime_error if no process can be created.
std::string runIsolated(const BenchmarkPlan& plan, const BenchmarkJob& job,
                        const ProgressMonitor& watch = {});

/// Converts the bytes that runIsolated() returned for `job` to the result of a run.
BenchmarkRun benchmarkRun(const BenchmarkJob& job, const std::string& bytes);

/// Returns true if the run ended with a route without violations. The costs of other runs are meaningless.
bool stands(const BenchmarkRun& run) noexcept;

/// Returns the best known cost of a case [J]: the optimum if it is known, otherwise the lowest cost of all
/// runs of the case for which stands() is true; infinite if there is no such run.
double bestKnown_J(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs, std::size_t case_index);

/// Returns the runs of one case in the form of an OMPL benchmark log (text) for ompl_benchmark_statistics.py
/// and Planner Arena. The properties of a run are time, memory, status, correctness, cost, length, turns, gap
/// to the best known cost, cusps, turns in place, curvature and clearance. The progress of a run is its cost
/// over time.
std::string benchmarkLog(const BenchmarkPlan& plan, const std::vector<BenchmarkRun>& runs,
                         std::size_t case_index);

}  // namespace talus::planner
